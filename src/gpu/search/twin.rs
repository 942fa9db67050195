//! The shaders of the search in Rust: `bounds.wgsl`, `search.wgsl`, `gather.wgsl` and the refit,
//! step by step, and the tests that compare the two.

use super::bounds::{
    FAR, FLAT_ERROR, PARALLEL, ROUND_ERROR, SMALL, SearchCap, THIN, TINY, TURN_ERROR,
};
use super::kernels::{MOST_GATHERED, NOTHING, SLOTS};
use super::tree::{LEAF, SearchTree, leaf_range};
use crate::distance::Vec3;
use crate::mesh::{Mesh, SearchFrame};

type Point = Vec3<f32>;

/// The inner product, as devices may compute it: in order, or fused and in reverse.
fn dot<const FUSED: bool>(a: Point, b: Point) -> f32 {
    if FUSED {
        return a.x.mul_add(b.x, a.y.mul_add(b.y, a.z * b.z));
    }
    a.x * b.x + a.y * b.y + a.z * b.z
}

/// The function `op` of each coordinate.
fn map2(a: Point, b: Point, op: impl Fn(f32, f32) -> f32) -> Point {
    Vec3::new(op(a.x, b.x), op(a.y, b.y), op(a.z, b.z))
}

fn abs(a: Point) -> Point {
    Vec3::new(a.x.abs(), a.y.abs(), a.z.abs())
}

/// Bounds on the signed distance of a triangle from a link.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    pub lower: f32,
    pub upper: f32,
}

/// A place on the axis (from 0 to 1) and one on a triangle, as shares of two edges.
#[derive(Clone, Copy)]
struct Places {
    s: f32,
    v: f32,
    w: f32,
}

/// A link as the device sees it. `FUSED`: whether products are fused with sums.
#[derive(Clone, Copy, Debug)]
pub(super) struct SearchedLink<const FUSED: bool = false> {
    start: Point,
    end: Point,
    axis: Point,
    low: Point,
    high: Point,
    pub radius: f32,
    length: f32,
    inverse: f32,
    pub error: f32,
    /// Whether a cap is flat or may be.
    flat_start: bool,
    flat_end: bool,
    /// Whether a cap is round or may be.
    round_start: bool,
    round_end: bool,
    is_thin: bool,
}

impl<const FUSED: bool> SearchedLink<FUSED> {
    pub(super) fn new([start, end]: [Point; 2], radius: f32, caps: [SearchCap; 2]) -> Self {
        let along = end - start;
        let squared = dot::<FUSED>(along, along);
        let length = squared.sqrt();
        let reach = start.largest().max(end.largest()).max(radius.max(1.0));
        let has_flat = caps != [SearchCap::Round; 2];
        let is_thin = has_flat && length < THIN * reach;
        let short = 1.0 / length.max(TINY);
        let error = if has_flat && !is_thin {
            reach * (FLAT_ERROR + TURN_ERROR * radius * short)
        } else {
            ROUND_ERROR * reach
        };
        Self {
            start,
            end,
            axis: along * short,
            low: map2(start, end, f32::min),
            high: map2(start, end, f32::max),
            radius,
            length,
            inverse: 1.0 / squared.max(TINY),
            error,
            flat_start: !is_thin && caps[0] != SearchCap::Round,
            flat_end: !is_thin && caps[1] != SearchCap::Round,
            round_start: is_thin || caps[0] != SearchCap::Flat,
            round_end: is_thin || caps[1] != SearchCap::Flat,
            is_thin,
        }
    }

