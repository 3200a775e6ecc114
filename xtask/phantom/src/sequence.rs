//! A film as the files of a study: frames, true masks, poses, models, calibration.

use crate::film::activity::{Activity, Course};
use crate::film::motion::{self, Position};
use crate::film::{self, Motion, Physics, Placed, Scene};
use crate::implant::{self, Parameters, Side, Size, Triangles};
use crate::own_folder::{check_files, check_study};
use crate::picture::{write_grey, write_mask};
use crate::stl;
use crate::whole;
use anyhow::{Context, Result, ensure};
use fluoropose::camera::Camera;
use fluoropose::image::mask::Mask;
use fluoropose::pose::jts;
use fluoropose::pose::{EulerPose, Pose};
use rayon::prelude::*;
use serde::Serialize;
use std::fs;
use std::path::Path;

/// Focus to detector, and the detector's side, mm.
const PRINCIPAL_DISTANCE: f64 = 1200.0;
const DETECTOR: f64 = 1024.0 * 0.373;
/// What the study files of sequences begin with.
const SYNTHETIC: &str = "# Synthetic:";
/// What the demonstration is called.
const NAME: &str = "deep-knee-bend";

/// What is filmed.
#[derive(Clone, Debug)]
pub struct Options {
    /// Number of frames; of the demonstration, from extension to 110 degrees of flexion.
    pub frames: usize,
    /// Seed of the noise, of the bones' texture and of small rotations; the same seed gives the same files.
    pub seed: u64,
    /// Left or right knee.
    pub side: Side,
    /// Side of the square frames, pixels: of the same detector, so that fewer are larger.
    pub pixels: usize,
    /// What the person does, at the rate of a fluoroscope; else the demonstration's few frames of a deep knee bend.
    pub activity: Option<Activity>,
    /// How the film is made.
    pub physics: Physics,
    /// Part of the time from one frame to the next during which a frame is exposed: motion blur.
    pub shutter: f64,
    /// Whether the other leg passes behind this one. Of activities.
    pub second_leg: bool,
    /// Whether the joint leaves the field and comes back. Of activities.
    pub leaves_field: bool,
    /// Other implants than the built-in ones.
    pub implants: Option<Implants>,
}

/// Femur and tray, in the axes and with the origins of the built-in ones.
#[derive(Clone, Debug)]
pub struct Implants {
    /// The femur first.
    pub parts: [Triangles; 2],
    /// Mediolateral width of the tray, mm.
    pub width_mm: f64,
}

impl Implants {
    /// Those of the demonstration at the resolution 1; a film that is only followed is followed sooner with fewer triangles.
    ///
    /// # Errors
    /// For a resolution that is not made.
    pub fn built_in(side: Side, resolution: f64) -> Result<Self> {
        let size = Size::default();
        let parameters = Parameters {
            side,
            size,
            resolution,
        };
        Ok(Self {
            parts: [implant::femur(&parameters)?, implant::tibia(&parameters)?],
            width_mm: size.width_mm(),
        })
    }
}

impl Default for Options {
    /// What the page shows: 8 frames of a left knee, 1024 x 1024.
    fn default() -> Self {
        Self {
            frames: 8,
            seed: 1,
            side: Side::Left,
            pixels: 1024,
            activity: None,
            physics: Physics::default(),
            shutter: 0.0,
            second_leg: false,
            leaves_field: false,
            implants: None,
        }
    }
}

impl Options {
    fn pitch(&self) -> f64 {
        DETECTOR / self.pixels as f64
    }

    fn name(&self) -> String {
        let activity = self.activity.as_ref();
        activity.map_or_else(|| NAME.to_owned(), ToString::to_string)
    }

    fn course(&self) -> Option<Course> {
        self.activity.map(|activity| Course {
            activity,
            frames: self.frames,
            side: self.side,
            seed: self.seed,
            leaves_field: self.leaves_field,
        })
    }

    fn positions(&self, femur: &Triangles, width_mm: f64) -> Vec<Position> {
        match self.course() {
            Some(course) => course.positions(femur, width_mm),
            None => motion::deep_knee_bend(self.frames, self.side, femur, width_mm, self.seed),
        }
    }

    /// How one frame is made.
    fn physics_of(&self, frame: usize) -> Physics {
        let mut physics = self.physics;
        if let Some(course) = self.course().filter(|_| self.second_leg) {
            physics.surroundings.second_leg_mm = Some(course.second_leg_mm(frame));
        }
        physics
    }

    /// How a component moves while a frame is exposed, by the frames before and after.
    fn motion(&self, poses: &[EulerPose], frame: usize) -> Motion {
        if self.shutter <= 0.0 {
            return Motion::default();
        }
        let (from, to) = (frame.saturating_sub(1), (frame + 1).min(poses.len() - 1));
        let part = self.shutter / (to - from).max(1) as f64;
        Motion::between(&poses[from].into(), &poses[to].into(), part)
    }
}

