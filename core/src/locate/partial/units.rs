//! Lengths and scales of the search, in terms of a library's canonical silhouettes.

use crate::camera::Camera;
use crate::library::Library;
use crate::math::sqrt;

/// The object may be this much nearer than the library's views show it, and this much farther: a
/// quarter and a third, and half a scale of the search more.
pub(super) const NEAREST: f64 = 0.73;
pub(super) const FARTHEST: f64 = 1.38;

/// Lengths that go with the size of the library's canonical silhouettes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Units {
    /// Horizontal focal length of the camera, pixels.
    pub(super) focal: f64,
    /// Canonical pixels between samples of a view.
    pub(super) spacing: f64,
    /// Sides either way over which a view's outline is smoothed.
    pub(super) view_reach: usize,
    /// Pixel widths of a 122nd part of a usual silhouette's side.
    pub(super) pixel: f64,
    /// Distances beyond this say no more, at first and at last; pixel widths.
    pub(super) wide: f64,
    pub(super) narrow: f64,
    /// Hypotheses whose centroids are nearer than this may be one, pixel widths.
    pub(super) apart: f64,
}

/// Area of canonical silhouettes of which the lengths below are pixels.
const UNIT_AREA: f64 = 15_000.0;
/// Between samples of views, and between points of the known outline.
const VIEW_SPACING: f64 = 6.0;
pub(super) const KNOWN_SPACING: f64 = 2.0;
/// Smoothing, either way.
pub(super) const REACH: f64 = 2.5;
/// Shortest piece of outline that is used.
pub(super) const LEAST_PIECE: f64 = 20.0;
/// See [`Units`].
const WIDE: f64 = 12.0;
const NARROW: f64 = 5.0;
const HYPOTHESES_APART: f64 = 15.0;

impl Units {
    pub(super) fn new(library: &Library<'_>, camera: &Camera) -> Self {
        let info = library.info();
        let unit = sqrt(f64::from(info.canonical.area()) / UNIT_AREA);
        let [focal, _] = camera.focal();
        let middle = library.record(library.views() / 2).scale;
        let pixel = unit * focal / (info.focal * middle);
        Self {
            focal,
            spacing: VIEW_SPACING * unit,
            view_reach: (REACH * unit + 0.5) as usize,
            pixel,
            wide: WIDE * pixel,
            narrow: NARROW * pixel,
            apart: HYPOTHESES_APART * pixel,
        }
    }

    /// Pixel widths per canonical pixel of a view seen at the library's distance.
    pub(super) fn nominal(&self, library: &Library<'_>, view: usize) -> f64 {
        self.focal / (library.info().focal * library.record(view).scale)
    }

    /// The least and the greatest scale of any view.
    pub(super) fn scales(&self, library: &Library<'_>) -> (f64, f64) {
        let all = (0..library.views()).map(|view| self.nominal(library, view));
        let (low, high) = all.fold((f64::INFINITY, 0.0f64), |(low, high), scale| {
            (low.min(scale), high.max(scale))
        });
        (low / FARTHEST, high / NEAREST)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canonical::CanonicalSpec;
    use crate::library::fake::plain_library;

    /// By hand: of views of a focal length of 100 pixels, whose scales are 1, 2, 3 and 4.
    #[test]
    fn lengths_go_with_the_size_of_a_view_in_the_frame() {
        // A quarter of the usual area: half as long.
        let spec = CanonicalSpec::new(128, 3750).expect("possible");
        let views = std::vec![std::vec![1; spec.words_needed()]; 4];
        let bytes = plain_library(&views, 2, spec);
        let library = Library::open(&bytes).expect("valid");
        let camera = Camera::new(640, 480, [900.0, 800.0], [320.0, 240.0]).expect("valid");
        let units = Units::new(&library, &camera);
        assert_eq!(
            (units.focal, units.spacing, units.view_reach),
            (900.0, 3.0, 1)
        );
        // Nine pixels of the frame for one of a view's camera; of the view in the middle three canonical ones.
        assert!((units.pixel - 0.5 * 9.0 / 3.0).abs() < 1e-12);
        let lengths = [units.narrow, units.wide, units.apart];
        let expected = [5.0, 12.0, 15.0].map(|length| length * units.pixel);
        assert_eq!(lengths, expected);
        for (view, scale) in [(0, 9.0), (1, 4.5), (2, 3.0), (3, 2.25)] {
            assert!((units.nominal(&library, view) - scale).abs() < 1e-12);
        }
        let (low, high) = units.scales(&library);
        assert!((low - 2.25 / FARTHEST).abs() < 1e-12);
        assert!((high - 9.0 / NEAREST).abs() < 1e-12);
    }
}
