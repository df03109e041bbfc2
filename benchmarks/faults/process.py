"""The mooring node as a process under test."""
import os
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SCENE = str(ROOT / "config" / "scenes" / "oc4.txt")
START = 240.0       # s, cold compilation included


class NodeProcess:
    """`mooring_node` with these parameters (name -> value), its log in folder/node.log.

    domain: ROS_DOMAIN_ID; hears this machine alone. file_size: bytes that it may write into one file (RLIMIT_FSIZE), None for any. log: whether
    anybody reads what it says.
    """

    def __init__(self, folder, parameters, domain, file_size=None, log=True):
        self.log_path = Path(folder) / f"node_{time.monotonic_ns()}.log"
        arguments = [part for name, value in {"scene": SCENE, **parameters}.items() for part in ("-p", f"{name}:={_yaml(value)}")]
        environment = {**os.environ, "ROS_DOMAIN_ID": str(domain), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
                       "PYTHONPATH": os.pathsep.join([str(ROOT), *filter(None, [os.environ.get("PYTHONPATH")])])}
        limit = None if file_size is None else lambda: _limit_files(file_size)
        self.log_path.touch()
        with open(self.log_path, "wb") if log else _broken_pipe() as log:
            self.process = subprocess.Popen([sys.executable, "-m", "mooring_ros.node", "--ros-args", *arguments], cwd=folder, env=environment,
                                            stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT, preexec_fn=limit)

    @property
    def log(self):
        """What it has said so far."""
        return self.log_path.read_text(encoding="utf-8", errors="replace")

    @property
    def alive(self):
        return self.process.poll() is None

    def memory(self):
        """Resident set, bytes."""
        pages = int(Path(f"/proc/{self.process.pid}/statm").read_text().split()[1])
        return pages * os.sysconf("SC_PAGE_SIZE")

    def send(self, number):
        """Send a signal, if it still runs."""
        if self.alive:
            self.process.send_signal(number)

    def wait(self, timeout=30.0):
        """The exit status (negative: the signal that ended it). Raises subprocess.TimeoutExpired."""
        return self.process.wait(timeout)

    def end(self):
        """End it, more and more firmly."""
        for number in (signal.SIGCONT, signal.SIGTERM, signal.SIGKILL):
            self.send(number)
            try:
                return self.wait(20.0 if number == signal.SIGTERM else 0.01)
            except subprocess.TimeoutExpired:
                continue
        return self.wait()


def _broken_pipe():
    reading, writing = os.pipe()
    os.close(reading)
    return os.fdopen(writing, "wb")


def _limit_files(size):
    # Beyond the limit the kernel would kill the process; ignored, the write fails as on a full disk.
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))


def _yaml(value):
    return f'"{value}"' if isinstance(value, str) else str(value).lower() if isinstance(value, bool) else repr(value)
