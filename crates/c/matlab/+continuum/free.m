function free(varargin)
%CONTINUUM.FREE  Frees a mesh, a motion or a scene.
%   continuum.free(handle)
%
%   What was made of it stays.
%
%   See also continuum.mesh
    continuum_mex('free', varargin{:});
end
