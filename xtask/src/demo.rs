//! Verb `demo`: a synthetic fluoroscopy sequence of a deep knee bend, with known poses.

use crate::options::sides;
use anyhow::Result;
use fluoropose_phantom::implant::Side;
use fluoropose_phantom::sequence::{self, Options};
use std::path::PathBuf;

/// Options of `demo`.
#[derive(clap::Args)]
#[command(
    after_help = "Writes into DIR:\n  frames/0001.png ...           8-bit frames, 1024 x 1024\n  calibration.txt               JT_INTCALIB\n  \
femur.stl, tibia.stl          the implants, mm\n  femur.jts, tibia.jts          the exact poses, a row a frame\n  \
masks/femur/0001.png ...      the true silhouettes, and masks/tibia\n  study.toml                    for `cargo xtask evaluate --study DIR/study.toml`\n  \
demo.json                     what the page reads\n\n\
The pictures are drawn, not filmed: bones and skin are plausible shapes, only the implants' poses mean anything.\n\n\
Example:\n  cargo xtask demo --out demo --frames 12 --side right"
)]
pub(crate) struct Args {
    /// Number of frames, from extension to 110 degrees of flexion
    #[arg(long, default_value_t = 8)]
    frames: usize,
    /// Seed of the noise, of the bones' texture and of small rotations; the same seed gives the same files
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Left or right knee
    #[arg(long, value_parser = sides(), default_value = "left")]
    side: Side,
    /// Folder to write to; made if absent
    #[arg(long, default_value = "demo")]
    out: PathBuf,
}

/// Runs the verb.
pub(crate) fn run(args: Args) -> Result<()> {
    let options = Options {
        frames: args.frames,
        seed: args.seed,
        side: args.side,
        ..Options::default()
    };
    sequence::write(&options, &args.out)?;
    println!("{} frames in {}", args.frames, args.out.display());
    println!(
        "try: cargo xtask evaluate --study {}",
        args.out.join("study.toml").display()
    );
    Ok(())
}
