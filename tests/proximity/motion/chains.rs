//! Chains whose vertices move straight.

use super::polyline;
use continuum_scene::ventricle;
use continuum_testing::Random;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, FirstContact, MotionAnswer, Proximity};
use parry_continuum::{Chain, LinearMotion, RobotError, verify_motion};

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
    for round in 0..400 {
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
        let chains: Vec<_> = (0..=count).map(|step| chain(Real::from(step) / Real::from(count))).collect();
        let distance =
            |search: &mut BvhSearch, chain: &Chain| search.minimum(chain, &Pose::IDENTITY).unwrap().distance;
        let distances: Vec<_> = chains.iter().map(|chain| distance(&mut search, chain)).collect();
        changing += usize::from(chains.iter().any(|chain| {
            chain.links().iter().zip(chains[0].links()).any(|(link, first)| link.caps() != first.caps())
        }));
        let least = distances.iter().copied().fold(Real::INFINITY, Real::min);
        // Between two steps nothing moves farther than this, unless a cap changes.
        let fine = 4.0 / Real::from(count);
        for margin in [0.0, random.unit(), (least - fine).max(0.0), least + 2e-3] {
            match search.clears_motion(&motion, margin, 1e-3).unwrap() {
                MotionAnswer::Clear => {
                    clear += 1;
                    wide += usize::from(least > margin + 0.5);
                    assert!(least > margin, "certified, but a step is {least} away, margin {margin}");
                }
                MotionAnswer::Contact { t, upper, .. } => {
                    contact += 1;
                    let truth = distance(&mut search, &chain(t));
                    assert!(
                        truth <= margin + 1e-9 && truth <= upper + 1e-9,
                        "{truth} at {t}, margin {margin}"
                    );
                }
                MotionAnswer::Undecided { .. } => undecided += 1,
                other => panic!("{other:?}"),
            }
            // When it happens.
            match search.time_of_contact(&motion, margin, 1e-3).unwrap() {
                FirstContact::Never => assert!(least > margin, "never, but {least} away, margin {margin}"),
                FirstContact::Within { clear_until, t, upper, .. } => {
                    assert!(clear_until <= t);
                    let truth = distance(&mut search, &chain(t));
                    assert!(truth <= margin + 1e-9 && upper <= margin, "{truth} at {t}, margin {margin}");
                    let clear = distances.iter().take((clear_until * Real::from(count)).ceil() as usize);
                    assert!(clear.clone().all(|distance| *distance > margin), "{clear_until} to {t}");
                }
                FirstContact::Undecided { interval, .. } => {
                    let clear = distances.iter().take((interval[0] * Real::from(count)).ceil() as usize);
                    assert!(clear.clone().all(|distance| *distance > margin), "{interval:?}");
                }
                other => panic!("{other:?}"),
            }
        }
    }
    println!("{clear} {contact} {undecided} {changing} {wide}");
    assert!(
        clear > 200 && contact > 400 && changing > 20 && wide > 50,
        "{clear} {contact} {changing} {wide}"
    );
    assert!(undecided < 40, "{undecided}");
}
