"""Load-strain curves and two-Kelvin ropes, one segment at a time, against closed forms."""


import numpy as np
import pytest
from scenes_in_code import line_type

from mooring_ros.core.ropes import SETTLED, build_ropes, rope_limits, rope_statics, rope_tensions, series_stiffness, settle_creep
from mooring_ros.core.schemes import LEAPFROG, stable_step
from mooring_ros.scene.description import LineType

LENGTH = 10.0  # m, unstretched
KNOTS = ((0.0, 0.0), (0.01, 1e5), (0.02, 4e5), (0.05, 5e5), (0.06, 9e5))
EA_S, EA_D, BA_S, BA_D = 1.424e8, 1.586e8, 4e9, 11e6
EA_1 = EA_D * EA_S / (EA_D - EA_S)
# (s, strain of the slow element, strain of both) under 1e6 N from t = 0 on, computed with 30 digits
CREEP = np.array(
    [
        (0.01, 2.49564845199e-06, 0.000849088786948),
        (0.05, 1.23917147967e-05, 0.003251294899),
        (0.1, 2.45693570464e-05, 0.00483858340296),
        (0.5, 0.000114714525164, 0.00641522001431),
        (1.0, 0.000211083321015, 0.00651625010949),
        (5.0, 0.000591732782469, 0.00689690302207),
        (10.0, 0.000695319921005, 0.0070004901606),
        (30.0, 0.000717281027028, 0.00702245126662),
    ]
)


def kelvin_type(slow_damping=BA_S, damping=BA_D, slow_stiffness=EA_1, stiffness=EA_D, mass=26.0):
    return LineType("rope", 0.2, mass, stiffness, damping, slow_stiffness=slow_stiffness, slow_damping=slow_damping)


def curve_type(knots=KNOTS, damping=0.0):
    steepest = max((b[1] - a[1]) / (b[0] - a[0]) for a, b in zip(knots, knots[1:]))
    return LineType("rope", 0.2, 26.0, steepest, damping, curve=knots)


class Segment:
    """One segment of a rope between nodes 1 and 2; node 0 and segment 0 belong to something else."""

    def __init__(self, kind, damping=0.0):
        self.ropes = build_ropes([(kind, 1, 1, LENGTH)])
        self.position, self.inverse_length = np.zeros((3, 4)), np.full(4, 1.0 / LENGTH)
        self.damping, self.length_rate = np.full(4, damping / LENGTH), np.zeros(4)
        self.tension, self.creep, self.creep_rate = np.full(4, 7.0), np.zeros(4), np.zeros(4)

    def __call__(self, strain, rate=0.0, creep=0.0, step=0.0):
        """(tension, rate of the slow strain) at a strain and its rate (1/s)."""
        direction = np.array([0.6, 0.0, 0.8])
        self.position[:, 1] = [3.0, -2.0, -40.0]
        self.position[:, 2] = self.position[:, 1] + direction * LENGTH * (1.0 + strain)
        self.length_rate[2], self.creep[2] = rate * LENGTH, creep
        rope_tensions(self.ropes, step, self.position, self.inverse_length, self.damping, self.length_rate, self.tension, self.creep, self.creep_rate)
        assert self.tension[0] == self.tension[1] == self.tension[3] == 7.0
        return self.tension[2], self.creep_rate[2]


def rate_under_load(segment, load, strain, creep, step):
    """Rate of the strain at which the segment carries `load`; its tension is affine in the rate while it is taut."""
    low, high = segment(strain, 0.5, creep, step)[0], segment(strain, 1.0, creep, step)[0]
    assert 0.0 < low < high
    return 0.5 + 0.5 * (load - low) / (high - low)


def creep_under_load(load, times, step):
    """(total, slow) strain at `times` (s) of a rope suddenly loaded, by two-stage steps made of Euler steps."""
    segment = Segment(kelvin_type())
    strain, creep, now, rows = 1e-12, 0.0, 0.0, []
    for time in times:
        count = max(int(np.ceil((time - now) / step)), 1)
        h = (time - now) / count
        for _ in range(count):
            first = (strain, creep)
            for _ in range(2):
                rate = rate_under_load(segment, load, strain, creep, h)
                creep += h * segment(strain, rate, creep, h)[1]
                strain += h * rate
            strain, creep = 0.5 * (first[0] + strain), 0.5 * (first[1] + creep)
        now = time
        rows.append((strain, creep))
    return np.array(rows)


