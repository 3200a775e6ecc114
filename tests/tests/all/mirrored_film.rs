//! Pictures that are mirrored as a whole: told by the joint, whose parts lie beside each other then, and never of right ones.

use std::path::{Path, PathBuf};

use fluoropose::finder::rivals::refine_rivals;
use fluoropose::finder::{FlippedFit, FlippedKnee};
use fluoropose::image::silhouette::Silhouette;
use fluoropose::joint::beside::{Beside, Middles};
use fluoropose::mesh::OwnedModel;
use fluoropose::mesh::anatomy::KneeComponent;
use fluoropose::mesh::mirror::mirror_pose;
use fluoropose::mesh::symmetry::symmetry_planes;
use fluoropose::pose::{EulerPose, Pose};
use fluoropose::refine::{CameraView, RefineBuffers, RefineOptions};
use fluoropose::render::{Projected, render, scratch_needed};
use fluoropose_laboratory::files::{
    Frames, MaskBuffer, Role, Study, files_in, grey, name_of, owned, read_mask, write_text,
};
use fluoropose_laboratory::finding::{Method, axes_of};
use fluoropose_laboratory::verbs::evaluate::{Request, evaluate};
use fluoropose_phantom::film::motion::knee;
use fluoropose_phantom::implant::{self, Parameters, Side, Size};
use fluoropose_phantom::picture::{write_grey, write_mask};
use fluoropose_tests::{camera, study, turned};

/// A knee whose files have any axes, with what is said of its joint.
struct Case {
    /// Femur and tibia.
    models: [OwnedModel; 2],
    /// Their anatomical axes, as their shapes tell them.
    axes: [Pose; 2],
    /// `camera_from_model`.
    poses: [Pose; 2],
}

/// Numbers from -1 to 1 without a pattern.
fn draw(case: usize, irrational: f64) -> f64 {
    2.0 * ((irrational.sqrt() * (case + 1) as f64).fract()) - 1.0
}

impl Case {
    /// One of many: side, size, axes, view, flexion to 140 degrees, and how far the tray slid across, mm.
    fn of(case: usize, slid_mm: f64) -> Self {
        let side = [Side::Left, Side::Right][case % 2];
        let size = Size::numbered(1 + case % 8).expect("a size");
        let parameters = Parameters {
            side,
            size,
            // Its axes are the same with a third of the triangles.
            resolution: 0.5,
        };
        let femur = implant::femur(&parameters).expect("possible");
        let tibia = implant::tibia(&parameters).expect("possible");
        let tray = EulerPose {
            x_mm: 30.0 * draw(case, 2.0),
            y_mm: 30.0 * draw(case, 3.0) - 20.0,
            z_mm: 60.0 * draw(case, 5.0) - 1050.0,
            z_rot_deg: 180.0 * draw(case, 7.0),
            x_rot_deg: 8.0 * draw(case, 11.0),
            y_rot_deg: 12.0 * draw(case, 13.0),
        };
        let flexion = 70.0 + 70.0 * draw(case, 17.0);
        let position = knee(tray, flexion, side, &femur, size.width_mm());
        let aside = Pose::from(EulerPose {
            z_mm: slid_mm,
            ..EulerPose::default()
        });
        let own = [
            Pose::from(position.femur),
            Pose::from(position.tibia).compose(&aside),
        ];
        let other = |k: f64| {
            let turn = |irrational: f64| 180.0 * draw(case, irrational + k);
            Pose::from(EulerPose {
                x_mm: 20.0 * draw(case, 19.0 + k),
                z_rot_deg: turn(23.0),
                x_rot_deg: turn(29.0),
                y_rot_deg: turn(31.0),
                ..EulerPose::default()
            })
        };
        let by = [other(0.0), other(12.0)];
        let models = [femur, tibia].map(|made| owned(made).expect("valid"));
        let models = [turned(&models[0], &by[0]), turned(&models[1], &by[1])];
        let roles = [Role::Femur, Role::Tibia];
        let axes = [0, 1].map(|k| {
            let told = axes_of(&models[k].as_model(), roles[k], None).expect("no words");
            told.expect("the shape tells its axes").model_from_field
        });
        let poses = [0, 1].map(|k| own[k].compose(&by[k].inverse()));
        Self {
            models,
            axes,
            poses,
        }
    }

    fn middles(&self) -> Middles {
        let mesh = |k: usize| *self.models[k].as_model().mesh();
        Middles::new((mesh(0), &self.axes[0]), (mesh(1), &self.axes[1])).expect("a plate")
    }

    fn flipped(&self) -> FlippedKnee {
        let models = [self.models[0].as_model(), self.models[1].as_model()];
        FlippedKnee::new((&models[0], &self.axes[0]), (&models[1], &self.axes[1])).expect("a plate")
    }

