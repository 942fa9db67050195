//! The scene of the examples is what it says: a closed ventricle with a robot that fits, meshes read as they were
//! written, pictures that show caps as they are queried, and programs whose errors are one line.

#[path = "../examples/scene/mod.rs"]
mod scene;

use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::query::{Ray, RayCast};
use parry_continuum::parry::shape::{SharedShape, TriMesh};
use parry_continuum::proximity::{BvhSearch, Proximity};
use parry_continuum::{Chain, ModifiedCylinder};
use scene::canvas::Canvas;
use scene::colour_map::ColourMap;
use scene::ctr::three_tubes;
use scene::picture::{Camera, Picture, Solid};
use scene::surface::Mesh;
use scene::{lettering, mesh_file, steer, ventricle};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// The default ventricle, grown once for all tests.
fn small() -> &'static Mesh {
    static MESH: OnceLock<Mesh> = OnceLock::new();
    MESH.get_or_init(|| ventricle::mesh(ventricle::DEFAULT_TRIANGLES))
}

/// Asserts that a mesh is one closed surface: every edge has exactly two triangles, which run along
/// it in opposite directions, those around a vertex form one ring, and Euler's characteristic is as given: 2 for a
/// surface without handles, 0 for a ring.
fn assert_closed(points: &[Vector], triangles: &[[u32; 3]], euler: i64) {
    let mut edges = BTreeSet::new();
    let mut next = vec![BTreeMap::new(); points.len()];
    for &[a, b, c] in triangles {
        for (a, b, c) in [(a, b, c), (b, c, a), (c, a, b)] {
            assert!(edges.insert((a, b)), "two triangles run from {a} to {b}");
            next[a as usize].insert(b, c);
        }
    }
    assert!(edges.iter().all(|&(a, b)| edges.contains(&(b, a))), "an edge has one triangle");
    for ring in &next {
        let (&first, _) = ring.first_key_value().expect("a vertex without a triangle");
        let (mut at, mut count) = (ring[&first], 1);
        while at != first {
            (at, count) = (ring[&at], count + 1);
        }
        assert_eq!(count, ring.len(), "the triangles around a vertex form more than one ring");
    }
    let mut reached = vec![false; points.len()];
    let mut stack = vec![0];
    while let Some(at) = stack.pop() {
        if !std::mem::replace(&mut reached[at as usize], true) {
            stack.extend(next[at as usize].keys());
        }
    }
    assert!(reached.iter().all(|&is| is), "more than one part");
    let (v, e, f) = (points.len() as i64, edges.len() as i64 / 2, triangles.len() as i64);
    assert_eq!(v - e + f, euler);
}

fn volume((points, triangles): &Mesh) -> Real {
    let corner = |t: &[u32; 3]| t.map(|i| points[i as usize]);
    triangles.iter().map(corner).map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum()
}

fn smallest_angle([a, b, c]: [Vector; 3]) -> Real {
    [(b - a).angle_between(c - a), (c - b).angle_between(a - b), (a - c).angle_between(b - c)]
        .into_iter()
        .fold(Real::INFINITY, Real::min)
        .to_degrees()
}

#[test]
fn ventricle_is_closed_oriented_and_of_well_shaped_triangles_at_any_size() {
    let field = ventricle::Ventricle::grow();
    for wanted in [ventricle::DEFAULT_TRIANGLES, 50_000] {
        let mesh = if wanted == small().1.len() { small().clone() } else { ventricle::mesh(wanted) };
        let (points, triangles) = &mesh;
        assert!(triangles.len().abs_diff(wanted) <= wanted / 1000, "{} of {wanted}", triangles.len());
        assert_closed(points, triangles, 2);
        // Outward normals make the volume positive; an adult's ventricles hold 20 to 50 ml.
        assert!((20e3..50e3).contains(&volume(&mesh)), "{} ml", volume(&mesh) / 1e3);
        let low = points.iter().copied().reduce(Vector::min).unwrap();
        let size = points.iter().copied().reduce(Vector::max).unwrap() - low;
        assert!((size - Vector::new(80.0, 90.0, 90.0)).abs().max_element() < 12.0, "{size} mm");
        assert!(points.iter().all(|&p| field.value(p).abs() < 1e-3));

        let mut angles: Vec<_> =
            triangles.iter().map(|t| smallest_angle(t.map(|i| points[i as usize]))).collect();
        angles.sort_by(Real::total_cmp);
        assert!(
            angles[0] > 15.0 && angles[angles.len() / 2] > 45.0,
            "{} {}",
            angles[0],
            angles[angles.len() / 2]
        );
    }
}

