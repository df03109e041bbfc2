"""The coupled run: mooring node and floater as two ROS 2 processes, started, watched and closed."""

import json
import os
import sys
import time
from dataclasses import dataclass
from pathlib import Path

from mooring_ros.demo.options import sea_arguments
from mooring_ros.demo.processes import Child

_APPEARANCE = 600.0  # s for the node: the first start on a machine compiles the core
_DOMAINS = 101  # ROS_DOMAIN_ID 1 to 101: above, the ports may be taken by others


class RunFailed(Exception):
    """The coupled run did not come to its end; the text says who failed, with the end of its log. status: its exit status."""

    def __init__(self, child, others=()):
        self.status = child.status
        logs = "".join(f"\nthe end of {one.log}:\n{one.tail()}" for one in (child, *others))
        super().__init__(f"the {child.name} ended with status {child.status}{logs}")


@dataclass(frozen=True)
class Run:
    """A finished run: the folder's files, and what the simulator says about it (see simulator.Summary)."""

    recording: Path
    summary: dict


def environment():
    """The environment of both processes: a ROS domain of their own on this machine alone, unless the user has chosen otherwise."""
    chosen = dict(os.environ)
    chosen.setdefault("ROS_DOMAIN_ID", str(1 + os.getpid() % _DOMAINS))
    chosen.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    chosen["PYTHONUNBUFFERED"] = "1"
    return chosen


def run(options, scene, depth, folder, variables, progress, interrupted):
    """Run the demo's two processes and return the Run.

    options: the command line's; scene: path; depth: m; folder: of the results; variables: environment; progress: Progress;
    interrupted: called without arguments, tells whether to stop. Raises RunFailed, KeyboardInterrupt when interrupted; the recording is closed in both cases.
    """
    recording, summary = folder / "run.mcap", folder / "simulator.json"
    node = Child("mooring node", "mooring_ros.node", _node_arguments(options, scene, recording), folder / "node.log", variables, sys.executable)
    floater = None
    try:
        arguments = [*sea_arguments(options), f"--depth={depth!r}", f"--timeout={_APPEARANCE!r}", f"--summary={summary}", "--json"]
        floater = Child("floater", "mooring_ros.demo.simulator", arguments, folder / "floater.log", variables, sys.executable, read=True)
        _watch(node, floater, progress, interrupted)
    finally:
        progress.close()
        # The floater first: what it has sent is then recorded to the last sample.
        if floater is not None:
            floater.stop()
        node.stop()
    return Run(recording, json.loads(summary.read_text(encoding="utf-8")))


def _watch(node, floater, progress, interrupted):
    """Show the progress until the floater is done."""
    waiting = True
    while True:
        if waiting:
            progress.state("starting the mooring node and the floater (the first start on a machine compiles the mooring core)")
        if interrupted():
            raise KeyboardInterrupt
        ended = floater.status  # before the lines: after its end, all of them are there
        for line in floater.lines():
            waiting = False
            progress.run(json.loads(line)["time"])
        if ended == 0:
            return
        if node.status is not None:
            raise RunFailed(node)
        if ended is not None:
            raise RunFailed(floater, [node])
        time.sleep(0.05)


def _node_arguments(options, scene, recording):
    parameters = {"scene": str(Path(scene).resolve()), "recording.enabled": True, "recording.path": str(recording.resolve())}
    for name in ("fidelity", "solver", "dt", "segments", "refine"):
        if getattr(options, name) is not None:
            parameters[name] = getattr(options, name)
    words = ["--ros-args"]
    for name, value in parameters.items():
        words += ["-p", f"{name}:={json.dumps(value)}"]
    return words