def test_a_loaded_rope_creeps_as_two_kelvin_elements_do():
    """0.1 % of the total and of the slow strain, from the first hundredth of a second to rest."""
    rows = creep_under_load(1e6, CREEP[:, 0], 0.002)
    np.testing.assert_allclose(rows, CREEP[:, [2, 1]], rtol=1e-3)


def test_creep_is_of_second_order():
    """Half the step: a quarter of the error."""
    errors = [abs(creep_under_load(1e6, CREEP[1:2, 0], step)[0, 0] - CREEP[1, 2]) for step in (0.005, 0.0025)]
    assert 3.4 < errors[0] / errors[1] < 4.6


def relaxed(step, end):
    """Tension at `end` (s) of a rope held at 0.5 % strain, all of it in the fast element at first."""
    segment, creep = Segment(kelvin_type()), 0.0
    for _ in range(round(end / step)):
        creep += step * segment(0.005, 0.0, creep, step)[1]
    return segment(0.005, 0.0, creep, 0.0)[0]


@pytest.mark.parametrize("end", [0.5, 2.0, 5.0, 20.0])
def test_tension_of_a_rope_held_at_a_strain_relaxes(end):
    """T = E [EA_S + (T_0/E - EA_S) exp(-w t)], w = (EA_1 + EA_D)/(BA_1 + BA_D), within 0.1 %."""
    strain, w = 0.005, (EA_1 + EA_D) / (BA_S + BA_D)
    start = (BA_S * EA_D / (BA_S + BA_D)) * strain
    want = EA_S * strain + (start - EA_S * strain) * np.exp(-w * end)
    assert relaxed(0.01, end) == pytest.approx(want, rel=1e-3)


@pytest.mark.parametrize("step", [0.5, 10.0, 1e4, 1e9])
def test_steps_far_longer_than_the_slow_element_go_to_rest_without_swinging(step):
    """The tension falls from step to step and ends at EA_S times the strain, also when a step is a billion time constants."""
    segment, creep, tensions = Segment(kelvin_type()), 0.0, []
    for _ in range(max(5, round(40.0 / step))):
        tension, rate = segment(0.005, 0.0, creep, step)
        creep += step * rate
        tensions.append(tension)
    assert (np.diff(tensions) <= 1e-9 * tensions[0]).all()
    assert tensions[-1] == pytest.approx(EA_S * 0.005, rel=1e-4)
    assert creep == pytest.approx(EA_S * 0.005 / EA_1, rel=1e-3)


@pytest.mark.parametrize("period", [0.05, 0.5, 5.0, 30.0, 300.0])
def test_storage_and_loss_modulus(period):
    """In a steady oscillation, E' + i E'' = 1/(1/(EA_1 + i w BA_1) + 1/(EA_D + i w BA_D)), each within 0.2 % of its magnitude."""
    segment, w = Segment(kelvin_type()), 2.0 * np.pi / period
    slow, fast = EA_1 + 1j * w * BA_S, EA_D + 1j * w * BA_D
    modulus = slow * fast / (slow + fast)
    mean, amplitude, count = 0.006, 0.0005, 4000
    h = period / count
    creep = EA_S * mean / EA_1 + (amplitude * modulus / slow).real  # of the steady oscillation at t = 0
    tensions = []
    for k in range(count):
        first = creep
        for stage in (0, 1):  # two Euler steps and the mean with the start: second order
            phase = w * h * (k + stage)
            tension, rate = segment(mean + amplitude * np.cos(phase), -amplitude * w * np.sin(phase), creep, h)
            if stage == 0:
                tensions.append(segment(mean + amplitude * np.cos(phase), -amplitude * w * np.sin(phase), creep, 0.0)[0])
            creep += h * rate
        creep = 0.5 * (first + creep)
    got = 2.0 / count * np.sum(np.array(tensions) * np.exp(-1j * w * h * np.arange(count))) / amplitude
    assert abs(got.real - modulus.real) < 2e-3 * abs(modulus)
    assert abs(got.imag - modulus.imag) < 2e-3 * abs(modulus)
    assert got.imag > 0.0