    /// The square of a lower bound on the distance between the axis and a box.
    pub(super) fn box_distance_squared(&self, low: Point, high: Point) -> f32 {
        // 1. The gaps between two boxes.
        let gap = map2(low - self.high, self.low - high, f32::max);
        let gap = map2(gap, Vec3::zero(0.0), f32::max);
        // 2. The plane across the vector from the axis to the centre.
        let centre = (low + high) * 0.5;
        let half = high - centre;
        let along = self.end - self.start;
        let s = (dot::<FUSED>(centre - self.start, along) * self.inverse).clamp(0.0, 1.0);
        let normal = centre - (self.start + along * s);
        let behind = dot::<FUSED>(normal, self.start).max(dot::<FUSED>(normal, self.end));
        let reach = dot::<FUSED>(abs(normal), half);
        let ahead = (dot::<FUSED>(normal, centre) - reach - behind).max(0.0);
        let squared = dot::<FUSED>(normal, normal);
        let plane = if squared > TINY { ahead * ahead / squared } else { 0.0 };
        dot::<FUSED>(gap, gap).max(plane)
    }

    /// The limit on [`SearchedLink::box_distance_squared`] for a bound on the distance.
    pub(super) fn box_limit(&self, bound: f32) -> f32 {
        let limit = bound + self.radius + self.error;
        limit * limit
    }

    /// How far the triangle lies ahead of the link along a normal. `caps`: the reach of a flat
    /// start and a flat end along that normal, beyond the ends of the axis.
    fn ahead_of_plane(&self, [a, b, c]: [Point; 3], normal: Point, caps: [f32; 2]) -> f32 {
        let at = |point| dot::<FUSED>(normal, point);
        let triangle = at(a).min(at(b).min(at(c)));
        triangle - (at(self.start) + caps[0]).max(at(self.end) + caps[1])
    }

    pub(super) fn bounds(&self, corners: [Point; 3]) -> Bounds {
        let [a, b, c] = corners;
        let along = self.end - self.start;
        let (e1, e2) = (b - a, c - a);
        let Places { s, v, w } = close_places::<FUSED>(along, a - self.start, e1, e2);
        let on_triangle = a + e1 * v + e2 * w;
        let between = on_triangle - (self.start + along * s);
        let axis = dot::<FUSED>(between, between).sqrt();
        let axis_ahead = self.ahead_of_plane(corners, between, [0.0; 2]).max(0.0);
        let axis_lower = if axis > SMALL { axis_ahead / axis } else { 0.0 };
        let radius = if self.is_thin { 0.0 } else { self.radius };
        let mut bounds = Bounds { lower: axis_lower - self.radius, upper: axis - radius };
        if !self.flat_start && !self.flat_end {
            return bounds;
        }
        // The height of the point over the cap that is nearer to it.
        let from_start = on_triangle - self.start;
        let along_axis = dot::<FUSED>(from_start, self.axis);
        let below_start = if self.flat_start { -along_axis } else { -FAR };
        let above_end = if self.flat_end { along_axis - self.length } else { -FAR };
        let height = below_start.max(above_end);
        if height <= 0.0 {
            bounds.upper = bounds.upper.max(height);
            return bounds;
        }
        let outward = if above_end > below_start { self.axis } else { -self.axis };
        let radial = from_start - self.axis * along_axis;
        let rho = dot::<FUSED>(radial, radial).sqrt();
        let beside = (rho - self.radius).max(0.0);
        bounds.upper = (height * height + beside * beside).sqrt();
        let normal = outward * height + radial * (beside / rho.max(SMALL));
        let length = dot::<FUSED>(normal, normal).sqrt();
        let across = normal - self.axis * dot::<FUSED>(normal, self.axis);
        let flat_reach = self.radius * dot::<FUSED>(across, across).sqrt();
        let round_reach = self.radius * length;
        let caps = [self.round_start, self.round_end]
            .map(|is_round| if is_round { round_reach } else { flat_reach });
        if length > SMALL {
            let lower = self.ahead_of_plane(corners, normal, caps) / length;
            bounds.lower = bounds.lower.max(lower);
        }
        bounds
    }
}

