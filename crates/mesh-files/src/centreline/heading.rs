//! The columns of a table of points, and the units of length that their names state.
//!
//! # Choice of the coordinates
//! 1. Columns named x, y, z or r, a, s or l, p, s, or ParaView's `Points:0` to `Points:2`.
//! 2. Otherwise the only triple of names that end or begin with x, y, z and may be a position, such
//!    as `pos_x` or `Tx`. Rotations, directions, velocities and forces are none.
//!
//! Two triples that may be the position are an error, which names both. So are two columns that may
//! be the radius. A triple whose name does not say that it is a position is read with a doubt.

use crate::Frame;
use crate::text::{shown, to_mm, unit_in_mm};

/// What is wrong with a line.
pub struct Fault {
    pub line: usize,
    pub problem: String,
}

pub fn fault<T>(line: usize, problem: String) -> Result<T, Fault> {
    Err(Fault { line, problem })
}

/// A heading: its line number and its names.
pub struct Heading {
    pub line: usize,
    pub names: Vec<Name>,
}

/// The name of a column.
pub struct Name {
    /// As it stands in the file.
    written: String,
    /// In lower case, without the unit, and with underscores for spaces and marks.
    own: String,
    unit: Option<String>,
}

impl Name {
    pub fn new(word: &str) -> Self {
        let (own, unit) = split_unit(word);
        let own: String =
            own.to_lowercase().chars().map(|c| if c.is_alphanumeric() { c } else { '_' }).collect();
        let unit = unit.map(|unit| unit.trim().to_owned()).filter(|unit| !unit.is_empty());
        Self { written: word.to_owned(), own: own.trim_matches('_').to_owned(), unit }
    }

    /// Adds the unit of a second line of the heading. Returns the name's own unit if that is
    /// another one.
    pub fn set_unit(&mut self, word: &str) -> Result<(), &str> {
        let inner = word.trim_matches(['[', ']', '(', ')', ' ']);
        if inner.is_empty() {
            return Ok(());
        }
        let unit = self.unit.get_or_insert_with(|| inner.to_owned());
        if unit == inner || length(unit) == length(inner) { Ok(()) } else { Err(unit) }
    }

    pub fn has_unit(&self) -> bool {
        self.unit.is_some()
    }

    pub fn has_digit(&self) -> bool {
        self.own.contains(char::is_numeric)
    }

    /// Returns whether this is a name of the list, for names that are written in several ways.
    fn is_any(&self, list: &[&str]) -> bool {
        let bare = self.own.replace('_', "");
        list.contains(&bare.as_str())
    }
}

/// Returns the names of the columns. A unit after a space belongs to the name before it.
pub fn names(words: &[&str]) -> Vec<Name> {
    let mut names: Vec<Name> = Vec::new();
    for word in words {
        let name = Name::new(word);
        match names.last_mut() {
            // A second bracket says something else.
            Some(last) if name.own.is_empty() && name.unit.is_some() => {
                last.unit = last.unit.take().or(name.unit);
            }
            _ => names.push(name),
        }
    }
    names
}

/// Returns a name and its unit: in brackets, after a slash, or a known unit after a space or a
/// mark.
fn split_unit(word: &str) -> (&str, Option<&str>) {
    if let Some((name, unit)) = word.split_once(['[', '(', '{']) {
        return (name, unit.split([']', ')', '}']).next());
    }
    match word.rsplit_once(['_', ' ', '/', '-', '.']) {
        Some((name, unit)) if word[name.len()..].starts_with('/') || length(unit).is_some() => {
            (name, Some(unit))
        }
        _ => (word, None),
    }
}

/// Returns the number of millimetres of a unit. The French scale of catheters has thirds.
fn length(unit: &str) -> Option<f64> {
    let unit = unit.trim().to_lowercase();
    match unit.as_str() {
        "in" | "inch" | "inches" | "\"" => Some(25.4),
        "fr" | "french" | "ch" | "charriere" | "charri\u{e8}re" => Some(1.0 / 3.0),
        unit => unit_in_mm(unit),
    }
}

