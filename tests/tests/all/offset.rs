//! Outlines that lie off the implant's everywhere alike: taken away where it is known, told where it is not.

use fluoropose::camera::Camera;
use fluoropose::image::mask::Mask;
use fluoropose::image::silhouette::{CommonOffset, OutlineOrigin, Silhouette};
use fluoropose::mesh::Model;
use fluoropose::pose::covariance::Deviations;
use fluoropose::pose::{EulerPose, Pose};
use fluoropose::refine::{
    CameraView, RefineBuffers, RefineOptions, assess, outline_offset, refine,
};
use fluoropose_laboratory::files::MaskBuffer;
use fluoropose_phantom::film::{Placed, silhouette};
use fluoropose_tests::{SEEN_FEMUR, camera, femur, surface};

/// The same with all pixels that touch it, as a network might see it.
fn widened(mask: &Mask<'_>) -> MaskBuffer {
    let (width, height) = (mask.width(), mask.height());
    let mut wide = MaskBuffer::new(width, height).expect("a mask");
    wide.draw(|wide| {
        for (column, row) in (1..height - 1).flat_map(|row| (1..width - 1).map(move |c| (c, row))) {
            let beside = [(0, 1), (1, 0), (1, 1), (1, 2), (2, 1)];
            let touches = |&(right, down): &_| mask.get(column + right - 1, row + down - 1);
            wide.set(column, row, beside.iter().any(touches));
        }
    });
    wide
}

/// A pose that was refined from the truth, and its standard deviations.
fn refined(model: &Model<'_>, camera: &Camera, seen: Silhouette<'_>) -> (EulerPose, Deviations) {
    let (view, mut buffers) = ([CameraView::only(camera, seen)], RefineBuffers::default());
    let mut memory = buffers.borrow(model, camera);
    let (truth, options) = (Pose::from(SEEN_FEMUR), RefineOptions::default());
    let refined = refine(model, &view, &truth, options, &mut memory).expect("refined");
    let told = assess(model, &view, &refined, &mut memory).expect("assessed");
    let covariance = told.covariance.expect("determined");
    let deviations = covariance.deviations(&refined.pose, &model.bounds().centre);
    (EulerPose::from(refined.pose), deviations)
}

/// How far z is off, and its standard deviation, mm.
fn depth(model: &Model<'_>, camera: &Camera, seen: Silhouette<'_>) -> [f64; 2] {
    let (found, deviations) = refined(model, camera, seen);
    [found.z_mm - SEEN_FEMUR.z_mm, deviations.z_mm]
}

#[test]
fn a_common_offset_is_found_taken_away_and_told() {
    let (femur, camera) = (femur(), camera());
    let truth = Pose::from(SEEN_FEMUR);
    let words = silhouette(&camera, &Placed::at_rest(&femur, SEEN_FEMUR.into())).expect("drawn");
    let mask = Mask::new(&words, camera.width(), camera.height()).expect("fits");
    let wide = widened(&mask);
    let (wide, model) = (wide.mask(), surface(femur));
    let (wide, model) = (Silhouette::from(&wide), model.as_model());

    let mut buffers = RefineBuffers::default();
    let mut memory = buffers.borrow(&model, &camera);
    let view = CameraView::only(&camera, wide);
    let px = outline_offset(&model, view, &truth, &mut memory).expect("seen");
    let px = px.expect("met");
    assert!((0.6..1.1).contains(&px), "{px}");

    let [off, told] = depth(&model, &camera, wide.laid_by(OutlineOrigin::Drawn));
    assert!(off > 3.0, "{off}");
    let [_, of_a_mask] = depth(&model, &camera, wide);
    assert!(told < 0.9 * of_a_mask, "{told} {of_a_mask}");
    assert!(off < 1.5 * of_a_mask, "{off} {of_a_mask}");
    let unknown = CommonOffset {
        px: 0.0,
        deviation_px: px,
    };
    let [still_off, wider] = depth(&model, &camera, wide.lying_off(unknown));
    assert_eq!(still_off, off);
    let by_offset = (wider * wider - told * told).sqrt();
    assert!((off - by_offset).abs() < 0.2 * off, "{off} {by_offset}");
    let known = CommonOffset {
        px,
        deviation_px: 0.0,
    };
    let [off, _] = depth(&model, &camera, wide.lying_off(known));
    assert!(off.abs() < 0.5, "{off}");
}

/// Another hand or another exposure draws one side of a mask too wide and not the other: all of the outline is shifted then, and wider along one line
/// than across, which leaves as little as an outline that is wider everywhere. What is told of a pose holds for that too.
#[test]
fn a_mask_that_is_too_wide_on_one_side_is_told_with_deviations_that_hold() {
    let (femur, camera) = (femur(), camera());
    let words = silhouette(&camera, &Placed::at_rest(&femur, SEEN_FEMUR.into())).expect("drawn");
    let mask = Mask::new(&words, camera.width(), camera.height()).expect("fits");
    let model = surface(femur);
    let model = model.as_model();
    for (right, down) in [(1, 0), (-1, 0), (0, 1), (0, -1)] {
        let wide = widened_towards(&mask, right, down, 2);
        let wide = wide.mask();
        let told = off_in_deviations(&model, &camera, Silhouette::from(&wide));
        assert!(
            told.iter().all(|off| *off < 4.0),
            "{right} {down}: {told:.1?}"
        );
        let drawn = Silhouette::from(&wide).laid_by(OutlineOrigin::Drawn);
        let certain = off_in_deviations(&model, &camera, drawn);
        let worst = |off: [f64; 6]| off.into_iter().fold(0.0, f64::max);
        assert!(
            worst(certain) > 1.5 * worst(told),
            "{certain:.1?} {told:.1?}"
        );
    }
}

/// The same with so many pixels more on one side.
fn widened_towards(mask: &Mask<'_>, right: isize, down: isize, pixels: isize) -> MaskBuffer {
    let (width, height) = (mask.width(), mask.height());
    let mut wide = MaskBuffer::new(width, height).expect("a mask");
    let is_set = |column: usize, row: usize| {
        (0..=pixels).any(|step| {
            let place = (
                column.checked_add_signed(-step * right),
                row.checked_add_signed(-step * down),
            );
            matches!(place, (Some(column), Some(row)) if column < width && row < height && mask.get(column, row))
        })
    };
    wide.draw(|wide| {
        for (column, row) in (0..height).flat_map(|row| (0..width).map(move |c| (c, row))) {
            wide.set(column, row, is_set(column, row));
        }
    });
    wide
}

/// How far each number of the pose is off, in its own standard deviations.
fn off_in_deviations(model: &Model<'_>, camera: &Camera, seen: Silhouette<'_>) -> [f64; 6] {
    let (found, one) = refined(model, camera, seen);
    let truth = SEEN_FEMUR;
    [
        (found.x_mm - truth.x_mm) / one.x_mm,
        (found.y_mm - truth.y_mm) / one.y_mm,
        (found.z_mm - truth.z_mm) / one.z_mm,
        (found.z_rot_deg - truth.z_rot_deg) / one.z_rot_deg,
        (found.x_rot_deg - truth.x_rot_deg) / one.x_rot_deg,
        (found.y_rot_deg - truth.y_rot_deg) / one.y_rot_deg,
    ]
    .map(f64::abs)
}
