"""Bent lines against beams and the exact elastica (see mooring_ros/core/hinges.py for the end conditions)."""

import csv
from pathlib import Path

import numpy as np
import pytest
from bent_lines import BentLines
from scipy.integrate import solve_bvp
from scipy.linalg import eigh
from scipy.optimize import root

from mooring_ros.core.hinges import stiffness_rows

TABLES = Path(__file__).parents[1] / "reference"


def rows(name):
    with open(TABLES / name, newline="") as file:
        return list(csv.DictReader(file))


def deflect(count, load, measure="angle"):
    """Tip deflection and shortening, over the length, of a cantilever of length 1 and EI 1 under the dead load P L^2 / EI, by Newton."""
    lines = BentLines([(count, 1.0, 1.0)], [(0, np.array([1.0, 0.0, 0.0]))], measure=measure)
    axial = 1e7 * count  # EA/l: strains of 1e-6 at most
    position = lines.position
    position[0, : count + 1] = np.linspace(0.0, 1.0, count + 1)
    x = position[:, : count + 1]
    for share in np.linspace(0.0, load, 1 + int(np.ceil(2 * load)))[1:]:
        for _ in range(60):
            force = lines.forces(position)[0][:, : count + 1]
            stiffness = lines.hessian(position)
            span = np.diff(x, axis=1)
            length = np.linalg.norm(span, axis=0)
            q = span / length
            tension = axial * (length - 1.0 / count)
            force[:, :-1] += tension * q
            force[:, 1:] -= tension * q
            force[1, -1] += share
            for j in range(count):
                block = axial * np.outer(q[:, j], q[:, j]) + tension[j] / length[j] * (np.eye(3) - np.outer(q[:, j], q[:, j]))
                pair = slice(3 * j, 3 * j + 6)
                stiffness[pair, pair] += np.kron([[1.0, -1.0], [-1.0, 1.0]], block)
            move = np.linalg.solve(stiffness[3:, 3:], force.T.ravel()[3:])
            x[:, 1:] += move.reshape(-1, 3).T * min(1.0, 1.0 / count / np.abs(move).max())
            if np.abs(move).max() < 1e-12:
                break
        else:
            raise AssertionError("Newton did not find the deflected shape")
    return x[1, -1], 1.0 - x[0, -1]


def elastica(load):
    row = next(row for row in rows("elastica_tip_load.csv") if float(row["PL2_over_EI"]) == load)
    return float(row["w_tip_over_L"]), float(row["u_tip_over_L"])


@pytest.mark.parametrize("count, bound, load", [(8, 0.25e-2, 0.2), (8, 0.25e-2, 2.0), (8, 0.25e-2, 10.0), (40, 0.012e-2, 1.0), (40, 0.012e-2, 10.0)])
def test_tip_deflects_as_the_exact_elastica(count, bound, load):
    assert deflect(count, load)[0] == pytest.approx(elastica(load)[0], rel=bound)


@pytest.mark.parametrize("load", [0.2, 2.0, 10.0])
def test_tip_deflection_converges_with_second_order_or_better(load):
    exact = elastica(load)
    errors = [np.abs(np.subtract(deflect(count, load), exact)).max() for count in (8, 16, 32)]
    assert errors[0] > 3.5 * errors[1] > 3.5**2 * errors[2]


@pytest.mark.parametrize("row", [row for row in rows("hall2020_cantilever.csv") if row["g"] == "9.80665"])
def test_the_seeds_cantilevers_deflect_as_the_exact_elastica_and_better_than_by_the_papers_end_condition(row):
    length, load = float(row["L_m"]), float(row["PL2_over_EI"])
    exact = float(row["w_tip_exact_m"]) / length
    for count, bound in ((2, 0.05), (4, 0.006), (6, 0.0035), (8, 0.0023)):
        error = abs(deflect(count, load)[0] / exact - 1.0)
        assert error < bound
        assert error < 0.6 * abs(deflect(count, load, "paper")[0] / exact - 1.0)


@pytest.mark.parametrize("count", [1, 2, 3, 5, 20])
def test_a_small_tip_load_deflects_every_cantilever_exactly(count):
    load = 1e-6
    assert deflect(count, load)[0] == pytest.approx(load / 3.0, rel=1e-6)


