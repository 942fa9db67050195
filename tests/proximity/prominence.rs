//! Prominent contacts: which stay, by the ways between all triangles and by those on a finely
//! divided mesh; every wall stays on both sides of a fillet, a groove and a lumen; a label map's
//! are few.

use super::contacts::{Passes, small_mesh, small_robot};
use continuum_testing::narrow_phase::point_modified_cylinder;
use continuum_testing::{Random, rounds};
use mesh_files::{Options, from_bytes};
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::TriMesh;
use parry_continuum::proximity::{BvhSearch, Contact, Exhaustive, Proximity, ProximityError};
use parry_continuum::{Cap, Chain, ModifiedCylinder};
use std::collections::HashMap;
use std::time::{Duration, Instant};

fn contacts_within(
    engine: &mut impl Proximity,
    robot: &Chain,
    margin: f64,
    prominence: f64,
) -> Vec<Contact> {
    let mut out = Vec::new();
    engine.contacts_within(robot, &Pose::IDENTITY, margin, prominence, &mut out).unwrap();
    out
}

fn triangles_of(mesh: &TriMesh) -> Vec<[Vector; 3]> {
    mesh.indices().iter().map(|corners| corners.map(|i| mesh.vertices()[i as usize])).collect()
}

/// The contacts of one link with a margin and a prominence, and all that there are.
struct OfLink<'a> {
    all: Vec<&'a Contact>,
    kept: Vec<&'a Contact>,
    margin: f64,
    prominence: f64,
}

/// What the sample has seen.
#[derive(Debug, Default)]
struct Census {
    left_out: usize,
    kept: usize,
    by_height: usize,
    by_normal: usize,
    by_margin: usize,
}

impl OfLink<'_> {
    /// Each contact that is kept has no nearer one that is kept, with such a normal, behind a low
    /// pass; each that is left out has one. `pass` bounds the height of the pass between two
    /// contacts from below and above.
    fn judge(
        &self,
        tie: f64,
        pass: impl Fn(&Contact, &Contact) -> [f64; 2],
        census: &mut Census,
        text: &str,
    ) {
        let mut nearer: Vec<&Contact> = Vec::new();
        for contact in &self.all {
            let is_kept = self.kept.contains(contact);
            let below = contact.distance + self.prominence;
            let (mut may_stand_for_it, mut must_stand_for_it) = (false, None);
            for other in &nearer {
                let [low, high] = pass(contact, other);
                let cosine = match (contact.normal, other.normal) {
                    (Some(one), Some(other)) => one.dot(other),
                    _ => -1.0,
                };
                may_stand_for_it |= cosine >= 0.5 - 1e-9 && low < below + tie && low <= self.margin;
                if cosine >= 0.5 + 1e-9 && high < below - tie && high < self.margin - tie {
                    must_stand_for_it = Some((other, high));
                }
                census.by_height += usize::from(cosine >= 0.5 && low > below && low < self.margin);
                census.by_normal += usize::from(cosine < 0.5 && high < below && high < self.margin);
                census.by_margin += usize::from(cosine >= 0.5 && high < below && low > self.margin);
            }
            assert!(is_kept || may_stand_for_it, "{text}: nothing stands for {contact:?}");
            assert!(
                !is_kept || must_stand_for_it.is_none(),
                "{text}: {contact:?}, {must_stand_for_it:?} {below}"
            );
            if is_kept {
                nearer.push(contact);
            }
            *if is_kept { &mut census.kept } else { &mut census.left_out } += 1;
        }
        assert_eq!(nearer, self.kept, "{text}: not a choice of all contacts");
    }
}