    /// The component's silhouette, in a mirror or not, and the pose that its outline leads to.
    fn found(&self, component: usize, is_mirrored: bool) -> Option<(MaskBuffer, Pose)> {
        let (camera, model) = (camera(), self.models[component].as_model());
        let mut mask = MaskBuffer::new(camera.width(), camera.height()).expect("a shape");
        let mut scratch = vec![Projected::default(); scratch_needed(&model)];
        let pose = &self.poses[component];
        mask.draw(|mask| render(&model, &camera, pose, &mut scratch, mask))
            .expect("in front");
        let planes = symmetry_planes(model.mesh());
        let plane = planes.first()?;
        let mut starts = [*pose, *pose];
        if is_mirrored {
            mask = mirrored(&mask);
            // As if seen from behind, and as if the part were its own mirror image.
            let behind = in_mirror(pose, &plane.normal, &plane.point);
            starts = [behind, mirror_pose(&behind, plane)];
        }
        let view = mask.mask();
        let silhouette = Silhouette::from(&view);
        let view = CameraView::only(&camera, silhouette);
        let mut buffers = RefineBuffers::default();
        let mut memory = buffers.borrow(&model, &camera);
        let options = RefineOptions::default();
        let found = refine_rivals(&model, &[view], &starts, &planes, options, &mut memory).ok()?;
        Some((mask, found.first()?.refined.pose))
    }
}

/// A pose seen in a mirror across x, of a part that is nearly its own mirror image in a plane.
fn in_mirror(pose: &Pose, normal: &[f64; 3], point: &[f64; 3]) -> Pose {
    let across = |row: usize| if row == 0 { -1.0 } else { 1.0 };
    let rotation: [[f64; 3]; 3] = std::array::from_fn(|row| {
        let own = pose.rotation[row];
        let along: f64 = own.iter().zip(normal).map(|(a, b)| a * b).sum();
        std::array::from_fn(|k| across(row) * (own[k] - 2.0 * along * normal[k]))
    });
    let middle = pose.transform(point);
    let turned = Pose {
        rotation,
        translation: [0.0; 3],
    }
    .transform(point);
    Pose {
        rotation,
        translation: std::array::from_fn(|k| across(k) * middle[k] - turned[k]),
    }
}

fn mirrored(mask: &MaskBuffer) -> MaskBuffer {
    let mask = mask.mask();
    let (width, height) = (mask.width(), mask.height());
    let pixel = |at: usize| u8::from(mask.get(width - 1 - at % width, at / width));
    let pixels: Vec<u8> = (0..width * height).map(pixel).collect();
    MaskBuffer::of_pixels(&pixels, width, height).expect("the same shape")
}

/// What is told of a knee by its silhouettes, in a mirror or not: where its parts lie alone, and with its picture flipped.
fn told(knee: &Case, is_mirrored: bool) -> [Option<Beside>; 2] {
    let found = [0, 1].map(|component| knee.found(component, is_mirrored).expect("a pose"));
    let poses = [0, 1].map(|k| [Some(found[k].1)]);
    let middles = knee.middles();
    let apart = middles.apart_of(&poses[0], &poses[1]);
    let alone = middles.judge_poses(&poses[0], &poses[1]);
    let (flipped, camera) = (knee.flipped(), camera());
    let mut buffers = RefineBuffers::default();
    let components = [KneeComponent::Femur, KneeComponent::Tibia];
    let fit = [0, 1].map(|k| {
        let mask = found[k].0.mask();
        let view = CameraView::only(&camera, Silhouette::from(&mask));
        let own = (&knee.models[k].as_model(), &found[k].1);
        let options = RefineOptions::default();
        flipped.fit(components[k], own, view, options, &mut buffers)
    });
    let gains = fit.map(|fit| fit.map_or(f64::NAN, |fit| fit.gain));
    let mut told = alone.clone();
    let both = fit[0].zip(fit[1]).map(<[FlippedFit; 2]>::from);
    flipped.judge(&mut told, &apart, &[both]);
    println!(
        "mirrored {is_mirrored}: {:.1} mm of {:.1}, without flipping {gains:.2?} times as much remains",
        apart[0],
        middles.most_mm()
    );
    [alone[0], told[0]]
}

/// Right knees of any axes, side, size, view and flexion, their trays slid by 8 mm to either side: nothing is told.
#[test]
fn right_pictures_are_never_told_as_mirrored() {
    for case in 0..24 {
        let knee = Case::of(case, 8.0 * [-1.0, 0.0, 1.0][case % 3]);
        assert_eq!(told(&knee, false), [None; 2], "case {case}");
    }
}

/// Mirrored ones are told, by where the parts lie or because both fit better flipped back; flipped back they are a knee.
#[test]
fn mirrored_pictures_are_told_and_are_a_knee_when_they_are_flipped_back() {
    let (mut lying, mut all, mut silent) = (0, 0, 0);
    for case in 0..24 {
        let [alone, told] = told(&Case::of(case, 0.0), true);
        lying += usize::from(alone.is_some());
        all += usize::from(told.is_some());
        match told {
            Some(told) => assert!(
                told.flipped.is_some_and(|flipped| flipped.mm < 4.0),
                "{told}"
            ),
            None => silent += 1,
        }
    }
    println!("mirrored: {lying} of 24 told by where the parts lie, {all} with the picture flipped");
    assert!(silent == 0, "{silent}");
}