def sideways(lines):
    """Stiffness against small moves across straight lines, (size, size)."""
    return lines.hessian(lines.position)[1::3, 1::3]


def straight(count, clamps, measure="angle", rigidity=1.0):
    lines = BentLines([(count, 1.0, rigidity)], clamps, measure=measure)
    lines.position[0, : count + 1] = np.linspace(0.0, 1.0, count + 1)
    return lines


AXIS = np.array([1.0, 0.0, 0.0])


def sections_deflect(load, softer, first, second):
    """Tip deflection of a cantilever whose first 0.4 of 1 m have EI 1 and the rest EI `softer`, as two lines at a joint of rigid segments."""
    lines = BentLines([(first, 0.4, 1.0), (second, 0.6, softer)], [(0, AXIS)], [[(1, -1.0), (2, 1.0)]])
    spans = np.repeat([0.4 / first, 0.6 / second], [first, second])
    nodes = np.concatenate([np.arange(first + 1), np.arange(first, first + second + 1)])

    def turning_moments(angles):
        places = np.concatenate([[[0.0, 0.0]], np.cumsum(spans[:, None] * np.column_stack([np.cos(angles), np.sin(angles)]), axis=0)])
        lines.position[:2, : lines.size] = places[nodes].T
        force = lines.forces(lines.position)[0][:2, : lines.size].copy()
        force[1, -1] += load
        beyond = np.array([force[:, nodes > k].sum(axis=1) for k in range(first + second)])
        return spans * (beyond[:, 1] * np.cos(angles) - beyond[:, 0] * np.sin(angles))

    found = root(turning_moments, np.full(first + second, 0.2 * load), tol=1e-12)
    assert found.success
    turning_moments(found.x)
    return lines.position[1, lines.size - 1]


@pytest.mark.parametrize("softer", [0.2, 1.0, 5.0])
def test_sections_of_different_stiffness_and_fineness_deflect_as_the_elastica(softer):
    load = 1.0

    def slopes(s, y):
        return np.array([y[1] / np.where(s < 0.4, 1.0, softer), -load * np.cos(y[0]), np.sin(y[0])])

    mesh = np.sort(np.append(np.linspace(0.0, 1.0, 501), [0.4 - 1e-9, 0.4 + 1e-9]))
    guess = np.array([0.3 * mesh, load * (1.0 - mesh), 0.15 * mesh**2])
    exact = solve_bvp(slopes, lambda a, b: np.array([a[0], b[1], a[2]]), mesh, guess, tol=1e-6, max_nodes=20000).y[2, -1]
    for counts, bound in (((4, 6), 1.5e-3), ((8, 3), 1.5e-3), ((16, 12), 4e-4)):
        assert sections_deflect(load, softer, *counts) == pytest.approx(exact, rel=bound)


CLAMPS = {
    "clamped-free": ([(0, AXIS)], slice(1, None)),
    "clamped-clamped": ([(0, AXIS), (1, -AXIS)], slice(1, -1)),
    "clamped-pinned": ([(0, AXIS)], slice(1, -1)),
    "pinned-pinned": ([], slice(1, -1)),
}


def frequencies(count, ends, measure="angle"):
    clamps, moving = CLAMPS[ends]
    mass = np.full(count + 1, 1.0 / count)
    mass[[0, -1]] *= 0.5
    stiffness = sideways(straight(count, clamps, measure))[moving, moving]
    return np.sqrt(eigh(stiffness, np.diag(mass[moving]), eigvals_only=True))


@pytest.mark.parametrize("ends", CLAMPS)
def test_beams_swing_with_the_frequencies_of_the_table(ends):
    table = np.array([float(row["coefficient"]) for row in rows("eigenvalues.csv") if row["system"] == f"beam {ends}"])
    errors = {count: np.abs(frequencies(count, ends)[:3] / table[:3] - 1.0) for count in (20, 40)}
    assert (errors[40] < [0.0007, 0.0025, 0.0053]).all()
    assert (errors[20] > 3.5 * errors[40]).all()
    for count in (4, 8, 20):
        ours, paper = (np.abs(frequencies(count, ends, measure)[:2] / table[:2] - 1.0) for measure in ("angle", "paper"))
        assert (ours <= paper * (1.0 + 1e-9)).all()


