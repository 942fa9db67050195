function found = clears_inside(varargin)
%CONTINUUM.CLEARS_INSIDE  Says whether a robot keeps the margin, and whether it is inside.
%   found = continuum.clears_inside(mesh, points, radii, 'margin', margin, ...)
%
%   points: N x 3, the centreline from the base to the tip.
%   radii: one number, or N - 1, one for each segment.
%   'pose': 4 x 4, from the robot's frame to the mesh's; the identity without it.
%   'caps': 'fitted' (flat tips and steps, filled bends), 'capsules' or 'cylinders'.
%
%   found.holds: the whole robot is inside and keeps the margin. found.clears: it keeps the margin.
%   found.base and found.tip: -1 inside, 1 outside, 0 undecided.
%
%   See also continuum.side, continuum.clears
    found = continuum_mex('clears_inside', varargin{:});
end
