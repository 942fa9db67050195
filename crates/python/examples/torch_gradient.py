"""The distance as a function that PyTorch differentiates: `pip install torch`."""

import torch

from parry_continuum import Mesh


class Distance(torch.autograd.Function):
    """``Distance.apply(mesh, points, radii, pose)``, as `Mesh.distance_and_gradient` has it."""

    @staticmethod
    def forward(ctx, mesh, points, radii, pose):
        given = [array.detach().cpu().double().numpy() for array in (points, radii, pose)]
        found = mesh.distance_and_gradient(given[0], given[1], pose=given[2])
        ctx.save_for_backward(*(torch.as_tensor(part).to(points) for part in found[1:4]))
        return points.new_tensor(found.value)

    @staticmethod
    def backward(ctx, cotangent):
        def times(part):
            return cotangent.reshape(cotangent.shape + (1,) * (part.dim() - cotangent.dim())) * part

        return None, *(times(part) for part in ctx.saved_tensors)


def main():
    floor = Mesh([[-90, -90, 0], [90, -90, 0], [0, 90, 0]], [[0, 1, 2]])
    radii, pose = torch.full((20,), 0.5).double(), torch.eye(4).double()

    def lengthened(length, angle):
        """An arc of this length that turns by the angle, on its way down to the floor."""
        share = torch.linspace(0, 1, 21).double() * angle[..., None]
        points = torch.stack([1 - torch.cos(share), 0 * share, 30 * angle[..., None] / length[..., None] - torch.sin(share)], -1)
        return Distance.apply(floor, (length / angle)[..., None, None] * points, radii, pose)

    one = (torch.tensor(20.0).double().requires_grad_(), torch.tensor(0.7).double().requires_grad_())
    many = (torch.linspace(10, 20, 30).double().requires_grad_(), torch.linspace(0.2, 1, 30).double().requires_grad_())
    assert torch.autograd.gradcheck(lengthened, one) and torch.autograd.gradcheck(lengthened, many)
    lengthened(*one).backward()
    print("the distance changes by", round(one[0].grad.item(), 3), "for each unit of length")


if __name__ == "__main__":
    main()