/// Places where a segment from 0 to `along` and the segment from `a` to `a + edge` are close.
fn close_segments<const FUSED: bool>(along: Point, a: Point, edge: Point) -> [f32; 2] {
    let (aa, ee) = (dot::<FUSED>(along, along), dot::<FUSED>(edge, edge));
    let ae = dot::<FUSED>(along, edge);
    let (c, f) = (-dot::<FUSED>(along, a), -dot::<FUSED>(edge, a));
    let determinant = aa * ee - ae * ae;
    let is_skew = determinant > PARALLEL * aa * ee;
    let s = if is_skew { ((ae * f - c * ee) / determinant).clamp(0.0, 1.0) } else { 0.0 };
    let t = ((ae * s + f) / ee.max(TINY)).clamp(0.0, 1.0);
    [((ae * t - c) / aa.max(TINY)).clamp(0.0, 1.0), t]
}

/// A guess at the closest places of an axis from 0 to `along` and a triangle.
fn close_places<const FUSED: bool>(along: Point, a: Point, e1: Point, e2: Point) -> Places {
    let squared_between = |Places { s, v, w }: Places| {
        let d = a + e1 * v + e2 * w - along * s;
        dot::<FUSED>(d, d)
    };
    let ab = close_segments::<FUSED>(along, a, e1);
    let ac = close_segments::<FUSED>(along, a, e2);
    let bc = close_segments::<FUSED>(along, a + e1, e2 - e1);
    let normal = e1.cross(e2);
    let squared = dot::<FUSED>(normal, normal);
    let has_face = squared > TINY;
    let inverse = 1.0 / if has_face { squared } else { 1.0 };
    let start_height = dot::<FUSED>(a, normal);
    let end_height = dot::<FUSED>(a - along, normal);
    let crosses = (start_height < 0.0) != (end_height < 0.0);
    let difference = start_height - end_height;
    let crossing = if crosses && difference != 0.0 { start_height / difference } else { 0.0 };
    let on_face = |s: f32| {
        let point = along * s - a;
        let v = dot::<FUSED>(point.cross(e2), normal) * inverse;
        let w = dot::<FUSED>(e1.cross(point), normal) * inverse;
        (has_face && v >= 0.0 && w >= 0.0 && v + w <= 1.0).then(|| {
            let v = v.clamp(0.0, 1.0);
            Places { s, v, w: w.clamp(0.0, 1.0 - v) }
        })
    };
    let edges = [
        Places { s: ab[0], v: ab[1], w: 0.0 },
        Places { s: ac[0], v: 0.0, w: ac[1] },
        Places { s: bc[0], v: 1.0 - bc[1], w: bc[1] },
    ];
    let crossing = if crosses { on_face(crossing.clamp(0.0, 1.0)) } else { None };
    let faces = [on_face(0.0), on_face(1.0), crossing];
    let (mut best, mut least) = (edges[0], squared_between(edges[0]));
    for other in edges.into_iter().skip(1).chain(faces.into_iter().flatten()) {
        let squared = squared_between(other);
        if squared < least {
            (best, least) = (other, squared);
        }
    }
    best
}

/// A box: its lowest and its highest corner.
type Corners = [Point; 2];

/// The tree as the device has it after a refit.
pub(super) struct TwinTree<'a> {
    tree: &'a SearchTree,
    pub boxes: Vec<[Corners; 2]>,
    triangles: Vec<[Point; 3]>,
}

/// Nodes and leaves visited.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct TwinWork {
    pub nodes: usize,
    pub leaves: usize,
}

/// The wanted triangles of a link: D and T of the module `batch`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wanted {
    pub bound: f32,
    pub highest: u32,
}

impl Wanted {
    pub(super) const ANY: Self = Self { bound: FAR, highest: NOTHING };

    /// `is_wanted` in robots.wgsl: whether a triangle with this lower bound is wanted.
    fn is_met_by(self, lower: f32, triangle: u32, error: f32) -> bool {
        lower <= self.bound + error && triangle <= self.highest
    }
}

fn low_of(a: Point, b: Point) -> Point {
    Vec3::new(a.x.min(b.x), a.y.min(b.y), a.z.min(b.z))
}

fn high_of(a: Point, b: Point) -> Point {
    Vec3::new(a.x.max(b.x), a.y.max(b.y), a.z.max(b.z))
}