@pytest.mark.parametrize("row", rows("clamped_tensioned_beam.csv"))
def test_a_clamped_tensioned_beam_resists_a_turn_of_its_clamp(row):
    slenderness = float(row["lambdaL=L*sqrt(T/EI)"])
    exact = float(row["M0*L/(EI*theta0)"])
    errors = {}
    for measure in ("angle", "paper"):
        for count in (8, 40):
            lines = straight(count, [(0, AXIS)], measure)
            stiffness = sideways(lines) + slenderness**2 * count * (
                np.diag([1.0] + [2.0] * (count - 1) + [1.0]) - np.eye(count + 1, k=1) - np.eye(count + 1, k=-1)
            )
            _, turn, axis = lines.blocks(lines.position)
            coupling = turn[0, 1, 1, 2]  # force across on the next node by a turn about z
            shape = np.linalg.solve(stiffness[1:-1, 1:-1], np.concatenate([[-coupling], np.zeros(count - 2)]))
            errors[measure, count] = abs((axis[0, 2, 2] + coupling * shape[0]) / exact - 1.0)
    spacing = slenderness / 40.0  # of 40 segments, in the length over which the moment decays
    assert errors["angle", 40] < 0.1 * spacing**2
    assert errors["angle", 8] < 0.9 * errors["paper", 8]
    assert errors["angle", 40] < 0.9 * errors["paper", 40]


@pytest.mark.parametrize("count", [1, 2, 3, 4, 5, 9])
@pytest.mark.parametrize("clamps", [[(0, AXIS)], [(1, -AXIS)], [(0, AXIS), (1, -AXIS)]])
def test_every_hinge_and_clamp_keeps_a_positive_stiffness_near_that_of_the_paper(count, clamps):
    ours, paper = (BentLines([(count, 1.0, 1.0)], clamps, measure=measure).bending for measure in ("angle", "paper"))
    assert (ours.stiffness[1:count] > 0.74 * paper.stiffness[1:count]).all()
    assert (ours.stiffness[1:count] < 1.2 * paper.stiffness[1:count]).all()
    assert (ours.clamp_stiffness >= paper.clamp_stiffness).all()
    assert (ours.clamp_stiffness <= 1.5 * paper.clamp_stiffness).all()


@pytest.mark.parametrize("count", [2, 3, 10])
def test_a_beam_clamped_on_both_sides_is_turned_and_moved_as_it_should(count):
    """12 EI / L^3 for a shift of one clamp, EI / L for its share of a turn against the other: exact for bending that is linear along the line."""
    lines = straight(count, [(0, AXIS), (1, -AXIS)])
    stiffness = sideways(lines)
    _, turn, axis = lines.blocks(lines.position)
    inner = slice(1, count)
    coupling = np.zeros((count + 1, 2))
    for clamp, (end, far) in enumerate(((0, 1), (count, count - 1))):
        coupling[end, clamp] += turn[clamp, 0, 1, 2]
        coupling[far, clamp] += turn[clamp, 1, 1, 2]
    whole = np.block([[stiffness, coupling], [coupling.T, np.diag(axis[:, 2, 2])]])
    kept = [0, count, count + 1, count + 2]
    inner = list(range(1, count))
    condensed = whole[np.ix_(kept, kept)] - whole[np.ix_(kept, inner)] @ np.linalg.solve(whole[np.ix_(inner, inner)], whole[np.ix_(inner, kept)])
    beam = [[12.0, -12.0, 6.0, 6.0], [-12.0, 12.0, -6.0, -6.0], [6.0, -6.0, 4.0, 2.0], [6.0, -6.0, 2.0, 4.0]]
    assert condensed == pytest.approx(np.array(beam), rel=1e-9)


def test_rows_of_stiffness_bound_the_highest_frequency():
    for clamps, moving in CLAMPS.values():
        lines = straight(12, clamps)
        mass = np.full(13, 1.0 / 12)
        bound = stiffness_rows(lines.bending, lines.length)[:13]
        highest = eigh(sideways(lines)[moving, moving], np.diag(mass[moving]), eigvals_only=True)[-1]
        assert 0.9 * (bound / mass)[moving].max() < highest * 1.2
        assert highest <= (bound / mass)[moving].max() * (1.0 + 1e-12)
    inside = stiffness_rows(straight(12, []).bending, lines.length)[6]
    assert inside == pytest.approx(16.0 * 12**3)
