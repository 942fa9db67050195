//! From the samples of a curve to the answer: what a query costs when the robot has a new shape
//! each time.

use crate::statistics::quantile;
use crate::ways::text;
use continuum_demo::ctr::{Centreline, Curve, Joints, Robot};
use continuum_demo::subdivide::in_four;
use continuum_studies::long_table;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Decision, Proximity};
use parry_continuum::{Chain, Tube, TubeSection, simplify};
use std::fmt::Write;
use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

/// Tolerances that are compared, mm.
const TOLERANCES: [Real; 4] = [1.0, 0.1, 0.01, 0.001];

/// The margin, and the resolution of the answer, mm.
const MARGIN: Real = 0.5;
const RESOLUTION: Real = 0.001;

/// Repetitions per shape; its time is the median.
const TURNS: usize = 5;

/// How many shapes of each kind are timed.
const SHAPES: usize = 150;

/// A shape in every form that somebody may have it.
struct Shape {
    samples: Centreline,
    tangents: [Vector; 2],
    curve: Curve,
    sections: Vec<TubeSection>,
    /// On stations chosen without a look at the samples, for each tolerance.
    fixed: Vec<Centreline>,
}

impl Shape {
    fn new(robot: &Robot, joints: &Joints, spacing: Real) -> Self {
        let curve = robot.curve(joints);
        let sections = robot.sections_out(joints);
        let end = robot.length(joints);
        let at = |spacing: &dyn Fn(&TubeSection) -> Real| {
            let (mut points, mut radii, mut from) = (vec![curve.at(0.0).0], Vec::new(), 0.0);
            for section in &sections {
                let count = (section.length / spacing(section)).ceil().max(1.0) as usize;
                points.extend(
                    (1..=count)
                        .map(|k| curve.at(from + section.length * k as Real / count as Real).0),
                );
                radii.extend(std::iter::repeat_n(section.radius, count));
                from += section.length;
            }
            Centreline { points, radii }
        };
        let fixed = TOLERANCES.map(|tolerance| {
            at(&|section: &TubeSection| (8.0 * tolerance / section.curvature.max(1e-3)).sqrt())
        });
        Self {
            samples: at(&|_| spacing),
            tangents: [curve.at(0.0).1, curve.at(end).1],
            fixed: fixed.into(),
            curve,
            sections,
        }
    }
}

/// Times from samples to a clearance within a tolerance, by a tube and by links, in seconds.
#[derive(Default)]
pub struct FromSamples {
    pub triangles: usize,
    pub tolerance: Real,
    pub free_and_touching: [[f64; 2]; 2],
}

/// A way from a shape to an answer.
type Way<'a> = Box<dyn FnMut(&Shape) -> Result<(), String> + 'a>;

/// The chapter, and its rows for the undivided mesh. Free and touching shapes are separate, and so
/// are the mesh and the mesh divided in four twice. The long table goes to `out`.
pub fn chapter(
    robot: &Robot,
    [free, touching]: [&[Joints]; 2],
    mesh: &TriMesh,
    base: &Pose,
    spacing: Real,
    out: &Path,
) -> Result<(String, Vec<FromSamples>), String> {
    let mut page = format!(
        "## From samples to the answer\n\n\
         A planner or a controller has a new shape at each query. Here the time counts from its samples, one every {spacing} \
         mm with the directions at both ends, to the clearance: medians over {SHAPES} shapes that are free and {SHAPES} that \
         touch the wall, on one thread, the first time unless it says *again* (after the same shape).\n\n\
         - *Tube*: `Tube::set_samples` and `clearance`, whose bounds are at most the tolerance apart and count everything.\n\
         - *Tube, function*: `Tube::from_function`, whose curve is computed where the query needs it.\n\
         - *Simplify*: `simplify`, `Chain::set_centreline` and `minimum`.\n\
         - *Fixed*: links of the length sqrt(8 tolerance / curvature), taken from the curve and not from samples. Nothing \
         checks their error, and the faces are off as well.\n\n\
         [tradeoff_samples.csv](tradeoff_samples.csv) has the same for the mesh with each triangle divided in sixteen.\n\n"
    );
    let mut table = String::from(
        "| triangles | shapes | tolerance | tube | tube, again | tube, function | simplify | fixed | fixed, again |\n\
         |---|---|---|---|---|---|---|---|---|\n",
    );
    let mut clears = format!(
        "\nThe same for the question whether the shape keeps {MARGIN} mm: `clears_tube` with a resolution of {RESOLUTION} mm, \
         and `clears` of fixed links within 0.01 mm:\n\n\
         | triangles | shapes | tube | tube, function | fixed | building the tube alone |\n|---|---|---|---|---|---|\n"
    );
    let fine = in_four(in_four((mesh.vertices().to_vec(), mesh.indices().to_vec())));
    let fine = TriMesh::new(fine.0, fine.1).map_err(text)?;
    let row = |&tolerance| FromSamples {
        triangles: mesh.num_triangles(),
        tolerance,
        ..FromSamples::default()
    };
    let mut rows: Vec<_> = TOLERANCES.iter().map(row).collect();
    for (is_coarse, mesh) in [(true, mesh), (false, &fine)] {
        for (kind, (name, joints)) in
            [("free", free), ("touching", touching)].into_iter().enumerate()
        {
            let shapes: Vec<_> = joints
                .iter()
                .take(SHAPES)
                .map(|joints| Shape::new(robot, joints, spacing))
                .collect();
            for (index, &tolerance) in TOLERANCES.iter().enumerate() {
                let times = times(&shapes, clearances(mesh, base, tolerance, index)?)?;
                if is_coarse {
                    rows[index].free_and_touching[kind] = [times[0], times[3]];
                }
                let cells: Vec<_> =
                    times.iter().map(|time| format!("{:.1} us", time * 1e6)).collect();
                // Writing to a string cannot fail.
                let _ = writeln!(
                    table,
                    "| {} | {name} | {tolerance} mm | {} |",
                    mesh.num_triangles(),
                    cells.join(" | ")
                );
            }
            let times = times(&shapes, decisions(mesh, base)?)?;
            let cells: Vec<_> = times.iter().map(|time| format!("{:.1} us", time * 1e6)).collect();
            let _ =
                writeln!(clears, "| {} | {name} | {} |", mesh.num_triangles(), cells.join(" | "));
        }
    }
    let triangles = mesh.num_triangles().to_string();
    page += &long_table::write(&table, &out.join("tradeoff_samples.csv"), |cells| {
        cells[0] == triangles.as_str()
    })?;
    Ok((page + &clears, rows))
}

