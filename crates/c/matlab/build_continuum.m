function build_continuum(prefix)
%BUILD_CONTINUUM  Compiles the gateway of the package continuum, in MATLAB or Octave.
%   build_continuum(prefix)
%
%   prefix: the folder that the library is installed in, with include and lib.
    here = fileparts(mfilename('fullpath'));
    if nargin < 1
        prefix = fullfile(here, '..', '..', '..');
    end
    source = fullfile(here, 'continuum_mex.c');
    include = ['-I' fullfile(prefix, 'include')];
    lib = ['-L' fullfile(prefix, 'lib')];
    if exist('OCTAVE_VERSION', 'builtin')
        args = {source, include, lib, '-lparry_continuum_c'};
        if isunix()
            args{end + 1} = ['-Wl,-rpath,' fullfile(prefix, 'lib')];
        end
        args = [args, {'-o', fullfile(here, 'continuum_mex.mex')}];
    else
        args = {source, include, lib, '-lparry_continuum_c', '-outdir', here};
        if isunix()
            args{end + 1} = ['LDFLAGS=$LDFLAGS -Wl,-rpath,' fullfile(prefix, 'lib')];
        end
    end
    mex(args{:});
end
