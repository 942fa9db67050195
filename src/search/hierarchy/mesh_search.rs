//! A mesh's hierarchies and the search through them for one convex piece, in the precision that resolves it.

use super::build::WideBvh;
use super::traverse::{Stack, Traversal};
use crate::answer::Work;
use crate::mesh::Mesh;
use crate::pair::{Best, Nearest, PlacedLink, PlacedRobot, SearchLink};
use crate::query::contacts::{Across, NearTriangles};
use crate::query::nearest::{JointSearch, Pairs, RoughSides};
use crate::query::side::FarFields;
use crate::threads::Lazy;
use fearless_simd::Level;
use parry3d_f64::math::{Real, Vector};

/// The sides of the mesh are found when so many robots were met: a planner meets more, a controller never does.
const ROBOTS_MET: u32 = 64;

/// A mesh and its hierarchies.
#[derive(Clone)]
pub(crate) struct Hierarchy {
    pub mesh: Mesh,
    /// The largest coordinate of a triangle.
    pub reach: Real,
    single: WideBvh<f32>,
    /// For those who ask for contacts, begun at the first question.
    across: Lazy<Across<f32>>,
    /// For links that single precision does not resolve, built when the first of them comes.
    double: Lazy<WideBvh<f64>>,
    /// For those who ask on which side of the mesh a point is, built at the first question.
    far_fields: Lazy<FarFields>,
    /// For those who often ask about robots that do not keep away.
    sides: Lazy<RoughSides>,
}

impl Hierarchy {
    pub(crate) fn new(level: Level, mesh: Mesh) -> Self {
        Self {
            single: WideBvh::new(level, &mesh),
            across: Lazy::new(),
            double: Lazy::new(),
            far_fields: Lazy::new(),
            sides: Lazy::new(),
            reach: reach(mesh.bounds()),
            mesh,
        }
    }

    fn double(&self, level: Level) -> &WideBvh<f64> {
        self.double.get_or_build(|| WideBvh::new(level, &self.mesh))
    }

    /// What the side of a point is found by. The division of either hierarchy serves.
    pub(crate) fn around(&self) -> (&Mesh, &WideBvh<f32>, &FarFields) {
        let fields = self.far_fields.get_or_build(|| FarFields::new(&self.single, &self.mesh));
        (&self.mesh, &self.single, fields)
    }

    /// Where each triangle stands in the leaves that tell of slopes.
    pub(crate) fn place_of(&self) -> &[u32] {
        &self.single.place_of
    }

    /// The link in the precision that resolves it.
    fn searched(&self, level: Level, link: &PlacedLink) -> Searched {
        let single = SearchLink::new(link, &self.single.frame);
        if let Some(single) = single.filter(|single| self.single.frame.resolves(single)) {
            return Searched::Single(single);
        }
        match SearchLink::new(link, &self.double(level).frame) {
            Some(double) => Searched::Double(double),
            None => Searched::OutOfReach,
        }
    }

    /// Takes over that the vertices of the mesh have moved.
    pub(crate) fn refit(&mut self, level: Level) {
        let bounds = self.mesh.bounds();
        self.reach = reach(bounds);
        self.far_fields.take();
        if self.sides.get().is_some_and(|sides| !sides.still_fit(bounds)) {
            self.sides.take();
        }
        self.single.refit(level, &self.mesh);
        if let Some(across) = self.across.get_mut() {
            across.forget();
        }
        if let Some(double) = self.double.get_mut() {
            double.refit(level, &self.mesh);
        }
    }
}

/// The largest coordinate of what lies in a box.
fn reach([low, high]: [Vector; 2]) -> Real {
    low.abs().max(high.abs()).max_element()
}

/// A link in the frame of a search.
enum Searched {
    Single(SearchLink<f32>),
    Double(SearchLink<f64>),
    /// Farther out than double precision reaches beside a mesh so small.
    OutOfReach,
}

/// What is known to keep away from the mesh.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum KeepsAway {
    /// Every link by itself.
    Links,
    /// Even the capsule around all links.
    Capsule,
}

/// Memory of a query, used again by the next.
#[derive(Clone, Default)]
pub(crate) struct Scratch {
    single: Stack<f32>,
    double: Stack<f64>,
    single_pairs: Pairs<f32>,
    double_pairs: Pairs<f64>,
    /// How many robots did not keep away.
    met: u32,
    pub work: Work,
}

impl Scratch {
    /// Forgets what bounds the next query.
    pub(crate) fn forget(&mut self) {
        self.single_pairs.forget();
        self.double_pairs.forget();
    }
}

/// A search through a mesh, with the memory it needs.
pub(crate) struct MeshSearch<'a> {
    pub level: Level,
    pub hierarchy: &'a Hierarchy,
    pub scratch: &'a mut Scratch,
}

