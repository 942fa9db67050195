//! A batch of robots on the device: the device finds candidates, the CPU measures them.
//!
//! # Definitions
//! - **Link group**: up to [`GROUP_SIZE`] links of one robot. A workgroup searches it, with a
//!   thread for each link.
//! - **Entry**: a candidate in the memory that is read back. A chunk has a fixed number of entries,
//!   its **capacity**.
//! - d(t): the distance of triangle t from a link. `lower`, `upper`, e: its bounds on the device
//!   and their error (see the module `bounds`), `lower - e <= d <= max(upper + e, 0)`.
//! - D (`bound` in the shaders): an upper bound on the distance that is wanted: `max(upper + e, 0)`
//!   of some triangle of the link (per link) or of the group (minimum), or the margin, rounded up
//!   (clears, within). D never grows.
//! - T (`highest_wanted` in the shaders): the lowest triangle with `upper + e < 0` so far, of the
//!   link or the group; none at first, and never for a margin. Such a triangle certainly touches.
//! - t is **wanted** if `lower <= D + e` and `t <= T`.
//!
//! # Algorithm
//! 1. **Pack**, on the CPU: the points and radii of a chunk of robots, in the search frame
//!    (`chunk`, `robots`).
//! 2. **First pass**, on the device (`search`): visit the boxes that may hold a wanted triangle,
//!    the nearer child first. A thread keeps up to [`SLOTS`] wanted triangles that it meets. At the
//!    end it keeps only the triangles that are still wanted. For a margin, a triangle with
//!    `upper + e <= margin` settles the robot.
//! 3. **Second pass**, on the device (`gather`): the groups in which a wanted triangle found no
//!    slot gather all wanted triangles for the final D and T. For all triangles within a margin
//!    this is the only pass. It counts before it writes; the CPU searches for a robot whose two
//!    counts differ.
//! 4. **Repeat**: if the candidates of a chunk exceed its capacity, the chunk is searched once
//!    more, with the entries that they need.
//! 5. **Measure**, on the CPU: all candidates, in double precision. The best is the answer
//!    (`answer`).
//! 6. **Remainder**, on the CPU (`engine`): the CPU searches for robots that the device cannot
//!    represent, whose candidates do not fit, or whose loops the driver stopped. They are counted.
//!
//! Chunks overlap: the CPU packs a chunk and measures the chunk before while the device works.
//!
//! # Claim
//! The answers equal the answers of [`BvhSearch`](crate::proximity::BvhSearch) bit for bit.
//!
//! **Proof.** Let t be the nearest triangle of the link, or of the group with any of its links, at
//! distance d(t); of equals the lowest. It is wanted at all times:
//! 1. `lower(t) - e <= d(t)`, and d(t) is at most each `max(upper + e, 0)`, so `lower(t) <= D + e`.
//! 2. If T is a triangle, it touches. So d(t) = 0, and t is not higher than T.
//!
//! The same holds for every link of the group that has t. It holds in each other group of the robot
//! with a link at the distance d(t) from t: no triangle is nearer to that group, and of equals t is
//! the lowest there. So ties go to the lowest link of all that have t. A box is skipped only if it
//! holds no wanted triangle: claim 1 of `bounds`. So t is among the candidates, unless it found no
//! slot in the first pass; then the group takes the second pass, where t is wanted too. The CPU
//! measures all candidates with the function that measures in every engine. For a margin, every
//! triangle within it is wanted, and a decision is settled early only if a link is certainly within
//! it.

use super::answer::{Answer, Candidate, Found, Measure};
use super::chunk::{COUNTER_BYTES, Chunk, ENTRY_BYTES, HEAD_BYTES, capacity_for};
use super::chunk_upload::{RobotLayout, TASK_SIZE, chunk_from};
use super::device::Searched;
#[cfg(doc)]
use super::kernels::SLOTS;
use super::kernels::{FOUND, FULL, GROUP_SIZE, HIT, Question, STOPPED};
use super::robots::Packed;
use crate::answer::ProximityError;
use crate::threads::each;
use gpu_batch::{Clock, Device, DeviceFailure, READINGS, Watch};
use std::time::Duration;

/// The least entries per item, for each kind of question. An item is a link if the query answers
/// each link, else a link group. The capacity of a chunk follows what earlier chunks needed, and
/// all of it is read back. For a margin, few robots have a candidate.
const LEAST_ENTRIES_PER_ITEM: [u64; Question::KINDS] = [4, 16, 1, 32];

