//! The pieces of a clearance: the whole tube, each in its body, and coarse where the wall is far.

use continuum_testing::{Arcs, Random};
use parry_continuum::parry::math::{Pose, Rotation, Vector};
use parry_continuum::parry::query::PointQuery;
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{
    BvhSearch, Clearance, Decision, ProximityError, RobotPair, TubePiece,
};
use parry_continuum::{Cap, Tube, TubeSection};
use std::f64::consts::TAU;
use std::sync::Arc;

/// A square wall across z at `height`.
fn wall(height: f64) -> TriMesh {
    let corner = |x: f64, y: f64| Vector::new(x, y, height);
    let corners =
        [corner(-90.0, -90.0), corner(90.0, -90.0), corner(90.0, 90.0), corner(-90.0, 90.0)];
    TriMesh::new(corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]]).unwrap()
}

fn from_function(arcs: &Arc<Arcs>) -> Tube {
    let sections = arcs.stretches.iter();
    let sections: Vec<_> = sections
        .map(|part| TubeSection {
            length: part.length,
            radius: part.radius,
            curvature: part.curvature,
        })
        .collect();
    let curve = Arc::clone(arcs);
    Tube::from_function(&sections, move |s| curve.at(s)).unwrap()
}

/// The tube through samples of each stretch; and of each sample how far along the tube it is, and
/// how far along the curve.
fn from_samples(arcs: &Arcs) -> (Tube, Vec<[f64; 2]>) {
    let (mut points, mut radii, mut places) = (vec![arcs.at(0.0).0], Vec::new(), vec![[0.0; 2]]);
    let (mut along, mut from) = (0.0, 0.0);
    for part in &arcs.stretches {
        let spacing = (arcs.shortest() / 4.0).min(0.2 * part.radius);
        let count = (part.length / spacing).ceil();
        for k in 1..=count as u32 {
            let s = from + part.length * f64::from(k) / count;
            let point = arcs.at(s).0;
            along += (point - points[points.len() - 1]).length();
            points.push(point);
            radii.push(part.radius);
            places.push([along, s]);
        }
        from += part.length;
    }
    (Tube::from_samples(&points, &radii, Some(arcs.end_tangents())).unwrap(), places)
}

/// Asks twice from the start, with pieces and without.
fn ask(
    mesh: &TriMesh,
    tube: &Tube,
    pose: &Pose,
    tolerance: f64,
) -> Result<(Clearance, Vec<TubePiece>), ProximityError> {
    let mut pieces = Vec::new();
    let found = BvhSearch::new(mesh).unwrap().clearance_pieces(tube, pose, tolerance, &mut pieces);
    assert_eq!(found, BvhSearch::new(mesh).unwrap().clearance(tube, pose, tolerance));
    assert!(found.is_ok() || pieces.is_empty());
    Ok((found?, pieces))
}

/// The rims of discs across the centreline, in the mesh's frame.
fn rims(arcs: &Arcs, pose: &Pose, [from, to]: [f64; 2], radius: f64) -> Vec<Vector> {
    let mut points = Vec::new();
    for step in 0..=8 {
        let (centre, tangent) = arcs.at(from + (to - from) * f64::from(step) / 8.0);
        let (across, up) = tangent.any_orthonormal_pair();
        let rim = (0..12).map(|k| f64::sin_cos(TAU * f64::from(k) / 12.0));
        points.extend(rim.map(|(sin, cos)| pose * (centre + (across * cos + up * sin) * radius)));
    }
    points
}

fn length(piece: &TubePiece) -> f64 {
    piece.arc_lengths[1] - piece.arc_lengths[0]
}

