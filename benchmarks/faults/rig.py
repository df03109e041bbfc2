"""A node process with its peer, services and judge, and what the faults do with them."""
import math
import re
import tempfile
import time

from ..domains import free_domain
from . import motion
from .judge import Judge, Wrong
from .peer import Peer
from .process import SCENE, NodeProcess
from .services import Services

STEP = 20_000_000       # ns between samples, 50 Hz
BEGIN = 10_000_000_000  # ns, the first stamp
SHOWN_WITHIN = 0.5      # s
PATIENCE = 3.0          # s more, to tell what comes late from what never comes
_ANSWER = 5.0           # s


class Rig:
    """A context: inside, the node runs.

    stamp: ns of the next good sample; offset: ns by which stamps are ahead of the motion's time. shown: what diagnostics said, (status, words, s
    after the fault).
    """

    def __init__(self, parameters=None, file_size=None, folder=None, reliability="reliable", log=True):
        self._temporary = None if folder else tempfile.TemporaryDirectory(prefix="mooring_faults_")
        self.folder = folder or self._temporary.name
        self._parameters, self._file_size = parameters or {}, file_size
        self.domain, self._reliability, self._log = free_domain(), reliability, log
        self.judge = Judge(SCENE)
        self.stamp, self.offset = BEGIN, 0
        self._judged = 0
        self.shown, self.fault_at = [], None
        self.notes = []

    def __enter__(self):
        self.launch()
        self.peer, self.services = Peer(self.domain, self._reliability), Services(self.domain)
        try:
            self.peer.wait_for_node(lambda: self.process.alive)
        except BaseException as error:
            log = self.process.log
            self.__exit__()
            raise Wrong(f"{error}\n{log}") from error
        return self

    def __exit__(self, *_):
        self.services.close()
        self.peer.close()
        self.process.end()
        if self._temporary:
            self._temporary.cleanup()

    def launch(self, **changes):
        """Start the node process (again)."""
        self.process = NodeProcess(self.folder, {**self._parameters, **changes}, self.domain, self._file_size, self._log)

    def fresh(self):
        """A new session of the same process, with nothing left of the last one."""
        if self.services.state() == "active":
            assert self.services.transition("deactivate")
        if self.services.state() == "unconfigured":
            assert self.services.transition("configure")
        assert self.services.transition("activate")
        self.peer.wait_for_node(lambda: self.process.alive)
        self.forget()

    def forget(self):
        """What was heard and sent so far is judged; begin anew."""
        self.peer.heard.clear()
        self.peer.statuses.clear()
        self._judged = 0
        self.judge.begin()
        self.stamp, self.offset = BEGIN, 0
        self.shown, self.notes, self.fault_at = [], [], None

    # --- motion ---

    def state(self, stamp):
        """Where the platform is at a stamp (ns)."""
        return motion.at((stamp - self.offset) * 1e-9)

    def jump_clock(self, by):
        """The simulator's clock is set by so many ns; the motion goes on where it was."""
        self.stamp += by
        self.offset += by

    def send(self, count=1, answered=True, period=0.0):
        """Good samples, one after the other, each when the last one is answered; with answered=False without waiting, `period` s apart."""
        for _ in range(count):
            stamp = self.stamp
            self.send_at(stamp)
            self.stamp += STEP
            if answered:
                self.answer(stamp)
            elif period:
                time.sleep(period)

    def send_at(self, stamp, good=True, state=None):
        """The sample of one stamp. good: whether it may be answered."""
        state = state or self.state(stamp)
        if good:
            self.judge.good[stamp] = state
        self.peer.odometry.send(motion.odometry(stamp, state))

    def bad(self, stamp=None, frame="world", child="platform", position=None, quaternion=None, twist=None, change=None):
        """The next sample with something wrong in it. change(message): for what has no name here. It must not be answered."""
        stamp = self.stamp if stamp is None else stamp
        state = self.state(self.stamp)
        pose = [*(position or state.pose[:3]), *(quaternion or state.pose[3:])]
        message = motion.odometry(stamp, state, frame, child)
        message["pose"]["pose"] = {"position": dict(zip("xyz", pose)), "orientation": dict(zip("xyzw", pose[3:]))}
        if twist:
            message["twist"]["twist"] = {"linear": dict(zip("xyz", twist)), "angular": dict(zip("xyz", twist[3:]))}
        if change:
            change(message)
        self.mark()
        self.peer.odometry.send(message)

    def answer(self, stamp, timeout=_ANSWER):
        """Wait for the wrench of a stamp and judge all that came until then."""
        if not self.peer.wait(lambda: self.peer.heard[self._judged:] and self.peer.heard[-1].stamp == stamp, timeout):
            raise Wrong(f"no wrench for {stamp * 1e-9:.9f} s within {timeout} s{self._why()}")
        self.judged()

    def silence(self, seconds):
        """Wait; raises Wrong if a sample is answered. What is held meanwhile goes out under the last stamp."""
        last = self.peer.heard[-1].stamp if self.peer.heard else None
        if self.peer.wait(lambda: self.peer.heard and self.peer.heard[-1].stamp != last, seconds):
            raise Wrong(f"a wrench with stamp {self.peer.heard[-1].stamp * 1e-9:.9f} s, expected none")

    def held(self, timeout=3.0):
        """Wait until the output has gone to the static wrench and stays there; the judge follows."""
        def there():
            self.judged()
            return self.judge.share >= 1.0 - 1e-9 and self.judge.holds
        if not self.peer.wait(there, timeout):
            raise Wrong(f"the output has not reached the static wrench within {timeout} s, but {100.0 * self.judge.share:.1f} % of the way")

    def running(self, timeout=5.0):
        """Send good samples until the output is as computed again."""
        end = time.monotonic() + timeout
        while self.judge.blends:
            if time.monotonic() > end:
                raise Wrong(f"the output is not as computed within {timeout} s")
            self.send()

    def running_by_the_wall_clock(self):
        """Send some good samples with the stamps of now, and more until the output is as computed again, a thousand at most."""
        for number in range(1000):
            self.stamp = time.time_ns()
            self.send()
            if number > 20 and not self.judge.blends:
                break
            time.sleep(0.005)

    def unjudged(self):
        """Leave what was heard so far to others to judge, but for numbers that are not finite."""
        self._judged = len(self.peer.heard)
        if not all(math.isfinite(x) for heard in self.peer.heard for x in heard.wrench):
            raise Wrong("a wrench that is not finite")

    def judged(self):
        """Judge what was heard since the last time."""
        while self._judged < len(self.peer.heard):
            self.judge.check(self.peer.heard[self._judged])
            self._judged += 1

    # --- what the node says ---

    def mark(self):
        """The fault happens now."""
        if self.fault_at is None:
            self.fault_at = time.monotonic()

    def expect(self, name, words, allowed=0.0, level=1):
        """Wait until /diagnostics shows the cause: status `name` of this level or above whose message matches the expression `words`.

        allowed: s for which it is no fault yet.
        """
        within = SHOWN_WITHIN + allowed
        since, pattern = self.fault_at or time.monotonic(), re.compile(words)

        def found():
            told = (s for s in self.peer.statuses if s.arrived >= since and s.name == name and s.level >= level)
            return next((s for s in told if pattern.search(s.message)), None)

        patience = within + PATIENCE
        status = self.peer.wait(found, patience)
        if status is None:
            now = next((s for s in reversed(self.peer.statuses) if s.name == name), None)
            raise Wrong(f"diagnostics of {name} do not say '{words}' within {patience} s; they say {now and (now.level, now.message)}")
        after = max(status.arrived - since - allowed, 0.0)
        self.shown.append((name, status.message, after))
        if after > SHOWN_WITHIN:
            raise Wrong(f"diagnostics of {name} said '{status.message}' after {after:.2f} s, expected {SHOWN_WITHIN} s")
        self.fault_at = None
        return status

    def value(self, name, key):
        """The newest value under a key of a status, as text; None before there is one."""
        return next((s.values.get(key) for s in reversed(self.peer.statuses) if s.name == name), None)

    def runs(self, timeout=3.0):
        """Wait until the node says that it is in full run."""
        if not self.peer.wait(lambda: self.value("state", "state") == "RUN", timeout):
            raise Wrong("it does not run again")

    def settle(self):
        """Ask the node to settle; the judge does, too, at the sample sent last."""
        ok, words = self.services.trigger("settle")
        if not ok:
            raise Wrong(f"~/settle: {words}{self._why()}")
        self.judged()
        self.judge.settle(self.stamp - STEP)

    def _why(self):
        if not self.process.alive:
            return f"; the node has ended with {self.process.process.returncode}:\n{self.process.log[-2000:]}"
        status = [f"{s.name}: {s.message}" for s in self.peer.statuses[-5:]]
        return "; diagnostics: " + " | ".join(status)