/// Against the ways between all triangles.
#[test]
fn prominent_contacts_are_those_of_the_definition() {
    let mut census = Census::default();
    for seed in 0..rounds(400) {
        let random = &mut Random::new(seed);
        let (mesh, robot) = (small_mesh(random), small_robot(random));
        let triangles = triangles_of(&mesh);
        let margin = [0.3, 1.0, 4.0, f64::INFINITY][random.below(4) as usize];
        let prominence = [1e-300, 0.01, 0.1, 0.5, 5.0, f64::INFINITY][random.below(6) as usize];
        let mut search = BvhSearch::new(&mesh).unwrap();
        let all = contacts_within(&mut search, &robot, margin, 0.0);
        let kept = contacts_within(&mut search, &robot, margin, prominence);
        let (mut single, mut double) =
            (Exhaustive::<f32>::new(&mesh).unwrap(), Exhaustive::<f64>::new(&mesh).unwrap());
        assert_eq!(kept, contacts_within(&mut single, &robot, margin, prominence), "{seed}");
        assert_eq!(kept, contacts_within(&mut double, &robot, margin, prominence), "{seed}");
        for (number, link) in robot.links().iter().enumerate() {
            let of_link = |contacts: &'_ [Contact]| {
                contacts
                    .iter()
                    .filter(|contact| contact.link as usize == number)
                    .copied()
                    .collect::<Vec<_>>()
            };
            let (all, kept) = (of_link(&all), of_link(&kept));
            let passes = Passes::new(link, &triangles);
            let pass = |one: &Contact, other: &Contact| {
                [passes.heights[one.witness.triangle as usize][other.witness.triangle as usize]; 2]
            };
            let of_link = OfLink {
                all: all.iter().collect(),
                kept: kept.iter().collect(),
                margin,
                prominence,
            };
            of_link.judge(1e-13, pass, &mut census, &format!("{seed}"));
        }
    }
    let Census { left_out, kept, by_height, by_normal, by_margin } = census;
    assert!(left_out > rounds(200) && kept > rounds(1000), "{census:?}");
    assert!(
        by_height > rounds(50) && by_normal > rounds(50) && by_margin > rounds(20) / 10,
        "{census:?}"
    );
}

/// A mesh whose triangles are divided into `parts` x `parts` each. Paths along the edges of the
/// small triangles are paths on the mesh, and one is as low as the lowest path up to the length of
/// an edge.
struct FineMesh {
    /// How far each corner of a small triangle is from the link, and where it is.
    heights: Vec<f64>,
    points: Vec<Vector>,
    /// The corners of each triangle's small triangles.
    corners: Vec<Vec<usize>>,
    /// The edges, those first whose farther end is nearest.
    edges: Vec<[usize; 2]>,
    /// The longest edge.
    step: f64,
}

impl FineMesh {
    fn new(link: &ModifiedCylinder, triangles: &[[Vector; 3]], parts: usize) -> Self {
        let flat = link.caps().map(|cap| cap == Cap::Flat);
        let bits = |point: Vector| (point + Vector::ZERO).to_array().map(f64::to_bits);
        let mut known = HashMap::new();
        let mut fine = Self {
            heights: Vec::new(),
            points: Vec::new(),
            corners: Vec::new(),
            edges: Vec::new(),
            step: 0.0,
        };
        for (number, triangle) in triangles.iter().enumerate() {
            let mut rows: Vec<Vec<usize>> = Vec::new();
            for i in 0..=parts {
                let row = (0..=i).map(|j| {
                    let shares = [parts - i, i - j, j].map(|share| share as f64 / parts as f64);
                    let mut terms: Vec<_> =
                        triangle.iter().zip(shares).filter(|(_, share)| *share > 0.0).collect();
                    // The same sum in all triangles that share the corner or the edge. Where
                    // triangles cross they are not joined.
                    terms.sort_by_key(|(corner, _)| bits(**corner));
                    let point = terms
                        .iter()
                        .fold(Vector::ZERO, |sum, (corner, share)| sum + **corner * *share);
                    let mut of: Vec<_> = terms.iter().map(|(corner, _)| bits(**corner)).collect();
                    of.dedup();
                    // Not even those with the same corners are joined inside.
                    let inside = (of.len() == 3).then_some(number);
                    *known.entry((of, inside, bits(point))).or_insert_with(|| {
                        let [start, end] = [link.start(), link.end()].map(Into::into);
                        let away =
                            point_modified_cylinder(point.into(), start, end, link.radius(), flat);
                        fine.heights.push(away.distance);
                        fine.points.push(point);
                        fine.points.len() - 1
                    })
                });
                rows.push(row.collect());
            }
            for i in 1..=parts {
                for j in 0..i {
                    let [low, left, right] = [rows[i - 1][j], rows[i][j], rows[i][j + 1]];
                    fine.edges.extend([[low, left], [low, right], [left, right]]);
                }
            }
            let [a, b, c] = *triangle;
            let longest = (b - a).length().max((c - b).length()).max((a - c).length());
            fine.step = fine.step.max(longest / parts as f64);
            fine.corners.push(rows.concat());
        }
        let heights = &fine.heights;
        let height = |&[one, other]: &[usize; 2]| heights[one].max(heights[other]);
        fine.edges.sort_by(|one, other| height(one).total_cmp(&height(other)));
        fine
    }

