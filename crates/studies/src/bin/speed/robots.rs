//! Two robots beside one another, and one that coils beside itself: this crate's search, every pair
//! of links in turn, and parry's shapes.

use crate::Effort;
use continuum_demo::timing::medians;
use parry_continuum::distance::{Vec3, modified_cylinder_modified_cylinder, segment_segment};
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::query::{self, ClosestPoints};
use parry_continuum::parry::shape::{Capsule, Compound, SharedShape};
use parry_continuum::proximity::{RobotPair, SelfQuery};
use parry_continuum::{Cap, Chain, ModifiedCylinder};
use std::f64::consts::{PI, TAU};
use std::fmt::{Display, Write};
use std::hint::black_box;
use std::time::Duration;

/// Between these marks the page has the chapter.
pub const MARK: &str = "robots";

/// How many places the second robot takes beside the first.
const PLACES: u32 = 60;

/// How far the plane of the second robot is from that of the first: they never touch.
const BESIDE: f64 = 4.0;

/// The chapter of the page, without its marks.
pub fn chapter(effort: Effort, written: &str) -> Result<String, String> {
    let mut page = format!(
        "## Robots beside robots\n\n\
         {written}. Two bent robots of 30 links with flat tips: the second moves past the first in {PLACES} places \
         and never touches it. And a coil of three turns beside itself. Microseconds per query, in bursts. Searches and \
         loops over all pairs find the same distances, within rounding; parry's distances are for capsules.\n\n\
         - Every link: the distance of each pair, bounded by the least so far or by the margin. The axes' distance \
         less both radii prunes pairs.\n\
         - Every segment: the distance of the axes less both radii and no more, for all pairs.\n\
         - parry, capsules: `closest_points` of each pair, never farther than the least so far or the margin. parry, compounds: \
         `distance` of two compounds of capsules.\n\
         - For a robot and itself the loops leave out only neighbours, and find parts that are near because they are \
         near along the robot.\n\n\
         | robots | question | goal | cold | in a loop | every link | every segment | parry, capsules | parry, compounds |\n\
         |---|---|---|---|---|---|---|---|---|\n"
    );
    for (name, offset) in [("near", 26.0), ("far", 80.0)] {
        two_robots(effort, name, offset, &mut page)?;
    }
    for links in [60, 100] {
        one_robot(effort, links, &mut page)?;
    }
    Ok(page)
}

/// A robot of 30 links that bends to one side.
fn bent(side: f64) -> Result<Chain, String> {
    let point = |k: i32| {
        let s = f64::from(k) * 2.0;
        let turn = s / 45.0;
        Vector::new(side * 45.0 * (1.0 - turn.cos()), 0.3 * s * (s / 20.0).sin(), 45.0 * turn.sin())
    };
    let points: Vec<_> = (0..=30).map(point).collect();
    Chain::from_centreline(&points, &[1.0; 30]).map_err(text)
}

/// A coil of three turns.
fn coil(links: i32) -> Result<Chain, String> {
    let point = |k: i32| {
        let turn = f64::from(k) * 3.0 * TAU / f64::from(links);
        Vector::new(10.0 * turn.cos(), 10.0 * turn.sin(), 4.0 * turn / PI)
    };
    let points: Vec<_> = (0..=links).map(point).collect();
    Chain::from_centreline(&points, &vec![0.8; links as usize]).map_err(text)
}

pub fn text(error: impl Display) -> String {
    error.to_string()
}

fn axis(link: &ModifiedCylinder) -> [Vec3<f64>; 2] {
    [link.start(), link.end()].map(|point| Vec3::from(point.to_array()))
}

fn axes_apart(one: &ModifiedCylinder, two: &ModifiedCylinder) -> f64 {
    segment_segment(axis(one), axis(two)).distance - one.radius() - two.radius()
}

/// The nearer of a distance and that of two links; the distance where the capsules around them are
/// farther apart.
fn nearer(least: f64, one: &ModifiedCylinder, two: &ModifiedCylinder) -> f64 {
    if axes_apart(one, two) > least {
        return least;
    }
    let flat = |link: &ModifiedCylinder| link.caps().map(|cap| cap == Cap::Flat);
    let (flat1, flat2) = (flat(one), flat(two));
    let found = modified_cylinder_modified_cylinder(
        axis(one),
        one.radius(),
        flat1,
        axis(two),
        two.radius(),
        flat2,
    );
    found.distance.min(least)
}