impl<'a> TwinTree<'a> {
    /// corners.wgsl and refit.wgsl.
    pub(super) fn refit(tree: &'a SearchTree, frame: &SearchFrame, mesh: &Mesh) -> Self {
        let corners = |&triangle: &u32| mesh.corners(triangle).map(|corner| frame.point(corner));
        let triangles: Vec<[Point; 3]> = tree.triangles.iter().map(corners).collect();
        let nothing = [Vec3::new(FAR, FAR, FAR), Vec3::new(-FAR, -FAR, -FAR)];
        let mut boxes = vec![[nothing; 2]; tree.nodes.len()];
        for &node in &tree.by_height {
            boxes[node as usize] = tree.nodes[node as usize].children.map(|child| {
                let all: Vec<Corners> = if child & LEAF != 0 {
                    let corners = triangles[leaf_range(child)].iter().flatten();
                    corners.map(|&corner| [corner; 2]).collect()
                } else {
                    boxes[child as usize].to_vec()
                };
                all.into_iter().fold(nothing, |[low, high], [other_low, other_high]| {
                    [low_of(low, other_low), high_of(high, other_high)]
                })
            });
        }
        Self { tree, boxes, triangles }
    }

    /// search.wgsl for one link: its candidates, what is wanted in the end, and whether a wanted
    /// triangle found no slot.
    pub(super) fn search<const FUSED: bool>(
        &self,
        link: &SearchedLink<FUSED>,
        mut wanted: Wanted,
        work: &mut TwinWork,
    ) -> (Vec<u32>, Wanted, bool) {
        let mut candidates: Vec<(f32, u32)> = Vec::new();
        let mut least_overflow = FAR;
        let mut waiting = vec![(0.0, 0)];
        while let Some((squared, place)) = waiting.pop() {
            if squared > link.box_limit(wanted.bound) {
                continue;
            }
            if place & LEAF == 0 {
                work.nodes += 1;
                let node = &self.tree.nodes[place as usize];
                let limit = link.box_limit(wanted.bound);
                let mut visited = Vec::new();
                for ((child, lowest), [low, high]) in
                    node.children.into_iter().zip(node.lowest).zip(self.boxes[place as usize])
                {
                    let squared = link.box_distance_squared(low, high);
                    if squared <= limit && lowest <= wanted.highest {
                        visited.push((squared, child));
                    }
                }
                visited.sort_by(|a, b| b.0.total_cmp(&a.0));
                waiting.extend(visited);
                continue;
            }
            work.leaves += 1;
            for at in leaf_range(place) {
                let triangle = self.tree.triangles[at];
                let bounds = link.bounds(self.triangles[at]);
                if !wanted.is_met_by(bounds.lower, triangle, link.error) {
                    continue;
                }
                let at_most = bounds.upper + link.error;
                wanted.bound = wanted.bound.min(at_most.max(0.0));
                if at_most < 0.0 {
                    wanted.highest = wanted.highest.min(triangle);
                }
                if candidates.len() == SLOTS as usize {
                    candidates
                        .retain(|&(lower, triangle)| wanted.is_met_by(lower, triangle, link.error));
                }
                candidates.push((bounds.lower, triangle));
                if candidates.len() > SLOTS as usize {
                    candidates.sort_by(|a, b| a.0.total_cmp(&b.0));
                    let dropped = candidates.pop();
                    least_overflow =
                        dropped.map_or(least_overflow, |(lower, _)| least_overflow.min(lower));
                }
            }
        }
        candidates.retain(|&(lower, triangle)| wanted.is_met_by(lower, triangle, link.error));
        let overflows = wanted.is_met_by(least_overflow, 0, link.error);
        (candidates.into_iter().map(|candidate| candidate.1).collect(), wanted, overflows)
    }

