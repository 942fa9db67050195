//! Proofs: `docs/book/check_proof.py` accepts the proofs of clear chains, tubes and motions, and
//! refuses altered ones.

use super::contacts::{small_mesh, small_robot};
use continuum_demo::joint_motion::JointMotion;
use continuum_demo::{ctr, ventricle};
use continuum_testing::narrow_phase::triangle_modified_cylinder;
use continuum_testing::{Random, rounds};
use parry_continuum::distance::Vec3;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::parry::shape::Ball;
use parry_continuum::proximity::{BvhSearch, Decision, Proof, Proximity};
use parry_continuum::{Cap, Chain, LinearMotion, RigidMotion, Tube, TubeSection};
use std::fs;
use std::path::PathBuf;
use std::process::Command;
use std::time::{Duration, Instant};

/// Says yes or no to each proof that is named on the command line behind its mesh, and how much
/// time of a processor it took.
const ALL: &str = "
import contextlib, io, sys, time
sys.dont_write_bytecode = True
sys.path.insert(0, sys.argv[1])
import check_proof
names = sys.argv[2:]
for mesh, proof in zip(names[::2], names[1::2]):
    said, begin = io.StringIO(), time.process_time()
    try:
        with contextlib.redirect_stdout(said):
            check_proof.main(mesh, proof)
        answer = 'yes'
        assert 'the side of the wall' in said.getvalue() and 'the premises' in said.getvalue()
    except check_proof.No as reason:
        answer = f'no: {reason}'
    assert answer.isascii() and answer.isprintable() and len(answer) < 300, answer
    lines = said.getvalue().replace(chr(10), '|')
    print(f'{time.process_time() - begin:.3f};{answer};{lines}')
";

/// What the program says.
#[derive(Debug)]
struct Said {
    is_yes: bool,
    text: String,
    time: Duration,
}

/// Meshes and proofs for the program, each in a file.
struct Checks {
    folder: PathBuf,
    files: Vec<PathBuf>,
}

impl Checks {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("proofs-{name}-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        Self { folder, files: Vec::new() }
    }

    fn add(&mut self, mesh: &(impl AsRef<[u8]> + ?Sized), proof: &(impl AsRef<[u8]> + ?Sized)) {
        for (text, kind) in [(mesh.as_ref(), "obj"), (proof.as_ref(), "txt")] {
            let path = self.folder.join(format!("{}.{kind}", self.files.len()));
            fs::write(&path, text).unwrap();
            self.files.push(path);
        }
    }

    /// What is said of each; none where there is no Python and no need to have one.
    fn run(self) -> Option<Vec<Said>> {
        let docs = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/book");
        let output = Command::new("python3").args(["-c", ALL, docs]).args(&self.files).output();
        fs::remove_dir_all(&self.folder).unwrap();
        let output = match output {
            Ok(output) => output,
            Err(error) if std::env::var_os("CI").is_none() => {
                eprintln!("skipped, without python3: {error}");
                return None;
            }
            Err(error) => panic!("python3: {error}"),
        };
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let said = String::from_utf8(output.stdout).unwrap();
        let said: Vec<_> = said
            .lines()
            .map(|line| {
                let (time, text) = line.split_once(';').unwrap();
                let time = Duration::from_secs_f64(time.parse().unwrap());
                Said { is_yes: text.starts_with("yes;"), text: text.to_owned(), time }
            })
            .collect();
        assert_eq!(said.len(), self.files.len() / 2);
        Some(said)
    }
}

fn obj(search: &BvhSearch) -> String {
    let vertices = search.vertices().iter().map(|v| format!("v {:?} {:?} {:?}\n", v.x, v.y, v.z));
    let faces =
        search.triangles().iter().map(|[a, b, c]| format!("f {} {} {}\n", a + 1, b + 1, c + 1));
    vertices.chain(faces).collect()
}

fn ball(radius: f64, parts: u32) -> BvhSearch {
    let (vertices, triangles) = Ball::new(radius).to_trimesh(2 * parts, parts);
    BvhSearch::from_triangles(&vertices, &triangles).unwrap()
}

/// Points on a bend.
fn bend(count: u32, length: f64, curvature: f64) -> Vec<Vector> {
    let point = |k: u32| {
        let s = length * f64::from(k) / f64::from(count);
        Vector::new(
            (1.0 - (curvature * s).cos()) / curvature,
            0.0,
            (curvature * s).sin() / curvature,
        )
    };
    (0..=count).map(point).collect()
}

/// What keeps a margin has a proof, however near it comes, and what does not has none.
#[test]
fn chains_that_keep_a_margin_are_proven() {
    let (mut checks, mut planes, mut refused, mut flat) = (Checks::new("chains"), Vec::new(), 0, 0);
    for seed in 0..150 {
        let random = &mut Random::new(seed);
        let (mesh, robot) = (small_mesh(random), small_robot(random));
        let pose = if random.below(2) == 0 { Pose::IDENTITY } else { random.pose(1.5) };
        let mut search = BvhSearch::new(&mesh).unwrap();
        let distance = search.minimum(&robot, &pose).unwrap().distance;
        for margin in [distance, distance * (1.0 + 1e-9), 2.0 * distance + 0.1] {
            assert_eq!(search.prove(&robot, &pose, margin).unwrap(), None, "{seed}: {margin}");
            refused += 1;
        }
        if distance < 1e-3 {
            continue;
        }
        let margin = distance * [0.0, 0.5, 0.999, 1.0 - 1e-9][random.below(4) as usize];
        let proof = search.prove(&robot, &pose, margin).unwrap();
        let proof = proof.unwrap_or_else(|| panic!("{seed}: no proof of {margin} < {distance}"));
        flat += usize::from(proof.to_string().contains(" ff") || proof.to_string().contains("fr"));
        planes.push(proof.planes());
        checks.add(&obj(&search), &proof.to_string());
    }
    let Some(said) = checks.run() else { return };
    assert!(said.iter().all(|said| said.is_yes), "{said:?}");
    let most = planes.iter().max();
    assert!(
        said.len() > 60 && flat > 20 && refused > 400,
        "{} {flat} {refused} {most:?}",
        said.len()
    );
}

/// A text with the words between two numbers of a line changed.
fn with_line(text: &str, starts: &str, change: impl Fn(&str) -> String) -> String {
    let mut is_changed = false;
    let lines = text.lines().map(|line| {
        if line.starts_with(starts) && !is_changed {
            is_changed = true;
            return change(line);
        }
        line.to_owned()
    });
    let text = lines.map(|line| line + "\n").collect();
    assert!(is_changed, "{starts}");
    text
}

/// The lines of the proof of a chain.
struct Lines {
    head: Vec<String>,
    points: Vec<String>,
    pieces: Vec<String>,
    steps: Vec<String>,
}

impl Lines {
    fn of(proof: &Proof) -> Self {
        let text = proof.to_string();
        let lines: Vec<_> = text.lines().map(str::to_owned).collect();
        let shape = lines.iter().position(|line| line.starts_with("shape ")).unwrap();
        let count: usize = lines[shape].split(' ').next_back().unwrap().parse().unwrap();
        let steps = lines[shape + 2 * count + 3..lines.len() - 1].iter();
        Self {
            head: lines[..shape].to_vec(),
            points: lines[shape + 1..shape + 2 + count].to_vec(),
            pieces: lines[shape + 2 + count..shape + 2 + 2 * count].to_vec(),
            steps: steps.flat_map(|line| line.split(' ')).map(str::to_owned).collect(),
        }
    }

