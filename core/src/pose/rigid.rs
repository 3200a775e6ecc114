//! Rigid poses and their forms: matrix, Z-X-Y Euler angles, quaternion.

use crate::math::{
    IDENTITY, Matrix3, Vector3, add, apply, asin, atan2, degrees, determinant, dot, multiply,
    radians, scale, sin_cos, sqrt, transpose,
};

/// `X_camera = rotation * X_model + translation`; mm.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Pose {
    /// `camera_from_model`: a rotation matrix, row by row.
    pub rotation: Matrix3,
    /// The model's origin in camera coordinates, mm.
    pub translation: Vector3,
}

/// A pose as the field writes it (`JT_EULER_312`): `R = Rz(z_rot) * Rx(x_rot) * Ry(y_rot)`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct EulerPose {
    /// Translation to the right, mm.
    pub x_mm: f64,
    /// Translation upwards, mm.
    pub y_mm: f64,
    /// Translation along the view, mm; negative in front of the camera.
    pub z_mm: f64,
    /// Rotation in the image plane, degrees, -180 to 180.
    pub z_rot_deg: f64,
    /// Out-of-plane rotation about x, degrees, -90 to 90.
    pub x_rot_deg: f64,
    /// Out-of-plane rotation about y, degrees, -180 to 180.
    pub y_rot_deg: f64,
}

/// A unit quaternion, scalar first: a rotation by `2 acos(w)` about `(x, y, z)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quaternion {
    /// Scalar part.
    pub w: f64,
    /// Vector part.
    pub x: f64,
    /// Vector part.
    pub y: f64,
    /// Vector part.
    pub z: f64,
}

/// `Rz(z) * Rx(x) * Ry(y)`, angles in degrees.
#[must_use]
pub(crate) fn rotation_zxy(z_deg: f64, x_deg: f64, y_deg: f64) -> Matrix3 {
    let (sz, cz) = sin_cos(radians(z_deg));
    let (sx, cx) = sin_cos(radians(x_deg));
    let (sy, cy) = sin_cos(radians(y_deg));
    [
        [cz * cy - sz * sx * sy, -sz * cx, cz * sy + sz * sx * cy],
        [sz * cy + cz * sx * sy, cz * cx, sz * sy - cz * sx * cy],
        [-cx * sy, sx, cx * cy],
    ]
}

/// Angle in degrees of the rotation that leads from `a` to `b`: the geodesic distance.
///
/// From the Frobenius norm, `|a - b| = 2 sqrt(2) sin(angle / 2)`, which keeps its digits where
/// the arc cosine of the trace loses them.
#[must_use]
pub fn geodesic_deg(a: &Matrix3, b: &Matrix3) -> f64 {
    let squares: f64 = a
        .iter()
        .flatten()
        .zip(b.iter().flatten())
        .map(|(a, b)| (a - b) * (a - b))
        .sum();
    degrees(2.0 * asin(sqrt(squares / 8.0)))
}

/// The rotation that turns the optical axis (0, 0, -1) to the direction of `point` (camera
/// coordinates) about an axis perpendicular to both: where a camera would have to turn to look
/// at the point. The identity for a point on the axis or at the focus; half a turn about x for one behind it, from
/// which all axes lead there.
#[must_use]
pub fn view_rotation(point: &Vector3) -> Matrix3 {
    let length = crate::math::norm(point);
    if length == 0.0 {
        return IDENTITY;
    }
    // Rodrigues' formula for two unit vectors a, b: R = 1 + [v] + [v]^2 / (1 + a.b), v = a x b.
    let b = scale(point, 1.0 / length);
    let (vx, vy) = (b[1], -b[0]);
    let cosine = -b[2];
    if cosine < 0.0 {
        return turned_back(vx, vy, cosine);
    }
    let k = 1.0 / (1.0 + cosine);
    [
        [1.0 - vy * vy * k, vx * vy * k, vy],
        [vx * vy * k, 1.0 - vx * vx * k, -vx],
        [-vy, vx, cosine],
    ]
}

