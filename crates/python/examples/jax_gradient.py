"""The distance as a function that JAX differentiates, under `jit` and `vmap`: `pip install jax`."""

import jax
import jax.numpy as jnp
import numpy as np
from jax.test_util import check_grads

from parry_continuum import Mesh

jax.config.update("jax_enable_x64", True)  # or distances have seven digits, and so has all that is asked


def differentiable(mesh):
    """``distance(points, radii, pose)``, as `Mesh.distance_and_gradient` has it."""

    def ask(points, radii, pose):
        def many(points, radii, pose):
            return tuple(mesh.distance_and_gradient(points, radii, pose=pose)[:4])

        number = jax.ShapeDtypeStruct((), points.dtype)
        shapes = (number, *(jax.ShapeDtypeStruct(array.shape, array.dtype) for array in (points, radii, pose)))
        return jax.pure_callback(many, shapes, points, radii, pose, vmap_method="broadcast_all")

    @jax.custom_vjp
    def distance(points, radii, pose):
        return ask(points, radii, pose)[0]

    def forward(points, radii, pose):
        value, *gradient = ask(points, radii, pose)
        return value, gradient

    def backward(gradient, cotangent):
        return tuple(cotangent * part for part in gradient)

    distance.defvjp(forward, backward)
    return distance


def main():
    floor = Mesh([[-90, -90, 0], [90, -90, 0], [0, 90, 0]], [[0, 1, 2]])
    distance = differentiable(floor)

    def lengthened(length, angle):
        """An arc of this length that turns by the angle, on its way down to the floor."""
        share = jnp.linspace(0, 1, 21) * angle
        points = length / angle * jnp.stack([1 - jnp.cos(share), 0 * share, -jnp.sin(share)], axis=1)
        return distance(points, jnp.full(20, 0.5), jnp.eye(4).at[2, 3].set(30.0))

    check_grads(lengthened, (20.0, 0.7), order=1, modes=["rev"], atol=1e-6, rtol=1e-6)
    slopes = jax.jit(jax.vmap(jax.grad(lengthened)))(jnp.linspace(10, 20, 100), jnp.linspace(0.2, 1, 100))
    assert slopes.shape == (100,) and bool(jnp.all(slopes < 0))
    print("the distance changes by", np.round(np.asarray(slopes)[[0, -1]], 3), "for each unit of length")


if __name__ == "__main__":
    main()