    fn text(&self) -> String {
        let Self { head, points, pieces, steps } = self;
        let (count, done) = (pieces.len(), steps.len());
        let parts =
            [head.join("\n"), format!("shape {count}"), points.join("\n"), pieces.join("\n")];
        format!("{}\nsteps {done}\n{}\nend\n", parts.join("\n"), steps.join(" "))
    }
}

/// 200 texts, each false by one step or one number.
#[test]
fn what_was_tampered_with_is_refused() {
    let mut search = ball(10.0, 8);
    let robot = Chain::from_centreline(&bend(12, 8.0, 0.1), &[0.9; 12]).unwrap();
    let distance = search.minimum(&robot, &Pose::IDENTITY).unwrap().distance;
    let proof = search.prove(&robot, &Pose::IDENTITY, 0.5 * distance).unwrap().unwrap();
    let (mesh, good) = (obj(&search), || Lines::of(&proof));
    let random = &mut Random::new(5);
    let mut checks = Checks::new("tampered");
    checks.add(&mesh, &proof.to_string());
    checks.add(&mesh, &good().text());
    let untouched = 2;
    let mut what = Vec::new();
    let mut tamper = |name: &str, mesh: &str, text: String| {
        assert!(text != good().text() || mesh != obj(&search), "{name}: not touched");
        checks.add(mesh, &text);
        what.push(name.to_owned());
    };
    let planes: Vec<_> =
        (0..good().steps.len()).filter(|&k| good().steps[k].contains(',')).collect();
    for round in 0..rounds(25) {
        // A plane with the robot on its wrong side, or none.
        let mut lines = good();
        let at = planes[random.below(planes.len() as u32) as usize];
        let opposite =
            |number: &str| number.strip_prefix('-').map_or(format!("-{number}"), str::to_owned);
        lines.steps[at] = lines.steps[at].split(',').map(opposite).collect::<Vec<_>>().join(",");
        tamper("a plane points to the robot", &mesh, lines.text());
        // A step less, or one more.
        let mut lines = good();
        lines.steps.remove(random.below(lines.steps.len() as u32) as usize);
        tamper("a step is missing", &mesh, lines.text());
        let mut lines = good();
        let at = random.below(lines.steps.len() as u32) as usize;
        lines.steps.insert(at, ["t", "p", "1,0,0", "q"][round % 4].to_owned());
        tamper("a step is added", &mesh, lines.text());
        // What is claimed is not so.
        let mut lines = good();
        lines.head[2] = format!("margin {:?}", distance * random.between(1.0 + 1e-12, 9.0));
        tamper("the margin is not kept", &mesh, lines.text());
        let mut lines = good();
        let at = random.below(lines.points.len() as u32) as usize;
        let vertex = search.vertices()[random.below(search.vertices().len() as u32) as usize];
        lines.points[at] = format!("{:?} {:?} {:?}", vertex.x, vertex.y, vertex.z);
        tamper("the robot meets the wall", &mesh, lines.text());
        let mut lines = good();
        let at = random.below(lines.pieces.len() as u32) as usize;
        lines.pieces[at] = lines.pieces[at].replace("0.9 ", "11.0 ");
        tamper("the robot is as wide as the wall", &mesh, lines.text());
        // Another mesh.
        let at = random.below(search.vertices().len() as u32) as usize;
        let moved: String = mesh
            .lines()
            .enumerate()
            .map(|(number, line)| {
                if number != at {
                    return format!("{line}\n");
                }
                let v = search.vertices()[at];
                format!("v {:?} {:?} {:?}\n", v.x, v.y, f64::from_bits((v.z + 0.0).to_bits() ^ 1))
            })
            .collect();
        tamper("a vertex is off by its last bit", &moved, good().text());
        let text = good().text();
        let end = random.below(text.len() as u32 - 1) as usize;
        tamper("the end is missing", &mesh, text[..end].to_owned());
    }
    for (starts, from, to) in [
        ("mesh", " ", " 1"),
        ("mesh", "mesh", "mush"),
        ("proof", "2", "1"),
        ("margin", "margin ", "margin -"),
        ("margin", "margin 0", "margin nan"),
        ("margin", "margin ", "margin 1e999"),
        ("chain", "chain", "motion"),
        ("chain", "chain", "tube"),
        ("chain", "1", "2"),
        ("chain", "1", "0"),
        ("shape", "12", "11"),
        ("shape", "12", "13"),
        ("0.9", "0.9", "-0.9"),
        ("0.9", "0.9 ", "0.9 x"),
        ("0.9", "0.9", "inf"),
        ("steps", "steps ", "steps 1"),
        ("end", "end", "end end"),
        ("end", "end", "0,0,0"),
    ] {
        let text = with_line(&good().text(), starts, |line| line.replacen(from, to, 1));
        tamper(&format!("{starts}: {to} for {from}"), &mesh, text);
    }
    let reordered = mesh.lines().rev().map(|line| format!("{line}\n")).collect::<String>();
    tamper("the mesh is in another order", &reordered, good().text());
    let fewer = mesh.trim_end().rsplit_once('\n').unwrap().0.to_owned();
    tamper("a triangle is missing", &fewer, good().text());
    let mut lines = good();
    lines.steps.push(lines.steps[planes[0]].clone());
    tamper("a step behind the last", &mesh, lines.text());
    let mut lines = good();
    lines.steps[planes[0]] = "0,0,0".to_owned();
    tamper("a plane without a normal", &mesh, lines.text());

    // What harms nothing: the answer is yes, and what was changed is printed.
    let mut harmless = Vec::new();
    let mut leave = |said: &str, text: String| {
        checks.add(&mesh, &text);
        harmless.push(said.to_owned());
    };
    let mut lines = good();
    lines.head[2] = "margin 0.0 # less".to_owned();
    leave("more than 0.0 from", lines.text());
    let mut lines = good();
    lines.pieces[3] = lines.pieces[3].replace("0.9 ", "0.25 ");
    leave("radius 0.25,", lines.text());
    let mut lines = good();
    // The first link is half as long.
    let [x, y, z] = [0, 1, 2].map(|k| {
        let number: f64 = lines.points[1].split(' ').nth(k).unwrap().parse().unwrap();
        0.5 * number
    });
    lines.points[0] = format!("{x:?} {y:?} {z:?}");
    leave(&format!("{z:?}) to"), lines.text());
    let mut lines = good();
    for &at in &planes {
        let threefold = |number: &str| (3 * number.parse::<i64>().unwrap()).to_string();
        lines.steps[at] = lines.steps[at].split(',').map(threefold).collect::<Vec<_>>().join(",");
    }
    leave("planes", lines.text());
    leave("planes", good().text().replace(' ', "\n# again\n  "));

    let Some(said) = checks.run() else { return };
    assert!(said[..untouched].iter().all(|said| said.is_yes), "{:?}", &said[..untouched]);
    let (tampered, left) = said[untouched..].split_at(what.len());
    for (said, what) in tampered.iter().zip(&what) {
        assert!(!said.is_yes, "{what}: {said:?}");
    }
    assert!(tampered.len() >= rounds(200), "{}", tampered.len());
    for (said, expected) in left.iter().zip(&harmless) {
        assert!(said.is_yes && said.text.contains(expected), "{expected}: {said:?}");
    }
}