impl MeshSearch<'_> {
    /// The triangle nearest to a link that improves on `best`. The triangles to `start` with come first.
    pub(crate) fn nearest(&mut self, link: &PlacedLink, mut best: Best, start: [Option<u32>; 2]) -> Best {
        match self.hierarchy.searched(self.level, link) {
            Searched::Single(searched) => self.single().nearest(link, &searched, best, start),
            Searched::Double(searched) => self.double().nearest(link, &searched, best, start),
            Searched::OutOfReach => {
                let mesh = &self.hierarchy.mesh;
                for triangle in 0..mesh.len() as u32 {
                    best.measure(link, triangle, mesh.corners(triangle));
                }
                self.scratch.work.measured += mesh.len() as u64;
                best
            }
        }
    }

    /// The same without a bound, unless few triangles are in question: they are then added to `few`, the likeliest first, and
    /// not measured.
    pub(crate) fn nearest_or_few(
        &mut self,
        link: &PlacedLink,
        start: [Option<u32>; 2],
        few: &mut Vec<u32>,
    ) -> Option<Best> {
        match self.hierarchy.searched(self.level, link) {
            Searched::Single(searched) => self.single().nearest_or_few(link, &searched, start, few),
            Searched::Double(searched) => self.double().nearest_or_few(link, &searched, start, few),
            Searched::OutOfReach => Some(self.nearest(link, Best::within(Real::INFINITY), start)),
        }
    }

    /// The same as [`MeshSearch::nearest`], and what the link keeps from all triangles at the least, with a triangle about as
    /// near if one was met.
    /// Nothing is looked for that is farther than `far`, which is `best`'s bound or more.
    pub(crate) fn nearest_and_kept(
        &mut self,
        link: &PlacedLink,
        best: Best,
        far: Real,
        start: [Option<u32>; 2],
    ) -> (Best, Real, Option<u32>) {
        match self.hierarchy.searched(self.level, link) {
            Searched::Single(searched) => self.single().nearest_and_kept(link, &searched, best, far, start),
            Searched::Double(searched) => self.double().nearest_and_kept(link, &searched, best, far, start),
            Searched::OutOfReach => (self.nearest(link, best, start), 0.0, None),
        }
    }

    /// About the triangle nearest to a capsule around links, if any is within reach.
    pub(crate) fn about_nearest(&mut self, capsule: &PlacedLink) -> Option<u32> {
        match self.hierarchy.searched(self.level, capsule) {
            Searched::Single(searched) => self.single().about_nearest(&searched),
            Searched::Double(searched) => self.double().about_nearest(&searched),
            Searched::OutOfReach => None,
        }
    }

    /// Whether any triangle may be at most `bound` from a capsule around links; false only if none is.
    pub(crate) fn may_meet(&mut self, capsule: &PlacedLink, bound: Real) -> bool {
        self.may_meet_below(capsule, bound, u32::MAX)
    }

    /// The same of the triangles with a lower number than `below`.
    pub(crate) fn may_meet_below(&mut self, capsule: &PlacedLink, bound: Real, below: u32) -> bool {
        match self.hierarchy.searched(self.level, capsule) {
            Searched::Single(searched) => self.single().may_meet(&searched, bound, below),
            Searched::Double(searched) => self.double().may_meet(&searched, bound, below),
            Searched::OutOfReach => true,
        }
    }

    /// What of a robot is known to keep more than `margin` away. None where some link does not.
    pub(crate) fn keeps_away(&mut self, robot: PlacedRobot, margin: Real) -> Option<KeepsAway> {
        let Hierarchy { mesh, single, sides, .. } = self.hierarchy;
        let level = self.level;
        let Scratch { single_pairs, double_pairs, met, work, .. } = &mut *self.scratch;
        let sides =
            if *met < ROBOTS_MET { sides.get() } else { Some(sides.get_or_build(|| RoughSides::new(mesh))) };
        let first = sides.and_then(|sides| sides.crossing(robot));
        let search = JointSearch { level, tree: single, robot, margin, first, pairs: single_pairs, work };
        let mut answer = search.keeps_away(mesh);
        let mut even_capsule = single_pairs.speak_for_capsule();
        if answer.is_none() {
            let tree = self.hierarchy.double(level);
            let search = JointSearch { level, tree, robot, margin, first, pairs: double_pairs, work };
            answer = search.keeps_away(mesh);
            even_capsule = double_pairs.speak_for_capsule();
        }
        if let Some(keeps_away) = answer {
            *met = met.saturating_add(u32::from(!keeps_away));
            let known = if even_capsule { KeepsAway::Capsule } else { KeepsAway::Links };
            return keeps_away.then_some(known);
        }
        let is_away = |link| self.nearest(&link, Best::within(margin), [None; 2]).nearest().is_none();
        robot.placed_links().all(is_away).then_some(KeepsAway::Links)
    }

    /// Adds to `found` the triangles that may be at most `bound` from a link.
    pub(crate) fn within(&mut self, link: &PlacedLink, bound: Real, found: &mut NearTriangles) {
        let Hierarchy { mesh, single, across, .. } = self.hierarchy;
        match self.hierarchy.searched(self.level, link) {
            Searched::Single(searched) => {
                let across = across.get_or_build(|| Across::new(single));
                self.single().within(&searched, bound, Some(across), found);
            }
            // Such links are rare: they do without the corners beyond the edges.
            Searched::Double(searched) => self.double().within(&searched, bound, None, found),
            Searched::OutOfReach => found.add_unknown(0..mesh.len() as u32),
        }
    }

    /// Some triangle, for a link whose nearest no search tells.
    pub(crate) fn any(&self, link: &PlacedLink) -> Nearest {
        link.measure(0, self.hierarchy.mesh.corners(0))
    }

    fn single(&mut self) -> Traversal<'_, f32> {
        let Hierarchy { mesh, single, .. } = self.hierarchy;
        let Scratch { single: stack, work, .. } = &mut *self.scratch;
        Traversal { level: self.level, mesh, tree: single, stack, work }
    }

    fn double(&mut self) -> Traversal<'_, f64> {
        let tree = self.hierarchy.double(self.level);
        let Scratch { double: stack, work, .. } = &mut *self.scratch;
        Traversal { level: self.level, mesh: &self.hierarchy.mesh, tree, stack, work }
    }
}