#[test]
fn coarsening_stops_before_it_closes_a_ring() {
    // So thin that the last collapses allowed by shape alone would pinch it.
    let ring = |p: Vector| (p.x.hypot(p.y) - 5.0).hypot(p.z) - 1.0;
    let fine = scene::surface::extract(&ring, Vector::splat(-7.0), Vector::splat(7.0), 0.35);
    assert_closed(&fine.0, &fine.1, 0);
    for target in [1000, 300, 100, 0] {
        let (points, triangles) = scene::remesh::remesh(&ring, fine.clone(), target, 1e-4);
        assert_closed(&points, &triangles, 0);
        assert!(triangles.len() >= target && triangles.len() < target.max(100) + 100, "{}", triangles.len());
    }
}

#[test]
fn default_robot_starts_inside_a_burr_hole_and_keeps_clear_all_the_way() {
    let (points, triangles) = small().clone();
    let mesh = TriMesh::new(points, triangles).unwrap();
    let (base, robot, goal) = (ventricle::entry(), three_tubes(), ventricle::goal());
    assert!(steer::is_inside(&mesh, base.translation));
    let back = Ray::new(base.translation, base.rotation * -Vector::Z);
    let depth = mesh.cast_local_ray(&back, 100.0, false).unwrap();
    assert!((depth - 3.0).abs() < 0.2, "the base is {depth} mm from the roof");

    let mut search = BvhSearch::new(&mesh).unwrap();
    let whole: Vec<Real> = (0..=40).map(|k| robot.length(&goal) * Real::from(k) / 40.0).collect();
    let shape = robot.frames(&goal, &whole);
    for step in 1..=40 {
        let joints = robot.on_the_way(&goal, Real::from(step) / 40.0);
        let out = &whole[..=step as usize];
        assert!((robot.length(&joints) - out[out.len() - 1]).abs() < 1e-12);
        for (frame, settled) in robot.frames(&joints, out).iter().zip(&shape) {
            // The wire's nominal curvature of 1e-9 / mm is all that differs.
            assert!((frame.translation - settled.translation).length() < 1e-6);
        }
        let line = robot.centreline(&joints, 30);
        let chain = Chain::from_centreline(&line.points, &line.radii).unwrap();
        let clearance = search.minimum(&chain, &base).unwrap().distance;
        assert!(clearance > 1.0, "{clearance} mm at step {step}");
    }
    let tip = base * shape[40].translation;
    assert!((tip - Vector::new(0.0, -15.0, -5.0)).length() < 2.0, "{tip} is not the mouth of the aqueduct");
}

/// A ball of about the given radius: an octahedron, cut finer three times.
fn ball(radius: Real) -> TriMesh {
    let field = |p: Vector| p.length() - radius;
    let axes = [Vector::X, Vector::Y, Vector::Z];
    let points = axes.iter().flat_map(|&axis| [axis * radius, -axis * radius]).collect();
    let octants = (0..8u32).map(|k| {
        let [x, y, z] = [k & 1, 2 + (k >> 1 & 1), 4 + (k >> 2)];
        if k.count_ones() % 2 == 0 { [x, y, z] } else { [x, z, y] }
    });
    let mut mesh: Mesh = (points, octants.collect());
    for _ in 0..3 {
        mesh = scene::surface::subdivide(&field, mesh, 1e-6 * radius);
    }
    assert_closed(&mesh.0, &mesh.1, 2);
    assert!(volume(&mesh) > 0.0);
    TriMesh::new(mesh.0, mesh.1).unwrap()
}

