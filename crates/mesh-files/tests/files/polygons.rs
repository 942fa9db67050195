//! A face of n corners becomes n - 2 triangles whose common boundary is its outline, in every
//! format. They cover what an outline without crossings encloses.

use crate::mutations::Draws;
use crate::{Vertex, ply_header, read};
use mesh_files::Mesh;
use std::collections::HashMap;
use std::f64::consts::TAU;

type Place = [i64; 2];

fn obj(corners: &[Vertex], face: &[usize]) -> String {
    let vertices: String = corners.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n")).collect();
    let face: Vec<_> = face.iter().map(|corner| (corner + 1).to_string()).collect();
    format!("{vertices}f {}\n", face.join(" "))
}

/// Asserts that the directed edges of the triangles add up to the outline.
fn assert_boundary(name: &str, mesh: &Mesh, face: &[usize]) {
    let mut sums: HashMap<(usize, usize), i64> = HashMap::new();
    let mut add = |a: usize, b: usize, sign: i64| {
        *sums.entry((a.min(b), a.max(b))).or_default() += if a < b { sign } else { -sign };
    };
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|corner| corner as usize);
        [(a, b), (b, c), (c, a)].into_iter().for_each(|(a, b)| add(a, b, 1));
    }
    let next = face.iter().cycle().skip(1);
    face.iter().zip(next).for_each(|(&a, &b)| add(a, b, -1));
    assert!(sums.values().all(|&sum| sum == 0), "{name}: {face:?}, {:?}", mesh.triangles);
}

/// The outline of a maze of thick paths: a random spanning tree of `size` by `size` rooms. It has
/// no crossings, and many corners on straight edges.
fn maze(size: usize, draws: &mut Draws) -> Vec<Place> {
    let mut filled = vec![vec![false; 2 * size + 1]; 2 * size + 1];
    let mut open = vec![[0_usize, 0]];
    filled[1][1] = true;
    while !open.is_empty() {
        let at = draws.below(open.len());
        let [x, y] = open[at];
        let ways = [[x + 1, y], [x.wrapping_sub(1), y], [x, y + 1], [x, y.wrapping_sub(1)]];
        let free = |[x, y]: &[usize; 2]| *x < size && *y < size && !filled[2 * x + 1][2 * y + 1];
        let ways: Vec<_> = ways.into_iter().filter(free).collect();
        if ways.is_empty() {
            open.swap_remove(at);
            continue;
        }
        let [u, v] = ways[draws.below(ways.len())];
        filled[2 * u + 1][2 * v + 1] = true;
        filled[x + u + 1][y + v + 1] = true;
        open.push([u, v]);
    }
    // Each side between a filled and an empty square, with the filled one on its left.
    let mut next = HashMap::new();
    for (x, y) in (1..2 * size).flat_map(|x| (1..2 * size).map(move |y| (x, y))) {
        if filled[x][y] {
            let is_empty = |x: usize, y: usize| !filled[x][y];
            let [a, b] = [x as i64, y as i64];
            let sides = [
                (is_empty(x, y - 1), [a, b], [a + 1, b]),
                (is_empty(x + 1, y), [a + 1, b], [a + 1, b + 1]),
                (is_empty(x, y + 1), [a + 1, b + 1], [a, b + 1]),
                (is_empty(x - 1, y), [a, b + 1], [a, b]),
            ];
            next.extend(sides.into_iter().filter(|side| side.0).map(|(_, a, b)| (a, b)));
        }
    }
    let mut outline = vec![[1, 1]];
    while outline.len() < next.len() {
        outline.push(next[&outline[outline.len() - 1]]);
    }
    assert_eq!(next[&outline[outline.len() - 1]], [1, 1]);
    outline
}

fn turn(a: Place, b: Place, c: Place) -> i64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn twice_area(outline: &[Place]) -> i64 {
    let next = outline.iter().cycle().skip(1);
    outline.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum()
}

/// A square with square holes, each reached by a bridge that is passed twice.
fn with_holes(count: i64) -> Vec<Place> {
    let mut outline = vec![[0, 0], [10 * count, 0], [10 * count, 10], [0, 10]];
    for hole in (0..count).rev() {
        let x = 10 * hole + 4;
        let around = [[x, 4], [x, 6], [x + 2, 6], [x + 2, 4], [x, 4]];
        // From a corner of the lower side to the hole, and back.
        let foot = [x, 0];
        let way: Vec<_> = [foot].into_iter().chain(around).chain([foot]).collect();
        outline.splice(1..1, way);
    }
    outline
}

