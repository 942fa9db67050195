//! The answers of Rust to a file of cases. C, C++ and Octave must give the same bits.
//!
//! `answers write CASES` writes the cases: the reference cases of `tests/data`, and 10,000 random
//! robots. `answers CASES ANSWERS` answers them. Both files are doubles alone, so that every
//! language reads and writes them in a line. A question that is refused has the answer NaN.

use continuum_testing::{Case as Distance, Random, distance_cases, read_lines};
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::proximity::{
    Between, BvhSearch, Clearance, Contact, Decision, LinkProximity, MotionAnswer, MotionClearance,
    Proximity, RobotPair, Scene, SceneMotionAnswer, SelfQuery, Side, StructureEnd, UndecidedReason,
    Witness,
};
use parry_continuum::{BendingSection, Chain, LinearMotion, RobotError, Tube, pose_from_matrix};
use serde_json::Value;
use std::error::Error;
use std::{env, fs};

const RANDOM_ROBOTS: usize = 10_000;
/// Of every this many random robots one is asked everything.
const EVERYTHING: usize = 40;

type Fallible<T> = Result<T, Box<dyn Error>>;
type Mesh = (Vec<Vector>, Vec<[u32; 3]>);

/// One robot: a motion from `start` to `end`, at a pose.
struct Case {
    mesh: usize,
    caps: u32,
    start: Vec<Vector>,
    end: Vec<Vector>,
    radii: Vec<f64>,
    pose: [f64; 16],
    margin: f64,
    everything: bool,
}

const IDENTITY: [f64; 16] =
    [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];

fn vector(value: &Value) -> Vector {
    let number = |k: usize| value[k].as_f64().unwrap_or(f64::NAN);
    Vector::new(number(0), number(1), number(2))
}

fn vectors(value: &Value) -> Vec<Vector> {
    value.as_array().into_iter().flatten().map(vector).collect()
}

/// A mesh of triangles that share no vertices.
fn loose(triangles: impl Iterator<Item = [Vector; 3]>) -> Mesh {
    let vertices: Vec<_> = triangles.flatten().collect();
    let triangles = (0..vertices.len() as u32 / 3).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]);
    let triangles = triangles.collect();
    (vertices, triangles)
}

/// The reference cases that a chain can be.
fn reference(meshes: &mut Vec<Mesh>, cases: &mut Vec<Case>) -> Fallible<()> {
    let chains = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/chain_open.jsonl");
    for case in read_lines::<Value>(&fs::read_to_string(chains)?) {
        let corners = case["tris"].as_array().into_iter().flatten().map(vectors);
        meshes.push(loose(corners.map(|corners| [corners[0], corners[1], corners[2]])));
        let start = vectors(&case["points"]);
        cases.push(Case {
            mesh: meshes.len() - 1,
            caps: 0,
            end: start.iter().map(|point| point + Vector::X).collect(),
            start,
            radii: case["segment_radius"]
                .as_array()
                .into_iter()
                .flatten()
                .filter_map(Value::as_f64)
                .collect(),
            pose: IDENTITY,
            margin: 0.5,
            everything: true,
        });
    }
    for case in distance_cases().iter().filter(|case| case.is_link()) {
        let Distance { tri, p0, p1, r, .. } = case;
        let caps = match case.flat() {
            [false, false] => 1,
            [true, true] => 2,
            _ => continue, // a chain has no such caps
        };
        meshes.push(loose([tri.map(Vector::from)].into_iter()));
        let (start, radii) = (vec![Vector::from(*p0), Vector::from(*p1)], vec![*r]);
        let end = start.clone();
        let (mesh, margin, everything) = (meshes.len() - 1, case.distance(), false);
        cases.push(Case { mesh, caps, start, end, radii, pose: IDENTITY, margin, everything });
    }
    Ok(())
}

