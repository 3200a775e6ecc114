//! Disguises of a small film: their truth lies where their pixels do.
#![allow(clippy::unwrap_used, reason = "a refusal fails the test")]

use std::fs;
use std::path::{Path, PathBuf};

use fluoropose::camera::Camera;
use fluoropose::mesh::{Model, OwnedModel};
use fluoropose::pose::{EulerPose, Pose};
use fluoropose::render::{Projected, render, scratch_needed};
use fluoropose_decode::{Pixels, decode_frames};
use fluoropose_laboratory::files::{
    MaskBuffer, Study, files_in, read_calibration, read_model, read_poses, write_poses,
};
use fluoropose_laboratory::verbs::disguise::{Field, Kind, Marks, Mesh, Plan, Tone, disguise};
use fluoropose_phantom::implant::{Parameters, Side, Triangles, femur, tibia};
use fluoropose_phantom::{picture, stl};

const SIDE: usize = 256;
const PITCH: f64 = 1.0;
const SEEDS: u64 = 12;
/// Silhouettes are drawn so many times as finely as they are seen.
const FINE: usize = 4;
/// Every so many vertices are looked for among the others.
const EVERY: usize = 9;
const CALIBRATION: &str = "JT_INTCALIB\n1200\n3\n-5\n1\n";
const STUDY: &str = "name = 'small'\nside = 'left'\ncalibration = 'calibration.txt'\nframes = 'frames'\n\
[[component]]\nname = 'femur'\nmodel = 'femur.stl'\nreference = 'femur.jts'\n\
[[component]]\nname = 'tibia'\nmodel = 'tibia.stl'\nreference = 'tibia.jts'\n";

/// A film of one frame in a folder of its own: dark silhouettes, drawn four times as finely.
struct Small(PathBuf);

impl Drop for Small {
    fn drop(&mut self) {
        // What cannot be removed stays in the folder of temporary files.
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn poses() -> [EulerPose; 2] {
    let femur = EulerPose::from([-2.0, 18.0, -1050.0, 20.0, 5.0, -8.0]);
    [
        femur,
        EulerPose::from([3.0, -24.0, -1060.0, -7.0, -4.0, 6.0]),
    ]
}

fn parts() -> [Triangles; 2] {
    let parameters = Parameters {
        side: Side::Left,
        resolution: 0.5,
        ..Parameters::default()
    };
    [femur(&parameters).unwrap(), tibia(&parameters).unwrap()]
}

fn camera(fine: usize) -> Camera {
    let pitch = PITCH / fine as f64;
    Camera::from_principal_distance(SIDE * fine, SIDE * fine, 1200.0, pitch, [3.0, -5.0]).unwrap()
}

/// Adds to each pixel how many of its parts a model covers, as a camera of finer pixels sees it.
fn cover(model: &Model<'_>, fine: &Camera, pose: &Pose, covered: &mut [u32]) {
    let mut drawn = MaskBuffer::new(fine.width(), fine.height()).unwrap();
    let mut scratch = vec![Projected::default(); scratch_needed(model)];
    drawn
        .draw(|mask| render(model, fine, pose, &mut scratch, mask))
        .unwrap();
    let (width, mask) = (fine.width() / FINE, drawn.mask());
    for (at, covered) in covered.iter_mut().enumerate() {
        let (column, row) = (at % width * FINE, at / width * FINE);
        let set = |k: &usize| mask.get(column + k % FINE, row + k / FINE);
        *covered += (0..FINE * FINE).filter(set).count() as u32;
    }
}

/// The light of a pixel of which so many parts are covered.
fn light(covered: u32) -> f64 {
    let all = (FINE * FINE) as f64;
    1.0 - f64::from(covered).min(all) / all
}

impl Small {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("fluoropose-{name}-{}", std::process::id()));
        fs::create_dir_all(folder.join("frames")).unwrap();
        fs::write(folder.join("calibration.txt"), CALIBRATION).unwrap();
        fs::write(folder.join("study.toml"), STUDY).unwrap();
        let mut covered = vec![0u32; SIDE * SIDE];
        for ((part, pose), name) in parts().iter().zip(poses()).zip(["femur", "tibia"]) {
            stl::write_file(part, &folder.join(format!("{name}.stl"))).unwrap();
            write_poses(&folder.join(format!("{name}.jts")), &[Some(pose)]).unwrap();
            let model = Model::from_triangles(&part.vertices, &part.triangles).unwrap();
            cover(&model, &camera(FINE), &pose.into(), &mut covered);
        }
        let grey = |&covered: &u32| (255.0 * light(covered)) as u8;
        let pixels: Vec<u8> = covered.iter().map(grey).collect();
        picture::write_grey(&folder.join("frames/1.png"), (SIDE, SIDE), &pixels).unwrap();
        Self(folder)
    }