    /// How high the lowest way between two contacts leads, at least and at most.
    fn pass(&self, one: &Contact, other: &Contact) -> [f64; 2] {
        let nearest = |contact: &Contact| {
            let away = |at: &usize| (self.points[*at] - contact.witness.on_mesh).length();
            let corners = self.corners[contact.witness.triangle as usize].iter().copied();
            corners.min_by(|one, other| away(one).total_cmp(&away(other))).unwrap()
        };
        let ends = [one, other].map(nearest);
        let mut piece: Vec<usize> = (0..self.points.len()).collect();
        let first_of = |piece: &mut Vec<usize>, mut at: usize| {
            while piece[at] != at {
                piece[at] = piece[piece[at]];
                at = piece[at];
            }
            at
        };
        let mut high = ends
            .map(|end| self.heights[end])
            .into_iter()
            .fold(one.distance.max(other.distance), f64::max);
        for &[from, to] in &self.edges {
            if first_of(&mut piece, ends[0]) == first_of(&mut piece, ends[1]) {
                return [high - self.step, high];
            }
            high = high.max(self.heights[from]).max(self.heights[to]);
            let (from, to) = (first_of(&mut piece, from), first_of(&mut piece, to));
            piece[from] = to;
        }
        if first_of(&mut piece, ends[0]) == first_of(&mut piece, ends[1]) {
            [high - self.step, high]
        } else {
            [f64::INFINITY; 2]
        }
    }
}

/// Against paths on a finely divided mesh: passes are tested at points alone.
#[test]
fn prominent_contacts_are_those_of_a_finely_divided_mesh() {
    let mut census = Census::default();
    for seed in 7000..7080 {
        let random = &mut Random::new(seed);
        let (mesh, robot) = (small_mesh(random), small_robot(random));
        let triangles = triangles_of(&mesh);
        let margin = [1.0, 4.0][random.below(2) as usize];
        let prominence = [0.05, 0.3, 1.0, f64::INFINITY][random.below(4) as usize];
        let mut search = BvhSearch::new(&mesh).unwrap();
        let (all, kept) = (
            contacts_within(&mut search, &robot, margin, 0.0),
            contacts_within(&mut search, &robot, margin, prominence),
        );
        for (number, link) in robot.links().iter().enumerate() {
            let of_link = |contacts: &'_ [Contact]| {
                contacts
                    .iter()
                    .filter(|contact| contact.link as usize == number)
                    .copied()
                    .collect::<Vec<_>>()
            };
            let (all, kept) = (of_link(&all), of_link(&kept));
            if all.len() < 2 {
                continue;
            }
            let fine = FineMesh::new(link, &triangles, 16);
            let of_link = OfLink {
                all: all.iter().collect(),
                kept: kept.iter().collect(),
                margin,
                prominence,
            };
            let pass = |one: &Contact, other: &Contact| fine.pass(one, other);
            of_link.judge(1e-12, pass, &mut census, &format!("{seed}"));
        }
    }
    let Census { left_out, kept, by_height, by_normal, .. } = census;
    assert!(left_out > 30 && kept > 150 && by_height > 10 && by_normal > 10, "{census:?}");
}

/// A wall over a profile of points (y, z) that is drawn along x, in steps of 0.2, with bumps of up
/// to `rough`.
fn drawn(profile: &[[f64; 2]], rough: f64) -> TriMesh {
    let random = &mut Random::new(11);
    let (rows, columns) = (60, profile.len() as u32);
    let mut vertices = Vec::new();
    for row in 0..rows {
        for point in profile {
            let along = (f64::from(row) - 0.5 * f64::from(rows - 1)) * 0.2;
            let bump =
                Vector::new(0.0, random.between(-rough, rough), random.between(-rough, rough));
            vertices.push(Vector::new(along, point[0], point[1]) + bump);
        }
    }
    let squares = (0..(rows - 1) * columns).filter(|i| (i + 1) % columns != 0);
    let indices =
        squares.flat_map(|i| [[i, i + 1, i + columns + 1], [i, i + columns + 1, i + columns]]);
    TriMesh::new(vertices, indices.collect()).unwrap()
}

