"""Parameters of the engine, with PyBullet's defaults."""

from __future__ import annotations

from dataclasses import dataclass

DEFAULT_TIME_STEP = 1.0 / 240.0
BULLET, RIGID, COMPLIANT = "bullet", "rigid", "compliant"
CONVERGED = RIGID, COMPLIANT
"""The laws of contacts that are solved until they converge."""

DISCRETE, EULER, IMPLICIT_FAST, IMPLICIT, RK4 = "discrete", "euler", "implicitfast", "implicit", "rk4"
MIDPOINT, EXPLICIT = "midpoint", "explicit"
INTEGRATORS = DISCRETE, MIDPOINT, EULER, EXPLICIT, IMPLICIT_FAST, IMPLICIT, RK4
"""The integrators: all but "midpoint" are MuJoCo's. "explicit" is its Euler without the flag `eulerdamp`."""
OF_STEPS = DISCRETE, MIDPOINT
"""Those that ask for velocities at the end of a step, and can have contacts that are rigid."""


def usual_integrator(contact: str) -> str:
    """The integrator of a `World` of which nobody has said another one."""
    return MIDPOINT if contact in CONVERGED else DISCRETE


def integrator_of(integrator: str, contact: str) -> str:
    """The integrator of a step: "discrete" with rigid contacts is "midpoint"."""
    return MIDPOINT if integrator == DISCRETE and contact == RIGID else integrator


def check_integrator(integrator: object, contact: str) -> str:
    """Check the name of an integrator, and that it suits a law of contacts.

    Raises:
        ValueError: There is no such integrator, or that law has no forces at an instant.
    """
    if integrator not in INTEGRATORS:
        known = ", ".join(map(repr, INTEGRATORS[:-1]))
        raise ValueError(f"integrator must be {known} or {INTEGRATORS[-1]!r}, not {integrator!r}")
    if integrator not in OF_STEPS and contact == RIGID:
        raise ValueError(
            f"integrator={integrator!r} needs contacts with forces at an instant, and those of "
            "contact='rigid' are impulses of whole steps: take contact='compliant', or "
            "integrator='midpoint'"
        )
    return str(integrator)


def check_contact(contact: object) -> str:
    """Check the name of a law of contacts.

    Raises:
        ValueError: There is no such law.
    """
    if contact in (BULLET, *CONVERGED):
        return str(contact)
    raise ValueError(f"contact must be 'bullet', 'rigid' or 'compliant', not {contact!r}")


# Bullet's -0.04 is a float32.
DEFAULT_SPLIT_THRESHOLD = -0.03999999910593033