/// A wall behind the flat end of a short robot, and the line of a proof that says which mesh it is.
fn triangle_and_its_name(corners: [Vector; 3]) -> (BvhSearch, String, String) {
    let mut search = BvhSearch::from_triangles(&corners, &[[0, 1, 2]]).unwrap();
    let far = corners[0] + 1e3 * (1.0 + (corners[1] - corners[0]).length()) * Vector::X;
    let robot = Chain::capsules(&[far, far + Vector::X], &[0.0]).unwrap();
    let proof = search.prove(&robot, &Pose::IDENTITY, 0.0).unwrap().unwrap().to_string();
    let name = proof.lines().nth(1).unwrap().to_owned();
    let mesh = obj(&search);
    (search, mesh, name)
}

/// Links, and tubes of them, that are shorter than their radius and have one flat and one round
/// end: a proof is found and accepted up to the distance from the half ball beyond the round end's
/// disc, and no proof beyond it.
#[test]
fn short_pieces_with_one_flat_end_hold_the_half_ball() {
    let (mut checks, mut shorter) = (Checks::new("half-balls"), 0);
    for seed in 0..rounds(60) {
        let random = &mut Random::new(seed);
        let pose = if seed % 2 == 0 { Pose::IDENTITY } else { random.pose(3.0) };
        let radius = random.between(0.3, 2.0);
        let short = radius * random.between(0.02, 0.9);
        // The first link ends in a ball, as there is room up to the tip: it is cut off at the base.
        let points = [Vector::ZERO, Vector::Z * short, Vector::Z * (short + 3.0 * radius)];
        let robot = Chain::from_centreline(&points, &[radius; 2]).unwrap();
        assert_eq!(robot.links()[0].caps(), [Cap::Flat, Cap::Round]);
        let below = -Vector::Z * radius * random.between(0.02, 1.0 - short / radius);
        let corner = |random: &mut Random| pose * (below + 0.05 * radius * random.point());
        let (mut search, mesh, _) =
            triangle_and_its_name([corner(random), corner(random), corner(random)]);
        let distance = search.minimum(&robot, &pose).unwrap().distance;
        if distance <= 0.0 {
            continue;
        }
        shorter += 1;
        let tube = Tube::from(&robot);
        for share in [0.5, 0.999] {
            let proof = search.prove(&robot, &pose, share * distance).unwrap();
            checks.add(&mesh, &proof.unwrap_or_else(|| panic!("{seed}: no proof")).to_string());
            let proof = search.prove_tube(&tube, &pose, share * distance, 1e-4 * distance).unwrap();
            let proof = proof.unwrap_or_else(|| panic!("{seed}: no proof of the tube")).to_string();
            assert!(proof.contains(" fr "), "{proof}");
            checks.add(&mesh, &proof);
        }
        assert_eq!(search.prove(&robot, &pose, distance).unwrap(), None);
        assert_eq!(search.prove_tube(&tube, &pose, distance, 1e-4 * distance).unwrap(), None);
    }
    let Some(said) = checks.run() else { return };
    assert!(said.iter().all(|said| said.is_yes), "{said:?}");
    assert!(shorter > rounds(40) && said.len() == 4 * shorter, "{shorter}");
}

/// A flat end before a wall across it is proven as near as `clears_tube` decides: with a stated
/// error or turn, a sample taken twice, radii that differ by rounding, and on bent curves.
#[test]
fn flat_ends_are_proven_as_they_are_decided() {
    let (mut checks, mut sharp) = (Checks::new("flat-ends"), 0);
    let mut prove = |tube: &Tube, tip: Vector, along: Vector, gap: f64, resolution: f64| {
        let side = along.any_orthonormal_vector();
        let centre = tip + along * gap;
        let corners = [0.0, 2.1, 4.2].map(|angle| {
            centre + (side * f64::cos(angle) + along.cross(side) * f64::sin(angle)) * 30.0
        });
        let mut search = BvhSearch::from_triangles(&corners, &[[0, 1, 2]]).unwrap();
        let decided = search.clears_tube(tube, &Pose::IDENTITY, 0.0, resolution);
        assert_eq!(decided, Ok(Decision::Clear), "{gap}");
        let proof = search.prove_tube(tube, &Pose::IDENTITY, 0.0, resolution).unwrap();
        let proof = proof.unwrap_or_else(|| panic!("{gap}: no proof"));
        checks.add(&obj(&search), &proof.to_string());
    };
    // A rod, nearer to the wall than its radius.
    let rod: Vec<_> = (0..=20).map(|z| Vector::Z * f64::from(z)).collect();
    let tangents = Some([Vector::Z; 2]);
    let sampled = |points: &[Vector], radius: &dyn Fn(usize) -> f64| {
        let radii: Vec<_> = (1..points.len()).map(radius).collect();
        Tube::from_samples(points, &radii, tangents).unwrap()
    };
    let plain = || sampled(&rod, &|_| 1.0);
    let mut twice = rod.clone();
    twice.insert(9, rod[8] + Vector::X * 1e-5);
    let mut again = rod.clone();
    again.insert(9, rod[8]);
    for tube in [
        plain(),
        plain().with_error(1e-9).unwrap(),
        plain().with_turn(1e-9).unwrap(),
        plain().with_error(0.05).unwrap().with_turn(0.05).unwrap(),
        sampled(&twice, &|_| 1.0),
        sampled(&again, &|_| 1.0),
        sampled(&rod, &|k| if k == 7 { 1.0 + 1e-12 } else { 1.0 }),
    ] {
        prove(&tube, Vector::Z * 20.0, Vector::Z, 0.9, 1e-3);
    }
    // The end of a fit, by its turn alone: a half ball reaches less far than the disc turned by it.
    let fit = Tube::fit(&rod, &[1.0; 20], 1e-6).unwrap().with_turn(1.2).unwrap();
    prove(&fit, Vector::Z * 20.0, Vector::Z, 1.1, 1e-3);
    // Arcs with their tangents, in random frames: nearer than radius x curvature x spacing / 2.
    for seed in 0..rounds(60) {
        let random = &mut Random::new(seed);
        let pose = random.pose(5.0);
        // Thinner tubes are bounded along their chords, and no nearer than that is decided. In thick
        // ones, up to some that are wider than long, the inner ends near the face turn by more than
        // they are behind it. Still thicker ones need more samples there.
        let (curvature, radius) = if seed % 3 == 0 {
            let curvature = random.between(0.012, 0.07);
            (curvature, random.between(0.3, 0.6) / curvature)
        } else {
            (random.between(0.01, 0.1), random.between(0.8, 2.0))
        };
        let at = |s: f64| {
            let (sin, cos) = (curvature * s).sin_cos();
            let along = pose.rotation * Vector::new(sin, 0.0, cos);
            (pose * Vector::new((1.0 - cos) / curvature, 0.0, sin / curvature), along)
        };
        let points: Vec<_> = (0..=20).map(|k| at(f64::from(k)).0).collect();
        let ((_, start), (tip, along)) = (at(0.0), at(20.0));
        let tube = Tube::with_constant_radius(&points, radius, Some([start, along])).unwrap();
        let gap = 10_f64.powf(random.between(-6.0, -3.0));
        sharp += usize::from(gap < 0.5 * radius * curvature);
        prove(&tube, tip, along, gap, 0.1 * gap);
    }
    assert!(sharp > rounds(50), "{sharp}");
    let Some(said) = checks.run() else { return };
    assert!(said.iter().all(|said| said.is_yes), "{said:?}");
}