/// Every contact has one that is kept within 60 degrees, and at most `most` are kept.
fn keeps_both_sides(mesh: &TriMesh, radius: f64, margin: f64, rough: f64, most: usize) {
    let ends = [Vector::new(-3.0, 0.0, 0.0), Vector::new(3.0, 0.0, 0.0)];
    for robot in [Chain::capsules(&ends, &[radius]), Chain::cylinders(&ends, &[radius])] {
        let robot = robot.unwrap();
        let mut search = BvhSearch::new(mesh).unwrap();
        let all = contacts_within(&mut search, &robot, margin, 0.0);
        for prominence in [2.0 * rough, 1.0, f64::INFINITY] {
            let kept = contacts_within(&mut search, &robot, margin, prominence);
            assert!(kept.len() <= most, "{} of {} at {prominence}", kept.len(), all.len());
            for contact in &all {
                let cosines =
                    kept.iter().map(|kept| kept.normal.unwrap().dot(contact.normal.unwrap()));
                let nearest = cosines.fold(-1.0, f64::max);
                assert!(nearest >= 0.5 - 1e-9, "{contact:?} at {prominence}: {kept:?}");
            }
            let sides = kept.iter().map(|contact| contact.normal.unwrap().y);
            let (low, high) =
                sides.fold((1.0_f64, -1.0_f64), |(low, high), y| (low.min(y), high.max(y)));
            assert!(low < -0.5 && high > 0.5, "one side is lost at {prominence}: {kept:?}");
        }
        assert!(all.len() > 4 * most, "{}: not rough", all.len());
    }
}

/// Two walls that meet at a right angle below the link.
#[test]
fn both_sides_of_a_groove_stay() {
    let profile: Vec<_> =
        (-15..=15).map(|k| f64::from(k) * 0.2).map(|y: f64| [y, y.abs() - 1.0]).collect();
    keeps_both_sides(&drawn(&profile, 0.03), 0.4, 1.0, 0.03, 3);
}

/// The same with a round bottom, so that normals turn steadily from one side to the other.
#[test]
fn both_sides_of_a_fillet_stay() {
    let radius: f64 = 0.8;
    // The link is above the centre of the bottom, so that the flanks are nearer than the bottom
    let centre = -0.2;
    let from = std::f64::consts::FRAC_PI_4;
    let bottom = (-8..=8).map(|k| f64::from(k) / 8.0 * from);
    let mut profile: Vec<_> =
        bottom.map(|turn: f64| [radius * turn.sin(), centre - radius * turn.cos()]).collect();
    for side in [-1.0, 1.0] {
        let [y, z] = [radius * from.sin(), centre - radius * from.cos()];
        let flank = (1..=8).map(|k| [side * (y + 0.15 * f64::from(k)), z + 0.15 * f64::from(k)]);
        profile.extend(flank);
    }
    profile.sort_by(|one, other| one[0].total_cmp(&other[0]));
    keeps_both_sides(&drawn(&profile, 0.03), 0.3, 1.0, 0.03, 4);
}

/// A lumen all around the link.
#[test]
fn all_sides_of_a_narrow_lumen_stay() {
    let turn = |k: u32| std::f64::consts::TAU * f64::from(k) / 24.0;
    let profile: Vec<_> = (0..=24).map(|k| [0.7 * turn(k).sin(), -0.7 * turn(k).cos()]).collect();
    keeps_both_sides(&drawn(&profile, 0.02), 0.4, 1.0, 0.02, 12);
}

/// A tube-like label map of voxels of 1 mm around a bent robot, as a file holds it.
fn label_map() -> TriMesh {
    let sizes = [26_usize, 26, 60];
    let mut file = format!(
        "NRRD0004\ntype: uchar\ndimension: 3\nspace: RAS\nsizes: {} {} {}\nencoding: raw\n\
         space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (-13,-13,-5)\n\n",
        sizes[0], sizes[1], sizes[2]
    )
    .into_bytes();
    for k in 0..sizes[2] {
        for j in 0..sizes[1] {
            for i in 0..sizes[0] {
                let [x, y, z] = [i as f64 - 13.0, j as f64 - 13.0, k as f64 - 5.0];
                let (bend, width) = (3.0 * (0.08 * z).sin(), 7.3 + 1.1 * (0.3 * z).sin());
                let is_inside = (x - bend).hypot(y) < width && (0.0..50.0).contains(&z);
                file.push(u8::from(is_inside));
            }
        }
    }
    let (vertices, triangles) =
        from_bytes("lumen.nrrd", &file, &Options::default()).unwrap().into_parts::<Vector>();
    TriMesh::new(vertices, triangles).unwrap()
}

