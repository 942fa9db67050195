//! Algorithm 1 of the paper (section III.F): which link ends are round.
//!
//! A round cap fills the wedge that opens between two links where the centreline bends. A round cap
//! also reaches one radius along the tube. It must not stick out of a *face*: a flat end that the
//! tube really has.
//!
//! # Definitions
//! - Faces: the two ends of the robot, and each place where a thicker tube begins.
//! - `limit`: the last face that the walk has passed.
//! - `radius`: the radius of the link whose end is decided.
//!
//! # Algorithm
//! One walk along the centreline decides the start cap of each link:
//!
//! 1. **First link**: flat. Its start becomes `limit`.
//! 2. **Link thicker than the one before**: flat. Its start becomes `limit`.
//! 3. **Room for a ball**: any other start with `|start - limit| >= radius` is round.
//! 4. **Too near**: any other start is flat.
//!
//! A second walk, from tip to base, decides the end caps by the same cases.
//!
//! # Choices
//! - **No division.** The paper divides by the radius; 0 / 0 leaves the cap of a wire undecided.
//!   We compare lengths on the chord from `limit` to the joint. A distance equal to the radius is
//!   round.
//! - **Radius per segment.** The paper gives a radius to each vertex. [`from_segment_radii`] uses
//!   the radius of the link whose end is decided, because a radius belongs to a tube.
//!   [`from_vertex_radii`] is the rule as printed.
//! - **Equal radii.** Radii that differ by rounding alone are equal ([`RadiusSteps`]). Otherwise
//!   every second segment of a rod simulator, thicker by one bit, would begin with a face.
//!
//! # Limits
//! - A thick tube shorter than two radii keeps flat caps throughout. Wedges stay open at its bends.
//! - If each link takes the smaller radius of its two vertices, both functions agree, with two
//!   exceptions. (No other choice of link radii is right for both steps up and steps down.)
//!   1. After a thick tube shorter than its radius, the printed rule compares the thin tube's first
//!      joint with the thick radius and leaves a wedge open.
//!   2. A single thick vertex belongs to no tube. The printed rule makes both its sides flat.

use super::Cap;
use super::compare::at_least_apart;
use super::modified_cylinder::has_direction;
use super::radius_steps::RadiusSteps;
use parry3d_f64::math::{Real, Vector};

/// Writes the caps of each segment to `caps`, whose memory is reused.
///
/// Takes one radius per segment: `points.len() == radii.len() + 1`. A segment without length is no
/// link of the robot: it makes no step, and its own caps are flat.
pub(super) fn from_segment_radii(points: &[Vector], radii: &[Real], caps: &mut Vec<[Cap; 2]>) {
    let is_link = |k: usize| has_direction(points[k], points[k + 1], radii[k]);
    from_radii(points, radii, caps, is_link);
}

/// As [`from_segment_radii`], for segments that are all links. While a robot moves, a link may have
/// no length at one instant.
#[cfg(feature = "tubes")]
pub(crate) fn from_link_radii(points: &[Vector], radii: &[Real], caps: &mut Vec<[Cap; 2]>) {
    from_radii(points, radii, caps, |_| true);
}

fn from_radii(
    points: &[Vector],
    radii: &[Real],
    caps: &mut Vec<[Cap; 2]>,
    is_link: impl Fn(usize) -> bool,
) {
    reset(caps, radii.len());
    let links = || (0..radii.len()).filter(|&k| is_link(k));
    let starts = links().map(|k| (&points[k], &radii[k]));
    let ends = links().rev().map(|k| (&points[k + 1], &radii[k]));
    walk(starts).zip(links()).for_each(|(cap, k)| caps[k][0] = cap);
    walk(ends).zip(links().rev()).for_each(|(cap, k)| caps[k][1] = cap);
}

/// As [`from_segment_radii`], with one radius per vertex: `points.len() == radii.len()`.
pub(super) fn from_vertex_radii(points: &[Vector], radii: &[Real], caps: &mut Vec<[Cap; 2]>) {
    reset(caps, radii.len().saturating_sub(1));
    let vertices = points.iter().zip(radii);
    // Link k begins at vertex k and ends at vertex k + 1.
    walk(vertices.clone()).zip(caps.iter_mut()).for_each(|(cap, caps)| caps[0] = cap);
    walk(vertices.rev()).zip(caps.iter_mut().rev()).for_each(|(cap, caps)| caps[1] = cap);
}

fn reset(caps: &mut Vec<[Cap; 2]>, links: usize) {
    caps.clear();
    caps.resize(links, [Cap::Flat; 2]);
}

/// Yields, for each vertex in walking order, the cap of the link end that faces back to `limit`.
fn walk<'a>(vertices: impl Iterator<Item = (&'a Vector, &'a Real)>) -> impl Iterator<Item = Cap> {
    let (mut limit, mut steps) = (None::<Vector>, RadiusSteps::default());
    vertices.map(move |(&point, &radius)| {
        let is_up = steps.is_up(radius);
        match limit {
            // Case 3.
            Some(limit) if !is_up && at_least_apart(limit, point, radius) => Cap::Round,
            // Case 4.
            Some(_) if !is_up => Cap::Flat,
            // Cases 1 and 2.
            _ => {
                limit = Some(point);
                Cap::Flat
            }
        }
    })
}
