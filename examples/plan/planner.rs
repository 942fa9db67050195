//! RRT-Connect (Kuffner and LaValle, 2000): two trees, one from each end, take turns to grow
//! towards random places and towards each other. Only clear places are worth growing to, so these
//! are drawn in batches.

use super::edges::{Edges, Place, along, any_place, length, way};
use continuum_demo::steer::Random;

/// The longest edge, mm.
const LONGEST: f64 = 6.0;

/// Places that are drawn at a time.
const BATCH: usize = 256;

/// Edges after which the planner gives up.
pub const MOST_EDGES: u64 = 20_000;

/// A tree of places. Each edge leads to the place of its number.
struct Tree {
    places: Vec<Place>,
    parents: Vec<usize>,
}

impl Tree {
    fn new(root: Place) -> Self {
        Self { places: vec![root], parents: vec![0] }
    }

    fn nearest(&self, to: &Place) -> usize {
        let distance = |k: &usize| length(&way(&self.places[*k], to));
        (0..self.places.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0)
    }

    /// Grows by edges towards a place: one, or as many as are clear. Returns the last place, and
    /// whether it is that.
    fn grow(
        &mut self,
        edges: &mut Edges,
        to: &Place,
        is_greedy: bool,
    ) -> Result<(usize, bool), String> {
        let mut last = self.nearest(to);
        loop {
            let from = self.places[last];
            let way = way(&from, to);
            let share = LONGEST / length(&way);
            let next = if share < 1.0 { along(&from, &way, share) } else { *to };
            if !edges.is_clear(&from, &next)? {
                return Ok((last, false));
            }
            self.places.push(next);
            self.parents.push(last);
            last = self.places.len() - 1;
            if share >= 1.0 || !is_greedy {
                return Ok((last, share >= 1.0));
            }
        }
    }

    /// The places from a place back to the root.
    fn back(&self, mut from: usize) -> Vec<Place> {
        let mut places = vec![self.places[from]];
        while from > 0 {
            from = self.parents[from];
            places.push(self.places[from]);
        }
        places
    }

    /// The edges that were accepted.
    fn edges(&self) -> impl Iterator<Item = [Place; 2]> {
        (1..self.places.len()).map(|k| [self.places[self.parents[k]], self.places[k]])
    }
}

/// What a planner found.
pub struct Plan {
    /// The way, place by place; none if the planner gave up.
    pub path: Option<Vec<Place>>,
    /// All edges of both trees.
    pub accepted: Vec<[Place; 2]>,
    /// How many places were drawn, and how many of them are clear.
    pub drawn: usize,
    pub clear: usize,
}

/// Plans from a place to another.
pub fn plan(edges: &mut Edges, ends: [Place; 2], seed: u64) -> Result<Plan, String> {
    let mut random = Random(seed);
    let mut trees = ends.map(Tree::new);
    let (mut drawn, mut clear, mut path) = (0, 0, None);
    let last = edges.costs.edges + MOST_EDGES;
    'search: while edges.costs.edges < last {
        let places = (0..BATCH).map(|_| any_place(edges.robot, &mut random)).collect();
        let targets = edges.clear_places(places)?;
        (drawn, clear) = (drawn + BATCH, clear + targets.len());
        for (turn, target) in targets.iter().enumerate() {
            let [one, other] = &mut trees;
            let (growing, waiting) = if turn % 2 == 0 { (one, other) } else { (other, one) };
            let (reached, _) = growing.grow(edges, target, false)?;
            let goal = growing.places[reached];
            let (met, is_met) = waiting.grow(edges, &goal, true)?;
            if is_met {
                let halves = if turn % 2 == 0 { [reached, met] } else { [met, reached] };
                let mut all = trees[0].back(halves[0]);
                all.reverse();
                all.extend(trees[1].back(halves[1]).into_iter().skip(1));
                path = Some(all);
                break 'search;
            }
        }
    }
    let accepted = trees.iter().flat_map(Tree::edges).collect();
    Ok(Plan { path, accepted, drawn, clear })
}

/// The path with detours left out: edges between places that are not neighbours, where they are
/// clear.
pub fn shorten(edges: &mut Edges, mut path: Vec<Place>, seed: u64) -> Result<Vec<Place>, String> {
    let mut random = Random(seed);
    for _ in 0..20 * path.len() {
        let mut pick = || (random.share() * path.len() as f64) as usize;
        let (a, b) = (pick(), pick());
        let (from, to) = (a.min(b), a.max(b));
        if from + 1 < to && to < path.len() && edges.is_clear(&path[from], &path[to])? {
            path.drain(from + 1..to);
        }
    }
    Ok(path)
}
