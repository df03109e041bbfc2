"""Our settings on one of the twelve cases: solver, step, sampling of the motion and mesh, by what the façade offers."""

from dataclasses import dataclass

from mooring_ros import mooring as facade

from .peer_runs import error, of_ours, transit
from .peer_search import period

RATE = 100.0  # Hz, at which the motion is sampled for references
IMPLICIT_STEPS = (35, 50, 70, 100, 140, 200, 400)  # in a period
EXPLICIT_PARTS = (0.06, 0.12, 0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0)  # of the default step
LONGEST_INTERVAL = 1.0 / 25.0  # between samples, of a period
FEWEST = 105  # samples to take an error from


@dataclass(frozen=True)
class OurSetting:
    """A run of ours."""

    solver: str
    dt: float | None  # s, None for the default
    rate: float  # Hz
    call: str  # "run" or "step"
    refinement: float
    error: float  # inf where it failed
    cost: float  # s/s
    failure: str = ""

    def label(self):
        """For a table."""
        step = "default step" if self.dt is None else f"{1e3 * self.dt:.3g} ms"
        return f"{self.solver}, {step}, samples at {self.rate:.3g} Hz"


def reference(case, refinement=1, fine=8):
    """Our converged run on a mesh: ``fine`` steps in a segment's transit time, motion sampled at 100 Hz."""
    return of_ours(case, "explicit", transit(case, refinement) / fine, max(RATE, 200.0 / period(case)), refinement)


def tried(case, known, solver, dt, rate, refinement=1, call="run", what="force"):
    """One setting, with its error against the run ``known``."""
    run = of_ours(case, solver, dt, rate, refinement, call)
    return OurSetting(solver, dt, rate, call, refinement, error(run, known, case.platform(), what), run.cost, run.failure)


def settings(case, known, refinement=1, what="force"):
    """All solvers with their steps, each with samples about as far apart as its steps and, where these are short, as 20 Hz."""
    found = []
    for solver in facade.SOLVERS:
        steps = [None]
        if solver == "explicit":
            limit = float(facade.Mooring(case.scene(refinement), solver=solver).step_limit.dt)
            steps += [limit * part for part in EXPLICIT_PARTS]
        elif solver == "implicit":
            steps += [period(case) / count for count in IMPLICIT_STEPS]
        for dt in steps:
            for rate in rates(case, dt):  # none where so long a step leaves too few samples
                found.append(tried(case, known, solver, dt, rate, refinement, what=what))
    return found


def rates(case, dt):
    """Rates (Hz) of samples for a step: whole numbers of steps apart, up to a 25th of a period."""
    motion = case.platform()
    longest = min(LONGEST_INTERVAL * period(case), (motion.end - motion.start) / FEWEST)
    if dt is None:
        return (20.0, 10.0, 5.0, 1.0 / longest)
    wholes = {int(x / dt) for x in (dt, 0.3 * longest, longest) if dt <= longest} - {0}
    return tuple(sorted({1.0 / (n * dt) for n in wholes}))