/// An uneven closed vessel, around which the robots are.
fn vessel(random: &mut Random) -> Mesh {
    const AROUND: u32 = 24;
    const ALONG: u32 = 20;
    let mut vertices = vec![Vector::new(0.0, 0.0, -1.0), Vector::new(0.0, 0.0, 11.0)];
    for ring in 0..ALONG {
        for k in 0..AROUND {
            let angle = std::f64::consts::TAU * f64::from(k) / f64::from(AROUND);
            let radius = 3.0 + 0.3 * random.unit();
            let height = 10.0 * f64::from(ring) / f64::from(ALONG - 1);
            vertices.push(Vector::new(radius * angle.cos(), radius * angle.sin(), height));
        }
    }
    let at = |ring: u32, k: u32| 2 + ring * AROUND + k % AROUND;
    let mut triangles = Vec::new();
    for k in 0..AROUND {
        triangles.push([0, at(0, k + 1), at(0, k)]);
        triangles.push([1, at(ALONG - 1, k), at(ALONG - 1, k + 1)]);
        for ring in 0..ALONG - 1 {
            let [a, b] = [at(ring, k), at(ring, k + 1)];
            let [c, d] = [at(ring + 1, k), at(ring + 1, k + 1)];
            triangles.extend([[a, b, c], [b, d, c]]);
        }
    }
    (vertices, triangles)
}

/// Robots inside, through the wall, and outside; some with points that no robot has.
fn drawn(meshes: &mut Vec<Mesh>, cases: &mut Vec<Case>) {
    let random = &mut Random::new(69);
    let mesh = meshes.len();
    meshes.push(vessel(random));
    for k in 0..RANDOM_ROBOTS {
        let count = 2 + (10.0 * random.unit()) as usize;
        let mut point = 2.0 * random.point() + Vector::Z * 2.0;
        let mut direction = (Vector::Z + 0.5 * random.point()).normalize();
        let mut start = vec![point];
        for _ in 1..count {
            direction = (direction + 0.3 * random.point()).normalize();
            point += (0.2 + 0.5 * random.unit()) * direction;
            start.push(point);
        }
        let shift = 0.5 * random.point();
        let mut radius = 0.1 + 0.3 * random.unit();
        let radii = (1..count).map(|_| {
            radius *= if random.unit() < 0.3 { 0.9 } else { 1.0 };
            radius
        });
        let radii: Vec<_> = radii.collect();
        let [sine, cosine] = [0.6, 0.8];
        let [x, y, z] = (0.3 * random.point()).to_array();
        let turned =
            [cosine, -sine, 0.0, x, sine, cosine, 0.0, y, 0.0, 0.0, 1.0, z, 0.0, 0.0, 0.0, 1.0];
        if k % 100 == 99 {
            start[count / 2].x = f64::NAN;
        }
        cases.push(Case {
            mesh,
            caps: (k % 7).saturating_sub(4) as u32,
            end: start.iter().map(|point| point + shift).collect(),
            start,
            radii,
            pose: if k % 2 == 0 { turned } else { IDENTITY },
            margin: 0.4 * random.unit(),
            everything: k % EVERYTHING == 0,
        });
    }
}

fn write(path: &str) -> Fallible<()> {
    let (mut meshes, mut cases) = (Vec::new(), Vec::new());
    reference(&mut meshes, &mut cases)?;
    drawn(&mut meshes, &mut cases);
    let mut out = vec![meshes.len() as f64];
    for (vertices, triangles) in &meshes {
        out.push(vertices.len() as f64);
        out.extend(vertices.iter().flat_map(|vertex| vertex.to_array()));
        out.push(triangles.len() as f64);
        out.extend(triangles.as_flattened().iter().copied().map(f64::from));
    }
    out.push(cases.len() as f64);
    for case in &cases {
        let everything = f64::from(u8::from(case.everything));
        out.extend([case.mesh as f64, f64::from(case.caps), case.margin, everything]);
        out.extend(case.pose);
        out.push(case.start.len() as f64);
        out.extend(case.start.iter().chain(&case.end).flat_map(|point| point.to_array()));
        out.extend(&case.radii);
    }
    save(path, &out)
}

fn save(path: &str, numbers: &[f64]) -> Fallible<()> {
    let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
    Ok(fs::write(path, bytes)?)
}

/// The numbers of a file, one after another.
struct Numbers(std::vec::IntoIter<f64>);

impl Numbers {
    fn new(path: &str) -> Fallible<Self> {
        let bytes = fs::read(path)?;
        let numbers = bytes.as_chunks().0.iter().map(|chunk| f64::from_le_bytes(*chunk));
        Ok(Self(numbers.collect::<Vec<_>>().into_iter()))
    }

    fn number(&mut self) -> f64 {
        self.0.next().unwrap_or(f64::NAN)
    }

