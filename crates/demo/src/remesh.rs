//! Well-shaped triangles: a closed surface coarsened to a number of triangles, and evened out on
//! the field it came from.
//!
//! Coarsening collapses the shortest edge again and again, if two conditions hold: the edge's ends
//! share exactly their two opposite vertices (the link condition, which keeps the topology), and no
//! triangle turns over or becomes a sliver. Between the rounds, edges
//! flip towards six neighbours per vertex and then towards the larger angles, and vertices slide
//! along the surface to the centroid of their neighbourhood (after Botsch and Kobbelt, A remeshing
//! approach to multiresolution modeling, 2004). Lengths are measured in units that shrink where the
//! surface bends, so that thin horns and passages keep their shape.

use crate::surface::{Field, Mesh, project, slope};
use parry_continuum::parry::math::{Real, Vector};
use rayon::prelude::*;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Where the radius of curvature is this, triangles are finer than on a plane by the square root of
/// two.
const DETAIL: Real = 4.0;

/// Distance over which curvature is measured.
const REACH: Real = 0.5;

/// A closed surface with, for each vertex, the triangles around it.
struct Surface<'a> {
    field: Field<'a>,
    step: Real,
    points: Vec<Vector>,
    /// How much finer than on a plane the triangles at each vertex are to be.
    fineness: Vec<Real>,
    /// A removed triangle has three equal corners.
    triangles: Vec<[u32; 3]>,
    around: Vec<Vec<u32>>,
    alive: usize,
}

/// The surface with about `target` triangles (never fewer), evened out. `step` is small against
/// every detail.
pub fn remesh(field: Field, (points, triangles): Mesh, target: usize, step: Real) -> Mesh {
    let mut around = vec![Vec::new(); points.len()];
    for (index, triangle) in triangles.iter().enumerate() {
        triangle.iter().for_each(|&corner| around[corner as usize].push(index as u32));
    }
    let alive = triangles.len();
    let fineness = vec![1.0; points.len()];
    let mut surface = Surface { field, step, points, fineness, triangles, around, alive };
    surface.slide(1);
    for round in 0..6 {
        surface.measure();
        surface.coarsen(target);
        surface.flip(if round < 4 { Surface::evens_neighbours } else { Surface::widens_angles });
        surface.slide(2);
    }
    for _ in 0..3 {
        surface.flip(Surface::widens_angles);
        surface.slide(1);
    }
    surface.compact()
}

