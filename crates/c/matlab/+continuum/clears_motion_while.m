function found = clears_motion_while(varargin)
%CONTINUUM.CLEARS_MOTION_WHILE  Says whether a motion keeps the margin while the mesh moves, too.
%   found = continuum.clears_motion_while(mesh, vertices, motion, 'margin', margin, ...
%                                         'resolution', resolution)
%
%   vertices: N x 3, to which the vertices of the mesh move, straight and evenly.
%
%   The fields are those of continuum.clears_motion.
%
%   See also continuum.clears_motion
    found = continuum_mex('clears_motion_while', varargin{:});
end
