//! The cost of proving a motion, beside one bound for the whole robot and beside steps.

use crate::statistics::{Share, quantile};
use crate::ways::text;
use continuum_demo::ctr::{Joints, Robot};
use continuum_demo::joint_motion::JointMotion;
use continuum_demo::steer::Random;
use continuum_demo::ventricle;
use continuum_studies::machine;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Decision, Proximity};
use parry_continuum::{DisplacementBound, Motion, RobotError, Speed, Tube};
use std::cell::Cell;
use std::fmt::Write;
use std::time::Instant;

/// What encloses the chapter in the page.
pub const MARK: &str = "motions";

/// The motions of the tips, and the margins, mm.
const LENGTHS: [Real; 4] = [1.0, 2.0, 5.0, 10.0];
const MARGINS: [Real; 2] = [0.0, 0.5];

/// How near to the margin an answer may stay open, mm.
const RESOLUTION: Real = 0.001;

/// How often each edge is checked; its time is the median.
const TURNS: usize = 3;

/// Random edges of a length that are tried for each that is wanted: both ends have to keep the
/// margin.
const TRIES: usize = 300;

/// How far the wall moves where it moves, mm, and how long the wave is in which it does, as a
/// factor of 2 pi mm.
const WALL_MOVES: Real = 0.5;
const WAVE: Real = 10.0;

/// A motion that counts its shapes.
struct Counted<'a> {
    motion: &'a JointMotion,
    shapes: Cell<u64>,
    /// Whether it says where it goes, and not only how fast.
    has_courses: Cell<bool>,
}

impl Motion for Counted<'_> {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        self.shapes.set(self.shapes.get() + 1);
        self.motion.shape(t, tube)
    }

    fn speed(&self, section: usize, shares: [Real; 2], times: [Real; 2]) -> Speed {
        self.motion.speed(section, shares, times)
    }

    fn displacement(
        &self,
        section: usize,
        shares: [Real; 2],
        times: [Real; 2],
    ) -> Option<DisplacementBound> {
        if self.has_courses.get() { self.motion.displacement(section, shares, times) } else { None }
    }
}

/// What a way of checking makes of an edge.
#[derive(Clone, Copy, PartialEq)]
enum Verdict {
    Clear,
    Contact,
    Undecided,
}

type Way<'a> = &'a dyn Fn(&mut BvhSearch, &Counted, Real) -> Result<Verdict, String>;

fn verdict(decision: Decision) -> Verdict {
    match decision {
        Decision::Clear => Verdict::Clear,
        Decision::Contact => Verdict::Contact,
        Decision::Undecided => Verdict::Undecided,
    }
}

/// By bounds for each piece, and by where it goes.
fn by_pieces(search: &mut BvhSearch, motion: &Counted, margin: Real) -> Result<Verdict, String> {
    Ok(verdict(search.clears_motion(motion, margin, RESOLUTION).map_err(text)?.decision))
}

/// By bounds on the speed of each piece alone.
fn by_speeds(search: &mut BvhSearch, motion: &Counted, margin: Real) -> Result<Verdict, String> {
    motion.has_courses.set(false);
    by_pieces(search, motion, margin)
}

/// While the wall moves too.
fn by_moving_walls(
    search: &mut BvhSearch,
    motion: &Counted,
    to: &[Vector],
    margin: Real,
) -> Result<Verdict, String> {
    Ok(verdict(search.clears_motion_while(to, motion, margin, RESOLUTION).map_err(text)?.decision))
}

/// By one bound for the whole robot. Its clearance in the middle of an interval bounds the time
/// before and after in which nothing comes nearer than the margin, if all of it moves as fast as
/// its fastest point. The remaining intervals are halved. (Conservative advancement, to both
/// sides.)
fn by_one_bound(
    search: &mut BvhSearch,
    motion: &Counted,
    base: &Pose,
    sections: usize,
    margin: Real,
) -> Result<Verdict, String> {
    let fastest = |number: usize| {
        let Speed { point, turn } = motion.speed(number, [0.0, 1.0], [0.0, 1.0]);
        // The discs of the widest tube.
        point + 1.25 * turn
    };
    let speed = (0..sections).map(fastest).fold(0.0, Real::max);
    let mut tube = motion.motion.tube(0.0).map_err(text)?;
    let (mut waiting, mut verdict) =
        (std::collections::VecDeque::from([[0.0, 1.0]]), Verdict::Clear);
    while let Some([from, to]) = waiting.pop_front() {
        let (middle, half): (Real, Real) = (0.5 * (from + to), 0.5 * (to - from));
        motion.shape(middle, &mut tube).map_err(text)?;
        let tolerance = (0.25 * half * speed).max(0.25 * RESOLUTION);
        let found = search.clearance(&tube, base, tolerance).map_err(text)?;
        if found.upper <= margin {
            return Ok(Verdict::Contact);
        }
        if half * speed <= 0.5 * RESOLUTION && found.lower <= margin + half * speed {
            verdict = Verdict::Undecided;
            continue;
        }
        let still = ((found.lower - margin) / speed).max(0.0);
        if still < half {
            waiting.extend([[from, middle - still], [middle + still, to]]);
        }
    }
    Ok(verdict)
}

