"""PyElastica's rods against a mesh: `pip install pyelastica`.

A catheter is clamped at its base and bent by a load at its tip, in a tube-shaped cavity. Without contact it ends outside of
the wall; with `MeshContact` it lies on it. SI units.
"""

import sys
import time

import elastica as ea
import numpy as np

from parry_continuum import Mesh

RADIUS, LENGTH = 0.8e-3, 75e-3
# The wall pushes back by 200 N for each metre that a rod is nearer than the margin, and 0.05 N for each m/s.
STIFFNESS, DAMPING, MARGIN = 200.0, 0.05, 0.2e-3


class MeshContact(ea.NoForces):
    """A force along the wall's normal at each contact, shared by the two nodes beside it."""

    def __init__(self, mesh, stiffness, damping, margin):
        super().__init__()
        self.mesh, self.stiffness, self.damping, self.margin = mesh, stiffness, damping, margin

    def apply_forces(self, system, time=0.0):
        contacts = self.mesh.contacts_within(system.position_collection.T, system.radius, margin=self.margin)
        known = np.isfinite(contacts.normal[:, 0])
        if not known.any():
            return
        node, share, normal = contacts.segment[known], contacts.fraction[known, None], contacts.normal[known]
        velocity = system.velocity_collection.T
        speed = np.sum(((1 - share) * velocity[node] + share * velocity[node + 1]) * normal, axis=1)
        force = self.stiffness * (self.margin - contacts.depth[known]) - self.damping * speed
        force = np.maximum(force, 0)[:, None] * normal
        np.add.at(system.external_forces.T, node, (1 - share) * force)
        np.add.at(system.external_forces.T, node + 1, share * force)


def cavity():
    """A wavy tube along z, 22 mm wide, as a mesh of 20,000 triangles."""
    z, angle = np.meshgrid(np.linspace(-0.05, 0.06, 101), np.arange(100) * 2 * np.pi / 100, indexing="ij")
    radius = 11e-3 + 0.4e-3 * np.sin(300 * z) * np.cos(3 * angle)
    vertices = np.stack([radius * np.cos(angle), radius * np.sin(angle), z], axis=-1).reshape(-1, 3)
    a = np.arange(100 * 100)
    right = a - a % 100 + (a + 1) % 100
    return Mesh(vertices, np.concatenate([np.stack([a, right, a + 100], 1), np.stack([right, right + 100, a + 100], 1)]))


class Simulator(ea.BaseSystemCollection, ea.Constraints, ea.Forcing, ea.Damping):
    pass


def simulate(steps, contact=None):
    """The rod after so many steps of 10 us, and the time that each took."""
    simulator = Simulator()
    rod = ea.CosseratRod.straight_rod(30, np.array([0, 0, -0.04]), np.array([0, 0, 1.0]), np.array([1.0, 0, 0]), LENGTH, RADIUS,
                                      2000.0, youngs_modulus=2e7, shear_modulus=1e7)
    simulator.append(rod)
    simulator.constrain(rod).using(ea.OneEndFixedBC, constrained_position_idx=(0,), constrained_director_idx=(0,))
    load = np.array([2.0e-3, 8e-4, 0.0])
    simulator.add_forcing_to(rod).using(ea.EndpointForces, np.zeros(3), load, ramp_up_time=0.05)
    if contact is not None:
        simulator.add_forcing_to(rod).using(MeshContact, **contact)
    simulator.dampen(rod).using(ea.AnalyticalLinearDamper, uniform_damping_constant=20.0, time_step=1e-5)
    simulator.finalize()
    stepper, t = ea.PositionVerlet(), np.float64(0)
    for _ in range(50):  # what is compiled at the first step
        t = stepper.step(simulator, t, 1e-5)
    begin = time.perf_counter()
    for _ in range(steps - 50):
        t = stepper.step(simulator, t, 1e-5)
    return rod, (time.perf_counter() - begin) / (steps - 50)


def main(steps=30_000):
    mesh = cavity()
    free, plain = simulate(steps)
    held, with_contact = simulate(steps, {"mesh": mesh, "stiffness": STIFFNESS, "damping": DAMPING, "margin": MARGIN})
    for name, rod, step in [("free", free, plain), ("held", held, with_contact)]:
        links = mesh.per_link(rod.position_collection.T, rod.radius)
        speed = np.abs(rod.velocity_collection).max()
        print(f"{name}: {1e6 * step:.1f} us a step; {np.sum(links.distance == 0)} of 30 links in the wall, the nearest "
              f"{1e3 * links.distance.min():.3f} mm from it; tip at {np.round(1e3 * rod.position_collection[:, -1], 2)} mm, "
              f"at most {speed:.3f} m/s")
    return mesh, free, held


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
