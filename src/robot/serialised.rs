//! Links and chains as data (feature `serde-serialize`).
//!
//! The data are the arguments of the constructors. Reading calls the constructors, so an invalid
//! link or chain is an error with their message.

use super::chain::check_chain;
use super::{Cap, Chain, ModifiedCylinder};
use parry3d_f64::math::{Real, Vector};
use serde::{Deserialize, Serialize};

/// A link: `{"start": [x, y, z], "end": [x, y, z], "radius": r, "caps": ["Flat", "Round"]}`.
#[derive(Serialize, Deserialize)]
pub(super) struct Link {
    start: [Real; 3],
    end: [Real; 3],
    radius: Real,
    caps: [Cap; 2],
}

impl From<ModifiedCylinder> for Link {
    fn from(link: ModifiedCylinder) -> Self {
        let (start, end) = (link.start().to_array(), link.end().to_array());
        Self { start, end, radius: link.radius(), caps: link.caps() }
    }
}

impl TryFrom<Link> for ModifiedCylinder {
    type Error = String;

    fn try_from(link: Link) -> Result<Self, String> {
        let (start, end) = (Vector::from_array(link.start), Vector::from_array(link.end));
        Self::new(start, end, link.radius, link.caps).map_err(|error| error.to_string())
    }
}

/// A chain: the points of its joints; per link the radius, the caps and the number of input
/// segments.
#[derive(Serialize, Deserialize)]
pub(super) struct Links {
    points: Vec<[Real; 3]>,
    radii: Vec<Real>,
    caps: Vec<[Cap; 2]>,
    segments: Vec<usize>,
    /// The number of the first link's segments before the one that has a length.
    #[serde(default)]
    leading: usize,
}

impl From<Chain> for Links {
    fn from(chain: Chain) -> Self {
        let links = chain.links();
        let first = links.iter().take(1).map(ModifiedCylinder::start);
        Self {
            points: first
                .chain(links.iter().map(ModifiedCylinder::end))
                .map(|p| p.to_array())
                .collect(),
            radii: links.iter().map(ModifiedCylinder::radius).collect(),
            caps: links.iter().map(ModifiedCylinder::caps).collect(),
            segments: (0..links.len()).map(|link| chain.segments_of(link).len()).collect(),
            leading: chain.segment_of(0),
        }
    }
}

impl TryFrom<Links> for Chain {
    type Error = String;

    fn try_from(data: Links) -> Result<Self, String> {
        let points: Vec<_> = data.points.into_iter().map(Vector::from_array).collect();
        check_chain(["points", "radii"], &points, &data.radii, points.len().saturating_sub(1))
            .map_err(|error| error.to_string())?;
        let count = data.radii.len();
        if data.caps.len() != count || data.segments.len() != count {
            let (caps, segments) = (data.caps.len(), data.segments.len());
            return Err(format!(
                "{count} links need as many caps and segments, got {caps} and {segments}"
            ));
        }
        let (mut links, mut segments, mut from) = (Vec::new(), Vec::new(), 0usize);
        for (index, ends) in points.windows(2).enumerate() {
            let [start, end] = [ends[0], ends[1]];
            if start == end {
                return Err(format!("link {index} has length 0; a chain has no such link"));
            }
            let link = ModifiedCylinder::new(start, end, data.radii[index], data.caps[index]);
            links.push(link.map_err(|error| format!("link {index}: {error}"))?);
            let to = from.checked_add(data.segments[index]).filter(|to| *to > from);
            let to =
                to.ok_or(format!("link {index} stands for {} segments", data.segments[index]))?;
            segments.push(from..to);
            from = to;
        }
        if segments.first().is_none_or(|first| data.leading >= first.end) {
            return Err(format!("{} segments come before the one that is link 0", data.leading));
        }
        Ok(Self::of(links, segments, data.leading))
    }
}