    /// gather.wgsl for one link. `None` if there are too many.
    pub(super) fn gather<const FUSED: bool>(
        &self,
        link: &SearchedLink<FUSED>,
        wanted: Wanted,
    ) -> Option<Vec<u32>> {
        let limit = link.box_limit(wanted.bound);
        let mut found = Vec::new();
        let mut waiting = vec![0];
        while let Some(place) = waiting.pop() {
            if place & LEAF != 0 {
                for at in leaf_range(place) {
                    let triangle = self.tree.triangles[at];
                    let lower = link.bounds(self.triangles[at]).lower;
                    if wanted.is_met_by(lower, triangle, link.error) {
                        found.push(triangle);
                    }
                }
                if found.len() > MOST_GATHERED as usize {
                    return None;
                }
                continue;
            }
            let node = &self.tree.nodes[place as usize];
            for ((child, lowest), [low, high]) in
                node.children.into_iter().zip(node.lowest).zip(self.boxes[place as usize])
            {
                let squared = link.box_distance_squared(low, high);
                if lowest <= wanted.highest && squared <= limit {
                    waiting.push(child);
                }
            }
        }
        Some(found)
    }
}

mod tests {
    use super::super::bounds::ErrorBound;
    use super::super::device::DeviceTree;
    use super::super::kernels::text_of_bounds;
    use super::*;
    use crate::gpu::tests::gpu;
    use crate::mesh::round;
    use crate::pair::{Best, PlacedLink};
    use crate::robot::{Cap, ModifiedCylinder};
    use continuum_testing::Random;
    use gpu_batch::wgpu::BufferUsages;
    use gpu_batch::{Batch, Kernel};
    use parry3d_f64::math::{Pose, Real, Vector};

