//! What size a component has in a frame, from its library and the camera.

use super::Part;
use fluoropose::camera::Camera;

/// Distances of the object from the focus, in parts of the library's: as
/// [`fluoropose::locate::partial`] takes them.
const DISTANCES: [f64; 2] = [0.75, 1.35];
/// Part of a silhouette that a region must hold at least, and how many times it may be as large:
/// what touches it comes with it.
const REGION: [f64; 2] = [0.4, 4.0];

/// Sizes in pixels and distances in mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Expected {
    /// Least and greatest area of a region worth a look, square pixels.
    pub(super) areas: [f64; 2],
    /// Root of a usual silhouette's area, pixels.
    pub(super) size: f64,
    /// No two points of a silhouette are farther apart, pixels.
    pub(super) extent: f64,
    /// Nearest and farthest distance of the part's middle from the focus along the axis, mm.
    pub(super) depths: [f64; 2],
}

impl Expected {
    pub(super) fn of(part: &Part<'_>, camera: &Camera) -> Self {
        let info = part.library.info();
        let [fx, fy] = camera.focal();
        let unit = fx * fy / (info.focal * info.focal);
        let (mut least, mut most) = (f64::INFINITY, 0.0f64);
        for view in 0..part.library.views() {
            let area = f64::from(part.library.record(view).area) * unit;
            (least, most) = (least.min(area), most.max(area));
        }
        let [near, far] = DISTANCES;
        let depths = DISTANCES.map(|share| share * info.distance);
        Self {
            areas: [
                REGION[0] * least / (far * far),
                REGION[1] * most / (near * near),
            ],
            size: fluoropose::math::sqrt((least + most) / 2.0),
            extent: 2.0 * part.model.bounds().radius * fx.max(fy) / depths[0],
            depths,
        }
    }

    /// Without a component: anything from a speck to half of a frame.
    pub(super) fn anything(camera: &Camera) -> Self {
        let pixels = (camera.width() * camera.height()) as f64;
        Self {
            areas: [pixels / 4096.0, pixels / 2.0],
            size: fluoropose::math::sqrt(pixels) / 10.0,
            extent: fluoropose::math::sqrt(pixels),
            depths: DISTANCES,
        }
    }
}
