//! A ray-caster: the wall as a translucent skin, solids inside it, seen through parry's `RayCast`
//! trait.
//!
//! A ray that enters the lumen meets the skin from outside, where it is transparent except at
//! grazing angles. A ray that leaves the lumen meets the far side, which is drawn as tissue. So the
//! inside is visible without a cut. Any `Shape` is a solid: rays hit it by
//! `cast_ray_and_get_normal`, and it darkens the tissue near it by `distance_to_point`, which shows
//! its height above the tissue.

use crate::canvas::{Canvas, Colour, hex, mix};
use parry_continuum::parry::bounding_volume::{Aabb, BoundingVolume};
use parry_continuum::parry::math::{Pose, Real, Vector};
use parry_continuum::parry::query::{PointQuery, Ray, RayCast};
use parry_continuum::parry::shape::{SharedShape, TriMesh};
use rayon::prelude::*;
use std::collections::HashMap;

/// Where the picture is taken from.
#[derive(Clone, Copy)]
pub struct Camera {
    pub eye: Vector,
    pub forward: Vector,
    pub up: Vector,
    pub right: Vector,
    /// Half the vertical field of view, as a tangent.
    pub spread: Real,
    /// Depth before which nothing is seen: a cut through the scene.
    pub cut: Real,
}

impl Camera {
    /// A camera looking along `forward` from as near as shows every point, with `margin` (a share
    /// of the frame) around.
    pub fn framing(
        points: &[Vector],
        forward: Vector,
        up: Vector,
        aspect: Real,
        margin: Real,
    ) -> Self {
        let forward = forward.normalize();
        let right =
            forward.cross(up).try_normalize().unwrap_or_else(|| forward.any_orthonormal_vector());
        let up = right.cross(forward);
        let spread = 0.21;
        let tall = spread * (1.0 - 2.0 * margin);
        let (mut centre, mut back) = (Vector::ZERO, 0.0);
        for _ in 0..6 {
            // The frame's four sides in perspective: move the centre so that the points lie evenly
            // between them.
            let (mut low, mut high) = ([Real::MAX; 2], [Real::MIN; 2]);
            back = Real::MIN;
            for &p in points {
                let q = p - centre;
                let [x, y] = [q.dot(right), q.dot(up)];
                low = [low[0].min(x), low[1].min(y)];
                high = [high[0].max(x), high[1].max(y)];
                back = back.max((x.abs() / aspect).max(y.abs()) / tall - q.dot(forward));
            }
            centre += (right * (low[0] + high[0]) + up * (low[1] + high[1])) * 0.5;
        }
        for &p in points {
            let q = p - centre;
            back = back
                .max((q.dot(right).abs() / aspect).max(q.dot(up).abs()) / tall - q.dot(forward));
        }
        Self { eye: centre - forward * back, forward, up, right, spread, cut: 0.0 }
    }

    /// The place of a point in a picture of the given size, in pixels.
    pub fn place(&self, p: Vector, [width, height]: [usize; 2]) -> [f32; 2] {
        let q = p - self.eye;
        let scale = 0.5 * height as Real / (self.spread * q.dot(self.forward));
        [
            (0.5 * width as Real + q.dot(self.right) * scale) as f32,
            (0.5 * height as Real - q.dot(self.up) * scale) as f32,
        ]
    }
}

/// Most tests of programs set it: the second rays take most of the time.
pub const ROUGH: &str = "CONTINUUM_DEMO_ROUGH";

/// A thing in the picture.
pub struct Solid {
    shape: SharedShape,
    pose: Pose,
    aabb: Aabb,
    colour: Colour,
    /// Whether it darkens the tissue near it.
    shades: bool,
}

impl Solid {
    pub fn new(shape: SharedShape, pose: Pose, colour: Colour, shades: bool) -> Self {
        let aabb = shape.compute_aabb(&pose);
        Self { shape, pose, aabb, colour, shades }
    }
}