    fn count(&mut self) -> usize {
        self.number() as usize
    }

    fn numbers(&mut self, count: usize) -> Vec<f64> {
        self.0.by_ref().take(count).collect()
    }

    fn points(&mut self, count: usize) -> Vec<Vector> {
        let numbers = self.numbers(3 * count);
        numbers.as_chunks().0.iter().map(|point: &[f64; 3]| Vector::from(*point)).collect()
    }

    fn mesh(&mut self) -> Mesh {
        let count = self.count();
        let vertices = self.points(count);
        let count = self.count();
        let indices: Vec<_> = self.numbers(3 * count).iter().map(|index| *index as u32).collect();
        (vertices, indices.as_chunks().0.to_vec())
    }

    fn case(&mut self) -> Case {
        let [mesh, caps] = [self.count(), self.count()];
        let [margin, everything] = [self.number(), self.number()];
        let mut pose = IDENTITY;
        pose.copy_from_slice(&self.numbers(16));
        let count = self.count();
        let [start, end] = [self.points(count), self.points(count)];
        let radii = self.numbers(count - 1);
        let (caps, everything) = (caps as u32, everything != 0.0);
        Case { mesh, caps, start, end, radii, pose, margin, everything }
    }
}

/// The answers of all questions.
struct Answers(Vec<f64>);

impl Answers {
    /// The numbers of an answer, or NaN.
    fn add<T, E>(&mut self, found: Result<T, E>, numbers: impl FnOnce(&mut Self, T)) {
        match found {
            Ok(found) => numbers(self, found),
            Err(_) => self.0.push(f64::NAN),
        }
    }

    fn numbers(&mut self, numbers: impl IntoIterator<Item = f64>) {
        self.0.extend(numbers);
    }

    fn truth(&mut self, truth: bool) {
        self.0.push(f64::from(u8::from(truth)));
    }

    fn place(&mut self, witness: &Witness) {
        self.numbers([witness.on_robot, witness.on_mesh].iter().flat_map(|it| it.to_array()));
        self.numbers([witness.arc_length, witness.segment.into(), witness.triangle.into()]);
    }

    fn minimum(&mut self, found: &LinkProximity) {
        self.0.push(found.distance);
        self.place(&found.witness);
    }

    fn contact(&mut self, found: &Contact) {
        self.numbers([found.distance, found.depth, found.fraction]);
        self.numbers(found.normal.unwrap_or(Vector::NAN).to_array());
        self.place(&found.witness);
    }

    fn decision(&mut self, decision: Decision) {
        self.0.push(match decision {
            Decision::Contact => -1.0,
            Decision::Undecided => 0.0,
            Decision::Clear => 1.0,
        });
    }

    fn side(&mut self, side: Side) {
        self.0.push(match side {
            Side::Inside => -1.0,
            Side::Undecided => 0.0,
            Side::Outside => 1.0,
        });
    }

    fn clearance(&mut self, found: &Clearance) {
        self.numbers([found.lower, found.upper, found.uncertainty, 0.0]);
        self.place(&found.witness);
        self.truth(found.resolved);
    }

    fn motion_clearance(&mut self, found: &MotionClearance) {
        self.numbers([found.lower, found.upper, found.uncertainty, found.t]);
        self.place(&found.witness);
        self.truth(found.resolved);
    }

    fn reason(&mut self, reason: Option<UndecidedReason>) {
        self.0.push(match reason {
            None => 0.0,
            Some(UndecidedReason::Work) => 2.0,
            Some(_) => 1.0,
        });
    }

    fn scene_motion(&mut self, found: &SceneMotionAnswer) {
        self.decision(found.decision);
        self.reason(found.reason);
        self.numbers(found.interval);
        self.numbers(found.contact.as_ref().map_or([f64::NAN; 2], |it| [it.t(), it.upper()]));
    }

    fn motion(&mut self, found: &MotionAnswer) {
        self.decision(found.decision);
        self.reason(found.reason);
        self.numbers(found.interval);
        match &found.contact {
            Some(shape) => {
                self.numbers([shape.t, shape.upper]);
                self.place(&shape.witness);
            }
            None => self.numbers([f64::NAN; 11]),
        }
    }
}