/// The nearer of a distance and parry's of two capsules.
fn parry_nearer(least: f64, one: &Capsule, place: &Pose, two: &Capsule) -> Result<f64, String> {
    match query::closest_points(&Pose::IDENTITY, one, place, two, least).map_err(text)? {
        ClosestPoints::Intersecting => Ok(0.0),
        ClosestPoints::WithinMargin(a, b) => Ok(least.min((a - b).length())),
        ClosestPoints::Disjoint => Ok(least),
    }
}

fn capsules(robot: &Chain) -> Vec<Capsule> {
    robot.links().iter().map(|link| Capsule::new(link.start(), link.end(), link.radius())).collect()
}

fn compound(capsules: &[Capsule]) -> Compound {
    Compound::new(capsules.iter().map(|part| (Pose::IDENTITY, SharedShape::new(*part))).collect())
}

pub type Job<'a> = Box<dyn FnMut() -> Result<(), String> + 'a>;

/// A job that queries every place of a robot.
pub fn at_all<'a>(
    poses: &'a [Pose],
    mut ask: impl FnMut(&Pose) -> Result<f64, String> + 'a,
) -> Job<'a> {
    Box::new(move || {
        for pose in poses {
            black_box(ask(black_box(pose))?);
        }
        Ok(())
    })
}

/// Writes a row: the median times of the jobs, each of `count` questions; a missing job has no
/// time.
fn row(
    effort: Effort,
    head: &str,
    jobs: Vec<Option<Job>>,
    count: u32,
    page: &mut String,
) -> Result<(), String> {
    let is_there: Vec<_> = jobs.iter().map(Option::is_some).collect();
    let mut jobs: Vec<_> = jobs.into_iter().flatten().collect();
    let mut called: Vec<&mut dyn FnMut() -> Result<(), String>> =
        jobs.iter_mut().map(|job| &mut **job as _).collect();
    let times = medians(&mut called, effort.enough)?;
    let mut times = times.iter().map(|time: &Duration| time.as_secs_f64() * 1e6 / f64::from(count));
    page.push_str(head);
    for is_there in is_there {
        let time = if is_there { times.next() } else { None };
        let _ = match time {
            Some(micros) => write!(page, " {micros:.1} |"),
            None => write!(page, " |"),
        };
    }
    page.push('\n');
    Ok(())
}

fn two_robots(effort: Effort, name: &str, offset: f64, page: &mut String) -> Result<(), String> {
    let (a, b) = (bent(1.0)?, bent(-1.0)?);
    let poses: Vec<_> =
        (0..PLACES).map(|k| Pose::translation(offset + 0.2 * f64::from(k), BESIDE, 0.0)).collect();
    let here = Pose::IDENTITY;
    let (one, two) = (capsules(&a), capsules(&b));
    let compounds = [compound(&one), compound(&two)];
    let least = |pose: &Pose| {
        RobotPair::new().minimum(&a, &here, &b, pose).map(|found| found.distance).map_err(text)
    };
    let margin = 0.5
        * poses
            .iter()
            .map(least)
            .try_fold(f64::INFINITY, |most, d| Ok::<_, String>(most.min(d?)))?;
    let placed =
        |pose: &Pose| b.links().iter().map(|link| link.transformed(pose)).collect::<Vec<_>>();
    let every = |pose: &Pose, bound: f64| {
        let placed = placed(pose);
        let pairs = a.links().iter().flat_map(|one| placed.iter().map(move |two| (one, two)));
        pairs.fold(bound, |least, (one, two)| nearer(least, one, two))
    };
    let segments = |pose: &Pose| {
        let placed = placed(pose);
        let pairs = a.links().iter().flat_map(|one| placed.iter().map(move |two| (one, two)));
        pairs.fold(f64::INFINITY, |least, (one, two)| least.min(axes_apart(one, two)))
    };
    let parry = |pose: &Pose, bound: f64| {
        let mut pairs = one.iter().flat_map(|one| two.iter().map(move |two| (one, two)));
        pairs.try_fold(bound, |least, (one, two)| parry_nearer(least, one, pose, two))
    };
    let beside = |pose: &Pose| {
        query::distance(&here, &compounds[0], pose, &compounds[1])
            .map(|found| found.distance)
            .map_err(text)
    };
    let mut pair = RobotPair::new();
    let jobs = vec![
        Some(at_all(&poses, least)),
        Some(at_all(&poses, |pose| {
            pair.minimum(&a, &here, &b, pose).map(|found| found.distance).map_err(text)
        })),
        Some(at_all(&poses, |pose| Ok(every(pose, f64::INFINITY)))),
        Some(at_all(&poses, |pose| Ok(segments(pose)))),
        Some(at_all(&poses, |pose| parry(pose, f64::MAX))),
        Some(at_all(&poses, beside)),
    ];
    row(
        effort,
        &format!("| 30 and 30 links, {name} | `minimum` | 5, 2 in a loop |"),
        jobs,
        PLACES,
        page,
    )?;
    let mut pair = RobotPair::new();
    let as_number = |clears: bool| f64::from(u8::from(clears));
    let jobs = vec![
        Some(at_all(&poses, |pose| {
            RobotPair::new().clears(&a, &here, &b, pose, margin).map(as_number).map_err(text)
        })),
        Some(at_all(&poses, |pose| {
            pair.clears(&a, &here, &b, pose, margin).map(as_number).map_err(text)
        })),
        Some(at_all(&poses, |pose| Ok(every(pose, margin)))),
        None,
        Some(at_all(&poses, |pose| parry(pose, margin))),
        None,
    ];
    row(
        effort,
        &format!("| 30 and 30 links, {name} | `clears`, half of the least distance | |"),
        jobs,
        PLACES,
        page,
    )?;
    let (mut pair, mut fresh, mut each, mut again) =
        (RobotPair::new(), RobotPair::new(), Vec::new(), Vec::new());
    let jobs = vec![
        Some(at_all(&poses, |pose| {
            fresh.forget();
            fresh.per_link(&a, &here, &b, pose, &mut each).map_err(text)?;
            Ok(each[0].distance)
        })),
        Some(at_all(&poses, |pose| {
            pair.per_link(&a, &here, &b, pose, &mut again).map_err(text)?;
            Ok(again[0].distance)
        })),
        Some(at_all(&poses, |pose| {
            let placed = placed(pose);
            let least =
                |one| placed.iter().fold(f64::INFINITY, |least, two| nearer(least, one, two));
            Ok(a.links().iter().map(least).sum())
        })),
        None,
        Some(at_all(&poses, |pose| {
            let mut sum = 0.0;
            for one in &one {
                sum += two
                    .iter()
                    .try_fold(f64::MAX, |least, two| parry_nearer(least, one, pose, two))?;
            }
            Ok(sum)
        })),
        None,
    ];
    row(effort, &format!("| 30 and 30 links, {name} | `per_link` | |"), jobs, PLACES, page)
}

