//! One robot or many, as arrays describe them.

use super::counts::broadcast;
use super::names::Names;
use super::numbers::{Numbers, shape_text};
use super::poses::{Poses, pose_of};
use crate::error::Refused;
use crate::threads::Asked;
use parry_continuum::RobotError;
use parry_continuum::parry::math::{Pose, Vector};
use pyo3::prelude::*;
use std::ops::Range;

/// One robot or a batch, as Python passes them. Its methods need the GIL.
pub(crate) struct Robots<'py> {
    names: Names,
    /// What the function calls `more`.
    more_name: &'static str,
    /// How many robots the batch has; none where one robot was given, without a first index.
    pub count: Option<usize>,
    /// How many points each of them has; of a path, each of its shapes.
    pub points_each: usize,
    points: Numbers<'py>,
    /// More points: where a motion ends, or the directions of a curve.
    more: Option<Numbers<'py>>,
    /// Whether the points of one robot stand for all robots of a batch.
    more_is_one: bool,
    radii: Radii<'py>,
    poses: Poses<'py>,
    /// Whether the points of one robot stand for all robots of a batch.
    is_one: bool,
    /// The other robots, of questions about several.
    others: Option<Box<Robots<'py>>>,
}

enum Radii<'py> {
    Number(f64),
    Shared(Numbers<'py>),
    Each(Numbers<'py>),
}

/// Which robots of a batch share what.
#[derive(Clone, Copy, Default)]
struct Shared {
    points: bool,
    more: bool,
    radii: bool,
    pose: bool,
}

/// A copy of some robots, which needs no GIL. It is filled again and again.
#[derive(Default)]
pub(crate) struct Block {
    names: Names,
    /// The place of its first robot in the batch.
    first: usize,
    points_each: usize,
    more_each: usize,
    segments_each: usize,
    points: Vec<Vector>,
    more: Vec<Vector>,
    radii: Vec<f64>,
    matrices: Vec<[f64; 16]>,
    shared: Shared,
    others: Option<Box<Block>>,
}

/// One robot of a block.
#[derive(Clone, Copy)]
pub(crate) struct Given<'a> {
    /// What the function calls its parameters.
    pub names: Names,
    /// Its place in the batch.
    pub number: usize,
    pub points: &'a [Vector],
    pub more: &'a [Vector],
    pub radii: &'a [f64],
    matrix: Option<&'a [f64; 16]>,
    others: Option<(&'a Block, usize)>,
}

fn refuse(py: Python<'_>, text: String) -> PyErr {
    Refused::other("bad_shape", text).raise(py, None)
}

/// Points of one robot, (N, 3), or of many, (B, N, 3).
fn points<'py>(
    given: &Bound<'py, PyAny>,
    name: &str,
) -> PyResult<(Numbers<'py>, Option<usize>, usize)> {
    let numbers = Numbers::new(given, name)?;
    match *numbers.shape() {
        [each, 3] => Ok((numbers, None, each)),
        // An array without numbers may have any number of rows.
        [(1..), 0, 3] => {
            let text = format!(
                "`{name}` has the shape {}, robots without points; give at least two points for each",
                shape_text(numbers.shape())
            );
            Err(Refused::other("too_few_points", text).raise(given.py(), None))
        }
        [count, each, 3] => Ok((numbers, Some(count), each)),
        ref shape => {
            let advice = match *shape {
                // It may be three points without z too.
                [3, 2] | [_, 3, 2] => "give three coordinates for each point",
                [3, _] => "give its transpose, `.T`",
                [_, 3, _] => "give its transpose, `.swapaxes(1, 2)`",
                _ => "give a row of three coordinates for each point",
            };
            let text = format!(
                "`{name}` has the shape {}, not (N, 3) or (B, N, 3); {advice}",
                shape_text(shape)
            );
            Err(refuse(given.py(), text))
        }
    }
}

