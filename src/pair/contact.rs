//! The contact of an answer: its normal, features and place on the robot.

use super::answer_subject::{corners, placed_link, transformed_link};
use super::contact_batch::{PlacedPair, try_add_contacts};
use super::nearest::Nearest;
use super::nearest_features::{Measured, NearPair, NearestFeatures};
use super::placed_link::PlacedLink;
use crate::answer::{Contact, ContactFeature, LinkProximity, ProximityError, Witness};
use crate::mesh::Mesh;
use crate::robot::{Chain, length};
use fearless_simd::Level;
use parry3d_f64::math::{Pose, Real, Vector};

/// Returns the contact of an answer about this mesh.
///
/// # Errors
/// As [`Proximity::contact`](crate::proximity::Proximity::contact).
pub(crate) fn contact(
    mesh: &Mesh,
    robot: &Chain,
    pose: &Pose,
    answer: &LinkProximity,
) -> Result<Contact, ProximityError> {
    let (link, corners, measured) = near(mesh, robot, pose, answer)?;
    let (length, before) = (length(link.along()), robot.length_before(answer.link as usize));
    let found = measured.features(|| NearPair::exactly(&link, corners));
    Ok(contact_of(answer, length, before, &found))
}

/// Replaces `out` by the contacts of answers about this mesh.
///
/// # Errors
/// As [`Proximity::contacts`](crate::proximity::Proximity::contacts). Then `out` is empty.
pub(crate) fn contacts(
    mesh: &Mesh,
    robot: &Chain,
    pose: &Pose,
    answers: &[LinkProximity],
    out: &mut Vec<Contact>,
) -> Result<(), ProximityError> {
    out.clear();
    let place = |answer: &LinkProximity| {
        let link = transformed_link(answer, robot, pose)?;
        let corners = corners(mesh.vertices(), mesh.indices(), answer.witness.triangle as usize)?;
        let before = robot.length_before(answer.link as usize);
        let ends = [link.start(), link.end()];
        Ok(PlacedPair { ends, radius: link.radius(), flat: link.flat(), corners, before })
    };
    let check = |answer: &LinkProximity, place: &PlacedPair, measured: &Nearest| {
        answer.check_answer_of(measured, || place.link(), place.corners)
    };
    try_add_contacts(Level::new(), answers, place, check, out).inspect_err(|_| out.clear())
}

/// Returns the link and the triangle's vertices of an answer that fits them, and both measured.
///
/// # Errors
/// One of them does not exist, the pose is not finite or moves the link out of range, or the answer
/// does not fit.
pub(crate) fn near(
    mesh: &Mesh,
    robot: &Chain,
    pose: &Pose,
    answer: &LinkProximity,
) -> Result<(PlacedLink, [Vector; 3], Measured), ProximityError> {
    let link = placed_link(answer, robot, pose)?;
    let corners = corners(mesh.vertices(), mesh.indices(), answer.witness.triangle as usize)?;
    let measured = Measured::new(&link, corners);
    answer.check_answer_of(&measured.nearest(&link, answer.witness.triangle), || link, corners)?;
    Ok((link, corners, measured))
}

/// Returns the contact of an answer about a link of this length. `before` is the length of the
/// links before it.
pub(crate) fn contact_of(
    answer: &LinkProximity,
    length: Real,
    before: Real,
    found: &NearestFeatures,
) -> Contact {
    let LinkProximity { link, distance, witness } = *answer;
    Contact {
        link,
        fraction: found.fraction,
        feature: ContactFeature { link: found.link, triangle: found.triangle },
        distance,
        depth: if distance > 0.0 { distance } else { found.depth.min(0.0) },
        normal: found.normal,
        witness: Witness { arc_length: before + found.fraction * length, ..witness },
        lever: found.lever,
        kink: found.kink,
    }
}
