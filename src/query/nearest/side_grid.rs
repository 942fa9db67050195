//! A coarse grid that guesses on which side of the wall a point lies. No answer depends on it.
//!
//! A robot with its base on one side and its tip on the other passes through the wall in between. A
//! query about a margin searches there first.
//!
//! # Algorithm
//! 1. Lay a grid of cells over the mesh and cut each triangle into pieces of less than a cell.
//! 2. For each piece, mark the cell of its centroid as wall. The cell in front of it (one cell's
//!    length along the normal) gets a vote of +1, the cell behind it one of -1.
//! 3. The sign of the votes is the side of a cell. Cells without votes take the side of their
//!    nearest neighbours, breadth first.
//! 4. To find a crossing, look up the base and the tip. If their sides differ, bisect the joints.

use crate::mesh::Mesh;
use crate::pair::PlacedRobot;
use parry3d_f64::math::{Real, Vector};

/// The most cells for each triangle, and the most cells along a side of the mesh. Both bound the
/// memory.
const CELLS_FOR_A_TRIANGLE: Real = 24.0;
const CELLS_ALONG_A_SIDE: Real = 62.0;
/// The least length of a cell, in typical edges. It limits the number of pieces of large triangles.
const CELL_BESIDE_AN_EDGE: Real = 0.5;
/// The longest edge of a piece, in cells. Then no point of a piece is farther than half a cell from
/// its centroid. So a wall between the centres of two neighbouring cells marks one of them.
const PIECE_BESIDE_A_CELL: Real = 0.75;
/// Samples about this many of the triangles that are far smaller than a cell, to limit the time.
const ENOUGH_TRIANGLES: usize = 1 << 17;
const FAR_SMALLER: Real = 0.25;
/// The grid is rebuilt once the box around the mesh has moved by more than this many cells.
const CELLS_MOVED: Real = 4.0;
/// How many joints are tried, from the tip on, to find one that is not close to the wall.
const JOINTS_AT_THE_TIP: usize = 4;

/// How many more triangles have the cell before them than behind them.
type Votes = i8;
/// Close to the wall, or in the outermost layer of the grid.
const WALL: Votes = Votes::MIN;
const MOST: Votes = Votes::MAX;

/// The sides of a mesh, as the mesh was when the grid was built.
#[derive(Clone)]
pub(crate) struct SideGrid {
    /// The box around the mesh.
    bounds: [Vector; 2],
    /// The corner of the grid. The outermost layer of cells is a sentinel: every other cell has six
    /// neighbours. The next layer is free of the mesh and stands for all points outside the grid.
    corner: Vector,
    /// Cells for a unit of length.
    inverse: Real,
    /// Cells along a side.
    count: usize,
    cells: Vec<Votes>,
}

impl SideGrid {
    /// The sides of a mesh with at least one triangle.
    pub(crate) fn new(mesh: &Mesh) -> Self {
        let bounds @ [low, high] = mesh.bounds();
        let side = (high - low).max_element();
        let every = mesh.len().div_ceil(ENOUGH_TRIANGLES);
        let few = || (0..mesh.len()).step_by(every).map(|triangle| mesh.corners(triangle as u32));
        let squared =
            few().map(|triangle| longest(triangle.map(|corner| (corner - low) / side)).powi(2));
        let typical = (squared.sum::<Real>() / few().len() as Real).sqrt();
        let finest =
            ((CELLS_FOR_A_TRIANGLE * mesh.len() as Real).cbrt() - 2.0).min(CELLS_ALONG_A_SIDE);
        // Without extent all quotients are NaN, and everything falls into the first cell.
        let inner = finest.min(1.0 / (CELL_BESIDE_AN_EDGE * typical)).max(1.0).floor();
        let count = inner as usize + 4;
        let mut sides = Self {
            bounds,
            corner: low - Vector::splat(2.0 * side / inner),
            inverse: inner / side,
            count,
            cells: vec![0; count.pow(3)],
        };
        for triangle in 0..mesh.len() {
            let [a, b, c] = sides.in_cells(mesh.corners(triangle as u32));
            let size = (a.max(b).max(c) - a.min(b).min(c)).max_element();
            if triangle % every == 0 || size >= FAR_SMALLER {
                sides.vote([a, b, c]);
            }
        }
        sides.fill_unknown();
        sides
    }

    /// Steps 1 and 2 for one triangle, in units of cells.
    fn vote(&mut self, [a, b, c]: [Vector; 3]) {
        let normal = (b - a).cross(c - a).normalize_or_zero();
        for centroid in centroids([a, b, c], self.count) {
            for (point, vote) in [(centroid + normal, 1), (centroid - normal, -1)] {
                let cell = self.cell(point);
                let votes = self.cells[cell];
                if votes != WALL {
                    self.cells[cell] = votes.saturating_add(vote).max(-MOST);
                }
            }
            let cell = self.cell(centroid);
            self.cells[cell] = WALL;
        }
    }