@dataclass(slots=True)
class EngineParameters:
    """The parameters of `setPhysicsEngineParameter` and similar functions.

    `World.change_parameters` sets them.

    Attributes:
        time_step: Duration of one step [s].
        substeps: Number of substeps; 0 is the same as 1.
        gravity: [m/s²] in world axes.
        fluid_density: Density of the fluid around all bodies [kg/m³]; 0 and a viscosity of 0 are none. It
            causes drag and lift by the models of MuJoCo's documentation, and no buoyancy.
        fluid_viscosity: Its viscosity [Pa s].
        wind: Its velocity [m/s] in world axes.
        solver_iterations: Maximum number of sweeps over the constraint rows.
        solver_residual_threshold: Sweeps end when no row's squared velocity change exceeds this.
        erp: Share of a joint limit's or user constraint's error that is corrected per step.
        contact_erp: The same for penetrations.
        friction_erp: The same for friction anchors.
        global_cfm: Softness of contacts: velocity per impulse, times the length of a substep [s/kg].
        contact_breaking_threshold: Distance at which a contact point is removed [m].
        contact_slop: Penetration that is not corrected [m].
        restitution_velocity_threshold: Slower impacts do not bounce [m/s].
        split_impulse: Deep errors are not turned into velocity.
        split_impulse_penetration_threshold: Threshold of a deep error (negative) [rad or m].
        cone_friction: Friction is bounded by a cone, not by a pyramid.
        isotropic_friction: Friction is bounded by a cone and opposite to the velocity of sliding, in whatever
            direction a body moves. Off as in PyBullet, where a vehicle with skid steering turns faster at
            some headings than at others.
        deterministic_overlapping_pairs: Contacts are relaxed in the order of their links, instead of in the
            order in which bounds have met.
        joint_feedback_mode: Bit 1: force-torque sensors in world axes; bit 2: about the joint.
        allowed_ccd_penetration: Depth that continuous collision detection allows [m].
        warm_starting_factor: PyBullet's parameter of this name, which has no effect on multibodies.
        contact_warm_starting: Share of their last impulses that the contacts of rigid bodies at rest start
            from, and those of MJCF files that yield. 0 is PyBullet's behaviour; rest poses are the same, but
            need more sweeps.
        noncontact_inner_iterations: Iterations over joint rows per sweep.
        minimum_island_size: Islands are solved together until they have more constraints and pairs of bodies.
        report_solver_analytics: `stepSimulation` returns solver statistics.
        constraint_solver: 1 sequential impulses, 2 projected Gauss-Seidel, 3 Dantzig.
        sat: Separating axis test for polyhedra.
        collision_filter_mode: 0 both bodies must accept each other, 1 one is enough.
        sensor_seed: Seed of the noise of all sensors.
        noslip_iterations: With contact="compliant": greatest number of passes after which friction of
            contacts of MJCF files, and dry friction of joints, does not yield any more, as MuJoCo's.
        contact: The law of contacts and its solver: "bullet", sweeps as PyBullet makes them, or "rigid" or
            "compliant", solved until they converge; docs/contact.md compares them.
        integrator: "discrete", in which damping, springs and servos count implicitly, in free motion and in
            all rows; "midpoint", the same with free rotation that keeps its energy (as "discrete" where there
            are soft bodies or bodies with late velocities), which worlds with contact="rigid" have for
            "discrete"; or MuJoCo's "euler", "explicit", "implicitfast", "implicit" or "rk4".
            docs/solver.md has the equations.
    """

    time_step: float = DEFAULT_TIME_STEP
    substeps: int = 0
    gravity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    fluid_density: float = 0.0
    fluid_viscosity: float = 0.0
    wind: tuple[float, float, float] = (0.0, 0.0, 0.0)
    solver_iterations: int = 50
    solver_residual_threshold: float = 1e-7
    erp: float = 0.2
    contact_erp: float = 0.08
    friction_erp: float = 0.2
    global_cfm: float = 0.0
    contact_breaking_threshold: float = 0.02
    contact_slop: float = 1e-5
    restitution_velocity_threshold: float = 0.2
    split_impulse: bool = True
    split_impulse_penetration_threshold: float = DEFAULT_SPLIT_THRESHOLD
    cone_friction: bool = True
    isotropic_friction: bool = False
    deterministic_overlapping_pairs: bool = False
    joint_feedback_mode: int = 0
    allowed_ccd_penetration: float = 0.04
    warm_starting_factor: float = 0.1
    contact_warm_starting: float = 1.0
    noncontact_inner_iterations: int = 1
    minimum_island_size: int = 0
    report_solver_analytics: int = 0
    constraint_solver: int = 1
    sat: bool = False
    collision_filter_mode: int = 1
    sensor_seed: int = 0
    noslip_iterations: int = 0
    contact: str = BULLET
    integrator: str = DISCRETE

    @property
    def substep_count(self) -> int:
        """Number of substeps, at least one."""
        return max(1, self.substeps)

    def substeps_due(self, unspent_time: float) -> tuple[int, float]:
        """Number of substeps of the next step, and the time that remains for the step after it [s].

        As with Bullet's clock, the number is that which fits into the elapsed time. By rounding it can be one
        less than `substeps` in a step; it never exceeds `substeps`.

        Args:
            unspent_time: Time that remains from earlier steps [s].
        """
        if self.substeps <= 1:
            return 1, 0.0
        unspent_time += self.time_step
        count = int(unspent_time / self.substep_time)
        return min(count, self.substeps), unspent_time - count * self.substep_time

    @property
    def substep_time(self) -> float:
        """Duration of one substep [s]."""
        return self.time_step / self.substep_count
