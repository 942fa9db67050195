//! Answers to seeded questions as one number a kind, to compare machines and instruction sets to the last bit: what two
//! machines print is the same. `.ci/alone` runs it here and as WebAssembly.
//!
//! `cargo run --release -p continuum-testing --example bits`

use continuum_testing::Random;
use parry_continuum::parry::math::{Pose, Rotation, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Exhaustive, LinkProximity, Proximity, Witness};
use parry_continuum::{BendingSection, Chain, ConstantCurvature, LinearMotion, RigidMotion, Tube};

/// Robots of each kind.
const COUNT: usize = 200;
/// Far from the origin the rounding of a coordinate is felt.
const OFFSETS: [f64; 3] = [0.0, 100.0, 1.5e7];

/// All that was answered, mixed into 64 bits (FNV-1a).
struct Bits {
    name: &'static str,
    numbers: usize,
    hash: u64,
}

impl Bits {
    fn new(name: &'static str) -> Self {
        Self { name, numbers: 0, hash: 0xcbf2_9ce4_8422_2325 }
    }

    fn add(&mut self, numbers: impl IntoIterator<Item = f64>) {
        for number in numbers {
            self.numbers += 1;
            for byte in number.to_bits().to_le_bytes() {
                self.hash = (self.hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
            }
        }
    }

    fn add_witness(&mut self, witness: &Witness) {
        self.add(witness.on_robot.to_array().into_iter().chain(witness.on_mesh.to_array()));
        self.add([f64::from(witness.triangle), witness.arc_length]);
    }

    fn add_link(&mut self, answer: &LinkProximity) {
        self.add([f64::from(answer.link), answer.distance]);
        self.add_witness(&answer.witness);
    }
}

/// A closed wall of 2 n^2 triangles around the offset, uneven.
fn wall(random: &mut Random, n: u32, offset: f64) -> (Vec<Vector>, Vec<[u32; 3]>) {
    let vertices = (0..(n + 1) * (n + 1))
        .map(|k| {
            let [i, j] = [k / (n + 1), k % (n + 1)].map(|k| 2.0 * f64::from(k) / f64::from(n) - 1.0);
            let height = 2.0 + i * i - j * j + 0.05 * random.unit();
            Vector::new(5.0 * i + offset, 5.0 * j, height)
        })
        .collect();
    let cell = |k: u32| {
        let a = (n + 1) * (k / n) + k % n;
        [[a, a + 1, a + n + 1], [a + 1, a + n + 2, a + n + 1]]
    };
    (vertices, (0..n * n).flat_map(cell).collect())
}

/// A pose without sines, which are the system's.
fn pose(random: &mut Random, offset: f64) -> Pose {
    let [a, b] = [random.point(), random.point()];
    let rotation = Rotation::from_xyzw(a.x, a.y, a.z, b.x).normalize();
    Pose::from_parts(random.point() + Vector::X * offset, rotation)
}

fn centreline(random: &mut Random) -> Vec<Vector> {
    let mut points = vec![random.point()];
    let mut way = random.direction();
    for _ in 0..12 {
        way = (way + 0.2 * random.point()).normalize();
        points.push(points[points.len() - 1] + way * 0.3);
    }
    points
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut all = [
        "minimum",
        "per_link",
        "certify",
        "contacts",
        "exhaustive",
        "clearance",
        "sections",
        "motion",
        "side",
    ]
    .map(Bits::new);
    for offset in OFFSETS {
        let random = &mut Random::new(7);
        let (vertices, triangles) = wall(random, 24, offset);
        let mesh = TriMesh::new(vertices.clone(), triangles.clone())?;
        let mut search = BvhSearch::from_triangles(&vertices, &triangles)?;
        let mut exhaustive = Exhaustive::<f32>::from_triangles(&vertices, &triangles)?;
        // Finer than rounding, or than what samples leave open, is refused.
        let resolution = 0.1 + 1e-8 * offset;
        let (mut links, mut contacts) = (Vec::new(), Vec::new());
        for _ in 0..COUNT {
            let [minimum, per_link, certified, near, every, clearance, sections, motions, sides] = &mut all;
            let (points, pose) = (centreline(random), pose(random, offset));
            let radii = [0.05 + 0.1 * random.unit(); 12];
            let chain = Chain::from_centreline(&points, &radii)?;
            let closest = search.minimum(&chain, &pose)?;
            minimum.add_link(&closest);
            let certificate = closest.certify(&chain, &pose, &mesh)?;
            certified.add([certificate.lower, certificate.upper]);
            search.per_link(&chain, &pose, &mut links)?;
            links.iter().for_each(|link| per_link.add_link(link));
            search.within(&chain, &pose, 1.0, 0.0, &mut contacts)?;
            for contact in &contacts {
                near.add([contact.distance, contact.depth.unwrap_or(-1.0)]);
                near.add_witness(&contact.witness);
            }
            exhaustive.per_link(&chain, &pose, &mut links)?;
            links.iter().for_each(|link| every.add_link(link));
            let tube = Tube::from_samples(&points, &radii, None)?;
            let found = search.clearance(&tube, &pose, 0.01)?;
            clearance.add([found.lower, found.upper]);
            clearance.add_witness(&found.witness);
            let section =
                BendingSection { length: 3.0, radius: 0.2, bend: [0.3 * random.unit(), random.unit()] };
            let found = search.clearance(&ConstantCurvature::new(&[section])?.tube()?, &pose, 0.001)?;
            sections.add([found.lower, found.upper]);
            let to: Vec<_> = points.iter().map(|point| *point + 0.1 * random.point()).collect();
            let answer =
                search.clears_motion(&LinearMotion::chain(&points, &to, &radii)?, 0.01, resolution)?;
            motions.add(answer.interval);
            let turned = Pose::from_parts(
                pose.translation,
                (pose.rotation * Rotation::from_xyzw(0.01, 0.02, 0.0, 1.0)).normalize(),
            );
            let answer = search.time_of_contact(&RigidMotion::new(tube, [pose, turned])?, 0.1, resolution)?;
            motions.add(answer.interval);
            sides.add([f64::from(search.side(pose.translation) as u8)]);
        }
    }
    for Bits { name, numbers, hash } in all {
        println!("{name}: {numbers} numbers, {hash:016x}");
    }
    Ok(())
}