    fn study(&self) -> PathBuf {
        self.0.join("study.toml")
    }
}

/// A seed's disguise in small frames.
fn plan(seed: u64) -> Plan {
    let mut plan = Plan::drawn(seed, 1, (SIDE, SIDE));
    let factor = 192.0 / plan.view.size[0] as f64;
    plan.view.size = plan.view.size.map(|side| (side as f64 * factor) as usize);
    plan.view.scale *= factor;
    plan.frames.first = 0;
    plan.frames.count = 0;
    plan
}

/// Where a component's vertices are seen at a pose.
fn seen(vertices: &[[f32; 3]], pose: &Pose, camera: &Camera) -> Vec<[f64; 2]> {
    let place = |vertex: &[f32; 3]| {
        let place = camera
            .project(&pose.transform(&vertex.map(f64::from)))
            .unwrap();
        [place.column, place.row]
    };
    vertices.iter().map(place).collect()
}

/// The largest distance from a place of one to the nearest of the other, as some of them tell it.
fn farthest(from: &[[f64; 2]], to: &[[f64; 2]]) -> f64 {
    let nearest = |a: &[f64; 2]| {
        let squares = to
            .iter()
            .map(|b| (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2));
        squares.fold(f64::MAX, f64::min).sqrt()
    };
    from.iter().step_by(EVERY).map(nearest).fold(0.0, f64::max)
}

/// The camera, and the models with their poses, as the files of a disguise tell them.
fn read_back(folder: &Path) -> (Camera, Vec<(OwnedModel, Pose)>) {
    let study = Study::read_quietly(&folder.join("study.toml")).unwrap();
    let frames = files_in(study.frames_folder().unwrap()).unwrap();
    let frame = decode_frames(&fs::read(&frames[0]).unwrap(), "frame").unwrap();
    let (width, height) = (frame[0].width as usize, frame[0].height as usize);
    let camera = read_calibration(&study.calibration)
        .unwrap()
        .camera(width, height)
        .unwrap();
    let part = |component: &fluoropose_laboratory::files::Component| {
        let model = read_model(&component.model).unwrap();
        let poses = read_poses(component.reference.as_ref().unwrap()).unwrap();
        (model, poses[0].unwrap())
    };
    (camera, study.components.iter().map(part).collect())
}

#[test]
fn models_at_the_written_poses_are_seen_where_the_pixels_went() {
    let small = Small::new("disguise-truth");
    for seed in 0..SEEDS {
        let (out, plan) = (small.0.join(seed.to_string()), plan(seed));
        let lens = disguise(&small.study(), &plan, &out).unwrap();
        let (camera, there) = read_back(&out);
        for ((part, pose), (model, other)) in parts().iter().zip(poses()).zip(&there) {
            let known = seen(&part.vertices, &pose.into(), &camera_of_film());
            let known: Vec<[f64; 2]> = known
                .into_iter()
                .map(|place| lens.forwards(place))
                .collect();
            let found = seen(model.as_model().vertices(), other, &camera);
            let off = farthest(&known, &found).max(farthest(&found, &known));
            assert!(off < 0.05, "seed {seed}: {off} px ({plan})");
        }
    }
}

fn camera_of_film() -> Camera {
    camera(1)
}

/// Area of what is dark, and its centre, pixels.
fn dark(pixels: &[f64], width: usize) -> [f64; 3] {
    let (mut area, mut columns, mut rows) = (0.0, 0.0, 0.0);
    for (at, value) in pixels.iter().enumerate() {
        area += 1.0 - value;
        columns += (1.0 - value) * (at % width) as f64;
        rows += (1.0 - value) * (at / width) as f64;
    }
    [area, columns / area, rows / area]
}

/// What the files of a disguise tell its frame to show, drawn four times as finely as the `pixels` are.
fn drawn_finely(folder: &Path, pixels: usize) -> Vec<f64> {
    let (camera, parts) = read_back(folder);
    let fine = camera.supersampled(FINE).unwrap();
    let mut covered = vec![0u32; pixels];
    for (model, pose) in parts {
        cover(&model.as_model(), &fine, &pose, &mut covered);
    }
    covered.iter().map(|&covered| light(covered)).collect()
}

