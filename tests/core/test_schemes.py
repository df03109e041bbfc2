"""Explicit schemes: growth of single modes, order in the step, limits of the step, energy through slack."""

import numpy as np
import pytest
from scenes_in_code import COUPLED, FIXED, FREE, HERE, SCENES, anchored, line_type, refresh, scene, surge_heave, table, vacuum

from mooring_ros import Mooring
from mooring_ros.core.schemes import AXIAL, LEAPFROG, SSP, polynomial, stable_step, step_table

LENGTH, MASS, STIFFNESS, SEGMENTS = 50.0, 4.0, 1e5, 10
CELERITY = np.sqrt(STIFFNESS / MASS)
OMEGA = 2.0 * SEGMENTS / LENGTH * CELERITY


def use_only(mooring, scheme, step):
    """Let the mooring take steps of `scheme` of exactly `step` (s)."""
    mooring._table = step_table({scheme: np.inf}, step)


def taut_string(zeta):
    kind = line_type(mass=MASS, stiffness=STIFFNESS, damping=-zeta)
    mooring = Mooring(vacuum([(FIXED, (0, 0, -50)), (FIXED, (1.01 * LENGTH, 0, -50))], [(kind, 1, 2, LENGTH, SEGMENTS)]))
    mooring.settle(HERE)
    return mooring


def growth_of_the_stiffest_mode(scheme, zeta, step):
    """Largest eigenvalue of the map that one step is for the highest axial mode, and that mode's frequency (rad/s).

    The map is measured from a displacement and from a velocity so small that no guard sees them.
    """
    mooring = taut_string(zeta)
    use_only(mooring, scheme, step)
    rest = mooring.snapshot()
    inner = slice(0, SEGMENTS + 1)
    shape = np.sin((SEGMENTS - 1) * np.pi * np.arange(SEGMENTS + 1) / SEGMENTS)
    omega = OMEGA * np.sin((SEGMENTS - 1) * np.pi / (2 * SEGMENTS))
    size = 1e-7
    columns = []
    for moved, pushed in ((1.0, 0.0), (0.0, 1.0)):
        mooring.restore(rest)
        state = mooring._state
        state.position[0, inner] += size * moved * shape
        state.velocity[0, inner] = size * pushed * omega * shape
        refresh(mooring)
        mooring.step(step, HERE, np.zeros(6))
        x = (state.position[0, inner] - rest.state.position[0, inner]) @ shape
        columns.append(np.array([x, state.velocity[0, inner] @ shape / omega]) / (size * shape @ shape))
    return np.abs(np.linalg.eigvals(np.array(columns).T)).max(), omega


def largest_eigenvalue(scheme, zeta, omega, step):
    """Growth a step that the scheme's theory gives a mode lambda^2 + 2 zeta_m omega lambda + omega^2 = 0, zeta_m = zeta omega/OMEGA."""
    damping = zeta * omega / OMEGA
    if scheme == LEAPFROG:
        h, c, k = step, 2.0 * damping * omega, omega**2
        matrix = np.array([[1.0 - h * h * k, h - h * h * c], [-h * k, 1.0 - h * c]])
        return np.abs(np.linalg.eigvals(matrix)).max()
    roots = np.roots([1.0, 2.0 * damping * omega, omega**2])
    return np.abs(np.polynomial.polynomial.polyval(step * roots, polynomial(scheme))).max()


@pytest.mark.parametrize(("scheme", "zeta"), [(s, z) for s in (LEAPFROG, *SSP) for z in (0.0, 0.3, 1.0, 3.0) if stable_step(s, OMEGA, z) > 0.0])
@pytest.mark.parametrize("share", [0.5, 1.0, 1.3])
def test_stiffest_mode_grows_as_the_theory_says(scheme, zeta, share):
    """Growth a step at half, at the limit and beyond, as of the stability polynomial to 1e-5; none up to the stated limit."""
    limit = stable_step(scheme, OMEGA, zeta)
    growth, omega = growth_of_the_stiffest_mode(scheme, zeta, share * limit)
    assert growth == pytest.approx(largest_eigenvalue(scheme, zeta, omega, share * limit), abs=1e-5 * max(growth, 1.0))
    if share <= 1.0:
        assert growth < 1.0 + 1e-5
    elif scheme == LEAPFROG or zeta >= 1.0:
        assert growth > 1.05


def test_no_step_of_the_many_stage_schemes_is_called_stable_without_damping():
    assert all(stable_step(scheme, OMEGA, 0.0) == 0.0 for scheme in SSP)


