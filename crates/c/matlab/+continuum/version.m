function text = version(varargin)
%CONTINUUM.VERSION  The version of the library.
%   text = continuum.version()
%
%   See also continuum.mesh
    text = continuum_mex('version', varargin{:});
end
