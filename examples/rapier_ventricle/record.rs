//! What every step of the simulation was like, as two CSV files. No time of the clock is in them,
//! so that two runs can be compared.

use parry_continuum::Chain;
use parry_continuum::parry::math::{Real, Vector};
use parry_continuum::proximity::LinkProximity;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// The state of the robot after a step, one entry per link.
pub struct Moment {
    /// In s from the start.
    pub time: Real,
    /// The length that is out and how far the base has been pushed, in mm.
    pub out: Real,
    pub pushed: Real,
    /// The robot as it is, in the mesh's frame.
    pub robot: Chain,
    /// Its joints and tip as the kinematics have them.
    pub planned: Vec<Vector>,
    /// Clearances.
    pub found: Vec<LinkProximity>,
    /// Contact forces in mN.
    pub forces: Vec<Real>,
    /// How far the end of each link is from the kinematic shape, in mm.
    pub deviations: Vec<Real>,
}

impl Moment {
    /// The least clearance and its link.
    pub fn closest(&self) -> (Real, u32) {
        let closest = self.found.iter().min_by(|a, b| a.distance.total_cmp(&b.distance));
        closest.map_or((Real::INFINITY, 0), |link| (link.distance, link.link))
    }

    /// The sum of the contact forces' magnitudes.
    pub fn force(&self) -> Real {
        self.forces.iter().sum()
    }

    /// How far the tip is from where the kinematics have it.
    pub fn tip_deviation(&self) -> Real {
        self.deviations.last().copied().unwrap_or(0.0)
    }
}

/// The two files.
pub struct Recorder {
    steps: BufWriter<File>,
    links: BufWriter<File>,
}

impl Recorder {
    /// `steps.csv` and `links.csv` in `directory`.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn new(directory: &Path) -> io::Result<Self> {
        let create = |name: &str| File::create(directory.join(name)).map(BufWriter::new);
        let (mut steps, mut links) = (create("steps.csv")?, create("links.csv")?);
        writeln!(
            steps,
            "step,time_s,out_mm,pushed_mm,links,clearance_mm,closest_link,links_held,force_mN,\
             tip_deviation_mm,largest_deviation_mm"
        )?;
        writeln!(links, "step,link,clearance_mm,triangle,force_mN,deviation_mm")?;
        Ok(Self { steps, links })
    }

    /// Writes a row and one per link.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn write(&mut self, step: usize, moment: &Moment) -> io::Result<()> {
        let (clearance, closest) = moment.closest();
        let held = moment.forces.iter().filter(|force| **force > 0.0).count();
        let largest = moment.deviations.iter().copied().fold(0.0, Real::max);
        writeln!(
            self.steps,
            "{step},{:.3},{:.3},{:.3},{},{clearance:.6},{closest},{held},{:.4},{:.6},{largest:.6}",
            moment.time,
            moment.out,
            moment.pushed,
            moment.found.len(),
            moment.force(),
            moment.tip_deviation(),
        )?;
        for ((found, force), deviation) in
            moment.found.iter().zip(&moment.forces).zip(&moment.deviations)
        {
            let (link, triangle) = (found.link, found.witness.triangle);
            writeln!(
                self.links,
                "{step},{link},{:.6},{triangle},{force:.4},{deviation:.6}",
                found.distance
            )?;
        }
        Ok(())
    }

    /// Makes sure that all is on disk.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn finish(mut self) -> io::Result<()> {
        self.steps.flush()?;
        self.links.flush()
    }
}
