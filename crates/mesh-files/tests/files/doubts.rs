//! A robot that is in another frame or unit than the mesh is doubted, with the change that helps.

use mesh_files::{Bounds, Change, RadiusDoubt, misfits, radius_doubt};

/// A mesh between these corners.
const MESH: Bounds = Bounds { low: [-60.0, 20.0, 100.0], high: [-20.0, 90.0, 150.0] };

/// A robot inside the mesh.
const LINE: [[f64; 3]; 3] = [[-50.0, 30.0, 110.0], [-45.0, 60.0, 120.0], [-30.0, 80.0, 140.0]];

/// The box of the line, made wrong and then changed.
fn around(wrong: Change, change: Change) -> Option<Bounds> {
    Bounds::of_balls(
        LINE.map(|point| (change.apply(wrong.apply(point)), 1.5 * wrong.scale * change.scale)),
    )
}

#[test]
fn a_robot_that_fits_is_not_doubted() {
    let fits = misfits(|change| around(Change::NONE, change), &MESH, true);
    assert!(fits.doubts.is_empty() && fits.remedy.is_none());
}

#[test]
fn another_frame_or_unit_is_found() {
    for (wrong, turns, remedy) in [
        (1.0, true, 1.0),
        (1e-3, false, 1000.0),
        (1000.0, false, 1e-3),
        (0.1, false, 10.0),
        (10.0, false, 0.1),
        (1e-3, true, 1000.0),
    ] {
        let robot = |change| around(Change { scale: wrong, turns }, change);
        let found = misfits(robot, &MESH, true);
        assert!(!found.doubts.is_empty(), "{wrong} {turns}");
        assert_eq!(found.remedy, Some(Change { scale: remedy, turns }));
        // A stated pose is not turned.
        let stated = misfits(robot, &MESH, false);
        assert_eq!(stated.remedy.is_some(), !turns);
    }
}

#[test]
fn doubts_state_sizes_and_gap() {
    // The robot is 50 above the mesh along z; its box is 20 x 50 x 30, wider by the radius 1.5.
    let above = |change: Change| {
        Bounds::of_balls(LINE.map(|[x, y, z]| (change.apply([x, y, z + 91.5]), 1.5)))
    };
    let doubts = misfits(above, &MESH, false).with_remedy(|_| "no change".into());
    assert_eq!(doubts, ["the robot's box and the mesh's do not overlap; they are 50.000 apart"]);
    let small = |change: Change| around(Change { scale: 1e-3, turns: false }, change);
    let doubts =
        misfits(small, &MESH, false).with_remedy(|change| format!("a scale of {}", change.scale));
    // sqrt(23^2 + 53^2 + 33^2) / 1000 and sqrt(40^2 + 70^2 + 50^2).
    assert_eq!(doubts[0], "the robot's box measures 0.067, the mesh's 94.868");
    assert!(doubts[1].ends_with("apart; with a scale of 1000 they fit"), "{doubts:?}");
}

#[test]
fn points_that_are_not_finite_are_skipped() {
    assert_eq!(Bounds::of_balls([([f64::NAN, 0.0, 0.0], 1.0)]), None);
    let bounds = Bounds::of_balls([([f64::INFINITY, 0.0, 0.0], 1.0), ([1.0, 2.0, 3.0], 1.0)]);
    assert_eq!(bounds, Some(Bounds { low: [0.0, 1.0, 2.0], high: [2.0, 3.0, 4.0] }));
    let nothing = misfits(|_| None, &MESH, true);
    assert!(nothing.doubts.is_empty() && nothing.remedy.is_none());
}

#[test]
fn a_radius_in_another_unit_is_doubted() {
    // The mesh measures 94.868: 9.5 is 1/10 of it, and 0.019 is 1/5000.
    for radius in [0.0, 0.02, 0.5, 9.4] {
        assert_eq!(radius_doubt(radius, &MESH), None);
    }
    for (radius, size, factor) in [
        (500.0, "large", 1e-3),
        (50.0, "large", 1e-2),
        (0.005, "small", 100.0),
        (0.0005, "small", 1e3),
    ] {
        let RadiusDoubt { doubt, factor: found } = radius_doubt(radius, &MESH).unwrap();
        let expected = format!(
            "the radius {radius} is {size} beside the mesh's box, which measures 94.868; check its unit"
        );
        assert_eq!((doubt, found), (expected, factor));
    }
    assert_eq!(radius_doubt(f64::INFINITY, &MESH), None);
}