/// Pieces as the page defines them, with the largest bend, length, offset and tilt that it allows,
/// beside a triangle: an accepted proof is true of every disc and of the half balls beyond round
/// ends.
#[test]
fn what_is_believed_of_a_piece_is_true_of_its_discs_and_half_balls() {
    let (mut checks, mut nearest, mut flats, mut directions) =
        (Checks::new("pieces"), Vec::new(), 0, 0);
    for seed in 0..rounds(100) {
        let random = &mut Random::new(seed);
        let pose = random.pose(2.0);
        let length = random.between(0.05, 3.0);
        let curvature = random.between(0.0, 1.0) / length * f64::from(random.below(2));
        let radius = random.between(0.1, 0.95) * (1.0 / curvature.max(0.1)).min(3.0);
        let off = [0.0, 0.02 * length][random.below(2) as usize];
        let mut caps = [["ff", "fr", "rf"][random.below(3) as usize], "rr"]
            [random.below(4) as usize / 3]
            .to_owned();
        // With a stated direction, the direction takes half of the tilt and the discs the rest.
        let is_stated = caps != "rr" && random.below(2) == 0;
        let tilt = [0.0, 0.03][random.below(2) as usize];
        let of_discs = if is_stated { 0.499 * tilt } else { 0.999 * tilt };
        // An arc whose ends are off by as much as is stated.
        let at = |s: f64| {
            let (sin, cos) = (curvature * s).sin_cos();
            let centre = if curvature > 0.0 {
                Vector::new((1.0 - cos) / curvature, 0.0, sin / curvature)
            } else {
                Vector::Z * s
            };
            (pose * centre, pose.rotation * Vector::new(sin, 0.0, cos))
        };
        let stated =
            [at(0.0).0, at(length).0].map(|point| point + 0.999 * off * random.direction());
        // A triangle near the piece's surface, ahead of an end as often as beside.
        let (centre, along) =
            at([0.0, length, random.between(0.0, length)][random.below(3) as usize]);
        let way = (along.cross(random.direction()) * random.unit()
            + along * random.between(-1.0, 1.0))
        .normalize();
        let corner = centre + way * radius * random.between(0.3, 2.5);
        let corners = [
            corner,
            corner + 0.01 * radius * random.point(),
            corner + 0.01 * radius * random.point(),
        ];
        let (_, mesh, name) = triangle_and_its_name(corners);
        let mut direction = String::new();
        if is_stated {
            let end = caps.rfind('f').unwrap();
            caps.replace_range(end..=end, "d");
            let (_, along) = at([0.0, length][end]);
            let outward = if end == 0 { -along } else { along };
            let off = outward.cross(random.direction()).normalize() * f64::tan(of_discs);
            let Vector { x, y, z } = (outward + off) * random.between(0.1, 9.0);
            direction = format!(" {x:?} {y:?} {z:?}");
        }
        let tilted = |along: Vector, random: &mut Random| {
            let off = along.cross(random.direction()).normalize() * f64::tan(of_discs);
            (along + off).normalize()
        };
        // How far the piece is, by its discs' rims and centres and its ends' directions.
        let mut least = f64::INFINITY;
        let mut visit = |point: Vector| {
            // Toward a corner is near enough: the triangle is small.
            least =
                corners.iter().fold(least, |least, corner| least.min((*corner - point).length()));
        };
        for k in 0..=100 {
            let (centre, along) = at(length * f64::from(k) / 100.0);
            let along = tilted(along, random);
            let way = corner - centre;
            let across = way - along * way.dot(along);
            visit(centre + across * (radius / across.length()).min(1.0));
        }
        for (end, s) in [0.0, length].into_iter().enumerate() {
            let (centre, along) = at(s);
            let outward = if end == 0 { -along } else { along };
            let outward = tilted(outward, random);
            let way = corner - centre;
            let is_round = &caps[end..=end] == "r";
            if is_round && (caps == "rr" || way.dot(outward) > 0.0) {
                visit(centre + way * (radius / way.length()).min(1.0));
            }
        }
        let length = length * (1.0 + 1e-12);
        let stated_piece =
            format!("{radius:?} {caps} {curvature:?} {length:?} {off:?} {tilt:?}{direction}");
        for share in [0.2, 0.6, 0.9, 1.0, 1.1] {
            let margin = share * least;
            let way = (corner - centre.lerp(0.5 * (stated[0] + stated[1]), random.unit()))
                .normalize()
                * 2f64.powi(30);
            for way in [way, along * 2f64.powi(30), -along * 2f64.powi(30)] {
                let [a, b, c] = way.to_array().map(|number| number.round() as i64);
                let points = stated.map(|p| format!("{:?} {:?} {:?}", p.x, p.y, p.z)).join("\n");
                checks.add(
                    &mesh,
                    &format!(
                        "proof of clearance 2\n{name}\nmargin {margin:?}\ntube 1\nshape 1\n{points}\n{stated_piece}\nsteps 1\n\
                         {a},{b},{c}\nend\n"
                    ),
                );
                nearest.push((margin, least, seed, is_stated));
            }
        }
        flats += usize::from(caps != "rr");
        directions += usize::from(is_stated);
    }
    let Some(said) = checks.run() else { return };
    let (mut believed, mut by_direction) = (0, 0);
    for ((margin, least, seed, is_stated), said) in nearest.iter().zip(&said) {
        assert!(
            !said.is_yes || margin < &(least * (1.0 + 1e-9)),
            "{seed}: {margin} of {least}, {said:?}"
        );
        believed += usize::from(said.is_yes);
        by_direction += usize::from(said.is_yes && *is_stated);
    }
    assert!(believed > rounds(75) && flats > rounds(50), "{believed} {flats}");
    assert!(directions > rounds(20) && by_direction > rounds(20), "{directions} {by_direction}");
}

