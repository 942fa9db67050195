function is_clear = clears(varargin)
%CONTINUUM.CLEARS  Says whether a robot keeps more than the margin away.
%   is_clear = continuum.clears(mesh, points, radii, 'margin', margin, ...)
%
%   points: N x 3, the centreline from the base to the tip, or N x 3 x B for B robots.
%   radii: one number, or N - 1, one for each segment.
%   'pose': 4 x 4, from the robot's frame to the mesh's, or 4 x 4 x B; the identity without it.
%   'caps': 'fitted' (flat tips and steps, filled bends), 'capsules' or 'cylinders'.
%
%   Of B robots it is B x 1; they run on all cores.
%
%   See also continuum.clears_inside, continuum.clears_motion
    is_clear = continuum_mex('clears', varargin{:});
end
