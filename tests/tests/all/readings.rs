//! What was seen beside the model's outline, piece by piece: a model that was moved tells by how much, everywhere.

use fluoropose::image::frame::Frame;
use fluoropose::image::mask::Mask;
use fluoropose::image::profile::NormalReading;
use fluoropose::image::silhouette::Silhouette;
use fluoropose::pose::Pose;
use fluoropose::refine::{
    CameraView, OutlineReading, RefineBuffers, fit_at, outline_readings, outline_samples,
};
use fluoropose_laboratory::files::MaskBuffer;
use fluoropose_phantom::film::{Placed, silhouette};
use fluoropose_tests::{SEEN_FEMUR, camera, femur, surface, tibia};

use crate::mirrored;

const RIGHT_PX: f64 = 2.0;

#[test]
fn a_model_that_was_moved_is_off_by_that_much_along_each_normal() {
    let (femur, camera) = (femur(), camera());
    let words = silhouette(&camera, &Placed::at_rest(&femur, SEEN_FEMUR.into())).expect("drawn");
    let (width, height) = (camera.width(), camera.height());
    let mask = Mask::new(&words, width, height).expect("fits");
    let mut hidden = MaskBuffer::new(width, height).expect("a mask");
    let middle_row = height / 2;
    hidden.draw(|hidden| {
        for (column, row) in (0..middle_row).flat_map(|row| (0..width).map(move |c| (c, row))) {
            hidden.set(column, row, true);
        }
    });
    let hidden = hidden.mask();
    let seen = Silhouette::new(&mask, &hidden).expect("of one size");
    let model = surface(femur);
    let model = model.as_model();

    let mut moved = Pose::from(SEEN_FEMUR);
    moved.translation[0] += RIGHT_PX * -SEEN_FEMUR.z_mm / camera.focal()[0];
    let mut buffers = RefineBuffers::default();
    let mut memory = buffers.borrow(&model, &camera);
    let view = CameraView::only(&camera, seen);
    let mut readings: Vec<OutlineReading> = Vec::new();
    let fit = outline_readings(&model, view, &moved, &mut memory, |one| readings.push(*one));
    let fit = fit.expect("seen");
    assert_eq!(
        fit,
        fit_at(&model, &[view], &moved, &mut memory).expect("seen")
    );

    let mut whole = 0.0;
    outline_samples(&model, &camera, &moved, &mut memory, |one| {
        whole += one.length
    })
    .expect("drawn");
    let length: f64 = readings.iter().map(|one| one.length).sum();
    assert!((length / whole - 1.0).abs() < 0.02, "{length} of {whole}");
    let mut shifts = Vec::new();
    for one in &readings {
        let above = one.row < middle_row as f64;
        let is_unknown = one.seen == NormalReading::Unknown;
        assert_eq!(one.is_met().is_none(), is_unknown);
        // What is read reaches some pixels across the border of what is hidden.
        if (one.row - middle_row as f64).abs() > 15.0 {
            assert_eq!(is_unknown, above, "{one:?}");
        }
        if let NormalReading::At(px) = one.seen
            && one.normal[0].abs() > 0.9
        {
            shifts.push(-px / one.normal[0]);
        }
    }
    assert!(shifts.len() > 50, "{}", shifts.len());
    // Outlines of whole pixels: each is known to one, their mean to a part of one.
    let off = |px: &&f64| (**px - RIGHT_PX).abs() > 1.2;
    assert_eq!(shifts.iter().filter(off).count(), 0, "{shifts:?}");
    let mean = shifts.iter().sum::<f64>() / shifts.len() as f64;
    assert!((mean - RIGHT_PX).abs() < 0.15, "{mean}");
}

#[test]
fn a_tray_at_its_pose_lies_on_the_edges_of_its_film_and_every_piece_stands_for_what_is_beside_it() {
    let (pixels, camera, model) = (mirrored::grey(), camera(), surface(tibia()));
    let model = model.as_model();
    let frame = Frame::new(pixels, camera.width(), camera.height(), camera.width());
    let frame = frame.expect("fits");
    let view = CameraView::only(&camera, mirrored::shown(&frame));
    let mut buffers = RefineBuffers::default();
    let mut memory = buffers.borrow(&model, &camera);
    let truth = Pose::from(mirrored::TRUE);
    let mut whole = 0.0;
    outline_samples(&model, &camera, &truth, &mut memory, |one| {
        whole += one.length
    })
    .expect("drawn");
    let (mut pieces, mut length) = (0, 0.0);
    let fit = outline_readings(&model, view, &truth, &mut memory, |one| {
        pieces += 1;
        length += one.length;
    });
    let fit = fit.expect("seen");
    assert!(fit.met > 0.9 && fit.residual_px < 0.5, "{fit:?}");
    assert!(
        f64::from(pieces) < whole / 3.0,
        "{pieces} pieces of {whole} px"
    );
    assert!((length / whole - 1.0).abs() < 0.1, "{length} of {whole}");
}
