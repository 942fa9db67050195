//! The text of the kernels, and the constants and records that they share with the host.

use super::robots::BendingQuery;
use super::tree::{LEAF, LEAF_SIZE, MAX_DEPTH};
use super::{bending, bounds};
use gpu_batch::wgsl::constant;
use gpu_batch::{Record, Shader, record};
use parry3d_f64::math::Real;

/// The most links of a link group. A workgroup searches a link group, with a thread for each link.
pub(super) const GROUP_SIZE: u32 = 32;
/// The candidates that a thread has slots for in the first pass. More take a second pass.
pub(super) const SLOTS: u32 = 8;
/// The most candidates of a link that are gathered.
pub(super) const MOST_GATHERED: u32 = 1 << 11;
/// Threads per workgroup of a refit.
pub(super) const REFIT_THREADS: u32 = 64;
/// Threads per workgroup where points are computed.
pub(super) const BENDING_THREADS: u32 = 64;
/// No triangle, and no node.
pub(super) const NOTHING: u32 = u32::MAX;

/// Status of a link group: a link is certainly within the margin. (0 is no answer.)
pub(super) const HIT: u32 = 1;
/// Status: the candidates do not fit into the entries, or into [`MOST_GATHERED`], or two visits
/// counted them differently.
pub(super) const FULL: u32 = 2;
/// Status: the second pass gathers the candidates.
const SECOND: u32 = 3;
/// Status: the driver has stopped a loop.
pub(super) const STOPPED: u32 = 4;
/// Status, plus the number of candidates: all candidates were found.
pub(super) const FOUND: u32 = 5;

/// The question of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::gpu) enum Question {
    PerLink,
    Minimum,
    /// Is the robot farther than this margin?
    Clears(Real),
    /// Which triangles are within this margin of each link?
    Within(Real),
}

/// The kind of [`Question::Within`].
const WITHIN: usize = 3;

impl Question {
    /// The kinds of questions. Each has its own kernels.
    pub(in crate::gpu) const KINDS: usize = 4;

    pub(super) fn kind(self) -> usize {
        match self {
            Self::PerLink => 0,
            Self::Minimum => 1,
            Self::Clears(_) => 2,
            Self::Within(_) => WITHIN,
        }
    }

    pub(super) fn margin(self) -> Option<Real> {
        match self {
            Self::PerLink | Self::Minimum => None,
            Self::Clears(margin) | Self::Within(margin) => Some(margin),
        }
    }

    /// Whether the number of entries is in proportion to the links, not to the link groups.
    pub(super) fn is_about_links(self) -> bool {
        matches!(self, Self::PerLink | Self::Within(_))
    }
}

record! {
    /// The parameters of a search.
    pub(super) struct SearchQuery {
        pub groups: u32,
        /// The margin rounded up, as the bits of an `f32`: a farther triangle is not wanted.
        pub margin_up: u32,
        /// The margin rounded down: a triangle that is certainly within it is a hit.
        pub margin_down: u32,
        /// The most entries that come back.
        pub capacity: u32,
    }
}

record! {
    /// The nodes of a level.
    pub(super) struct RefitLevel {
        pub first: u32,
        pub nodes: u32,
    }
}

macro_rules! text {
    ($file:literal) => {
        include_str!(concat!("../shaders/search/", $file, ".wgsl"))
    };
}

fn constants(values: &[(&str, u32)]) -> String {
    let bounds = bounds::constants();
    values
        .iter()
        .fold(bounds, |text, (name, value)| text + &constant(name, format_args!("{value}u")))
}

fn tree() -> String {
    let sizes = [
        ("LEAF", LEAF),
        ("LEAF_SIZE", LEAF_SIZE as u32),
        ("REFIT_THREADS", REFIT_THREADS),
        ("NOTHING", NOTHING),
    ];
    constants(&sizes) + text!("tree")
}

/// Fills the triangles with the current vertices.
pub(super) fn corners() -> Shader {
    Shader::new("corners", tree() + text!("corners"))
}

/// Fits the boxes of a level.
pub(super) fn refit() -> Shader {
    Shader::new("refit", tree() + &RefitLevel::wgsl() + text!("refit"))
}

/// Computes the points of robots of sections.
pub(super) fn bend() -> Shader {
    let text = constant("BENDING_THREADS", format_args!("{BENDING_THREADS}u"))
        + &bending::constants()
        + &BendingQuery::wgsl()
        + text!("bending");
    Shader::new("bend", text)
}

/// The passes of a kind of question. If `counts_work`, the first pass of a search counts nodes,
/// leaves and links.
pub(in crate::gpu) fn passes(kind: usize, counts_work: bool) -> Vec<Shader> {
    let sizes = [
        ("GROUP_SIZE", GROUP_SIZE),
        ("SLOTS", SLOTS),
        ("MOST_GATHERED", MOST_GATHERED),
        ("DEPTH", MAX_DEPTH + 2),
        ("HIT", HIT),
        ("FULL", FULL),
        ("SECOND", SECOND),
        ("STOPPED", STOPPED),
        ("FOUND", FOUND),
        ("MINIMUM", Question::Minimum.kind() as u32),
        ("CLEARS", Question::Clears(0.0).kind() as u32),
        ("WITHIN", WITHIN as u32),
        ("QUESTION", kind as u32),
    ];
    let values = sizes.iter().map(|(name, value)| constant(name, format_args!("{value}u")));
    let shared = tree()
        + &values.collect::<String>()
        + &constant("COUNTS_WORK", counts_work)
        + &SearchQuery::wgsl()
        + text!("bounds")
        + text!("robots");
    let search = Shader::new("search", shared.clone() + text!("search"));
    let gather = Shader::new("gather", shared + text!("gather"));
    // All triangles within a margin are gathered at once: no bound is to be found first.
    if kind == WITHIN { vec![gather] } else { vec![search, gather] }
}

/// Every kernel, for tests.
#[cfg(feature = "laboratory")]
pub(in crate::gpu) fn all() -> Vec<Shader> {
    let mut all = vec![corners(), refit(), bend()];
    for kind in 0..Question::KINDS {
        all.extend([false, true].into_iter().flat_map(|counts_work| passes(kind, counts_work)));
    }
    all
}

/// The functions of the bounds alone, for tests.
#[cfg(test)]
pub(super) fn text_of_bounds() -> String {
    bounds::constants() + text!("bounds")
}
