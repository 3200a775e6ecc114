//! Verb `undistort`: frames without distortion.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use fluoropose::image::frame::Pixel;
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
    let undistorter = Undistorter::new(read_distortion(&args.distortion)?);
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
    let names = names_of(&files);
    let mut notes = BTreeSet::new();
    let mut written = 0;
    for (path, name) in files.iter().zip(&names) {
        written += straighten(path, &undistorter, &args.out.join(name), &mut notes)?;
        bar.inc(1);
    }
    bar.finish_and_clear();
    notes.iter().for_each(|note| eprintln!("{note}"));
    println!("{written} straight frames in {}", args.out.display());
    Ok(())
}

/// What the straight frames of each file are named by: its name without its ending, or with it where another file would have that name.
fn names_of(files: &[PathBuf]) -> Vec<String> {
    let stem = |path: &PathBuf| {
        let stem = path.file_stem().unwrap_or_default();
        stem.to_string_lossy().into_owned()
    };
    let stems: Vec<String> = files.iter().map(stem).collect();
    let distinct: BTreeSet<&String> = stems.iter().collect();
    match distinct.len() == stems.len() {
        true => stems,
        false => files.iter().map(|path| name_of(path)).collect(),
    }
}

/// Writes all frames of a file, with what there is to note of them; returns how many.
fn straighten(
    path: &Path,
    undistorter: &Undistorter,
    out: &Path,
    notes: &mut BTreeSet<String>,
) -> Result<usize> {
    let name = name_of(path);
    let file = FrameFile::open(read(path)?, &name)?;
    for index in 0..file.count() {
        let mut frame = file.frame(index)?;
        notes.extend(frame.notes.drain(..));
        let size = (frame.width as usize, frame.height as usize);
        let mut target = out.as_os_str().to_owned();
        match file.count() {
            1 => target.push(".png"),
            _ => target.push(format!("_{:05}.png", index + 1)),
        }
        let target = PathBuf::from(target);
        if target.exists() {
            bail!(
                "{} is written by two frames: give the files other names",
                target.display()
            );
        }
        let covered = frame.shutter.as_ref().map_or(Vec::new(), |shutter| {
            notes.insert(format!("{name}: what its shutter covers is written black"));
            shutter.covered(frame.width, frame.height)
        });
        let of_file = || name.clone();
        match &mut frame.pixels {
            Pixels::U8(pixels) => {
                blacken(pixels, &covered);
                let pixels = undistorter.straight(pixels, size).with_context(of_file)?;
                write_grey(&target, size, &pixels)?;
            }
            Pixels::U16(pixels) => {
                blacken(pixels, &covered);
                let pixels = undistorter.straight(pixels, size).with_context(of_file)?;
                write_grey_16(&target, size, &pixels)?;
            }
        }
    }
    Ok(file.count())
}

/// A picture without a shutter has what is covered in one grey, where nobody looks. `covered`: of each run the first pixel, and the one after its last.
fn blacken<P: Pixel>(pixels: &mut [P], covered: &[u32]) {
    for run in covered.chunks_exact(2) {
        if let Some(run) = pixels.get_mut(run[0] as usize..run[1] as usize) {
            run.fill(P::default());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_files_have_one_name() {
        let named = |names: &[&str]| names_of(&names.iter().map(PathBuf::from).collect::<Vec<_>>());
        assert_eq!(named(&["x/a.png", "x/b.tif"]), ["a", "b"]);
        assert_eq!(
            named(&["1.2.113.1", "1.2.113.2"]),
            ["1.2.113.1", "1.2.113.2"]
        );
        assert_eq!(named(&["a.png", "a.tif"]), ["a.png", "a.tif"]);
    }

    #[test]
    fn what_is_covered_is_black() {
        let mut pixels = [7u8; 6];
        blacken(&mut pixels, &[0, 2, 5, 6]);
        assert_eq!(pixels, [0, 0, 7, 7, 7, 0]);
    }
}