/// Files that are not proofs or not meshes of triangles: one line refuses them, and its quotes are
/// escaped.
#[test]
fn malformed_files_are_refused() {
    let (mut search, mesh, _) = triangle_and_its_name([Vector::ZERO, Vector::X, Vector::Y]);
    let points =
        [Vector::new(0.2, 0.2, 2.0), Vector::new(0.2, 0.2, 3.0), Vector::new(0.2, 0.5, 4.0)];
    let robot = Chain::from_centreline(&points, &[0.5; 2]).unwrap();
    let chain = search.prove(&robot, &Pose::IDENTITY, 0.5).unwrap().unwrap().to_string();
    let tube = search
        .prove_tube(&Tube::from(&robot), &Pose::IDENTITY, 0.5, 0.01)
        .unwrap()
        .unwrap()
        .to_string();
    // Over the triangle from one side to the other.
    let [from, to] = [-6.0, 6.0].map(|x| Pose::from_translation(Vector::X * x));
    let pushed = RigidMotion::new(Tube::from(&robot), [from, to]).unwrap();
    let motion = search.prove_motion(&pushed, 0.5, 0.01).unwrap().unwrap();
    assert!(motion.shapes() > 1);
    let motion = motion.to_string();
    let mut checks = Checks::new("malformed");
    let (mut right, mut wrong) = (Vec::new(), Vec::new());

    // What is right in another dress.
    let corners = [
        "f 1/1 2/2 3/3\n",
        "f 1//4 2//4 3//4\n",
        "f 1/2/3 2/2/3 3/2/3\n",
        "f\t1  2 3 # the floor\n",
    ];
    for f in corners {
        right.push((mesh.replace("f 1 2 3\n", f), chain.clone()));
    }
    let exported = "# Fl\u{e4}che\nmtllib a.mtl\no floor\n\nvn 0 0 1\nvt 0 1\ng x y\nusemtl \u{1b}[32m\ns off\n";
    right.push((format!("{exported}{mesh}"), chain.clone()));
    right.push((mesh.replace('\n', "\r\n"), chain.replace('\n', "\r\n")));
    right.push((mesh.replace("v 0.0 0.0 0.0", "v -0.0 0 0e0 0.5 0.5 0.5"), chain.clone()));
    right.push((format!("\u{feff}{mesh}"), format!("# \u{1b}[2J\n{chain}# behind the end")));
    right.push((mesh.clone(), tube.clone()));
    right.push((mesh.clone(), motion.clone()));

    for [from, to] in [
        ["f 1 2 3", "f 1 2 0_3"],
        ["f 1 2 3", "f 1 2 \u{663}"],
        ["f 1 2 3", "f +1 2 3"],
        ["f 1 2 3", "f 01 2 3"],
        ["f 1 2 3", "f 1 2 3 1"],
        ["f 1 2 3", "f 1 2"],
        ["f 1 2 3", "f 1 2 4"],
        ["f 1 2 3", "f 0 1 2"],
        ["f 1 2 3", "f -3 -2 -1"],
        ["f 1 2 3", "f 1/ 2/ 3/"],
        ["f 1 2 3", "f 1/x 2/x 3/x"],
        ["f 1 2 3", "f 1//// 2 3"],
        ["f 1 2 3", "f 1.0 2 3"],
        ["f 1 2 3", "f 1 2 \\\n3"],
        ["f 1 2 3", "f 1 2 3\np 1"],
        ["f 1 2 3", "f 1 2 3\nl 1 2"],
        ["f 1 2 3", "f 1 2 3\nF 1 2 3"],
        ["f 1 2 3", "f 1 2 3\nfo 1 2 3"],
        ["f 1 2 3", "f 1 2 3\ncall other.obj"],
        ["f 1 2 3", "f 1 2 3\n\u{1b}[2Jyes"],
        ["f 1 2 3", "f 1 2 3\n\u{a0}f 1 2 3"],
        ["f 1 2 3", "f 1\u{a0}2 3"],
        ["f 1 2 3", "f 1\u{b}2 3"],
        ["f 1 2 3", "# comment \\\nf 1 2 3"],
        ["f 1 2 3", "# comment \rf 1 2 3"],
        ["f 1 2 3", "f 1 2 3\0"],
        ["f 1 2 3", ""],
        ["v 0.0", "v 0.0 0.0"],
        ["v 0.0", "v 0_0.0"],
        ["v 0.0", "v \u{660}.0"],
        ["v 0.0", "v nan"],
        ["v 0.0", "v -inf"],
        ["v 0.0", "v 0x0"],
        ["v 0.0", "v 1e999"],
        ["v 0.0", "vp 0.0"],
        ["v 0.0 0.0", "v 0.0"],
    ] {
        let changed = mesh.replacen(from, to, 1);
        assert_ne!(changed, mesh, "{from}");
        wrong.push((changed, chain.clone()));
    }
    let long = "9".repeat(200_000);
    let zeros = format!("0.{}5", "0".repeat(5_000));
    for (proof, from, to) in [
        // Numbers that Python reads and the page does not know.
        (&chain, "margin 0.5", "margin 0_0.5"),
        (&chain, "margin 0.5", "margin +0.5"),
        (&chain, "margin 0.5", "margin .5"),
        (&chain, "margin 0.5", "margin 5e-1_0"),
        (&chain, "margin 0.5", "margin nan"),
        (&chain, "margin 0.5", "margin inf"),
        (&chain, "margin 0.5", "margin \u{661}"),
        (&chain, "margin 0.5", "margin \u{ff11}"),
        (&chain, "margin 0.5", "margin 1e400"),
        (&chain, "margin 0.5", &format!("margin {long}")),
        (&chain, "margin 0.5", "margin 1/2"),
        (&chain, "margin 0.5", "margin\u{a0}0.5"),
        (&chain, "margin 0.5", "margin\u{c}0.5"),
        (&chain, "margin 0.5", "margin\u{2028}0.5"),
        (&chain, "margin 0.5", "margin 0.5\0"),
        (&chain, "margin 0.5", "margin 0.5\u{1b}[A"),
        (&chain, "margin 0.5", "margin -0.5"),
        // A line that is there twice, or in another order.
        (&chain, "margin 0.5", "margin 0.5 margin 0.5"),
        (&chain, "margin 0.5", "margin 0.5\nmargin 0.1"),
        (&chain, "proof of clearance 2", "proof of clearance 2\nproof of clearance 2"),
        (&chain, "mesh 3 1 ", "mesh 3 1 mesh 3 1 "),
        (&chain, "mesh 3 1 ", "mesh 3 -1 "),
        (&chain, "mesh 3 1 ", "mesh 3 1_0 "),
        (&chain, "mesh 3 1 ", &format!("mesh {long} 1 ")),
        // Counts.
        (&chain, "chain 1", "chain -1"),
        (&chain, "chain 1", "chain 0"),
        (&chain, "chain 1", "chain 1.0"),
        (&chain, "chain 1", "chain \u{b9}"),
        (&chain, "chain 1", "chain 999999999"),
        (&chain, "chain 1", "\u{1b}[2K\u{1b}[1Ayes 1"),
        (&chain, "shape 2", "shape 999999999"),
        (&chain, "shape 2", "shape -2"),
        (&chain, "shape 2", "shape 0"),
        (&chain, "steps ", "steps -"),
        (&chain, "steps ", "steps 9999"),
        (&chain, "0.5 f", "0.5 F"),
        (&chain, "0.5 f", "0.5 \u{1b}[32m"),
        (&chain, "0.5 f", "0.5 fff"),
        (&chain, "end", "\u{1b}[2Kyes"),
        (&chain, "end", "end yes"),
        (&chain, "end", "end\n\u{202e}sey"),
        // Flat, and no direction.
        (&chain, "0.2 0.2 3.0\n", "0.2 0.2 2.0\n"),
        // Premises that contradict one another.
        (&tube, " 0.0 1.0", " 0.0 0.0"),
        (&tube, " 0.0 1.0", " 0.0 0.9"),
        (&tube, " 0.0 1.0", " 1.1 1.0"),
        (&tube, " 0.0 1.0", " -0.1 1.0"),
        // A stated direction that is missing.
        (&tube, " f", " d"),
        (&chain, " f", " d"),
        (&tube, "0.2 0.2 3.0\n", "0.2 0.2 2.0\n"),
        (&motion, "shape 0.0 ", "shape 0.0 0.0 "),
    ] {
        let changed = proof.replacen(from, to, 1);
        assert_ne!(&changed, proof, "{from}");
        wrong.push((mesh.clone(), changed));
    }
    for text in ["", "\n", "#", "proof", "\0", &zeros, &"t ".repeat(100_000), &long] {
        wrong.push((mesh.clone(), text.to_owned()));
        wrong.push((text.to_owned(), chain.clone()));
    }
    // A stated direction that is right, none, at both ends, or into the piece.
    for (caps, direction) in
        [("dr", "0.0 0.0 -3.0"), ("dr", "0.0 0.0 0.0"), ("dd", "0 0 -1"), ("dr", "0 0 1")]
    {
        let lines = tube.lines().map(|line| match line.split_once(" fr ") {
            Some((radius, rest)) => format!("{radius} {caps} {rest} {direction}\n"),
            None => format!("{line}\n"),
        });
        let is_right = direction == "0.0 0.0 -3.0";
        (if is_right { &mut right } else { &mut wrong }).push((mesh.clone(), lines.collect()));
    }

    // A motion that exceeds its stated speed between two shapes, at the base or at the tip.
    let slow = motion.lines().map(|line| match line.split(' ').collect::<Vec<_>>()[..] {
        [radius, caps, curvature, length, off, tilt, _, turn] => {
            format!("{radius} {caps} {curvature} {length} {off} {tilt} 0.0 {turn}\n")
        }
        _ => format!("{line}\n"),
    });
    wrong.push((mesh.clone(), slow.collect()));

    for (mesh, proof) in right.iter().chain(&wrong) {
        checks.add(mesh, proof);
    }
    // A file of bytes that are no text.
    checks.add(&[0xff, 0xfe, b'v'], &chain);
    checks.add(&mesh, &[b'p', 0xff, 0x9b]);
    let Some(said) = checks.run() else { return };
    let (taken, refused) = said.split_at(right.len());
    for (said, (mesh, proof)) in taken.iter().zip(&right) {
        assert!(said.is_yes, "{said:?}: {mesh} {proof}");
    }
    for (number, said) in refused.iter().enumerate() {
        assert!(!said.is_yes, "{said:?}: {:?}", wrong.get(number));
    }
}

