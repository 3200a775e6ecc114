//! Verb `undistort`: frames without distortion.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use fluoropose_decode::{FrameFile, Pixels};
use fluoropose_phantom::picture::{write_grey, write_grey_16};

use crate::files::{Undistorter, files_in, name_of, read, read_distortion};

use crate::progress::progress;

/// Options of `undistort`.
#[derive(clap::Args)]
#[command(
    after_help = "Writes each frame as a grey PNG of its own depth, numbered in a file of several. The correction is one that the page or \
`cargo xtask calibrate` has written.\n\nExample:\n  cargo xtask undistort --distortion plate.json --frames run --out straight"
)]
pub struct Args {
    /// Correction of distortion (JSON)
    #[arg(long)]
    distortion: PathBuf,
    /// Folder of frames, in the order of their names
    #[arg(long)]
    frames: PathBuf,
    /// Folder to write to; it must be empty or new
    #[arg(long)]
    out: PathBuf,
}

/// Runs the verb.
///
/// # Errors
/// For files that cannot be read or written, frames of another size, and a folder that holds something.
pub fn run(args: Args) -> Result<()> {
    let undistorter = Undistorter::new(&read_distortion(&args.distortion)?);
    let files = files_in(&args.frames)?;
    let cannot = || format!("cannot make {}", args.out.display());
    std::fs::create_dir_all(&args.out).with_context(cannot)?;
    if std::fs::read_dir(&args.out)
        .with_context(cannot)?
        .next()
        .is_some()
    {
        bail!("{} is not empty; choose a new folder", args.out.display());
    }
    let bar = progress(files.len(), "files");
    let mut written = 0;
    for path in &files {
        written += straighten(path, &undistorter, &args.out)?;
        bar.inc(1);
    }
    bar.finish_and_clear();
    println!("{written} straight frames in {}", args.out.display());
    Ok(())
}

/// Writes all frames of a file; returns how many.
fn straighten(path: &Path, undistorter: &Undistorter, out: &Path) -> Result<usize> {
    let name = name_of(path);
    let file = FrameFile::open(read(path)?, &name)?;
    let stem = Path::new(&name)
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    for index in 0..file.count() {
        let frame = file.frame(index)?;
        let size = (frame.width as usize, frame.height as usize);
        let target = out.join(match file.count() {
            1 => format!("{stem}.png"),
            _ => format!("{stem}_{:05}.png", index + 1),
        });
        let of_file = || name.clone();
        match &frame.pixels {
            Pixels::U8(pixels) => {
                let pixels = undistorter.straight(pixels, size).with_context(of_file)?;
                write_grey(&target, size, &pixels)?;
            }
            Pixels::U16(pixels) => {
                let pixels = undistorter.straight(pixels, size).with_context(of_file)?;
                write_grey_16(&target, size, &pixels)?;
            }
        }
    }
    Ok(file.count())
}
