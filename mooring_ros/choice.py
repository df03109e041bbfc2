"""Which solver `auto` takes, and why: from the scene alone, so that the same scene is solved alike on every machine, live and replayed."""

from .core import implicit
from .core.friction import NO_FRICTION

STEP = 20.0  # evaluations of the forces that an implicit step costs, its iterations included (docs/solvers.md)
WORTH = 5.0  # times the cost of the implicit solver that the explicit one, the more accurate of the two with axial waves, may have


def choose_solver(scene, model, limit, table, dt):
    """("explicit" or "implicit", why) for `scene` built as `model`, with the explicit solver's StepLimit and step table; `dt` (s) as given, or None."""
    own = min(cost / largest for _, largest, _, cost in table)
    step = implicit.step_limit(scene, limit).dt if dt is None else min(implicit.step_limit(scene, limit).dt, dt)
    other = STEP / step
    spent = f"{own:.0f} evaluations of the forces a simulated second in steps of {limit.dt:.3g} s ({limit.limited_by})"
    if own <= WORTH * other:
        return "explicit", f"explicit: {spent}; implicit steps of {step:.3g} s would cost as much as {other:.0f}"
    try:
        implicit.refuse(scene)
    except ValueError as reason:
        return "explicit", f"explicit: {spent}; {reason}"
    if model.ground.law != NO_FRICTION:
        return "explicit", f"explicit: {spent}; friction on the bed halves implicit steps too often"
    return "implicit", f"implicit: steps of {step:.3g} s cost as much as {other:.0f} evaluations of the forces a simulated second; explicit ones {spent}"