/// Proofs and meshes with some bytes changed: an accepted proof is true of the printed robot.
#[test]
fn what_is_believed_of_a_changed_text_is_true() {
    let mut search = ball(10.0, 4);
    let robot = Chain::from_centreline(&bend(4, 8.0, 0.1), &[0.9; 4]).unwrap();
    let distance = search.minimum(&robot, &Pose::IDENTITY).unwrap().distance;
    let proof =
        search.prove(&robot, &Pose::IDENTITY, 0.25 * distance).unwrap().unwrap().to_string();
    let mesh = obj(&search);
    let random = &mut Random::new(8);
    let (mut checks, mut texts) = (Checks::new("changed"), Vec::new());
    for _ in 0..250 {
        let mut text = proof.clone().into_bytes();
        for _ in 0..=random.below(2) {
            let at = random.below(text.len() as u32) as usize;
            let digits = b"0123456789.-e \nfr,tp#_\0\x1b\xff";
            let to = digits[random.below(digits.len() as u32) as usize];
            match random.below(4) {
                0 => drop(text.remove(at)),
                1 => text.insert(at, to),
                _ => text[at] = to,
            }
        }
        checks.add(&mesh, &text);
        texts.push(text);
    }
    let Some(said) = checks.run() else { return };
    let (mut believed, mut refused) = (0, 0);
    for (said, text) in said.iter().zip(&texts) {
        if !said.is_yes {
            refused += 1;
            continue;
        }
        believed += 1;
        // yes;This chain keeps more than 0.5 from ..|  (x, y, z) to (x, y, z): radius r, caps fr|
        let margin = said.text.split("more than ").nth(1).unwrap().split(' ').next().unwrap();
        let margin: f64 = margin.parse().unwrap();
        for line in said.text.split('|').filter(|line| line.starts_with("  (")) {
            let numbers: Vec<f64> = line
                .split(|c: char| !(c.is_ascii_digit() || ".-+e".contains(c)))
                .filter_map(|word| word.parse().ok())
                .collect();
            let caps = line.split("caps ").nth(1).unwrap().as_bytes();
            let flat = [caps[0] == b'f', caps[1] == b'f'];
            let [start, end] =
                [0, 3].map(|k| Vec3::new(numbers[k], numbers[k + 1], numbers[k + 2]));
            for [a, b, c] in search.triangles() {
                let corners = [a, b, c].map(|&corner| search.vertices()[corner as usize].into());
                let distance =
                    triangle_modified_cylinder(corners, start, end, numbers[6], flat).distance;
                assert!(
                    distance > margin * (1.0 - 1e-9),
                    "{distance}: {}",
                    String::from_utf8_lossy(text)
                );
            }
        }
    }
    assert!(believed > 8 && refused > 80, "{believed} {refused}");
}

/// The shapes of a motion are one robot: its radii stay, and no part of it jumps between two
/// shapes. The plane alone separates each of these shapes from the wall.
#[test]
fn a_motion_whose_parts_jump_is_refused() {
    let wall = [[-50.0, -50.0, 100.0], [50.0, -50.0, 100.0], [0.0, 50.0, 100.0]];
    let search = BvhSearch::from_triangles(&wall.map(Vector::from), &[[0, 1, 2]]).unwrap();
    // The head of a proof has the digest of the mesh.
    let robot = Chain::capsules(&[Vector::ZERO, Vector::Z], &[1.0]).unwrap();
    let still = RigidMotion::new(Tube::from(&robot), [Pose::IDENTITY; 2]).unwrap();
    let proof = search.clone().prove_motion(&still, 1.0, 1e-3).unwrap().unwrap().to_string();
    let head: Vec<_> = proof.lines().take(3).collect();
    let shape = |times: [f64; 2], points: &[[f64; 2]], radii: &[f64]| {
        let mut text = format!("shape {:?} {:?} {}\n", times[0], times[1], radii.len());
        points.iter().for_each(|[y, z]| text += &format!("0.0 {y:?} {z:?}\n"));
        // At most 10.5 long, and 0.125 further after a quarter of the time.
        radii
            .iter()
            .for_each(|radius| text += &format!("{radius:?} rr 0.0 10.5 0.0 0.0 0.5 0.0\n"));
        text + "steps 1\n0,0,1\n"
    };
    let first = [[0.0, 0.0], [0.0, 10.0], [0.0, 20.0]];
    let second = |y: f64, z: f64| [[0.1, 0.0], [y, z], [0.1, 20.0]];
    /// Points of the second shape, the radii of both, and what the checker says.
    type Case<'a> = (&'a [[f64; 2]], [&'a [f64]; 2], &'a str);
    let cases: [Case; 8] = [
        (&second(0.2, 10.0), [&[1.0; 2], &[1.0; 2]], "yes"),
        // The same in other pieces, and a joint that moves along the robot where no radius shows
        // it.
        (&[[0.1, 0.0], [0.2, 5.0], [0.2, 10.0], [0.1, 20.0]], [&[1.0; 2], &[1.0; 3]], "yes"),
        (&second(0.1, 12.0), [&[1.0; 2], &[1.0; 2]], "does not reach"),
        (&second(0.2, 10.0), [&[1.0, 2.0], &[1.0, 2.0]], "yes"),
        (&second(0.2, 10.0), [&[1.0; 2], &[0.001; 2]], "radii differ"),
        (&second(0.2, 10.0), [&[1.0, 2.0], &[2.0, 1.0]], "radii differ"),
        (&second(0.6, 10.0), [&[1.0; 2], &[1.0; 2]], "jumps"),
        (
            &[[0.1, 0.0], [0.2, 9.9], [0.2, 9.3], [0.1, 19.2]],
            [&[1.0, 2.0], &[1.0, 1.0, 2.0]],
            "jump",
        ),
    ];
    let mut checks = Checks::new("jumps");
    for (points, radii, _) in cases {
        let shapes = [shape([0.0, 0.5], &first, radii[0]), shape([0.5, 1.0], points, radii[1])];
        let text = format!("{}\nmotion 2\n{}{}end\n", head.join("\n"), shapes[0], shapes[1]);
        checks.add(&obj(&search), &text);
    }
    let Some(said) = checks.run() else { return };
    for (said, (points, radii, expected)) in said.iter().zip(cases) {
        assert!(said.text.contains(expected), "{}: {points:?} {radii:?}", said.text);
    }
}

