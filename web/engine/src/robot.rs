use crate::csv;
use continuum_demo::ctr::{Joints, three_tubes};
use continuum_demo::ventricle;
use parry_continuum::Chain;
use parry_continuum::parry::math::Real;
use wasm_bindgen::prelude::wasm_bindgen;

/// How many links stand for the tubes.
const LINKS: usize = 30;

/// A robot: concentric tubes, or the user's points.
#[wasm_bindgen]
pub struct Robot {
    chain: Chain,
    stands_at_entry: bool,
}

#[wasm_bindgen]
impl Robot {
    /// Three concentric tubes, each so far out of the one around it and turned by an angle (rad).
    ///
    /// # Errors
    /// Nothing is out.
    pub fn of_tubes(extensions: &[Real], angles: &[Real]) -> Result<Robot, String> {
        let joints = Joints { extensions: extensions.to_vec(), angles: angles.to_vec() };
        let line = three_tubes().centreline(&joints, LINKS);
        let chain =
            Chain::from_centreline(&line.points, &line.radii).map_err(|error| error.to_string())?;
        Ok(Self { chain, stands_at_entry: true })
    }

    /// Points in the wall's frame, as text: `x,y,z` or `x,y,z,radius` in each line. `radius` is for
    /// segments without.
    ///
    /// # Errors
    /// A line is something else, or the points make no robot.
    pub fn from_csv(text: &str, radius: Real) -> Result<Robot, String> {
        let (points, radii) = csv::centreline(text, radius)?;
        let chain = Chain::from_centreline(&points, &radii).map_err(|error| error.to_string())?;
        Ok(Self { chain, stands_at_entry: false })
    }

    /// How far each tube can be out.
    pub fn longest() -> Vec<Real> {
        three_tubes().sections.iter().map(|section| section.length).collect()
    }

    /// Three extensions and three angles at which the tubes reach the end of the ventricle.
    pub fn goal() -> Vec<Real> {
        let Joints { extensions, angles } = ventricle::goal();
        [extensions, angles].concat()
    }
}

impl Robot {
    pub(crate) fn chain(&self) -> &Chain {
        &self.chain
    }

    pub(crate) fn stands_at_entry(&self) -> bool {
        self.stands_at_entry
    }
}
