//! From a matched view to a pose: the equations of Walker et al. 1996, then the view direction.
//!
//! Walker et al. 1996, section 2.3, with the correction for an object off the optical axis.

use crate::camera::Camera;
use crate::canonical::CanonicalForm;
use crate::library::LibraryInfo;
use crate::locate::interpolate::FineView;
use crate::math::{apply, degrees, multiply, norm, sin_cos, sqrt};
use crate::pose::{Pose, rotation_zxy, view_rotation};

/// The pose of the model from the canonical form of its silhouette and the view that matches.
///
/// 1. `z_rot` is the difference of the two axis angles, plus 180 degrees for a reversed match.
/// 2. Depth is the library's distance times the ratio of the silhouettes' linear sizes, each
///    divided by its own focal length. A silhouette seen at the angle `phi` off the axis is
///    stretched by the flat detector: a solid angle covers `1 / cos^3 phi` times the area, and
///    the depth is `cos phi` times the distance along the ray, together `1 / sqrt(cos phi)`.
/// 3. The library's vector from the reference point to the centroid, rotated and scaled, leads
///    from the silhouette's centroid back to the image of the reference point, and similar
///    triangles from there to x and y.
/// 4. The view shows the object from the direction of the ray to it, so its rotation in camera
///    coordinates is the turn from the axis to that ray times the view's.
#[must_use]
pub fn pose_from_view(
    camera: &Camera,
    info: &LibraryInfo,
    form: &CanonicalForm,
    view: &FineView,
) -> Pose {
    let half_turn = if view.reversed {
        core::f64::consts::PI
    } else {
        0.0
    };
    let z_rot = form.angle - view.record.angle + half_turn;
    let [fx, _] = camera.focal();
    let (sin, cos) = sin_cos(z_rot);
    let [a, b] = view
        .record
        .offset
        .map(|v| v * view.record.scale / form.scale);
    let [cx, cy] = camera.principal_point();
    let ray = [
        (form.centroid.column - cx - (cos * a - sin * b)) / fx,
        (-(form.centroid.row - cy) * form.aspect - (sin * a + cos * b)) / fx,
        -1.0,
    ];
    let cos_phi = 1.0 / norm(&ray);
    let size_ratio = form.scale * fx / (view.record.scale * info.focal);
    let depth = info.distance * size_ratio / sqrt(cos_phi);
    let reference = ray.map(|component| component * depth);
    let rotated = rotation_zxy(degrees(z_rot), view.record.x_deg, view.record.y_deg);
    let rotation = multiply(&view_rotation(&ray), &rotated);
    let from_origin = apply(&rotation, &info.reference);
    Pose {
        rotation,
        translation: core::array::from_fn(|k| reference[k] - from_origin[k]),
    }
}