#[test]
fn a_start_and_a_goal_are_found_in_an_unknown_mesh() {
    let room = ball(60.0);
    let start = steer::deepest_point(&room).unwrap();
    assert!(start.length() < 3.0, "{start}");
    assert!(steer::is_inside(&room, start) && !steer::is_inside(&room, Vector::X * 61.0));
    assert!(steer::clear_direction(&room, Vector::X * 50.0).dot(-Vector::X) > 0.97);

    // There is room for the longest shape whose way in is exact: the second section and the third.
    let robot = three_tubes();
    let mut search = BvhSearch::new(&room).unwrap();
    let base = Pose::from_translation(start);
    let goal = steer::find_goal(&robot, &mut search, &base).unwrap();
    let line = robot.centreline(&goal, 30);
    let chain = Chain::capsules(&line.points, &line.radii).unwrap();
    let clearance = search.minimum(&chain, &base).unwrap().distance;
    assert!(clearance > 0.5 && robot.length(&goal) > 76.0, "{clearance} {}", robot.length(&goal));
    assert!(goal.extensions[0] + goal.extensions[1] <= 66.7 + 1e-12);

    let mut cramped = BvhSearch::new(&ball(2.0)).unwrap();
    assert!(matches!(steer::find_goal(&robot, &mut cramped, &Pose::IDENTITY), Err(steer::NoGoal::NoRoom)));
    let sheet = TriMesh::new(vec![Vector::ZERO, Vector::X, Vector::Y], vec![[0, 1, 2]]).unwrap();
    assert_eq!(steer::deepest_point(&sheet), None);
    // Below a ball, the sheet makes the number of crossings odd: no telling what is inside.
    let (mut points, mut triangles) = (room.vertices().to_vec(), room.indices().to_vec());
    let last = points.len() as u32;
    points.extend([[-500.0, -300.0], [500.0, -300.0], [0.0, 800.0]].map(|[x, y]| Vector::new(x, y, -400.0)));
    triangles.push([last, last + 1, last + 2]);
    let deepest = steer::deepest_point(&TriMesh::new(points, triangles).unwrap());
    assert!(deepest.is_none_or(|p| p.length() < 60.0), "{deepest:?}");
}

/// A file with the given bytes, in a directory of this test's own.
fn file(name: &str, bytes: &[u8]) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::write(&path, bytes).unwrap();
    path
}

fn binary_stl((points, triangles): &Mesh) -> Vec<u8> {
    let vertex = |i: u32| stl_io::Vertex::new(points[i as usize].to_array().map(|x| x as f32));
    let facet =
        |t: &[u32; 3]| stl_io::Triangle { normal: stl_io::Normal::new([0.0; 3]), vertices: t.map(vertex) };
    let facets: Vec<_> = triangles.iter().map(facet).collect();
    let mut bytes = Vec::new();
    stl_io::write_stl(&mut bytes, facets.iter()).unwrap();
    bytes
}

/// The mesh as text: a line for each vertex and one for each triangle.
fn lines(mesh: &Mesh, vertex: impl Fn(Vector) -> String, face: impl Fn([u32; 3]) -> String) -> String {
    mesh.0.iter().map(|&p| vertex(p)).chain(mesh.1.iter().map(|&t| face(t))).collect()
}

fn ply_header(mesh: &Mesh, format: &str, number: &str) -> String {
    format!(
        "ply\nformat {format} 1.0\nelement vertex {}\nproperty {number} x\nproperty {number} y\nproperty {number} z\n\
         element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        mesh.0.len(),
        mesh.1.len()
    )
}

