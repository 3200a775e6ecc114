//! Outlines of any shape, to poses.

use fluoropose::finder::choice::ChoiceContext;
use fluoropose::image::mask::words_needed;
use fluoropose::search::kernels::Kernels;
use fluoropose::{
    Component, FinderBuffers, Goal, Library, MaskMut, Outline, Point, RefineOptions, Silhouette,
    find,
};

use super::made::{FEMUR, SIDE, camera};

/// Bytes are points, two bytes a coordinate in sixteenths of a pixel, on the frame and beyond.
pub(super) fn run(bytes: &[u8]) {
    let coordinate = |two: &[u8]| f64::from(i16::from_le_bytes([two[0], two[1]])) / 16.0;
    let points: Vec<Point> = bytes
        .chunks_exact(4)
        .map(|four| Point::new(coordinate(&four[..2]), coordinate(&four[2..])))
        .collect();
    let Ok(outline) = Outline::new(&points, SIDE, SIDE) else {
        return;
    };
    let model = FEMUR.model.as_model();
    let library = Library::open(&FEMUR.library).expect("whole");
    look(
        &Component {
            library: &library,
            model: &model,
            planes: &[],
        },
        &outline,
    );
}

/// Looks for the poses that explain an outline.
///
/// # Panics
/// Where one of them is none.
pub(super) fn look(component: &Component<'_>, outline: &Outline<'_>) {
    let mut words = vec![0; words_needed(SIDE, SIDE)];
    let mut mask = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
    mask.fill_outline(outline);
    let mask = mask.into_mask();
    let (camera, mut buffers) = (camera(), FinderBuffers::default());
    let mut memory = buffers.borrow(component, &camera, Kernels::PORTABLE);
    let (silhouette, options) = (Silhouette::from(&mask), RefineOptions::default());
    let Ok(found) = find(
        component,
        &camera,
        &silhouette,
        Goal::Outline,
        options,
        &mut memory,
    ) else {
        return;
    };
    for candidate in &found.candidates {
        assert!(candidate.pose.is_rigid(1e-6), "no rotation");
        let numbers = candidate.pose.translation;
        assert!(
            numbers.iter().all(|number| number.is_finite()),
            "{numbers:?}"
        );
        assert!(numbers[2] < 0.0, "behind the focus");
    }
    let _ = found.decide(&ChoiceContext::default());
}