    /// A link near a triangle in a search frame, in double precision, of the kinds that break
    /// bounds: short and thick, touching, parallel, thin triangles, far away.
    fn pair(random: &mut Random, kind: u32) -> (ModifiedCylinder, [Vector; 3]) {
        let size = [1.0, 0.1, 0.003][random.below(3) as usize];
        let at = random.point() * 0.5;
        let mut corners = [(); 3].map(|()| at + random.point() * (0.5 * size));
        if kind % 5 == 1 {
            // A sliver, or no area.
            let share = random.unit();
            corners[2] = corners[0] * share
                + corners[1] * (1.0 - share)
                + random.point() * (1e-7 * f64::from(kind % 2) * size);
        }
        let near = at + random.point() * [0.0, 1.0, 1.0, 30.0][random.below(4) as usize] * size;
        let direction = match kind % 4 {
            0 => random.direction(),
            1 => (corners[1] - corners[0]).normalize_or(Vector::X),
            2 => (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or(Vector::Y),
            _ => (corners[1] - corners[0] + random.direction() * (1e-4 * size))
                .normalize_or(Vector::Z),
        };
        let length = [1.0, 0.3, 0.01, 1e-4, 1e-6][random.below(5) as usize] * size;
        let radius = [0.0, 0.02, 0.2, 1.0][random.below(4) as usize] * size;
        let caps = [0, 1].map(|end| if (kind >> end) & 1 == 0 { Cap::Flat } else { Cap::Round });
        let link = ModifiedCylinder::new(near, near + direction * length, radius, caps).unwrap();
        (link, corners)
    }

    /// What the bounds claim, and how close they are.
    #[derive(Debug, Default)]
    struct Tally {
        touching: u32,
        certain: u32,
        apart: u32,
        tight: u32,
    }

    impl Tally {
        /// `d`: the distance of the link with the caps that it has.
        fn check(
            &mut self,
            d: Real,
            lower: f32,
            upper: f32,
            error: f32,
            what: &dyn Fn() -> String,
        ) {
            let [lower, upper, error] = [lower, upper, error].map(Real::from);
            // In this frame the measured distance is exact beside the error.
            assert!(lower - error <= d, "{lower} {error} {d}: {}", what());
            assert!(d <= upper.max(-error) + error, "{upper} {error} {d}: {}", what());
            if upper + error < 0.0 {
                assert_eq!(d, 0.0, "{}", what());
                self.certain += 1;
            }
            if d > 0.0 {
                self.apart += 1
            } else {
                self.touching += 1
            }
            self.tight += u32::from(upper.max(0.0) - lower.max(0.0) <= 2.0 * error);
        }

        /// Bounds that were loose would be right and useless.
        fn is_telling(&self) -> bool {
            let all = self.touching + self.apart;
            self.touching > all / 20 && self.certain > self.touching / 3 && self.tight > all / 2
        }
    }

    fn in_frame(link: &ModifiedCylinder, corners: [Vector; 3]) -> ([Point; 2], f32, [Point; 3]) {
        let ends = [link.start(), link.end()].map(round::<f32>);
        (ends, link.radius() as f32, corners.map(round::<f32>))
    }

    /// The caps of a link as the device may know them.
    fn known(random: &mut Random, link: &ModifiedCylinder) -> [SearchCap; 2] {
        SearchCap::of(link.flat())
            .map(|cap| if random.below(3) == 0 { SearchCap::Either } else { cap })
    }

    /// The links that fit these caps.
    fn choices(link: &ModifiedCylinder, caps: [SearchCap; 2]) -> Vec<ModifiedCylinder> {
        let of = |cap| match cap {
            SearchCap::Round => vec![Cap::Round],
            SearchCap::Flat => vec![Cap::Flat],
            SearchCap::Either => vec![Cap::Round, Cap::Flat],
        };
        let (start, end, radius) = (link.start(), link.end(), link.radius());
        let pairs = of(caps[0])
            .into_iter()
            .flat_map(|first| of(caps[1]).into_iter().map(move |last| [first, last]));
        pairs.filter_map(|caps| ModifiedCylinder::new(start, end, radius, caps).ok()).collect()
    }

    fn measured(link: &ModifiedCylinder, corners: [Vector; 3]) -> Real {
        PlacedLink::new(link, &Pose::IDENTITY).measure(0, corners).distance
    }

    #[test]
    fn the_bounds_hold_fused_or_not() {
        let mut random = Random::new(29);
        let [mut plain, mut fused, mut either] = [(); 3].map(|()| Tally::default());
        for kind in 0..200_000 {
            let (link, corners) = pair(&mut random, kind);
            let d = measured(&link, corners);
            let (ends, radius, triangle) = in_frame(&link, corners);
            let what = || format!("{kind}: {link:?}, {corners:?}");
            let one = SearchedLink::<false>::new(ends, radius, SearchCap::of(link.flat()));
            let found = one.bounds(triangle);
            plain.check(d, found.lower, found.upper, one.error, &what);
            let other = SearchedLink::<true>::new(ends, radius, SearchCap::of(link.flat()));
            let found = other.bounds(triangle);
            fused.check(d, found.lower, found.upper, other.error, &what);
            // Caps that may be round or flat: one bound for all links that fit.
            let caps = known(&mut random, &link);
            let known = SearchedLink::<false>::new(ends, radius, caps);
            let found = known.bounds(triangle);
            for link in choices(&link, caps) {
                let d = measured(&link, corners);
                let what = || format!("{kind}: {link:?}, {caps:?}, {corners:?}");
                either.check(d, found.lower, found.upper, known.error, &what);
            }
            // A box around the triangle.
            let [a, b, c] = triangle;
            let (low, high) = (low_of(a, low_of(b, c)), high_of(a, high_of(b, c)));
            let limit = Real::from(one.box_limit(d as f32)).sqrt() * (1.0 + 1e-6);
            for squared in
                [one.box_distance_squared(low, high), other.box_distance_squared(low, high)]
            {
                assert!(Real::from(squared).sqrt() <= limit, "{}", what());
            }
        }
        let all = [&plain, &fused, &either];
        assert!(all.iter().all(|tally| tally.is_telling()), "{all:?}");
    }

    #[test]
    fn the_bounds_hold_on_the_device() {
        let Some(gpu) = gpu() else { return };
        let solve = "fn solve(problem: u32, answer: u32) {
            var p: array<f32, 17>;
            for (var k = 0u; k < 17u; k++) { p[k] = problems[problem + k]; }
            let link = link_new(vec3<f32>(p[0], p[1], p[2]), vec3<f32>(p[3], p[4], p[5]), p[6], p[7]);
            let a = vec3<f32>(p[8], p[9], p[10]);
            let b = vec3<f32>(p[11], p[12], p[13]);
            let c = vec3<f32>(p[14], p[15], p[16]);
            let found = triangle_bounds(link, a, b, c);
            answers[answer] = found.lower;
            answers[answer + 1u] = found.upper;
            answers[answer + 2u] = link.error;
            answers[answer + 3u] = box_distance_squared(link, min(a, min(b, c)), max(a, max(b, c)));
        }";
        let text = text_of_bounds() + solve;
        let mut batch = Batch::new(&gpu.0.device, &Kernel::new("bounds", &text, 17, 4)).unwrap();
        let mut random = Random::new(31);
        let problems: Vec<_> = (0..50_000)
            .map(|kind| {
                let (link, corners) = pair(&mut random, kind);
                let caps = known(&mut random, &link);
                (link, corners, caps)
            })
            .collect();
        let numbers = problems.iter().flat_map(|(link, corners, caps)| {
            let (ends, radius, triangle) = in_frame(link, *corners);
            let caps = SearchCap::code(*caps);
            let mut numbers: Vec<f64> = Vec::new();
            let mut add = |point: Point| numbers.extend([point.x, point.y, point.z].map(f64::from));
            ends.into_iter().for_each(&mut add);
            let rest =
                triangle.into_iter().flat_map(|point| [point.x, point.y, point.z].map(f64::from));
            let rest: Vec<_> =
                [f64::from(radius), f64::from(caps)].into_iter().chain(rest).collect();
            numbers.into_iter().chain(rest).collect::<Vec<_>>()
        });
        let (mut tally, mut place) = (Tally::default(), 0);
        batch
            .run(numbers, |found| {
                let (link, corners, caps) = &problems[place];
                let what = || format!("{place}: {link:?}, {caps:?}, {corners:?}");
                let mut d = 0.0;
                for link in choices(link, *caps) {
                    d = measured(&link, *corners);
                    tally.check(d, found[0] as f32, found[1] as f32, found[2] as f32, &what);
                }
                let limit = d + link.radius() + found[2];
                assert!(found[3].sqrt() <= limit * (1.0 + 1e-6), "{}", what());
                let (ends, radius, _) = in_frame(link, *corners);
                let error = SearchedLink::<false>::new(ends, radius, *caps).error;
                assert!((found[2] / f64::from(error) - 1.0).abs() < 1e-5, "{}", what());
                // The host's bound, for the link as it is.
                let error =
                    SearchedLink::<false>::new(ends, radius, SearchCap::of(link.flat())).error;
                let mut bound = ErrorBound::default();
                bound.add(ends, radius, link.flat());
                assert!(error <= bound.error() * (1.0 + 1e-5), "{}", what());
                place += 1;
            })
            .unwrap();
        assert!(place == problems.len() && tally.is_telling(), "{tally:?}");
    }