fn one_robot(effort: Effort, links: i32, page: &mut String) -> Result<(), String> {
    let robot = coil(links)?;
    let all = robot.links();
    let parts = capsules(&robot);
    let once = [Pose::IDENTITY];
    let pairs = || (0..all.len()).flat_map(|i| (i + 2..all.len()).map(move |j| (i, j)));
    let every = |bound: f64| pairs().fold(bound, |least, (i, j)| nearer(least, &all[i], &all[j]));
    let parry = |bound: f64| {
        pairs().try_fold(bound, |least, (i, j)| {
            parry_nearer(least, &parts[i], &Pose::IDENTITY, &parts[j])
        })
    };
    let mut query = SelfQuery::new();
    let distance = |found: Option<parry_continuum::proximity::RobotProximity>| {
        found.map_or(f64::INFINITY, |found| found.distance)
    };
    let goal = if links == 60 { 6 } else { 10 };
    let jobs = vec![
        Some(at_all(&once, |_| {
            SelfQuery::new().minimum(black_box(&robot)).map(distance).map_err(text)
        })),
        Some(at_all(&once, |_| query.minimum(black_box(&robot)).map(distance).map_err(text))),
        Some(at_all(&once, |_| Ok(every(f64::INFINITY)))),
        Some(at_all(&once, |_| {
            Ok(pairs().fold(f64::INFINITY, |least, (i, j)| least.min(axes_apart(&all[i], &all[j]))))
        })),
        Some(at_all(&once, |_| parry(f64::MAX))),
        None,
    ];
    row(
        effort,
        &format!("| coil of {links} links | `SelfQuery::minimum` | {goal} |"),
        jobs,
        1,
        page,
    )?;
    let mut query = SelfQuery::new();
    let as_number = |clears: bool| f64::from(u8::from(clears));
    let jobs = vec![
        Some(at_all(&once, |_| {
            SelfQuery::new().clears(black_box(&robot), 1.0).map(as_number).map_err(text)
        })),
        Some(at_all(&once, |_| query.clears(black_box(&robot), 1.0).map(as_number).map_err(text))),
        Some(at_all(&once, |_| Ok(every(1.0)))),
        None,
        Some(at_all(&once, |_| parry(1.0))),
        None,
    ];
    row(
        effort,
        &format!("| coil of {links} links | `SelfQuery::clears`, 1 mm | {goal} |"),
        jobs,
        1,
        page,
    )
}
