//! The answers about one robot, as arrays for JavaScript.

use crate::flat;
use crate::placement::Placement;
use parry_continuum::parry::math::Real;
use parry_continuum::proximity::{LinkProximity, Side};
use parry_continuum::{Cap, ModifiedCylinder};
use wasm_bindgen::prelude::wasm_bindgen;

/// How far each link of a robot is from the wall, and where the links are.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Answers {
    pub(crate) links: Vec<LinkProximity>,
    pub(crate) minimum: LinkProximity,
    pub(crate) base: Side,
    pub(crate) tip: Side,
    pub(crate) sides: Vec<Side>,
    pub(crate) robot: Vec<ModifiedCylinder>,
    pub(crate) placement: Placement,
}

#[wasm_bindgen]
impl Answers {
    pub fn distances(&self) -> Vec<Real> {
        self.links.iter().map(|link| link.distance).collect()
    }

    /// The closest points on the robot.
    pub fn on_robot(&self) -> Vec<Real> {
        flat(self.links.iter().map(|link| &link.witness.on_robot))
    }

    /// The closest points on the wall.
    pub fn on_mesh(&self) -> Vec<Real> {
        flat(self.links.iter().map(|link| &link.witness.on_mesh))
    }

    /// The index of the closest link, from 0.
    pub fn closest(&self) -> u32 {
        self.minimum.link
    }

    pub fn minimum(&self) -> Real {
        self.minimum.distance
    }

    /// How far along the robot the closest point is.
    pub fn arc_length(&self) -> Real {
        self.minimum.witness.arc_length
    }

    /// What looks like a mistake in frame or unit: a line for each doubt.
    pub fn doubts(&self) -> Vec<String> {
        self.placement.doubts.clone()
    }

    /// From which frame to which one the robot was turned, if it was.
    pub fn turned(&self) -> Option<String> {
        self.placement.turned.map(|[from, to]| format!("{} to {}", from.name(), to.name()))
    }

    /// Of the robot's base: `inside`, `outside` or `undecided`.
    pub fn base(&self) -> String {
        name(self.base).to_owned()
    }

    /// Of the robot's tip, in the same words.
    pub fn tip(&self) -> String {
        name(self.tip).to_owned()
    }

    /// Of each link, in the same words. A link that touches the wall or crosses an opening is
    /// `undecided`.
    pub fn sides(&self) -> Vec<String> {
        self.sides.iter().map(|side| name(*side).to_owned()).collect()
    }

    /// Whether every link is inside.
    pub fn is_inside(&self) -> bool {
        self.sides.iter().all(|side| *side == Side::Inside)
    }

    /// The two ends of each link.
    pub fn ends(&self) -> Vec<Real> {
        let pose = self.placement.pose;
        let ends = self.robot.iter().flat_map(|link| [pose * link.start(), pose * link.end()]);
        flat(&ends.collect::<Vec<_>>())
    }

    /// The length of each link.
    pub fn lengths(&self) -> Vec<Real> {
        self.robot.iter().map(|link| link.length()).collect()
    }

    pub fn radii(&self) -> Vec<Real> {
        self.robot.iter().map(|link| link.radius()).collect()
    }

    /// Whether the two caps of each link are round: 1, or 0 if flat.
    pub fn is_round(&self) -> Vec<u8> {
        let caps = self.robot.iter().flat_map(|link| link.caps());
        caps.map(|cap| u8::from(cap == Cap::Round)).collect()
    }
}

fn name(side: Side) -> &'static str {
    match side {
        Side::Inside => "inside",
        Side::Outside => "outside",
        Side::Undecided => "undecided",
    }
}