impl<'py> Robots<'py> {
    /// Robots by their points, radii and poses.
    pub(crate) fn new(
        names: Names,
        given: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
        pose: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Self> {
        let (points, own, points_each) = points(given, names.points)?;
        let (radii, radii_count) = Radii::new(radii, own, points_each, names)?;
        let count = broadcast(own, radii_count).unwrap_or(own);
        let (poses, poses_count) =
            pose.map_or(Ok((Poses::Identity, None)), |pose| Poses::new(pose, count, names.pose))?;
        let count = broadcast(count, poses_count).unwrap_or(count);
        Ok(Self {
            names,
            more_name: "",
            count,
            points_each,
            points,
            more: None,
            more_is_one: false,
            radii,
            poses,
            is_one: own != count,
            others: None,
        })
    }

    /// Paths, each of several shapes of one robot, (S, N, 3) or (B, S, N, 3). The points of a path
    /// are its shapes' points, one shape after the other.
    pub(crate) fn paths(
        name: &'static str,
        given: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
    ) -> PyResult<Self> {
        let points = Numbers::new(given, name)?;
        let (count, points_each) = match *points.shape() {
            [.., (1..), 0, 3] | [(1..), 0, _, 3] => {
                let text = format!(
                    "`{name}` has the shape {}, paths without shapes or shapes without points; give at least one shape, of at least \
                     two points",
                    shape_text(points.shape())
                );
                return Err(Refused::other("too_few_points", text).raise(given.py(), None));
            }
            [_, each, 3] => (None, each),
            [count, _, each, 3] => (Some(count), each),
            ref shape => {
                let text = format!(
                    "`{name}` has the shape {}, not (S, N, 3) or (B, S, N, 3); give S shapes of N points each",
                    shape_text(shape)
                );
                return Err(refuse(given.py(), text));
            }
        };
        let names = Names::one(name);
        let (radii, radii_count) = Radii::new(radii, count, points_each, names)?;
        let (own, count) = (count, broadcast(count, radii_count).unwrap_or(count));
        let poses = Poses::Identity;
        Ok(Self {
            names,
            more_name: "",
            count,
            points_each,
            points,
            more: None,
            more_is_one: false,
            radii,
            poses,
            is_one: own != count,
            others: None,
        })
    }

    /// The same with as many points more, such as those at which a motion ends. Of a batch and one,
    /// the one stands for all.
    pub(crate) fn with_as_many(
        mut self,
        name: &'static str,
        given: &Bound<'py, PyAny>,
        other: &str,
    ) -> PyResult<Self> {
        let (more, count, each) = points(given, name)?;
        if each != self.points_each || broadcast(self.count, count).is_none() {
            let text = format!(
                "`{name}` has the shape {}, and `{other}` has {}; give both the same shape, or a batch and one",
                shape_text(more.shape()),
                shape_text(self.points.shape())
            );
            return Err(refuse(given.py(), text));
        }
        self.set_more(name, more, count);
        Ok(self)
    }

    /// The same with directions of each robot's curve, at its two ends or at all of its points.
    /// `name` is the parameter's.
    pub(crate) fn with_tangents(
        mut self,
        name: &'static str,
        given: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Self> {
        let Some(given) = given else { return Ok(self) };
        let (tangents, count, each) = points(given, name)?;
        let fits = broadcast(self.count, count).is_some();
        if !fits || !(each == 2 || each == self.points_each) {
            let text = format!(
                "`{name}` has the shape {} beside points of {}; give two directions for each robot, at its ends, or one for \
                 each point",
                shape_text(tangents.shape()),
                shape_text(self.points.shape())
            );
            return Err(refuse(given.py(), text));
        }
        self.set_more(name, tangents, count);
        Ok(self)
    }

    /// Keeps more points, of as many robots or of one.
    fn set_more(&mut self, name: &'static str, more: Numbers<'py>, count: Option<usize>) {
        let all = broadcast(self.count, count).unwrap_or(self.count);
        self.is_one |= self.count != all;
        self.count = all;
        (self.more, self.more_name, self.more_is_one) = (Some(more), name, count != all);
    }

    /// These robots, each beside one of the others. Where there is one of either, it stands for as
    /// many as there are of the others.
    pub(crate) fn with_others(mut self, py: Python<'_>, mut others: Self) -> PyResult<Self> {
        let Some(count) = broadcast(self.count, others.count) else {
            let [one, other] = [self.count, others.count].map(Option::unwrap_or_default);
            let [first, second] = [self.names, others.names].map(|names| names.robot());
            let text = format!(
                "`{first}` has {one} robots and `{second}` {other}; give as many of both, or one of either"
            );
            return Err(refuse(py, text));
        };
        self.stand_for(count);
        others.stand_for(count);
        self.others = Some(Box::new(others));
        Ok(self)
    }

    fn stand_for(&mut self, count: Option<usize>) {
        self.is_one |= self.count != count;
        self.more_is_one |= self.count != count;
        self.count = count;
        if let Some(others) = &mut self.others {
            others.stand_for(count);
        }
    }

    /// How many segments each of them has.
    pub(crate) fn segments_each(&self) -> usize {
        self.points_each.saturating_sub(1)
    }
}

impl<'py> Asked for Robots<'py> {
    type Block = Block;
    type One<'a> = Given<'a>;

    fn count(&self) -> Option<usize> {
        self.count
    }

    fn one(block: &Block, place: usize) -> Given<'_> {
        block.robot(place)
    }

    fn copy(&self, robots: Range<usize>, block: &mut Block) -> Result<(), Refused> {
        let Names { points, radii, pose, .. } = self.names;
        self.points.check_unchanged(points)?;
        if let Some(more) = &self.more {
            more.check_unchanged(self.more_name)?;
        }
        if let Radii::Shared(numbers) | Radii::Each(numbers) = &self.radii {
            numbers.check_unchanged(radii)?;
        }
        self.poses.check_unchanged(pose)?;
        (block.first, block.names) = (robots.start, self.names);
        let copy_points = |from: &Numbers<'_>, is_one: bool, to: &mut Vec<Vector>| {
            let each = from.points().len() / if is_one { 1 } else { self.len().max(1) };
            to.clear();
            let range = if is_one { 0..each } else { each * robots.start..each * robots.end };
            to.extend(from.points()[range].iter().map(|&point| Vector::from_array(point)));
            each
        };
        block.points_each = copy_points(&self.points, self.is_one, &mut block.points);
        (block.more_each, block.segments_each) = (0, self.segments_each());
        block.more.clear();
        if let Some(more) = &self.more {
            block.more_each = copy_points(more, self.more_is_one, &mut block.more);
        }
        block.radii.clear();
        match &self.radii {
            Radii::Number(radius) => block.radii.resize(self.segments_each(), *radius),
            Radii::Shared(radii) => block.radii.extend(radii.values()),
            Radii::Each(radii) => {
                let each = self.segments_each();
                block.radii.extend(&radii.values()[each * robots.start..each * robots.end]);
            }
        }
        block.matrices.clear();
        block.matrices.extend(self.poses.matrices(robots.clone()));
        if let Some(others) = &self.others {
            others.copy(robots, block.others.get_or_insert_default())?;
        }
        block.shared = Shared {
            points: self.is_one,
            more: self.more_is_one,
            radii: !matches!(self.radii, Radii::Each(_)),
            pose: self.poses.is_one(),
        };
        Ok(())
    }
}