    /// Returns true if a mesh with this bounding box still lies about where the grid was built.
    pub(crate) fn covers(&self, bounds: [Vector; 2]) -> bool {
        let moved =
            |(now, then): (Vector, Vector)| ((now - then) * self.inverse).abs().max_element();
        bounds.into_iter().zip(self.bounds).map(moved).all(|cells| cells <= CELLS_MOVED)
    }

    /// Returns the middle of the links that seem to pass through the wall. None if base and tip are
    /// on one side.
    pub(crate) fn likely_crossing(&self, robot: PlacedRobot) -> Option<usize> {
        let links = robot.links();
        let at_joint = |joint: usize| self.side(robot.placed(links[joint].start()));
        let [base, mut tip] = robot.ends().map(|end| self.side(end));
        let mut last = links.len();
        while tip == 0 && last > 1 && links.len() - last < JOINTS_AT_THE_TIP {
            last -= 1;
            tip = at_joint(last);
        }
        if base * tip >= 0 {
            return None;
        }
        // Joints close to the wall are on an unknown side. Find where they begin and where they
        // end.
        let begin = first_joint([0, last], |joint| at_joint(joint) != base);
        let end = first_joint([begin - 1, last], |joint| at_joint(joint) == tip);
        Some((begin + end - 1) / 2)
    }

    /// 1 before the wall, -1 behind it, 0 close to it.
    #[inline(always)] // called for a few joints of each query
    fn side(&self, point: Vector) -> Votes {
        let [point] = self.in_cells([point]);
        let votes = self.cells[self.cell(point)];
        if votes == WALL { 0 } else { votes.signum() }
    }

    /// Converts to units of cells.
    fn in_cells<const N: usize>(&self, points: [Vector; N]) -> [Vector; N] {
        points.map(|point| (point - self.corner) * self.inverse)
    }

    /// The cell of a point in units of cells; for points outside, the nearest cell.
    fn cell(&self, point: Vector) -> usize {
        let [x, y, z] = point.to_array().map(|place| (place as usize).clamp(1, self.count - 2));
        x + self.count * (y + self.count * z)
    }

    /// Step 3: gives cells without votes the side of their nearest neighbours.
    fn fill_unknown(&mut self) {
        let Self { count, cells, .. } = self;
        let (across, last) = (*count * *count, *count - 1);
        for (one, other) in (0..*count).flat_map(|one| (0..*count).map(move |other| (one, other))) {
            let faces = [one + *count * other, one * *count + other * across, one + other * across];
            for (face, step) in faces.into_iter().zip([across, 1, *count]) {
                (cells[face], cells[face + last * step]) = (WALL, WALL);
            }
        }
        let mut known: Vec<_> =
            (0..cells.len()).filter(|&cell| ![0, WALL].contains(&cells[cell])).collect();
        let mut next = Vec::new();
        while !known.is_empty() {
            for &cell in &known {
                let side = cells[cell].signum();
                for step in [1, *count, across] {
                    for neighbour in [cell - step, cell + step] {
                        if cells[neighbour] == 0 {
                            cells[neighbour] = side;
                            next.push(neighbour);
                        }
                    }
                }
            }
            known.clear();
            std::mem::swap(&mut known, &mut next);
        }
    }
}

/// Bisects for the first joint in `low + 1..=high` at which `is_true` holds. Assumes that it holds
/// at `high`, and from its first joint on.
fn first_joint([mut low, mut high]: [usize; 2], is_true: impl Fn(usize) -> bool) -> usize {
    while high - low > 1 {
        let middle = (low + high) / 2;
        if is_true(middle) { high = middle } else { low = middle }
    }
    high
}

/// The longest edge of a triangle whose coordinates are of size one.
fn longest([a, b, c]: [Vector; 3]) -> Real {
    (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared()).sqrt()
}

