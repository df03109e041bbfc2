"""Short forms of the coupled decay and of its delay: a floater at 1:50 and the real node, in lockstep over DDS."""

import dataclasses
import os

import numpy as np
import pytest

from benchmarks import decay_floater as floaters
from benchmarks import decay_runs as runs
from benchmarks.coupled_decay import SCALE, static_wrench, whole
from benchmarks.decay_measure import coordinate, measure

DOMAIN = 10 + os.getpid() % 190
HEAVE = dataclasses.replace(floaters.RELEASES["heave"], halves=2)
SURGE = floaters.Release(0, 0.5, 2)


@pytest.fixture(scope="module")
def body():
    return floaters.floater(static_wrench(SCALE), SCALE)


def test_period_damping_and_order_are_those_of_one_system(body):
    times, poses, twists = whole("heave", HEAVE.halves)
    reference = measure(times, poses, twists, HEAVE.axis, HEAVE.halves)
    seconds = floaters.duration("heave", SCALE, HEAVE.halves)
    errors = {}
    with runs.mooring_node(SCALE, domain=DOMAIN):
        found = runs.decay_of(body, HEAVE, SCALE, 0.01, seconds)
        for scheme in ("held", "extrapolated", "stiffness"):
            for step in (0.04, 0.08):
                at, coupled, _, _ = runs.decay(body, HEAVE, SCALE, step, seconds, scheme)
                within = at * np.sqrt(SCALE) <= times[-1]
                right = np.interp(at[within] * np.sqrt(SCALE), times, coordinate(poses, HEAVE.axis))
                errors[scheme, step] = np.abs(SCALE * coordinate(coupled[within], HEAVE.axis) - right).max()
    assert found.period * np.sqrt(SCALE) == pytest.approx(reference.period, rel=1e-4)
    assert found.damping == pytest.approx(reference.damping, abs=5e-5)
    order = {scheme: np.log2(errors[scheme, 0.08] / errors[scheme, 0.04]) for scheme, _ in errors}
    assert order["held"] == pytest.approx(1.0, abs=0.2)
    assert order["extrapolated"] == pytest.approx(2.0, abs=0.3) and order["stiffness"] == pytest.approx(2.0, abs=0.3)


def test_a_delay_costs_damping_as_predicted_and_prediction_gives_nine_tenths_back(body):
    delay, seconds = 0.02, floaters.duration("surge", SCALE, SURGE.halves)

    def decay(lag, compensated):
        with runs.mooring_node(SCALE, delay if compensated else 0.0, domain=DOMAIN):
            return runs.decay_of(body, SURGE, SCALE, 0.01, seconds, lag=lag)

    none, late, compensated = decay(0, False), decay(2, False), decay(2, True)
    lost = none.damping - late.damping
    assert lost == pytest.approx(np.pi / none.period * delay, rel=0.1)
    assert abs(none.damping - compensated.damping) < 0.1 * lost
