//! A batch of robots on the device: the device finds candidates, the CPU measures them.
//!
//! # Definitions
//! - **Part**: up to [`PART`] links of one robot; a workgroup with a thread for each link.
//! - d(t): the distance of triangle t from a link. `lower`, `upper`, e: its bounds on the device
//!   and their error (see the module `bounds`), `lower - e <= d <= max(upper + e, 0)`.
//! - D: an upper bound on the distance that is wanted: `max(upper + e, 0)` of some triangle of the
//!   link (per link) or of the part (minimum), or the margin, rounded up (clears, within). D never
//!   grows.
//! - T: the lowest triangle with `upper + e < 0` so far, of the link or the part; none at first,
//!   and never for a margin. Such a triangle certainly touches.
//! - t is **wanted** if `lower <= D + e` and `t <= T`.
//!
//! # Algorithm
//! 1. **Pack**, on the CPU: the points and radii of a chunk of robots, in the search frame.
//! 2. **First pass**, on the device (`search`): visit the boxes that may hold a wanted triangle,
//!    the nearer child first. A thread keeps the wanted triangles it meets, up to [`ROOM`]. At the
//!    end it keeps only the triangles that are still wanted. For a margin, a triangle with
//!    `upper + e <= margin` settles the robot.
//! 3. **Second pass**, on the device (`gather`): the parts in which a wanted triangle found no room
//!    gather all wanted triangles for the final D and T. For all triangles within a margin this is
//!    the only pass. It counts before it writes; a part whose two counts differ is left to the CPU.
//! 4. **Repeat**: if the candidates of a chunk find too little room, the chunk is searched once
//!    more, with the room that they need.
//! 5. **Measure**, on the CPU: all candidates, in double precision. The best is the answer.
//! 6. **Remainder**, on the CPU: robots that the device cannot represent, whose candidates do not
//!    fit, or whose loops the driver stopped take the search on the CPU. They are counted.
//!
//! Chunks overlap: the CPU packs a chunk and measures the chunk before while the device works.
//!
//! # Claim
//! The answers equal the answers of [`BvhSearch`](crate::proximity::BvhSearch) bit for bit.
//!
//! **Proof.** Let t be the nearest triangle of the link, or of the part with any of its links, at
//! distance d(t); of equals the lowest. It is wanted at all times:
//! 1. `lower(t) - e <= d(t)`, and d(t) is at most each `max(upper + e, 0)`, so `lower(t) <= D + e`.
//! 2. If T is a triangle, it touches. So d(t) = 0, and t is not higher than T.
//!
//! The same holds for every link of the part that has t. It holds in each other part of the robot
//! with a link at the distance d(t) from t: no triangle is nearer to that part, and of equals t is
//! the lowest there. So ties go to the lowest link of all that have t. Boxes are left out only if they hold no
//! wanted triangle: claim 1 of `bounds`. So t is among the candidates, unless it found no room in
//! the first pass; then the part takes the second pass, where t is wanted too. The CPU measures all
//! candidates with the function that measures in every engine. For a margin, every triangle within
//! it is wanted, and a decision is settled early only if a link is certainly within it.

use super::chunk::{COUNTERS, Chunk, ENTRY, HEAD, Layout, TASK_SIZE, chunk_from, room_for};
use super::device::{DeviceTree, SearchKernels};
#[cfg(doc)]
use super::kernels::ROOM;
use super::kernels::{FOUND, FULL, HIT, PART, Question, STOPPED};
use super::robots::Packed;
use crate::answer::ProximityError;
use crate::gpu::opened::Opened;
use crate::mesh::SearchFrame;
use crate::threads::each;
use gpu_batch::{Clock, Device, DeviceFailure, READINGS, Watch};
use std::time::Duration;

/// The least room for entries, for each kind of question: per link if the query answers each link,
/// else per part. The room of a chunk follows what the chunks before needed, and all of it is read
/// back. For a margin, few robots have a candidate.
const LEAST_ROOM: [u64; Question::KINDS] = [4, 16, 1, 32];
/// What the device has found about a robot.
pub(super) struct Found<'a> {
    /// A link is certainly within the margin.
    pub is_hit: bool,
    /// The links and triangles that may be the answer.
    pub candidates: &'a [(u32, u32)],
}