/// Everything in the picture.
pub struct Picture<'a> {
    wall: Option<&'a TriMesh>,
    normals: Vec<Vector>,
    /// Triangles of the wall in a colour of their own.
    pub tints: HashMap<u32, Colour>,
    solids: Vec<Solid>,
    aabb: Aabb,
    /// How far shading by a nearby solid reaches.
    reach: Real,
    pub skin: Skin,
    /// The backdrop's colour at the top and at the bottom.
    pub sky: [Colour; 2],
}

/// How the wall looks: opacities.
#[derive(Clone, Copy)]
pub struct Skin {
    /// Of the near side, seen straight on.
    pub near: f32,
    /// Of the near side, seen at a grazing angle.
    pub rim: f32,
    /// Of the lamp's reflection in the near side.
    pub glint: f32,
    /// Of the far side.
    pub far: f32,
    /// Of the triangles' edges, on the near and the far side.
    pub edges: [f32; 2],
    /// What is in front of a solid is this share as opaque.
    pub veil: f32,
}

const GLASS: Colour = hex(0xdbe7ee);
const GLASS_EDGE: Colour = hex(0x35607d);
const TISSUE: Colour = hex(0xf3bfae);
const TISSUE_DEEP: Colour = hex(0x6e3138);
const INK: Colour = hex(0x3d4a57);
pub const SKY: [Colour; 2] = [hex(0xfdfcfa), hex(0xdfe5ea)];

impl<'a> Picture<'a> {
    pub fn new(wall: Option<&'a TriMesh>, solids: Vec<Solid>) -> Self {
        let mut aabb = Aabb::new_invalid();
        for solid in &solids {
            aabb.merge(&solid.aabb);
        }
        let reach =
            3.0 * solids.iter().map(|s| s.aabb.half_extents().min_element()).fold(0.0, Real::max);
        let normals = wall.map(vertex_normals).unwrap_or_default();
        Self {
            wall,
            normals,
            tints: HashMap::new(),
            solids,
            aabb,
            reach,
            skin: Skin {
                near: 0.05,
                rim: 0.8,
                glint: 0.5,
                far: 0.72,
                edges: [0.16, 0.2],
                veil: 1.0,
            },
            sky: SKY,
        }
    }

    /// Renders the picture: once per pixel, then nine times where neighbours differ. Once only if
    /// the environment variable [`ROUGH`] is set.
    pub fn render(&self, camera: &Camera, width: usize, height: usize) -> Canvas {
        let mut canvas = Canvas::new(width, height, |_, _| [0.0; 3]);
        let look = |x: f64, y: f64| {
            let across = (2.0 * x - width as f64) / height as f64 * camera.spread;
            let up = (1.0 - 2.0 * y / height as f64) * camera.spread;
            let towards = camera.forward + camera.right * across + camera.up * up;
            let ray = Ray::new(camera.eye + towards * camera.cut, towards.normalize());
            let backdrop = mix(self.sky[0], self.sky[1], (y / height as f64) as f32);
            self.look(&ray, camera, backdrop, 2.0 * camera.spread / height as Real)
        };
        canvas.pixels.par_chunks_mut(width).enumerate().for_each(|(y, row)| {
            for (x, pixel) in row.iter_mut().enumerate() {
                *pixel = look(x as f64 + 0.5, y as f64 + 0.5);
            }
        });
        if std::env::var_os(ROUGH).is_some() {
            return canvas;
        }
        let rough = canvas.pixels.clone();
        let differs = |x: usize, y: usize| {
            let here = rough[y * width + x];
            let near = [(x.wrapping_sub(1), y), (x + 1, y), (x, y.wrapping_sub(1)), (x, y + 1)];
            near.iter().filter(|(x, y)| *x < width && *y < height).any(|(x, y)| {
                let there = rough[y * width + x];
                (0..3).any(|i| (here[i].sqrt() - there[i].sqrt()).abs() > 0.025)
            })
        };
        canvas.pixels.par_chunks_mut(width).enumerate().for_each(|(y, row)| {
            for (x, pixel) in row.iter_mut().enumerate().filter(|(x, _)| differs(*x, y)) {
                let mut sum = [0.0; 3];
                for sample in 0..9 {
                    let (dx, dy) = ((sample % 3) as f64 / 3.0, (sample / 3) as f64 / 3.0);
                    let seen = look(x as f64 + dx + 1.0 / 6.0, y as f64 + dy + 1.0 / 6.0);
                    sum = std::array::from_fn(|i| sum[i] + seen[i].min(1.0) / 9.0);
                }
                *pixel = sum;
            }
        });
        canvas
    }

