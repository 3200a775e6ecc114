//! Which views a library holds.

use fluoropose::camera::calibration::Calibration;
use fluoropose::canonical::{CanonicalError, CanonicalSpec};
use fluoropose::library::ViewGrid;

use crate::options::{Pair, Range};

/// Which views a library holds.
#[derive(clap::Args, Clone, Copy, Debug, Default)]
pub struct ViewOptions {
    /// Rotations about x and y of the nominal view, degrees: the ranges below are about it
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true)]
    pub nominal: Option<Pair>,
    /// Rotations about x, degrees, as first:last:step [default: all directions; -15:15:1 where y or the nominal view is
    /// given, and in `synthetic`]
    #[arg(long, allow_hyphen_values = true)]
    pub x: Option<Range>,
    /// Rotations about y, degrees, as first:last:step [default: all directions; -20:20:1 where x or the nominal view is
    /// given, and in `synthetic`]
    #[arg(long, allow_hyphen_values = true)]
    pub y: Option<Range>,
    /// Distance from the focus to the object in the views, mm [default: 0.9 of the principal
    /// distance, or 1000 where the calibration does not tell it]
    #[arg(long, value_name = "MM")]
    pub distance: Option<f64>,
    /// Area of a canonical silhouette, pixels [default: 938 for all directions, else 15000]
    #[arg(long, value_name = "PX")]
    pub area: Option<u32>,
    /// Side of the canonical frame, pixels; a multiple of 32 [default: 64 for all directions, else 256]
    #[arg(long, value_name = "PX")]
    pub size: Option<usize>,
}

impl ViewOptions {
    /// The window of views of Walker et al. 1996 about a nominal view, degrees about x and y.
    pub fn window(nominal: [f64; 2]) -> Self {
        Self {
            nominal: Some(Pair(nominal)),
            ..Self::default()
        }
    }

    /// The window of Walker et al. 1996 where nothing else was asked for.
    pub fn or_window(self) -> Self {
        match self.is_all_around() {
            true => Self {
                nominal: Some(Pair::default()),
                ..self
            },
            false => self,
        }
    }

    fn is_all_around(&self) -> bool {
        self.nominal.is_none() && self.x.is_none() && self.y.is_none()
    }

    /// The grid of views: all directions, or a window about the nominal view.
    pub fn grid(&self) -> ViewGrid {
        if self.is_all_around() {
            return ViewGrid::everywhere();
        }
        let Pair([x, y]) = self.nominal.unwrap_or_default();
        let window = ViewGrid::default();
        ViewGrid {
            x: self.x.map_or(window.x, |range| range.0).shifted(x),
            y: self.y.map_or(window.y, |range| range.0).shifted(y),
        }
    }

    /// The canonical frame of the views.
    ///
    /// # Errors
    /// Those of [`CanonicalSpec::new`].
    pub fn canonical(&self) -> Result<CanonicalSpec, CanonicalError> {
        let usual = match self.is_all_around() {
            true => CanonicalSpec::COARSE,
            false => CanonicalSpec::USUAL,
        };
        let (size, area) = (usual.size(), usual.area());
        CanonicalSpec::new(self.size.unwrap_or(size), self.area.unwrap_or(area))
    }

    /// The distance asked for, or the usual one for a calibration, mm.
    pub fn distance_for(&self, calibration: &Calibration) -> f64 {
        self.distance
            .unwrap_or_else(|| calibration.expected_distance())
    }
}
