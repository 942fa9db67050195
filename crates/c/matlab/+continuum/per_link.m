function found = per_link(varargin)
%CONTINUUM.PER_LINK  Finds where each link of a robot is closest to a mesh.
%   found = continuum.per_link(mesh, points, radii, ...)
%
%   points: N x 3, the centreline from the base to the tip, or N x 3 x B for B robots.
%   radii: one number, or N - 1, one for each segment.
%   'pose': 4 x 4, from the robot's frame to the mesh's, or 4 x 4 x B; the identity without it.
%   'caps': 'fitted' (flat tips and steps, filled bends), 'capsules' or 'cylinders'.
%
%   The fields are those of continuum.minimum, with a row for each segment that has a length.
%   found.robot: which of B robots the row is about; they run on all cores.
%
%   See also continuum.minimum
    found = continuum_mex('per_link', varargin{:});
end