    /// The hits of a ray: layers of skin from near to far, up to a solid or the backdrop.
    fn look(&self, ray: &Ray, camera: &Camera, backdrop: Colour, pixel: Real) -> Colour {
        let solid = self.nearest(ray);
        let limit = solid.map_or(1e3 * camera.eye.length().max(1.0), |(_, t, _)| t);
        let mut seen = [0.0; 3];
        let mut clear = 1.0;
        if let Some(wall) = self.wall {
            let step = 1e-7 * limit;
            let mut start = 0.0;
            while clear > 0.02 {
                let rest = Ray::new(ray.point_at(start), ray.dir);
                let Some(hit) = wall.cast_local_ray_and_get_normal(&rest, limit - start, false)
                else {
                    break;
                };
                let t = start + hit.time_of_impact;
                let (colour, mut opacity) = self.skin(wall, ray, t, hit.subshape, camera, pixel);
                if solid.is_some() {
                    opacity *= self.skin.veil;
                }
                seen = std::array::from_fn(|i| seen[i] + clear * opacity * colour[i]);
                clear *= 1.0 - opacity;
                start = t + step;
            }
        }
        let behind = solid
            .map_or(backdrop, |(solid, _, normal)| gloss(solid.colour, normal, ray.dir, camera));
        std::array::from_fn(|i| seen[i] + clear * behind[i])
    }

    /// The first solid on the ray, where, and its normal there.
    fn nearest(&self, ray: &Ray) -> Option<(&Solid, Real, Vector)> {
        self.aabb.cast_local_ray(ray, Real::MAX, true)?;
        let mut best: Option<(&Solid, Real, Vector)> = None;
        for solid in &self.solids {
            let limit = best.map_or(Real::MAX, |(_, t, _)| t);
            if solid.aabb.cast_local_ray(ray, limit, true).is_some()
                && let Some(hit) = solid.shape.cast_ray_and_get_normal(&solid.pose, ray, limit, true)
                // Where two surfaces coincide, as the balls at a joint do, the first one shows.
                && hit.time_of_impact < limit * (1.0 - 1e-9)
            {
                best = Some((solid, hit.time_of_impact, hit.normal));
            }
        }
        best
    }

    /// Colour and opacity of the wall where the ray meets it; `pixel` is a pixel's size at depth 1.
    fn skin(
        &self,
        wall: &TriMesh,
        ray: &Ray,
        t: Real,
        id: u32,
        camera: &Camera,
        pixel: Real,
    ) -> (Colour, f32) {
        let p = ray.point_at(t);
        let pixel = pixel * (p - camera.eye).dot(camera.forward);
        let corners = wall.indices()[id as usize].map(|i| i as usize);
        let [a, b, c] = corners.map(|i| wall.vertices()[i]);
        let flat = (b - a).cross(c - a);
        let share = [(c - b).cross(p - b), (a - c).cross(p - c), (b - a).cross(p - a)]
            .map(|cross| cross.dot(flat) / flat.length_squared());
        let smooth: Vector = (0..3).map(|i| self.normals[corners[i]] * share[i].max(0.0)).sum();
        let normal = smooth.try_normalize().unwrap_or(-ray.dir);
        let entering = flat.dot(ray.dir) < 0.0;
        let facing = normal.dot(ray.dir).abs() as f32;
        let grazing = (1.0 - facing).powi(3);

        let heights =
            [(c - b).length(), (a - c).length(), (b - a).length()].map(|side| flat.length() / side);
        let to_edge =
            (0..3).map(|i| share[i].max(0.0) * heights[i]).fold(Real::MAX, Real::min) / pixel;
        let fades =
            ((heights.into_iter().fold(Real::MAX, Real::min) / pixel - 6.0) / 20.0).clamp(0.0, 1.0);
        let line = self.skin.edges[usize::from(!entering)]
            * ((1.1 - to_edge).clamp(0.0, 1.0) * fades) as f32;

        let (mut colour, mut opacity) = if entering {
            let colour = mix(GLASS, GLASS_EDGE, grazing);
            let glint = self.skin.glint * shine(normal, ray.dir, camera, 60.0);
            (
                mix(colour, [1.0; 3], glint.min(1.0)),
                self.skin.near + self.skin.rim * grazing + glint,
            )
        } else {
            let light = light(-normal, camera) * (1.0 - 0.62 * self.shade(p));
            (mix(TISSUE_DEEP, TISSUE, light), self.skin.far + (1.0 - self.skin.far) * grazing)
        };
        if let Some(tint) = self.tints.get(&id) {
            colour = mix(colour, *tint, 0.85);
            opacity = opacity.max(if entering { 0.3 } else { 0.85 });
        }
        (mix(colour, INK, line), (opacity + line).min(1.0))
    }