/// Memory of the batches, here and on the device, reused by the next.
pub(super) struct Batches {
    watch: Watch,
    /// Two chunks in turn: one is answered while the device searches the other.
    chunks: [Chunk; 2],
    /// For each kind of question: see [`LEAST_ENTRIES_PER_ITEM`].
    entries_per_item: [u64; Question::KINDS],
    /// The robots of the last batch that the CPU must search for.
    pub for_cpu: Vec<usize>,
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
            chunks: Default::default(),
            entries_per_item: LEAST_ENTRIES_PER_ITEM,
            for_cpu: Vec::new(),
            device_time: None,
            work: [0; 3],
        }
    }

    /// Drops the buffers, after a failure or with another tree.
    pub(super) fn forget(&mut self) {
        self.chunks = Default::default();
    }

    /// Answers all robots except the robots in [`Batches::for_cpu`].
    ///
    /// # Errors
    /// The device has failed since the last batch, or did not answer.
    pub(super) fn run<A: Answer>(
        &mut self,
        searched: Searched,
        robots: impl Packed,
        answer: &A,
        measure: Measure,
        out: &mut [Result<A::Value, ProximityError>],
    ) -> Result<(), DeviceFailure> {
        let done = self.run_chunks(searched, robots, answer, measure, out);
        if done.is_err() {
            self.abandon(&searched.gpu.device);
        }
        done
    }

    /// Waits for the chunks that the device still has. A buffer that vanishes while it is waited
    /// for would be reported as another failure.
    fn abandon(&mut self, device: &Device) {
        let Self { watch, chunks, .. } = self;
        for chunk in chunks {
            if let Some((submitted, readback)) = chunk.submitted.take().zip(chunk.readback()) {
                // The batch has failed already.
                let _ = device.read(watch, submitted, readback, |_| Ok(()));
            }
        }
    }

    fn run_chunks<A: Answer>(
        &mut self,
        searched: Searched,
        robots: impl Packed,
        answer: &A,
        measure: Measure,
        out: &mut [Result<A::Value, ProximityError>],
    ) -> Result<(), DeviceFailure> {
        self.for_cpu.clear();
        self.work = [0; 3];
        self.device_time = searched.gpu.device.tick().map(|_| Duration::ZERO);
        let question = answer.question();
        // The first robot of the next chunk, and which of the two chunks has its turn.
        let (mut next, mut turn) = (0, 0);
        let mut pending = None;
        while next < robots.len() {
            let range = chunk_from(robots, next);
            next = range.end;
            let entries = self.entries_per_item[question.kind()];
            let Self { chunks, watch, .. } = self;
            chunks[turn].start(searched, robots, range, question, entries, out, watch)?;
            if let Some(before) = pending.replace(turn) {
                self.finish(before, searched, answer, measure, out)?;
            }
            turn = 1 - turn;
        }
        pending.map_or(Ok(()), |last| self.finish(last, searched, answer, measure, out))
    }

    /// Steps 4 and 5, for one of the two chunks.
    fn finish<A: Answer>(
        &mut self,
        turn: usize,
        searched: Searched,
        answer: &A,
        measure: Measure,
        out: &mut [Result<A::Value, ProximityError>],
    ) -> Result<(), DeviceFailure> {
        let Self { watch, chunks, entries_per_item, for_cpu, device_time, work } = self;
        let (chunk, device, question) =
            (&mut chunks[turn], &searched.gpu.device, answer.question());
        let robots = chunk.layout.robots.clone();
        let numbered = robots.clone().zip(&chunk.layout.layouts);
        for_cpu.extend(numbered.filter(|(_, layout)| layout.is_for_cpu).map(|(robot, _)| robot));
        let entries_per_item = &mut entries_per_item[question.kind()];
        let least = LEAST_ENTRIES_PER_ITEM[question.kind()];
        let out = &mut out[robots.clone()];
        // If the candidates exceed the capacity, the chunk is searched once more.
        let mut is_second = false;
        while let Some((submitted, readback)) = chunk.submitted.take().zip(chunk.readback()) {
            let layouts = &chunk.layout.layouts;
            let mut is_answered = false;
            device.read(watch, submitted, readback, |bytes| {
                let (readings, bytes) = bytes.split_at(READINGS as usize);
                *device_time = device_time
                    .zip(Clock::time_between(device, readings))
                    .map(|(sum, more)| sum + more);
                let (counters, bytes) = bytes.split_at(COUNTER_BYTES as usize);
                let mut counters = words(counters).map(u64::from);
                let needed = counters.next().unwrap_or(0);
                *entries_per_item =
                    next_entries_per_item(*entries_per_item, least, needed, chunk.items);
                let next = capacity_for(*entries_per_item, chunk.items, device.largest_binding());
                let fit = needed <= chunk.capacity.into();
                is_answered = is_second || fit || next <= chunk.capacity;
                if !is_answered {
                    return Ok(());
                }
                work.iter_mut().zip(counters).for_each(|(sum, more)| *sum += more);
                let heads_bytes = chunk.layout.groups as usize * HEAD_BYTES as usize;
                let (heads, entries) = bytes.split_at(heads_bytes);
                let heads = Heads { heads, entries, capacity: chunk.capacity };
                let shares = out.chunks_mut(TASK_SIZE).zip(layouts.chunks(TASK_SIZE)).enumerate();
                let mut shares: Vec<_> = shares
                    .map(|(share, (out, layouts))| {
                        (robots.start + share * TASK_SIZE, layouts, out, Ok(Vec::new()))
                    })
                    .collect();
                each(&mut shares, |_, (first, layouts, out, for_cpu)| {
                    *for_cpu = heads.answer(*first, layouts, out, answer, measure);
                });
                for (.., of_share) in shares {
                    for_cpu.extend(of_share?);
                }
                Ok(())
            })?;
            if !is_answered {
                is_second = true;
                chunk.submit(searched, question, *entries_per_item, watch)?;
            }
        }
        Ok(())
    }
}

