//! A robot that is in another frame or unit than the mesh is doubted, with the change that helps.

use crate::mutations::Draws;
use mesh_files::{
    Bounds, Change, RadiusDoubt, margin_doubt, misfits, radius_doubt, scales_radius, sharp_turns,
};

/// A mesh between these corners.
const MESH: Bounds = Bounds { low: [-60.0, 20.0, 100.0], high: [-20.0, 90.0, 150.0] };

/// A robot inside the mesh.
const LINE: [[f64; 3]; 3] = [[-50.0, 30.0, 110.0], [-45.0, 60.0, 120.0], [-30.0, 80.0, 140.0]];

/// The box of the line, made wrong and then changed.
fn around(wrong: Change, change: Change) -> Option<Bounds> {
    Bounds::of_points(LINE.map(|point| change.apply(wrong.apply(point))))
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
    // The robot is 50 above the mesh along z; its box is 20 x 50 x 30.
    let above =
        |change: Change| Bounds::of_points(LINE.map(|[x, y, z]| change.apply([x, y, z + 90.0])));
    let doubts = misfits(above, &MESH, false).with_remedy(|_| "no change".into());
    let expected = "the robot's box and the mesh's do not overlap; they are 50.000 apart; check the robot's pose";
    assert_eq!(doubts, [expected]);
    let small = |change: Change| around(Change { scale: 1e-3, turns: false }, change);
    let doubts =
        misfits(small, &MESH, false).with_remedy(|change| format!("a scale of {}", change.scale));
    // sqrt(20^2 + 50^2 + 30^2) / 1000 and sqrt(40^2 + 70^2 + 50^2).
    assert_eq!(doubts[0], "the robot's box measures 0.062, the mesh's 94.868");
    assert!(doubts[1].ends_with("apart; with a scale of 1000 they fit"), "{doubts:?}");
}

