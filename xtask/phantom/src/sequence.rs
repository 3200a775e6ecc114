//! A film of a deep knee bend as the files of a study: frames, true masks, poses, models, calibration.

use crate::film::motion::{self, Position};
use crate::film::{self, Placed, Scene};
use crate::implant::{self, Parameters, Side, Size, Triangles};
use crate::picture::{write_grey, write_mask};
use crate::stl;
use anyhow::{Context, Result, ensure};
use fluoropose::camera::Camera;
use fluoropose::image::mask::Mask;
use fluoropose::pose::jts;
use fluoropose::pose::{EulerPose, Pose};
use rayon::prelude::*;
use serde::Serialize;
use std::fs;
use std::path::Path;

/// Side of the square frames, pixels.
const FRAME: usize = 1024;
/// Focus to detector and pitch of the pixels there, mm.
const PRINCIPAL_DISTANCE: f64 = 1200.0;
const PITCH: f64 = 0.373;
/// What the sequence is called.
const NAME: &str = "deep-knee-bend";

/// What is filmed.
#[derive(Clone, Debug)]
pub struct Options {
    /// Number of frames, from extension to 110 degrees of flexion.
    pub frames: usize,
    /// Seed of the noise, of the bones' texture and of small rotations; the same seed gives the same files.
    pub seed: u64,
    /// Left or right knee.
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
    stl::write_file(&implants[0], &out.join("femur.stl"))?;
    stl::write_file(&implants[1], &out.join("tibia.stl"))?;
    positions
        .par_iter()
        .enumerate()
        .try_for_each(|(index, position)| write_frame(options, &implants, position, index, out))
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
    write_grey(&out.join("frames").join(&name), (FRAME, FRAME), &pixels)?;
    for (component, placed) in [("femur", &femur), ("tibia", &tibia)] {
        let words = film::silhouette(&camera, placed)?;
        let path = out.join("masks").join(component).join(&name);
        write_mask(&path, &Mask::new(&words, FRAME, FRAME)?)?;
    }
    Ok(())
}

fn frame_name(index: usize) -> String {
    format!("{:04}.png", index + 1)
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
    save("femur.jts", &poses(positions, |position| position.femur)?)?;
    save("tibia.jts", &poses(positions, |position| position.tibia)?)?;
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
    save(
        "demo.json",
        &(serde_json::to_string_pretty(&manifest)? + "\n"),
    )
}

/// The poses of one component as a `.jts` file, a row a frame.
fn poses(positions: &[Position], of: fn(&Position) -> EulerPose) -> Result<String> {
    let mut text = String::new();
    jts::write_heading(&mut text)?;
    for position in positions {
        jts::write_row(&mut text, Some(&of(position)))?;
    }
    Ok(text)
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
