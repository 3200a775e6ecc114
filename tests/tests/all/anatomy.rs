//! Anatomical axes of whole implants, however their files turn them.

use fluoropose::joint::flange::side_by_flange;
use fluoropose::joint::kinematics::{Side, joint_angles, relative_pose};
use fluoropose::mesh::anatomy::{
    AnatomicalAxes, KneeComponent, anatomical_axes, component_by_shape,
};
use fluoropose::mesh::coarser;
use fluoropose::mesh::symmetry::symmetry_planes;
use fluoropose::mesh::{Mesh, OwnedModel};
use fluoropose::pose::{EulerPose, Pose, geodesic_deg};
use fluoropose_laboratory::files::read_model;
use fluoropose_phantom::implant::{self, Parameters};
use fluoropose_tests::{coarse_parts, femur, study, surface, tibia, turned};

fn axes(mesh: &Mesh<'_>, component: KneeComponent) -> AnatomicalAxes {
    let planes = symmetry_planes(mesh);
    anatomical_axes(mesh, &planes, component).expect("the shape tells")
}

/// Every rotation that permutes the axes.
fn permutations() -> Vec<Pose> {
    let quarters = [0.0, 90.0, 180.0, 270.0];
    let mut all: Vec<Pose> = Vec::new();
    for (z_rot_deg, x_rot_deg, y_rot_deg) in quarters.iter().flat_map(|&z| {
        quarters
            .iter()
            .flat_map(move |&x| quarters.map(|y| (z, x, y)))
    }) {
        let pose = Pose::from(EulerPose {
            z_rot_deg,
            x_rot_deg,
            y_rot_deg,
            ..EulerPose::default()
        });
        let rotation = pose.rotation.map(|row| row.map(f64::round));
        let pose = Pose { rotation, ..pose };
        if all
            .iter()
            .all(|other| geodesic_deg(&other.rotation, &rotation) > 1.0)
        {
            all.push(pose);
        }
    }
    assert_eq!(all.len(), 24);
    all
}

/// In the field's axes they are the file's own; permuted they are permuted, exactly; turned by any angle they turn with the
/// part to within what is taken for the file's own.
fn follow_the_part(model: &OwnedModel, component: KneeComponent, name: &str) {
    let own = axes(model.as_model().mesh(), component);
    assert_eq!(
        own.model_from_field.rotation,
        Pose::IDENTITY.rotation,
        "{name}"
    );
    assert!(own.front_is_known && own.are_files_own, "{name}");
    for by in permutations() {
        let turned = turned(model, &by);
        let found = axes(turned.as_model().mesh(), component);
        assert_eq!(found.model_from_field.rotation, by.rotation, "{name}");
        assert!(found.front_is_known, "{name}");
    }
    for turn in 0..8 {
        let by = Pose::from(EulerPose {
            z_rot_deg: 40.0 + 35.0 * f64::from(turn),
            x_rot_deg: 25.0 + 9.0 * f64::from(turn),
            y_rot_deg: 170.0 - 31.0 * f64::from(turn),
            ..EulerPose::default()
        });
        let turned = turned(model, &by);
        let found = axes(turned.as_model().mesh(), component);
        let off = geodesic_deg(&found.model_from_field.rotation, &by.rotation);
        assert!(off < 12.0, "{name}: {off} degrees");
    }
}

#[test]
fn the_axes_of_built_in_implants_follow_them() {
    let [femur, tibia] = coarse_parts();
    follow_the_part(&surface(femur), KneeComponent::Femur, "femur");
    follow_the_part(&surface(tibia), KneeComponent::Tibia, "tibia");
}

#[test]
fn the_axes_of_real_implants_follow_them() {
    let Some(study) = study("left8") else { return };
    let folder = study.parent().expect("a folder");
    for (file, component) in [
        ("KR_left_8_fem.stl", KneeComponent::Femur),
        ("KR_left_8_tib.stl", KneeComponent::Tibia),
    ] {
        let model = read_model(&folder.join(file)).expect("a model");
        follow_the_part(&model, component, file);
    }
}

