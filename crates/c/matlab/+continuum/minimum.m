function found = minimum(varargin)
%CONTINUUM.MINIMUM  Finds where a robot is closest to a mesh.
%   found = continuum.minimum(mesh, points, radii, ...)
%
%   points: N x 3, the centreline from the base to the tip, or N x 3 x B for B robots.
%   radii: one number, or N - 1, one for each segment.
%   'pose': 4 x 4, from the robot's frame to the mesh's, or 4 x 4 x B; the identity without it.
%   'caps': 'fitted' (flat tips and steps, filled bends), 'capsules' or 'cylinders'.
%
%   found.distance is 0 where they touch or overlap;
%   on_robot and on_mesh are the closest points, segment and triangle count from 1,
%   arc_length is measured from the base.
%   Of B robots each field has B rows; they run on all cores.
%
%   See also continuum.distance, continuum.per_link, continuum.clears
    found = continuum_mex('minimum', varargin{:});
end