/// The entries per item after a chunk of `items` that needed `needed` entries. They grow at once
/// and shrink slowly, because all entries of a chunk are read back.
fn next_entries_per_item(before: u64, least: u64, needed: u64, items: u64) -> u64 {
    let per_item = (needed + needed / 8).div_ceil(items.max(1));
    per_item.max(before - before / 8).max(least)
}

/// The words in some bytes of the device.
fn words(bytes: &[u8]) -> impl Iterator<Item = u32> + Clone + '_ {
    bytes.as_chunks::<4>().0.iter().map(|word| u32::from_ne_bytes(*word))
}

/// The pairs of words in some bytes of the device.
fn pairs(bytes: &[u8]) -> impl Iterator<Item = (u32, u32)> + Clone + '_ {
    let pairs = bytes.as_chunks::<4>().0.as_chunks::<2>().0.iter();
    pairs.map(|[one, other]| (u32::from_ne_bytes(*one), u32::from_ne_bytes(*other)))
}

/// The number of a link in its group: the thread that searched for it.
#[derive(Clone, Copy)]
struct Lane(u32);

impl Lane {
    /// The number of the link in its robot. `first_link` is the first link of its group.
    fn in_robot(self, first_link: u32) -> u32 {
        first_link + self.0
    }
}

/// What came back about the link groups of a chunk.
#[derive(Clone, Copy)]
struct Heads<'a> {
    heads: &'a [u8],
    entries: &'a [u8],
    /// The number of entries.
    capacity: u32,
}

impl<'a> Heads<'a> {
    /// Answers robots from the number `first` on. Returns the robots that the CPU must search for.
    ///
    /// # Errors
    /// The device did not answer for a link group.
    fn answer<A: Answer>(
        self,
        first: usize,
        layouts: &[RobotLayout],
        out: &mut [Result<A::Value, ProximityError>],
        answer: &A,
        measure: Measure,
    ) -> Result<Vec<usize>, DeviceFailure> {
        let (mut for_cpu, mut candidates) = (Vec::new(), Vec::new());
        for ((robot, layout), out) in (first..).zip(layouts).zip(out) {
            if layout.links == 0 {
                continue;
            }
            candidates.clear();
            let (mut is_hit, mut is_incomplete) = (false, false);
            let heads = &self.heads[layout.first_group as usize * HEAD_BYTES as usize..];
            for ((begin, status), first_link) in
                pairs(heads).take(layout.groups() as usize).zip((0..).step_by(GROUP_SIZE as usize))
            {
                match status {
                    HIT => is_hit = true,
                    FULL | STOPPED => is_incomplete = true,
                    FOUND.. => {
                        let found = self.entries(begin, status - FOUND)?;
                        candidates.extend(found.map(|(lane, triangle)| Candidate {
                            link: lane.in_robot(first_link),
                            triangle,
                        }));
                    }
                    _ => return Err(DeviceFailure::Unanswered),
                }
            }
            // A hit settles a robot, regardless of its other groups.
            let is_settled = is_hit || !is_incomplete;
            let found = Found { is_hit, candidates: &candidates };
            match is_settled.then(|| answer.answer(measure, robot, found, out)).flatten() {
                Some(value) => *out = Ok(value),
                None => for_cpu.push(robot),
            }
        }
        Ok(for_cpu)
    }