/// Outlines without crossings, in integers: mazes with and without the corners on straight edges,
/// squares with holes, combs, spirals, and stars about a point.
fn outline(kind: usize, draws: &mut Draws) -> Vec<Place> {
    let mut drawn = |count: usize| draws.below(count) as i64;
    match kind {
        0 | 1 => {
            let size = 1 + draws.below(9);
            let whole = maze(size, draws);
            if kind == 0 {
                return whole;
            }
            let count = whole.len();
            let at = |i: usize| whole[i % count];
            let is_corner = |&i: &usize| turn(at(i + count - 1), at(i), at(i + 1)) != 0;
            (0..count).filter(is_corner).map(at).collect()
        }
        2 => with_holes(1 + drawn(5)),
        3 => {
            let teeth = 1 + drawn(20);
            let tip = |x: i64| [x, if x % 2 == 0 { 0 } else { 1000 }];
            let base = [[2 * teeth, -3], [0, -3]];
            (0..=2 * teeth).rev().map(tip).rev().chain(base).rev().collect::<Vec<_>>()
        }
        4 => {
            // Around by quarter turns, outwards along one wall and back along the other.
            let turns = 2 + drawn(12);
            let wall = |k: i64, width: i64| {
                let r = 3 * k + width;
                [[r, -r], [r, r], [-r, r], [-r, -r - 3]][(k % 4) as usize].map(|x| x + k % 4)
            };
            let out = (0..turns).map(|k| wall(k, 2));
            out.chain((0..turns).rev().map(|k| wall(k, 0))).collect()
        }
        _ => {
            let count = 4 + drawn(30) as usize;
            let mut ways: Vec<Place> =
                (0..count).map(|_| [drawn(200) - 100, drawn(200) - 100]).collect();
            ways.retain(|way| *way != [0, 0]);
            let angle = |way: &Place| (way[1] as f64).atan2(way[0] as f64);
            ways.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
            ways.dedup_by(|a, b| turn([0, 0], *a, *b) == 0);
            ways
        }
    }
}

#[test]
fn outlines_without_crossings_are_covered_once() {
    let mut draws = Draws(5);
    let (mut cut, mut straight, mut twice) = (0, 0, 0);
    for round in 0..600 {
        let outline = outline(round % 6, &mut draws);
        let area = twice_area(&outline);
        // A star may not contain its centre, and a spiral of few turns may cross itself.
        if outline.len() < 4 || area <= 0 || crosses(&outline) {
            continue;
        }
        // Repeated places are one vertex.
        let mut vertices: Vec<Place> = Vec::new();
        let mut face: Vec<usize> = Vec::new();
        for place in &outline {
            let known = vertices.iter().position(|own| own == place);
            face.push(known.unwrap_or_else(|| {
                vertices.push(*place);
                vertices.len() - 1
            }));
        }
        twice += usize::from(vertices.len() < face.len());
        let count = outline.len();
        let at = |i: usize| outline[i % count];
        straight += usize::from((0..count).any(|i| turn(at(i), at(i + 1), at(i + 2)) == 0));
        // Any first corner, direction, unit, place, and plane, upright ones among them.
        let first = draws.below(count);
        face.rotate_left(first);
        let is_back = draws.below(2) == 0;
        if is_back {
            face.reverse();
        }
        let scale = 2_f64.powi([-40, 0, 40][draws.below(3)]);
        let shift = [0, 1 << 20][draws.below(2)];
        let axes = [[0, 1, 2], [1, 2, 0], [2, 0, 1]][draws.below(3)];
        let lean = draws.below(3) as i64;
        let corners: Vec<Vertex> = vertices
            .iter()
            .map(|&[x, y]| {
                let place = [x + shift, y, lean * x];
                axes.map(|axis| scale * place[axis] as f64)
            })
            .collect();
        let name = format!("{round}");
        let mesh = read("a.obj", obj(&corners, &face)).unwrap();
        assert_boundary(&name, &mesh, &face);
        assert_eq!(mesh.skipped_faces, 0);
        // Triangles that name a vertex twice, at bridges, have no area and are left out.
        let repeated = 2 * (face.len() - vertices.len());
        assert!((count - 2 - repeated..=count - 2).contains(&mesh.triangles.len()), "{name}");
        let turns: Vec<_> = mesh
            .triangles
            .iter()
            .map(|triangle| {
                let [a, b, c] = triangle.map(|corner| vertices[corner as usize]);
                if is_back { turn(a, c, b) } else { turn(a, b, c) }
            })
            .collect();
        assert!(turns.iter().all(|&turn| turn >= 0), "{name}: {outline:?}");
        assert_eq!(turns.iter().sum::<i64>(), area, "{name}");
        cut += 1;
    }
    assert!(cut > 400 && straight > 100 && twice > 50, "{cut}, {straight}, {twice}");
}