/// Returns whether a line holds the units of the heading above it.
pub fn is_units(words: &[&str]) -> bool {
    let is_bare = |word: &str| word.trim_matches(['[', ']', '(', ')', ' ', '-']).is_empty();
    let is_bracketed = |word: &str| word.starts_with(['[', '(']) && word.ends_with([']', ')']);
    words.iter().all(|word| is_bare(word) || is_bracketed(word) || length(word).is_some())
        && words.iter().any(|word| !is_bare(word))
}

/// The columns of a table.
pub struct Columns {
    pub axes: [usize; 3],
    pub radius: Option<usize>,
    /// The factor of the radii: 1/2 for diameters.
    pub radius_factor: f64,
    /// The millimetres of the unit of the coordinates and of the radius, if it is stated.
    units: [Option<f64>; 2],
    /// The column of the number of the shape, in a table of shapes.
    pub shape: Option<usize>,
    /// The columns that may number the lines of a file, the most likely one first.
    pub lines: Vec<usize>,
    /// The columns that may tell the robots of a file apart, or their times. Points may have times
    /// of their own.
    pub times: Vec<usize>,
    /// The column in which 3D Slicer says whether a point has a position.
    pub defined: Option<usize>,
    pub frame: Option<Frame>,
    /// What makes the choice of the columns doubtful.
    pub doubts: Vec<String>,
    /// The number of columns that a line may have.
    pub most: usize,
    pub has_heading: bool,
    /// The line of the heading.
    pub line: usize,
}

impl Columns {
    /// Returns the columns of a table without a heading.
    pub fn plain(first: usize) -> Self {
        Self {
            axes: [first, first + 1, first + 2],
            radius: Some(first + 3),
            radius_factor: 1.0,
            units: [None; 2],
            shape: (first > 0).then_some(0),
            lines: Vec::new(),
            times: Vec::new(),
            defined: None,
            frame: None,
            doubts: Vec::new(),
            most: first + 4,
            has_heading: false,
            line: 1,
        }
    }