impl Found<'_> {
    /// Whether the robot clears the margin of the question, if that is certain.
    pub(super) fn decision(&self) -> Option<bool> {
        (self.is_hit || self.candidates.is_empty()).then_some(!self.is_hit)
    }
}

/// The mesh as a batch needs it.
#[derive(Clone, Copy)]
pub(super) struct Searched<'a> {
    pub gpu: &'a Opened,
    pub kernels: &'a SearchKernels,
    pub tree: &'a DeviceTree,
    pub frame: &'a SearchFrame,
}

/// Memory of the batches, here and on the device, reused by the next.
pub(super) struct Batches {
    watch: Watch,
    /// Two chunks in turn.
    slots: [Chunk; 2],
    /// The room for entries, for each kind of question: see [`LEAST_ROOM`].
    room: [u64; Question::KINDS],
    /// The robots of the last batch that the device left to the CPU.
    pub left: Vec<usize>,
    /// The time of the kernels of the last batch, if the device keeps time.
    pub device_time: Option<Duration>,
    /// Nodes, leaves and links of the last batch, if the kernels count them.
    pub work: [u64; 3],
}

impl Batches {
    /// `watch` has already reported the failures before the first batch.
    pub(super) fn new(watch: Watch) -> Self {
        Self {
            watch,
            slots: Default::default(),
            room: LEAST_ROOM,
            left: Vec::new(),
            device_time: None,
            work: [0; 3],
        }
    }

    /// Drops the buffers, after a failure or with another tree.
    pub(super) fn forget(&mut self) {
        self.slots = Default::default();
    }

    /// Answers all robots except the robots in [`Batches::left`]. `answer` gets a robot's number
    /// and what was found, and writes the answer. If it returns false, the robot is left to the
    /// CPU.
    ///
    /// # Errors
    /// The device has failed since the last batch, or did not answer.
    pub(super) fn run<A: Send>(
        &mut self,
        searched: Searched,
        robots: impl Packed,
        question: Question,
        out: &mut [Result<A, ProximityError>],
        answer: impl Fn(usize, Found, &mut Result<A, ProximityError>) -> bool + Sync,
    ) -> Result<(), DeviceFailure> {
        let done = self.run_chunks(searched, robots, question, out, answer);
        if done.is_err() {
            self.abandon(&searched.gpu.device);
        }
        done
    }

    /// Waits for the chunks that the device still has. A buffer that vanishes while it is waited
    /// for would be reported as another failure.
    fn abandon(&mut self, device: &Device) {
        let Self { watch, slots, .. } = self;
        for slot in slots {
            if let Some((submitted, readback)) = slot.submitted.take().zip(slot.readback()) {
                // The batch has failed already.
                let _ = device.read(watch, submitted, readback, |_| Ok(()));
            }
        }
    }

    fn run_chunks<A: Send>(
        &mut self,
        searched: Searched,
        robots: impl Packed,
        question: Question,
        out: &mut [Result<A, ProximityError>],
        answer: impl Fn(usize, Found, &mut Result<A, ProximityError>) -> bool + Sync,
    ) -> Result<(), DeviceFailure> {
        self.left.clear();
        self.work = [0; 3];
        self.device_time = searched.gpu.device.tick().map(|_| Duration::ZERO);
        let (mut next, mut turn) = (0, 0);
        let mut pending = None;
        while next < robots.len() {
            let chunk = chunk_from(robots, next);
            next = chunk.end;
            let room = self.room[question.kind()];
            let slot = &mut self.slots[turn];
            slot.submit(searched, robots, chunk, question, room, out, &mut self.watch)?;
            if let Some(before) = pending.replace(turn) {
                self.finish(before, searched, question, out, &answer)?;
            }
            turn = 1 - turn;
        }
        pending.map_or(Ok(()), |last| self.finish(last, searched, question, out, &answer))
    }

