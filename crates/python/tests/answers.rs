//! The Rust library's answers to a problem of the Python tests, as numbers: what Python gets must
//! be the same, bit for bit.
//!
//! Reads and writes 64-bit floats, little-endian. In: the counts of vertices, triangles, robots and
//! points each; the vertices, the triangles, and for each robot its points, where they move to, its
//! radii and its pose as 16 numbers.

use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::proximity::{
    BvhSearch, Certificate, Decision, MotionAnswer, Proximity, RobotPair, RobotProximity,
    SelfQuery, Side, Witness,
};
use parry_continuum::{
    BendingMotion, BendingSection, Chain, LinearMotion, MovingBase, RigidMotion, Tube,
    pose_from_matrix,
};
use std::error::Error;
use std::io::{Read, Write, stdin, stdout};

const MARGIN: f64 = 0.5;
const TOLERANCE: f64 = 0.01;

struct Numbers(std::vec::IntoIter<f64>);

impl Numbers {
    fn one(&mut self) -> Result<f64, &'static str> {
        self.0.next().ok_or("there are too few numbers")
    }

    fn count(&mut self) -> Result<usize, &'static str> {
        Ok(self.one()? as usize)
    }

    fn many(&mut self, count: usize) -> Result<Vec<f64>, &'static str> {
        (0..count).map(|_| self.one()).collect()
    }

    fn points(&mut self, count: usize) -> Result<Vec<Vector>, &'static str> {
        (0..count).map(|_| Ok(Vector::new(self.one()?, self.one()?, self.one()?))).collect()
    }
}

fn add_witness(out: &mut Vec<f64>, found: &Witness) {
    out.extend(found.on_robot.to_array());
    out.extend(found.on_mesh.to_array());
    out.extend([f64::from(found.segment), found.arc_length, f64::from(found.triangle)]);
}

fn add_answer(out: &mut Vec<f64>, found: &MotionAnswer) {
    out.extend(found.interval);
    out.push(match found.decision {
        Decision::Contact => -1.0,
        Decision::Undecided => 0.0,
        Decision::Clear => 1.0,
    });
}

