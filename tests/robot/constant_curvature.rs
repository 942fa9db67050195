//! Sections of constant curvature: the frame's differential equation, the formulas of the
//! literature, and the tube.

use continuum_testing::Random;
use parry_continuum::parry::math::{Pose, Rotation, Vector};
use parry_continuum::{BendingSection, ConstantCurvature, RobotError};

fn random_sections(random: &mut Random) -> Vec<BendingSection> {
    let section = |random: &mut Random| BendingSection {
        length: random.between(0.5, 30.0),
        radius: random.between(0.1, 2.0),
        bend: match random.below(4) {
            0 => [0.0, 0.0],
            1 => [1e-12, -1e-11],
            _ => [random.between(-0.2, 0.2), random.between(-0.2, 0.2)],
        },
    };
    (0..1 + random.below(4)).map(|_| section(random)).collect()
}

/// dp/ds = R z, dR/ds = R [u] with u across the curve: many small turns and steps.
#[test]
fn the_frame_solves_its_equation() {
    let mut random = Random::new(67);
    for _ in 0..20 {
        let sections = random_sections(&mut random);
        let robot = ConstantCurvature::new(&sections).unwrap();
        let (mut frame, mut arc_length, mut allowed) = (Pose::IDENTITY, 0.0, 1e-10);
        for section in &sections {
            const STEPS: u32 = 2000;
            let step = section.length / f64::from(STEPS);
            let [x, y] = section.bend;
            let half_turn = Rotation::from_scaled_axis(Vector::new(-y, x, 0.0) * (0.5 * step));
            for _ in 0..STEPS {
                let middle = frame.rotation * half_turn;
                frame.translation += middle * Vector::Z * step;
                frame.rotation = middle * half_turn;
                arc_length += step;
                let found = robot.frame(arc_length);
                // A chord is shorter than its arc by this much.
                allowed += step * step * step * (x * x + y * y) / 24.0;
                assert!(
                    found.translation.distance(frame.translation) <= allowed,
                    "{arc_length}: {found:?} {frame:?}"
                );
                let turned = (found.rotation * Vector::X - frame.rotation * Vector::X).length();
                assert!(turned < 1e-10, "{arc_length}: {turned}");
            }
        }
        assert!((robot.length() - arc_length).abs() < 1e-9);
    }
}

/// Webster and Jones (2010): x, y, z = (1 - cos(k l)) / k towards the bend, sin(k l) / k along.
#[test]
fn a_quarter_turn_ends_where_it_should() {
    let radius = 20.0;
    let length = radius * std::f64::consts::FRAC_PI_2;
    let towards_y = BendingSection { length, radius: 1.0, bend: [0.0, 1.0 / radius] };
    let robot = ConstantCurvature::new(&[
        towards_y,
        BendingSection { bend: [0.0; 2], length: 5.0, ..towards_y },
    ])
    .unwrap();
    let quarter = robot.frame(length);
    assert!(quarter.translation.distance(Vector::new(0.0, radius, radius)) < 1e-13);
    assert!((quarter.rotation * Vector::Z).distance(Vector::Y) < 1e-15);
    assert!(
        robot.frame(length + 5.0).translation.distance(Vector::new(0.0, radius + 5.0, radius))
            < 1e-13
    );
}

#[test]
fn points_and_tube_are_on_the_curve() {
    let mut random = Random::new(71);
    let mut tubes = 0;
    for _ in 0..100 {
        let sections = random_sections(&mut random);
        let robot = ConstantCurvature::new(&sections).unwrap();
        let (points, radii) = robot.points(7);
        assert_eq!((points.len(), radii.len()), (7 * sections.len() + 1, 7 * sections.len()));
        let mut arc_length = 0.0;
        for (number, point) in points.iter().enumerate() {
            assert!(
                point.distance(robot.frame(arc_length).translation) < 1e-12 * (1.0 + arc_length)
            );
            arc_length += sections[(number / 7).min(sections.len() - 1)].length / 7.0;
        }
        for (number, radius) in radii.iter().enumerate() {
            assert_eq!(*radius, sections[number / 7].radius);
        }
        if let Ok(tube) = robot.tube() {
            // Its statements about the curve hold.
            tube.verify(200).unwrap();
            tubes += 1;
        }
    }
    assert!(tubes > 80, "{tubes}");
    let robot = ConstantCurvature::new(&random_sections(&mut random)).unwrap();
    assert_eq!(robot.points(0), robot.points(1));
}

#[test]
fn what_is_no_section_is_named() {
    let good = BendingSection { length: 1.0, radius: 0.1, bend: [0.1, 0.0] };
    let error = |bad: BendingSection| ConstantCurvature::new(&[good, bad]).unwrap_err();
    assert!(matches!(
        ConstantCurvature::new(&[]),
        Err(RobotError::NoSections { parameter: "sections" })
    ));
    assert!(matches!(
        error(BendingSection { length: 0.0, ..good }),
        RobotError::BadLength { index: 1, .. }
    ));
    assert!(matches!(
        error(BendingSection { radius: -1.0, ..good }),
        RobotError::BadRadius { index: 1, .. }
    ));
    let bent = |bend| error(BendingSection { bend, ..good });
    assert!(matches!(bent([f64::NAN, 0.0]), RobotError::BadCurvature { index: 1, .. }));
    assert!(matches!(bent([0.0, f64::INFINITY]), RobotError::BadCurvature { index: 1, .. }));
    assert!(
        ConstantCurvature::new(&[BendingSection { bend: [20.0, 0.0], ..good }])
            .unwrap()
            .tube()
            .is_err()
    );
}
