//! Chains whose vertices move straight.

use super::polyline;
use continuum_demo::ventricle;
use continuum_testing::{Random, rounds};
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Decision, Proximity};
use parry_continuum::{Cap, Chain, LinearMotion, Motion, RobotError, Speed, Tube, verify_motion};

/// The model of a chain: Algorithm 1, or capsules.
type Model = fn(&[Vector], &[Real]) -> Result<Chain, RobotError>;

/// Chains whose vertices move straight, against the links of each step.
#[test]
fn no_chain_is_misjudged() {
    let (vertices, indices) = ventricle::mesh(6_000);
    let mesh = TriMesh::new(vertices, indices).unwrap();
    let mut search = BvhSearch::new(&mesh).unwrap();
    let mut random = Random::new(4);
    let (mut clear, mut contact, mut undecided, mut changing, mut wide) = (0, 0, 0, 0, 0);
    for round in 0..rounds(400) {
        let near = mesh.vertices()[random.below(mesh.vertices().len() as u32) as usize];
        let base = near + random.point() * 4.0;
        let (from, radii) = polyline(&mut random, base);
        let shift = random.direction() * random.between(0.0, 3.0);
        let to: Vec<_> = from.iter().map(|&point| point + shift + random.point() * 0.5).collect();
        let (motion, model): (_, Model) = if round % 3 == 0 {
            (LinearMotion::capsules(&from, &to, &radii).unwrap(), Chain::capsules)
        } else {
            (LinearMotion::chain(&from, &to, &radii).unwrap(), Chain::from_centreline)
        };
        verify_motion(&motion, 20).unwrap();
        let count = 400;
        let chain = |t: Real| {
            let points: Vec<_> = from.iter().zip(&to).map(|(a, b)| a + (b - a) * t).collect();
            model(&points, &radii).unwrap()
        };
        let chains: Vec<_> =
            (0..=count).map(|step| chain(Real::from(step) / Real::from(count))).collect();
        let distance = |search: &mut BvhSearch, chain: &Chain| {
            search.minimum(chain, &Pose::IDENTITY).unwrap().distance
        };
        let distances: Vec<_> = chains.iter().map(|chain| distance(&mut search, chain)).collect();
        changing += usize::from(chains.iter().any(|chain| {
            chain
                .links()
                .iter()
                .zip(chains[0].links())
                .any(|(link, first)| link.caps() != first.caps())
        }));
        let least = distances.iter().copied().fold(Real::INFINITY, Real::min);
        // Between two steps nothing moves farther than this, unless a cap changes.
        let fine = 4.0 / Real::from(count);
        for margin in [0.0, random.unit(), (least - fine).max(0.0), least + 2e-3] {
            let answer = search.clears_motion(&motion, margin, 1e-3).unwrap();
            match (answer.decision, answer.contact) {
                (Decision::Clear, _) => {
                    clear += 1;
                    wide += usize::from(least > margin + 0.5);
                    assert!(
                        least > margin,
                        "certified, but a step is {least} away, margin {margin}"
                    );
                }
                (Decision::Contact, Some(shape)) => {
                    let (t, upper) = (shape.t, shape.upper);
                    contact += 1;
                    let truth = distance(&mut search, &chain(t));
                    assert!(
                        truth <= margin + 1e-9 && truth <= upper + 1e-9,
                        "{truth} at {t}, margin {margin}"
                    );
                }
                (Decision::Undecided, _) => undecided += 1,
                (Decision::Contact, None) => panic!("{answer:?}"),
            }
            // When it happens.
            let answer = search.time_of_contact(&motion, margin, 1e-3).unwrap();
            match (answer.decision, answer.contact) {
                (Decision::Clear, _) => {
                    assert!(least > margin, "never, but {least} away, margin {margin}")
                }
                (Decision::Contact, Some(shape)) => {
                    let ([clear_until, t], upper) = (answer.interval, shape.upper);
                    assert!(clear_until <= t && t == shape.t);
                    let truth = distance(&mut search, &chain(t));
                    assert!(
                        truth <= margin + 1e-9 && upper <= margin,
                        "{truth} at {t}, margin {margin}"
                    );
                    let clear =
                        distances.iter().take((clear_until * Real::from(count)).ceil() as usize);
                    assert!(
                        clear.clone().all(|distance| *distance > margin),
                        "{clear_until} to {t}"
                    );
                }
                (Decision::Undecided, _) => {
                    let interval = answer.interval;
                    let clear =
                        distances.iter().take((interval[0] * Real::from(count)).ceil() as usize);
                    assert!(clear.clone().all(|distance| *distance > margin), "{interval:?}");
                }
                (Decision::Contact, None) => panic!("{answer:?}"),
            }
        }
    }
    println!("{clear} {contact} {undecided} {changing} {wide}");
    assert!(
        clear > rounds(200) && contact > rounds(400) && changing > rounds(20) && wide > rounds(50),
        "{clear} {contact} {changing} {wide}"
    );
    assert!(undecided <= rounds(40), "{undecided}");
}

