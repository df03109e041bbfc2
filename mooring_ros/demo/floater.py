"""The demo's floater: one rigid body with hydrostatics, added mass and damping, and a mooring and waves that pull at it.

Figures of the VolturnUS-S with the IEA 15 MW turbine, as one rigid body (platform, tower, rotor and nacelle). "Report" is
Allen et al., NREL/TP-5000-76773 (2020); "reference model" is the public model that goes with it (its WAMIT results and
inputs); "chosen" is ours.

The equations are Kirchhoff's, with the constant added mass of zero frequency: added mass and radiation damping do not
depend on the frequency here, as they would with a radiation–diffraction code behind.
"""

from dataclasses import dataclass, field

import numpy as np

_ADDED_MASS = 1025.0 * np.array(  # reference model, WAMIT at zero frequency, over the density, symmetrised
    [
        [1.2334e4, 0.0, 0.0, 0.0, -1.1725e5, 0.0],
        [0.0, 1.2334e4, 0.0, 1.1725e5, 0.0, 0.0],
        [0.0, 0.0, 2.6275e4, 0.0, 0.0, 0.0],
        [0.0, 1.1725e5, 0.0, 1.2163e7, 0.0, 0.0],
        [-1.1725e5, 0.0, 0.0, 0.0, 1.2163e7, 0.0],
        [0.0, 0.0, 0.0, 0.0, 0.0, 2.5311e7],
    ]
)

_QUADRATIC_DAMPING = np.array(  # report
    [
        [9.23e5, 0.0, 0.0, 0.0, -8.92e6, 0.0],
        [0.0, 9.23e5, 0.0, 8.92e6, 0.0, 0.0],
        [0.0, 0.0, 2.30e6, 0.0, 0.0, 0.0],
        [0.0, 8.92e6, 0.0, 1.68e10, 0.0, 0.0],
        [-8.92e6, 0.0, 0.0, 0.0, 1.68e10, 0.0],
        [0.0, 0.0, 0.0, 0.0, 0.0, 4.80e10],
    ]
)


@dataclass(frozen=True)
class FloaterProperties:
    """Figures of the floater about its reference point at the still water line, body axes, SI units."""

    mass: float = 20093.0e3  # report: platform, ballast, tower, rotor and nacelle
    centre_of_gravity: float = -2.32  # m, z; reference model
    # kg m², also pitch, about the reference point: the report's platform (1.251e10 about its own centre at z = −14.94 m)
    # with the tower (1263 t, 15 to 144.5 m) and the rotor and nacelle (991 t at 150 m)
    roll_inertia: float = 4.46e10
    yaw_inertia: float = 2.37e10  # kg m²; report (platform; tower and rotor add little)
    displacement: float = 20206.0  # m³; report
    heave_stiffness: float = 4.47e6  # N/m; report
    tilt_stiffness: float = 2.19e9  # N m/rad, roll and pitch: water plane and buoyancy, without the weight; report
    added_mass: np.ndarray = field(default_factory=_ADDED_MASS.copy)  # (6, 6)
    quadratic_damping: np.ndarray = field(default_factory=_QUADRATIC_DAMPING.copy)  # (6, 6)
    # (6,) diagonal; chosen: about 2 % of critical, in the place of the radiation damping
    linear_damping: np.ndarray = field(default_factory=lambda: np.array([6e4, 6e4, 5.8e5, 5e8, 5e8, 1.4e8]))
    density: float = 1025.0
    gravity: float = 9.80665


