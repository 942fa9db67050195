//! A flat cap that faces a triangle: the points of the triangle's outline below the cap's disc.
//!
//! Points of the triangle are projected along the normal onto the disc's plane. A corner that lands
//! on the disc counts. So do the two points at which an edge comes below the rim and leaves it.

use super::feature;
use super::link_triangle_points::Meeting;
use super::support_points::{centre, faces_flat, outward};
use parry3d_f64::math::Vector;
use parry3d_f64::shape::PackedFeatureId;

/// Adds the corners and crossings below the flat caps that face along the normal.
pub(super) fn collect(meeting: &mut Meeting) {
    for end in 0..2 {
        if faces_flat(meeting.link, meeting.normal, end) {
            collect_below(meeting, end);
        }
    }
}

fn collect_below(meeting: &mut Meeting, end: usize) {
    let (link, normal) = (meeting.link, meeting.normal);
    let (centre, outward, radius) = (centre(link, end), outward(link, end), link.radius());
    let height = |q: Vector| (q - centre).dot(outward) / normal.dot(outward);
    let on_plane = |q: Vector| q - centre - normal * height(q);
    for (corner, q) in meeting.triangle.into_iter().enumerate() {
        if on_plane(q).length() <= radius {
            let name = PackedFeatureId::vertex(corner as u32);
            meeting.add(centre + on_plane(q), height(q), feature::CAP[end].into(), name);
        }
    }
    for (j, (v, w)) in meeting.edges().into_iter().enumerate() {
        let (from, way) = (on_plane(v), on_plane(w) - on_plane(v));
        let squared = way.length_squared();
        let middle = -from.dot(way) / squared;
        let gap = (from + way * middle).length();
        // Excludes an edge parallel to the normal.
        if squared > 0.0 && gap < radius {
            let half = ((radius - gap) * (radius + gap) / squared).sqrt();
            for (share, name) in
                [middle - half, middle + half].into_iter().zip(feature::RIM_ENDS[end])
            {
                if 0.0 < share && share < 1.0 {
                    let q = v.lerp(w, share);
                    let [name, edge] = [name, j as u32].map(PackedFeatureId::edge);
                    meeting.add(centre + on_plane(q), height(q), name, edge);
                }
            }
        }
    }
}
