//! Which views a library holds.

use fluoropose::camera::calibration::Calibration;
use fluoropose::canonical::CanonicalSpec;
use fluoropose::library::ViewGrid;

use crate::options::{Pair, Range};

/// Where the object is expected when nothing says so: this part of the way from the focus to
/// the detector, as in a usual knee study.
const USUAL_DEPTH: f64 = 0.9;
/// The same where the calibration does not tell the detector's distance, mm.
const USUAL_DISTANCE_MM: f64 = 1000.0;

/// Which views a library holds.
#[derive(clap::Args, Clone, Copy, Debug)]
pub struct ViewOptions {
    /// Rotations about x and y of the nominal view, degrees: the ranges below are about it
    #[arg(
        long,
        value_name = "X,Y",
        default_value = "0,0",
        allow_hyphen_values = true
    )]
    pub nominal: Pair,
    /// Rotations about x, degrees, as first:last:step
    #[arg(long, default_value = "-15:15:1", allow_hyphen_values = true)]
    pub x: Range,
    /// Rotations about y, degrees, as first:last:step
    #[arg(long, default_value = "-20:20:1", allow_hyphen_values = true)]
    pub y: Range,
    /// Distance from the focus to the object in the views, mm [default: 0.9 of the principal
    /// distance, or 1000 where the calibration does not tell it]
    #[arg(long, value_name = "MM")]
    pub distance: Option<f64>,
    /// Area of a canonical silhouette, pixels
    #[arg(long, value_name = "PX", default_value_t = 15_000)]
    pub area: u32,
    /// Side of the canonical frame, pixels; a multiple of 32
    #[arg(long, value_name = "PX", default_value_t = 256)]
    pub size: usize,
}

impl Default for ViewOptions {
    fn default() -> Self {
        let grid = ViewGrid::default();
        Self {
            nominal: Pair::default(),
            x: Range(grid.x),
            y: Range(grid.y),
            distance: None,
            area: CanonicalSpec::default().area(),
            size: CanonicalSpec::default().size(),
        }
    }
}

impl ViewOptions {
    /// The grid about the nominal view.
    pub fn grid(&self) -> ViewGrid {
        let Pair([x, y]) = self.nominal;
        ViewGrid {
            x: self.x.0.shifted(x),
            y: self.y.0.shifted(y),
        }
    }

    /// The distance asked for, or the usual one for a calibration, mm.
    pub fn distance_for(&self, calibration: &Calibration) -> f64 {
        let usual = calibration
            .principal_distance()
            .map_or(USUAL_DISTANCE_MM, |distance| USUAL_DEPTH * distance);
        self.distance.unwrap_or(usual)
    }
}