/// Outlines that touch themselves in a corner: petals around one place, from any corner on.
#[test]
fn outlines_that_touch_themselves_are_covered_once() {
    let mut draws = Draws(12);
    let mut covered = 0;
    for round in 0..300 {
        let petals = 2 + draws.below(3);
        // All around, or within an angle that is convex at the place.
        let span = [1.0, 0.4][round % 2] * TAU;
        let mut outline: Vec<Place> = Vec::new();
        let mut face = Vec::new();
        let mut vertices: Vec<Place> = vec![[0, 0]];
        for petal in 0..petals {
            face.push(0);
            outline.push([0, 0]);
            // Corners of a wedge of the plane, counter-clockwise, some of them notches.
            for corner in 0..2 + draws.below(4) {
                let angle = (petal as f64 + 0.1 + 0.13 * corner as f64) / petals as f64 * span;
                let reach = 1000.0 + 4000.0 * draws.below(5) as f64;
                let place = [angle.cos(), angle.sin()].map(|x| (reach * x) as i64);
                face.push(vertices.len());
                vertices.push(place);
                outline.push(place);
            }
        }
        let area = twice_area(&outline);
        let name = format!("{round}: {outline:?}");
        for start in 0..face.len() {
            face.rotate_left(1);
            let corners: Vec<Vertex> =
                vertices.iter().map(|&[x, y]| [x as f64, y as f64, 0.0]).collect();
            let mesh = read("a.obj", obj(&corners, &face)).unwrap();
            let turns: Vec<_> = mesh
                .triangles
                .iter()
                .map(|triangle| {
                    let [a, b, c] = triangle.map(|corner| vertices[corner as usize]);
                    turn(a, b, c)
                })
                .collect();
            assert!(turns.iter().all(|&turn| turn >= 0), "{start} of {name}");
            assert_eq!(turns.iter().sum::<i64>(), area, "{start} of {name}");
            covered += 1;
        }
    }
    assert!(covered > 1000, "{covered}");
}

/// Returns whether two edges of an outline cross.
fn crosses(outline: &[Place]) -> bool {
    let count = outline.len();
    let edge = |i: usize| [outline[i], outline[(i + 1) % count]];
    let sign = |a, b, c| turn(a, b, c).signum();
    (0..count).any(|i| {
        (i + 1..count).any(|j| {
            let ([a, b], [c, d]) = (edge(i), edge(j));
            sign(a, b, c) * sign(a, b, d) < 0 && sign(c, d, a) * sign(c, d, b) < 0
        })
    })
}

#[test]
fn outlines_that_cross_themselves_keep_their_corners() {
    let mut draws = Draws(9);
    let mut crossed = 0;
    for round in 0..600 {
        let count = 4 + draws.below(if round % 2 == 0 { 1 } else { 9 });
        let drawn: Vec<Place> =
            (0..count).map(|_| [0, 1].map(|_| draws.below(40) as i64 - 20)).collect();
        // Flat, or with noise across the plane.
        let noise = [0, 0, 7][round % 3];
        let corners: Vec<Vertex> = drawn
            .iter()
            .map(|&[x, y]| [x as f64, y as f64, draws.below(noise + 1) as f64])
            .collect();
        let face: Vec<_> = (0..count).collect();
        let mesh = read("a.obj", obj(&corners, &face)).unwrap();
        assert_eq!(mesh.triangles.len(), count - 2, "{drawn:?}");
        assert_boundary(&format!("{round}"), &mesh, &face);
        crossed += usize::from(crosses(&drawn));
    }
    assert!(crossed > 200, "{crossed}");
}

/// The quadrilateral of a report: its sides cross, so one half of its fan lies on its back.
#[test]
fn both_halves_of_a_crossed_quadrilateral_are_kept_in_every_format() {
    let corners = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [1.0, 3.0, 0.0], [6.0, 3.0, 0.0]];
    let points = "0 0 0\n4 0 0\n1 3 0\n6 3 0\n";
    let vtk = |kind: &str, cells: &str| {
        format!(
            "# vtk DataFile Version 3.0\nx\nASCII\nDATASET {kind}\nPOINTS 4 float\n{points}{cells}"
        )
    };
    let ring = "4 0 1 2 3\n";
    let grid = |kind: &str, ring: &str| {
        vtk("UNSTRUCTURED_GRID", &format!("CELLS 1 5\n{ring}CELL_TYPES 1\n{kind}\n"))
    };
    let vtp = format!(
        "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"4\" NumberOfPolys=\"1\"><Points><DataArray \
         type=\"Float64\" NumberOfComponents=\"3\">{points}</DataArray></Points><Polys><DataArray type=\"Int64\" \
         Name=\"connectivity\">0 1 2 3</DataArray><DataArray type=\"Int64\" Name=\"offsets\">4</DataArray></Polys>\
         </Piece></PolyData></VTKFile>"
    );
    for (name, text) in [
        ("a.obj", obj(&corners, &[0, 1, 2, 3])),
        ("a.ply", ply_header(4, 1, "ascii", "float") + points + ring),
        #[cfg(feature = "centrelines")]
        ("a.vtk", vtk("POLYDATA", &format!("POLYGONS 1 5\n{ring}"))),
        // A quad, a polygon, and a pixel, whose corners are written row by row.
        #[cfg(feature = "centrelines")]
        ("a.vtk", grid("9", ring)),
        #[cfg(feature = "centrelines")]
        ("a.vtk", grid("7", ring)),
        #[cfg(feature = "centrelines")]
        ("a.vtk", grid("8", "4 0 1 3 2\n")),
        #[cfg(feature = "centrelines")]
        ("a.vtp", vtp),
    ] {
        let mesh = read(name, &text).unwrap();
        assert_eq!((mesh.triangles.len(), mesh.skipped_faces), (2, 0), "{text}");
        assert_boundary(name, &mesh, &[0, 1, 2, 3]);
    }
}
