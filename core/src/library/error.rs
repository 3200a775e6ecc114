//! Why bytes are no library, and why none can be built.

use core::fmt;

use thiserror::Error;

use super::wire::{PLAIN_VERSION, VERSION};
use crate::camera::CameraError;
use crate::canonical::CanonicalError;
use crate::image::mask::MaskError;
use crate::memory::TooLittleMemory;
use crate::render::RenderError;

/// Why bytes are not a library.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum LibraryError {
    /// The first bytes are not those of a library.
    #[error("this is not a library file: it does not begin with FLUOROPL")]
    Magic,
    /// The layout is unknown.
    #[error(
        "the library has version {0}; this program reads versions {PLAIN_VERSION} and {VERSION}. Build it again"
    )]
    Version(u16),
    /// The file is shorter or longer than its header says.
    #[error("the library has {given} bytes but should have {needed}: the file is cut or padded")]
    Length {
        /// Bytes by the header.
        needed: u64,
        /// Bytes that were given.
        given: u64,
    },
    /// A checksum is wrong.
    #[error("the library's {0} is damaged: its checksum does not fit. Build or fetch it again")]
    Checksum(&'static str),
    /// A number in it is impossible although the checksum fits.
    #[error("the library's {0} is not possible; the file was written wrongly. Build it again")]
    Value(&'static str),
    /// The canonical frame is impossible.
    #[error(transparent)]
    Canonical(#[from] CanonicalError),
    /// The camera is impossible.
    #[error(transparent)]
    Camera(#[from] CameraError),
}

/// Why a library cannot be built.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum BuildError {
    /// A parameter is impossible.
    #[error("{}", Permitted(.0))]
    Parameter(LibraryError),
    /// The model would touch the focus.
    #[error(
        "the distance of {distance} mm is shorter than the model's radius of {radius:.1} mm; are the lengths of model and calibration in mm?"
    )]
    TooNear {
        /// Distance asked for, mm.
        distance: f64,
        /// Of the model, mm.
        radius: f64,
    },
    /// Working memory is too short.
    #[error(transparent)]
    Memory(#[from] TooLittleMemory),
    /// Fewer or more packed views than the grid has.
    #[error("the grid has {needed} views but {given} were packed")]
    Views {
        /// Views of the grid.
        needed: usize,
        /// Packed views.
        given: usize,
    },
    /// The bytes given for a packed view are not one.
    #[error("view {0} was not packed, or not whole: pack it again")]
    Packed(usize),
    /// A view has no canonical form.
    #[error(transparent)]
    Canonical(#[from] CanonicalError),
    /// A mask could not be made.
    #[error(transparent)]
    Mask(#[from] MaskError),
    /// A view could not be drawn.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The views' camera is impossible.
    #[error(transparent)]
    Camera(#[from] CameraError),
}

/// Names of what a caller chooses, in `LibraryError::Value`.
pub(super) const X_ROTATIONS: &str = "range of x rotations";
pub(super) const Y_ROTATIONS: &str = "range of y rotations";
pub(super) const DISTANCE: &str = "distance";

/// What is wrong with a parameter that was asked for, and what may be: nothing was written that could be built again.
struct Permitted<'e>(&'e LibraryError);

impl fmt::Display for Permitted<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let &LibraryError::Value(what) = self.0 else {
            return write!(f, "{}", self.0);
        };
        let permitted = match what {
            X_ROTATIONS => "it may reach from -89 to 89 degrees, in 4096 steps at most",
            Y_ROTATIONS => "it may reach from -360 to 360 degrees, in 4096 steps at most",
            DISTANCE => "it must be more than 0 and at most 100 000 mm",
            _ => "are the model's lengths in mm?",
        };
        write!(
            f,
            "the {what} that was asked for is not possible: {permitted}"
        )
    }
}

#[cfg(test)]
mod tests {
    use crate::camera::Camera;
    use crate::canonical::CanonicalSpec;
    use crate::library::{Builder, ViewAxis, ViewGrid};
    use crate::mesh::edges::fake;
    use crate::mesh::{Mesh, Model};
    use std::string::{String, ToString as _};

    #[test]
    fn what_was_asked_for_is_told_with_what_may_be() {
        let (vertices, triangles) = fake::torus(&[0.0; 40]);
        let model = Model::new(Mesh::new(&vertices, &triangles).expect("valid"));
        let camera = Camera::new(256, 256, [900.0; 2], [128.0; 2]).expect("valid");
        let said = |x: [f64; 2], y: [f64; 2], distance| -> String {
            let axis = |[first, last]: [f64; 2]| ViewAxis {
                first,
                step: 2.0,
                count: ((last - first) / 2.0) as usize + 1,
            };
            let grid = ViewGrid {
                x: axis(x),
                y: axis(y),
            };
            match Builder::new(model, camera, CanonicalSpec::USUAL, grid, distance) {
                Ok(_) => String::new(),
                Err(error) => error.to_string(),
            }
        };
        let (narrow, distance) = ([-10.0, 10.0], 1000.0);
        assert_eq!(
            said([60.0, 90.0], narrow, distance),
            "the range of x rotations that was asked for is not possible: it may reach from -89 to 89 degrees, in 4096 steps at most"
        );
        assert_eq!(said([-89.0, 89.0], narrow, distance), "");
        let wide = said(narrow, [0.0, 362.0], distance);
        assert!(wide.contains("y rotations") && wide.contains("from -360 to 360 degrees"));
        let far = said(narrow, narrow, 2e5);
        assert!(far.contains("at most 100 000 mm"), "{far}");
    }
}
