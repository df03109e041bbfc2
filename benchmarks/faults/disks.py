"""The recording's disk: full, slow, gone."""
import os
import resource
import shutil
import textwrap
import time
from pathlib import Path

from mcap.reader import make_reader
from rosbags.highlevel import AnyReader

from mooring_ros.recording.recover import recover

from .judge import Wrong
from .peer import Peer
from .registry import fault
from .rig import Rig
from .services import Services
from .setups import QUIET

SLOW = 1.5      # s that each write takes on the slow disk


def recorded(folder, name="run.mcap"):
    """Parameters of a node that records to folder/name."""
    return {**QUIET, "recording.enabled": True, "recording.path": str(Path(folder) / name)}


def wrenches_in(path):
    """Stamps (ns) of the wrenches in a recording that was closed."""
    with open(path, "rb") as file:
        return [message.publish_time for _, _, message in make_reader(file).iter_messages(topics=["/mooring/wrench"])]


def _complete(rig, path):
    stamps = wrenches_in(path)
    heard = [heard.stamp for heard in rig.peer.heard]
    if stamps != heard:
        raise Wrong(f"{len(stamps)} wrenches in the recording, expected the {len(heard)} that were heard")


@fault("the disk full for two seconds", "none needed: what waits is written when there is room again, nothing is lost", node=None)
def disk_full(folder):
    with Rig(recorded(folder), folder=folder) as rig:
        rig.send(100)
        file = Path(folder) / "run.mcap"
        process = rig.process.process.pid
        before = resource.prlimit(process, resource.RLIMIT_FSIZE)
        rig.peer.wait(lambda: False, 0.5)
        resource.prlimit(process, resource.RLIMIT_FSIZE, (file.stat().st_size, before[1]))
        rig.mark()
        rig.send(50)
        rig.expect("recording", "File too large|No space", allowed=0.3, level=2)
        rig.send(100, period=0.01)
        rig.peer.wait(lambda: False, 1.0)
        resource.prlimit(process, resource.RLIMIT_FSIZE, before)
        rig.send(50)
        if not rig.peer.wait(lambda: (s := rig.peer.statuses[-1]) and s.name == "recording" and s.level == 0, 3.0):
            raise Wrong(f"diagnostics of the recording do not recover: {rig.peer.statuses[-1]}")
        rig.judged()
        rig.process.end()
        _complete(rig, file)
    return rig


@fault("the disk full until the end", "the file ends without an index, and `mooring recover` reads it", node=None, quick=False)
def disk_full_at_the_end(folder):
    with Rig(recorded(folder), folder=folder) as rig:
        rig.send(100)
        rig.peer.wait(lambda: False, 0.5)
        file = Path(folder) / "run.mcap"
        process = rig.process.process.pid
        resource.prlimit(process, resource.RLIMIT_FSIZE, (file.stat().st_size, resource.prlimit(process, resource.RLIMIT_FSIZE)[1]))
        rig.mark()
        rig.send(50)
        rig.expect("recording", "File too large|No space", allowed=0.3, level=2)
        status = rig.process.end()
        if status != 0 or "recording" not in rig.process.log:
            raise Wrong(f"the node ended with {status}, expected 0 and a word about the recording:\n{rig.process.log}")
        recovered(file, Path(folder) / "whole.mcap", 100)
    return rig


def recovered(file, out, least):
    """`mooring recover` makes it readable by rosbags, with so many wrenches at least."""
    recover(file, out)
    with AnyReader([out]) as reader:
        count = sum(1 for _ in reader.messages([c for c in reader.connections if c.topic == "/mooring/wrench"]))
    if count < least:
        raise Wrong(f"{count} wrenches in the recovered recording, expected {least} at least")
    return count


@fault(f"a disk that takes {SLOW} s for each write", "none needed: no wrench waits, and nothing is lost", node=None, quick=False)
def disk_slow(folder):
    # From outside: the interpreter of the node loads this before anything else.
    site = Path(folder) / "site"
    site.mkdir()
    (site / "sitecustomize.py").write_text(textwrap.dedent(f"""
        import os, threading, time
        own = os.pwrite
        def pwrite(*arguments):
            if os.path.exists({str(Path(folder) / "slow")!r}):
                time.sleep({SLOW})
            return own(*arguments)
        os.pwrite = pwrite
        """))
    before = os.environ.get("PYTHONPATH")
    os.environ["PYTHONPATH"] = os.pathsep.join([str(site), *filter(None, [before])])
    try:
        rig = Rig(recorded(folder), folder=folder)
        rig.__enter__()
    finally:
        os.environ.pop("PYTHONPATH") if before is None else os.environ.update(PYTHONPATH=before)
    try:
        rig.send(50)
        (Path(folder) / "slow").touch()
        rig.mark()
        slowest = 0.0
        for _ in range(150):
            begin = time.monotonic()
            rig.send()
            slowest = max(slowest, time.monotonic() - begin)
            time.sleep(0.01)
        rig.expect("recording", "behind|waits", allowed=1.5)    # behind after a second, and then at once
        if slowest > 0.5 * SLOW:
            raise Wrong(f"an answer took {slowest:.2f} s while the disk was slow")
        (Path(folder) / "slow").unlink()
        rig.send(20)
        rig.process.end()
        _complete(rig, Path(folder) / "run.mcap")
    finally:
        rig.__exit__()
    return rig


@fault("the recording's folder removed while it is written", "the wrenches go on; configure anew for a new recording", node=None, quick=False)
def recording_removed(folder):
    with Rig(recorded(folder, "bag/run"), folder=folder) as rig:
        rig.send(100)
        rig.peer.wait(lambda: False, 0.5)
        shutil.rmtree(Path(folder) / "bag")
        rig.mark()
        rig.send(100, period=0.01)
        rig.expect("recording", "removed", allowed=0.3, level=2)
        rig.send(20)
        rig.judged()
        if rig.process.end() != 0 or "Traceback" in rig.process.log:
            raise Wrong(f"the node did not end well:\n{rig.process.log}")
    return rig


@fault("a recording that cannot be created", "set another `recording.path`, configure and activate", node=None, quick=False)
def recording_impossible(folder):
    rig = Rig(recorded("/proc/nowhere"), folder=folder)
    rig.launch()
    rig.peer, rig.services = Peer(rig.domain), Services(rig.domain)
    try:
        rig.services.state(timeout=240.0)
        rig.expect("core", "/proc/nowhere", allowed=2.5, level=2)
        if not rig.services.set("recording.path", str(Path(folder) / "run.mcap"))[0]:
            raise Wrong("recording.path cannot be set when the node is not configured")
        shown = rig.shown
        rig.fresh()
        rig.shown = shown
        rig.send(20)
    finally:
        rig.__exit__()
    return rig