@pytest.mark.parametrize("seed", range(5))
def test_a_closed_cycle_costs_energy(seed):
    """Work done on a rope by any periodic strain, slack in between, is positive once the cycle has become steady."""
    rng = np.random.default_rng(seed)
    segment, creep = Segment(kelvin_type(slow_damping=2e9)), 0.0
    amplitudes, phases = 0.004 * rng.random(3), 2.0 * np.pi * rng.random(3)
    count, h = 2000, 0.005
    w = 2.0 * np.pi / (count * h) * np.arange(1, 4)
    for cycle in range(4):
        work, slack = 0.0, 0
        for k in range(count):
            angle = w * k * h + phases
            strain, rate = 0.002 + amplitudes @ np.cos(angle), -amplitudes * w @ np.sin(angle)
            tension, creep_rate = segment(strain, rate, creep, h)
            creep += h * creep_rate
            work += tension * rate * h
            slack += tension == 0.0
    assert slack > 0
    assert work > 0.0
    assert creep >= 0.0


@pytest.mark.parametrize("step", [0.0, 0.01, 10.0])
def test_a_slack_rope_carries_nothing_and_its_slow_strain_recovers_by_itself(step):
    """d creep/dt = -EA_1 creep/BA_1, however the ends move."""
    segment = Segment(kelvin_type())
    for strain in (-0.1, 0.0, 0.0005 if step < 1.0 else -0.0005):
        for rate in (-1.0, 0.0, 1.0):
            assert segment(strain, rate, 0.001, step)[0] == 0.0
    tension, creep_rate = segment(-0.1, 0.0, 0.001, step)
    if step < 1.0:
        assert creep_rate == pytest.approx(-0.001 * EA_1 / BA_S, rel=1e-2)
    assert -0.001 <= step * creep_rate <= 0.0


def test_a_rope_never_pushes():
    """Random strains, rates and slow strains: no tension below zero, no NaN."""
    rng, segment = np.random.default_rng(2), Segment(kelvin_type())
    pulled = 0
    for _ in range(2000):
        step = rng.choice([0.0, 1e-3, 1.0, 1e6, SETTLED])
        tension, rate = segment(rng.normal(0.0, 0.01), rng.normal(0.0, 0.1), abs(rng.normal(0.0, 1e-3)), step)
        assert tension >= 0.0
        assert np.isfinite([tension, rate]).all()
        pulled += tension > 0.0
    assert 200 < pulled < 1800


def euler_matrix(segment, h, mass_factor, leapfrog):
    """Matrix of a step (strain, its rate, slow strain) of one axial mode: d rate/dt = -mass_factor T."""
    at = lambda strain, rate, creep: np.array(segment(strain, rate, creep, h))  # noqa: E731
    rest = at(1.0, 0.0, 0.0)
    tension, rate = (np.array([at(1.001, 0.0, 0.0), at(1.0, 1e-3, 0.0), at(1.0, 0.0, 1e-3)]) - rest).T / 1e-3
    matrix = np.eye(3)
    if leapfrog:
        matrix[1] -= h * mass_factor * tension
        matrix[0] += h * matrix[1]
    else:
        matrix[0, 1] += h
        matrix[1] -= h * mass_factor * tension
    matrix[2] += h * rate
    return matrix


@pytest.mark.parametrize("zeta", [0.003, 0.1, 0.5, 1.0, 3.0])
@pytest.mark.parametrize("leapfrog", [False, True])
def test_the_slow_element_does_not_limit_the_step(zeta, leapfrog):
    """Modes of a line of ropes, step at 0.95 of the limit of `rope_limits`: none grows, whatever the slow element's constants are."""
    mass = 26.0
    omega = 2.0 / LENGTH * np.sqrt(EA_D / mass)
    for ratio in (0.01, 0.3, 1.0, 10.0, 1000.0):
        for time_constant in (0.0, 1.0 / omega, 10.0 / omega, 1e3 / omega):
            kind = kelvin_type(time_constant * ratio * EA_D, 2.0 * zeta * EA_D / omega, ratio * EA_D, mass=mass)
            stiffness, damping = rope_limits(kind, LENGTH)
            assert (stiffness, damping) == (EA_D, kind.damping)
            h = 0.95 * stable_step(LEAPFROG if leapfrog else 2, omega, 0.5 * omega * damping / stiffness)
            segment = Segment(kind)
            for share in np.linspace(0.05, 1.0, 12):
                matrix = euler_matrix(segment, h, (share * omega) ** 2 / EA_D, leapfrog)
                assert np.abs(np.linalg.eigvals(matrix)).max() <= 1.0 + 1e-6, (ratio, time_constant * omega, share)