/// The median time of each way, seconds; they take turns with every shape.
fn times(shapes: &[Shape], mut ways: Vec<Way>) -> Result<Vec<f64>, String> {
    let mut all = vec![Vec::with_capacity(shapes.len()); ways.len()];
    for shape in shapes {
        for (way, times) in ways.iter_mut().zip(&mut all) {
            let mut turns = [0.0; TURNS];
            for time in &mut turns {
                let begin = Instant::now();
                way(shape)?;
                *time = begin.elapsed().as_secs_f64();
            }
            turns.sort_by(f64::total_cmp);
            times.push(turns[TURNS / 2]);
        }
    }
    Ok(all.into_iter().map(|times| quantile(times, 0.5).unwrap_or(f64::NAN)).collect())
}

fn from_function(shape: &Shape) -> Result<Tube, String> {
    let curve = shape.curve.clone();
    Tube::from_function(&shape.sections, move |s| curve.at(s)).map_err(text)
}

fn empty_tube() -> Result<Tube, String> {
    Tube::from_samples(&[Vector::ZERO, Vector::Z], &[0.0], None).map_err(text)
}

fn empty_chain() -> Result<Chain, String> {
    Chain::from_centreline(&[Vector::ZERO, Vector::Z], &[0.0]).map_err(text)
}

/// Every way to a clearance, in the order of the table.
fn clearances<'a>(
    mesh: &TriMesh,
    base: &'a Pose,
    tolerance: Real,
    index: usize,
) -> Result<Vec<Way<'a>>, String> {
    let engine = || BvhSearch::new(mesh).map_err(text);
    let tube = |forget: bool| -> Result<Way<'a>, String> {
        let (mut search, mut tube) = (engine()?, empty_tube()?);
        Ok(Box::new(move |shape: &Shape| {
            if forget {
                search.forget();
            }
            let Centreline { points, radii } = &shape.samples;
            tube.set_samples(points, radii, Some(shape.tangents)).map_err(text)?;
            black_box(search.clearance(&tube, base, tolerance).map_err(text)?);
            Ok(())
        }))
    };
    let fixed = |forget: bool| -> Result<Way<'a>, String> {
        let (mut search, mut chain) = (engine()?, empty_chain()?);
        Ok(Box::new(move |shape: &Shape| {
            if forget {
                search.forget();
            }
            let Centreline { points, radii } = &shape.fixed[index];
            chain.set_centreline(points, radii).map_err(text)?;
            black_box(search.minimum(&chain, base).map_err(text)?);
            Ok(())
        }))
    };
    let (mut search, mut chain) = (engine()?, empty_chain()?);
    let simplified: Way = Box::new(move |shape: &Shape| {
        search.forget();
        let Centreline { points, radii } = &shape.samples;
        let (points, radii) = simplify(points, radii, tolerance).map_err(text)?;
        chain.set_centreline(&points, &radii).map_err(text)?;
        black_box(search.minimum(&chain, base).map_err(text)?);
        Ok(())
    });
    let mut search = engine()?;
    let function: Way = Box::new(move |shape: &Shape| {
        search.forget();
        let tube = from_function(shape)?;
        black_box(search.clearance(&tube, base, tolerance).map_err(text)?);
        Ok(())
    });
    Ok(vec![tube(true)?, tube(false)?, function, simplified, fixed(true)?, fixed(false)?])
}

/// Every way to a decision, and building a tube alone.
fn decisions<'a>(mesh: &TriMesh, base: &'a Pose) -> Result<Vec<Way<'a>>, String> {
    let engine = || BvhSearch::new(mesh).map_err(text);
    let decide = |search: &mut BvhSearch, tube: &Tube| -> Result<Decision, String> {
        search.forget();
        search.clears_tube(tube, base, MARGIN, RESOLUTION).map_err(text)
    };
    let (mut one, mut other, mut third) = (engine()?, engine()?, engine()?);
    let (mut tube, mut chain) = (empty_tube()?, empty_chain()?);
    let mut built = empty_tube()?;
    Ok(vec![
        Box::new(move |shape: &Shape| {
            let Centreline { points, radii } = &shape.samples;
            tube.set_samples(points, radii, Some(shape.tangents)).map_err(text)?;
            black_box(decide(&mut one, &tube)?);
            Ok(())
        }),
        Box::new(move |shape: &Shape| {
            black_box(decide(&mut other, &from_function(shape)?)?);
            Ok(())
        }),
        Box::new(move |shape: &Shape| {
            third.forget();
            let Centreline { points, radii } = &shape.fixed[2];
            chain.set_centreline(points, radii).map_err(text)?;
            black_box(third.clears(&chain, base, MARGIN).map_err(text)?);
            Ok(())
        }),
        Box::new(move |shape: &Shape| {
            let Centreline { points, radii } = &shape.samples;
            built.set_samples(points, radii, Some(shape.tangents)).map_err(text)
        }),
    ])
}
