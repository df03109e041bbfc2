"""Kernels that do one part of a step many times over, for those who time it. What they leave in the state is of no use."""

from numba.core import types

from .address import address_of, caller
from .cache import kernel
from .forces import evaluate_in_place, stream_past
from .inertia import accelerations
from .model import Model, Scratch, State
from .packed import Fields
from .points import carry_ends, hold_prescribed
from .seabed import bed_contact
from .tension import pull_on_nodes, segment_tensions
from .water import water_loads

_EVALUATE = types.none, (Fields(Model), Fields(State), Fields(Scratch), types.float64, types.float64, types.boolean)
_evaluate_at = caller(*_EVALUATE)


@kernel
def _repeat_evaluation(address, model, state, scratch, drag_time, bed_step, surfaced, count):
    for _ in range(count):
        _evaluate_at(address, model, state, scratch, drag_time, bed_step, surfaced)


def repeat_evaluation(model, state, scratch, surfaced, count):
    """Forces and accelerations `count` times, as a step evaluates them with the settings in the state."""
    for known in (model, state, scratch):
        known.address  # noqa: B018  (its layout must be known before anything is compiled)
    address = address_of(evaluate_in_place, *_EVALUATE)
    _repeat_evaluation(address, model, state, scratch, float(state.settings[0]), float(state.settings[1]), surfaced, count)


@kernel
def repeat_tension(model, state, count):
    for _ in range(count):
        segment_tensions(model, state)
        pull_on_nodes(model, state)


@kernel
def repeat_water(model, state, count):
    for _ in range(count):
        water_loads(model, state, 0.0)


@kernel
def repeat_bed(model, state, count):
    for _ in range(count):
        bed_contact(model, state, 0.0)


@kernel
def repeat_inertia(model, state, count):
    for _ in range(count):
        carry_ends(model, state)
        accelerations(model, state)
        hold_prescribed(model, state)


@kernel
def repeat_streams(model, state, count):
    for _ in range(count):
        stream_past(model, state, state.settings[6])
