//! The outline of a link in a picture.

use crate::lettering::Stroke;
use crate::picture::Camera;
use parry_continuum::parry::math::{Pose, Real};
use parry_continuum::{Cap, ModifiedCylinder};
use std::f64::consts::TAU;

/// How many points stand for a circle.
const POINTS: u32 = 48;

/// The outline of a link in a camera's picture, as a closed line in pixels: the hull of the rims of
/// its flat ends and of the circles of its balls.
pub fn outline(link: &ModifiedCylinder, pose: &Pose, camera: &Camera, size: [usize; 2]) -> Stroke {
    let mut places = Vec::new();
    for (end, cap) in [link.start(), link.end()].into_iter().zip(link.caps()) {
        let centre = pose * end;
        let across = match cap {
            Cap::Flat => pose.rotation * link.axis(),
            Cap::Round => (centre - camera.eye).normalize(),
        };
        let (x, y) = across.any_orthonormal_pair();
        places.extend((0..POINTS).map(|k| {
            let (sin, cos) = (TAU * Real::from(k) / Real::from(POINTS)).sin_cos();
            camera.place(centre + (x * cos + y * sin) * link.radius(), size)
        }));
    }
    let mut hull = hull(places);
    hull.extend(hull.first().copied());
    hull
}

/// The corners of the convex hull of points, in order, by Andrew's monotone chain.
fn hull(mut points: Vec<[f32; 2]>) -> Stroke {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let mut corners: Stroke = Vec::new();
    let there = points.iter().copied();
    for half in [&mut there.clone() as &mut dyn Iterator<Item = [f32; 2]>, &mut there.rev()] {
        let first = corners.len();
        for point in half {
            while let [.., a, b] = corners[first..] {
                let turn = (b[0] - a[0]) * (point[1] - a[1]) - (b[1] - a[1]) * (point[0] - a[0]);
                if turn > 0.0 {
                    break;
                }
                corners.pop();
            }
            corners.push(point);
        }
        corners.pop();
    }
    corners
}

#[cfg(test)]
mod tests {
    use super::*;
    use parry_continuum::parry::math::Vector;

    /// Points of the link's surface are within the outline, and some on it.
    #[test]
    fn an_outline_holds_what_the_camera_sees_of_a_link() {
        let pose = Pose::new(Vector::new(0.3, -0.2, 0.1), Vector::new(0.4, 0.9, -0.3));
        let [start, end] = [Vector::new(-3.0, 0.5, 1.0), Vector::new(2.0, -1.0, 0.0)];
        let link = ModifiedCylinder::new(start, end, 0.8, [Cap::Flat, Cap::Round]).unwrap();
        let camera = Camera::framing(
            &[Vector::splat(-9.0), Vector::splat(9.0)],
            Vector::new(1.0, 2.0, -0.5),
            Vector::Z,
            1.0,
            0.0,
        );
        let size = [600, 600];
        let outline = outline(&link, &pose, &camera, size);
        assert_eq!(outline.first(), outline.last());
        let (vertices, _) = link.to_trimesh(40);
        let mut least = f32::INFINITY;
        for vertex in vertices {
            let p = camera.place(pose * vertex, size);
            for side in outline.windows(2) {
                let [along, to] = [side[1], p].map(|q| [q[0] - side[0][0], q[1] - side[0][1]]);
                let inward = (along[0] * to[1] - along[1] * to[0]) / along[0].hypot(along[1]);
                // A ball seen in perspective is a little more than its circle.
                assert!(inward > -0.5, "{p:?} is {inward} within {side:?}");
                least = least.min(inward);
            }
        }
        assert!(least < 0.5 && outline.len() > 40, "{least} {}", outline.len());
    }
}
