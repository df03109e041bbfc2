"""Parameters, services and winches, used wrongly or too often."""
import math
from pathlib import Path

from .judge import Wrong
from .peer import wait_until_heard
from .process import SCENE
from .registry import fault

_LENGTHS = "sensor_msgs/msg/JointState"


@fault("fixed parameters, and values out of range, set while active", "each is refused with its reason, and nothing changes")
def parameters_refused(rig):
    rig.send(20)
    for name, value in (("scene", "/etc/passwd"), ("fidelity", "linear"), ("scale", 50.0), ("recording.path", "/tmp/x"), ("limits.force", -1.0),
                        ("limits.jump", math.nan), ("ramp_time", math.inf), ("visual_rate", 1e9), ("limits.gap", "long"), ("no.such", 1.0)):
        done, reason = rig.services.set(name, value)
        if done or not reason:
            raise Wrong(f"parameter {name} could be set to {value!r} while active, or was refused without a reason")
        if name == "scene":
            rig.shown.append(("the service's answer", reason, 0.0))
    rig.send(20)


@fault("over the graph: a scene and a recording outside of the node's folders, and a scene that names a file there",
       "each is refused with its reason, and nothing of the file is told")
def files_outside(rig):
    rig.send(20)
    assert rig.services.transition("deactivate") and rig.services.transition("cleanup")
    for name, value in (("scene", "/etc/passwd"), ("recording.path", "/var/x.mcap"), ("recording.path", "../../../../var/x"),
                        ("access.folders", "/")):
        done, reason = rig.services.set(name, value)
        if done or "root:" in reason:
            raise Wrong(f"parameter {name} could be set to {value!r} over the graph, or the reason tells of the file: {reason}")
    inside = Path(rig.folder) / "scene.txt"
    inside.write_text(Path(SCENE).read_text(encoding="utf-8").replace("WtrDpth", "WtrDpth\n/etc/passwd SeafloorFile"), encoding="utf-8")
    if not rig.services.set("scene", str(inside))[0]:
        raise Wrong("a scene in the node's working directory is refused")
    rig.mark()
    if rig.services.transition("configure"):
        raise Wrong("a scene that names /etc/passwd was read")
    told = rig.expect("core", "/etc/passwd' lies outside", level=2)
    if "root:" in told.message or "root:" in rig.process.log:
        raise Wrong("diagnostics or log tell what is in /etc/passwd")
    assert rig.services.set("scene", SCENE)[0]
    shown = rig.shown
    rig.fresh()
    rig.shown = shown
    rig.send(20)


@fault("limits of the input changed while samples come", "they hold from the next sample on")
def parameters_changed(rig):
    rig.send(20)
    if not rig.services.set("limits.gap", 0.1)[0]:
        raise Wrong("limits.gap cannot be set while active")
    rig.send(20)
    rig.stamp += 200_000_000
    rig.mark()
    rig.send_at(rig.stamp, good=False)
    rig.expect("input", r"jump: stamp is 0\.22")
    rig.services.set("limits.gap", 60.0)
    rig.stamp += 20_000_000
    rig.send(20)


@fault("lifecycle transitions that there are none of: activate while active, cleanup while active, number 77", "each is refused, and nothing changes")
def impossible_transitions(rig):
    rig.send(20)
    for label in ("activate", "configure", "cleanup", 77):
        if rig.services.transition(label):
            raise Wrong(f"the transition {label} succeeded while active")
    if rig.services.state() != "active":
        raise Wrong(f"the node is {rig.services.state()}, expected it to be active still")
    rig.shown.append(("the service's answer", "no success", 0.0))
    rig.send(20)


@fault("100 lifecycle cycles, each down to unconfigured and back, with samples", "none needed", quick=False)
def lifecycle_cycles(rig):
    _cycles(rig, 100)


@fault("5 lifecycle cycles, each down to unconfigured and back, with samples", "none needed")
def few_lifecycle_cycles(rig):
    _cycles(rig, 5)


def _cycles(rig, count):
    memory = None
    for number in range(count):
        rig.send(5)
        rig.judged()
        for label in ("deactivate", "cleanup"):
            if not rig.services.transition(label):
                raise Wrong(f"cycle {number}: cannot {label}")
        rig.fresh()
        if number == count // 5:
            memory = rig.process.memory()
    rig.send(5)
    grown = rig.process.memory() / memory - 1.0
    rig.shown.append(("the process", f"memory grew by {100.0 * grown:.1f} % over the last {count - count // 5} cycles", 0.0))
    if grown > 0.1 and count > 20:
        raise Wrong(f"the memory grew by {100.0 * grown:.0f} % over {count} lifecycle cycles")


@fault("unstretched lengths that make no sense: unknown line, NaN, negative, zero, infinite, too few, none",
       "each message is refused as a whole, nothing changes")
def winch_nonsense(rig):
    rig.send(20)
    winch = rig.peer.publisher("/mooring/unstretched_lengths", _LENGTHS)
    wait_until_heard(winch)
    for names, lengths in ((["line9"], [800.0]), (["line1"], [math.nan]), (["line1"], [-5.0]), (["line1", "line2"], [800.0, 0.0]),
                           (["line1"], [math.inf]), (["line1", "line2"], [800.0]), ([], []), (["line1", "line1"], [800.0, 801.0]),
                           (["../../line1"], [800.0])):
        rig.mark()
        winch.send({"name": names, "position": lengths})
    rig.expect("core", "unstretched lengths refused")
    rig.send(20)
    winch.close()


@fault("a slip of the decimal point at the winch: 83.5 m for 835 m", "it is refused; `limits.winch` says how far a message may go")
def winch_slip(rig):
    rig.send(20)
    winch = rig.peer.publisher("/mooring/unstretched_lengths", _LENGTHS)
    wait_until_heard(winch)
    rig.mark()
    winch.send({"name": ["line1"], "position": [83.5]})
    rig.expect("core", "unstretched lengths refused: unstretched length of line1 is 83.5 m")
    rig.send(20)
    winch.close()


@fault("~/settle a hundred times between samples", "none needed")
def many_settles(rig):
    rig.send(5)
    for _ in range(100):
        rig.settle()
    rig.send(20)


@fault("~/hold in full run, samples going on", "~/settle")
def hold_asked(rig):
    rig.send(20)
    rig.judge.held()
    rig.mark()
    if not rig.services.trigger("hold")[0]:
        raise Wrong("~/hold is refused")
    rig.expect("state", "HOLD: ~/hold")
    rig.held()
    rig.settle()
    rig.running()
    rig.send(20)


@fault("a line let go twice", "the second is refused with its reason")
def released_twice(rig):
    rig.send(5)
    ok, words = rig.services.trigger("lines/line2/release")
    if not ok:
        raise Wrong(f"release: {words}")
    rig.judge.release("line2")
    rig.send(20)
    ok, words = rig.services.trigger("lines/line2/release")
    if ok:
        raise Wrong("a line could be let go twice")
    rig.shown.append(("the service's answer", words, 0.0))
    rig.send(20)
    # What was let go stays so until a new configure.
    assert rig.services.transition("deactivate") and rig.services.transition("cleanup")
