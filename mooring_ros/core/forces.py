"""One evaluation of the equations of motion: the stages in their order. What a scene does not contain is skipped."""

from .cache import kernel, stage
from .inertia import accelerations
from .points import carry_ends, gather, hold_prescribed, move_free_points
from .rigid import carry_parts, move_parts
from .ropes import SETTLED, rope_tensions
from .seabed import bed_contact
from .surface import wet_shares
from .tension import pull_on_nodes, segment_tensions
from .water import water_loads


@stage
def evaluate(model, state, scratch, drag_time, bed_step, surfaced):
    """Forces and accelerations of all nodes and parts from positions and velocities; prescribed points must stand in place.

    `drag_time` (s): see `water_loads`; `bed_step` (s): see `bed_contact`. `surfaced`: some of the mooring may be above water. Otherwise `state.wet` must be ones.
    """
    if model.rigid.mass.size > 0:
        carry_parts(model, state)
    carry_ends(model, state)
    segment_tensions(model, state)
    if model.ropes.curve_first.size + model.ropes.kelvin_first.size > 0:
        rope_step = SETTLED if state.settings[7] != 0.0 else bed_step
        rope_tensions(
            model.ropes, rope_step, state.position, model.inverse_length, model.damping, state.strain_rate, state.tension, state.creep, state.creep_rate
        )
    pull_on_nodes(model, state)
    if surfaced:
        wet_shares(model, state, scratch)
    water_loads(model, state, drag_time)
    bed_contact(model, state, bed_step)
    accelerations(model, state)
    if model.free_points.size + model.rigid.mass.size > 0:
        gather(model, state, scratch.load)
        move_free_points(model, state, scratch.load)
    if model.rigid.mass.size > 0:
        move_parts(model, state, scratch)
    hold_prescribed(model, state)


@kernel
def evaluate_once(model, state, scratch, drag_time, bed_step, surfaced):
    """`evaluate`, compiled once for all callers outside the stepping loop."""
    evaluate(model, state, scratch, drag_time, bed_step, surfaced)
