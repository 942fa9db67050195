//! The layout of a chunk of robots: which link groups, points and radii each robot has, and where
//! they begin in the device's memory.

use super::kernels::{GROUP_SIZE, MOST_GATHERED};
use super::robots::{BendingQuery, Packed};
use crate::threads::each;
use std::ops::Range;

/// Robots that one task of the CPU takes.
pub(super) const TASK_SIZE: usize = 64;
/// Bytes of a link group.
pub(super) const GROUP_BYTES: u64 = 16;
/// The most links of a robot on the device.
const MOST_LINKS: usize = 1 << 20;
/// The number of candidates of a chunk fits into a `u32`, which counts them on the device.
const _: () = assert!(MOST_LINKS as u64 * (MOST_GATHERED as u64) < 1 << 32);

/// The layout of a chunk. Its memory is reused by a later chunk.
#[derive(Default)]
pub(super) struct ChunkLayout {
    /// The robots of the batch.
    pub robots: Range<usize>,
    /// The layout of each robot of the chunk.
    pub layouts: Vec<RobotLayout>,
    /// How many link groups all robots have.
    pub groups: u32,
    /// How many links all robots have.
    pub links: u64,
    /// How many `f32` all points take.
    pub points_size: u32,
    /// How many `f32` all radii and caps take.
    pub radii_size: u32,
    /// How the device computes the points, unless they are uploaded.
    pub bending: Option<BendingQuery>,
}

/// The layout of a robot in a chunk.
#[derive(Clone, Copy, Default)]
pub(super) struct RobotLayout {
    pub first_group: u32,
    /// The number of links, or 0 if the device does not search for the robot.
    pub links: u32,
    pub is_for_cpu: bool,
    /// The index of the first `f32` of its points, among the numbers of the chunk.
    points_at: u32,
    /// The index of the first `f32` of its radii and caps.
    radii_at: u32,
    /// Whether it uses the radii and caps of the robot before.
    shares_radii: bool,
}

/// The robots of the chunk that begins at `first`.
pub(super) fn chunk_from<R: Packed>(robots: R, first: usize) -> Range<usize> {
    const { assert!(R::CHUNK * GROUP_SIZE as usize <= MOST_LINKS) };
    let (mut end, mut groups) = (first, 0);
    while end < robots.len() {
        groups += robots.links(end).div_ceil(GROUP_SIZE as usize);
        if groups > R::CHUNK && end > first {
            break;
        }
        end += 1;
    }
    first..end
}

impl ChunkLayout {
    /// Lays out the robots of a chunk. All points come first, then all radii and caps.
    pub(super) fn lay_out(&mut self, robots: impl Packed, chunk: Range<usize>) {
        let first = chunk.start;
        self.layouts.clear();
        self.layouts.resize(chunk.len(), RobotLayout::default());
        let mut shares: Vec<_> = self.layouts.chunks_mut(TASK_SIZE).collect();
        each(&mut shares, |share, layouts| {
            for (robot, layout) in (first + share * TASK_SIZE..).zip(layouts.iter_mut()) {
                let links = robots.links(robot);
                layout.is_for_cpu = links > MOST_LINKS;
                layout.links = if layout.is_for_cpu { 0 } else { links as u32 };
                layout.shares_radii = robot > first && robots.is_like_before(robot);
            }
        });
        (self.groups, self.points_size, self.links) = (0, 0, 0);
        for layout in &mut self.layouts {
            (layout.points_at, layout.first_group) = (self.points_size, self.groups);
            self.points_size += layout.points_size();
            self.groups += layout.groups();
            self.links += u64::from(layout.links);
        }
        self.radii_size = 0;
        let mut last_radii_at = self.points_size;
        for layout in &mut self.layouts {
            if !layout.shares_radii {
                last_radii_at = self.points_size + self.radii_size;
            }
            self.radii_size += layout.radii_size();
            layout.radii_at = last_radii_at;
        }
        self.bending = robots.bending(chunk.len());
        self.robots = chunk;
    }

    /// How many link groups or links share the entries of a chunk.
    pub(super) fn items(&self, is_about_links: bool) -> u64 {
        if is_about_links { self.links } else { self.groups.into() }
    }
}

impl RobotLayout {
    pub(super) fn groups(&self) -> u32 {
        self.links.div_ceil(GROUP_SIZE)
    }

    /// How many `f32` its points take.
    fn points_size(&self) -> u32 {
        if self.links == 0 { 0 } else { 3 * (self.links + 1) }
    }

    /// How many `f32` its radii and caps take; 0 if it uses the radii and caps of the
    /// robot before.
    pub(super) fn radii_size(&self) -> u32 {
        if self.shares_radii { 0 } else { 2 * self.links }
    }

    pub(super) fn groups_bytes(&self) -> usize {
        GROUP_BYTES as usize * self.groups() as usize
    }

    /// Writes the link groups of the robot: the indices of points and radii, the number of links,
    /// and the error of the points. A group without links has no candidates.
    pub(super) fn write_groups(&self, more_error: f32, bytes: &mut [u8]) {
        let groups = bytes.chunks_exact_mut(GROUP_BYTES as usize);
        for (group, first_link) in groups.zip((0..).step_by(GROUP_SIZE as usize)) {
            let links = self.links.saturating_sub(first_link).min(GROUP_SIZE);
            let points_at = self.points_at + 3 * first_link;
            let radii_at = self.radii_at + 2 * first_link;
            let words = [points_at, radii_at, links, more_error.to_bits()];
            group.copy_from_slice(words.map(u32::to_ne_bytes).as_flattened());
        }
    }
}