    /// Returns the columns that a heading names. `first` is 1 in a table of shapes, where the
    /// column of the shape comes first unless it has a name.
    pub fn named(heading: &Heading, first: usize) -> Result<Self, Fault> {
        let Heading { line, names } = heading;
        let column = |name: &str| names.iter().position(|own| own.own == name);
        let shape = (first > 0).then(|| column("shape").unwrap_or(0));
        if let Some(column) = misplaced(names) {
            let name = shown(&names[column].written);
            return fault(*line, format!("has '{name}' in column {}", column + 1));
        }
        let is_free = |column: usize| shape != Some(column);
        let Position { axes, frame, doubt } = position(*line, names, &is_free)?;
        let is_free = |column: &usize| is_free(*column) && !axes.contains(column);
        let named = |list| {
            let is_it = move |column: &usize| names[*column].is_any(list) && is_free(column);
            (0..names.len()).filter(is_it)
        };
        let radii: Vec<_> = RADIUS
            .iter()
            .flat_map(|(list, factor)| named(list).map(move |column| (column, *factor)))
            .collect();
        if let [(first, _), (second, _), ..] = radii[..] {
            let [first, second] = [first, second].map(|column| shown(&names[column].written));
            return fault(
                *line,
                format!("has '{first}' and '{second}', and both may be the radius"),
            );
        }
        let (radius, radius_factor) = radii.first().copied().unzip();
        let of_lists = |lists: &'static [&'static str]| {
            lists.iter().filter_map(|name| named(std::slice::from_ref(name)).next())
        };
        let mut columns = Self {
            axes,
            radius,
            radius_factor: radius_factor.unwrap_or(1.0),
            units: [None; 2],
            shape,
            lines: if first == 0 { of_lists(&LINES).collect() } else { Vec::new() },
            times: if first == 0 { of_lists(&TIMES).collect() } else { Vec::new() },
            defined: column("defined").filter(&is_free),
            frame,
            doubts: doubt.into_iter().collect(),
            most: names.len(),
            has_heading: true,
            line: *line,
        };
        columns.units = columns.stated_units(heading)?;
        Ok(columns)
    }

    /// Returns the units of the coordinates and of the radius.
    ///
    /// # Errors
    /// A unit is unknown, or the coordinates have different units, or only they have one that is
    /// not the millimetre.
    fn stated_units(&self, heading: &Heading) -> Result<[Option<f64>; 2], Fault> {
        let unit = |column: usize| {
            let Some(name) = &heading.names[column].unit else { return Ok(None) };
            match length(name) {
                Some(unit) => Ok(Some(unit)),
                None => fault(
                    heading.line,
                    format!(
                        "has '{}' in column {}, whose unit '{}' is unknown; use mm, cm, m, um or in",
                        shown(&heading.names[column].written),
                        column + 1,
                        shown(name)
                    ),
                ),
            }
        };
        let [x, y, z] = self.axes;
        let units = [unit(x)?, unit(y)?, unit(z)?];
        let written = |column: usize| shown(&heading.names[column].written);
        if let Some(axis) = (1..3).find(|&axis| units[axis] != units[0]) {
            let [a, b] = [written(x), written(self.axes[axis])];
            return fault(heading.line, format!("has different units in '{a}' and '{b}'"));
        }
        let radius = self.radius.map(unit).transpose()?.flatten();
        if let (Some(column), None, Some(own)) = (self.radius, radius, units[0])
            && own != 1.0
        {
            let (name, column) = (written(column), column + 1);
            return fault(
                heading.line,
                format!("has '{name}' in column {column} without a unit, beside '{}'", written(x)),
            );
        }
        Ok([units[0], radius])
    }

    /// Returns whether the coordinates are converted to millimetres.
    pub fn states_unit(&self) -> bool {
        self.units[0].is_some()
    }

    /// Returns whether only the radius has a unit, so that a scale of the coordinates does not
    /// apply to it.
    pub fn states_radius_only(&self) -> bool {
        self.units[0].is_none() && self.units[1].is_some()
    }

    pub fn coordinate(&self, x: f64) -> f64 {
        to_mm(x, self.units[0].unwrap_or(1.0))
    }

    pub fn radius_of(&self, number: f64) -> f64 {
        to_mm(number * self.radius_factor, self.units[1].unwrap_or(1.0))
    }

    /// Returns the last column that every line has.
    pub fn last(&self) -> usize {
        self.axes.into_iter().chain(self.shape).fold(0, usize::max)
    }
}

/// The names of a column of radii or of diameters, and the factor to radii.
const RADIUS: [(&[&str], f64); 2] = [
    (
        &[
            "radius",
            "radii",
            "rad",
            "r",
            "outerradius",
            "radiusout",
            "rout",
            "tuberadius",
            "linkradius",
        ],
        1.0,
    ),
    (
        &[
            "diameter",
            "diameters",
            "dia",
            "diam",
            "od",
            "outerdiameter",
            "diameterout",
            "tubediameter",
        ],
        0.5,
    ),
];

/// The names of a column that numbers the lines of a file.
const LINES: [&str; 26] = [
    "centerlineids",
    "centerlineid",
    "centerline",
    "centrelineid",
    "centreline",
    "lineid",
    "lineids",
    "line",
    "branchid",
    "branchids",
    "branch",
    "shapeid",
    "shape",
    "curveid",
    "curve",
    "pathid",
    "path",
    "vesselid",
    "vessel",
    "groupids",
    "groupid",
    "group",
    "tractids",
    "segmentids",
    "segmentid",
    "segment",
];

/// The names of a column that may tell robots apart, or the times of one robot.
const TIMES: [&str; 16] = [
    "robot",
    "robotid",
    "id",
    "config",
    "configuration",
    "pose",
    "frame",
    "step",
    "timestep",
    "sample",
    "trial",
    "run",
    "time",
    "timestamp",
    "t",
    "ms",
];

/// Stems of names with x, y, z that say that they are a position.
const POSITION: [&str; 36] = [
    "p",
    "pos",
    "position",
    "posicion",
    "posizione",
    "point",
    "points",
    "pt",
    "punkt",
    "coord",
    "coords",
    "coordinate",
    "coordinates",
    "koordinate",
    "koordinaten",
    "coordonnee",
    "coordonn\u{e9}e",
    "coordenada",
    "coordinata",
    "t",
    "trans",
    "translation",
    "c",
    "center",
    "centre",
    "loc",
    "location",
    "tip",
    "base",
    "marker",
    "sensor",
    "node",
    "vertex",
    "xyz",
    "ras",
    "lps",
];