/// A short robot with one thick point, which stands still for half of the time and then moves
/// aside. The links behind it stand still all the time, but the first of them gets a round start
/// when the thick point is a radius away.
struct ThickPoint;

impl ThickPoint {
    fn chain(t: Real) -> Result<Chain, RobotError> {
        let aside = 3.0 * (2.0 * t - 1.0).max(0.0).powi(2);
        let points = [
            Vector::ZERO,
            Vector::new(0.25, -aside, 0.0),
            Vector::new(0.5, 0.0, 0.0),
            Vector::new(0.5, 0.0, 0.9),
        ];
        Chain::from_vertex_radii(&points, &[1.0, 2.0, 1.0, 1.0])
    }
}

impl Motion for ThickPoint {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        tube.set_chain(&Self::chain(t)?);
        Ok(Pose::IDENTITY)
    }

    fn speed(&self, section: usize, shares: [Real; 2], _: [Real; 2]) -> Speed {
        // The derivative of `aside` is at most 12, and a link of 0.25 beside it turns by 12 / 0.25
        // at most.
        match section {
            0 => Speed { point: 12.0 * shares[1], turn: 48.0 },
            1 => Speed { point: 12.0 * (1.0 - shares[0]), turn: 48.0 },
            _ => Speed { point: 0.0, turn: 0.0 },
        }
    }
}

/// Caps by vertex radii follow faces that the links' radii don't show.
#[test]
fn a_cap_that_becomes_round_behind_a_thick_point_is_seen() {
    verify_motion(&ThickPoint, 200).unwrap();
    let [before, behind] = [0.5, 1.0].map(|t| ThickPoint::chain(t).unwrap());
    assert_eq!([&before, &behind].map(|chain| chain.links()[2].caps()[0]), [Cap::Flat, Cap::Round]);
    // A speck in the ball at that start, and in nothing else.
    let speck = Vector::new(0.8, 0.3, -0.8);
    let corners = [Vector::X, Vector::Y, Vector::Z].map(|off| speck + off * 1e-3);
    let mut search =
        BvhSearch::new(&TriMesh::new(corners.to_vec(), vec![[0, 1, 2]]).unwrap()).unwrap();
    let distances = (0..=100).map(|step| {
        let chain = ThickPoint::chain(Real::from(step) / 100.0).unwrap();
        search.minimum(&chain, &Pose::IDENTITY).unwrap().distance
    });
    let distances: Vec<_> = distances.collect();
    let first = distances.iter().position(|distance| *distance == 0.0).unwrap();
    assert!(
        first > 60 && distances[..first].iter().all(|distance| *distance > 0.02),
        "{distances:?}"
    );
    let answer = search.clears_motion(&ThickPoint, 0.0, 1e-3).unwrap();
    assert!(answer.contact.is_some_and(|shape| shape.t > 0.6), "{answer:?}");
    // The thick point is a radius away when the square of `aside` is 1 - 0.25^2.
    let jump = 0.5 + 0.5 * ((1.0 - 0.0625_f64).sqrt() / 3.0).sqrt();
    assert!((first as Real / 100.0 - jump).abs() <= 0.01, "{first} {jump}");
    let first = search.time_of_contact(&ThickPoint, 0.0, 1e-3).unwrap();
    let [clear_until, t] = first.interval;
    assert!(first.decision == Decision::Contact && clear_until <= jump && jump <= t, "{first:?}");
}