    /// How much the solids keep light from a point of the wall.
    fn shade(&self, p: Vector) -> f32 {
        if self.aabb.distance_to_local_point(p, true) > self.reach {
            return 0.0;
        }
        let near = self
            .solids
            .iter()
            .filter(|s| s.shades && s.aabb.distance_to_local_point(p, true) < self.reach);
        let distance =
            near.map(|s| s.shape.distance_to_point(&s.pose, p, true)).fold(self.reach, Real::min);
        (1.0 - distance / self.reach).powi(2) as f32
    }
}

/// The light on a surface: a lamp above the camera's left shoulder, a softer one from the right,
/// and the sky.
fn light(normal: Vector, camera: &Camera) -> f32 {
    let lamp = (camera.up * 0.75 - camera.right * 0.55 - camera.forward * 0.7).normalize();
    let other = (camera.right * 0.9 - camera.forward * 0.4).normalize();
    let wrap = |direction: Vector| (0.5 + 0.5 * normal.dot(direction)).powi(2);
    (0.12 + 0.75 * wrap(lamp) + 0.22 * wrap(other)) as f32
}

/// The lamp's reflection.
fn shine(normal: Vector, towards: Vector, camera: &Camera, sharpness: Real) -> f32 {
    let lamp = (camera.up * 0.75 - camera.right * 0.55 - camera.forward * 0.7).normalize();
    let halfway = (lamp - towards).normalize();
    halfway.dot(normal).max(0.0).powf(sharpness) as f32
}

/// The colour of a solid's surface.
fn gloss(colour: Colour, normal: Vector, towards: Vector, camera: &Camera) -> Colour {
    let lit = light(normal, camera) * 1.15;
    let rim = (1.0 + normal.dot(towards)).clamp(0.0, 1.0).powi(3) as f32;
    let glint = 0.35 * shine(normal, towards, camera, 50.0);
    std::array::from_fn(|i| (colour[i] * lit * (1.0 - 0.45 * rim) + glint).min(1.0))
}

/// Smooth normals: the mean normal of the triangles around each vertex, weighted by their angles.
fn vertex_normals(mesh: &TriMesh) -> Vec<Vector> {
    let mut normals = vec![Vector::ZERO; mesh.vertices().len()];
    for triangle in mesh.indices() {
        let p = triangle.map(|i| mesh.vertices()[i as usize]);
        let normal = (p[1] - p[0]).cross(p[2] - p[0]).normalize_or_zero();
        for i in 0..3 {
            let (one, two) = (p[(i + 1) % 3] - p[i], p[(i + 2) % 3] - p[i]);
            let angle = one.cross(two).length().atan2(one.dot(two));
            normals[triangle[i] as usize] += normal * angle;
        }
    }
    normals.into_iter().map(Vector::normalize_or_zero).collect()
}
