function found = distance_and_gradient(varargin)
%CONTINUUM.DISTANCE_AND_GRADIENT  The distance, and its derivative by every point and radius.
%   found = continuum.distance_and_gradient(mesh, points, radii, ...)
%
%   points: N x 3, the centreline from the base to the tip.
%   radii: one number, or N - 1, one for each segment.
%   'pose': 4 x 4, from the robot's frame to the mesh's; the identity without it.
%   'caps': 'fitted' (flat tips and steps, filled bends), 'capsules' or 'cylinders'.
%
%   found.value: the distance, negative where they overlap. found.points: N x 3, in the
%   robot's frame. found.radii: (N - 1) x 1.
%   found.kink: other points are as close, with another derivative.
%
%   See also continuum.minimum
    found = continuum_mex('distance_and_gradient', varargin{:});
end