/// Tubes and motions, beside and through what the library itself decides.
#[test]
fn tubes_and_motions_that_keep_a_margin_are_proven() {
    let mut checks = Checks::new("tubes");
    let mut search = ball(10.0, 12);
    let mut texts = Vec::new();
    let mut prove = |search: &BvhSearch, proof: Option<Proof>, what: &str| {
        let proof = proof.unwrap_or_else(|| panic!("{what}: no proof"));
        checks.add(&obj(search), &proof.to_string());
        texts.push((what.to_owned(), proof));
    };
    let sampled = Tube::from_samples(&bend(40, 8.0, 0.11), &[0.6; 40], None).unwrap();
    let section = TubeSection { length: 8.0, radius: 0.5, curvature: 0.2 };
    let function = Tube::from_function(&[section], |s| {
        let (sin, cos) = (0.2 * s).sin_cos();
        (Vector::new(0.0, 4.0 - 5.0 * cos, 5.0 * sin), Vector::new(0.0, sin, cos))
    });
    let chain = Tube::from(&Chain::from_centreline(&bend(8, 7.0, 0.1), &[0.7; 8]).unwrap());
    let tubes = [("samples", sampled), ("chain", chain), ("function", function.unwrap())];
    for (name, tube) in &tubes {
        let found = search.clearance(tube, &Pose::IDENTITY, 1e-3).unwrap();
        for share in [0.0, 0.5, 0.95] {
            let proof =
                search.prove_tube(tube, &Pose::IDENTITY, share * found.lower, 1e-3).unwrap();
            prove(&search, proof, name);
        }
        assert_eq!(
            search.prove_tube(tube, &Pose::IDENTITY, found.upper, 1e-3).unwrap(),
            None,
            "{name}"
        );
    }
    let (from, to) = (bend(8, 7.0, 0.01), bend(8, 7.0, 0.12));
    let bending = LinearMotion::chain(&from, &to, &[0.5; 8]).unwrap();
    // At its end the robot is nearest to the wall.
    let last = Chain::from_centreline(&to, &[0.5; 8]).unwrap();
    let least = search.minimum(&last, &Pose::IDENTITY).unwrap().distance;
    for share in [0.0, 0.5, 0.9] {
        let proof = search.prove_motion(&bending, share * least, 1e-3).unwrap();
        prove(&search, proof, "bending");
    }
    assert_eq!(search.prove_motion(&bending, least, 1e-3).unwrap(), None);
    let away = Pose::from_translation(Vector::new(1.0, 1.0, -2.0));
    let pushed = RigidMotion::new(tubes[0].1.clone(), [Pose::IDENTITY, away]).unwrap();
    let proof = search.prove_motion(&pushed, 0.1, 1e-2).unwrap();
    prove(&search, proof, "pushed");
    let through = Pose::from_translation(Vector::X * 30.0);
    let through = RigidMotion::new(tubes[0].1.clone(), [Pose::IDENTITY, through]).unwrap();
    assert_eq!(search.prove_motion(&through, 0.0, 1e-2).unwrap(), None);

    // A motion that was tampered with: one of several shapes.
    let good = texts.iter().rfind(|(name, _)| name == "bending").unwrap();
    assert!(good.1.shapes() > 3, "{}", good.1.shapes());
    let good = good.1.to_string();
    let times: Vec<_> = good.lines().filter(|line| line.starts_with("shape ")).collect();
    let faster = with_line(&good, "0.5 ", |line| {
        let words: Vec<_> = line.split(' ').collect();
        [&words[..6], &["1000.0"], &words[7..]].concat().join(" ")
    });
    let late = good.replacen(times[0], &times[0].replacen(" 0.0 ", " 0.0078125 ", 1), 1);
    let last = times[times.len() - 1];
    let short = good.replacen(last, &last.replacen(" 1.0 ", " 0.9921875 ", 1), 1);
    // A shape is left out: the times have a gap.
    let second = good.find(times[1]).unwrap();
    let third = good.find(times[2]).unwrap();
    let count = format!("motion {}", times.len());
    let fewer = format!("{}{}", &good[..second], &good[third..]);
    let fewer = fewer.replacen(&count, &format!("motion {}", times.len() - 1), 1);
    for text in [&faster, &late, &short, &fewer] {
        assert_ne!(**text, good);
        checks.add(&obj(&search), text);
    }
    let Some(said) = checks.run() else { return };
    let (said, tampered) = said.split_at(texts.len());
    for (said, (what, proof)) in said.iter().zip(&texts) {
        assert!(said.is_yes, "{what}: {said:?}");
        assert!(said.text.contains("curvature"), "{what}: its premises are not printed");
        println!(
            "{what}: {} shapes, {} planes, {} bytes, {:?}",
            proof.shapes(),
            proof.planes(),
            proof.to_string().len(),
            said.time
        );
    }
    assert!(tampered.iter().all(|said| !said.is_yes), "{tampered:?}");
}