/// The centroids of the pieces of a triangle, in units of cells.
fn centroids(triangle @ [a, b, c]: [Vector; 3], count: usize) -> impl Iterator<Item = Vector> {
    // No edge is longer than the diagonal of the grid.
    let pieces = ((longest(triangle) / PIECE_BESIDE_A_CELL).ceil() as usize).clamp(1, 3 * count);
    let [ab, ac] = [b - a, c - a].map(|edge| edge / pieces as Real);
    (0..pieces).flat_map(move |row| {
        (0..pieces - row).flat_map(move |place| {
            let corner = a + ab * row as Real + ac * place as Real;
            let upright = corner + (ab + ac) / 3.0;
            let upside_down = (row + place + 1 < pieces).then(|| corner + (ab + ac) / 1.5);
            std::iter::once(upright).chain(upside_down)
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::Chain;
    use parry3d_f64::math::Pose;
    use parry3d_f64::shape::Ball;

    const RADIUS: Real = 3.0;

    /// A ball, and the same without its poles.
    fn walls(size: Real) -> [Mesh; 2] {
        let (vertices, triangles) = Ball::new(RADIUS).to_trimesh(48, 24);
        let is_near_equator = |triangle: &[u32; 3]| {
            triangle.iter().all(|&corner| vertices[corner as usize].y.abs() < 0.8 * RADIUS)
        };
        let open = triangles.iter().copied().filter(is_near_equator).collect();
        let vertices: Vec<_> = vertices.iter().map(|&vertex| vertex * size).collect();
        [Mesh::of(vertices.clone(), triangles), Mesh::of(vertices, open)]
    }

    /// Points on both sides, all around.
    fn places() -> impl Iterator<Item = Vector> {
        let share = |k: u32, prime: u32| f64::from(k * prime % 1009) / 1009.0 * 2.0 - 1.0;
        (0..2000)
            .map(move |k| Vector::new(share(k, 17), share(k, 331), share(k, 593)) * (1.5 * RADIUS))
    }

    #[test]
    fn sides_are_seldom_mistaken_away_from_the_wall() {
        for (is_open, mesh) in [false, true].into_iter().zip(walls(1.0)) {
            let sides = SideGrid::new(&mesh);
            let (mut known, mut close, mut wrong) = (0, 0, 0);
            for point in places().filter(|point| !is_open || point.y.abs() < 0.5 * RADIUS) {
                let height = point.length() - RADIUS;
                match sides.side(point) {
                    0 => {
                        assert!(height.abs() * sides.inverse < 2.0, "{point}");
                        close += 1;
                    }
                    side => {
                        known += 1;
                        wrong += usize::from((side > 0) != (height > 0.0));
                    }
                }
            }
            assert!(known > 500 && close > 20, "{known} {close}");
            assert!(100 * wrong <= known, "{wrong} of {known}, open: {is_open}");
        }
    }

    /// Holds in any unit of length. In the last one squares underflow.
    #[test]
    fn a_robot_passes_through_the_wall_where_it_is_said_to() {
        for size in [1.0, 2.0_f64.powi(400), 2.0_f64.powi(-560)] {
            for mesh in walls(size) {
                let sides = SideGrid::new(&mesh);
                let (mut found, mut through) = (0, 0);
                for direction in
                    places().map(Vector::normalize).filter(|direction| direction.y.abs() < 0.7)
                {
                    let points: Vec<_> = (0..=20)
                        .map(|k| direction * (0.25 * RADIUS * size * f64::from(k) / 2.5))
                        .collect();
                    let pose = Pose::IDENTITY;
                    let robot = Chain::capsules(&points, &[0.01 * size; 20]).unwrap();
                    let outwards = PlacedRobot::new(&robot, &pose).unwrap();
                    through += 1;
                    // The tenth joint lies on the ball.
                    let link = sides.likely_crossing(outwards);
                    found += usize::from(link.is_some_and(|link| (9..=10).contains(&link)));
                    let inside = Chain::capsules(&points[..8], &[0.01 * size; 7]).unwrap();
                    assert_eq!(
                        sides.likely_crossing(PlacedRobot::new(&inside, &pose).unwrap()),
                        None
                    );
                }
                assert!(
                    through > 1000 && 10 * found >= 9 * through,
                    "{found} of {through}, {size:e}"
                );
            }
        }
    }

    #[test]
    fn no_mesh_is_too_small_or_too_flat() {
        let far = Vector::new(1.0e150, -1.0e150, 0.0);
        for corners in
            [[Vector::ONE; 3], [Vector::ZERO, Vector::X, Vector::X], [far, -far, Vector::ZERO]]
        {
            let sides = SideGrid::new(&Mesh::of(corners.to_vec(), vec![[0, 1, 2]]));
            let robot = Chain::capsules(&[Vector::ZERO, Vector::Y, far], &[0.1; 2]).unwrap();
            let pose = Pose::IDENTITY;
            assert!(
                sides
                    .likely_crossing(PlacedRobot::new(&robot, &pose).unwrap())
                    .is_none_or(|link| link < 2)
            );
        }
    }

    #[test]
    fn the_grid_follows_a_mesh_that_is_moved_away() {
        let sides = SideGrid::new(&walls(1.0)[0]);
        let cell = Vector::splat(1.0 / sides.inverse);
        let moved = |by: Vector| sides.bounds.map(|corner| corner + by);
        assert!(sides.covers(moved(cell * 3.0)) && !sides.covers(moved(cell * 5.0)));
        assert!(!sides.covers(sides.bounds.map(|corner| corner * 3.0)));
    }
}