fn add_between(out: &mut Vec<f64>, found: &[RobotProximity]) {
    for found in found {
        out.push(found.distance);
        out.extend(found.witness.on_first.to_array());
        out.extend(found.witness.on_second.to_array());
        out.extend(found.witness.arc_lengths);
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut bytes = Vec::new();
    stdin().read_to_end(&mut bytes)?;
    let numbers: Vec<_> =
        bytes.as_chunks::<8>().0.iter().map(|bytes| f64::from_le_bytes(*bytes)).collect();
    let mut input = Numbers(numbers.into_iter());
    let [vertices, triangles, robots, points] =
        [input.count()?, input.count()?, input.count()?, input.count()?];
    let vertices = input.points(vertices)?;
    let triangles: Vec<_> = input
        .many(3 * triangles)?
        .as_chunks::<3>()
        .0
        .iter()
        .map(|face| face.map(|corner| corner as u32))
        .collect();
    let mut search = BvhSearch::from_triangles(&vertices, &triangles)?;
    let (mut out, mut links, mut contacts, mut between) =
        (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for _ in 0..robots {
        let (points, end) = (input.points(points)?, input.points(points)?);
        let radii = input.many(points.len() - 1)?;
        let matrix = input.many(16)?;
        let pose =
            pose_from_matrix(std::array::from_fn(|i| std::array::from_fn(|j| matrix[4 * i + j])))?;
        for chain in [
            Chain::from_centreline(&points, &radii)?,
            Chain::capsules(&points, &radii)?,
            Chain::cylinders(&points, &radii)?,
        ] {
            let closest = search.minimum(&chain, &pose)?;
            out.push(closest.distance);
            add_witness(&mut out, &closest.witness);
            search.per_link(&chain, &pose, &mut links)?;
            for link in &links {
                out.push(link.distance);
                add_witness(&mut out, &link.witness);
                let mesh = search.triangles()[link.witness.triangle as usize]
                    .map(|corner| search.vertices()[corner as usize]);
                let bounds = Certificate::between(&chain.links()[link.link as usize], &pose, mesh)?;
                out.extend([bounds.lower, bounds.upper]);
            }
            let inside = search.clears_inside(&chain, &pose, MARGIN)?;
            out.push(f64::from(inside.clears));
            out.push(match inside.base {
                Side::Inside => -1.0,
                Side::Undecided => 0.0,
                Side::Outside => 1.0,
            });
            search.contacts_within(&chain, &pose, MARGIN, 0.0, &mut contacts)?;
            out.push(contacts.len() as f64);
            for contact in &contacts {
                out.extend([contact.fraction, contact.distance, contact.depth]);
                out.extend(contact.normal.unwrap_or(Vector::NAN).to_array());
                add_witness(&mut out, &contact.witness);
            }
        }
        let tube = Tube::from_samples(&points, &radii, None)?;
        // In contact, the common point of a tube depends on earlier queries.
        let found =
            BvhSearch::from_triangles(&vertices, &triangles)?.clearance(&tube, &pose, TOLERANCE)?;
        out.extend([found.lower, found.upper, f64::from(found.resolved), found.uncertainty]);
        add_witness(&mut out, &found.witness);
        // For motions, only the fields that do not depend on earlier queries.
        let rigid = RigidMotion::new(
            Tube::from(&Chain::from_centreline(&points, &radii)?),
            [pose, Pose::IDENTITY],
        )?;
        let sections = |points: &[Vector]| -> Vec<_> {
            let bend = |point: &Vector| [0.01 * point.x, 0.01 * point.y];
            let section =
                |point| BendingSection { length: 1.0, radius: radii[0], bend: bend(point) };
            points[..2].iter().map(section).collect()
        };
        let bending = BendingMotion::new(&sections(&points), &sections(&end), pose)?;
        let based = MovingBase::new(bending.clone(), [pose, Pose::IDENTITY])?;
        let fresh = || BvhSearch::from_triangles(&vertices, &triangles);
        add_answer(&mut out, &fresh()?.clears_motion(&rigid, 0.0, TOLERANCE)?);
        add_answer(&mut out, &fresh()?.clears_motion(&bending, 0.0, TOLERANCE)?);
        add_answer(&mut out, &fresh()?.clears_motion(&based, 0.0, TOLERANCE)?);
        let shifted: Vec<_> =
            points.iter().map(|point| *point + Vector::new(0.5, -0.25, 1.0)).collect();
        let shapes = [Chain::capsules(&points, &radii)?, Chain::capsules(&shifted, &radii)?];
        add_answer(&mut out, &fresh()?.clears_path(&shapes, 0.1, MARGIN, TOLERANCE)?);
        let moved: Vec<_> = vertices.iter().map(|vertex| *vertex * 0.9).collect();
        add_answer(&mut out, &fresh()?.clears_motion_while(&moved, &rigid, 0.0, TOLERANCE)?);
        let [a, b] =
            [Chain::from_centreline(&points, &radii)?, Chain::from_centreline(&end, &radii)?];
        RobotPair::new().per_link(&a, &pose, &b, &Pose::IDENTITY, &mut between)?;
        add_between(&mut out, &between);
        RobotPair::new().contacts_within(&a, &pose, &b, &Pose::IDENTITY, 4.0, &mut between)?;
        out.push(between.len() as f64);
        add_between(&mut out, &between);
        // There and back, 2 beside. Some joints at the turn are too sharp for the query.
        let back = points.iter().rev().map(|point| *point + 2.0 * Vector::X);
        let hairpin: Vec<_> = points.iter().copied().chain(back).collect();
        let hairpin = Chain::from_centreline(&hairpin, &vec![radii[0]; hairpin.len() - 1])?;
        let own = SelfQuery::new().minimum(&hairpin);
        out.push(own.as_ref().map_or(-1.0, |found| f64::from(found.is_some())));
        add_between(&mut out, own.ok().flatten().as_slice());
        for motion in [
            LinearMotion::chain(&points, &end, &radii)?,
            LinearMotion::capsules(&points, &end, &radii)?,
        ] {
            add_answer(&mut out, &search.clears_motion(&motion, 0.0, TOLERANCE)?);
        }
    }
    let bytes: Vec<_> = out.into_iter().flat_map(f64::to_le_bytes).collect();
    Ok(stdout().write_all(&bytes)?)
}
