//! Time per query of every way at every tolerance, and what building the robot takes.

use crate::outcome::{INPUT_SPACING, TOLERANCES};
use crate::shapes::{Stations, step_before};
use crate::statistics::quantile;
use crate::subject::{Model, Subject};
use crate::ways::{self, Device, text};
use continuum_demo::ctr::{Centreline, Joints, Robot};
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::{Chain, simplify};
use std::hint::black_box;
use std::time::Instant;

/// Repetitions per shape; its time is the median.
const TURNS: usize = 3;

/// Median seconds over the shapes.
pub struct Times {
    /// At each tolerance.
    pub queries: Vec<Vec<Timed>>,
    pub building: Vec<Building>,
    /// The largest difference of two ways to ask for the same model by this crate, mm.
    pub apart: Real,
}

/// A way to ask.
pub struct Timed {
    pub model: Model,
    pub way: &'static str,
    /// None of a tube.
    pub links: Option<usize>,
    /// Seconds a query.
    pub time: f64,
}

/// What comes before the query, at a tolerance.
pub struct Building {
    pub links: usize,
    pub simplify: f64,
    pub chain: f64,
}

/// A curve, its directions at the ends, and the numbers of the points that fix the directions of
/// faces.
type Given = (Centreline, [Vector; 2]);

/// Times the shapes on one thread.
pub fn time(
    robot: &Robot,
    shapes: &[Joints],
    mesh: &TriMesh,
    base: &Pose,
    devices: &[Device],
) -> Result<Times, String> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().map_err(text)?;
    pool.install(|| {
        let mut times = Times { queries: Vec::new(), building: Vec::new(), apart: 0.0 };
        let curve = |joints: &Joints| {
            let stations = Stations::even(robot, joints, INPUT_SPACING);
            (stations.curve(robot, joints), stations.tangents(robot, joints))
        };
        let curves: Vec<_> =
            shapes.iter().map(|joints| [curve(&step_before(joints)), curve(joints)]).collect();
        for tolerance in TOLERANCES {
            times.building.push(building(&curves, tolerance)?);
            let subject =
                |(curve, tangents): &Given| Subject::new(curve, *tangents, tolerance).map_err(text);
            let subjects: Result<Vec<_>, String> =
                curves.iter().map(|[before, now]| Ok([subject(before)?, subject(now)?])).collect();
            let (rows, apart) = queries(&subjects?, mesh, base, devices)?;
            times.queries.push(rows);
            times.apart = times.apart.max(apart);
        }
        Ok(times)
    })
}

/// The times of every way to ask, and by how much this crate's differ from each other.
fn queries(
    subjects: &[[Subject; 2]],
    mesh: &TriMesh,
    base: &Pose,
    devices: &[Device],
) -> Result<(Vec<Timed>, Real), String> {
    let mut rows = Vec::new();
    let mut apart: Real = 0.0;
    let mut first: Vec<(Model, Vec<Real>)> = Vec::new();
    for mut way in ways::all(mesh, devices)? {
        let mut times = Vec::with_capacity(subjects.len());
        let mut clearances = Vec::with_capacity(subjects.len());
        for [before, now] in subjects {
            let mut turns = [0.0; TURNS];
            let mut clearance = 0.0;
            for time in &mut turns {
                // The query before fills the caches, and warms the search that remembers.
                black_box(way.program.clearance(before, base)?);
                way.program.prepare();
                let begin = Instant::now();
                clearance = black_box(way.program.clearance(now, base)?);
                *time = begin.elapsed().as_secs_f64();
            }
            turns.sort_by(f64::total_cmp);
            times.push(turns[TURNS / 2]);
            clearances.push(clearance);
        }
        if Model::OURS.contains(&way.model) {
            match first.iter().find(|(model, _)| *model == way.model) {
                Some((_, expected)) => {
                    let off = expected.iter().zip(&clearances).map(|(a, b)| (a - b).abs());
                    apart = off.fold(apart, Real::max);
                }
                None => first.push((way.model, clearances)),
            }
        }
        let links: Option<Vec<_>> = subjects
            .iter()
            .map(|[_, now]| now.links(way.model).map(|links| links as f64))
            .collect();
        rows.push(Timed {
            model: way.model,
            way: way.name,
            links: links.and_then(|links| quantile(links, 0.5)).map(|links| links as usize),
            time: quantile(times, 0.5).unwrap_or(f64::NAN),
        });
    }
    Ok((rows, apart))
}

/// From the curve to the links, and from the links to the chain.
fn building(curves: &[[Given; 2]], tolerance: Real) -> Result<Building, String> {
    let (mut links, mut simplifying, mut chaining) = (Vec::new(), Vec::new(), Vec::new());
    for [_, (curve, _)] in curves {
        let begin = Instant::now();
        let (points, radii) = simplify(&curve.points, &curve.radii, tolerance).map_err(text)?;
        simplifying.push(begin.elapsed().as_secs_f64());
        let begin = Instant::now();
        black_box(Chain::from_centreline(&points, &radii).map_err(text)?);
        chaining.push(begin.elapsed().as_secs_f64());
        links.push(radii.len() as f64);
    }
    let [links, simplify, chain] =
        [links, simplifying, chaining].map(|values| quantile(values, 0.5).unwrap_or(f64::NAN));
    Ok(Building { links: links as usize, simplify, chain })
}
