"""What `mooring status` knows of a running node, without ROS and without a clock of its own: times are s of a steady clock, handed in."""

from collections import defaultdict, deque

PREFIX = "mooring: "
WINDOW = 5.0  # s over which rates are taken
SILENT = 3.0  # s without diagnostics, which come once a second, after which a node counts as silent


class Rate:
    """Messages a second over the last WINDOW."""

    def __init__(self):
        self._arrivals = deque()

    def add(self, now):
        self._arrivals.append(now)
        self._forget(now)

    def hertz(self, now):
        """None before there are two."""
        self._forget(now)
        if len(self._arrivals) < 2:
            return None
        return (len(self._arrivals) - 1) / max(self._arrivals[-1] - self._arrivals[0], 1e-9)

    def age(self, now):
        """s since the last, None where none is remembered."""
        return now - self._arrivals[-1] if self._arrivals else None

    def _forget(self, now):
        while len(self._arrivals) > 1 and now - self._arrivals[0] > WINDOW:
            self._arrivals.popleft()


class View:
    """Takes the node's messages and gives one picture. nodes: names of all mooring nodes that /diagnostics has told of."""

    def __init__(self, node=None):
        self.node = node
        self.nodes = set()
        self._statuses, self._wrenches, self._lines = {}, {}, {}
        self._told = None
        self._rates = defaultdict(Rate)     # of wrenches, by platform
        self._highest = {}

    def take_statuses(self, now, statuses):
        """statuses: (name, level 0 to 3, message, hardware id, dict of values) of one message on /diagnostics."""
        own = [status for status in statuses if status[0].startswith(PREFIX)]
        self.nodes |= {hardware for *_, hardware, _ in own}
        self.node = self.node or (min(self.nodes) if self.nodes else None)
        for name, level, message, hardware, values in own:
            if hardware == self.node:
                self._told = now
                self._statuses[name.removeprefix(PREFIX)] = {"level": level, "message": message, "values": values}

    def take_wrench(self, now, stamp, frame, force, torque, platform=""):
        """stamp: s; force, torque: (3,) N, N·m; platform: its name where there are several."""
        self._rates[platform].add(now)
        self._wrenches[platform] = {"stamp": stamp, "frame": frame, "force": list(force), "torque": list(torque)}

    def take_lines(self, now, names, lengths, rates, tensions):
        """Of ~/lines: m, m/s, N."""
        self._lines = {name: (length, rate, tension) for name, length, rate, tension in zip(names, lengths, rates, tensions)}
        for name, tension in zip(names, tensions):
            self._highest[name] = max(self._highest.get(name, tension), tension)

    @property
    def heard(self):
        """Whether the node has told anything."""
        return bool(self._statuses)

    def picture(self, now):
        """All of it as an object for JSON; numbers that are not known are null."""
        wrenches = {name: {**wrench, "rate": self._rates[name].hertz(now), "age": self._rates[name].age(now)}
                    for name, wrench in self._wrenches.items()}
        since = None if self._told is None else now - self._told
        return {
            "node": self.node,
            "silent": since is None or since > SILENT,
            "since_diagnostics": since,
            "level": max((status["level"] for status in self._statuses.values()), default=None),
            "statuses": self._statuses,
            "wrench": wrenches.pop("", None),
            "platforms": wrenches,
            "lines": [{"name": name, "length": length, "length_rate": rate, "fairlead_tension": tension, "highest_tension": self._highest[name]}
                      for name, (length, rate, tension) in self._lines.items()],
        }
