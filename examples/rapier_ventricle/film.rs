//! Pictures of the simulation: the robot in the colours of its clearances, the kinematic shape as a
//! dark wire. The wire shows where the wall has bent the robot away from it, and dots where the
//! wall holds it.

use super::record::Moment;
use continuum_demo::canvas::{Align, Canvas, Colour, hex, mix};
use continuum_demo::colour_map::ColourMap;
use continuum_demo::figure;
use continuum_demo::picture::{Camera, Picture, SKY, Skin, Solid};
use parry_continuum::ModifiedCylinder;
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::shape::{SharedShape, TriMesh};

const INK: Colour = hex(0x22303c);
const PALE: Colour = hex(0x66757f);
const WIRE: Colour = hex(0x10161c);
const CONTACT: Colour = hex(0xd55e00);
const PANEL: [usize; 2] = [456, 342];
/// The height of the two lines below it.
const CAPTION: usize = 56;
const GAP: usize = 20;
const HEAD: usize = 84;
const FOOT: usize = 96;

/// How the scene is seen.
pub struct Studio<'a> {
    mesh: &'a TriMesh,
    camera: Camera,
    colours: ColourMap,
    wire: Real,
    /// A point at the depth of the robot, for the ruler.
    middle: Vector,
}

impl<'a> Studio<'a> {
    /// A view of the whole way, given where the robot will be: from where it is broadest, cut open
    /// in front of it.
    pub fn new(mesh: &'a TriMesh, places: &[Vector], radius: Real) -> Self {
        let [first, middle, last] = [0, places.len() / 2, places.len() - 1]
            .map(|k| places.get(k).copied().unwrap_or_default());
        let side = if first.x < mesh.local_aabb().center().x { 1.0 } else { -1.0 };
        let towards = Vector::new(side, -0.55, -0.32).normalize();
        let broadside = (middle - first).cross(last - first).normalize_or_zero();
        let broadside = if broadside.dot(towards) < 0.0 { -broadside } else { broadside };
        let aspect = PANEL[0] as Real / PANEL[1] as Real;
        let mut camera =
            Camera::framing(places, broadside + towards * 0.5, Vector::Z, aspect, 0.14);
        let depths = places.iter().map(|&p| (p - camera.eye).dot(camera.forward) - 2.5 * radius);
        camera.cut = depths.fold(Real::INFINITY, Real::min).max(0.0);
        Self { mesh, camera, colours: ColourMap::up_to(3.0), wire: 0.16 * radius, middle }
    }

    /// A picture of one moment with a line of text.
    pub fn frame(&self, moment: &Moment) -> Canvas {
        let mut solids: Vec<_> = moment
            .robot
            .links()
            .iter()
            .zip(&moment.found)
            .map(|(link, found)| {
                Solid::new(
                    SharedShape::new(*link),
                    Pose::IDENTITY,
                    self.colours.colour(found.distance),
                    true,
                )
            })
            .collect();
        for ends in moment.planned.windows(2) {
            if let Ok(wire) = ModifiedCylinder::capsule(ends[0], ends[1], self.wire) {
                solids.push(Solid::new(SharedShape::new(wire), Pose::IDENTITY, WIRE, false));
            }
        }
        for (found, _) in moment.found.iter().zip(&moment.forces).filter(|(_, force)| **force > 0.0)
        {
            let dot = SharedShape::ball(4.0 * self.wire);
            solids.push(Solid::new(
                dot,
                Pose::from_translation(found.witness.on_mesh),
                CONTACT,
                false,
            ));
        }
        let mut picture = Picture::new(Some(self.mesh), solids);
        picture.skin =
            Skin { near: 0.0, rim: 0.45, glint: 0.06, far: 0.88, edges: [0.04, 0.3], veil: 1.0 };
        picture.sky = SKY;
        let mut canvas = Canvas::new(PANEL[0], PANEL[1] + CAPTION, |_, _| SKY[0]);
        canvas.paste(&picture.render(&self.camera, PANEL[0], PANEL[1]), [0, 0], 0.0);
        figure::ruler(
            &mut canvas,
            &self.camera,
            self.middle,
            PANEL,
            [16.0, PANEL[1] as f32 - 18.0],
        );
        let (clearance, _) = moment.closest();
        let held = if moment.force() > 0.0 {
            format!("{:.0} mN", moment.force())
        } else {
            "no contact".into()
        };
        let lines = [
            format!(
                "{:.2} s: {:.1} mm out, pushed {:.1} mm",
                moment.time, moment.out, moment.pushed
            ),
            format!(
                "clearance {clearance:.2} mm, {held}, tip off by {:.2} mm",
                moment.tip_deviation()
            ),
        ];
        for (row, line) in lines.iter().enumerate() {
            let y = (PANEL[1] + 22 + 24 * row) as f32;
            canvas.text(line, [14.0, y], Align::Left, 12.0, INK);
        }
        canvas
    }

    /// Six moments on one sheet, with the meaning of the colours.
    pub fn sheet(&self, moments: &[Moment]) -> Canvas {
        let width = 3 * PANEL[0] + 4 * GAP;
        let tall = PANEL[1] + CAPTION;
        let height = HEAD + 2 * (tall + GAP) + FOOT;
        let mut sheet =
            Canvas::new(width, height, |_, y| mix(SKY[0], SKY[1], y as f32 / height as f32));
        for (k, moment) in moments.iter().take(6).enumerate() {
            let (left, top) = (GAP + (k % 3) * (PANEL[0] + GAP), HEAD + (k / 3) * (tall + GAP));
            sheet.paste(&self.frame(moment), [left, top], 12.0);
            let corner = [left as f32, top as f32];
            let frame =
                [corner[0], corner[1], corner[0] + PANEL[0] as f32, corner[1] + tall as f32];
            sheet.frame(frame, 12.0, 2.0, PALE);
        }
        let title = "An elastic concentric tube robot is pushed into a ventricle";
        sheet.text(title, [GAP as f32, 54.0], Align::Left, 24.0, INK);
        let bar = [GAP as f32, (height - FOOT + 32) as f32];
        let size = [0.45 * width as f32, 16.0];
        self.colours.draw(&mut sheet, bar, size, "distance from link to wall, mm", INK);
        for (row, note) in [
            "dark wire: the kinematic shape, where the robot is bent away from it",
            "orange dots: contacts; mN: the sum of the magnitudes of their forces",
        ]
        .into_iter()
        .enumerate()
        {
            let at = [width as f32 - GAP as f32, bar[1] + 4.0 + 28.0 * row as f32];
            sheet.text(note, at, Align::Right, 14.0, INK);
        }
        sheet
    }
}