    /// Steps 4 and 5, for the chunk in a slot.
    fn finish<A: Send>(
        &mut self,
        slot: usize,
        searched: Searched,
        question: Question,
        out: &mut [Result<A, ProximityError>],
        answer: &(impl Fn(usize, Found, &mut Result<A, ProximityError>) -> bool + Sync),
    ) -> Result<(), DeviceFailure> {
        let Self { watch, slots, room, left, device_time, work } = self;
        let slot = &mut slots[slot];
        let (first, device) = (slot.robots.start, &searched.gpu.device);
        left.extend((first..).zip(&slot.layouts).filter(|(_, layout)| layout.is_left).map(|x| x.0));
        let (room, least) = (&mut room[question.kind()], LEAST_ROOM[question.kind()]);
        let out = &mut out[slot.robots.clone()];
        // With too little room the chunk is searched once more.
        let mut is_last = false;
        while let Some((submitted, readback)) = slot.submitted.take().zip(slot.readback()) {
            let (parts, layouts) = (slot.parts as usize, &slot.layouts);
            let mut is_read = false;
            device.read(watch, submitted, readback, |bytes| {
                let (readings, bytes) = bytes.split_at(READINGS as usize);
                *device_time = device_time
                    .zip(Clock::time_between(device, readings))
                    .map(|(sum, more)| sum + more);
                let (counters, bytes) = bytes.split_at(COUNTERS as usize);
                let mut counters = words(counters).map(u64::from);
                let needed = counters.next().unwrap_or(0);
                *room = next_room(*room, least, needed, slot.items);
                let has_room = needed <= slot.room.into();
                let next = room_for(*room, slot.items, device.largest_binding());
                is_read = is_last || has_room || next <= slot.room;
                if !is_read {
                    return Ok(());
                }
                work.iter_mut().zip(counters).for_each(|(sum, more)| *sum += more);
                let (heads, entries) = bytes.split_at(parts * HEAD as usize);
                let heads = Heads { heads, entries, room: slot.room };
                let shares = out.chunks_mut(TASK_SIZE).zip(layouts.chunks(TASK_SIZE)).enumerate();
                let mut shares: Vec<_> = shares
                    .map(|(share, (out, layouts))| {
                        (first + share * TASK_SIZE, layouts, out, Ok(Vec::new()))
                    })
                    .collect();
                each(&mut shares, |_, (first, layouts, out, left)| {
                    *left = heads.answer(*first, layouts, out, answer);
                });
                for (.., share) in shares {
                    left.extend(share?);
                }
                Ok(())
            })?;
            if !is_read {
                is_last = true;
                slot.search(searched, question, *room, watch)?;
            }
        }
        Ok(())
    }
}

/// The room for entries of each item after a chunk of `items` that needed `needed` entries. The
/// room grows at once and shrinks slowly, because all room of a chunk is read back.
fn next_room(room: u64, least: u64, needed: u64, items: u64) -> u64 {
    let each = (needed + needed / 8).div_ceil(items.max(1));
    each.max(room - room / 8).max(least)
}

/// The words in some bytes of the device.
fn words(bytes: &[u8]) -> impl Iterator<Item = u32> + Clone + '_ {
    bytes.as_chunks::<4>().0.iter().map(|word| u32::from_ne_bytes(*word))
}

/// The pairs of words in some bytes of the device.
fn pairs(bytes: &[u8]) -> impl Iterator<Item = (u32, u32)> + Clone + '_ {
    let word = |pair: &[u8; 8], at| {
        u32::from_ne_bytes([pair[at], pair[at + 1], pair[at + 2], pair[at + 3]])
    };
    bytes.as_chunks::<8>().0.iter().map(move |pair| (word(pair, 0), word(pair, 4)))
}

/// What came back about the parts of a chunk.
#[derive(Clone, Copy)]
struct Heads<'a> {
    heads: &'a [u8],
    entries: &'a [u8],
    /// The number of entries that had room.
    room: u32,
}

