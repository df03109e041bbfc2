"""The tangent stiffness of bending is the exact derivative of its forces and moments."""

import numpy as np
import pytest
from bent_lines import three_bent_lines, turned

STEP = 1e-6


@pytest.mark.parametrize("measure", ["angle", "paper"])
def test_blocks_are_the_gradient_of_the_forces(measure):
    lines = three_bent_lines(7, measure)
    hessian = lines.hessian(lines.position)
    assert hessian == pytest.approx(hessian.T, abs=1e-12 * np.abs(hessian).max())
    for node in range(lines.size):
        for k in range(3):
            forces = []
            for sign in (1.0, -1.0):
                moved = lines.position.copy()
                moved[k, node] += sign * STEP
                forces.append(lines.forces(moved)[0][:, : lines.size].T.ravel())
            column = -(forces[0] - forces[1]) / (2.0 * STEP)
            assert hessian[:, 3 * node + k] == pytest.approx(column, abs=1e-7 * np.abs(hessian).max())


@pytest.mark.parametrize("measure", ["angle", "paper"])
def test_turns_of_a_clamp_couple_to_its_nodes_and_to_themselves(measure):
    lines = three_bent_lines(8, measure)
    _, turn, axis = lines.blocks(lines.position)
    assert axis == pytest.approx(axis.transpose(0, 2, 1), abs=1e-10)
    for clamp in range(4):
        segment = lines.bending.clamp_segment[clamp]
        end, far = (segment - 1, segment) if lines.bending.clamp_sign[clamp] > 0 else (segment, segment - 1)
        for k in range(3):
            sides = []
            for sign in (1.0, -1.0):
                axes = lines.axes.copy()
                axes[clamp] = turned(axes[clamp], sign * STEP * np.eye(3)[k])
                sides.append(lines.forces(lines.position, axes)[0])
            column = -(sides[0] - sides[1]) / (2.0 * STEP)
            assert turn[clamp, 0, :, k] == pytest.approx(column[:, end], abs=1e-6 * np.abs(turn).max())
            assert turn[clamp, 1, :, k] == pytest.approx(column[:, far], abs=1e-6 * np.abs(turn).max())


@pytest.mark.parametrize("measure", ["angle", "paper"])
def test_turning_a_clamp_costs_the_second_difference_of_the_energy(measure):
    lines = three_bent_lines(9, measure)
    _, _, axis = lines.blocks(lines.position)
    step = 1e-4
    for clamp in range(4):
        for direction in np.random.default_rng(clamp).normal(size=(4, 3)):
            energies = []
            for share in (1.0, 0.0, -1.0):
                axes = lines.axes.copy()
                axes[clamp] = turned(axes[clamp], share * step * direction)
                energies.append(lines.energy(lines.position, axes))
            second = (energies[0] - 2.0 * energies[1] + energies[2]) / step**2
            assert direction @ axis[clamp] @ direction == pytest.approx(second, rel=1e-4, abs=1e-4 * np.abs(axis).max())


def test_blocks_of_an_end_that_has_left_are_zero():
    lines = three_bent_lines(10)
    lines.end_point[:] = -1
    data, turn, axis = lines.blocks(lines.position)
    assert not turn.any() and not axis.any()
    assert not data[9 * lines.pattern.hinge.size :].any()