#[test]
fn frames_show_the_silhouettes_that_the_files_tell() {
    let small = Small::new("disguise-pixels");
    for seed in 0..SEEDS {
        let (out, mut plan) = (small.0.join(seed.to_string()), plan(seed));
        plan.tone = Tone::default();
        plan.marks = Marks {
            field: Field::Whole,
            white_surround: true,
            words: false,
        };
        // All of both is within the frame, and files round little.
        plan.view.middle = Some([0.5, 0.5]);
        plan.view.scale *= 0.75;
        plan.frames.kind =
            [Kind::Png8, Kind::Tiff12, Kind::Dicom12Inverse, Kind::Dicom8][seed as usize % 4];
        plan.models.mesh = [Mesh::Stl, Mesh::Obj, Mesh::Ply][seed as usize % 3];
        disguise(&small.study(), &plan, &out).unwrap();
        let frame = files_in(&out.join("frames")).unwrap();
        let frame = decode_frames(&fs::read(&frame[0]).unwrap(), "frame").unwrap();
        let shown: Vec<f64> = match &frame[0].pixels {
            Pixels::U8(pixels) => pixels.iter().map(|&p| f64::from(p)).collect(),
            Pixels::U16(pixels) => pixels.iter().map(|&p| f64::from(p)).collect(),
        };
        // A file of 16 bits does not tell that 12 are used.
        let white = shown.iter().copied().fold(0.0, f64::max);
        let shown: Vec<f64> = shown.into_iter().map(|value| value / white).collect();
        let width = frame[0].width as usize;
        let drawn = drawn_finely(&out, shown.len());
        let ([area, column, row], known) = (dark(&shown, width), dark(&drawn, width));
        let off = (column - known[1]).hypot(row - known[2]);
        assert!(off < 0.05, "seed {seed}: {off} px ({plan})");
        assert!(
            (area / known[0] - 1.0).abs() < 0.01,
            "seed {seed}: {area} and {}",
            known[0]
        );
    }
}

#[test]
fn a_seed_writes_the_same_bytes_again_and_its_file_states_it() {
    let small = Small::new("disguise-again");
    let (first, again) = (small.0.join("first"), small.0.join("again"));
    disguise(&small.study(), &plan(5), &first).unwrap();
    let stated = fs::read_to_string(first.join("disguise.toml")).unwrap();
    disguise(&small.study(), &toml::from_str(&stated).unwrap(), &again).unwrap();
    for folder in ["", "frames", "masks/tibia"] {
        for file in files_in(&first.join(folder)).unwrap() {
            let other = again.join(folder).join(file.file_name().unwrap());
            assert!(
                fs::read(&file).unwrap() == fs::read(&other).unwrap(),
                "{}",
                file.display()
            );
        }
    }
}

/// Why a disguise is not written; nothing where it is.
fn refused(study: &Path, plan: &Plan, out: &Path) -> String {
    let refused = disguise(study, plan, out).err();
    refused.map_or_else(String::new, |error| format!("{error:#}"))
}

#[test]
fn a_disguise_has_a_folder_of_its_own() {
    let small = Small::new("disguise-own");
    let (study, out) = (small.study(), small.0.join("out"));
    let refused = |plan: &Plan, out: &Path| refused(&study, plan, out);
    // It would read what it has just written, and the study would be lost.
    assert!(refused(&plan(1), &small.0).contains("the study itself"));
    assert_eq!(fs::read_to_string(&study).unwrap(), STUDY);
    assert_eq!(refused(&plan(1), &out), "");
    assert_eq!(refused(&plan(1), &out), "", "the same again");
    let mut other = plan(1);
    other.frames.prefix = "other".to_owned();
    let said = refused(&other, &out);
    assert!(said.contains("among the new film's frames"), "{said}");
    fs::remove_file(out.join("disguise.toml")).unwrap();
    assert!(refused(&plan(1), &out).contains("that others made"));
    other.frames.prefix = "../frame".to_owned();
    assert!(refused(&other, &small.0.join("escaped")).contains("no name for a file"));
    other.frames.prefix = String::new();
    other.models.only = Some("fibula".to_owned());
    let said = refused(&other, &small.0.join("only"));
    assert!(
        said.ends_with("no component fibula: it has femur, tibia"),
        "{said}"
    );
}

/// A row that is missing makes all behind it those of other frames.
#[test]
fn references_of_other_frames_are_refused() {
    let small = Small::new("disguise-rows");
    write_poses(&small.0.join("femur.jts"), &poses().map(Some)).unwrap();
    let said = refused(&small.study(), &plan(1), &small.0.join("out"));
    assert!(
        said.contains("there are 2 rows, but the film has 1 frames"),
        "{said}"
    );
}

#[test]
fn names_in_all_letters_are_read_back() {
    let small = Small::new("disguise-names");
    // A letter of two, as one system writes it, and a mark for writing from the right.
    let (name, study) = ("fe\u{301}mur\u{200f}", small.0.join("named.toml"));
    let text = STUDY.replace("'small'", &format!("'{name}'"));
    let text = text.replace(
        "name = 'femur'",
        &format!("name = '{name}'\nrole = 'femur'"),
    );
    fs::write(&study, text).unwrap();
    let out = small.0.join("out");
    disguise(&study, &plan(1), &out).unwrap();
    let read = Study::read_quietly(&out.join("study.toml")).unwrap();
    assert_eq!(
        (&*read.name, &*read.components[0].name),
        (&*format!("{name} 1"), name)
    );
}