#[test]
fn points_that_are_not_finite_are_skipped() {
    assert_eq!(Bounds::of_points([[f64::NAN, 0.0, 0.0]]), None);
    let bounds = Bounds::of_points([[f64::INFINITY, 0.0, 0.0], [1.0, 2.0, 3.0], [2.0, 0.0, 3.0]]);
    assert_eq!(bounds, Some(Bounds { low: [1.0, 0.0, 3.0], high: [2.0, 2.0, 3.0] }));
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

/// A robot of the mesh's size that lies beside it has a wrong pose. A change of its unit that makes
/// it overlap would hide that.
#[test]
fn a_shift_is_no_matter_of_units() {
    // The mesh contains the origin, so that every shrunken robot overlaps it.
    let mesh = Bounds { low: [0.0; 3], high: [60.0; 3] };
    for (shift, length) in [(60.0, 20.0), (500.0, 50.0), (80.0, 5.0)] {
        let line =
            [[30.0 + shift, 30.0 + shift, 20.0], [30.0 + shift, 30.0 + shift, 20.0 + length]];
        let robot = |change: Change| Bounds::of_points(line.map(|point| change.apply(point)));
        let found = misfits(robot, &mesh, true);
        assert_eq!(found.remedy, None, "{shift} {length}");
        let doubts = found.with_remedy(|_| "no change".into());
        assert!(doubts.len() == 1 && doubts[0].ends_with("; check the robot's pose"), "{doubts:?}");
    }
    // A robot in centimetres, ten times too small, is not shifted.
    let line = [[3.0, 3.0, 8.0], [3.0, 3.0, 9.5]];
    let mesh = Bounds { low: [10.0; 3], high: [100.0; 3] };
    let robot = |change: Change| Bounds::of_points(line.map(|point| change.apply(point)));
    assert_eq!(misfits(robot, &mesh, true).remedy, Some(Change { scale: 10.0, turns: false }));
}

#[test]
fn a_radius_in_the_meshs_unit_is_not_scaled() {
    // In metres: coordinates and radius, then coordinates alone.
    assert!(scales_radius(0.0005, 1000.0, &MESH) && !scales_radius(0.5, 1000.0, &MESH));
    // Usual both ways: it has the unit of the coordinates. Wrong both ways: the nearer one.
    assert!(scales_radius(0.2, 10.0, &MESH) && scales_radius(0.0, 1000.0, &MESH));
    assert!(!scales_radius(50.0, 1000.0, &MESH) && scales_radius(5e-6, 1000.0, &MESH));
}

#[test]
fn huge_numbers_stay_short() {
    let robot =
        |change: Change| Bounds::of_points([[1e300, 0.0, 0.0], [0.0; 3]].map(|p| change.apply(p)));
    let doubts = misfits(robot, &MESH, true).doubts;
    assert!(doubts.iter().all(|doubt| doubt.len() < 120), "{doubts:?}");
    assert!(radius_doubt(1e300, &MESH).unwrap().doubt.len() < 120);
}

#[test]
fn margins_of_another_unit_are_doubted() {
    // The mesh measures 94.868.
    for margin in [0.0, 0.01, 0.5, 2.0, 50.0] {
        assert_eq!(margin_doubt(margin, &MESH), None);
    }
    let expected = "the margin 0.002 is small beside the mesh's box, which measures 94.868; check \
                    its unit";
    assert_eq!(margin_doubt(0.002, &MESH).as_deref(), Some(expected));
}

#[test]
fn points_out_of_order_are_doubted_and_bends_are_not() {
    let mut draws = Draws(23);
    let mut draw = || draws.below(1 << 20) as f64 / f64::from(1 << 20);
    let mut found = [0; 2];
    for round in 0..400 {
        let scale = 2_f64.powi([-300, 0, 300][round % 3]);
        // An arc whose steps turn by at most 80 degrees, about any axis.
        let (turn, count) = (draw() * 1.39, 4 + round % 20);
        let tilt = draw() * std::f64::consts::PI;
        let point = |k: usize| {
            let (sin, cos) = (turn * k as f64).sin_cos();
            [sin, (1.0 - cos) * tilt.cos(), (1.0 - cos) * tilt.sin()].map(|x| x * scale)
        };
        let mut points: Vec<_> = (0..count).map(point).collect();
        assert_eq!(sharp_turns(&points), None, "{round}");
        // A point that is repeated, exactly or within the rounding of single precision.
        let again = points[1].map(|x| if round % 2 == 0 { x } else { f64::from(x as f32) });
        if scale == 1.0 {
            points.insert(2, again);
            assert_eq!(sharp_turns(&points), None, "{round}");
            points.remove(2);
        }
        // One point far away, and the points of two robots.
        let far = points[count / 2].map(|x| x + 10.0 * scale);
        let joined = [&points[..], &points].concat();
        points[count / 2] = far;
        found[0] += usize::from(sharp_turns(&points).is_some());
        // The way back from the end of less than half a turn.
        let is_short = turn * count as f64 <= 3.0;
        found[1] += usize::from(is_short && sharp_turns(&joined).is_some());
        assert!(!is_short || sharp_turns(&joined).is_some(), "{round}");
    }
    assert!(found[0] == 400 && found[1] > 60, "{found:?}");
    let zigzag = [[0.0; 3], [5.0, 0.0, 0.0], [0.0, 1.0, 0.0], [5.0, 2.0, 0.0]];
    let expected = "the robot turns by more than 90 degrees at point 1, and at one other point; \
                    check the order of the points, and whether they are of one robot";
    assert_eq!(sharp_turns(&zigzag).as_deref(), Some(expected));
    // A right angle is none. Points at one place have no direction.
    for points in [
        &[[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]][..],
        &[[0.0; 3]; 4],
        &[],
        &[[0.0; 3], [f64::NAN; 3], [1.0; 3]],
    ] {
        assert_eq!(sharp_turns(points), None);
    }
}