/// By shapes between which the tip moves by `step`; the ends are known.
fn by_steps(
    search: &mut BvhSearch,
    motion: &Counted,
    base: &Pose,
    step: Real,
    margin: Real,
) -> Result<Verdict, String> {
    let mut tube = motion.motion.tube(0.0).map_err(text)?;
    for t in motion.motion.steps(step).filter(|t| *t < 1.0) {
        motion.shape(t, &mut tube).map_err(text)?;
        if search.clears_tube(&tube, base, margin, RESOLUTION).map_err(text)? != Decision::Clear {
            return Ok(Verdict::Contact);
        }
    }
    Ok(Verdict::Clear)
}

/// What a way makes of all edges.
struct Measured {
    shapes: Vec<f64>,
    seconds: Vec<f64>,
    verdicts: Vec<Verdict>,
}

impl Measured {
    fn mean(values: &[f64]) -> f64 {
        values.iter().sum::<f64>() / values.len() as f64
    }

    fn shapes(&self) -> f64 {
        Self::mean(&self.shapes)
    }

    fn microseconds(&self) -> f64 {
        1e6 * Self::mean(&self.seconds)
    }

    fn count(&self, verdict: Verdict) -> usize {
        self.verdicts.iter().filter(|found| **found == verdict).count()
    }
}

/// Every way with every edge, in turns.
fn measure(
    edges: &[(JointMotion, Real)],
    ways: &[Way],
    searches: &mut [BvhSearch],
) -> Result<Vec<Measured>, String> {
    let empty = || Measured { shapes: Vec::new(), seconds: Vec::new(), verdicts: Vec::new() };
    let mut all: Vec<_> = ways.iter().map(|_| empty()).collect();
    for (motion, margin) in edges {
        for ((way, search), measured) in ways.iter().zip(&mut *searches).zip(&mut all) {
            let (mut seconds, mut seen) = (Vec::with_capacity(TURNS), None);
            for _ in 0..TURNS {
                let counted =
                    Counted { motion, shapes: Cell::new(0), has_courses: Cell::new(true) };
                search.forget();
                let begin = Instant::now();
                let verdict = way(search, &counted, *margin)?;
                seconds.push(begin.elapsed().as_secs_f64());
                seen = Some((verdict, counted.shapes.get()));
            }
            measured.seconds.extend(quantile(seconds, 0.5));
            measured.verdicts.extend(seen.map(|(verdict, _)| verdict));
            measured.shapes.extend(seen.map(|(_, shapes)| shapes as f64));
        }
    }
    Ok(all)
}

/// Random edges whose ends keep their margin.
fn edges(
    robot: &Robot,
    base: &Pose,
    search: &mut BvhSearch,
    random: &mut Random,
    length: Real,
    count: usize,
) -> Result<Vec<(JointMotion, Real)>, String> {
    let (mut edges, mut tries) = (Vec::new(), 0);
    while edges.len() < count && tries < TRIES * count {
        tries += 1;
        let motion = JointMotion::random(robot, *base, length, || random.share());
        let margin = MARGINS[edges.len() % MARGINS.len()];
        let mut is_clear = true;
        for t in [0.0, 1.0] {
            let tube = motion.tube(t).map_err(text)?;
            let decision = search.clears_tube(&tube, base, margin, RESOLUTION).map_err(text)?;
            is_clear &= decision == Decision::Clear;
        }
        if is_clear {
            edges.push((motion, margin));
        }
    }
    Ok(edges)
}

/// The planned way in: section after section comes out along the robot's final shape.
fn insertion(robot: &Robot, goal: &Joints) -> Result<Vec<JointMotion>, String> {
    const NOT_OUT: Real = 0.01;
    let out = |sections: usize| {
        let length = |k: usize| if k < sections { goal.extensions[k] } else { NOT_OUT };
        Joints {
            extensions: (0..goal.extensions.len()).map(length).collect(),
            angles: goal.angles.clone(),
        }
    };
    (0..goal.extensions.len())
        .map(|k| {
            JointMotion::new(robot, [&out(k), &out(k + 1)], ventricle::entry()).ok_or_else(|| {
                "the planned goal has a tube that is straight where it should be curved".into()
            })
        })
        .collect()
}

