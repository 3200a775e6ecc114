//! A film of an activity with its truth, as the folder of a study.

use std::path::PathBuf;

use anyhow::{Context, Result, ensure};
use fluoropose_phantom::film::activity::Activity;
use fluoropose_phantom::implant::Side;
use fluoropose_phantom::sequence::{self, Options};

use super::physics::PhysicsOptions;

/// What is filmed.
#[derive(clap::Args)]
pub(super) struct ActivityArgs {
    /// Write a film of the built-in implants: knee-bend, stair or gait
    #[arg(long, requires = "out", conflicts_with = "films")]
    pub(super) activity: Option<Activity>,
    /// With --activity: folder to write to; made if absent
    #[arg(long, value_name = "DIR", requires = "activity")]
    out: Option<PathBuf>,
    /// With --activity: number of frames
    #[arg(long, default_value_t = 120)]
    frames: usize,
    /// With --activity: left or right knee
    #[arg(long, default_value_t = Side::Left)]
    side: Side,
    /// With --activity: part of the time from frame to frame during which a frame is exposed, which blurs motion
    #[arg(long, value_name = "PART", default_value_t = 0.0)]
    shutter: f64,
    /// With --activity: the other leg passes behind this one
    #[arg(long)]
    second_leg: bool,
    /// With --activity: the joint leaves the field to one side and comes back
    #[arg(long)]
    leaves_field: bool,
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
    let options = Options {
        frames: args.frames,
        seed,
        side: args.side,
        activity: args.activity,
        physics: args.physics.physics()?,
        shutter: args.shutter,
        second_leg: args.second_leg,
        leaves_field: args.leaves_field,
    };
    sequence::write(&options, out)?;
    println!("{} frames in {}", args.frames, out.display());
    Ok(())
}