#[test]
fn in_another_laboratorys_axes_the_femur_stands_on_the_tray_and_both_look_forwards() {
    let Some(study) = study("film70") else { return };
    let folder = study.parent().expect("a folder");
    let read = |name: &str| fluoropose_laboratory::files::read_poses(&folder.join(name));
    let (femurs, tibias) = (
        read("femur.jts").expect("poses"),
        read("tibia.jts").expect("poses"),
    );
    let of = |file: &str, component| {
        let model = read_model(&folder.join(file)).expect("a model");
        let model = model.as_model();
        (axes(model.mesh(), component), model.bounds().centre)
    };
    let (femur, femur_middle) = of("femur.stl", KneeComponent::Femur);
    let (tibia, tibia_middle) = of("tibia.stl", KneeComponent::Tibia);
    let mut flexions = Vec::new();
    for (at, (femur_pose, tibia_pose)) in femurs.iter().zip(&tibias).enumerate() {
        let (Some(femur_pose), Some(tibia_pose)) = (femur_pose, tibia_pose) else {
            continue;
        };
        let (f, t) = (
            femur_pose.compose(&femur.model_from_field),
            tibia_pose.compose(&tibia.model_from_field),
        );
        let column = |pose: &Pose, k: usize| pose.rotation.map(|row| row[k]);
        let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let (a, b) = (
            femur_pose.transform(&femur_middle),
            tibia_pose.transform(&tibia_middle),
        );
        let between: [f64; 3] = std::array::from_fn(|k| a[k] - b[k]);
        assert!(
            dot(between, column(&t, 1)) > 0.0,
            "frame {at}: the femur is above the tray"
        );
        assert!(
            dot(column(&f, 2), column(&t, 2)) > 0.7,
            "frame {at}: both have the same right"
        );
        let flexion = joint_angles(&relative_pose(&f, &t), Side::Left).flexion_deg;
        assert!(
            (-15.0..150.0).contains(&flexion),
            "frame {at}: flexed by {flexion}"
        );
        flexions.push(flexion);
    }
    let (least, most) = flexions
        .iter()
        .fold((f64::MAX, f64::MIN), |(a, b), &x| (a.min(x), b.max(x)));
    println!("flexed by {least} to {most}");
    assert!(most - least > 30.0, "the knee bends: {least} to {most}");
}

/// Whole, turned, in inches, mirrored, and with a tenth of its triangles.
fn is_told_from_the_other(model: &OwnedModel, component: KneeComponent, name: &str) {
    let told = |model: &OwnedModel| component_by_shape(model.as_model().mesh());
    assert_eq!(told(model), Some(component), "{name}");
    let by = Pose::from(EulerPose {
        x_mm: 200.0,
        z_rot_deg: 71.0,
        x_rot_deg: -33.0,
        y_rot_deg: 142.0,
        ..EulerPose::default()
    });
    assert_eq!(told(&turned(model, &by)), Some(component), "{name} turned");
    let flat = model.as_model();
    for scales in [[1.0 / 25.4; 3], [-1.0, 1.0, 1.0]] {
        let vertices = flat.vertices().iter();
        let vertices = vertices.flat_map(|v| std::array::from_fn::<_, 3, _>(|k| v[k] * scales[k]));
        let triangles = flat.triangles().as_flattened().to_vec();
        let scaled = OwnedModel::new(vertices.collect(), triangles).expect("as valid as before");
        assert_eq!(told(&scaled), Some(component), "{name} by {scales:?}");
    }
    for cell_mm in [1.5, 3.0] {
        if let Some(coarse) = coarser(&flat, cell_mm) {
            assert_eq!(told(&coarse), Some(component), "{name} to {cell_mm} mm");
        }
    }
}

#[test]
fn shapes_tell_built_in_components_apart() {
    is_told_from_the_other(&surface(femur()), KneeComponent::Femur, "femur");
    is_told_from_the_other(&surface(tibia()), KneeComponent::Tibia, "tibia");
}

#[test]
fn shapes_tell_real_components_apart() {
    for (name, femur, tibia) in [
        ("left8", "KR_left_8_fem.stl", "KR_left_8_tib.stl"),
        ("film70", "femur.stl", "tibia.stl"),
    ] {
        let Some(study) = study(name) else { continue };
        let folder = study.parent().expect("a folder");
        for (file, component) in [(femur, KneeComponent::Femur), (tibia, KneeComponent::Tibia)] {
            let model = read_model(&folder.join(file)).expect("a model");
            is_told_from_the_other(&model, component, file);
        }
    }
}

fn mirrored(model: &OwnedModel) -> OwnedModel {
    let model = model.as_model();
    let vertices = model.vertices().iter().flat_map(|&[x, y, z]| [-x, y, z]);
    let triangles = model.triangles().iter().flat_map(|&[a, b, c]| [a, c, b]);
    OwnedModel::new(vertices.collect(), triangles.collect()).expect("as valid as before")
}

fn told_side(model: &OwnedModel) -> Option<Side> {
    let model = model.as_model();
    side_by_flange(model.mesh(), &axes(model.mesh(), KneeComponent::Femur))
}

#[test]
fn a_flange_tells_the_knee_that_its_component_is_made_for_however_its_file_turns_it() {
    for (side, told) in [
        (implant::Side::Left, Side::Left),
        (implant::Side::Right, Side::Right),
    ] {
        let parameters = Parameters {
            side,
            resolution: 0.5,
            ..Parameters::default()
        };
        let model = surface(implant::femur(&parameters).expect("usual"));
        for by in permutations() {
            assert_eq!(told_side(&turned(&model, &by)), Some(told), "{side}");
        }
    }
}

/// The first is that of a left knee. What the second one is of, its study does not know.
#[test]
fn flanges_of_real_components_tell_a_side_and_their_mirror_images_the_other() {
    for (name, file, told) in [
        ("left8", "KR_left_8_fem.stl", Side::Left),
        ("film70", "femur.stl", Side::Right),
    ] {
        let Some(study) = study(name) else { return };
        let folder = study.parent().expect("a folder");
        let model = read_model(&folder.join(file)).expect("a model");
        assert_eq!(told_side(&model), Some(told), "{name}");
        assert_eq!(told_side(&mirrored(&model)), Some(told.other()), "{name}");
    }
}