/// The same for a point behind, where `1 + a.b` is lost in rounding: by the axis itself.
fn turned_back(vx: f64, vy: f64, cosine: f64) -> Matrix3 {
    // Over the larger one first: squares of the smallest numbers are 0.
    let larger = vx.abs().max(vy.abs());
    let [x, y] = if larger > 0.0 {
        let (x, y) = (vx / larger, vy / larger);
        [x, y].map(|component| component / sqrt(x * x + y * y))
    } else {
        [1.0, 0.0]
    };
    let k = 1.0 - cosine;
    [
        [1.0 - y * y * k, x * y * k, vy],
        [x * y * k, 1.0 - x * x * k, -vx],
        [-vy, vx, cosine],
    ]
}

impl Pose {
    /// No rotation, no translation.
    pub const IDENTITY: Self = Self {
        rotation: IDENTITY,
        translation: [0.0; 3],
    };

    /// A point of the model in camera coordinates.
    #[must_use]
    pub fn transform(&self, point: &Vector3) -> Vector3 {
        add(&apply(&self.rotation, point), &self.translation)
    }

    /// The opposite transform.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let rotation = transpose(&self.rotation);
        let translation = scale(&apply(&rotation, &self.translation), -1.0);
        Self {
            rotation,
            translation,
        }
    }

    /// `self * inner`: what applies `inner` first.
    #[must_use]
    pub fn compose(&self, inner: &Self) -> Self {
        Self {
            rotation: multiply(&self.rotation, &inner.rotation),
            translation: self.transform(&inner.translation),
        }
    }

    /// Whether the rotation is orthonormal and right-handed within `tolerance`, and all finite.
    #[must_use]
    pub fn is_rigid(&self, tolerance: f64) -> bool {
        let [x, y, z] = &self.rotation;
        let is = |a, b, product: f64| (dot(a, b) - product).abs() <= tolerance;
        let unit = is(x, x, 1.0) && is(y, y, 1.0) && is(z, z, 1.0);
        unit && is(x, y, 0.0)
            && is(y, z, 0.0)
            && is(z, x, 0.0)
            && determinant(&self.rotation) > 0.0
            && self.translation.iter().all(|value| value.is_finite())
    }

    /// The same pose in the computer-vision camera frame (along +z, y down), or back: the
    /// change of axes `diag(1, -1, -1)` is its own inverse.
    #[must_use]
    pub fn flip_camera_axes(&self) -> Self {
        let flip = |row: usize| if row == 0 { 1.0 } else { -1.0 };
        let mut flipped = *self;
        for (row, values) in flipped.rotation.iter_mut().enumerate() {
            *values = scale(values, flip(row));
        }
        for (row, value) in flipped.translation.iter_mut().enumerate() {
            *value *= flip(row);
        }
        flipped
    }
}

impl From<[f64; 6]> for EulerPose {
    /// In the order of a pose file: x, y, z (mm), then z, x and y rotation (degrees).
    fn from([x_mm, y_mm, z_mm, z_rot_deg, x_rot_deg, y_rot_deg]: [f64; 6]) -> Self {
        Self {
            x_mm,
            y_mm,
            z_mm,
            z_rot_deg,
            x_rot_deg,
            y_rot_deg,
        }
    }
}

impl From<EulerPose> for [f64; 6] {
    /// In the order of a pose file.
    fn from(pose: EulerPose) -> Self {
        [
            pose.x_mm,
            pose.y_mm,
            pose.z_mm,
            pose.z_rot_deg,
            pose.x_rot_deg,
            pose.y_rot_deg,
        ]
    }
}

impl From<EulerPose> for Pose {
    fn from(euler: EulerPose) -> Self {
        Self {
            rotation: rotation_zxy(euler.z_rot_deg, euler.x_rot_deg, euler.y_rot_deg),
            translation: [euler.x_mm, euler.y_mm, euler.z_mm],
        }
    }
}

impl From<Pose> for EulerPose {
    /// At `x_rot` = 90 or -90 degrees z and y turn about one line; the whole turn is then given
    /// to z.
    fn from(pose: Pose) -> Self {
        let r = &pose.rotation;
        let [x_mm, y_mm, z_mm] = pose.translation;
        let cos_x = sqrt(r[2][0] * r[2][0] + r[2][2] * r[2][2]);
        let x_rot = atan2(r[2][1], cos_x);
        let (z_rot, y_rot) = if cos_x > 1e-9 {
            (atan2(-r[0][1], r[1][1]), atan2(-r[2][0], r[2][2]))
        } else {
            (atan2(r[1][0], r[0][0]), 0.0)
        };
        Self {
            x_mm,
            y_mm,
            z_mm,
            z_rot_deg: degrees(z_rot),
            x_rot_deg: degrees(x_rot),
            y_rot_deg: degrees(y_rot),
        }
    }
}

