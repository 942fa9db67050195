//! The picture of a proximity query: the whole scene on the left, the robot close up on the right.
//!
//! Each link has the colour of its distance to the wall. A thin line joins its two closest points,
//! and the triangle where it ends is painted in the link's colour. A ring marks the closest link.
//! The pieces into which a query divided the curve, if there was one, are outlined close up.

use crate::canvas::{Align, Canvas, Colour, hex, mix};
use crate::colour_map::ColourMap;
use crate::outline::outline;
use crate::picture::{Camera, Picture, SKY, Skin, Solid};
use parry_continuum::parry::math::{Pose, Real, Rot3, Vector};
use parry_continuum::parry::shape::{SharedShape, TriMesh};
use parry_continuum::proximity::{LinkProximity, TubePiece};
use parry_continuum::{Chain, ModifiedCylinder};

const INK: Colour = hex(0x22303c);
const PALE: Colour = hex(0x66757f);
const SIZE: [usize; 2] = [2000, 1220];
const LEFT: usize = 1230;
const TOP: usize = 150;
const INSET: [usize; 4] = [1250, 70, 690, 764];
/// Of the outlines of pieces, by turns.
const OUTLINES: [Colour; 2] = [hex(0xffffff), hex(0xff8c1a)];
/// Of the ring around the closest points of all (Okabe and Ito's vermilion).
const MARK: Colour = hex(0xd55e00);
/// From a line of the legend to the next.
const ROW: usize = 36;
/// The distance of the last colour, mm: one for all pictures, so that two of them compare.
pub const FARTHEST: Real = 5.0;
/// How many times larger the close-up must show the robot than the whole picture does.
const MAGNIFIES: f32 = 1.5;

/// The text on the picture.
pub struct Caption {
    pub title: String,
    pub subtitle: String,
    /// Where the robot is closest to the wall, and how far.
    pub closest: String,
}