impl Heads<'_> {
    /// Answers robots from the number `first` on. Returns the robots that are left to the CPU.
    ///
    /// # Errors
    /// A part was not answered.
    fn answer<A>(
        self,
        first: usize,
        layouts: &[Layout],
        out: &mut [Result<A, ProximityError>],
        answer: &impl Fn(usize, Found, &mut Result<A, ProximityError>) -> bool,
    ) -> Result<Vec<usize>, DeviceFailure> {
        let (mut left, mut candidates) = (Vec::new(), Vec::new());
        for ((number, layout), out) in (first..).zip(layouts).zip(out) {
            if layout.links == 0 {
                continue;
            }
            candidates.clear();
            let (mut is_hit, mut is_left) = (false, false);
            let parts = layout.links.div_ceil(PART) as usize;
            let heads = &self.heads[layout.first_part as usize * HEAD as usize..];
            for ((begin, status), first_link) in
                pairs(heads).take(parts).zip((0..).step_by(PART as usize))
            {
                match status {
                    HIT => is_hit = true,
                    FULL | STOPPED => is_left = true,
                    FOUND.. => {
                        let (begin, count) = (begin as usize, (status - FOUND) as usize);
                        if begin + count > self.room as usize {
                            return Err(DeviceFailure::Unanswered);
                        }
                        let bytes =
                            &self.entries[begin * ENTRY as usize..][..count * ENTRY as usize];
                        candidates.extend(
                            pairs(bytes).map(|(link, triangle)| (first_link + link, triangle)),
                        );
                    }
                    _ => return Err(DeviceFailure::Unanswered),
                }
            }
            let found = Found { is_hit, candidates: &candidates };
            // A hit settles a robot, regardless of its other parts.
            if is_left && !is_hit || !answer(number, found, out) {
                left.push(number);
            }
        }
        Ok(left)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::search::robots::Robots;
    use crate::robot::Chain;
    use continuum_testing::Random;
    use parry3d_f64::math::{Pose, Vector};

    /// What a device returns for a chunk: a head for each part, in any order of their entries. The
    /// candidate of link k of a robot has the number 1000 robot + k, once for each of `each`.
    fn returned(random: &mut Random, chunk: &Chunk, each: &[u32]) -> (Vec<u32>, Vec<u32>) {
        let mut heads = vec![0; 2 * chunk.parts as usize];
        let mut entries = Vec::new();
        let parts = |(robot, layout): (usize, &Layout)| {
            let (first, links) = (layout.first_part, layout.links);
            (0..links.div_ceil(PART)).map(move |part| (robot, first + part, part * PART, links))
        };
        let mut all: Vec<_> = chunk.robots.clone().zip(&chunk.layouts).flat_map(parts).collect();
        for place in (1..all.len()).rev() {
            all.swap(place, random.below(place as u32 + 1) as usize);
        }
        for (robot, part, first_link, links) in all {
            let lanes = (links - first_link).min(PART);
            let begin = entries.len() as u32 / 2;
            for lane in (0..lanes).rev() {
                for _ in 0..each[robot] {
                    entries.extend([lane, 1000 * robot as u32 + first_link + lane]);
                }
            }
            heads[2 * part as usize] = begin;
            heads[2 * part as usize + 1] = FOUND + entries.len() as u32 / 2 - begin;
        }
        (heads, entries)
    }

    fn bytes(words: &[u32]) -> Vec<u8> {
        words.iter().flat_map(|word| word.to_ne_bytes()).collect()
    }

    fn chains(links: &[usize]) -> Vec<Chain> {
        let chain = |&links: &usize| {
            let points: Vec<_> = (0..=links).map(|k| Vector::Z * k as f64).collect();
            Chain::capsules(&points, &vec![0.25; links]).unwrap()
        };
        links.iter().map(chain).collect()
    }

    /// Each robot gets the candidates of all of its parts, with the numbers of its links.
    #[test]
    fn candidates_come_back_to_their_robots_and_links() {
        let random = &mut Random::new(43);
        let (mut several_parts, mut hits, mut left_over) = (0, 0, 0);
        for _ in 0..100 {
            let count = 1 + random.below(6) as usize;
            let links: Vec<_> = (0..count)
                .map(|_| [1, 5, 31, 32, 33, 64, 65, 100][random.below(8) as usize])
                .collect();
            let chains = chains(&links);
            let robots: Vec<_> = chains.iter().map(|chain| (chain, Pose::IDENTITY)).collect();
            let first = random.below(count as u32) as usize;
            let robots = Robots::Batch(&robots);
            let mut chunk = Chunk::default();
            chunk.lay_out(robots, first..count);
            let needed: usize = links[first..].iter().map(|links| links.div_ceil(32)).sum();
            assert_eq!(chunk.parts as usize, needed);
            let each: Vec<_> = (0..count).map(|_| random.below(3)).collect();
            let (mut heads, entries) = returned(random, &chunk, &each);
            // Some parts are hit, or have no room.
            let mut status = vec![0; count];
            for (robot, layout) in (first..).zip(&chunk.layouts) {
                let parts = layout.links.div_ceil(PART);
                several_parts += usize::from(parts > 1);
                if random.below(3) == 0 {
                    status[robot] = [HIT, FULL, STOPPED][random.below(3) as usize];
                    let part = layout.first_part + random.below(parts);
                    heads[2 * part as usize + 1] = status[robot];
                }
            }
            let room = entries.len() as u32 / 2;
            let (heads, entries) = (bytes(&heads), bytes(&entries));
            let answers = Heads { heads: &heads, entries: &entries, room };
            let mut out = vec![Ok(Vec::new()); count - first];
            let answer = |robot: usize, found: Found, out: &mut Result<_, _>| {
                let mut all: Vec<_> = found.candidates.to_vec();
                all.sort_unstable();
                assert_eq!(found.is_hit, status[robot] == HIT);
                *out = Ok(all);
                true
            };
            let left = answers.answer(first, &chunk.layouts, &mut out, &answer).unwrap();
            let expected: Vec<_> =
                (first..count).filter(|&robot| [FULL, STOPPED].contains(&status[robot])).collect();
            assert_eq!(left, expected);
            left_over += left.len();
            hits += status.iter().filter(|&&status| status == HIT).count();
            for (robot, found) in (first..).zip(out) {
                if status[robot] != 0 {
                    continue;
                }
                let links = 0..links[robot] as u32;
                let expected: Vec<_> = links
                    .flat_map(|link| {
                        let entry = (link, 1000 * robot as u32 + link);
                        std::iter::repeat_n(entry, each[robot] as usize)
                    })
                    .collect();
                assert_eq!(found.unwrap(), expected, "{robot}");
            }
        }
        assert!(several_parts > 50 && hits > 10 && left_over > 20, "{several_parts} {hits}");
    }

    /// An entry beyond the room, and a part without an answer, fail the batch.
    #[test]
    fn what_did_not_come_back_is_no_answer() {
        let chains = chains(&[40]);
        let robots = [(&chains[0], Pose::IDENTITY)];
        let mut chunk = Chunk::default();
        chunk.lay_out(Robots::Batch(&robots), 0..1);
        let entries = bytes(&[0, 7, 1, 8]);
        for (heads, is_answered) in [
            ([0, FOUND + 2, 0, FOUND], true),
            ([0, FOUND + 1, 1, FOUND + 1], true),
            ([0, FOUND + 1, 1, FOUND + 2], false),
            ([2, FOUND + 1, 0, FOUND], false),
            ([0, FOUND + 2, 0, 0], false),
        ] {
            let heads = bytes(&heads);
            let heads = Heads { heads: &heads, entries: &entries, room: 2 };
            let mut out = [Ok(0)];
            let found = heads.answer(0, &chunk.layouts, &mut out, &|_, _, _| true);
            assert_eq!(found.is_ok(), is_answered);
        }
    }

    /// A chunk whose candidates find too little room is searched at most once more. Then all find
    /// room, unless the largest buffer is too small for them.
    #[test]
    fn a_second_search_has_room() {
        let random = &mut Random::new(47);
        let (mut once, mut again, mut too_many) = (0, 0, 0);
        for _ in 0..2000 {
            let items = 1 + u64::from(random.below(100_000));
            let needed = items * u64::from(random.below(200)) / (1 + u64::from(random.below(20)));
            let largest = 1 << (16 + random.below(14));
            let mut each = 4 + u64::from(random.below(40));
            let first = room_for(each, items, largest);
            each = next_room(each, 4, needed, items);
            let second = room_for(each, items, largest);
            if needed <= first.into() {
                once += 1;
            } else if second <= first {
                assert_eq!(u64::from(first), largest / ENTRY);
                too_many += 1;
            } else {
                assert!(needed <= second.into() || u64::from(second) == largest / ENTRY);
                again += 1;
            }
        }
        assert!(once > 200 && again > 200 && too_many > 200, "{once} {again} {too_many}");
    }

    #[test]
    fn the_room_grows_at_once_and_shrinks_slowly() {
        for (needed, items) in [(0, 1), (400, 100), (1000, 100), (102_400, 100)] {
            let room = next_room(4, 4, needed, items);
            assert!(room >= 4 && room * items >= needed, "{needed}: {room}");
        }
        let mut room = next_room(4, 4, 102_400, 100);
        let after = next_room(room, 4, 100, 100);
        assert!(room / 2 < after && after < room, "{room} {after}");
        for _ in 0..100 {
            room = next_room(room, 4, 100, 100);
        }
        assert!(room < 8, "{room}");
    }
}