/// The chapter, with this many edges of each length.
pub fn chapter(robot: &Robot, mesh: &TriMesh, base: &Pose, count: usize) -> Result<String, String> {
    let mut search = BvhSearch::new(mesh).map_err(text)?;
    let sections = robot.sections.len();
    let one_bound = |search: &mut BvhSearch, motion: &Counted, margin: Real| {
        by_one_bound(search, motion, base, sections, margin)
    };
    let coarse = |search: &mut BvhSearch, motion: &Counted, margin: Real| {
        by_steps(search, motion, base, 0.5, margin)
    };
    let fine = |search: &mut BvhSearch, motion: &Counted, margin: Real| {
        by_steps(search, motion, base, 0.1, margin)
    };
    let from = search.vertices().to_vec();
    let wave = |point: &Vector| point + Vector::Z * (WALL_MOVES * (point.x / WAVE).sin());
    let to: Vec<_> = from.iter().map(wave).collect();
    let staying = |search: &mut BvhSearch, motion: &Counted, margin: Real| {
        by_moving_walls(search, motion, &from, margin)
    };
    let moving = |search: &mut BvhSearch, motion: &Counted, margin: Real| {
        by_moving_walls(search, motion, &to, margin)
    };
    let ways: [Way; 7] = [&by_pieces, &by_speeds, &one_bound, &coarse, &fine, &staying, &moving];
    let mut searches: Vec<_> = ways.iter().map(|_| search.clone()).collect();

    let mut page = format!(
        "## Motions\n\n\
         Measured on {}, in the mesh of {} triangles. Random edges in joint space, {count} of each length, whose ends keep \
         the margin of {} or {} mm, half of the edges each: shapes of the robot that were looked at, and time with all that it takes to \
         make them. *Proof*: `clears_motion` with a resolution of {RESOLUTION} mm, which bounds the speed of each \
         piece and asks where it goes. *Speeds*: the same of a motion that states no courses. *One bound*: the same halving of time, but with the speed of the fastest point for all of the robot, and its \
         clearance (`clearance`). *Steps*: shapes between which the tip moves so far, by `clears_tube`, the middle first; \
         they prove nothing, and *missed* are edges that they accept and in which a contact was found. All on one thread, \
         without the last answers, in means over the edges (the median of {TURNS} turns each).\n\n\
         | tip moves | proof: shapes, median | mean | time | speeds: shapes | time | one bound: shapes | time | 0.5 mm: shapes | time | missed | \
         0.1 mm: shapes | time | missed | contacts | undecided |\n\
         |---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
        machine::description(),
        mesh.num_triangles(),
        MARGINS[0],
        MARGINS[1],
    );
    let mut walls = format!(
        "\nThe same edges while the wall moves too, in the same run: `clears_motion` with the wall at rest; \
         `clears_motion_while` with a wall at rest, which shows the cost of the boxes for the end of the time; and \
         with a wall whose vertices move along z, by {WALL_MOVES} mm at most, in a wave.\n\n\
         | tip moves | at rest: shapes | time | contacts | stays: shapes | time | contacts | moves: shapes | time | contacts | undecided |\n\
         |---|---|---|---|---|---|---|---|---|---|---|\n"
    );
    let (mut random, mut undecided) = (Random(1), Share::default());
    for length in LENGTHS {
        let edges = edges(robot, base, &mut search, &mut random, length, count)?;
        if edges.is_empty() {
            return Err("no edge keeps the margin; move the robot with --base and --axis".into());
        }
        let all = measure(&edges, &ways, &mut searches)?;
        let [proof, speeds, one, coarse, fine, staying, moving] = &all[..] else {
            return Err("a way is missing".into());
        };
        let missed = |steps: &Measured| {
            let pairs = steps.verdicts.iter().zip(&proof.verdicts);
            pairs.filter(|pair| *pair == (&Verdict::Clear, &Verdict::Contact)).count()
        };
        undecided.count += proof.count(Verdict::Undecided);
        undecided.of += edges.len();
        // Writing to a string cannot fail.
        let _ = writeln!(
            page,
            "| {length} mm | {} | {:.1} | {:.0} us | {:.1} | {:.0} us | {:.1} | {:.0} us | {:.1} | {:.0} us | {} | {:.1} | {:.0} us | {} | {} | {} |",
            quantile(proof.shapes.clone(), 0.5).unwrap_or(f64::NAN),
            proof.shapes(),
            proof.microseconds(),
            speeds.shapes(),
            speeds.microseconds(),
            one.shapes(),
            one.microseconds(),
            coarse.shapes(),
            coarse.microseconds(),
            missed(coarse),
            fine.shapes(),
            fine.microseconds(),
            missed(fine),
            proof.count(Verdict::Contact),
            proof.count(Verdict::Undecided),
        );
        let _ = write!(walls, "| {length} mm ");
        for way in [proof, staying, moving] {
            let contacts = way.count(Verdict::Contact);
            let _ =
                write!(walls, "| {:.1} | {:.0} us | {contacts} ", way.shapes(), way.microseconds());
        }
        let _ = writeln!(walls, "| {} |", moving.count(Verdict::Undecided));
    }
    let _ = writeln!(page, "\nUndecided in all: {undecided}.");
    page.push_str(&walls);
    if *base == ventricle::entry() {
        let goal = ventricle::goal();
        let (mut shapes, mut is_clear) = (0, true);
        for motion in insertion(robot, &goal)? {
            let counted =
                Counted { motion: &motion, shapes: Cell::new(0), has_courses: Cell::new(true) };
            is_clear &= by_pieces(&mut search, &counted, MARGINS[1])? == Verdict::Clear;
            shapes += counted.shapes.get();
        }
        let _ = writeln!(
            page,
            "\nThe planned way in, {:.0} mm, section after section: {shapes} shapes {} that it keeps {} mm.",
            robot.length(&goal),
            if is_clear { "prove" } else { "do not prove" },
            MARGINS[1]
        );
    }
    Ok(page)
}
