"""One evaluation of the equations of motion: the stages in their order. What a scene does not contain is skipped."""

from .bending import bend
from .cache import kernel, stage
from .clamps import turn_clamps_with_parts
from .ground import bed_under, contact
from .hulls import load_free_hulls
from .inertia import accelerations
from .packed import entry
from .points import carry_ends, gather, hold_prescribed, move_free_points
from .rigid import carry_parts, move_parts
from .ropes import SETTLED, rope_tensions
from .seabed import bed_contact
from .surface import wet_shares
from .tension import pull_on_nodes, segment_tensions
from .water import add_swell_loads, water_loads
from .waves import streams


@stage
def stretch_ropes(model, state, step):
    rope_tensions(
        model.ropes, step, state.position, model.inverse_length, model.damping, state.strain_rate, state.tension, state.creep, state.creep_rate
    )


@stage
def bend_lines(model, state, scratch):
    bend(
        model.bending,
        model.size,
        state.position,
        state.tangent,
        model.length,
        state.end_point,
        state.clamp_axis,
        scratch.bending,
        state.force,
        state.clamp_moment,
    )


@stage
def touch_ground(model, state, scratch, step):
    bed_under(model.ground, model.size, state.position, scratch.bed)
    contact(
        model.ground,
        model.size,
        step,
        state.position,
        state.velocity,
        state.tangent,
        model.bed_stiffness,
        model.bed_damping,
        state.inertia_normal,
        state.inertia_axial,
        state.slaved,
        scratch.bed,
        state.grip,
        state.expected,
        state.force,
        scratch.hold,
    )


@stage
def stream_past(model, state, time):
    """The water at the nodes at `time` (s)."""
    streams(model.sea, time, model.size, state.position, state.window_times, state.window, state.stream, state.swell)


@stage
def load_nodes(model, state, scratch, drag_time, bed_step, surfaced, flowing):
    """Forces on all nodes, and their inertia, from positions and velocities: see `evaluate`."""
    if model.rigid.mass.size > 0:
        carry_parts(model, state)
        turn_clamps_with_parts(model, state)
    carry_ends(model, state)
    if flowing:
        stream_past(model, state, state.settings[6])
    segment_tensions(model, state)
    if model.ropes.curve_first.size + model.ropes.kelvin_first.size > 0:
        stretch_ropes(model, state, SETTLED if state.settings[7] != 0.0 else bed_step)
    pull_on_nodes(model, state)
    if model.bending.stiffness.size > 0:
        bend_lines(model, state, scratch)
    if surfaced:
        wet_shares(model, state, scratch)
    water_loads(model, state, drag_time)
    if state.swell.shape[1] > 0:
        add_swell_loads(model, model.sea.gravity, state)
    if model.ground.on:
        touch_ground(model, state, scratch, bed_step)
    else:
        bed_contact(model, state, bed_step)
    if model.hulls.point.size > 0:
        load_free_hulls(model, state)


@stage
def evaluate(model, state, scratch, drag_time, bed_step, surfaced, flowing):
    """Forces and accelerations of all nodes and parts from positions and velocities; prescribed points must stand in place.

    `drag_time` (s): see `water_loads`; `bed_step` (s): see `bed_contact`. `surfaced`: some of the mooring may be above water. Otherwise `state.wet` must be ones.
    `flowing`: the water is that of the time in state.settings; otherwise that of the last evaluation.
    """
    load_nodes(model, state, scratch, drag_time, bed_step, surfaced, flowing)
    accelerations(model, state)
    if model.free_points.size + model.rigid.mass.size > 0:
        gather(model, state, scratch)
        move_free_points(model, state, scratch.load)
    if model.rigid.mass.size > 0:
        move_parts(model, state, scratch)
    hold_prescribed(model, state)


@kernel
def evaluate_in_place(model, state, scratch, drag_time, bed_step, surfaced):
    """`evaluate`, compiled once for all callers outside the stepping loop."""
    evaluate(model, state, scratch, drag_time, bed_step, surfaced, True)


evaluate_once = entry(evaluate_in_place)
