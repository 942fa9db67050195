function found = per_link(varargin)
%CONTINUUM.PER_LINK  Finds where each link of a robot is closest to a mesh.
%   found = continuum.per_link(mesh, points, radii, ...)
%
%   points: N x 3, the centreline from the base to the tip.
%   radii: one number, or N - 1, one for each segment.
%   'pose': 4 x 4, from the robot's frame to the mesh's; the identity without it.
%   'caps': 'fitted' (flat tips and steps, filled bends), 'capsules' or 'cylinders'.
%
%   The fields are those of continuum.minimum, with a row for each segment that has a length.
%
%   See also continuum.minimum
    found = continuum_mex('per_link', varargin{:});
end
