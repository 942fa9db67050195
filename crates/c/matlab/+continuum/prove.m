function is_proven = prove(varargin)
%CONTINUUM.PROVE  Writes a proof that a robot keeps the margin, and the mesh beside it as .obj.
%   is_proven = continuum.prove(mesh, points, radii, 'margin', margin, 'file', name, ...)
%
%   points: N x 3, the centreline from the base to the tip.
%   radii: one number, or N - 1, one for each segment.
%   'pose': 4 x 4, from the robot's frame to the mesh's; the identity without it.
%   'caps': 'fitted' (flat tips and steps, filled bends), 'capsules' or 'cylinders'.
%
%   A short Python program checks it: docs/book/check_proof.py. False if the margin is not kept.
%
%   See also continuum.clears
    is_proven = continuum_mex('prove', varargin{:});
end