#[test]
fn meshes_are_read_as_they_were_written() {
    let mesh = small();
    let mut solid = binary_stl(mesh);
    // A binary file may call itself solid, and an ASCII file may leave its solid without a name.
    solid[..16].copy_from_slice(b"solid of bytes \n");
    let facets: String = mesh
        .1
        .iter()
        .map(|t| {
            let corners: String = t
                .iter()
                .map(|&i| mesh.0[i as usize])
                .map(|p| format!("vertex {:e} {:e} {:e}\n", p.x as f32, p.y as f32, p.z as f32))
                .collect();
            format!("facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n")
        })
        .collect();
    let obj = lines(
        mesh,
        |p| format!("v {} {} {}\n", p.x, p.y, p.z),
        |[a, b, c]| format!("f {} {} {}\n", a + 1, b + 1, c + 1),
    );
    let ply = lines(mesh, |p| format!("{} {} {}\n", p.x, p.y, p.z), |[a, b, c]| format!("3 {a} {b} {c}\n"));
    let mut packed = ply_header(mesh, "binary_little_endian", "float").into_bytes();
    mesh.0.iter().flat_map(|p| p.to_array()).for_each(|x| packed.extend((x as f32).to_le_bytes()));
    for triangle in &mesh.1 {
        packed.push(3);
        triangle.iter().for_each(|corner| packed.extend(corner.to_le_bytes()));
    }

    let single = 40.0 * Real::from(f32::EPSILON);
    for (name, bytes, tolerance) in [
        ("read.stl", binary_stl(mesh), single),
        ("solid.STL", solid, single),
        ("ascii.stl", format!("solid\n{facets}endsolid\n").into_bytes(), single),
        ("read.obj", obj.into_bytes(), single),
        ("ascii.ply", (ply_header(mesh, "ascii", "double") + &ply).into_bytes(), 0.0),
        ("binary.ply", packed, single),
    ] {
        for scale in [1.0, 1000.0] {
            let (points, triangles) = mesh_file::load(&file(name, &bytes), scale).unwrap();
            assert_closed(&points, &triangles, 2);
            assert_eq!((points.len(), triangles.len()), (mesh.0.len(), mesh.1.len()), "{name}");
            for (read, written) in triangles.iter().zip(&mesh.1) {
                for corner in 0..3 {
                    let (p, q) = (points[read[corner] as usize], mesh.0[written[corner] as usize] * scale);
                    assert!((p - q).abs().max_element() <= tolerance * scale, "{name}: {p} for {q}");
                }
            }
        }
    }
}

