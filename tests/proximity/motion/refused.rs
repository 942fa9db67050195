//! Motions that cannot be queried.

use super::anatomy;
use continuum_demo::ventricle;
use parry_continuum::parry::math::{Pose, Real, Rotation, Vector};
use parry_continuum::proximity::{Decision, MotionAnswer, PlacementFault, ProximityError};
use parry_continuum::{
    BendingMotion, BendingSection, Chain, LinearMotion, Motion, RigidMotion, RobotError, Speed,
    Tube, verify_motion,
};

/// A motion that is made up of two functions.
struct Made<S, V>(S, V);

impl<S, V> Motion for Made<S, V>
where
    S: Fn(Real, &mut Tube) -> Result<Pose, RobotError>,
    V: Fn() -> Real,
{
    fn shape(&self, t: Real, tube: &mut Tube) -> Result<Pose, RobotError> {
        self.0(t, tube)
    }

    fn speed(&self, _section: usize, _shares: [Real; 2], _times: [Real; 2]) -> Speed {
        Speed { point: self.1(), turn: 0.0 }
    }
}

fn decision(answer: Result<MotionAnswer, ProximityError>) -> Result<Decision, ProximityError> {
    answer.map(|answer| answer.decision)
}

#[test]
fn a_motion_that_cannot_be_asked_about_is_refused() {
    let mut search = anatomy();
    let inside = ventricle::entry().translation;
    let straight = |links: usize, radius: Real| {
        move |_: Real, tube: &mut Tube| {
            let points: Vec<_> =
                (0..=links).map(|k| inside + Vector::Z * (0.1 * k as Real)).collect();
            tube.set_samples(&points, &vec![radius; links], None)?;
            Ok(Pose::IDENTITY)
        }
    };
    let good = Made(straight(3, 0.1), || 0.0);
    assert_eq!(decision(search.clears_motion(&good, 0.0, 1e-3)), Ok(Decision::Clear));
    assert_eq!(decision(search.time_of_contact(&good, 0.0, 1e-3)), Ok(Decision::Clear));
    assert!(matches!(
        search.clears_motion(&good, -1.0, 1e-3),
        Err(ProximityError::Negative { parameter: "margin", .. })
    ));
    assert!(matches!(
        search.clears_motion(&good, 0.0, -1.0),
        Err(ProximityError::Negative { parameter: "resolution", .. })
    ));
    assert!(matches!(
        search.clears_motion(&good, 0.0, Real::NAN),
        Err(ProximityError::Negative { parameter: "resolution", .. })
    ));
    assert!(matches!(
        search.clears_motion(&good, 0.0, 0.0),
        Err(ProximityError::ToleranceTooFine { .. })
    ));
    for speed in [Real::NAN, -1.0, Real::INFINITY] {
        let refused = search.clears_motion(&Made(straight(3, 0.1), || speed), 0.0, 1e-3);
        assert!(
            matches!(refused, Err(ProximityError::Motion(RobotError::BadSpeed { .. }))),
            "{refused:?}"
        );
    }
    let fast = search.clears_motion(&Made(straight(3, 0.1), || 1e30), 0.0, 1e-3);
    assert!(matches!(fast, Err(ProximityError::TooFast { .. })), "{fast:?}");
    // The radius changes on the way.
    let changing = Made(
        |t: Real, tube: &mut Tube| straight(3, if t < 0.5 { 0.1 } else { 0.2 })(t, tube),
        || 100.0,
    );
    let refused = search.clears_motion(&changing, 0.0, 1e-3);
    assert!(
        matches!(refused, Err(ProximityError::Motion(RobotError::SectionsChange { .. }))),
        "{refused:?}"
    );
    assert!(matches!(verify_motion(&changing, 4), Err(RobotError::SectionsChange { .. })));
    // There is no shape, or none that can be queried.
    let broken = Made(
        |_: Real, tube: &mut Tube| tube.set_samples(&[], &[], None).map(|()| Pose::IDENTITY),
        || 0.0,
    );
    assert!(matches!(search.clears_motion(&broken, 0.0, 1e-3), Err(ProximityError::Motion(_))));
    let failing =
        Made(|t: Real, _: &mut Tube| Err(RobotError::NoShape { t, reason: "no solution" }), || 0.0);
    let failed = search.clears_motion(&failing, 0.0, 1e-3).unwrap_err();
    assert_eq!(failed.kind(), "no_shape");
    assert_eq!(failed.to_string(), "the kinematics has no shape at t = 0.5: no solution");
    let nothing = Made(|_: Real, _: &mut Tube| Ok(Pose::IDENTITY), || 0.0);
    search.forget();
    let lost = Made(
        |t: Real, tube: &mut Tube| {
            straight(3, 0.1)(t, tube).map(|_| Pose::from_translation(Vector::splat(Real::NAN)))
        },
        || 0.0,
    );
    assert_eq!(
        search.clears_motion(&lost, 0.0, 1e-3),
        Err(ProximityError::Pose(PlacementFault::PoseNotFinite))
    );
    assert_eq!(anatomy().clears_motion(&nothing, 0.0, 1e-3), Err(ProximityError::EmptyTube));

    let (a, b) = ([Vector::ZERO, Vector::Z], [Vector::ZERO, Vector::Z, Vector::X]);
    assert_eq!(
        LinearMotion::chain(&a, &b, &[1.0]).unwrap_err(),
        RobotError::PointsDiffer { from: 2, to: 3 }
    );
    assert!(LinearMotion::capsules(&a, &a, &[-1.0]).is_err());
    assert!(LinearMotion::capsules(&a[..1], &a[..1], &[]).is_err());
    assert!(LinearMotion::capsules(&[Vector::ZERO; 2], &[Vector::X; 2], &[1.0]).is_err());
    let section = BendingSection { length: 1.0, radius: 0.1, bend: [0.0, 0.1] };
    let thick = BendingSection { radius: 0.2, ..section };
    assert_eq!(
        BendingMotion::new(&[section], &[thick], Pose::IDENTITY).unwrap_err(),
        RobotError::SectionsDiffer { index: 0 }
    );
    let unknown = BendingSection { radius: Real::NAN, ..section };
    let refused = BendingMotion::new(&[unknown], &[unknown], Pose::IDENTITY);
    assert!(matches!(refused, Err(RobotError::BadRadius { .. })), "{refused:?}");
    assert!(BendingMotion::new(&[section], &[section, section], Pose::IDENTITY).is_err());
    assert!(BendingMotion::new(&[], &[], Pose::IDENTITY).is_err());
    let endless = BendingSection { length: Real::INFINITY, ..section };
    assert!(BendingMotion::new(&[section], &[endless], Pose::IDENTITY).is_err());
    let turned = Pose::from_parts(Vector::ZERO, Rotation::from_xyzw(Real::NAN, 0.0, 0.0, 1.0));
    let lost = Pose::from_translation(Vector::splat(Real::NAN));
    for pose in [lost, turned] {
        let refused = BendingMotion::new(&[section], &[section], pose);
        assert!(matches!(refused, Err(RobotError::BadPose { .. })), "{refused:?}");
    }
    assert!(
        RigidMotion::new(Tube::from(&Chain::capsules(&a, &[1.0]).unwrap()), [lost, lost]).is_err()
    );
}

/// What one motion states of its tube is not left to the next, which says nothing of it.
#[test]
fn an_error_is_not_left_to_the_next_motion() {
    let mut search = anatomy();
    let inside = ventricle::entry().translation;
    let line = [inside, inside + Vector::Z * 0.3];
    let made = |t: Real, tube: &mut Tube| {
        tube.set_samples(&line, &[0.1], None)?;
        Ok(Pose::from_translation(Vector::Z * (0.1 * t)))
    };
    let motion = Made(made, || 0.1);
    let fresh = search.clears_motion(&motion, 0.2, 1e-3);
    assert_eq!(decision(fresh), Ok(Decision::Clear));
    let blurred = Tube::from_samples(&line, &[0.1], None).unwrap().with_error(50.0).unwrap();
    let blurred = RigidMotion::new(blurred, [Pose::IDENTITY; 2]).unwrap();
    assert_ne!(decision(search.clears_motion(&blurred, 0.2, 1e-3)), Ok(Decision::Clear));
    assert_eq!(search.clears_motion(&motion, 0.2, 1e-3), fresh);
}
