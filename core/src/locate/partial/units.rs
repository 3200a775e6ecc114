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