/// A chain of links that are shorter than its radius, pushed towards a wall.
struct Pushed {
    chain: Chain,
    way: Real,
}

impl Motion for Pushed {
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        tube.set_chain(&self.chain);
        Ok(Pose::from_translation(Vector::Z * (self.way * t)))
    }

    fn speed(&self, _: usize, _: [Real; 2], _: [Real; 2]) -> Speed {
        Speed { point: self.way, turn: 0.0 }
    }
}

/// Joints less than a radius behind the tip's face stay flat if the motion cannot move them away
/// from it: a round cap at the first of them would reach 0.35 beyond the tip.
#[test]
fn short_links_do_not_reach_beyond_a_flat_tip() {
    let points: Vec<_> = (0..=120).map(|k| Vector::Z * (0.25 * Real::from(k))).collect();
    let chain = Chain::from_centreline(&points, &[0.6; 120]).unwrap();
    assert_eq!(chain.links()[118].caps()[1], Cap::Flat);
    let way = 0.05;
    for gap in [0.1, 0.2, 0.4] {
        let z = 30.0 + way + gap;
        let wall =
            [Vector::new(-9.0, -9.0, z), Vector::new(9.0, -9.0, z), Vector::new(0.0, 9.0, z)];
        let mut search = BvhSearch::from_triangles(&wall, &[[0, 1, 2]]).unwrap();
        let answer =
            search.clears_motion(&Pushed { chain: chain.clone(), way }, 0.0, 1e-3).unwrap();
        assert!(answer.is_clear(), "{gap}: {answer:?}");
        let answer =
            search.clears_motion(&Pushed { chain: chain.clone(), way }, 1.1 * gap, 1e-3).unwrap();
        assert_eq!(answer.decision, Decision::Contact, "{gap}: {answer:?}");
    }
}

/// Segments without length are no links, and are counted all the same where an answer names the
/// segment of the input.
#[test]
fn the_segment_of_an_answer_is_that_of_the_input() {
    let from =
        [Vector::Z * 2.0, Vector::Z * 2.0, Vector::new(1.0, 0.0, 2.0), Vector::new(2.0, 0.0, 1.5)];
    let to = from.map(|point| point - Vector::Z);
    let floor =
        [Vector::new(-9.0, -9.0, 0.0), Vector::new(9.0, -9.0, 0.0), Vector::new(0.0, 9.0, 0.0)];
    let mut search = BvhSearch::from_triangles(&floor, &[[0, 1, 2]]).unwrap();
    for motion in
        [LinearMotion::chain, LinearMotion::capsules].map(|new| new(&from, &to, &[0.1; 3]).unwrap())
    {
        // The last of three segments comes to 0.4.
        let contact = search.clears_motion(&motion, 0.5, 1e-3).unwrap().contact.unwrap();
        assert_eq!(contact.witness.segment, 2);
        let first = search.time_of_contact(&motion, 0.5, 1e-3).unwrap().contact.unwrap();
        assert_eq!(first.witness.segment, 2);
        assert_eq!(search.clearance_of_motion(&motion, 0.01).unwrap().witness.segment, 2);
    }
    // The centre of the tip comes to 0.5; the direction of its face is unknown.
    let shapes = [&from, &to].map(|points| Chain::capsules(points, &[0.1; 3]).unwrap());
    let contact = search.clears_path(&shapes, 0.01, 0.6, 1e-3).unwrap().contact.unwrap();
    assert_eq!(contact.witness.segment, 2);
}