#[test]
fn pieces_are_the_whole_tube_and_lie_in_their_bodies() {
    let mut random = Random::new(5);
    let (mut touching, mut flat, mut divided, mut too_fine) = (0, 0, 0, 0);
    for round in 0..60 {
        let arcs = Arc::new(Arcs::random(&mut random, Pose::IDENTITY, 1.0));
        let (sampled, places) = from_samples(&arcs);
        let (pose, mesh) = (random.pose(2.0), wall([0.0, 6.0, 40.0][round % 3]));
        for (way, tube) in [from_function(&arcs), sampled].iter().enumerate() {
            let Ok((found, pieces)) = ask(&mesh, tube, &pose, 0.005) else {
                too_fine += 1;
                continue;
            };
            let mut end = 0.0;
            for piece in &pieces {
                assert_eq!(piece.arc_lengths[0], end, "no gap, no overlap");
                assert!(length(piece) > 0.0);
                end = piece.arc_lengths[1];
            }
            assert_eq!(end, tube.length());
            assert!(pieces.is_sorted_by_key(|piece| piece.section));
            assert_eq!(pieces.last().unwrap().section as usize + 1, arcs.stretches.len());

            for piece in &pieces {
                // Pieces of samples end at samples.
                let on_curve = |arc: f64| match way {
                    0 => arc,
                    _ => places
                        .iter()
                        .min_by(|a, b| (a[0] - arc).abs().total_cmp(&(b[0] - arc).abs()))
                        .unwrap()[1],
                };
                let radius = arcs.stretches[piece.section as usize].radius;
                for point in rims(&arcs, &pose, piece.arc_lengths.map(on_curve), radius) {
                    let out = piece.body.distance_to_local_point(point, true);
                    assert!(out < 1e-12, "{round} {way}: {out} out of {piece:?}");
                    assert!(mesh.distance_to_local_point(point, true) > piece.lower - 1e-12);
                }
                assert!(piece.lower >= found.lower && piece.lower >= 0.0);
                flat += usize::from(piece.body.caps().contains(&Cap::Flat));
            }
            let least = pieces.iter().map(|piece| piece.lower).fold(found.upper, f64::min);
            assert_eq!(least, found.lower);
            touching += usize::from(found.upper == 0.0);
            divided += usize::from(pieces.len() > 10);
        }
    }
    assert!(
        touching > 20 && flat > 100 && divided > 20 && too_fine < 30,
        "{touching} {flat} {divided} {too_fine}"
    );
}

/// An arch under a wall, whose crown is near it and whose feet are not.
#[test]
fn pieces_are_long_where_the_wall_is_far() {
    let (radius, bend, gap) = (0.5, 1.0 / 40.0, 0.5);
    let mut arcs = Arcs::from_frame(Pose::rotation(Vector::Y * -0.9));
    arcs.push(radius, &[(72.0, Vector::Y * bend)]);
    let arcs = Arc::new(arcs);
    let crown = 36.0;
    let top = arcs.at(crown).0;
    let rise = top - arcs.at(0.0).0.midpoint(arcs.at(arcs.length()).0);
    assert!(rise.length() > 10.0);
    let level =
        Pose::from_parts(Vector::ZERO, Rotation::from_rotation_arc(rise.normalize(), Vector::Z));
    let pose = Pose::from_translation(-(level * top)) * level;
    let mesh = wall(radius + gap);

    let tube = from_function(&arcs);
    let mut counts = Vec::new();
    for tolerance in [0.1, 1e-2, 1e-3, 1e-4] {
        let (found, pieces) = ask(&mesh, &tube, &pose, tolerance).unwrap();
        assert!(found.lower <= gap + 1e-12 && gap <= found.upper + 1e-12);
        let at = |arc: f64| pieces.iter().find(|piece| arc <= piece.arc_lengths[1]).unwrap();
        let nearest = at(crown);
        // By k l^2 / 8 the body is within the tolerance of the tube.
        assert!(bend * length(nearest).powi(2) < 16.0 * tolerance, "{tolerance}: {nearest:?}");
        for quarter in [0.25, 0.75] {
            let far = at(quarter * tube.length());
            let away = rims(&arcs, &pose, far.arc_lengths, radius).into_iter();
            let away = away
                .map(|point| mesh.distance_to_local_point(point, true))
                .fold(f64::INFINITY, f64::min);
            assert!(away > 2.0 * gap);
            assert!(
                length(far) > 0.03 / tolerance.sqrt() * length(nearest),
                "{tolerance}: {far:?} {nearest:?}"
            );
        }
        counts.push(pieces.len());
    }
    assert!(counts.is_sorted() && counts[3] < 4 * counts[0], "{counts:?}");
}

/// An arc of radius 1 from the origin along z, and a mesh near it.
fn short_arc(length: f64, curvature: f64) -> Tube {
    let mut arcs = Arcs::from_frame(Pose::IDENTITY);
    arcs.push(1.0, &[(length, Vector::X * curvature)]);
    from_function(&Arc::new(arcs))
}

