//! A film of an activity with its truth, as the folder of a study.

use std::path::PathBuf;

use anyhow::{Context, Result, ensure};
use fluoropose_phantom::film::activity::Activity;
use fluoropose_phantom::implant::Side;
use fluoropose_phantom::own_folder::check_source;
use fluoropose_phantom::sequence::{self, Options};
use fluoropose_report::counted;

use super::implants::of_study;
use super::physics::PhysicsOptions;
use crate::options::study_files;

/// What is filmed.
#[derive(clap::Args)]
pub(super) struct ActivityArgs {
    /// Write a film of the built-in implants: knee-bend, stair or gait
    #[arg(
        long,
        requires = "out",
        group = "drawn",
        conflicts_with_all = ["films", "json"],
        conflicts_with_all = super::OF_THE_PROTOCOL, conflicts_with_all = super::OF_THE_LIBRARY
    )]
    pub(super) activity: Option<Activity>,
    /// With --activity and --knees: folder to write to; made if absent
    #[arg(long, value_name = "DIR", requires = "drawn")]
    pub(super) out: Option<PathBuf>,
    /// With --activity and --knees: number of frames
    #[arg(long, default_value_t = 120, requires = "drawn")]
    pub(super) frames: usize,
    /// With --activity: left or right knee
    #[arg(long, default_value_t = Side::Left, requires = "drawn")]
    side: Side,
    /// With --activity: part of the time from frame to frame during which a frame is exposed, which blurs motion
    #[arg(long, value_name = "PART", default_value_t = 0.0, requires = "drawn")]
    shutter: f64,
    /// With --activity: the other leg passes behind this one
    #[arg(long, requires = "drawn")]
    second_leg: bool,
    /// With --activity: the joint leaves the field to one side and comes back
    #[arg(long, requires = "drawn")]
    leaves_field: bool,
    /// With --activity and --knees: the implants of this study in place of the built-in ones
    #[arg(long, value_name = "STUDY", value_parser = study_files(), requires = "drawn")]
    pub(super) implants: Option<PathBuf>,
    /// With --implants: other designs, stretched by so much along the anterior, superior and lateral axis
    #[arg(
        long,
        value_name = "X,Y,Z",
        value_delimiter = ',',
        requires = "implants",
        default_value = "1,1,1"
    )]
    stretch: Vec<f64>,
    #[command(flatten)]
    physics: PhysicsOptions,
}

/// Writes the film.
///
/// # Errors
/// For options out of range and files that cannot be written.
pub(super) fn run(args: &ActivityArgs, seed: u64) -> Result<()> {
    let out = args.out.as_ref().context("where to? --out DIR")?;
    ensure!(
        (0.0..=1.0).contains(&args.shutter),
        "a shutter is open for 0 to 1 of the time, not {}",
        args.shutter
    );
    let stretch = <[f64; 3]>::try_from(args.stretch.as_slice()).ok();
    let stretch = stretch.context("--stretch takes three numbers, as 1.1,1,0.9")?;
    let implants = args.implants.as_deref();
    implants.map_or(Ok(()), |study| check_source(study, out))?;
    let implants = implants.map(|study| of_study(study, args.side, stretch));
    let options = Options {
        frames: args.frames,
        seed,
        side: args.side,
        activity: args.activity,
        physics: args.physics.physics()?,
        shutter: args.shutter,
        second_leg: args.second_leg,
        leaves_field: args.leaves_field,
        implants: implants.transpose()?,
        ..Options::default()
    };
    sequence::write(&options, out)?;
    println!("{} in {}", counted(args.frames, "frame"), out.display());
    Ok(())
}