def test_a_curve_is_interpolated_and_goes_on_as_its_last_piece():
    segment = Segment(curve_type())
    strains = np.linspace(1e-4, 0.06, 601)
    want = np.interp(strains, *np.array(KNOTS).T)
    np.testing.assert_allclose([segment(strain)[0] for strain in strains], want, rtol=1e-9, atol=1e-6)
    assert segment(0.08)[0] == pytest.approx(9e5 + 0.02 * 4e7, rel=1e-9)
    assert segment(0.0)[0] == segment(-0.3)[0] == 0.0


def test_damping_of_a_curve_acts_while_it_pulls():
    """T + BA d strain/dt, never negative, and nothing when slack."""
    segment = Segment(curve_type(), damping=2e6)
    assert segment(0.015, 0.1)[0] == pytest.approx(2.5e5 + 2e5, rel=1e-9)
    assert segment(0.015, -0.1)[0] == pytest.approx(0.5e5, rel=1e-9)
    assert segment(0.015, -1.0)[0] == 0.0
    assert segment(-1e-6, 5.0)[0] == 0.0


def test_curves_of_several_lines_do_not_mix():
    """Two curves of different length and a linear line between them: each its own tension, the linear one untouched."""
    other = ((0.0, 0.0), (0.1, 3e5))
    lines = [(curve_type(), 0, 2, 5.0), (line_type(), 3, 2, 5.0), (curve_type(other), 6, 2, 8.0)]
    ropes, n = build_ropes(lines), 10
    length = np.array([1.0, 5.0, 5.0, 1.0, 5.0, 5.0, 1.0, 8.0, 8.0, 1.0])
    position = np.zeros((3, n))
    position[1] = np.cumsum(1.03 * length)
    tension, creep = np.full(n, 3.0), np.zeros(n)
    rope_tensions(ropes, 0.01, position, 1.0 / length, np.zeros(n), np.zeros(n), tension, creep, creep.copy())
    first, second = np.interp(0.03, *np.array(KNOTS).T), 0.03 * 3e6
    np.testing.assert_allclose(tension, [3.0, first, first, 3.0, 3.0, 3.0, 3.0, second, second, 3.0], rtol=1e-9)


@pytest.mark.parametrize("kind", [curve_type(), kelvin_type()], ids=["curve", "kelvin"])
def test_statics_are_the_law_at_rest(kind):
    """Strain from tension by the linear pieces, and tension from strain by the law: the same; and the slow strain rests there."""
    segment = Segment(kind)
    stiffness, slack, creep = np.zeros(4), np.zeros(4), np.zeros(4)
    for load in (1.0, 9e4, 2e5, 4.5e5, 7e5, 3e6):
        tension = np.full(4, load)
        rope_statics(segment.ropes, tension, stiffness, slack)
        settle_creep(segment.ropes, tension, creep)
        strain = slack[2] + load / stiffness[2]
        assert stiffness[1] == stiffness[3] == 0.0
        assert segment(strain, 0.0, 0.5, SETTLED)[0] == pytest.approx(load, rel=1e-6)
        tension, rate = segment(strain, 0.0, creep[2], 0.01)
        assert tension == pytest.approx(load, rel=1e-6)
        assert abs(rate) < 1e-9
    assert segment(0.0, 0.0, 0.5, SETTLED)[0] == 0.0


def test_damping_as_a_fraction_of_critical():
    """-zeta: BA = zeta l sqrt(EA m); EA is the secant to a curve's last row, EA_S for the slow element, as in MoorDyn."""
    assert rope_limits(curve_type(damping=-0.5), LENGTH) == pytest.approx((4e7, 0.5 * LENGTH * np.sqrt(1.5e7 * 26.0)))
    kind = kelvin_type(slow_damping=-200.0)
    assert build_ropes([(kind, 0, 3, LENGTH)]).slow_damping[0] == pytest.approx(200.0 * LENGTH * np.sqrt(EA_S * 26.0))
    assert series_stiffness(kind) == pytest.approx(EA_S)


def test_no_ropes_no_rows():
    ropes = build_ropes([(line_type(), 0, 5, 10.0)])
    assert all(array.size == 0 for name, array in zip(ropes._fields, ropes) if name != "curve_row")
