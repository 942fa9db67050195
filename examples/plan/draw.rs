//! The picture of a way: six moments of it, the wall cut open in front of the robot, each link in
//! the colour of its distance.

use super::edges::{Edges, Place, text};
use continuum_demo::canvas::{Align, Canvas, Colour, hex};
use continuum_demo::colour_map::ColourMap;
use continuum_demo::figure::{FARTHEST, ruler};
use continuum_demo::joint_motion::JointMotion;
use continuum_demo::picture::{Camera, Picture, SKY, Skin, Solid};
use parry_continuum::parry::math::{Real, Vector};
use parry_continuum::parry::shape::{SharedShape, TriMesh};
use parry_continuum::proximity::{LinkProximity, Proximity};
use parry_continuum::{Chain, ModifiedCylinder};

const INK: Colour = hex(0x22303c);
const PALE: Colour = hex(0x66757f);
/// The pictures in rows and columns, the size of each, and what is between them.
const GRID: [usize; 2] = [3, 2];
const PANEL: [usize; 2] = [600, 440];
const GAP: usize = 16;
/// How high the head and the foot are.
const HEAD: usize = 110;
const FOOT: usize = 120;

/// How long a link is about, mm.
const LINK: Real = 1.0;

/// Shapes per edge from which the length of the tip's path is measured.
const STEPS: u32 = 100;

/// A moment of the way.
struct Moment {
    chain: Chain,
    found: Vec<LinkProximity>,
}

impl Moment {
    /// The links at a time of a motion, and how far the wall is from each.
    fn new(edges: &mut Edges, motion: &JointMotion, t: Real) -> Result<Self, String> {
        let joints = motion.joints(t);
        let links = (edges.robot.length(&joints) / LINK).ceil() as usize;
        let line = edges.robot.centreline(&joints, links);
        let chain = Chain::from_centreline(&line.points, &line.radii).map_err(text)?;
        let mut found = Vec::new();
        edges.search.per_link(&chain, &edges.base, &mut found).map_err(text)?;
        Ok(Self { chain, found })
    }

    fn least(&self) -> Real {
        self.found.iter().map(|link| link.distance).fold(Real::INFINITY, Real::min)
    }
}

/// Draws the way through what is called `name`.
pub fn draw(
    mesh: &TriMesh,
    name: &str,
    edges: &mut Edges,
    path: &[Place],
) -> Result<Canvas, String> {
    let moments = moments(edges, path)?;
    let ends = |link: &ModifiedCylinder| [edges.base * link.start(), edges.base * link.end()];
    let places: Vec<_> =
        moments.iter().flat_map(|moment| moment.chain.links()).flat_map(ends).collect();
    let side = if edges.base.translation.x < mesh.local_aabb().center().x { 1.0 } else { -1.0 };
    let aspect = PANEL[0] as Real / PANEL[1] as Real;
    let mut camera =
        Camera::framing(&places, Vector::new(side, -0.55, -0.32), Vector::Z, aspect, 0.12);
    let depths = places.iter().map(|&p| (p - camera.eye).dot(camera.forward) - 2.0);
    camera.cut = depths.fold(Real::INFINITY, Real::min).max(0.0);

    let colours = ColourMap::up_to(FARTHEST);
    let width = GRID[0] * (PANEL[0] + GAP) + GAP;
    let height = HEAD + GRID[1] * (PANEL[1] + GAP) + FOOT;
    let mut canvas = Canvas::new(width, height, |_, _| SKY[0]);
    for (number, moment) in moments.iter().enumerate() {
        let solid = |(link, found): (&ModifiedCylinder, &LinkProximity)| {
            Solid::new(SharedShape::new(*link), edges.base, colours.colour(found.distance), true)
        };
        let solids = moment.chain.links().iter().zip(&moment.found).map(solid).collect();
        let mut picture = Picture::new(Some(mesh), solids);
        // Folds of the wall between the eye and the robot let it show through.
        picture.skin =
            Skin { near: 0.0, rim: 0.4, glint: 0.05, far: 0.85, edges: [0.03, 0.2], veil: 0.25 };
        let at =
            [GAP + number % GRID[0] * (PANEL[0] + GAP), HEAD + number / GRID[0] * (PANEL[1] + GAP)];
        canvas.paste(&picture.render(&camera, PANEL[0], PANEL[1]), at, 12.0);
        let [x, y] = at.map(|place| place as f32);
        canvas.frame([x, y, x + PANEL[0] as f32, y + PANEL[1] as f32], 12.0, 2.0, PALE);
        let place = match number {
            0 => " start",
            _ if number + 1 == moments.len() => " goal",
            _ => "",
        };
        let label = format!("{}{place}: {:.2} mm", number + 1, moment.least());
        canvas.panel([x + 10.0, y + 10.0, x + 190.0, y + 46.0], 8.0, SKY[0], 0.85);
        canvas.text(&label, [x + 20.0, y + 35.0], Align::Left, 17.0, INK);
    }
    let title = format!("A way into {name}, proven at every moment");
    canvas.text(&title, [GAP as f32 + 4.0, 48.0], Align::Left, 26.0, INK);
    let note = format!(
        "{} edges, each proven to keep {} mm from the wall; six moments of it, and how far the nearest link is",
        path.len() - 1,
        edges.margin
    );
    canvas.text(&note, [GAP as f32 + 4.0, 86.0], Align::Left, 17.0, PALE);
    let foot = height as f32 - FOOT as f32;
    let middle = places.iter().sum::<Vector>() / places.len() as Real;
    ruler(&mut canvas, &camera, middle, PANEL, [GAP as f32 + 4.0, foot + 52.0]);
    // At whole pixels, so that the colours stay what they are.
    let bar = [(0.4 * width as f32).round(), foot + 48.0];
    let size = [(0.53 * width as f32).round(), 22.0];
    colours.draw(&mut canvas, bar, size, "distance from link to wall, mm", INK);
    Ok(canvas)
}

/// As many moments as there are pictures, between which the tip moves as far each time.
fn moments(edges: &mut Edges, path: &[Place]) -> Result<Vec<Moment>, String> {
    let (mut moved, mut ways) = (0.0, Vec::new());
    for ends in path.windows(2) {
        let motion = edges.motion(&ends[0], &ends[1])?;
        let mut tip = motion.tip(0.0);
        for k in 0..=STEPS {
            let t = Real::from(k) / Real::from(STEPS);
            moved += (motion.tip(t) - tip).length();
            tip = motion.tip(t);
            ways.push((moved, ways.len() / (STEPS as usize + 1), t));
        }
    }
    let count = GRID[0] * GRID[1];
    let mut moments = Vec::new();
    for number in 0..count {
        let wanted = moved * number as Real / (count - 1) as Real;
        let place = ways.partition_point(|(moved, ..)| *moved < wanted).min(ways.len() - 1);
        let (_, edge, t) = ways[if number + 1 == count { ways.len() - 1 } else { place }];
        let motion = edges.motion(&path[edge], &path[edge + 1])?;
        moments.push(Moment::new(edges, &motion, t)?);
    }
    Ok(moments)
}
