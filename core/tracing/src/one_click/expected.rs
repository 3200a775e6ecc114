//! The size that a component has in a frame, from its library and the camera.

use fluoropose::camera::Camera;
use fluoropose::finder::Component;
use fluoropose::math::sqrt;

/// Nearest and farthest distance of the object from the focus, as multiples of the library's. A camera matrix tells no distance: the
/// library is then one for a metre, and knees are filmed from 0.7 to 1.45 m.
pub(crate) const DISTANCES: [f64; 2] = [0.7, 1.45];
/// The same one level farther: X-ray tubes stand two metres away at most.
const FARTHER: [f64; 2] = [1.45, 2.3];
/// Least and greatest area of a region, as multiples of a silhouette's area: what touches the implant may be part of it.
const REGION: [f64; 2] = [0.4, 4.0];
/// The same of a region whose border may be the implant's: what is larger is a limb or the field, whose borders are sharper.
const IMPLANT: f64 = 1.5;

/// Sizes in pixels and distances in mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Expected {
    /// Least and greatest area of a region that is tried, square pixels.
    pub(super) areas: [f64; 2],
    /// Greatest area of a region that is little more than the implant, square pixels.
    pub(super) implant: f64,
    /// Square root of the area of a usual silhouette, pixels.
    pub(super) size: f64,
    /// No two points of a silhouette are farther apart, pixels.
    pub(super) extent: f64,
    /// Nearest and farthest distance of the model's centre from the focus along the axis, mm.
    pub(super) depths: [f64; 2],
}

impl Expected {
    pub(super) fn of(component: &Component<'_>, camera: &Camera) -> Self {
        Self::between(DISTANCES, component, camera)
    }

    /// Farther away than [`Self::of`] goes.
    pub(super) fn farther(component: &Component<'_>, camera: &Camera) -> Self {
        Self::between(FARTHER, component, camera)
    }

    fn between(distances: [f64; 2], component: &Component<'_>, camera: &Camera) -> Self {
        let info = component.library.info();
        let [fx, fy] = camera.focal();
        let unit = fx * fy / (info.focal * info.focal);
        let (mut least, mut most) = (f64::INFINITY, 0.0f64);
        for view in 0..component.library.views() {
            let area = f64::from(component.library.record(view).area) * unit;
            (least, most) = (least.min(area), most.max(area));
        }
        let [near, far] = distances;
        let depths = distances.map(|multiple| multiple * info.distance);
        Self {
            areas: [
                REGION[0] * least / (far * far),
                REGION[1] * most / (near * near),
            ],
            implant: IMPLANT * most / (near * near),
            size: sqrt((least + most) / 2.0),
            extent: 2.0 * component.model.bounds().radius * fx.max(fy) / depths[0],
            depths,
        }
    }

    /// Without a component: anything from a speck to half of the frame.
    pub(super) fn anything(camera: &Camera) -> Self {
        let pixels = (camera.width() * camera.height()) as f64;
        Self {
            areas: [pixels / 4096.0, pixels / 2.0],
            implant: pixels / 2.0,
            size: sqrt(pixels) / 10.0,
            extent: sqrt(pixels),
            depths: DISTANCES,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_a_component_anything_to_half_a_frame_is_expected() {
        let camera = Camera::new(640, 400, [900.0; 2], [320.0, 200.0]).expect("valid");
        let Expected {
            areas,
            implant,
            size,
            extent,
            ..
        } = Expected::anything(&camera);
        assert_eq!((areas, implant), ([62.5, 128_000.0], 128_000.0));
        // Of a square of as many pixels.
        assert!((extent * extent - 256_000.0).abs() < 1e-6 && (10.0 * size - extent).abs() < 1e-9);
    }
}