/// A wall that is parallel to a face meets all of it at once, and the discs behind it a little
/// later.
#[test]
fn pieces_grow_like_the_root_of_the_tolerance_beside_a_face() {
    let mut random = Random::new(8);
    for round in 0..60 {
        let length = [0.15, 0.7, 2.0, 8.0][round % 4] * random.between(0.7, 1.3);
        // It does not come back to the wall.
        let bend = random.between(0.1, 0.9_f64.min(1.5 / length));
        let tube = short_arc(length, bend);
        let gap = [0.3, 1e-3, 2.0][round % 3];
        let corners = [[-1.0, -2.0], [2.0, -2.0], [0.0, 3.0]];
        let corners = corners.map(|[x, y]| Vector::new(x, y, -gap)).to_vec();
        let mesh = TriMesh::new(corners, vec![[0, 1, 2]]).unwrap();
        let counts = [1e-4, 1e-6, 1e-8].map(|tolerance| {
            let (found, pieces) = ask(&mesh, &tube, &Pose::IDENTITY, tolerance).unwrap();
            assert!(found.resolved && found.lower <= gap && gap <= found.upper, "{found:?}");
            pieces.len()
        });
        // The root is 10 from one to the next.
        assert!(
            counts[1] <= 10 * counts[0].max(4) && counts[2] <= 10 * counts[1],
            "{length} {bend}: {counts:?}"
        );
        assert!(counts[2] < 16, "{length} {bend}: {counts:?}");
    }
}

/// Distant parts of any size cost no digits near the robot.
#[test]
fn a_triangle_far_away_does_not_blur_a_near_one() {
    let tube = short_arc(4.0, 0.2);
    let near =
        [Vector::new(3.0, -1.0, 2.0), Vector::new(3.0, 1.0, 2.0), Vector::new(3.0, 0.0, 3.0)];
    let width = |far: f64| {
        let all = near.into_iter().chain(near.map(|corner| corner + Vector::Y * far)).collect();
        let mesh = TriMesh::new(all, vec![[0, 1, 2], [3, 4, 5]]).unwrap();
        let (found, _) = ask(&mesh, &tube, &Pose::IDENTITY, 1e-9).unwrap();
        assert!(found.resolved, "{far}: {found:?}");
        found.upper - found.lower
    };
    assert!([1e3, 1e6, 1e12].iter().all(|&far| width(far) <= 1e-9));
}

/// Beside a mesh that rounding makes a point, nothing is gained by dividing.
#[test]
fn a_tube_of_another_size_is_not_divided_in_vain() {
    let mesh = wall(0.0);
    let (length, bend) = (1e75, 1e-75);
    let mut arcs = Arcs::from_frame(Pose::IDENTITY);
    arcs.push(1e-200, &[(length, Vector::X * bend)]);
    let tube = from_function(&Arc::new(arcs));
    for pose in [Pose::IDENTITY, Pose::from_translation(Vector::Z * -0.3e75)] {
        let (found, pieces) = ask(&mesh, &tube, &pose, 1e-3).unwrap();
        assert!(!found.resolved && pieces.len() < 3_000, "{} {found:?}", pieces.len());
    }
}

/// An arc in the plane z = 0, so that all of it is 4 away from a wall, and from the same arc 6
/// higher. Where the margin is less than that by 3e-10, bodies that stick out by no more would have
/// to be 200,000: sagittas are 15 / n^2 for n of them. Only what the most pieces of a clearance
/// show is said.
#[test]
fn a_margin_at_the_clearance_stays_undecided_in_time() {
    let section = TubeSection { length: 60.0, radius: 1.0, curvature: 1.0 / 30.0 };
    let arc = |s: f64| {
        let (sin, cos) = (s / 30.0).sin_cos();
        (Vector::new(30.0 * sin, 30.0 * (1.0 - cos), 0.0), Vector::new(cos, sin, 0.0))
    };
    let tube = Tube::from_function(&[section], arc).unwrap();
    let mut search = BvhSearch::new(&wall(5.0)).unwrap();
    let higher = Pose::from_translation(Vector::Z * 6.0);
    let decide = |search: &mut BvhSearch, margin: f64, resolution: f64| {
        let beside_wall = search.clears_tube(&tube, &Pose::IDENTITY, margin, resolution).unwrap();
        let mut pair = RobotPair::default();
        let beside_other =
            pair.clears_tubes(&tube, &Pose::IDENTITY, &tube, &higher, margin, resolution).unwrap();
        [beside_wall, beside_other]
    };
    assert_eq!(decide(&mut search, 4.0 - 3e-10, 0.0), [Decision::Undecided; 2]);
    assert!(!decide(&mut search, 4.0, 0.0).contains(&Decision::Clear));
    assert_eq!(decide(&mut search, 4.0 - 1e-3, 0.0), [Decision::Clear; 2]);
    assert_eq!(decide(&mut search, 4.0 + 1e-9, 0.0), [Decision::Contact; 2]);
}
