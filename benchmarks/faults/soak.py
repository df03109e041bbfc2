"""`./run bench soak`: the node with recording for a long time: nothing missing, nothing growing, everything recorded, replayed bit for bit."""
import json
import os
import subprocess
import sys
import tempfile
import time
from array import array
from pathlib import Path

import numpy as np
from mcap.reader import make_reader

from .. import tables
from ..domains import free_domain
from . import motion
from .peer import Peer
from .process import ROOT, SCENE, NodeProcess

MEMORY_EVERY = 5.0      # s
MEMORY_MAY_GROW = 1.0   # %
WARM_UP = 0.2           # share of the run after which the memory is taken to be the node's
LAST_ANSWER = 5.0       # s
DRIFT = 10e-6           # of the rate: what the clock's resolution and one late answer may look like over a minute


class Counting(Peer):
    """Keeps stamps and times of arrival alone, so that the peer does not grow either."""

    def __init__(self, domain):
        self.stamps, self.arrivals, self.finite = array("q"), array("d"), True
        self.worst_level = {}
        super().__init__(domain)

    def _take_wrench(self, now, message):
        force = message.wrench.force
        self.stamps.append(motion.stamp_of(message))
        self.arrivals.append(now)
        self.finite = self.finite and abs(force.x + force.y + force.z) < float("inf")

    def _take_status(self, now, message):
        for status in message.status:
            if int(status.level) and len(self.stamps) > 100:
                self.worst_level.setdefault(f"{status.name}: {status.message}", now)


def add_arguments(parser):
    """Options of `bench soak`."""
    parser.add_argument("--minutes", type=float, default=60.0, help="default: %(default)g")
    parser.add_argument("--rate", type=float, default=200.0, metavar="HZ", help="default: %(default)g")
    parser.add_argument("--folder", type=Path, help="where to record (default: a temporary folder)")


def run(quick=False, minutes=60.0, rate=200.0, folder=None):
    """One run; quick: six seconds."""
    with tempfile.TemporaryDirectory(prefix="mooring_soak_") as temporary:
        found = soak(Path(folder or temporary), 0.1 if quick else minutes, rate)
    failed = verdicts(found, quick)
    rows = [[what, value, wanted] for what, value, wanted in _rows(found)]
    return {"tables": {"soak": tables.table(("", "found", "wanted"), rows)}, "failed": failed, **found}