/// Every `step`th frame of a study with its masks as they are, or mirrored; references are left out.
fn copied(
    study: &Study,
    (source, step): (&str, usize),
    method: Method,
    is_mirrored: bool,
) -> PathBuf {
    let name = format!(
        "fluoropose-mirrored-{}-{}-{is_mirrored}-{}",
        study.name,
        method.word(),
        std::process::id()
    );
    let folder = std::env::temp_dir().join(name);
    let mut text = format!(
        "name = \"{}\"\nside = \"left\"\ncalibration = {:?}\n",
        study.name, study.calibration
    );
    for component in &study.components {
        let masks = folder.join(&component.name);
        std::fs::create_dir_all(&masks).expect("a folder");
        for file in files_in(&component.masks[source])
            .expect("masks")
            .iter()
            .step_by(step)
        {
            let mut mask = read_mask(file).expect("a mask");
            if is_mirrored {
                mask = mirrored(&mask);
            }
            let to = Path::new(&name_of(file)).with_extension("png");
            write_mask(&masks.join(to), &mask.mask()).expect("written");
        }
        text += &format!(
            "[[component]]\nname = \"{}\"\nmodel = {:?}\nmasks.a = {:?}\n",
            component.name, component.model, masks
        );
    }
    if let (Method::Image, Some(frames)) = (method, &study.frames) {
        let to = folder.join("frames");
        std::fs::create_dir_all(&to).expect("a folder");
        copy_frames(frames, &to, step, is_mirrored);
        let (head, rest) = text.split_once("[[component]]").expect("components");
        text = format!("{head}frames = {to:?}\n[[component]]{rest}");
    }
    let file = folder.join("study.toml");
    write_text(&file, &text).expect("written");
    file
}

fn copy_frames(from: &Path, to: &Path, step: usize, is_mirrored: bool) {
    let (width, height) = (1024, 1024);
    let files = files_in(from).expect("frames");
    let frames = Frames::read(from, files.len(), (width, height)).expect("frames");
    for (at, file) in files.iter().enumerate().step_by(step) {
        let frame = frames.decode(at).expect("a frame");
        let grey = grey(&frame).expect("a picture");
        let column = |k: usize| if is_mirrored { width - 1 - k } else { k };
        let pixels: Vec<u8> = (0..width * height)
            .map(|k| {
                grey.at(column(k % width) as f64 + 0.5, (k / width) as f64 + 0.5)
                    .expect("a pixel") as u8
            })
            .collect();
        let name = Path::new(&name_of(file)).with_extension("png");
        write_grey(&to.join(name), (width, height), &pixels).expect("written");
    }
}

/// The verdicts of both components, by their tables.
fn verdicts(study: &Path, method: Method) -> Vec<(String, String)> {
    let folder = study.parent().expect("a folder");
    let poses = folder.join("found");
    let request = Request {
        poses: Some(&poses),
        ..Request::of(method)
    };
    evaluate(study, &request).expect("poses");
    let table = |name: &str| {
        let text = std::fs::read_to_string(poses.join(format!("{name}-a.csv"))).expect("a table");
        let rows = text.lines().skip(1).map(|row| {
            let word = ["good", "doubtful", "none"]
                .into_iter()
                .find(|word| row.contains(&format!(",{word},")));
            (word.expect("a verdict").to_owned(), row.to_owned())
        });
        rows.collect::<Vec<_>>()
    };
    let all = [table("femur"), table("tibia")].concat();
    std::fs::remove_dir_all(folder).expect("it is there");
    all
}

fn check(name: &str, masks: (&str, usize), method: Method) {
    let Some(path) = study(name) else { return };
    let study = Study::read(&path).expect("a study");
    let told = |is_mirrored| {
        let all = verdicts(&copied(&study, masks, method, is_mirrored), method);
        let said = |(word, row): &&(String, String)| word == "doubtful" && row.contains("mirrored");
        (all.iter().filter(said).count(), all)
    };
    let (count, all) = told(true);
    assert_eq!(count, all.len(), "{all:?}");
    assert!(
        all.iter()
            .all(|(_, row)| row.contains("Flipped left to right both fit"))
    );
    let (count, all) = told(false);
    assert_eq!(count, 0, "{all:?}");
}

#[test]
fn mirrored_masks_of_a_kneeling_knee_are_doubtful_and_right_ones_are_not() {
    check("left8", ("labels", 4), Method::Refined);
}

#[test]
fn mirrored_masks_of_another_laboratory_are_doubtful_and_right_ones_are_not() {
    check("film70", ("reference", 12), Method::Refined);
}

#[test]
fn mirrored_frames_of_a_kneeling_knee_are_doubtful_and_right_ones_are_not() {
    check("left8", ("labels", 4), Method::Image);
}