impl<'py> Radii<'py> {
    fn new(
        given: &Bound<'py, PyAny>,
        count: Option<usize>,
        points: usize,
        names: Names,
    ) -> PyResult<(Self, Option<usize>)> {
        if let Some(radius) = Numbers::single(given) {
            return Ok((Self::Number(radius), None));
        }
        let numbers = Numbers::new(given, names.radii)?;
        let segments = points.saturating_sub(1);
        let lengths_differ = |radii: usize| {
            let (parameter, expected) = (names.radii, segments);
            let error = RobotError::LengthsDiffer { parameter, points, expected, radii };
            Refused::Robot(error)
        };
        let name = names.radii;
        let of_robots = format!(
            "one radius for each robot is `{name}[:, None] * np.ones({segments})`, of the shape (B, {segments})"
        );
        let refused = match (numbers.shape(), count) {
            ([], _) => return Ok((Self::Number(numbers.values()[0]), None)),
            (&[radii], _) if radii == segments || points < 2 => {
                return Ok((Self::Shared(numbers), None));
            }
            (&[1, radii], _) if radii == segments => return Ok((Self::Shared(numbers), Some(1))),
            (&[robots, radii], _)
                if radii == segments && broadcast(count, Some(robots)).is_some() =>
            {
                return Ok((Self::Each(numbers), Some(robots)));
            }
            (&[radii], Some(count)) if radii == count && count > 1 => {
                lengths_differ(radii).with_advice(&of_robots)
            }
            (&[radii], _) => lengths_differ(radii),
            (&[robots, 1], _) if broadcast(count, Some(robots)).is_some() => {
                lengths_differ(1).with_advice(&of_robots)
            }
            (&[robots, radii], Some(count)) if robots == count => lengths_differ(radii),
            (shape, _) => {
                let fit = match count {
                    None | Some(1) => format!(" or (B, {segments})"),
                    Some(count) => format!(" or ({count}, {segments})"),
                };
                let text = format!(
                    "`{name}` has the shape {}; give a number, or the shape ({segments},){fit}: one radius for each segment",
                    shape_text(shape)
                );
                Refused::other("bad_shape", text)
            }
        };
        Err(refused.raise(given.py(), None))
    }
}

impl Block {
    /// The robot at this place in the block.
    pub(crate) fn robot(&self, place: usize) -> Given<'_> {
        let of = |each: usize| each * place..each * (place + 1);
        let segments = of(self.segments_each);
        let of = |each: usize, is_one: bool| if is_one { 0..each } else { of(each) };
        Given {
            names: self.names,
            number: self.first + place,
            points: &self.points[of(self.points_each, self.shared.points)],
            more: &self.more[of(self.more_each, self.shared.more)],
            radii: if self.shared.radii { &self.radii } else { &self.radii[segments] },
            matrix: self.matrices.get(if self.shared.pose { 0 } else { place }),
            others: self.others.as_deref().map(|block| (block, place)),
        }
    }
}

impl<'a> Given<'a> {
    /// The other robot, of a question about several.
    pub(crate) fn other(&self) -> Option<Given<'a>> {
        self.others.map(|(block, place)| block.robot(place))
    }

    /// This robot and the others of a question about several, in order.
    pub(crate) fn all(self) -> impl Iterator<Item = Self> {
        std::iter::successors(Some(self), Self::other)
    }

    /// The robot's pose in the mesh's frame.
    pub(crate) fn pose(&self) -> Result<Pose, Refused> {
        let pose = self.matrix.map_or(Ok(Pose::IDENTITY), pose_of);
        pose.map_err(|refused| self.names.in_entry(refused.of(self.names.pose)))
    }
}