@pytest.mark.parametrize("zeta", [0.0, 0.1, 0.5, 1.0, 2.0])
def test_every_mode_is_stable_at_the_limit(zeta):
    """Theory only: all modes of the line, weaker ones too, for every scheme at its stated limit; next to the imaginary axis the growth of
    the SSP schemes stays below (h omega)^4/64 a step."""
    for scheme in (LEAPFROG, *SSP):
        limit = stable_step(scheme, OMEGA, zeta)
        for omega in OMEGA * np.linspace(0.001, 1.0, 400):
            if limit > 0.0:
                allowed = 1e-6 + (0.0 if scheme == LEAPFROG else (limit * omega) ** 4 / 64.0 if omega < 0.1 * OMEGA else 0.0)
                assert largest_eigenvalue(scheme, zeta, omega, limit) <= 1.0 + allowed


@pytest.mark.parametrize("row", table("time_step_limits.csv"), ids=lambda row: row["case"])
def test_axial_limit_is_that_of_the_table(row):
    """time_step_limits.csv: 2/omega_axial for a line with the row's celerity and segment length, 1e-4. Its last limit is the smallest of
    all effects; where bed or bending is smaller there, this one is larger."""
    length, celerity = float(row["seg_len_m"]), float(row["c_axial_m_s"])
    kind = line_type(mass=20.0, stiffness=20.0 * celerity**2, drag=1.0)
    limit = Mooring(anchored(kind, (0, 0, -100), (9.5 * length, 0, -95), 10.0 * length, 10)).step_limit
    assert limit.limits["axial"] == pytest.approx(2.0 / float(row["omega_axial_rad_s"]), rel=1e-4)
    assert limit.limits["axial"] >= float(row["dt_max_leapfrog_s(2/omega_max)"]) * (1.0 - 1e-4)


@pytest.mark.parametrize(
    ("file", "case"),
    [("oc4.txt", "OC4 DeepCwind chain l=41.8m (20 seg)"), ("oc3_spar.txt", "OC3 Hywind l=45m (20 seg)")]
    + [("volturnus_s_chain.txt", "VolturnUS-S chain l=17m (50 seg)")],
)
def test_limits_of_the_scenes_are_those_of_the_table(file, case):
    """time_step_limits.csv: axial within 1e-4; bed within 7 % below (the table counts the water's added mass with the chain's)."""
    row = next(row for row in table("time_step_limits.csv") if row["case"] == case)
    limits = Mooring(SCENES / file).step_limit.limits
    assert limits["axial"] == pytest.approx(2.0 / float(row["omega_axial_rad_s"]), rel=1e-4)
    bed = 2.0 / float(row["omega_seabed_rad_s"])
    assert 0.93 * bed < limits["bed stiffness"] <= bed


def smooth_line(zeta):
    kind = line_type(0.1, 30.0, 2e6, -zeta, drag=1.2, added=1.0, drag_axial=0.1, added_axial=0.1)
    return anchored(kind, (0, 0, -80), (80, 0, -10), 110.0, 10, depth=200.0)


@pytest.mark.parametrize(("scheme", "zeta", "order"), [(AXIAL, 0.0, 2.0), (AXIAL, 0.5, 2.0), (LEAPFROG, 0.0, 2.0), (2, 0.5, 2.0), (4, 0.5, 2.0), (8, 0.5, 2.0)])
def test_order_of_the_error_in_the_step(scheme, zeta, order):
    """Positions after 4 s of a smooth motion in water against steps 16 times finer: second order."""
    times = np.arange(1, 41) * 0.1
    poses, twists = surge_heave(times, surge=1.0, heave=0.7, period=4.0)
    results = {}
    base = 0.1 / np.ceil(0.1 / (0.4 * stable_step(LEAPFROG if scheme == AXIAL else scheme, 2.0 / 11.0 * np.sqrt(2e6 / 30.0), zeta)))
    for divisor in (1, 2, 4, 64):
        mooring = Mooring(smooth_line(zeta))
        use_only(mooring, scheme, base / divisor * (1.0 + 1e-9))
        mooring.settle(HERE)
        mooring.run(times, poses, twists)
        results[divisor] = mooring.node_positions("line1")
    errors = [np.abs(results[d] - results[64]).max() for d in (1, 2, 4)]
    measured = np.log2(errors[0] / errors[2]) / 2.0
    assert measured > order - 0.25, errors


