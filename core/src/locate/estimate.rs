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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canonical::CanonicalSpec;
    use crate::image::contour::Point;
    use crate::library::{ViewGrid, ViewRecord};
    use crate::math::{Matrix3, Vector3, scale, subtract, transpose};
    use proptest::prelude::*;

    const REFERENCE: Vector3 = [7.0, -3.0, 12.0];

    fn camera(focal: f64, aspect: f64, point: [f64; 2]) -> Camera {
        Camera::new(1000, 1000, [focal, focal / aspect], point).expect("valid")
    }

    fn info() -> LibraryInfo {
        LibraryInfo {
            canonical: CanonicalSpec::default(),
            grid: ViewGrid::default(),
            distance: 1000.0,
            reference: REFERENCE,
            focal: 1500.0,
            camera: camera(3000.0, 1.0, [500.0; 2]),
            model: [0; 32],
        }
    }

    /// Right of the principal point and above it, in widths of a pixel, with the canonical scale and the angle.
    fn form(camera: &Camera, [right, up]: [f64; 2], scale: f64, angle: f64) -> CanonicalForm {
        let [column, row] = camera.principal_point();
        CanonicalForm {
            area_px: 0,
            centroid: Point::new(column + right, row - up / camera.aspect()),
            angle,
            scale,
            aspect: camera.aspect(),
            elongation: 0.0,
            clipped: false,
        }
    }

    fn view(angle: f64, offset: [f64; 2], reversed: bool) -> FineView {
        let record = ViewRecord {
            x_deg: 8.0,
            y_deg: -11.0,
            scale: 0.8,
            angle,
            offset,
            area: 1,
            elongation: 0.0,
        };
        FineView {
            record,
            reversed,
            unmatched: 0,
            at_border: false,
        }
    }

    fn off(a: &Pose, b: &Pose) -> f64 {
        let rotations = a
            .rotation
            .as_flattened()
            .iter()
            .zip(b.rotation.as_flattened());
        let turned = rotations.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let moved = norm(&subtract(&a.translation, &b.translation));
        turned.max(moved / norm(&a.translation))
    }

    fn about_the_axis(turn: f64) -> Matrix3 {
        let (sin, cos) = libm::sincos(turn);
        [[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]]
    }

    properties! {
        /// Similar triangles: where the reference point is seen, how far away it is, and from which side.
        #[test]
        fn the_reference_point_is_seen_where_and_as_the_view_has_it(
            place in proptest::array::uniform2(-900.0..900.0f64), focal in 1000.0..6000.0f64,
            aspect in 0.6..1.6f64, scale in 0.2..3.0f64, angle in -1.6..1.6f64, view_angle in -1.6..1.6f64,
            offset in proptest::array::uniform2(-60.0..60.0f64),
        ) {
            let camera = camera(focal, aspect, [480.0, 530.0]);
            let form = form(&camera, place, scale, angle);
            let pose = pose_from_view(&camera, &info(), &form, &view(view_angle, offset, false));
            prop_assert!(pose.is_rigid(1e-9));
            let reference = pose.transform(&REFERENCE);
            // Canonical pixels, of which the view's are 0.8 of its own: turned with the silhouette, from its centroid back.
            let turn = angle - view_angle;
            let (sin, cos) = libm::sincos(turn);
            let [a, b] = offset.map(|along| 0.8 * along);
            let back = [cos * a - sin * b, sin * a + cos * b].map(|along| along / scale);
            let seen = camera.project(&reference).expect("in front");
            let [column, row] = camera.principal_point();
            prop_assert!((seen.column - (column + place[0] - back[0])).abs() < 1e-6);
            prop_assert!((seen.row - (row - (place[1] - back[1]) / aspect)).abs() < 1e-6);
            // On the axis as far as sizes tell; aside a flat detector stretches what it shows.
            let cosine = -reference[2] / norm(&reference);
            let depth = 1000.0 * (scale * focal) / (0.8 * 1500.0) / sqrt(cosine);
            prop_assert!((-reference[2] / depth - 1.0).abs() < 1e-9);
            // The ray to it meets the model from the side from which the view does.
            let model_from_camera = transpose(&pose.rotation);
            let ray = apply(&model_from_camera, &crate::math::scale(&reference, -1.0 / norm(&reference)));
            let own = apply(&transpose(&rotation_zxy(0.0, 8.0, -11.0)), &[0.0, 0.0, 1.0]);
            prop_assert!(norm(&subtract(&ray, &own)) < 1e-9);
        }

        /// What turns about the axis as seen turns so in space, and half a turn of the view is one of the angle.
        #[test]
        fn a_silhouette_that_turns_about_the_principal_point_turns_the_pose(
            place in proptest::array::uniform2(-500.0..500.0f64), turn in -3.0..3.0f64,
            offset in proptest::array::uniform2(-60.0..60.0f64), scale in 0.2..3.0f64,
        ) {
            let camera = camera(2500.0, 1.0, [480.0, 530.0]);
            let (sin, cos) = libm::sincos(turn);
            let [x, y] = place;
            let turned = [cos * x - sin * y, sin * x + cos * y];
            let pose = |place, angle, reversed| {
                let form = form(&camera, place, scale, angle);
                pose_from_view(&camera, &info(), &form, &view(0.4, offset, reversed))
            };
            let (before, after) = (pose(place, 0.3, false), pose(turned, 0.3 + turn, false));
            let about = about_the_axis(turn);
            let expected = Pose {
                rotation: multiply(&about, &before.rotation),
                translation: apply(&about, &before.translation),
            };
            prop_assert!(off(&after, &expected) < 1e-9);
            let half = pose(place, 0.3 + core::f64::consts::PI, false);
            prop_assert!(off(&half, &pose(place, 0.3, true)) < 1e-9);
        }

        /// A frame sampled as finely again, or a part of one, shows the same.
        #[test]
        fn finer_frames_and_parts_of_frames_give_the_same_pose(
            place in proptest::array::uniform2(-500.0..500.0f64), finer in 1.0..4.0f64,
            offset in proptest::array::uniform2(-60.0..60.0f64), start in proptest::array::uniform2(-300.0..300.0f64),
            aspect in 0.6..1.6f64,
        ) {
            let pose = |focal: f64, point, place: [f64; 2], scale| {
                let camera = camera(focal, aspect, point);
                let form = form(&camera, place, scale, 0.3);
                pose_from_view(&camera, &info(), &form, &view(0.4, offset, false))
            };
            let whole = pose(2500.0, [480.0, 530.0], place, 1.1);
            let part = pose(2500.0, [480.0 - start[0], 530.0 - start[1]], place, 1.1);
            let fine = pose(2500.0 * finer, [480.0, 530.0], scale_two(place, finer), 1.1 / finer);
            prop_assert!(off(&part, &whole) < 1e-9 && off(&fine, &whole) < 1e-9);
        }
    }

    fn scale_two(place: [f64; 2], by: f64) -> [f64; 2] {
        place.map(|along| along * by)
    }

    #[test]
    fn on_the_axis_a_view_is_turned_and_moved_away() {
        let camera = camera(2400.0, 1.0, [480.0, 530.0]);
        // Twice as many canonical pixels for one of its own: half as large, of a focal length 1.6 times as long.
        let form = form(&camera, [0.0; 2], 1.6, 0.9);
        let pose = pose_from_view(&camera, &info(), &form, &view(0.4, [0.0; 2], false));
        let rotation = multiply(&about_the_axis(0.5), &rotation_zxy(0.0, 8.0, -11.0));
        let away = [0.0, 0.0, -1000.0 * 2.0 * 1.6];
        let translation = subtract(&away, &apply(&rotation, &REFERENCE));
        let expected = Pose {
            rotation,
            translation,
        };
        assert!(off(&pose, &expected) < 1e-12);
        let again = scale(&pose.transform(&REFERENCE), 1.0 / 3200.0);
        assert!(norm(&subtract(&again, &[0.0, 0.0, -1.0])) < 1e-12);
    }
}