#[test]
fn polygons_are_cut_and_objects_joined() {
    let quad = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
    let (_, triangles) = mesh_file::load(&file("quad.obj", quad), 1.0).unwrap();
    assert_eq!(triangles, [[0, 1, 2], [0, 2, 3]]);
    let two = b"o one\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no two\nv 0 0 9\nv 1 0 9\nv 0 1 9\nf 4 5 6\n";
    let (points, triangles) = mesh_file::load(&file("two.obj", two), 1.0).unwrap();
    assert_eq!(triangles.len(), 2);
    assert!(triangles[0].iter().all(|&i| points[i as usize].z == 0.0));
    assert!(triangles[1].iter().all(|&i| points[i as usize].z == 9.0));
    let mesh = (vec![Vector::ZERO; 5], vec![[0; 3]]);
    let text = ply_header(&mesh, "ascii", "float") + &"0 0 0\n".repeat(5) + "5 0 1 2 3 4\n";
    let (_, triangles) = mesh_file::load(&file("pentagon.ply", text.as_bytes()), 1.0).unwrap();
    assert_eq!(triangles, [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
}

#[test]
fn every_error_of_a_mesh_file_is_one_line_that_says_what_to_do() {
    let mesh = small();
    let cut = binary_stl(mesh)[..10_000].to_vec();
    let mut nan = binary_stl(mesh);
    nan[96..100].copy_from_slice(&f32::NAN.to_le_bytes());
    let triangle = (vec![Vector::ZERO; 3], vec![[0; 3]]);
    let ply = |faces: &str| {
        let text = ply_header(&triangle, "ascii", "float") + "0 0 0\n1 0 0\n0 1 0\n" + faces;
        text.into_bytes()
    };
    let mut packed = ply_header(&triangle, "binary_big_endian", "double").into_bytes();
    [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, Real::NAN, 0.0].iter().for_each(|x| packed.extend(x.to_be_bytes()));
    packed.extend([3, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 2]);
    let huge =
        ply_header(&triangle, "binary_little_endian", "float").replace("vertex 3", "vertex 99999999999");
    for (name, bytes, scale, expected) in [
        ("a.xyz", vec![], 1.0, "ends in .stl, .obj or .ply"),
        ("empty.stl", vec![], 1.0, "export it again"),
        ("cut.stl", cut, 1.0, "export it again"),
        ("none.stl", vec![0; 84], 1.0, "no triangles"),
        ("nan.stl", nan, 1.0, "repair that vertex"),
        ("text.stl", b"solid x\nfacet normal\n".to_vec(), 1.0, "export it again"),
        ("points.obj", b"v 0 0 0\nv 1 0 0\n".to_vec(), 1.0, "no triangles"),
        ("beyond.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n".to_vec(), 1.0, "export it again"),
        ("word.obj", b"v 0 zero 0\n".to_vec(), 1.0, "export it again"),
        ("nan.obj", b"v 0 nan 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".to_vec(), 1.0, "repair that vertex"),
        ("beyond.ply", ply("3 0 1 3\n"), 1.0, "names vertex 3, but there are 3"),
        ("negative.ply", ply("3 0 1 -1\n"), 1.0, "export it again"),
        ("missing.ply", ply(""), 1.0, "export it again"),
        ("huge.ply", huge.into_bytes(), 1.0, "export it again"),
        ("nan.ply", packed, 1.0, "repair that vertex"),
        ("scale.ply", ply("3 0 1 2\n"), 0.0, "give a positive number"),
        ("nan-scale.ply", ply("3 0 1 2\n"), Real::NAN, "give a positive number"),
        ("far.ply", ply("3 0 1 2\n"), 1e300, ""),
    ] {
        let result = mesh_file::load(&file(name, &bytes), scale);
        if expected.is_empty() {
            assert!(result.is_ok(), "{name}: {result:?}");
            continue;
        }
        let message = result.expect_err(name);
        assert!(message.contains(expected) && !message.contains('\n'), "{name}: {message}");
    }
    let message = mesh_file::load(Path::new("nowhere/brain.stl"), 1.0).unwrap_err();
    assert!(message.contains("nowhere/brain.stl") && message.contains("check the path"), "{message}");
}

/// How much of a picture differs from its first pixel.
fn covered(canvas: &Canvas) -> Real {
    let backdrop = canvas.pixels[0];
    canvas.pixels.iter().filter(|&&pixel| pixel != backdrop).count() as Real
}

#[test]
fn pictures_show_caps_as_they_are_queried() {
    let (start, end, radius) = (Vector::ZERO, Vector::X * 4.0, 1.0);
    let seen = |link: ModifiedCylinder| {
        let solid = Solid::new(SharedShape::new(link), Pose::IDENTITY, [0.2, 0.3, 0.4], false);
        let mut picture = Picture::new(None, vec![solid]);
        picture.sky = [[1.0; 3]; 2];
        // From far away the outline is that of a parallel projection.
        let far = Vector::new(2.0, 0.0, 4000.0);
        let camera = Camera {
            eye: far,
            forward: -Vector::Z,
            up: Vector::Y,
            right: Vector::X,
            spread: 5.0 / 4000.0,
            cut: 0.0,
        };
        covered(&picture.render(&camera, 400, 400)) / 1600.0
    };
    let flat = seen(ModifiedCylinder::cylinder(start, end, radius).unwrap());
    let round = seen(ModifiedCylinder::capsule(start, end, radius).unwrap());
    // 40 pixels to a unit: an outline pixel is a fortieth of a unit wide.
    assert!((flat - 8.0).abs() < 0.3, "{flat}");
    assert!((round - flat - std::f64::consts::PI).abs() < 0.2, "{}", round - flat);
}

#[test]
fn every_letter_can_be_drawn_and_every_scale_has_numbers() {
    for letter in ('a'..='z').chain('A'..='Z').chain('0'..='9').chain(".,:-+=<>/()%*".chars()) {
        let (strokes, width) = lettering::strokes(&letter.to_string(), 7.0);
        assert!(!strokes.is_empty() && strokes.iter().all(|s| s.len() > 1) && width < 8.0, "{letter}");
    }
    for largest in [1e-6, 0.03, 0.99, 1.0, 3.9, 4.1, 77.0, 12345.0] {
        let map = ColourMap::up_to(largest);
        assert!((1.0 - 1e-9..1.5).contains(&(map.end / largest)), "{} for {largest}", map.end);
    }
}

/// Runs an example program as a user does, in a directory of this test's own.
fn program(name: &str, arguments: &[&str]) -> (bool, String, String) {
    static BUILT: OnceLock<PathBuf> = OnceLock::new();
    let directory = BUILT.get_or_init(|| {
        let mut build = Command::new(env!("CARGO"));
        build.args(["build", "--quiet", "--example", "ventricle", "--example", "figure7"]);
        assert!(build.current_dir(env!("CARGO_MANIFEST_DIR")).status().unwrap().success());
        // This test is target/debug/deps/scene-..; examples are in target/debug/examples.
        std::env::current_exe().unwrap().ancestors().nth(2).unwrap().join("examples")
    });
    let output = Command::new(directory.join(name))
        .args(arguments)
        .current_dir(env!("CARGO_TARGET_TMPDIR"))
        .output()
        .unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.success(), text(output.stdout), text(output.stderr))
}

#[test]
fn programs_answer_bad_input_with_one_line_and_an_error_code() {
    let empty = file("hollow.stl", &[0; 84]);
    let empty = empty.to_str().unwrap();
    for (arguments, expected) in [
        (&["--mesh", "nowhere.stl"][..], "check the path"),
        (&["--mesh", empty], "no triangles"),
        (&["--mesh", empty, "--scale", "-1"], "positive number"),
        (&["--triangle", "1"], "--triangle"),
        (&["--triangles", "none"], "'none'"),
        (&["--triangles", "100"], "6000..=20000000"),
        (&["--base", "1,2"], "three numbers"),
        (&["--base", "1,2,inf"], "three numbers"),
        (&["--axis", "0,0,0"], "a direction needs a length"),
        (&["--model", "cone"], "capsule, cylinder, modified"),
        (&["--tolerance", "-0.1"], "at least 0"),
        (&["--steps", "0"], "1..=100000"),
        (&["--scale", "2"], "--mesh"),
    ] {
        let (success, out, error) = program("ventricle", arguments);
        assert!(!success && out.is_empty(), "{arguments:?}: {out}");
        assert!(error.contains(expected) && error.lines().count() == 1, "{arguments:?}: {error}");
    }
    assert!(program("ventricle", &["--help"]).0);
}

#[test]
fn programs_draw_their_pictures() {
    let room = ball(30.0);
    let mesh = (room.vertices().to_vec(), room.indices().to_vec());
    let path = file("room.stl", &binary_stl(&mesh));
    let arguments = [
        "--mesh",
        path.to_str().unwrap(),
        "--model",
        "capsule",
        "--tolerance",
        "0.2",
        "--steps",
        "3",
        "--out",
        "drawn",
    ];
    let (success, out, error) = program("ventricle", &arguments);
    assert!(success, "{error}");
    assert!(out.contains("512 triangles, 3 steps: search and exhaustive engine agree"), "{out}");
    for line in ["parry distance(Cylinder, TriMesh)", "search, cold", "search, warm", "exhaustive"] {
        assert!(out.contains(line), "{out}");
    }
    let (success, _, error) = program("figure7", &["--out", "drawn/seven.png"]);
    assert!(success, "{error}");
    for name in ["drawn/ventricle.png", "drawn/seven.png"] {
        let file = std::fs::File::open(Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)).unwrap();
        let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        let colours: BTreeSet<_> = pixels.as_chunks::<3>().0.iter().collect();
        assert!(colours.len() > 1000, "{name} has {} colours", colours.len());
    }
}