def energy(mooring):
    model, state = mooring._model, mooring._state
    last = SEGMENTS * 4 + 1
    stretch = np.linalg.norm(np.diff(state.position[:, :last], axis=1), axis=0) - model.length[1:last]
    elastic = 0.5 * (model.stiffness * model.inverse_length)[1:last] * np.maximum(stretch, 0.0) ** 2
    return elastic.sum() + 0.5 * (model.mass * (state.velocity**2).sum(axis=0))[: model.size].sum()


@pytest.mark.parametrize("zeta", [0.0, 0.01, 0.1, 1.0])
def test_energy_does_not_grow_through_slack(zeta):
    """A mass pulls a line taut in a vacuum, comes back and leaves it slack, its waves running on: energy never above 1.1 of that put in."""
    kind = line_type(mass=MASS, stiffness=STIFFNESS, damping=-zeta)
    count = 4 * SEGMENTS
    description = vacuum([(FIXED, (0, 0, -50)), (FREE, (LENGTH, 0, -50), MASS * LENGTH)], [(kind, 1, 2, LENGTH, count)])
    mooring = Mooring(description)
    mooring.settle(HERE)
    state, node = mooring._state, mooring._model.point_node[1]
    state.position[:, : count + 1] = np.array([np.linspace(0.0, LENGTH, count + 1), np.zeros(count + 1), np.full(count + 1, -50.0)])
    state.position[:, node] = [LENGTH, 0.0, -50.0]
    state.velocity[0, node] = 0.1
    refresh(mooring)
    start = energy(mooring)
    for t in np.arange(1, 201) * 0.05:
        mooring.step(t, HERE, np.zeros(6))
        assert energy(mooring) < 1.1 * start


@pytest.mark.parametrize("zeta", [0.0, 0.1, 1.0, 3.0])
def test_strong_motion_with_slack_is_that_of_finer_steps(zeta):
    """A mooring chain that goes slack and snaps: peak within 5 % and rms within 12 % of the dynamic deviation, against steps 20 times finer.

    Without any damping the waves of a snap run on for good and no step converges: there the mean and the deviation only, within 5 and 10 %.
    """
    kind = line_type(0.08, 110.0, 7.5e8, -zeta, drag=2.0, added=0.8, drag_axial=0.4, added_axial=0.25)
    description = anchored(kind, (0, 0, -100), (250, 0, -10), 280.0, 14, depth=100.0)
    times = np.arange(1, 401) * 0.05
    poses, twists = surge_heave(times, surge=3.0, heave=5.0, period=6.0)
    coarse = Mooring(description)
    fine = Mooring(description, dt=coarse.step_limit.limits["axial"] / 20.0)
    runs = []
    for mooring in (coarse, fine):
        mooring.settle(HERE)
        runs.append(mooring.run(times, poses, twists).fairlead_tension[:, 0])
    assert runs[1].min() < 1.0
    if zeta == 0.0:
        assert runs[0].mean() == pytest.approx(runs[1].mean(), rel=0.05)
        assert runs[0].std() == pytest.approx(runs[1].std(), rel=0.1)
        return
    assert runs[0].max() == pytest.approx(runs[1].max(), rel=0.05)
    assert np.sqrt(np.mean((runs[0] - runs[1]) ** 2)) < 0.12 * runs[1].std()


def test_a_given_step_is_kept_and_one_beyond_the_limit_is_not():
    file = SCENES / "oc4.txt"
    free = Mooring(file)
    assert Mooring(file, dt=1e-3).step_limit.dt == 1e-3
    longest = Mooring(file, dt=10.0).step_limit.dt
    assert free.step_limit.dt < longest <= 4.0 * free.step_limit.dt
    for dt, largest in ((1e-3, 1e-3), (10.0, longest)):
        mooring = Mooring(file, dt=dt)
        mooring.settle(HERE)
        mooring.step(1.0, HERE, np.zeros(6))
        assert mooring.last_step["dt"] <= largest * (1.0 + 1e-9)


def test_limit_names_the_line_that_limits():
    soft, stiff = line_type(mass=20.0, stiffness=1e6, name="soft"), line_type(mass=20.0, stiffness=1e9, name="stiff")
    points = [(FIXED, (0, 0, -50)), (COUPLED, (50, 0, 0)), (FIXED, (0, 20, -50))]
    limit = Mooring(scene(points, [(soft, 1, 2, 80.0, 10), (stiff, 3, 2, 80.0, 10)], depth=50.0)).step_limit
    assert "line2" in limit.limited_by
