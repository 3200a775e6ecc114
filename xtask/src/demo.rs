//! Verb `demo`: a synthetic fluoroscopy sequence of a deep knee bend, with known poses.

use crate::film::motion::{self, Position};
use crate::film::{self, Placed, Scene};
use crate::implant::{self, Parameters, Side, Size, Triangles};
use crate::models::write_stl;
use crate::pipeline::build::progress;
use crate::pipeline::files::{write_json, write_poses};
use anyhow::{Context, Result, ensure};
use fluoropose::camera::Camera;
use fluoropose::pose::{EulerPose, Pose};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use rayon::prelude::*;
use serde::Serialize;
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::{Path, PathBuf};

/// Side of the square frames, pixels.
const FRAME: usize = 1024;
/// Focus to detector and pitch of the pixels there, mm.
const PRINCIPAL_DISTANCE: f64 = 1200.0;
const PITCH: f64 = 0.373;
/// What the sequence is called.
const NAME: &str = "deep-knee-bend";

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
pub struct Args {
    #[command(flatten)]
    options: Options,
    /// Folder to write to; made if absent
    #[arg(long, default_value = "demo")]
    out: PathBuf,
}

/// What is filmed.
#[derive(Clone, Debug, clap::Args)]
pub struct Options {
    /// Number of frames, from extension to 110 degrees of flexion
    #[arg(long, default_value_t = 8)]
    pub frames: usize,
    /// Seed of the noise, of the bones' texture and of small rotations; the same seed gives the same files
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Left or right knee
    #[arg(long, value_enum, default_value = "left")]
    pub side: Side,
}

impl Default for Options {
    /// What the page shows: 8 frames of a left knee.
    fn default() -> Self {
        Self {
            frames: 8,
            seed: 1,
            side: Side::Left,
        }
    }
}

/// The page's list of what the folder holds; paths are relative to it.
#[derive(Serialize)]
struct Manifest {
    name: &'static str,
    side: Side,
    calibration: &'static str,
    frames: Vec<String>,
    models: Files,
    poses: Files,
}

#[derive(Serialize)]
struct Files {
    femur: &'static str,
    tibia: &'static str,
}

/// Runs the verb.
pub fn run(args: Args) -> Result<()> {
    write(&args.options, &args.out)?;
    println!("{} frames in {}", args.options.frames, args.out.display());
    println!(
        "try: cargo xtask evaluate --study {}",
        args.out.join("study.toml").display()
    );
    Ok(())
}

/// Writes the sequence into a folder.
///
/// # Errors
/// When no frame or more than 9999 are asked for, or a file cannot be written.
pub fn write(options: &Options, out: &Path) -> Result<()> {
    ensure!(
        (1..=9999).contains(&options.frames),
        "ask for 1 to 9999 frames, not {}",
        options.frames
    );
    for folder in ["frames", "masks/femur", "masks/tibia"] {
        let folder = out.join(folder);
        fs::create_dir_all(&folder)
            .with_context(|| format!("cannot make the folder {}", folder.display()))?;
    }
    let parameters = Parameters {
        side: options.side,
        size: Size::default(),
        resolution: 1.0,
    };
    let implants = [implant::femur(&parameters)?, implant::tibia(&parameters)?];
    let width_mm = parameters.size.width_mm();
    let positions = motion::deep_knee_bend(
        options.frames,
        options.side,
        &implants[0],
        width_mm,
        options.seed,
    );
    write_texts(options, &positions, out)?;
    write_stl(&implants[0], &out.join("femur.stl"))?;
    write_stl(&implants[1], &out.join("tibia.stl"))?;
    let bar = progress(positions.len(), "frames");
    positions
        .par_iter()
        .enumerate()
        .try_for_each(|(index, position)| {
            write_frame(options, &implants, position, index, out)?;
            bar.inc(1);
            anyhow::Ok(())
        })?;
    bar.finish_and_clear();
    Ok(())
}

fn write_frame(
    options: &Options,
    implants: &[Triangles; 2],
    position: &Position,
    index: usize,
    out: &Path,
) -> Result<()> {
    let [femur, tibia] = [
        (&implants[0], position.femur),
        (&implants[1], position.tibia),
    ]
    .map(|(mesh, pose)| Placed {
        mesh,
        pose: Pose::from(pose),
    });
    let camera =
        Camera::from_principal_distance(FRAME, FRAME, PRINCIPAL_DISTANCE, PITCH, [0.0, 0.0])?;
    let scene = Scene {
        camera,
        side: options.side,
        width_mm: Size::default().width_mm(),
        femur,
        tibia,
    };
    let name = frame_name(index);
    let pixels = film::expose(&scene, options.seed, index as u64)?;
    write_png(&pixels, &out.join("frames").join(&name))?;
    for (component, placed) in [("femur", &femur), ("tibia", &tibia)] {
        let buffer = film::silhouette(&camera, placed)?;
        let mask = buffer.mask();
        let pixels: Vec<u8> = (0..FRAME * FRAME)
            .map(|k| {
                if mask.get(k % FRAME, k / FRAME) {
                    255
                } else {
                    0
                }
            })
            .collect();
        write_png(&pixels, &out.join("masks").join(component).join(&name))?;
    }
    Ok(())
}

fn frame_name(index: usize) -> String {
    format!("{:04}.png", index + 1)
}

fn write_png(pixels: &[u8], path: &Path) -> Result<()> {
    let describe = || format!("cannot write {}", path.display());
    let file = BufWriter::new(File::create(path).with_context(describe)?);
    PngEncoder::new_with_quality(file, CompressionType::Default, FilterType::Adaptive)
        .write_image(pixels, FRAME as u32, FRAME as u32, ExtendedColorType::L8)
        .with_context(describe)
}

fn write_texts(options: &Options, positions: &[Position], out: &Path) -> Result<()> {
    let save = |name: &str, text: &str| {
        let path = out.join(name);
        fs::write(&path, text).with_context(|| format!("cannot write {}", path.display()))
    };
    save(
        "calibration.txt",
        &format!("JT_INTCALIB\n{PRINCIPAL_DISTANCE}\n0\n0\n{PITCH}\n"),
    )?;
    save("study.toml", &study(options.side))?;
    let poses = |of: fn(&Position) -> EulerPose| positions.iter().map(of).collect::<Vec<_>>();
    write_poses(&out.join("femur.jts"), &poses(|position| position.femur))?;
    write_poses(&out.join("tibia.jts"), &poses(|position| position.tibia))?;
    let manifest = Manifest {
        name: NAME,
        side: options.side,
        calibration: "calibration.txt",
        frames: (0..positions.len())
            .map(|index| format!("frames/{}", frame_name(index)))
            .collect(),
        models: Files {
            femur: "femur.stl",
            tibia: "tibia.stl",
        },
        poses: Files {
            femur: "femur.jts",
            tibia: "tibia.jts",
        },
    };
    write_json(Some(&out.join("demo.json")), &manifest)
}

fn study(side: Side) -> String {
    let mut text = format!(
        "# Synthetic: a deep knee bend, both components at known poses.\nname = \"{NAME}\"\nside = \"{side}\"\n\
         calibration = \"calibration.txt\"\nframes = \"frames\"\n"
    );
    for component in ["femur", "tibia"] {
        text += &format!(
            "\n[[component]]\nname = \"{component}\"\nmodel = \"{component}.stl\"\nreference = \"{component}.jts\"\n\
             masks.truth = \"masks/{component}\"\n"
        );
    }
    text
}