class Floater:
    """Accelerations of the floater from its pose, its twist and the outer wrenches.

    pose (7,): x, y, z (m), quaternion x, y, z, w; twist (6,): velocity of the reference point (m/s) and angular velocity
    (rad/s), both in the world frame; wrenches (6,): N and N·m about the reference point, world frame.
    """

    def __init__(self, properties=None):
        self.properties = p = properties or FloaterProperties()
        lever = p.mass * p.centre_of_gravity
        coupling = np.array([[0.0, lever, 0.0], [-lever, 0.0, 0.0], [0.0, 0.0, 0.0]])  # m S(r)ᵀ for r = (0, 0, z_g)
        inertia = np.diag([p.roll_inertia, p.roll_inertia, p.yaw_inertia])
        rigid = np.block([[p.mass * np.eye(3), coupling], [coupling.T, inertia]])
        self.mass_matrix = rigid + p.added_mass  # (6, 6), body axes
        self._inverse = np.linalg.inv(self.mass_matrix)
        self.ballast = np.zeros(6)  # constant, world frame: see trim

    def trim(self, mooring_wrench):
        """Ballast the floater so that heave, roll and pitch are at rest at the zero pose under this mooring wrench (6,).

        The report's displacement already carries the vertical pull of its own mooring; for that scene the ballast is
        0.1 % of the buoyancy surplus. It is small against the mass, so the mass matrix stays.
        """
        p = self.properties
        surplus = (p.density * p.displacement - p.mass) * p.gravity
        self.ballast = np.array([0.0, 0.0, -surplus - mooring_wrench[2], -mooring_wrench[3], -mooring_wrench[4], 0.0])

    def hydrostatic_wrench(self, pose):
        """Weight, buoyancy and ballast (6,) at pose. Derives from the potential in `energy`, whatever the rotation."""
        p = self.properties
        up = rotation_matrix(pose[3:7])[:, 2]  # the body's z axis
        tilt = np.array([up[1], -up[0], 0.0])  # up × world z
        buoyancy = p.density * p.gravity * p.displacement - p.heave_stiffness * pose[2]
        weight = p.mass * p.gravity
        # The weight acts at z_g·up: its moment is −z_g·weight·tilt.
        moment = (p.tilt_stiffness - weight * p.centre_of_gravity) * tilt
        return np.array([0.0, 0.0, buoyancy - weight, *moment]) + self.ballast

    def damping_wrench(self, body_twist):
        """Linear and quadratic damping (6,) at body_twist (6,), both in body axes."""
        p = self.properties
        return -p.linear_damping * body_twist - p.quadratic_damping @ (np.abs(body_twist) * body_twist)

    def acceleration(self, pose, twist, wrench):
        """Rate of twist (6,), world frame, under the outer wrench (6,) (mooring and waves) besides the floater's own."""
        rotation = rotation_matrix(pose[3:7])
        body_twist = _turn(rotation.T, twist)
        velocity, spin = body_twist[:3], body_twist[3:]
        momentum = self.mass_matrix @ body_twist
        load = _turn(rotation.T, wrench + self.hydrostatic_wrench(pose)) + self.damping_wrench(body_twist)
        load[:3] -= _cross(spin, momentum[:3])
        load[3:] -= _cross(spin, momentum[3:]) + _cross(velocity, momentum[:3])
        rate = self._inverse @ load
        rate[:3] += _cross(spin, velocity)  # from body axes to the velocity in the world
        return _turn(rotation, rate)

    def energy(self, pose, twist):
        """Kinetic (with the added mass) and potential energy (J); the potential is zero at the zero pose."""
        p = self.properties
        rotation = rotation_matrix(pose[3:7])
        body_twist = _turn(rotation.T, twist)
        surplus = (p.density * p.displacement - p.mass) * p.gravity + self.ballast[2]
        righting = p.tilt_stiffness - p.mass * p.gravity * p.centre_of_gravity
        potential = 0.5 * p.heave_stiffness * pose[2] ** 2 - surplus * pose[2] + righting * (1.0 - rotation[2, 2])
        return 0.5 * body_twist @ self.mass_matrix @ body_twist + potential


def rotation_matrix(quaternion):
    """Rotation (3, 3) from body to world of a unit quaternion (4,) x, y, z, w."""
    x, y, z, w = quaternion
    return np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
            [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
            [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
        ]
    )


def quaternion_rate(quaternion, spin):
    """Rate (4,) of a quaternion (4,) x, y, z, w under the angular velocity (3,) rad/s in the world frame."""
    x, y, z, w = quaternion
    a, b, c = spin
    return 0.5 * np.array([w * a + b * z - c * y, w * b + c * x - a * z, w * c + a * y - b * x, -a * x - b * y - c * z])


def _turn(rotation, pair):
    """Both 3-vectors of a pair (6,) turned by rotation (3, 3)."""
    return (rotation @ pair.reshape(2, 3).T).T.ravel()


def _cross(a, b):
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])