fn chain(caps: u32, points: &[Vector], radii: &[f64]) -> Result<Chain, RobotError> {
    match caps {
        0 => Chain::from_centreline(points, radii),
        1 => Chain::capsules(points, radii),
        _ => Chain::cylinders(points, radii),
    }
}

fn answer(input: &str, output: &str) -> Fallible<()> {
    const FINE: f64 = 0.05;
    let mut numbers = Numbers::new(input)?;
    let mut searches = Vec::new();
    for _ in 0..numbers.count() {
        let (vertices, triangles) = numbers.mesh();
        searches.push(BvhSearch::from_triangles(&vertices, &triangles)?);
    }
    let mut out = Answers(Vec::new());
    let (mut pair, mut alone) = (RobotPair::new(), SelfQuery::new());
    let mut everyone = Vec::new();
    for _ in 0..numbers.count() {
        let case = numbers.case();
        let Ok(robot) = chain(case.caps, &case.start, &case.radii) else {
            out.0.push(f64::NAN);
            continue;
        };
        let (search, margin) = (&mut searches[case.mesh], case.margin);
        let rows: [[f64; 4]; 4] = std::array::from_fn(|row| case.pose.as_chunks().0[row]);
        let pose = pose_from_matrix(rows)?;
        out.add(search.minimum(&robot, &pose), |out, found| out.minimum(&found));
        out.add(search.clears(&robot, &pose, margin), |out, found| out.truth(found));
        if case.everything {
            let mut links = Vec::new();
            out.add(search.per_link(&robot, &pose, &mut links), |out, ()| {
                out.0.push(links.len() as f64);
                links.iter().for_each(|link| out.minimum(link));
            });
            let mut contacts = Vec::new();
            let found = search.contacts_within(&robot, &pose, margin, 0.0, &mut contacts);
            out.add(found, |out, ()| {
                out.0.push(contacts.len() as f64);
                contacts.iter().for_each(|contact| out.contact(contact));
            });
            out.side(search.side(case.start[0]));
            out.add(search.clears_inside(&robot, &pose, margin), |out, found| {
                out.side(found.base);
                out.side(found.tip);
                out.truth(found.clears);
                out.truth(found.crosses_opening);
                out.truth(found.holds());
            });
            match Tube::from_samples(&case.start, &case.radii, None) {
                Err(_) => out.numbers([f64::NAN; 2]),
                Ok(tube) => {
                    let found = search.clearance(&tube, &pose, FINE);
                    out.add(found, |out, found| out.clearance(&found));
                    let found = search.clears_tube(&tube, &pose, margin, FINE);
                    out.add(found, |out, found| out.decision(found));
                }
            }
            let motion = LinearMotion::chain(&case.start, &case.end, &case.radii);
            out.add(motion, |out, motion| {
                let found = search.clears_motion(&motion, margin, FINE);
                out.add(found, |out, found| out.motion(&found));
                let found = search.time_of_contact(&motion, margin, FINE);
                out.add(found, |out, found| out.motion(&found));
                let found = search.clearance_of_motion(&motion, FINE);
                out.add(found, |out, found| out.motion_clearance(&found));
            });
            let other = chain(case.caps, &case.end, &case.radii)?;
            let found = pair.minimum(&robot, &pose, &other, &Pose::IDENTITY);
            out.add(found, |out, found| {
                out.0.push(found.distance);
                let witness = &found.witness;
                out.numbers(witness.on_first.to_array());
                out.numbers(witness.on_second.to_array());
                out.numbers(witness.arc_lengths);
            });
            out.add(alone.minimum(&robot), |out, found| {
                out.0.push(found.map_or(f64::INFINITY, |found| found.distance));
            });
            let mut scene = Scene::new();
            scene.set_robot_margin(Some(0.1))?;
            scene.add("wall", search.clone(), Some(margin))?;
            let robots = [(&robot, pose), (&other, Pose::IDENTITY)];
            out.add(scene.tightest(&robots), |out, found| match found {
                None => out.0.push(f64::INFINITY),
                Some(found) => {
                    let structure = match found.between {
                        Between::Structure(found) => f64::from(found.structure),
                        _ => f64::NAN,
                    };
                    out.numbers([found.slack, structure]);
                }
            });
            scene.set_margin_between(0, 1, Some(0.5))?;
            out.numbers([0, 1].map(|k| scene.margin_between(0, k).unwrap_or(f64::NAN)));
            out.add(scene.set_solid(0, true), |out, ()| out.0.push(1.0));
            out.truth(scene.is_solid(0));
            let sets = [[robots[0], robots[1]], [robots[1], robots[0]]];
            let sets = sets.each_ref().map(|set| set.as_slice());
            let mut found = Vec::new();
            scene.clears_batch(&sets, &mut found);
            for found in found {
                out.add(found, |out, clears| out.truth(clears));
            }
            let mut found = Vec::new();
            scene.tightest_batch(&sets, &mut found);
            for found in found {
                out.add(found, |out, found| {
                    out.0.push(found.map_or(f64::INFINITY, |found| found.slack));
                });
            }
            scene.set_margin_between(0, 1, None)?;
            out.add(scene.clears(&robots), |out, clears| out.truth(clears));
            scene.set_robot_margin(None)?;
            let motion = LinearMotion::chain(&case.start, &case.end, &case.radii);
            out.add(motion, |out, motion| {
                let moved = [(0, StructureEnd::Pose(pose))];
                let found = scene.clears_motion_while(&moved, &[&motion], FINE);
                out.add(found, |out, found| out.scene_motion(&found));
                let vertices: Vec<_> = search.vertices().iter().map(|it| it * 1.25).collect();
                let grown = [(0, StructureEnd::Vertices(&vertices))];
                let found = scene.clears_motion_while(&grown, &[&motion], FINE);
                out.add(found, |out, found| out.scene_motion(&found));
                let mut found = Vec::new();
                scene.clears_motion_batch(&[&[&motion], &[&motion]], FINE, &mut found);
                for found in found {
                    out.add(found, |out, found| out.scene_motion(&found));
                }
            });
        }
        if case.mesh == searches.len() - 1 {
            everyone.push((robot, pose));
        }
    }
    // A batch of all robots beside the last mesh.
    let (mut found, last) = (Vec::new(), searches.len() - 1);
    let robots: Vec<_> = everyone.iter().map(|(robot, pose)| (robot, *pose)).collect();
    searches[last].minimum_batch(&robots, &mut found)?;
    for found in found {
        out.add(found, |out, found| out.minimum(&found));
    }
    let mut found = Vec::new();
    searches[last].per_link_batch(&robots, &mut found)?;
    for found in found {
        out.add(found, |out, links| links.iter().for_each(|link| out.minimum(link)));
    }
    let pair = RobotPair::new();
    let shifted = robots.windows(2).map(|next| [next[0], (next[0].0, next[1].1)]);
    let pairs: Vec<_> = shifted.collect();
    let mut found = Vec::new();
    pair.clears_batch(&pairs, 0.5, &mut found)?;
    for found in found {
        out.add(found, |out, clears| out.truth(clears));
    }
    let mut found = Vec::new();
    let bent: Vec<_> = (0..SECTIONED).map(sections).collect();
    let bend = |numbers: [[f64; 3]; 2]| {
        let [first, second] = numbers;
        [(first, 0.3), (second, 0.2)].map(|([length, x, y], radius)| BendingSection {
            length,
            bend: [x, y],
            radius,
        })
    };
    let bent: Vec<_> = bent.into_iter().map(bend).collect();
    searches[last].clears_sections_batch(&bent, 5, &Pose::IDENTITY, 0.1, &mut found)?;
    for found in found {
        out.add(found, |out, clears| out.truth(clears));
    }
    save(output, &out.0)
}

/// How many robots of two sections there are.
const SECTIONED: u32 = 1000;

/// The length and the curvatures of the sections of robot `k`. Some have no length.
fn sections(k: u32) -> [[f64; 3]; 2] {
    let times = |share: f64, period: u32| share * f64::from(k % period);
    let length = if k % 97 == 96 { f64::NAN } else { 2.0 + times(0.5, 10) };
    [[length, times(0.0625, 7), times(-0.03125, 5)], [2.0, 0.5 - times(0.125, 11), times(0.25, 3)]]
}

fn main() -> Fallible<()> {
    let arguments: Vec<_> = env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["write", cases] => write(cases),
        [cases, answers] => answer(cases, answers),
        _ => Err("usage: answers write CASES | answers CASES ANSWERS".into()),
    }
}
