"""`mooring static`: the static solution of a scene at a pose."""

import numpy as np

from .arguments import load_mooring, pose
from .console import ComputationFailed, print_json, table

_AXES = ("x", "y", "z", "rx", "ry", "rz")


def add_arguments(parser):
    parser.add_argument("scene", metavar="SCENE", help="MoorDyn v2 input file, or a recording that holds one")
    parser.add_argument(
        "--pose",
        type=pose,
        default=pose("0,0,0,0,0,0"),
        metavar="X,Y,Z,ROLL,PITCH,YAW",
        help="platform pose in m and degrees; roll, pitch, yaw about the fixed x, y, z axes in that order (default: all zero)",
    )
    parser.add_argument("--json", action="store_true", help="one JSON object on standard output, nothing else")


def run(args):
    solution = solve(args.scene, args.pose)
    if args.json:
        print_json(solution)
    else:
        print(_text(args.scene, solution))
    return 0


def solve(scene, pose):
    """The static solution at a pose (7,), as the object that --json prints: N, N·m, world frame. Raises UsageError, ComputationFailed."""
    from mooring_ros.mooring import MooringError

    mooring = load_mooring(scene)
    try:
        mooring.settle(pose)
        stiffness = mooring.stiffness()
    except MooringError as error:
        raise ComputationFailed(f"{scene}: {error}") from error
    found = mooring.static_result
    if not found.converged:
        raise ComputationFailed(
            f"{scene}: the statics did not converge: {found.residual:.3g} N out of balance after {found.iterations} iterations"
        )
    lines = zip(
        mooring.line_names,
        mooring.fairlead_tension.tolist(),
        mooring.anchor_tension.tolist(),
        mooring.fairlead_end_force.tolist(),
        mooring.anchor_end_force.tolist(),
    )
    keys = ("name", "fairlead_tension", "anchor_tension", "fairlead_end_force", "anchor_end_force")
    return {
        "lines": [dict(zip(keys, line)) for line in lines],
        "wrench": {"force": mooring.wrench[:3].tolist(), "torque": mooring.wrench[3:].tolist()},
        "stiffness": np.asarray(stiffness).tolist(),
        "residual": float(found.residual),
        "iterations": int(found.iterations),
    }


def _text(scene, solution):
    wrench = [*solution["wrench"]["force"], *solution["wrench"]["torque"]]
    ends = [
        [line["name"], end, _number(line[f"{end}_tension"]), *map(_number, line[f"{end}_end_force"])]
        for line in solution["lines"]
        for end in ("fairlead", "anchor")
    ]
    return "\n".join(
        [
            f"{scene}: in balance to {solution['residual']:.2g} N after {solution['iterations']} iterations",
            "",
            "Forces of the lines on what holds their ends, world axes (N)",
            table(["line", "end", "tension", "fx", "fy", "fz"], ends),
            "",
            "On the platform, about its reference point, world axes (N, N·m)",
            table(["fx", "fy", "fz", "mx", "my", "mz"], [map(_number, wrench)]),
            "",
            "Stiffness −∂wrench/∂pose (N/m, N/rad, N·m/m, N·m/rad)",
            table(["", *_AXES], [[name, *map(_number, row)] for name, row in zip(_AXES, _without_rounding(solution["stiffness"]))]),
        ]
    )


def _without_rounding(matrix):
    """The matrix with zeros where only rounding is left, for the eye."""
    matrix = np.array(matrix)
    return np.where(np.abs(matrix) < 1e-12 * np.abs(matrix).max(), 0.0, matrix).tolist()


def _number(value):
    return f"{value + 0.0:.6g}"
