//! A coarse implant, for outlines and as bytes to be changed.

use std::sync::LazyLock;

use fluoropose::Camera;
use fluoropose::canonical::CanonicalSpec;
use fluoropose::implant::write_implant;
use fluoropose::library::ViewAxis;
use fluoropose::mesh::symmetry::symmetry_planes;
use fluoropose::mesh::{OwnedModel, coarser};
use fluoropose_laboratory::finding::{ViewOptions, build_library};
use fluoropose_laboratory::options::Range;
use fluoropose_phantom::implant::{Parameters, femur};

use crate::surface;

/// Side of the square frame, pixels.
pub(super) const SIDE: usize = 128;
const DISTANCE: f64 = 900.0;

/// What was made.
pub(super) struct Made {
    pub(super) model: OwnedModel,
    pub(super) library: Vec<u8>,
    /// All of it in one file.
    pub(super) implant: Vec<u8>,
}

/// A coarse implant with few views.
pub(super) static FEMUR: LazyLock<Made> = LazyLock::new(|| made(fine()));

/// All of a small implant in one file: vertices within so many mm are one.
///
/// # Panics
/// Where nothing would be left.
pub fn implant_file(cell_mm: f64) -> Vec<u8> {
    let model = coarser(&fine().as_model(), cell_mm).expect("something is left");
    made(model).implant
}

fn fine() -> OwnedModel {
    let parameters = Parameters {
        resolution: 0.5,
        ..Parameters::default()
    };
    surface(femur(&parameters).expect("possible"))
}

fn made(model: OwnedModel) -> Made {
    let axis = Some(Range(ViewAxis {
        first: -15.0,
        step: 5.0,
        count: 7,
    }));
    let views = ViewOptions {
        x: axis,
        y: axis,
        area: Some(CanonicalSpec::COARSE.area()),
        size: Some(CanonicalSpec::COARSE.size()),
        ..ViewOptions::default()
    };
    let library = build_library(model.as_model(), camera(), &views, DISTANCE).expect("built");
    let planes = symmetry_planes(model.as_model().mesh());
    let implant = write_implant(&model.as_model(), &library.bytes, &planes, 0.25);
    Made {
        library: library.bytes,
        implant: implant.expect("they belong together"),
        model,
    }
}

/// The camera that it is seen by.
pub(super) fn camera() -> Camera {
    Camera::from_principal_distance(SIDE, SIDE, 1000.0, 2.4, [0.0; 2]).expect("valid")
}