/// With one voxel's size a label map gives a handful of contacts a link, and each wall has one of
/// them.
#[test]
fn a_label_map_gives_a_handful_a_link() {
    let mesh = label_map();
    let point = |z: f64| Vector::new(3.0 * (0.08 * z).sin() + 1.5, 0.7, z);
    let points: Vec<_> = (0..5).map(|k| point(4.0 + 10.0 * f64::from(k))).collect();
    let robot = Chain::from_centreline(&points, &[1.2, 1.2, 0.9, 0.9]).unwrap();
    let mut search = BvhSearch::new(&mesh).unwrap();
    for margin in [5.0, 8.0, 12.0] {
        let (all, kept) = (
            contacts_within(&mut search, &robot, margin, 0.0),
            contacts_within(&mut search, &robot, margin, 1.0),
        );
        let mut best = [Duration::MAX; 2];
        for round in 0..40 {
            let begin = Instant::now();
            contacts_within(&mut search, &robot, margin, f64::from(round % 2));
            best[round as usize % 2] = best[round as usize % 2].min(begin.elapsed());
        }
        println!(
            "margin {margin}: {} contacts with {} triangles, {} prominent, in {best:?}",
            all.len(),
            mesh.indices().len(),
            kept.len()
        );
        assert_eq!(
            kept,
            contacts_within(&mut Exhaustive::<f32>::new(&mesh).unwrap(), &robot, margin, 1.0)
        );
        for link in 0..4 {
            let of_link = |contacts: &'_ [Contact]| {
                contacts.iter().filter(|contact| contact.link == link).copied().collect::<Vec<_>>()
            };
            let (all, kept) = (of_link(&all), of_link(&kept));
            assert!(kept.len() <= 12, "{} of {} at {margin}", kept.len(), all.len());
            assert_eq!(all.first(), kept.first());
            for contact in &all {
                let stands_for_it = |kept: &Contact| {
                    kept.distance <= contact.distance
                        && kept.normal.unwrap().dot(contact.normal.unwrap()) >= 0.5 - 1e-9
                };
                assert!(kept.iter().any(stands_for_it), "{contact:?}");
            }
        }
        assert!(margin < 8.0 || all.len() > 6 * kept.len(), "{} {}", all.len(), kept.len());
    }
}

#[test]
fn a_prominence_is_a_number_of_at_least_0() {
    let mesh = drawn(&[[-1.0, 1.0], [1.0, 1.0]], 0.0);
    let robot = Chain::capsules(&[Vector::ZERO, Vector::X], &[0.5]).unwrap();
    let mut search = BvhSearch::new(&mesh).unwrap();
    let mut out = contacts_within(&mut search, &robot, 1.0, 0.0);
    assert_eq!(out.len(), 1);
    for prominence in [-1.0, f64::NAN, f64::NEG_INFINITY] {
        let error = search.contacts_within(&robot, &Pose::IDENTITY, 1.0, prominence, &mut out);
        assert!(
            matches!(error, Err(ProximityError::Negative { parameter: "prominence", .. })),
            "{prominence}: {error:?}"
        );
        assert!(out.is_empty());
    }
}

/// A funnel of very many triangles around one corner, with a link across it that is near to two
/// sides of its rim.
fn funnel(count: u32) -> TriMesh {
    let around = |k: u32| {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / f64::from(count)).sin_cos();
        Vector::new(2.0 * cos, 2.0 * sin, 0.2 * cos.abs())
    };
    let vertices = std::iter::once(-Vector::Z).chain((0..count).map(around)).collect();
    TriMesh::new(vertices, (0..count).map(|k| [0, 1 + k, 1 + (k + 1) % count]).collect()).unwrap()
}

/// With 16 times the triangles it takes less than 4 times as long as to ask 16 times.
#[test]
fn a_pass_of_very_many_triangles_is_asked_in_time() {
    let robot = Chain::capsules(&[Vector::new(-2.0, 0.0, 0.5), Vector::new(2.0, 0.0, 0.5)], &[0.1])
        .unwrap();
    let meshes = [(16, funnel(1_000)), (1, funnel(16_000))];
    let mut engines = meshes.map(|(times, mesh)| (times, BvhSearch::new(&mesh).unwrap()));
    let mut best = [Duration::MAX; 2];
    for round in 0..30 {
        if round >= 3 && best[1] < 4 * best[0] {
            break;
        }
        for ((times, search), best) in engines.iter_mut().zip(&mut best) {
            let begin = Instant::now();
            for _ in 0..*times {
                // The minima are 0.3 from the axis. The pass is beside the corner, at a side of the
                // funnel: at the distance r it is sqrt(r^2 + (1.5 - r / 2)^2) from
                // the axis, at least the root of 1.8.
                for (prominence, expected) in [(1.04, 2), (1.043, 1)] {
                    assert_eq!(
                        contacts_within(search, &robot, 3.0, prominence).len(),
                        expected,
                        "{prominence}"
                    );
                }
            }
            *best = (*best).min(begin.elapsed());
        }
    }
    assert!(best[1] < 4 * best[0], "{best:?}");
}