/// Draws the scene. `pose` places the robot in the mesh's frame. `answers` holds one answer per
/// link, `pieces` the pieces of a query about the curve, or none. In the mesh, z is up and y is to
/// the front, as in scans.
pub fn draw(
    mesh: &TriMesh,
    robot: &Chain,
    pose: &Pose,
    answers: &[LinkProximity],
    pieces: &[TubePiece],
    caption: &Caption,
) -> Canvas {
    let colours = ColourMap::up_to(FARTHEST);
    let thick = robot.links().iter().map(ModifiedCylinder::radius).fold(0.0, Real::max);
    let mut picture = Picture::new(Some(mesh), solids(robot, pose, answers, &colours, thick));
    for answer in answers.iter().rev() {
        picture.tints.insert(answer.witness.triangle, colours.colour(answer.distance));
    }

    let sky = |y: usize| mix(SKY[0], SKY[1], y as f32 / SIZE[1] as f32);
    let mut canvas = Canvas::new(SIZE[0], SIZE[1], |_, y| sky(y));
    let mut seen: Vec<Vector> =
        robot.links().iter().flat_map(|l| [pose * l.start(), pose * l.end()]).collect();
    let (first, middle, last) = (seen[0], seen[seen.len() / 2], seen[seen.len() - 1]);

    // The whole, from the front and above, on the side where the robot is.
    let side = if first.x < mesh.local_aabb().center().x { 1.0 } else { -1.0 };
    let towards = Vector::new(side, -0.55, -0.32).normalize();
    let size = [LEFT, SIZE[1] - TOP];
    let whole = Camera::framing(
        mesh.vertices(),
        towards,
        Vector::Z,
        size[0] as Real / size[1] as Real,
        0.04,
    );
    picture.sky = [sky(TOP), sky(SIZE[1])];
    // The robot shows through the folds in front of it.
    picture.skin.veil = 0.25;
    canvas.paste(&picture.render(&whole, size[0], size[1]), [0, TOP], 0.0);

    // Close up: the robot and the ends of its lines, from where it is broadest, cut open in front
    // of them.
    let broadside = (middle - first).cross(last - first).normalize_or_zero();
    let broadside = if broadside.dot(towards) < 0.0 { -broadside } else { broadside };
    let ends = answers.iter().map(|answer| answer.witness.on_mesh);
    let inner = seen.clone();
    seen.extend(ends.clone());
    let [left, top, width, height] = INSET;
    // Room for one more line in the legend.
    let height = if pieces.is_empty() { height } else { height - ROW };
    let mut near = Camera::framing(
        &seen,
        broadside + towards.normalize() * 0.5,
        Vector::Z,
        width as Real / height as Real,
        0.08,
    );
    let depth = |p: Vector| (p - near.eye).dot(near.forward);
    let robot_depths = inner.into_iter().map(|p| depth(p) - 1.05 * thick);
    near.cut =
        robot_depths.chain(ends.map(|p| depth(p) - 0.2 * thick)).fold(Real::INFINITY, Real::min);
    let centre = seen.iter().sum::<Vector>() / seen.len() as Real;
    let closest = answers.iter().min_by(|a, b| a.distance.total_cmp(&b.distance));
    let closest = closest.map(|answer| answer.witness.on_robot.midpoint(answer.witness.on_mesh));
    for [x, y] in closest.iter().map(|&p| whole.place(p, size)) {
        ring(&mut canvas, [x, y + TOP as f32], 13.0);
    }

    let magnified = scale(&near, centre, [width, height]) / scale(&whole, centre, size);
    let mut foot = top as f32;
    if magnified >= MAGNIFIES {
        picture.sky = [sky(top), sky(top + height)];
        picture.skin =
            Skin { near: 0.0, rim: 0.45, glint: 0.06, far: 0.88, edges: [0.04, 0.3], veil: 1.0 };
        let mut inset = picture.render(&near, width, height);
        for (piece, colour) in pieces.iter().zip(OUTLINES.into_iter().cycle()) {
            inset.stroke(
                &[outline(&piece.body, &Pose::IDENTITY, &near, [width, height])],
                2.5,
                colour,
                0.9,
            );
        }
        for place in closest.iter().map(|&p| near.place(p, [width, height])) {
            ring(&mut inset, place, 26.0);
        }
        foot += height as f32;
        let frame = [left as f32, top as f32, (left + width) as f32, foot];
        let places = seen.iter().map(|&p| whole.place(p, size)).map(|[x, y]| [x, y + TOP as f32]);
        lens(&mut canvas, &places.collect::<Vec<_>>(), frame);
        canvas.paste(&inset, [left, top], 18.0);
        canvas.frame(frame, 18.0, 2.5, PALE);
        ruler(&mut canvas, &near, centre, [width, height], [frame[0] + 24.0, foot - 28.0]);
    }

    canvas.text(&caption.title, [56.0, 84.0], Align::Left, 30.0, INK);
    canvas.text(&caption.subtitle, [56.0, 132.0], Align::Left, 19.0, PALE);
    ruler(&mut canvas, &whole, mesh.local_aabb().center(), size, [56.0, 1164.0]);
    let bar = [left as f32, foot + 74.0];
    let size = [width as f32 - 72.0, 24.0];
    colours.draw(&mut canvas, bar, size, "distance from link to wall, mm", INK);
    let foot = [bar[0], bar[1] + 118.0];
    legend(&mut canvas, foot, colours.colour(0.5 * colours.end), &caption.closest);
    if !pieces.is_empty() {
        outline_legend(&mut canvas, [foot[0], foot[1] + 3.0 * ROW as f32]);
    }
    canvas
}

/// Marks a place, with a pale edge that shows on every ground, in grey too.
pub fn ring(canvas: &mut Canvas, [x, y]: [f32; 2], radius: f32) {
    let around = [x - radius, y - radius, x + radius, y + radius];
    canvas.frame(around, radius, 9.0, SKY[0]);
    canvas.frame(around, radius, 4.5, MARK);
}

/// The legend of the ring, the lines and the tinted triangles; `at` is the left end of the base
/// line.
fn legend(canvas: &mut Canvas, at: [f32; 2], tint: Colour, closest: &str) {
    let [x, y] = at;
    ring(canvas, [x + 25.0, y - 8.0], 11.0);
    canvas.text(closest, [x + 66.0, y], Align::Left, 18.0, INK);
    let y = y + ROW as f32;
    canvas.stroke(&[vec![[x, y - 7.0], [x + 44.0, y - 7.0]]], 3.0, INK, 1.0);
    canvas.panel([x + 38.0, y - 13.0, x + 50.0, y - 1.0], 6.0, INK, 1.0);
    canvas.text("closest points of a link and the wall", [x + 66.0, y], Align::Left, 18.0, INK);
    let y = y + ROW as f32;
    // Filled line by line.
    let rows = (0..=22).map(|row| row as f32).map(|row| {
        let half = 0.9 * row;
        vec![[x + 25.0 - half, y - 20.0 + row], [x + 25.0 + half, y - 20.0 + row]]
    });
    canvas.stroke(&rows.collect::<Vec<_>>(), 1.4, tint, 1.0);
    canvas.text(
        "nearest triangle of a link, in the link's colour",
        [x + 66.0, y],
        Align::Left,
        18.0,
        INK,
    );
}