/// Stems of names with x, y, z that are no position: rotations, quaternions, directions,
/// curvatures, velocities, forces, statistics, and places that are not in a unit of length.
const NO_POSITION: [&str; 80] = [
    "r",
    "rot",
    "rotation",
    "rotvec",
    "angle",
    "angles",
    "euler",
    "q",
    "quat",
    "quaternion",
    "o",
    "orient",
    "orientation",
    "n",
    "normal",
    "normals",
    "tan",
    "tangent",
    "tangents",
    "frenettangent",
    "frenetnormal",
    "frenetbinormal",
    "d",
    "dir",
    "direction",
    "directions",
    "axis",
    "b",
    "binormal",
    "binormals",
    "k",
    "kappa",
    "curv",
    "curvature",
    "curvatures",
    "u",
    "e",
    "strain",
    "stress",
    "v",
    "vel",
    "velocity",
    "velocities",
    "speed",
    "w",
    "omega",
    "angvel",
    "angularvelocity",
    "a",
    "acc",
    "accel",
    "acceleration",
    "f",
    "force",
    "forces",
    "m",
    "moment",
    "moments",
    "tau",
    "torque",
    "torques",
    "size",
    "scale",
    "color",
    "colour",
    "std",
    "sigma",
    "err",
    "error",
    "var",
    "i",
    "idx",
    "index",
    "px",
    "pixel",
    "pixels",
    "voxel",
    "vox",
    "norm",
    "normalized",
];

/// Three columns whose names have a stem in common.
struct Triple {
    stem: String,
    letters: [char; 3],
    /// Whether the letter stands in front of the stem.
    is_prefix: bool,
    columns: [Option<usize>; 3],
    is_twice: bool,
}

const XYZ: [char; 3] = ['x', 'y', 'z'];
const RAS: [char; 3] = ['r', 'a', 's'];
const LPS: [char; 3] = ['l', 'p', 's'];
/// ParaView numbers the components of points.
const NUMBERED: [char; 3] = ['0', '1', '2'];

impl Triple {
    fn is_exact(&self) -> bool {
        self.stem.is_empty() || self.letters == NUMBERED
    }

    fn columns(&self) -> Option<[usize; 3]> {
        let [Some(x), Some(y), Some(z)] = self.columns else { return None };
        Some([x, y, z])
    }

    fn bare_stem(&self) -> String {
        self.stem.replace('_', "")
    }

    fn frame(&self) -> Option<Frame> {
        match (self.letters, self.stem.as_str()) {
            (RAS, _) | (_, "ras") => Some(Frame::Ras),
            (LPS, _) | (_, "lps") => Some(Frame::Lps),
            _ => None,
        }
    }
}

/// Returns all complete triples of names, in the order of their first columns.
fn triples(names: &[Name], is_free: &dyn Fn(usize) -> bool) -> Vec<Triple> {
    let mut triples: Vec<Triple> = Vec::new();
    let mut add = |column: usize, letters: [char; 3], axis: usize, stem: &str, is_prefix: bool| {
        let stem = stem.trim_matches('_');
        let is_it = |triple: &&mut Triple| {
            triple.letters == letters && triple.stem == stem && triple.is_prefix == is_prefix
        };
        match triples.iter_mut().find(is_it) {
            Some(triple) => {
                triple.is_twice |= triple.columns[axis].is_some();
                triple.columns[axis].get_or_insert(column);
            }
            None => {
                let mut columns = [None; 3];
                columns[axis] = Some(column);
                let stem = stem.to_owned();
                triples.push(Triple { stem, letters, is_prefix, columns, is_twice: false });
            }
        }
    };
    for (column, name) in names.iter().enumerate().filter(|(column, _)| is_free(*column)) {
        let own = name.own.as_str();
        for letters in [RAS, LPS] {
            if let Some(axis) = letters.iter().position(|letter| own.chars().eq([*letter])) {
                add(column, letters, axis, "", false);
            }
        }
        for (axis, letter) in XYZ.into_iter().enumerate() {
            if let Some(stem) = own.strip_suffix(letter) {
                add(column, XYZ, axis, stem, false);
            }
            if let Some(stem) = own.strip_prefix(letter).filter(|stem| !stem.is_empty()) {
                add(column, XYZ, axis, stem, true);
            }
        }
        if let Some(stem) = own.strip_suffix(NUMBERED)
            && stem == "points_"
            && let Some(axis) = NUMBERED.iter().position(|letter| own.ends_with(*letter))
        {
            add(column, NUMBERED, axis, stem, false);
        }
    }
    triples.retain(|triple| triple.columns().is_some());
    triples
}