/// Rims move where the centreline rests, and a link that grows out of nothing is a ball for a
/// moment only.
#[test]
fn motions_that_roll_and_grow_are_proven() {
    let mut checks = Checks::new("rolls");
    let wall = [[-9.0, 1.5, -9.0], [9.0, 1.5, -9.0], [0.0, 1.5, 9.0]].map(Vector::from_array);
    let mut search = BvhSearch::from_triangles(&wall, &[[0, 1, 2]]).unwrap();
    let needle =
        Tube::from(&Chain::from_centreline(&[Vector::ZERO, Vector::X * 5.0], &[0.5]).unwrap());
    let mut proven = 0;
    for turn in [3.0, 0.3, 0.01] {
        let rolled = [Pose::IDENTITY, Pose::rotation(Vector::X * turn)];
        let motion = RigidMotion::new(needle.clone(), rolled).unwrap();
        for margin in [0.99, 0.9, 0.5, 0.3, 0.0] {
            let proof = search.prove_motion(&motion, margin, 1e-3).unwrap();
            let proof =
                proof.unwrap_or_else(|| panic!("turned by {turn}, margin {margin}: no proof"));
            checks.add(&obj(&search), &proof.to_string());
            proven += 1;
        }
        assert_eq!(search.prove_motion(&motion, 1.01, 1e-3).unwrap(), None);
    }
    // The flat tip of a needle that grows comes to 0.5 before the wall.
    let grown = [Vector::ZERO, Vector::Y];
    for begin in [0.0, 1e-9, 1e-3] {
        let motion =
            LinearMotion::chain(&[Vector::ZERO, Vector::Y * begin], &grown, &[0.9]).unwrap();
        for margin in [0.0, 0.3, 0.45] {
            let proof = search.prove_motion(&motion, margin, 1e-3).unwrap();
            let proof = proof.unwrap_or_else(|| panic!("from {begin}, margin {margin}: no proof"));
            checks.add(&obj(&search), &proof.to_string());
            proven += 1;
        }
        assert_eq!(search.prove_motion(&motion, 0.51, 1e-3).unwrap(), None);
    }
    let Some(said) = checks.run() else { return };
    assert_eq!(said.len(), proven);
    assert!(said.iter().all(|said| said.is_yes), "{said:?}");
}

/// The robot of the demo at its goal, and where it stands in the ventricle.
fn robot_in_ventricle() -> (Chain, Pose) {
    let robot = ctr::three_tubes().centreline(&ventricle::goal(), 60);
    (Chain::from_centreline(&robot.points, &robot.radii).unwrap(), ventricle::entry())
}

/// The cost of the proofs of a shape and of a motion in a ventricle of this many triangles.
fn in_the_ventricle(triangles: usize) -> Option<[(usize, Duration); 2]> {
    let (vertices, triangles) = ventricle::mesh(triangles);
    let (robot, pose) = robot_in_ventricle();
    let mut search = BvhSearch::from_triangles(&vertices, &triangles).unwrap();
    let distance = search.minimum(&robot, &pose).unwrap().distance;
    let begin = Instant::now();
    let shape = search.prove(&robot, &pose, 0.5 * distance).unwrap().unwrap();
    let shape_proven = begin.elapsed();
    let pushed = Pose::from_translation(pose.rotation * (0.4 * Vector::Z)) * pose;
    let motion = RigidMotion::new(Tube::from(&robot), [pose, pushed]).unwrap();
    let begin = Instant::now();
    let edge = search.prove_motion(&motion, 0.25 * distance, 1e-2).unwrap().unwrap();
    let edge_proven = begin.elapsed();
    let mut checks = Checks::new(&format!("ventricle-{}", triangles.len()));
    checks.add(&obj(&search), &shape.to_string());
    checks.add(&obj(&search), &edge.to_string());
    let said = checks.run()?;
    assert!(said.iter().all(|said| said.is_yes), "{said:?}");
    let of = |proof: &Proof, said: &Said, proven: Duration| {
        let (planes, shapes, bytes) = (proof.planes(), proof.shapes(), proof.to_string().len());
        println!(
            "{} triangles, {} links {distance} away: {shapes} shapes, {planes} planes, {bytes} bytes, proven in {proven:?}, \
             checked in {:?}",
            triangles.len(),
            robot.links().len(),
            said.time
        );
        (bytes, said.time)
    };
    Some([of(&shape, &said[0], shape_proven), of(&edge, &said[1], edge_proven)])
}

/// The largest proof of edges of a planner whose tip goes so far, and the longest time that
/// checking one takes.
fn edges_in_the_ventricle(triangles: usize, distances: &[f64]) -> Option<(usize, Duration)> {
    let (vertices, triangles) = ventricle::mesh(triangles);
    let mut search = BvhSearch::from_triangles(&vertices, &triangles).unwrap();
    let (robot, mut random) = (ctr::three_tubes(), Random::new(77));
    let (wall, mut checks, mut all) =
        (obj(&search), Checks::new(&format!("edges-{}", triangles.len())), vec![]);
    for &distance in distances {
        // The first edge that leaves the wall some room.
        let (motion, least) = std::iter::repeat_with(|| {
            let motion =
                JointMotion::random(&robot, ventricle::entry(), distance, || random.unit());
            let least = search.clearance_of_motion(&motion, 0.01).unwrap().lower;
            (motion, least)
        })
        .take(10_000)
        .find(|(_, least)| *least > 0.5)
        .unwrap();
        let begin = Instant::now();
        let proof = search.prove_motion(&motion, 0.5 * least, 1e-2).unwrap().unwrap();
        all.push((
            distance,
            least,
            proof.shapes(),
            proof.planes(),
            proof.to_string().len(),
            begin.elapsed(),
        ));
        checks.add(&wall, &proof.to_string());
    }
    let said = checks.run()?;
    assert!(said.iter().all(|said| said.is_yes), "{said:?}");
    for ((distance, least, shapes, planes, bytes, proven), said) in all.iter().zip(&said) {
        println!(
            "{} triangles, the tip moves {distance} mm, {least:.2} away: {shapes} shapes, {planes} planes, {bytes} bytes, \
             proven in {proven:?}, checked in {:?}",
            triangles.len(),
            said.time
        );
    }
    Some((all.iter().map(|one| one.4).max()?, said.iter().map(|said| said.time).max()?))
}

#[test]
fn edges_of_a_planner_are_proven_in_little_space() {
    let Some((bytes, _)) = edges_in_the_ventricle(ventricle::DEFAULT_TRIANGLES, &[1.0, 5.0, 20.0])
    else {
        return;
    };
    assert!(bytes < 1_000_000, "{bytes}");
}

#[test]
#[ignore = "a minute: run it by name"]
fn edges_in_a_fine_ventricle_are_checked_in_time() {
    let Some((bytes, time)) = edges_in_the_ventricle(82_000, &[1.0, 5.0, 20.0]) else { return };
    assert!(bytes < 1_000_000 && time < Duration::from_secs(60), "{bytes} {time:?}");
}

#[test]
fn a_robot_in_the_ventricle_is_proven_in_little_space() {
    let Some([(shape, _), (motion, _)]) = in_the_ventricle(ventricle::DEFAULT_TRIANGLES) else {
        return;
    };
    assert!(shape < 50_000 && motion < 1_000_000, "{shape} {motion}");
}

#[test]
#[ignore = "a minute: run it by name"]
fn a_robot_in_a_fine_ventricle_is_checked_in_time() {
    let Some([shape, motion]) = in_the_ventricle(82_000) else { return };
    assert!(shape.0 < 50_000 && shape.1 < Duration::from_secs(10), "{shape:?}");
    assert!(motion.0 < 1_000_000 && motion.1 < Duration::from_secs(60), "{motion:?}");
}