/// The legend of the outlines.
fn outline_legend(canvas: &mut Canvas, [x, y]: [f32; 2]) {
    let [one, other] = OUTLINES;
    canvas.panel([x, y - 19.0, x + 50.0, y + 3.0], 4.0, INK, 0.8);
    canvas.frame([x + 3.0, y - 15.0, x + 29.0, y - 1.0], 6.0, 2.5, one);
    canvas.frame([x + 27.0, y - 13.0, x + 47.0, y - 3.0], 5.0, 2.5, other);
    canvas.text("bodies in which the curve was searched", [x + 66.0, y], Align::Left, 18.0, INK);
}

/// Links, and the lines between closest points.
fn solids(
    robot: &Chain,
    pose: &Pose,
    answers: &[LinkProximity],
    colours: &ColourMap,
    thick: Real,
) -> Vec<Solid> {
    let mut solids = Vec::new();
    for (link, answer) in robot.links().iter().zip(answers) {
        let colour = colours.colour(answer.distance);
        solids.push(Solid::new(SharedShape::new(*link), *pose, colour, true));
        let line = answer.witness.on_mesh - answer.witness.on_robot;
        if line != Vector::ZERO {
            let middle = Pose::from_parts(
                answer.witness.on_robot.midpoint(answer.witness.on_mesh),
                Rot3::from_rotation_arc(Vector::Y, line.normalize()),
            );
            solids.push(Solid::new(
                SharedShape::cylinder(0.5 * line.length(), 0.045 * thick),
                middle,
                INK,
                false,
            ));
            let end = Pose::from_translation(answer.witness.on_mesh);
            solids.push(Solid::new(SharedShape::ball(0.11 * thick), end, INK, false));
        }
    }
    solids
}

/// Shows which part of the left picture the close-up shows.
fn lens(canvas: &mut Canvas, places: &[[f32; 2]], inset: [f32; 4]) {
    let side = |axis: usize, pick: fn(f32, f32) -> f32| {
        places.iter().map(|p| p[axis]).reduce(pick).unwrap_or(0.0)
    };
    let margin = 14.0;
    let frame = [
        side(0, f32::min) - margin,
        side(1, f32::min) - margin,
        side(0, f32::max) + margin,
        side(1, f32::max) + margin,
    ];
    for (from, to) in [(frame[1], inset[1]), (frame[3], inset[3])] {
        canvas.stroke(&[vec![[frame[2] - 5.0, from], [inset[0] + 9.0, to]]], 1.6, PALE, 0.55);
    }
    canvas.frame(frame, 10.0, 2.0, PALE);
}

/// How many pixels a millimetre has at the given depth.
fn scale(camera: &Camera, depth: Vector, size: [usize; 2]) -> f32 {
    let [from, to] = [depth, depth + camera.right].map(|p| camera.place(p, size)[0]);
    to - from
}

/// A ruler as long as a round number of millimetres at the given depth, with its left end at `at`.
pub fn ruler(canvas: &mut Canvas, camera: &Camera, depth: Vector, size: [usize; 2], at: [f32; 2]) {
    let unit = f64::from(scale(camera, depth, size));
    let decade = 10f64.powf((150.0 / unit).log10().floor());
    let length = [5.0, 2.0, 1.0]
        .into_iter()
        .map(|n| n * decade)
        .find(|n| n * unit <= 170.0)
        .unwrap_or(decade);
    let right = at[0] + (length * unit) as f32;
    let ends = [at[0], right].map(|x| vec![[x, at[1] - 7.0], [x, at[1] + 7.0]]);
    canvas.stroke(&[vec![at, [right, at[1]]], ends[0].clone(), ends[1].clone()], 2.5, INK, 1.0);
    canvas.text(&format!("{length} mm"), [right + 14.0, at[1] + 8.0], Align::Left, 17.0, INK);
}
