"""The peers' best settings: MoorDyn's scheme and largest step, CableDyn's mesh and step, that stay within an error. Each run is kept (`peer_cache`)."""

from dataclasses import dataclass

from .peer_runs import error, of_cabledyn, of_moordyn, transit

# MoorDyn's schemes, with the step as a multiple of a segment's axial transit time from which the search for the largest one begins
SCHEMES = {
    "Euler": 0.4, "Heun": 0.4, "RK2": 0.6, "RK4": 0.9, "ACA3": 0.6, "Midpoint3": 1.1, "Midpoint4": 1.6, "Midpoint5": 2.1, "Midpoint6": 2.6, "Midpoint8": 3.2, "BEuler4": 1.2,
}  # fmt: skip
FEW = ("Euler", "RK2", "Midpoint4", "Midpoint6")
CLOSE = 1.07  # the search ends when a step that will not do is this much larger than one that does
WEAK = 0.3  # of critical damping: less
SMALLEST = 0.15  # transit times: below, a scheme is given up
MOORDYN_MESHES = (0.5, 1.0, 2.0)
NEAR_LARGEST = {"Euler": 0.6, "RK2": 0.95, "RK4": 1.2, "Midpoint4": 2.4}  # steps in transit times
SHORTER, TRIES = 0.7, 5  # until it runs
MESHES = (0.5, 0.7, 1.0, 1.4)  # CableDyn's elements for each segment of the case
STEPS_IN_A_PERIOD = (25, 50, 100, 200)
PERIOD = 10.0  # s, of motions without one


@dataclass(frozen=True)
class Setting:
    """A run of a peer."""

    name: str  # scheme or mesh
    dt: float  # s
    refinement: float
    error: float  # inf where it failed
    cost: float  # s/s
    failure: str = ""

    def label(self):
        """For a table."""
        step = f"{1e3 * self.dt:.3g} ms"
        return f"{self.name}, {step}" if self.name else step


def moordyn_reference(case, refinement=1, fine=10):
    """Its converged run on a mesh, ``fine`` steps in a segment's transit time: RK2, but RK4 where little damping makes that grow."""
    damped = all(n.type.damping < -WEAK or n.type.damping > 0.0 for n in case.scene().lines)
    return of_moordyn(case, "RK2" if damped else "RK4", rounded(transit(case, refinement) / fine), refinement)


def rounded(step):
    """A step (s) of three digits, as a user would write it."""
    return float(f"{step:.3g}")


def moordyn_settings(case, reference, allowed, schemes=tuple(SCHEMES)):
    """Every run of a search for each scheme's largest step on the case's mesh with an error of the tension against ``reference`` of at most ``allowed``."""
    motion, unit = case.platform(), transit(case)
    tried = {}

    def good(scheme, multiple):
        dt = rounded(multiple * unit)
        if (scheme, dt) not in tried:
            run = of_moordyn(case, scheme, dt)
            tried[scheme, dt] = Setting(scheme, dt, 1.0, error(run, reference, motion, "tension"), run.cost, run.failure)
        return tried[scheme, dt].error <= allowed

    for scheme in schemes:
        low, high = SCHEMES[scheme], None
        while not good(scheme, low) and low > SMALLEST:
            low, high = 0.6 * low, low
        if low <= SMALLEST:
            continue
        while high is None:
            if good(scheme, 1.5 * low):
                low *= 1.5
            else:
                high = 1.5 * low
        while high > CLOSE * low:
            middle = (low * high) ** 0.5
            low, high = (middle, high) if good(scheme, middle) else (low, middle)
    return list(tried.values())


def moordyn_grid(case, reference, measure=error, finest=MOORDYN_MESHES[-1]):
    """Runs over meshes up to ``finest`` and schemes: with the largest step that runs of a few, and half of that; errors in space and time."""
    motion, tried = case.platform(), []

    def result(scheme, mesh, multiple):
        dt = rounded(multiple * transit(case, mesh))
        run = of_moordyn(case, scheme, dt, mesh)
        tried.append(Setting(f"{scheme}, mesh x {mesh:g}", dt, mesh, measure(run, reference, motion), run.cost, run.failure))
        return tried[-1].error < 1.0

    for mesh in (m for m in MOORDYN_MESHES if m <= finest):
        for scheme, multiple in NEAR_LARGEST.items():
            multiples = [multiple * SHORTER**k for k in range(TRIES)]
            works = next((m for m in multiples if result(scheme, mesh, m)), None)
            if works is not None:
                result(scheme, mesh, 0.5 * works)
    return tried


def cabledyn_reference(case, refinement=4, steps=800):
    """Its run converged in space and time."""
    return of_cabledyn(case, rounded(period(case) / steps), refinement)


def cabledyn_settings(case, reference, measure=error, meshes=MESHES, steps=STEPS_IN_A_PERIOD):
    """Every run of a search over meshes and steps; from a mesh's finest step that does no better than the next coarser one the search goes on."""
    motion, tried = case.platform(), []
    for mesh in meshes:
        row = []
        for count in steps:
            run = of_cabledyn(case, rounded(period(case) / count), mesh)
            found = Setting(f"mesh x {mesh:g}", rounded(period(case) / count), mesh, measure(run, reference, motion), run.cost, run.failure)
            row.append(found)
            if len(row) > 2 and 0.9 * row[-2].error < found.error < 1.0:
                break
        tried += row
    return tried


def period(case):
    """Of the motion (s)."""
    return getattr(case.platform(), "period", PERIOD)


def best(settings, allowed):
    """The cheapest within the error; None where there is none."""
    good = [s for s in settings if s.error <= allowed]
    return min(good, key=lambda s: s.cost) if good else None


def front(settings):
    """Those that no other is both cheaper and more accurate than, from the cheapest."""
    chosen, least = [], float("inf")
    for s in sorted((s for s in settings if s.error < float("inf")), key=lambda s: s.cost):
        if s.error < least:
            chosen.append(s)
            least = s.error
    return chosen