/// Pages that hang from one edge as in a book, half of them from below. The upper ones reach up to
/// 1 from it, at angles of up to 60 degrees with the vertical.
fn book(count: u32) -> TriMesh {
    let page = |k: u32| {
        let (sin, cos) = page_angle(k / 2, count / 2).sin_cos();
        let side = [1.0, -1.0][k as usize % 2];
        Vector::new(0.0, sin, cos) * side
    };
    let spine = [Vector::new(-4.0, 0.0, 0.0), Vector::new(4.0, 0.0, 0.0)];
    let vertices = spine.into_iter().chain((0..count).map(page)).collect();
    let turned = |k: u32| [[0, 1, 2 + k], [1, 2 + k, 0], [2 + k, 1, 0]][k as usize % 3];
    TriMesh::new(vertices, (0..count).map(turned).collect()).unwrap()
}

fn page_angle(page: u32, pages: u32) -> f64 {
    (f64::from(page) + 0.3) / f64::from(pages) * (2.0 * std::f64::consts::FRAC_PI_3)
        - std::f64::consts::FRAC_PI_3
}

/// Each page above is nearest at its tip, and the way from one to another leads over the edge,
/// which is nearest in its middle: its ends are beyond the margin. With 16 times the pages it takes
/// less than 4 times as long as to ask 16 times.
#[test]
fn very_many_pages_at_an_edge_are_as_prominent_as_they_are_high() {
    let robot =
        Chain::capsules(&[Vector::new(-0.2, 0.0, 2.5), Vector::new(0.2, 0.0, 2.5)], &[0.05])
            .unwrap();
    // How much higher the edge is than the tip of each page: 0.32 to 1.
    let rises = |pages: u32| {
        let rise = move |page: u32| {
            let (sin, cos) = page_angle(page, pages).sin_cos();
            2.5 - sin.hypot(2.5 - cos)
        };
        (0..pages).map(rise).collect::<Vec<_>>()
    };
    let expected = |rises: &[f64], margin: f64, prominence: f64| {
        assert!(rises.iter().all(|rise| (rise - prominence).abs() > 1e-9), "a tie");
        let is_kept = |rise: &&f64| **rise > prominence || margin < 2.45;
        // The nearest of all stays, however low it is.
        rises.iter().filter(is_kept).count().max(1)
    };
    let meshes =
        [(16, 1_000), (1, 16_000)].map(|(times, count)| (times, book(count), rises(count / 2)));
    let mut engines = meshes.map(|(times, mesh, rises)| {
        let engines = (BvhSearch::new(&mesh).unwrap(), Exhaustive::<f32>::new(&mesh).unwrap());
        (times, engines, rises)
    });
    let mut best = [Duration::MAX; 2];
    for round in 0..30 {
        if round >= 3 && best[1] < 4 * best[0] {
            break;
        }
        for ((times, (search, exhaustive), rises), best) in engines.iter_mut().zip(&mut best) {
            let begin = Instant::now();
            for time in 0..*times {
                for (margin, prominence) in
                    [(3.0, 0.1), (3.0, 0.55), (3.0, 0.9), (3.0, 2.0), (2.44, 2.0)]
                {
                    let expected = expected(rises, margin, prominence);
                    let found = contacts_within(search, &robot, margin, prominence);
                    assert_eq!(found.len(), expected, "{margin} {prominence}");
                    if time == 0 && round == 0 {
                        assert_eq!(found, contacts_within(exhaustive, &robot, margin, prominence));
                        let is_some = expected > 1 && expected < rises.len();
                        assert_eq!(is_some, matches!(prominence, 0.55 | 0.9), "{expected}");
                    }
                }
            }
            *best = (*best).min(begin.elapsed());
        }
    }
    assert!(best[1] < 4 * best[0], "{best:?}");
}