/// The page's list of what the folder holds; paths are relative to it.
#[derive(Serialize)]
struct Manifest {
    name: String,
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

/// Writes the sequence into a folder of its own.
///
/// # Errors
/// When no frame or more than 9999 are asked for, the folder holds another study or frames of a longer film, or a file cannot be written.
pub fn write(options: &Options, out: &Path) -> Result<()> {
    ensure!(
        (1..=9999).contains(&options.frames),
        "ask for 1 to 9999 frames, not {}",
        options.frames
    );
    check_study(out, |text| text.starts_with(SYNTHETIC))?;
    for folder in ["frames", "masks/femur", "masks/tibia"] {
        let folder = out.join(folder);
        check_files(&folder, |name| is_passed_by(name, options.frames))?;
        fs::create_dir_all(&folder)
            .with_context(|| format!("cannot make the folder {}", folder.display()))?;
    }
    let implants = match &options.implants {
        Some(implants) => implants.clone(),
        None => Implants::built_in(options.side, 1.0)?,
    };
    let positions = options.positions(&implants.parts[0], implants.width_mm);
    write_texts(options, &positions, out)?;
    stl::write_file(&implants.parts[0], &out.join("femur.stl"))?;
    stl::write_file(&implants.parts[1], &out.join("tibia.stl"))?;
    (0..positions.len())
        .into_par_iter()
        .try_for_each(|index| write_frame(options, &implants, &positions, index, out))
}

fn write_frame(
    options: &Options,
    implants: &Implants,
    positions: &[Position],
    index: usize,
    out: &Path,
) -> Result<()> {
    let poses: [Vec<EulerPose>; 2] = [
        positions.iter().map(|position| position.femur).collect(),
        positions.iter().map(|position| position.tibia).collect(),
    ];
    let [femur, tibia] = [0, 1].map(|part| Placed {
        mesh: &implants.parts[part],
        pose: Pose::from(poses[part][index]),
        motion: options.motion(&poses[part], index),
    });
    let (side, pitch) = (options.pixels, options.pitch());
    let camera =
        Camera::from_principal_distance(side, side, PRINCIPAL_DISTANCE, pitch, [0.0, 0.0])?;
    let scene = Scene {
        camera,
        side: options.side,
        width_mm: implants.width_mm,
        femur,
        tibia,
    };
    let name = frame_name(index);
    let physics = options.physics_of(index);
    let pixels = film::expose(&scene, &physics, options.seed, index as u64)?;
    write_grey(&out.join("frames").join(&name), (side, side), &pixels)?;
    for (component, placed) in [("femur", &femur), ("tibia", &tibia)] {
        let words = film::silhouette(&camera, placed)?;
        let path = out.join("masks").join(component).join(&name);
        write_mask(&path, &Mask::new(&words, side, side)?)?;
    }
    Ok(())
}

/// Whether a file in a folder of frames is one of so many, or none that could be taken for one.
fn is_passed_by(name: &str, frames: usize) -> bool {
    !name.ends_with(".png") || (0..frames).any(|index| frame_name(index) == name)
}

fn frame_name(index: usize) -> String {
    format!("{:04}.png", index + 1)
}

fn write_texts(options: &Options, positions: &[Position], out: &Path) -> Result<()> {
    let save = |name: &str, text: &str| {
        let path = out.join(name);
        whole::write(&path, text)
    };
    save(
        "calibration.txt",
        &format!(
            "JT_INTCALIB\n{PRINCIPAL_DISTANCE}\n0\n0\n{}\n",
            options.pitch()
        ),
    )?;
    save("study.toml", &study(&options.name(), options.side))?;
    save("femur.jts", &poses(positions, |position| position.femur)?)?;
    save("tibia.jts", &poses(positions, |position| position.tibia)?)?;
    let manifest = Manifest {
        name: options.name(),
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

fn study(name: &str, side: Side) -> String {
    let what = name.replace('-', " ");
    let mut text = format!(
        "{SYNTHETIC} a {what}, both components at known poses.\nname = \"{name}\"\nside = \"{side}\"\n\
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shorter_film_is_not_written_among_the_frames_of_a_longer_one() {
        let name = format!("fluoropose-shorter-{}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        let of = |frames| Options {
            frames,
            pixels: 64,
            implants: Implants::built_in(Side::Left, 0.5).ok(),
            ..Options::default()
        };
        write(&of(2), &folder).unwrap();
        write(&of(2), &folder).unwrap();
        let refused = write(&of(1), &folder).unwrap_err().to_string();
        assert!(refused.contains("holds 0002.png"), "{refused}");
        write(&of(3), &folder).unwrap();
        fs::write(folder.join("study.toml"), "name = \"of a patient\"").unwrap();
        let refused = write(&of(3), &folder).unwrap_err().to_string();
        assert!(refused.contains("that others made"), "{refused}");
        fs::remove_dir_all(folder).unwrap();
    }
}