/// Returns whether three of the names are coordinates.
pub fn has_coordinates(names: &[Name]) -> bool {
    !triples(names, &|_| true).is_empty()
}

/// The columns of the position.
struct Position {
    axes: [usize; 3],
    /// The frame that their names state.
    frame: Option<Frame>,
    /// That the names do not say what they are.
    doubt: Option<String>,
}

/// Returns the columns of the position.
fn position(
    line: usize,
    names: &[Name],
    is_free: &dyn Fn(usize) -> bool,
) -> Result<Position, Fault> {
    let triples = triples(names, is_free);
    let exact: Vec<_> = triples.iter().filter(|triple| triple.is_exact()).collect();
    // A column of t is a torque beside forces, and a translation otherwise.
    let has_forces = triples.iter().any(|triple| triple.stem == "f");
    let may_be = |triple: &&Triple| {
        let is_torque = has_forces && triple.stem == "t";
        !is_torque && !NO_POSITION.contains(&triple.bare_stem().as_str())
    };
    let candidates = if exact.is_empty() { triples.iter().filter(may_be).collect() } else { exact };
    let written = |triple: &Triple| {
        let column = triple.columns[0].unwrap_or_default();
        (shown(&names[column].written), column + 1)
    };
    match candidates[..] {
        [triple] if !triple.is_twice => {
            let axes = triple.columns().unwrap_or_default();
            let is_known = triple.is_exact() || POSITION.contains(&triple.bare_stem().as_str());
            let doubt = (!is_known).then(|| {
                let [x, y, z] = axes.map(|column| shown(&names[column].written));
                format!(
                    "'{x}', '{y}' and '{z}' are read as the position, but their names do not say \
                     what they are; name the position x, y and z"
                )
            });
            Ok(Position { axes, frame: triple.frame(), doubt })
        }
        [triple] => {
            let (name, _) = written(triple);
            fault(line, format!("has several columns '{name}'"))
        }
        [first, second, ..] => {
            let [(a, _), (b, _)] = [first, second].map(written);
            fault(line, format!("has '{a}' and '{b}', and both may be the position"))
        }
        [] => {
            let wrong = |(axis, column): (char, usize)| {
                let name = names.get(column).filter(|_| is_free(column))?;
                let is_named = name.own.starts_with(axis) || name.own.ends_with(axis);
                (!is_named).then(|| {
                    format!("has '{}' in column {}, not {axis}", shown(&name.written), column + 1)
                })
            };
            let first = usize::from(!is_free(0));
            let plain = || XYZ.into_iter().zip(first..).find_map(wrong);
            let problem = match triples.first().map(written) {
                Some((name, column)) => {
                    format!("has '{name}' in column {column}, which is no position")
                }
                None => plain().unwrap_or_else(|| "has no names of three coordinates".into()),
            };
            fault(line, problem)
        }
    }
}

/// Returns the column of a heading that names x, y or z out of order. Without an x, y and z belong
/// to the first columns, or those after a column of shapes.
fn misplaced(names: &[Name]) -> Option<usize> {
    let axis = |name: &Name| XYZ.iter().position(|axis| name.own.chars().eq([*axis]));
    let start = names.iter().position(|name| name.own == "x");
    let is_shape = names.first().is_some_and(|name| name.own == "shape");
    let start = start.unwrap_or(usize::from(is_shape));
    (0..names.len()).find(|&column| axis(&names[column]).is_some_and(|axis| start + axis != column))
}
