"""A setting of the trade: what the façade, the node and `mooring replay` are given."""

import math
import shlex
from dataclasses import asdict, dataclass


@dataclass(frozen=True)
class Setting:
    """Arguments of `Mooring` beside the scene; None and 1.0 leave the choice to the scene."""

    fidelity: str
    solver: str = "auto"
    dt: float | None = None  # s
    segments: int | None = None  # of every line
    refine: float = 1.0  # on the file's segments of each line

    def arguments(self):
        """Keyword arguments of `Mooring`."""
        return asdict(self)

    @property
    def method(self):
        """Fidelity and, where there is a choice, solver."""
        return f"dynamic, {self.solver}" if self.fidelity == "dynamic" else self.fidelity

    @property
    def mesh(self):
        if self.segments is not None:
            return str(self.segments)
        return "file" if self.refine == 1.0 else f"file × {self.refine:g}"

    @property
    def step(self):
        if self.fidelity != "dynamic":
            return "–"
        return "auto" if self.dt is None else f"{1e3 * self.dt:.4g} ms"

    def replay_command(self, scene, motion, chosen=()):
        """The `mooring replay` that computes with this setting. chosen: words that choose the motion in its file."""
        words = ["mooring", "replay", str(scene), str(motion), *chosen, "-o", "out.mcap", "--fidelity", self.fidelity]
        if self.fidelity == "dynamic":
            words += ["--solver", self.solver]
        if self.dt is not None:
            words += ["--dt", repr(self.dt)]
        if self.segments is not None:
            words += ["--segments", str(self.segments)]
        elif self.refine != 1.0:
            words += ["--refine", repr(self.refine)]
        return " ".join(shlex.quote(word) for word in words)


class Meshes:
    """The meshes of a scene: a factor on the file's segments, as a setting says it."""

    def __init__(self, scene):
        self._counts = [line.segments for line in scene.lines]
        self._even = len(set(self._counts)) == 1
        self.mean = sum(self._counts) / len(self._counts)

    def nearest(self, factor):
        """The factor nearest to `factor` that a setting can say."""
        if self._even:
            return max(1, round(factor * self._counts[0])) / self._counts[0]
        return float(f"{max(factor, 0.5 / max(self._counts)):.3g}")

    def arguments(self, factor):
        """{"segments"} or {"refine"} for a factor that `nearest` gave."""
        return {"segments": round(factor * self._counts[0])} if self._even else {"refine": factor}

    def count(self, factor):
        """Segments of all lines."""
        return sum(max(1, round(factor * count)) for count in self._counts)


def step_of(interval, steps):
    """dt (s), short to write, that takes `steps` steps in a sample interval (s)."""
    exact = interval / steps
    scale = 10.0 ** (3 - math.floor(math.log10(exact)))
    return float(f"{math.ceil(exact * scale * (1.0 - 1e-9)) / scale:.6g}")


def steps_in(interval, dt):
    """Steps that a largest step `dt` (s) makes of a sample interval (s), as the core counts them."""
    return max(1, math.ceil(interval / dt - 1e-9))