def soak(folder, minutes, rate):
    """Drive the node at `rate` (Hz) for so long, on absolute deadlines; returns what was found."""
    file = folder / "soak.mcap"
    domain = free_domain()
    node = NodeProcess(folder, {"recording.enabled": True, "recording.path": str(file)}, domain)
    peer = Counting(domain)
    try:
        peer.wait_for_node(lambda: node.alive)
        sent, memory, late = _drive(peer, node, round(60.0 * minutes * rate), rate)
        peer.wait(lambda: len(peer.stamps) >= len(sent), LAST_ANSWER)
    finally:
        status = node.end()
        peer.close()
    stamps, arrivals = np.array(peer.stamps), np.array(peer.arrivals)
    recorded = _recorded(file)
    replayed = _replay(file, folder / "replayed.mcap")
    warm = memory[int(WARM_UP * len(memory)):]
    third = max(len(warm) // 3, 1)
    return {
        "minutes": minutes, "rate": rate, "sent": len(sent),
        "missing": len(set(sent) - set(peer.stamps)), "doubled": len(stamps) - len(set(peer.stamps)),
        "finite": peer.finite, "drift": _drift(stamps, arrivals), "latest (ms)": 1e3 * late, "memory (MiB)": [m / 2**20 for m in memory],
        "growth (%)": 100.0 * (np.mean(warm[-third:]) / np.mean(warm[:third]) - 1.0), "status": status,
        "not recorded": {topic: len(sent) - count for topic, count in recorded.items() if count != len(sent)},
        "recording (MB)": file.stat().st_size * 1e-6, "replay": replayed, "warnings": sorted(peer.worst_level),
    }


def _drive(peer, node, count, rate):
    """Send; returns stamps (ns), memory of the node (bytes) now and then, and how late (s) the latest sample went out."""
    period = round(1e9 / rate)
    sent, memory, late = array("q"), [], 0.0
    begin = time.monotonic() + 0.1
    look = begin
    for k in range(count):
        stamp, due = k * period, begin + k * period * 1e-9
        now = time.monotonic()
        if now < due:
            time.sleep(due - now)
        late = max(late, time.monotonic() - due)
        peer.odometry.send(motion.odometry(stamp, motion.at(stamp * 1e-9)))
        sent.append(stamp)
        if due >= look:
            memory.append(node.memory())
            look = due + min(MEMORY_EVERY, count / rate / 30)
    return sent, memory, late


def _drift(stamps, arrivals):
    """By how much the clock of the answers runs slow: slope of the least-squares line through arrivals (n,) s over stamps (n,) ns, less one."""
    times = 1e-9 * (stamps - stamps[0]) if len(stamps) > 1 else np.zeros(0)
    return float(np.polyfit(times, arrivals - arrivals[0] - times, 1)[0]) if len(times) else float("inf")


def _recorded(file):
    """Topic -> messages, of the topics that have one for each sample."""
    with open(file, "rb") as stream:
        summary = make_reader(stream).get_summary()
    counts = {channel.topic: summary.statistics.channel_message_counts.get(number, 0) for number, channel in summary.channels.items()}
    each = ("/platform/odom", "/mooring/wrench", "/mooring/lines", "/mooring/line_tensions", "/mooring/steps")
    return {topic: counts.get(topic, 0) for topic in each}


def _replay(file, out):
    done = subprocess.run([sys.executable, "-m", "mooring_ros.offline", "replay", SCENE, str(file), "-o", str(out), "--json"], capture_output=True,
                          text=True, cwd=ROOT, env={**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])})
    return json.loads(done.stdout)["identical"] if done.returncode == 0 else {"same": 0, "total": 0, "error": done.stderr.strip()}


def _rows(found):
    yield "samples sent", found["sent"], f"{found['minutes']:g} min at {found['rate']:g} Hz"
    yield "wrenches missing", found["missing"], 0
    yield "wrenches doubled", found["doubled"], 0
    yield "rate of the answers off by", f"{found['drift']:.1e}", f"below {DRIFT:.0e}"
    yield "memory at the start, at the end (MiB)", f"{found['memory (MiB)'][0]:.1f}, {found['memory (MiB)'][-1]:.1f}", ""
    yield "memory grown after warm-up (%)", f"{found['growth (%)']:+.2f}", f"below {MEMORY_MAY_GROW:g}"
    yield "samples without their messages in the recording", sum(found["not recorded"].values()), 0
    yield "size of the recording (MB)", f"{found['recording (MB)']:.1f}", ""
    yield "tensions that the replay gave again, bit for bit", f"{found['replay']['same']} of {found['replay']['total']}", "all"
    yield "warnings in /diagnostics", "; ".join(found["warnings"]) or "none", ""


def verdicts(found, quick=False):
    """What was not as wanted, in words. quick: too short for rate and memory."""
    failed = []
    if found["missing"] or found["doubled"] or not found["finite"]:
        failed.append(f"{found['missing']} wrenches missing, {found['doubled']} doubled, finite: {found['finite']}")
    if found["not recorded"]:
        failed.append(f"not recorded: {found['not recorded']}")
    if not found["replay"]["total"] or found["replay"]["same"] != found["replay"]["total"]:
        failed.append(f"the replay differs: {found['replay']}")
    if found["status"] != 0:
        failed.append(f"the node ended with status {found['status']}")
    if not quick and abs(found["drift"]) > DRIFT:
        failed.append(f"the rate is off by {found['drift']:.1e}")
    if not quick and found["growth (%)"] > MEMORY_MAY_GROW:
        failed.append(f"the memory grew by {found['growth (%)']:.2f} %")
    return failed