    /// The entries of a link group.
    ///
    /// # Errors
    /// There are fewer entries.
    fn entries(
        self,
        begin: u32,
        count: u32,
    ) -> Result<impl Iterator<Item = (Lane, u32)> + use<'a>, DeviceFailure> {
        let (begin, count) = (begin as usize, count as usize);
        if begin + count > self.capacity as usize {
            return Err(DeviceFailure::Unanswered);
        }
        let bytes = &self.entries[begin * ENTRY_BYTES as usize..][..count * ENTRY_BYTES as usize];
        Ok(pairs(bytes).map(|(lane, triangle)| (Lane(lane), triangle)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::search::chunk_upload::ChunkLayout;
    use crate::gpu::search::robots::Robots;
    use crate::mesh::Mesh;
    use crate::robot::Chain;
    use continuum_testing::Random;
    use fearless_simd::Level;
    use parry3d_f64::math::{Pose, Vector};

    /// What a device returns for a chunk: a head for each link group, in any order of their
    /// entries. The candidate of link k of a robot has the number 1000 robot + k, once for each of
    /// `each`.
    fn returned(random: &mut Random, chunk: &ChunkLayout, each: &[u32]) -> (Vec<u32>, Vec<u32>) {
        let mut heads = vec![0; 2 * chunk.groups as usize];
        let mut entries = Vec::new();
        let groups = |(robot, layout): (usize, &RobotLayout)| {
            let (first, links) = (layout.first_group, layout.links);
            (0..layout.groups()).map(move |group| (robot, first + group, group * GROUP_SIZE, links))
        };
        let mut all: Vec<_> = chunk.robots.clone().zip(&chunk.layouts).flat_map(groups).collect();
        for k in (1..all.len()).rev() {
            all.swap(k, random.below(k as u32 + 1) as usize);
        }
        for (robot, group, first_link, links) in all {
            let lanes = (links - first_link).min(GROUP_SIZE);
            let begin = entries.len() as u32 / 2;
            for lane in (0..lanes).rev() {
                for _ in 0..each[robot] {
                    entries.extend([lane, 1000 * robot as u32 + first_link + lane]);
                }
            }
            heads[2 * group as usize] = begin;
            heads[2 * group as usize + 1] = FOUND + entries.len() as u32 / 2 - begin;
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

    /// Returns the sorted candidates of a robot, and checks whether it is hit.
    struct Sorted<'a> {
        /// The status of each robot, if it is not the number of its candidates.
        status: &'a [u32],
    }

    impl Answer for Sorted<'_> {
        type Value = Vec<Candidate>;

        fn question(&self) -> Question {
            Question::PerLink
        }

        fn placeholder(&self) -> Self::Value {
            Vec::new()
        }

        fn answer(
            &self,
            _: Measure,
            robot: usize,
            found: Found,
            _: &mut Result<Self::Value, ProximityError>,
        ) -> Option<Self::Value> {
            let mut all = found.candidates.to_vec();
            all.sort_unstable();
            assert_eq!(found.is_hit, self.status[robot] == HIT);
            Some(all)
        }
    }

    /// Each robot gets the candidates of all of its link groups, with the numbers of its links.
    #[test]
    fn candidates_come_back_to_their_robots_and_links() {
        let random = &mut Random::new(43);
        let (mut several_groups, mut hits, mut incomplete) = (0, 0, 0);
        let mesh = Mesh::of(vec![Vector::ZERO; 3], vec![[0, 1, 2]]);
        let measure = Measure { level: Level::new(), mesh: &mesh };
        for _ in 0..100 {
            let count = 1 + random.below(6) as usize;
            let links: Vec<_> = (0..count)
                .map(|_| [1, 5, 31, 32, 33, 64, 65, 100][random.below(8) as usize])
                .collect();
            let chains = chains(&links);
            let robots: Vec<_> = chains.iter().map(|chain| (chain, Pose::IDENTITY)).collect();
            let first = random.below(count as u32) as usize;
            let robots = Robots::Batch(&robots);
            let mut chunk = ChunkLayout::default();
            chunk.lay_out(robots, first..count);
            let needed: usize = links[first..].iter().map(|links| links.div_ceil(32)).sum();
            assert_eq!(chunk.groups as usize, needed);
            let each: Vec<_> = (0..count).map(|_| random.below(3)).collect();
            let (mut heads, entries) = returned(random, &chunk, &each);
            // Some groups are hit, or were not answered.
            let mut status = vec![0; count];
            for (robot, layout) in (first..).zip(&chunk.layouts) {
                let groups = layout.groups();
                several_groups += usize::from(groups > 1);
                if random.below(3) == 0 {
                    status[robot] = [HIT, FULL, STOPPED][random.below(3) as usize];
                    let group = layout.first_group + random.below(groups);
                    heads[2 * group as usize + 1] = status[robot];
                }
            }
            let capacity = entries.len() as u32 / 2;
            let (heads, entries) = (bytes(&heads), bytes(&entries));
            let answers = Heads { heads: &heads, entries: &entries, capacity };
            let mut out = vec![Ok(Vec::new()); count - first];
            let answer = Sorted { status: &status };
            let for_cpu =
                answers.answer(first, &chunk.layouts, &mut out, &answer, measure).unwrap();
            let expected: Vec<_> =
                (first..count).filter(|&robot| [FULL, STOPPED].contains(&status[robot])).collect();
            assert_eq!(for_cpu, expected);
            incomplete += for_cpu.len();
            hits += status.iter().filter(|&&status| status == HIT).count();
            for (robot, found) in (first..).zip(out) {
                if status[robot] != 0 {
                    continue;
                }
                let links = 0..links[robot] as u32;
                let expected: Vec<_> = links
                    .flat_map(|link| {
                        let candidate = Candidate { link, triangle: 1000 * robot as u32 + link };
                        std::iter::repeat_n(candidate, each[robot] as usize)
                    })
                    .collect();
                assert_eq!(found.unwrap(), expected, "{robot}");
            }
        }
        assert!(several_groups > 50 && hits > 10 && incomplete > 20, "{several_groups} {hits}");
    }

    /// An entry beyond the capacity, and a link group without an answer, fail the batch.
    #[test]
    fn missing_entries_and_heads_are_no_answer() {
        let mesh = Mesh::of(vec![Vector::ZERO; 3], vec![[0, 1, 2]]);
        let measure = Measure { level: Level::new(), mesh: &mesh };
        let chains = chains(&[40]);
        let robots = [(&chains[0], Pose::IDENTITY)];
        let mut chunk = ChunkLayout::default();
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
            let heads = Heads { heads: &heads, entries: &entries, capacity: 2 };
            let (mut out, answer) = ([Ok(Vec::new())], Sorted { status: &[0] });
            let found = heads.answer(0, &chunk.layouts, &mut out, &answer, measure);
            assert_eq!(found.is_ok(), is_answered);
        }
    }

    /// A chunk whose candidates exceed its capacity is searched at most once more. Then all fit,
    /// unless the largest buffer is too small for them.
    #[test]
    fn all_candidates_fit_at_a_second_search() {
        let random = &mut Random::new(47);
        let (mut once, mut again, mut too_many) = (0, 0, 0);
        for _ in 0..2000 {
            let items = 1 + u64::from(random.below(100_000));
            let needed = items * u64::from(random.below(200)) / (1 + u64::from(random.below(20)));
            let largest = 1 << (16 + random.below(14));
            let mut each = 4 + u64::from(random.below(40));
            let first = capacity_for(each, items, largest);
            each = next_entries_per_item(each, 4, needed, items);
            let second = capacity_for(each, items, largest);
            if needed <= first.into() {
                once += 1;
            } else if second <= first {
                assert_eq!(u64::from(first), largest / ENTRY_BYTES);
                too_many += 1;
            } else {
                assert!(needed <= second.into() || u64::from(second) == largest / ENTRY_BYTES);
                again += 1;
            }
        }
        assert!(once > 200 && again > 200 && too_many > 200, "{once} {again} {too_many}");
    }

    #[test]
    fn entries_grow_at_once_and_shrink_slowly() {
        for (needed, items) in [(0, 1), (400, 100), (1000, 100), (102_400, 100)] {
            let each = next_entries_per_item(4, 4, needed, items);
            assert!(each >= 4 && each * items >= needed, "{needed}: {each}");
        }
        let mut each = next_entries_per_item(4, 4, 102_400, 100);
        let after = next_entries_per_item(each, 4, 100, 100);
        assert!(each / 2 < after && after < each, "{each} {after}");
        for _ in 0..100 {
            each = next_entries_per_item(each, 4, 100, 100);
        }
        assert!(each < 8, "{each}");
    }
}
