"""The pictures of docs/look.md: a real run of the node, its recording drawn, and what `mooring status` says meanwhile."""
import itertools
import json
import os
import re
import subprocess
import sys
import tempfile
import threading
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

from mooring_ros.node.messages import NODE_FIELDS
from mooring_ros.offline.status_text import status_text

from .faults.rig import STEP, Rig

SAMPLES = 2000          # in lockstep, before the terminal looks on
SEEN = 400              # at 50 Hz, while it does
COLOURS = {"31": "#e06c75", "32": "#98c379", "33": "#e5c07b", "35": "#c678dd", "36": "#56b6c2"}
DARK, LIGHT = "#1e222a", "#d7dae0"
_NODE = np.dtype([(name, "<f4") for name in NODE_FIELDS])


def run(quick=False):
    """Run the node; the pictures are `look_status.png`, `look_tensions.png`, `look_time.png`."""
    with tempfile.TemporaryDirectory(prefix="mooring_look_") as folder:
        file = Path(folder) / "run.mcap"
        with Rig({"recording.enabled": True, "recording.path": str(file), "accuracy.share": 0.5}, folder=folder) as rig:
            rig.send(SAMPLES)
            sender = threading.Thread(target=rig.send, kwargs={"count": SEEN, "answered": False, "period": 1e-9 * STEP})
            sender.start()
            done = subprocess.run([sys.executable, "-m", "mooring_ros.offline", "status", "--json"], capture_output=True, text=True, check=True,
                                  env={**_environment(), "ROS_DOMAIN_ID": str(rig.domain)})
            sender.join()
            rig.answer(rig.stamp - STEP)
            rig.process.end()
        clouds, markers, lines = _recorded(file)
    text = status_text(json.loads(done.stdout), colour=True).replace(str(folder), "…")
    figures = {"look_status.png": terminal("$ mooring status\n" + text), "look_tensions.png": scene(clouds[-1], markers[-1]),
               "look_time.png": history(lines)}
    return {"tables": {}, "failed": [], "figures": figures, "status": text}


def _environment():
    path = ":".join([str(Path(__file__).parents[1]), os.environ.get("PYTHONPATH", "")])
    return {**os.environ, "PYTHONPATH": path, "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}


def _recorded(file):
    """Clouds (arrays of _NODE), marker arrays, and (stamps (n,) s, names, tensions (n, lines) N) of a recording."""
    clouds, markers, rows, names = [], [], [], []
    with open(file, "rb") as stream:
        for _, channel, _, message in make_reader(stream, decoder_factories=[DecoderFactory()]).iter_decoded_messages():
            if channel.topic == "/mooring/nodes":
                clouds.append(np.frombuffer(bytes(message.data), _NODE))
            elif channel.topic == "/mooring/markers":
                markers.append(message.markers)
            elif channel.topic == "/mooring/lines":
                names = list(message.name)
                rows.append((message.header.stamp.sec + 1e-9 * message.header.stamp.nanosec, *message.effort))
    table = np.array(rows)
    return clouds, markers, (table[:, 0], names, table[:, 1:])


def terminal(text):
    """Text with ANSI colours as a picture."""
    lines = text.split("\n")
    columns = max(len(re.sub(r"\x1b\[\d*m", "", line)) for line in lines)
    figure = Figure(figsize=(0.084 * columns + 0.4, 0.185 * len(lines) + 0.3), facecolor=DARK)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set_axis_off()
    axes.set_xlim(-2, columns + 2)
    axes.set_ylim(len(lines) + 0.5, -0.5)
    for row, line in enumerate(lines):
        column, colour = 0, LIGHT
        for piece in re.split(r"(\x1b\[\d*m)", line):
            if piece.startswith("\x1b"):
                colour = COLOURS.get(piece[2:-1], LIGHT)
                continue
            for character in piece:
                if character != " ":
                    axes.text(column, row + 0.5, character, color=colour, family="DejaVu Sans Mono", fontsize=9, ha="center", va="center")
                column += 1
    return figure


def scene(cloud, markers):
    """The point cloud, coloured by tension, over the bed and the anchors of the markers."""
    figure = Figure(figsize=(9, 5.5), layout="constrained")
    axes = figure.add_subplot(projection="3d")
    for line in np.unique(cloud["line"]):
        nodes = cloud[cloud["line"] == line]
        axes.plot(nodes["x"], nodes["y"], nodes["z"], color="0.6", linewidth=0.8, zorder=1)
    shown = axes.scatter(cloud["x"], cloud["y"], cloud["z"], c=cloud["tension"] / 1e3, cmap="turbo", s=14, depthshade=False, zorder=2)
    for marker in markers:
        if marker.ns == "anchors":
            places = np.array([(point.x, point.y, point.z) for point in marker.points])
            axes.scatter(*places.T, color="k", marker="s", s=30, label="anchors")
        elif marker.ns == "seabed":
            middle, half = marker.pose.position, 0.5 * marker.scale.x
            x, y = np.meshgrid([middle.x - half, middle.x + half], [middle.y - half, middle.y + half])
            axes.plot_surface(x, y, np.full_like(x, middle.z), color="#8c7859", alpha=0.25)
    axes.set_box_aspect((1, 1, 0.35), zoom=1.25)
    axes.view_init(25, -50)
    axes.set_xlabel("x (m)")
    axes.set_ylabel("y (m)")
    axes.set_zlabel("z (m)")
    figure.colorbar(shown, ax=axes, label="tension (kN)", shrink=0.7)
    return figure


def history(lines):
    """Fairlead tensions over time."""
    times, names, tensions = lines
    figure = Figure(figsize=(9, 3), layout="constrained")
    axes = figure.add_subplot()
    for name, tension, style in zip(names, tensions.T, itertools.cycle(("-", "--", ":"))):     # lines on both sides coincide
        axes.plot(times, tension / 1e3, style, label=name)
    axes.set_xlabel("stamp (s)")
    axes.set_ylabel("fairlead tension (kN)")
    axes.legend(loc="upper right")
    axes.grid(alpha=0.3)
    return figure
