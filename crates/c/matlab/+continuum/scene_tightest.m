function found = scene_tightest(varargin)
%CONTINUUM.SCENE_TIGHTEST  Finds the least slack in a scene: the distance less the margin.
%   found = continuum.scene_tightest(scene, robots, ...)
%
%   robots: as for continuum.scene_clears.
%
%   found.slack, found.structure (NaN between robots), found.robots, found.on_first,
%   found.on_second. Of B sets the fields have B rows.
%
%   See also continuum.scene_clears
    found = continuum_mex('scene_tightest', varargin{:});
end