impl Surface<'_> {
    fn point(&self, vertex: u32) -> Vector {
        self.points[vertex as usize]
    }

    fn valence(&self, vertex: u32) -> usize {
        self.around[vertex as usize].len()
    }

    /// Twice the triangle's area, along its outward normal.
    fn normal(&self, [a, b, c]: [u32; 3]) -> Vector {
        (self.point(b) - self.point(a)).cross(self.point(c) - self.point(a))
    }

    /// The corner of triangle `index` opposite its edge from a to b, if the triangle runs from a to
    /// b.
    fn opposite(&self, index: u32, a: u32, b: u32) -> Option<u32> {
        let [i, j, k] = self.triangles[index as usize];
        [(i, j, k), (j, k, i), (k, i, j)]
            .into_iter()
            .find(|&(p, q, _)| (p, q) == (a, b))
            .map(|(.., r)| r)
    }

    /// The two triangles at the edge, that from a to b first, each with its third corner.
    fn wings(&self, a: u32, b: u32) -> Option<[(u32, u32); 2]> {
        let find = |a, b| {
            let mut near = self.around[a as usize].iter();
            near.find_map(|&index| Some((index, self.opposite(index, a, b)?)))
        };
        Some([find(a, b)?, find(b, a)?])
    }

    /// The neighbours of a vertex: each triangle around it gives the corner that follows.
    fn neighbours(&self, vertex: u32) -> impl Iterator<Item = u32> + '_ {
        self.around[vertex as usize].iter().map(move |&index| {
            let [i, j, k] = self.triangles[index as usize];
            if i == vertex {
                j
            } else if j == vertex {
                k
            } else {
                i
            }
        })
    }

    fn edges(&self) -> Vec<[u32; 2]> {
        let sides = |&[a, b, c]: &[u32; 3]| [[a, b], [b, c], [c, a]];
        self.triangles.iter().flat_map(sides).filter(|[a, b]| a < b).collect()
    }

    /// The edge's length squared, in units of the wanted length.
    fn length(&self, [a, b]: [u32; 2]) -> Real {
        let fineness = self.fineness[a as usize].max(self.fineness[b as usize]);
        (self.point(a) - self.point(b)).length_squared() * fineness * fineness
    }

    /// Takes the fineness from the larger principal curvature: the normals' change over two
    /// directions across.
    fn measure(&mut self) {
        let normal = |p| slope(self.field, p, (self.field)(p), self.step).normalize_or_zero();
        let finer = |(&p, around): (&Vector, &Vec<u32>)| {
            if around.is_empty() {
                return 1.0;
            }
            let n = normal(p);
            let u = n.any_orthonormal_vector();
            let bend = [u, n.cross(u)].map(|along| (normal(p + along * REACH) - n) / REACH);
            let [xx, xy, yy] = [
                bend[0].dot(u),
                0.5 * (bend[0].dot(n.cross(u)) + bend[1].dot(u)),
                bend[1].dot(n.cross(u)),
            ];
            let curvature = (0.5 * (xx + yy)).abs() + (0.5 * (xx - yy)).hypot(xy);
            (DETAIL * curvature).hypot(1.0)
        };
        self.fineness = self.points.par_iter().zip(&self.around).map(finer).collect();
    }

    fn coarsen(&mut self, target: usize) {
        let key = |surface: &Self, edge: [u32; 2]| Reverse((surface.length(edge).to_bits(), edge));
        let mut queue: BinaryHeap<_> =
            self.edges().into_iter().map(|edge| key(self, edge)).collect();
        while self.alive >= target + 2
            && let Some(Reverse((bits, edge))) = queue.pop()
        {
            let is_current =
                self.length(edge).to_bits() == bits && self.wings(edge[0], edge[1]).is_some();
            if is_current && self.collapse(edge) {
                let kept = edge[0];
                queue.extend(
                    self.neighbours(kept)
                        .map(|other| key(self, [kept.min(other), kept.max(other)])),
                );
            }
        }
    }

    /// Merges b into a, if the surface survives it.
    fn collapse(&mut self, [a, b]: [u32; 2]) -> bool {
        let Some([(left, c), (right, d)]) = self.wings(a, b) else { return false };
        let shared = self.neighbours(a).filter(|&n| self.neighbours(b).any(|m| m == n)).count();
        let crowded = self.valence(a) + self.valence(b) > 4 + 8;
        if shared != 2 || crowded || self.valence(c) < 5 || self.valence(d) < 5 {
            return false;
        }
        let merged = project(self.field, self.point(a).midpoint(self.point(b)), self.step);
        let moved = |v: u32| if v == a || v == b { merged } else { self.point(v) };
        let stays_fair = |&index: &u32| {
            let triangle = self.triangles[index as usize];
            let [p, q, r] = triangle.map(moved);
            let (before, after) = (self.normal(triangle), (q - p).cross(r - p));
            let longest =
                [q - p, r - q, p - r].map(|e| e.length_squared()).into_iter().fold(0.0, Real::max);
            let turned = before.dot(after) < 0.3 * before.length() * after.length();
            !turned && after.length() > 0.25 * longest
        };
        let others = self.around[a as usize].iter().chain(&self.around[b as usize]);
        if !others.filter(|&&index| index != left && index != right).all(stays_fair) {
            return false;
        }
        for gone in [left, right] {
            for corner in std::mem::replace(&mut self.triangles[gone as usize], [a; 3]) {
                self.around[corner as usize].retain(|&index| index != gone);
            }
        }
        for index in std::mem::take(&mut self.around[b as usize]) {
            self.triangles[index as usize] =
                self.triangles[index as usize].map(|corner| if corner == b { a } else { corner });
            self.around[a as usize].push(index);
        }
        self.points[a as usize] = merged;
        self.fineness[a as usize] = self.fineness[a as usize].max(self.fineness[b as usize]);
        self.alive -= 2;
        true
    }

    /// Flips each edge that `improves` recommends and that may be flipped.
    fn flip(&mut self, improves: fn(&Self, [u32; 4]) -> bool) {
        for [a, b] in self.edges() {
            let Some([(left, c), (right, d)]) = self.wings(a, b) else { continue };
            let (one, two) = ([a, d, c], [d, b, c]);
            let outward = self.normal([a, b, c]).normalize_or_zero()
                + self.normal([b, a, d]).normalize_or_zero();
            let stays_flat = |t| self.normal(t).dot(outward) > 1.2 * self.normal(t).length();
            let spare = self.valence(a) > 4 && self.valence(b) > 4;
            let new = !self.neighbours(c).any(|n| n == d);
            if spare && new && stays_flat(one) && stays_flat(two) && improves(self, [a, b, c, d]) {
                self.triangles[left as usize] = one;
                self.triangles[right as usize] = two;
                self.around[a as usize].retain(|&index| index != right);
                self.around[b as usize].retain(|&index| index != left);
                self.around[c as usize].push(right);
                self.around[d as usize].push(left);
            }
        }
    }

    /// Whether the flip of a-b to c-d brings the numbers of neighbours closer to six.
    fn evens_neighbours(&self, [a, b, c, d]: [u32; 4]) -> bool {
        let off = |v: u32, change: i32| (self.valence(v) as i32 + change - 6).pow(2);
        let now = off(a, 0) + off(b, 0) + off(c, 0) + off(d, 0);
        off(a, -1) + off(b, -1) + off(c, 1) + off(d, 1) < now
            && self.smallest_angle([a, b, c, d]).1 > 0.35
    }

    /// Whether the flip of a-b to c-d widens the smallest angle.
    fn widens_angles(&self, corners: [u32; 4]) -> bool {
        let (before, after) = self.smallest_angle(corners);
        after > before
    }

    /// The smallest angle of the two triangles before and after the flip of a-b to c-d.
    fn smallest_angle(&self, [a, b, c, d]: [u32; 4]) -> (Real, Real) {
        let least = |t: [u32; 3]| {
            let [p, q, r] = t.map(|v| self.point(v));
            [
                (q - p).angle_between(r - p),
                (r - q).angle_between(p - q),
                (p - r).angle_between(q - r),
            ]
            .into_iter()
            .fold(Real::INFINITY, Real::min)
        };
        (least([a, b, c]).min(least([b, a, d])), least([a, d, c]).min(least([d, b, c])))
    }

    /// Slides each vertex along the surface towards the weighted centroid of the triangles around
    /// it.
    fn slide(&mut self, rounds: usize) {
        for _ in 0..rounds {
            let moved = |(vertex, around): (usize, &Vec<u32>)| {
                let p = self.points[vertex];
                let (mut sum, mut weight) = (Vector::ZERO, 0.0);
                for &index in around {
                    let triangle = self.triangles[index as usize];
                    let fineness =
                        triangle.map(|v| self.fineness[v as usize]).into_iter().sum::<Real>() / 3.0;
                    let share = self.normal(triangle).length() * fineness * fineness;
                    sum +=
                        triangle.map(|v| self.point(v)).into_iter().sum::<Vector>() * (share / 3.0);
                    weight += share;
                }
                if weight == 0.0 {
                    return p;
                }
                let normal = slope(self.field, p, (self.field)(p), self.step).normalize_or_zero();
                let pull = sum / weight - p;
                project(self.field, p + (pull - normal * pull.dot(normal)) * 0.8, self.step)
            };
            self.points = self.around.par_iter().enumerate().map(moved).collect();
        }
    }

    /// The surface without its removed vertices and triangles.
    fn compact(self) -> Mesh {
        let mut number = vec![u32::MAX; self.points.len()];
        let mut points = Vec::new();
        let mut triangles = Vec::with_capacity(self.alive);
        for triangle in self.triangles {
            if triangle[0] != triangle[1] {
                triangles.push(triangle.map(|corner| {
                    let place = &mut number[corner as usize];
                    if *place == u32::MAX {
                        *place = points.len() as u32;
                        points.push(self.points[corner as usize]);
                    }
                    *place
                }));
            }
        }
        (points, triangles)
    }
}