    /// The nearest triangle is among the candidates of the first pass, or of the second.
    #[test]
    fn the_twin_finds_the_nearest_triangle() {
        let mut random = Random::new(37);
        let (mut second, mut touching, mut full) = (0, 0, 0);
        for round_of in 0..40 {
            // Random triangles, each several times; in some rounds all meet in a point.
            let tip = random.point();
            let corners: Vec<_> = (0..300)
                .flat_map(|k| {
                    let at = random.point();
                    let first = if round_of % 4 == 0 && k % 2 == 0 { tip } else { at };
                    [first, at + random.point() * 0.2, at + random.point() * 0.2]
                })
                .collect();
            let mut indices: Vec<_> = (0..300).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
            indices.extend_from_within(..150);
            let mesh = Mesh::of(corners, indices);
            let frame = SearchFrame::new(&mesh);
            let tree = SearchTree::new(&frame, &mesh);
            let twin = TwinTree::refit(&tree, &frame, &mesh);
            for kind in 0..50 {
                let start = if kind % 3 == 0 { tip } else { random.point() };
                let start = start + random.direction() * random.between(0.0, 0.3);
                let caps =
                    [0, 1].map(|end| if (kind >> end) & 1 == 0 { Cap::Flat } else { Cap::Round });
                let link =
                    ModifiedCylinder::new(start, start + random.direction() * 0.2, 0.05, caps)
                        .unwrap();
                let placed = PlacedLink::new(&link, &Pose::IDENTITY);
                let mut best = Best::within(Real::INFINITY);
                (0..mesh.len() as u32).for_each(|t| {
                    best.take(placed.measure(t, mesh.corners(t)));
                });
                let nearest = best.nearest().unwrap();
                touching += usize::from(nearest.distance <= 0.0);
                let ends = [link.start(), link.end()].map(|end| frame.point::<f32>(end));
                let searched = SearchedLink::<false>::new(
                    ends,
                    (link.radius() * frame.scale) as f32,
                    SearchCap::of(link.flat()),
                );
                let mut work = TwinWork::default();
                let (mut found, wanted, overflows) = twin.search(&searched, Wanted::ANY, &mut work);
                if overflows {
                    second += 1;
                    match twin.gather(&searched, wanted) {
                        Some(gathered) => found = gathered,
                        None => {
                            full += 1;
                            continue;
                        }
                    }
                }
                assert!(
                    found.contains(&nearest.triangle),
                    "{round_of} {kind}: {nearest:?} {found:?}"
                );
                assert!(work.nodes < tree.nodes.len() && work.leaves > 0);
            }
        }
        assert!(second > 5 && touching > 50 && full == 0, "{second} {touching} {full}");
    }