impl From<Quaternion> for Matrix3 {
    fn from(Quaternion { w, x, y, z }: Quaternion) -> Self {
        [
            [
                1.0 - 2.0 * (y * y + z * z),
                2.0 * (x * y - w * z),
                2.0 * (x * z + w * y),
            ],
            [
                2.0 * (x * y + w * z),
                1.0 - 2.0 * (x * x + z * z),
                2.0 * (y * z - w * x),
            ],
            [
                2.0 * (x * z - w * y),
                2.0 * (y * z + w * x),
                1.0 - 2.0 * (x * x + y * y),
            ],
        ]
    }
}

impl From<Matrix3> for Quaternion {
    /// Shepperd's method (J. Guidance and Control 1, 1978): the largest of the four components
    /// is the divisor, so none is lost; the scalar part is not negative.
    fn from(r: Matrix3) -> Self {
        let (a, b, c) = (r[0][0], r[1][1], r[2][2]);
        let squares = [
            1.0 + a + b + c,
            1.0 + a - b - c,
            1.0 - a + b - c,
            1.0 - a - b + c,
        ];
        let largest = (1..4).fold(
            0,
            |best, k| if squares[k] > squares[best] { k } else { best },
        );
        let root = sqrt(squares[largest]);
        let k = 0.5 / root;
        let (d0, d1, d2) = (r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]);
        let (s0, s1, s2) = (r[1][0] + r[0][1], r[0][2] + r[2][0], r[2][1] + r[1][2]);
        let half = 0.5 * root;
        let [w, x, y, z] = match largest {
            0 => [half, d0 * k, d1 * k, d2 * k],
            1 => [d0 * k, half, s0 * k, s1 * k],
            2 => [d1 * k, s0 * k, half, s2 * k],
            _ => [d2 * k, s1 * k, s2 * k, half],
        };
        let sign = if w < 0.0 { -1.0 } else { 1.0 };
        Self {
            w: sign * w,
            x: sign * x,
            y: sign * y,
            z: sign * z,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn axis_rotation(axis: usize, deg: f64) -> Matrix3 {
        // Oracle by Rodrigues' formula through a quaternion of half the angle.
        let (s, c) = (libm::sin(radians(deg) / 2.0), libm::cos(radians(deg) / 2.0));
        let v = |k: usize| if k == axis { s } else { 0.0 };
        Matrix3::from(Quaternion {
            w: c,
            x: v(0),
            y: v(1),
            z: v(2),
        })
    }

    fn close(a: &Matrix3, b: &Matrix3) -> bool {
        a.iter()
            .flatten()
            .zip(b.iter().flatten())
            .all(|(a, b)| (a - b).abs() < 1e-12)
    }

    properties! {
        #[test]
        fn the_closed_form_is_the_product_of_three_turns(
            z in -180.0..180.0f64, x in -90.0..90.0f64, y in -180.0..180.0f64
        ) {
            let product = multiply(
                &multiply(&axis_rotation(2, z), &axis_rotation(0, x)),
                &axis_rotation(1, y),
            );
            prop_assert!(close(&product, &rotation_zxy(z, x, y)));
        }

        #[test]
        fn angles_survive_the_way_through_a_matrix_and_a_quaternion(
            z in -179.9..179.9f64, x in -89.9..89.9f64, y in -179.9..179.9f64
        ) {
            let euler = EulerPose { x_mm: 1.0, y_mm: 2.0, z_mm: -3.0,
                z_rot_deg: z, x_rot_deg: x, y_rot_deg: y };
            let pose = Pose::from(euler);
            let quaternion = Quaternion::from(pose.rotation);
            prop_assert!(close(&Matrix3::from(quaternion), &pose.rotation));
            prop_assert!(quaternion.w >= 0.0, "{quaternion:?}");
            let back = EulerPose::from(pose);
            prop_assert!((back.z_rot_deg - z).abs() < 1e-9);
            prop_assert!((back.x_rot_deg - x).abs() < 1e-9);
            prop_assert!((back.y_rot_deg - y).abs() < 1e-9);
        }

        #[test]
        fn the_view_rotation_looks_at_its_point_without_rolling(
            x in -500.0..500.0f64, y in -500.0..500.0f64, z in -2000.0..2000.0f64
        ) {
            let rotation = view_rotation(&[x, y, z]);
            let ray = apply(&rotation, &[0.0, 0.0, -1.0]);
            let length = crate::math::norm(&[x, y, z]);
            prop_assert!((ray[0] - x / length).abs() < 1e-12);
            prop_assert!((ray[1] - y / length).abs() < 1e-12);
            prop_assert!((ray[2] - z / length).abs() < 1e-12);
            let pose = Pose { rotation, translation: [0.0; 3] };
            prop_assert!(pose.is_rigid(1e-12));
            // No roll: the axis of the turn has no component along the view.
            prop_assert!((rotation[0][1] - rotation[1][0]).abs() < 1e-12);
        }

        #[test]
        fn inverse_and_compose_undo_each_other(
            z in -180.0..180.0f64, x in -90.0..90.0f64, t in -1000.0..1000.0f64
        ) {
            let pose = Pose { rotation: rotation_zxy(z, x, 20.0), translation: [t, 2.0, -t] };
            let one = pose.compose(&pose.inverse());
            prop_assert!(close(&one.rotation, &IDENTITY));
            prop_assert!(one.translation.iter().all(|v| v.abs() < 1e-9));
        }
    }

    #[test]
    fn what_is_behind_is_looked_at_too() {
        let aside = [0.0, 1.0, 1e-3, 1e-8, 1e-9, 1e-160, 5e-324];
        for (x, y) in aside.iter().flat_map(|&x| aside.map(|y| (x, -y))) {
            let rotation = view_rotation(&[x, y, 1.0]);
            let pose = Pose {
                rotation,
                translation: [0.0; 3],
            };
            assert!(pose.is_rigid(1e-12), "{x} {y}: {rotation:?}");
            let ray = apply(&rotation, &[0.0, 0.0, -1.0]);
            let length = crate::math::norm(&[x, y, 1.0]);
            for (got, wanted) in ray.iter().zip([x, y, 1.0]) {
                assert!((got - wanted / length).abs() < 1e-12, "{x} {y}: {ray:?}");
            }
        }
    }

    #[test]
    fn the_geodesic_distance_is_the_angle_between() {
        for deg in [0.0, 1e-7, 0.01, 30.0, 120.0, 179.0] {
            let a = rotation_zxy(10.0, 20.0, 30.0);
            let b = multiply(&a, &axis_rotation(1, deg));
            assert!((geodesic_deg(&a, &b) - deg).abs() < 1e-6 * (1.0 + deg));
        }
    }

    #[test]
    fn at_gimbal_lock_the_matrix_is_kept() {
        let pose = Pose {
            rotation: rotation_zxy(25.0, 90.0, 40.0),
            translation: [0.0; 3],
        };
        let again = Pose::from(EulerPose::from(pose));
        assert!(geodesic_deg(&pose.rotation, &again.rotation) < 1e-6);
    }

    #[test]
    fn the_other_camera_convention_sees_the_same_picture() {
        // Computer vision: column = fx X / Z + cx, row = fy Y / Z + cy.
        let pose = Pose::from(EulerPose {
            x_mm: 12.0,
            y_mm: -7.0,
            z_mm: -900.0,
            z_rot_deg: 30.0,
            x_rot_deg: 5.0,
            y_rot_deg: -8.0,
        });
        let camera = crate::camera::Camera::new(100, 100, [3000.0, 3100.0], [40.0, 60.0]);
        let ours = camera
            .expect("valid")
            .project(&pose.transform(&[3.0, 4.0, 5.0]))
            .expect("in front");
        let [x, y, z] = pose.flip_camera_axes().transform(&[3.0, 4.0, 5.0]);
        assert!((3000.0 * x / z + 40.0 - ours.column).abs() < 1e-9);
        assert!((3100.0 * y / z + 60.0 - ours.row).abs() < 1e-9);
    }
}
