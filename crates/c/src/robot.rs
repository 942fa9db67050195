//! Robots: chains of links, and curved tubes.

use crate::error::{Fault, pc_status};
use parry_continuum::parry::math::Vector;
use parry_continuum::{Chain, RobotError, Tube};

/// Flat tips and steps, filled bends. For `pc_chain_new`.
pub const PC_CAPS_FITTED: u32 = 0;
/// All ends are round.
pub const PC_CAPS_CAPSULES: u32 = 1;
/// All ends are flat.
pub const PC_CAPS_CYLINDERS: u32 = 2;

/// How the links of a robot end.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Caps {
    Fitted,
    Capsules,
    Cylinders,
}

impl Caps {
    pub(crate) fn new(caps: u32) -> Result<Self, Fault> {
        match caps {
            PC_CAPS_FITTED => Ok(Self::Fitted),
            PC_CAPS_CAPSULES => Ok(Self::Capsules),
            PC_CAPS_CYLINDERS => Ok(Self::Cylinders),
            _ => {
                let text = format!(
                    "`caps` is {caps}; give PC_CAPS_FITTED, PC_CAPS_CAPSULES or PC_CAPS_CYLINDERS"
                );
                Err(Fault::argument("bad_caps", text))
            }
        }
    }
}

/// One radius for each segment: as they are given, or the only one `segments` times in `memory`.
pub(crate) fn radii<'a>(given: &'a [f64], segments: usize, memory: &'a mut Vec<f64>) -> &'a [f64] {
    match *given {
        [radius] => {
            memory.clear();
            memory.resize(segments, radius);
            memory
        }
        _ => given,
    }
}

/// A robot of straight links.
pub struct pc_chain {
    pub(crate) chain: Chain,
    caps: Caps,
    radii: Vec<f64>,
}

fn chain(caps: Caps, points: &[Vector], radii: &[f64]) -> Result<Chain, RobotError> {
    match caps {
        Caps::Fitted => Chain::from_centreline(points, radii),
        Caps::Capsules => Chain::capsules(points, radii),
        Caps::Cylinders => Chain::cylinders(points, radii),
    }
}

/// Makes a robot of straight links: `point_count` points from the base to the tip, and one radius
/// for each segment, or a single one. `caps` is `PC_CAPS_FITTED`, `PC_CAPS_CAPSULES` or
/// `PC_CAPS_CYLINDERS`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_chain_new(
    points: *const f64,
    point_count: usize,
    radii: *const f64,
    radius_count: usize,
    caps: u32,
    robot: *mut *mut pc_chain,
) -> pc_status {
    border!(robot: new_handle, points: points(point_count), radii: items(radius_count) => {
        let (caps, mut memory) = (Caps::new(caps)?, Vec::new());
        let each = self::radii(radii, points.len().saturating_sub(1), &mut memory);
        robot.set(pc_chain { chain: chain(caps, points, each)?, caps, radii: memory });
        Ok(())
    })
}

/// Gives a robot other points and radii. With fitted caps and as many points as before it allocates
/// nothing. After an error the robot is as it was.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_chain_set(
    robot: *mut pc_chain,
    points: *const f64,
    point_count: usize,
    radii: *const f64,
    radius_count: usize,
) -> pc_status {
    border!(robot: exclusive, points: points(point_count), radii: items(radius_count) => {
        let each = self::radii(radii, points.len().saturating_sub(1), &mut robot.radii);
        match robot.caps {
            Caps::Fitted => robot.chain.set_centreline(points, each)?,
            caps => robot.chain = chain(caps, points, each)?,
        }
        Ok(())
    })
}

/// Frees a robot.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_chain_free(robot: *mut pc_chain) {
    free!(robot);
}

/// A robot with a smooth centreline.
pub struct pc_tube {
    pub(crate) tube: Tube,
    radii: Vec<f64>,
}

/// The directions at both ends, if there are directions.
fn ends(tangents: &[Vector]) -> Option<[Vector; 2]> {
    match tangents {
        [first, .., last] => Some([*first, *last]),
        _ => None,
    }
}

/// Refuses a number of directions that belong to no points.
fn check_tangents(points: usize, tangents: usize) -> Result<(), Fault> {
    if tangents == 0 || tangents == 2 || tangents == points {
        return Ok(());
    }
    let text = format!("`tangents` has {tangents} directions; give none, 2 or {points}");
    Err(Fault::argument("bad_length", text))
}

/// Makes a smooth tube through points, with flat ends and one radius for each segment, or a single
/// one. `tangents` are directions of any length: none, 2 for the ends, or one for each point.
/// `deviation` is how far a measured point may be from the curve, or 0; the curve is then fitted,
/// without tangents. `turn` is the largest angle in rad between the true direction and the curve's
/// at flat ends, or NaN if it is not known.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_tube_new(
    points: *const f64,
    point_count: usize,
    radii: *const f64,
    radius_count: usize,
    tangents: *const f64,
    tangent_count: usize,
    deviation: f64,
    turn: f64,
    tube: *mut *mut pc_tube,
) -> pc_status {
    border!(tube: new_handle, points: points(point_count), radii: items(radius_count),
        tangents: points(tangent_count) =>
    {
        check_tangents(points.len(), tangents.len())?;
        let mut memory = Vec::new();
        let each = self::radii(radii, points.len().saturating_sub(1), &mut memory);
        let made = if deviation != 0.0 {
            if !tangents.is_empty() {
                let text = "`tangents` and a deviation are given; give one of them";
                return Err(Fault::argument("bad_length", text.into()));
            }
            Tube::fit(points, each, deviation)?
        } else if tangents.len() > 2 {
            Tube::from_frames(points, tangents, each)?
        } else {
            Tube::from_samples(points, each, ends(tangents))?
        };
        let made = if turn.is_nan() { made } else { made.with_turn(turn)? };
        tube.set(pc_tube { tube: made, radii: memory });
        Ok(())
    })
}

/// Gives a tube other points, radii and end directions, `NULL` or two, in the memory that it has.
/// After an error the tube is as it was.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_tube_set(
    tube: *mut pc_tube,
    points: *const f64,
    point_count: usize,
    radii: *const f64,
    radius_count: usize,
    end_tangents: *const f64,
) -> pc_status {
    border!(tube: exclusive, points: points(point_count), radii: items(radius_count),
        end_tangents: points_or_none(2) =>
    {
        let each = self::radii(radii, points.len().saturating_sub(1), &mut tube.radii);
        Ok(tube.tube.set_samples(points, each, ends(end_tangents))?)
    })
}

/// Frees a tube.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_tube_free(tube: *mut pc_tube) {
    free!(tube);
}