    /// The device fits the boxes that the twin fits, at first and after a move.
    #[test]
    fn the_device_fits_the_boxes_of_the_twin() {
        let Some(gpu) = gpu() else { return };
        let mut random = Random::new(41);
        let kernels = gpu.0.search().unwrap();
        let device = &gpu.0.device;
        for count in [1_u32, 2, 5, 3000] {
            let corners: Vec<_> = (0..3 * count).map(|_| random.point()).collect();
            let indices = (0..count).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
            let mut mesh = Mesh::of(corners, indices);
            let tree = SearchTree::new(&SearchFrame::new(&mesh), &mesh);
            let mut on_device = DeviceTree::new(&gpu.0, kernels, &mesh, &tree).unwrap();
            for stretch in [1.0, 3.0] {
                let moved: Vec<_> = mesh
                    .vertices()
                    .iter()
                    .map(|v| Vector::new(v.x * stretch, v.y, v.z + v.x * (stretch - 1.0)))
                    .collect();
                mesh.set_vertices(&moved);
                on_device.invalidate();
                let frame = SearchFrame::new(&mesh);
                on_device.update(&gpu.0, kernels, &frame, &mesh);
                let twin = TwinTree::refit(&tree, &frame, &mesh);
                let size = 64 * tree.nodes.len() as u64;
                let usages = BufferUsages::MAP_READ | BufferUsages::COPY_DST;
                let readback = device.buffer(size, usages);
                let mut encoder = device.raw().create_command_encoder(&Default::default());
                encoder.copy_buffer_to_buffer(&on_device.nodes, 0, &readback, 0, Some(size));
                let mut words = Vec::new();
                let read = |bytes: &[u8]| {
                    let all = bytes.as_chunks::<4>().0.iter();
                    words.extend(all.map(|word| u32::from_ne_bytes(*word)));
                    Ok(())
                };
                let mut watch = device.watch();
                device.run_and_read(&mut watch, encoder.finish(), &readback, size, read).unwrap();
                for ((words, boxes), node) in
                    words.chunks_exact(16).zip(&twin.boxes).zip(&tree.nodes)
                {
                    assert_eq!([words[3], words[11]], node.children);
                    assert_eq!([words[7], words[15]], node.lowest);
                    let at = |place: usize| {
                        Vec3::from([0, 1, 2].map(|axis| f32::from_bits(words[place + axis])))
                    };
                    assert_eq!([[at(0), at(4)], [at(8), at(12)]], *boxes, "{count}");
                }
            }
        }
    }
}
