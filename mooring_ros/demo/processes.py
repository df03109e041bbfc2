"""Child processes of the demo: started, watched, and never left behind."""

import ctypes
import os
import signal
import subprocess

_GRACE = 15.0  # s for a child to close its files
_PR_SET_PDEATHSIG = 1


class Child:
    """A Python module run as a process of its own.

    Its standard error (and output, unless read) goes to the file `log`. It gets no Ctrl-C of the terminal: whoever owns it decides
    when it stops. Should its owner be killed, the kernel stops it.
    """

    def __init__(self, name, module, arguments, log, environment, executable, read=False):
        self.name, self.log = name, log
        libc = ctypes.CDLL(None)
        owner = os.getpid()

        def tie_to_owner():
            signal.signal(signal.SIGINT, signal.SIG_DFL)  # a shell that starts us in the background has it ignored
            libc.prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)
            if os.getppid() != owner:  # it died in between
                os._exit(1)

        with open(log, "wb") as file:
            self._process = subprocess.Popen(
                [executable, "-m", module, *arguments], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE if read else file, stderr=file,
                env=environment, start_new_session=True, preexec_fn=tie_to_owner,
            )  # fmt: skip
        self._partial = b""
        if read:
            os.set_blocking(self._process.stdout.fileno(), False)

    @property
    def status(self):
        """The exit status, or None while it runs."""
        return self._process.poll()

    def lines(self):
        """The whole lines it has printed since the last call, as text; for a child started with read=True."""
        while piece := self._process.stdout.read(65536):
            self._partial += piece
        *whole, self._partial = self._partial.split(b"\n")
        return [line.decode(errors="replace") for line in whole]

    def tail(self, count=12):
        """The last lines of its log, as text."""
        with open(self.log, encoding="utf-8", errors="replace") as file:
            return "".join(file.readlines()[-count:]).rstrip()

    def wait(self, timeout):
        """The exit status, or None when it still runs after timeout (s)."""
        try:
            return self._process.wait(timeout)
        except subprocess.TimeoutExpired:
            return None

    def stop(self):
        """Ask it to stop (SIGINT), then more firmly; returns its exit status."""
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
            if self.status is not None:
                break
            self._process.send_signal(number)
            self.wait(_GRACE if number == signal.SIGINT else 3.0)
        if self._process.stdout:
            self._process.stdout.close()
        return self._process.wait()
