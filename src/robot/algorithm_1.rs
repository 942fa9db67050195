//! Algorithm 1 of the paper (section III.F): which link ends are round.
//!
//! A round end fills the wedge that opens between two links where the centreline bends. But it also
//! reaches one radius along the tube, and must not stick out of a face that the tube really has:
//! its two ends, and each place where a thicker tube begins. So one walk goes along the centreline
//! with the last such face as its *limit*, and decides how each link begins:
//!
//! 1. **The first link** begins with a face, the first limit.
//! 2. **A thicker link** than the one before begins with a face too, which becomes the limit.
//! 3. **Room for a ball**: any other link begins round if its start is at least one radius away
//!    from the limit,
//! 4. **Too near**: and flat if it is not.
//!
//! A second walk comes back from the tip and treats the links' other ends in the same way.
//!
//! The test is on the chord between limit and joint, as printed, without the paper's division: 0/0
//! at radius 0 would leave the cap of a wire undecided. Equal radii may be round. A thick tube
//! shorter than two radii keeps flat ends all along, with open wedges where it bends: that is a
//! limit of the algorithm.
//!
//! Printed, the radius belongs to a vertex. [`from_segment_radii`] lets a vertex take the radius of
//! the link whose end is being decided, which is meant: a radius belongs to a tube.
//! [`from_vertex_radii`] is the rule as printed. With each link's radius the smaller of its two
//! vertices' (the only choice that makes both steps up and steps down come out right) the two
//! agree, except after a thick tube shorter than its radius (the printed rule compares the thin
//! tube's first joint with the thick radius, and leaves a gap) and around a lone thick vertex,
//! which belongs to no tube and which the printed rule makes flat on both sides.
//!
//! Radii that are equal but for rounding are equal here (`radius_steps`): of a rod simulator's
//! every second segment is thicker by its last bit, and would begin with a face.

use super::Cap;
use super::compare::at_least_apart;
use super::radius_steps::RadiusSteps;
use parry3d_f64::math::{Real, Vector};

/// Writes the caps of each link to `caps`, whose memory is used again; one point more than radii.
pub(super) fn from_segment_radii(points: &[Vector], radii: &[Real], caps: &mut Vec<[Cap; 2]>) {
    reset(caps, radii.len());
    let starts = points.iter().zip(radii);
    let ends = points.iter().skip(1).zip(radii).rev();
    walk(starts).zip(caps.iter_mut()).for_each(|(cap, caps)| caps[0] = cap);
    walk(ends).zip(caps.iter_mut().rev()).for_each(|(cap, caps)| caps[1] = cap);
}

/// As [`from_segment_radii`], from the vertices' radii; as many points as radii.
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

/// One walk: whether the link end at each vertex, facing back the way we came, is round.
fn walk<'a>(vertices: impl Iterator<Item = (&'a Vector, &'a Real)>) -> impl Iterator<Item = Cap> {
    let (mut limit, mut steps) = (None::<Vector>, RadiusSteps::default());
    vertices.map(move |(&point, &radius)| {
        let is_up = steps.is_up(radius);
        match limit {
            Some(limit) if !is_up && at_least_apart(limit, point, radius) => Cap::Round,
            Some(_) if !is_up => Cap::Flat,
            _ => {
                limit = Some(point);
                Cap::Flat
            }
        }
    })
}
