//! Images of vertices by whole numbers, for processors without doubles: where it is certain that those of doubles are rounded to the same
//! 1/4096 pixel, which they are but for a few in a hundred. The others are left to doubles, so that every target draws the same pixels.

use crate::camera::Camera;
use crate::image::scan::{FixedPoint, ONE};
use crate::mesh::Bounds;
use crate::pose::Pose;

/// Whether the processor reckons doubles by functions of hundreds of instructions each.
pub(super) const WORTH_IT: bool = cfg!(any(target_arch = "arm", target_arch = "riscv32"));

/// Binary places of rotations, and those of places in the camera's axes beyond those of vertices.
const TURN: u32 = 30;
const FINER: u32 = 8;
/// Binary places of an image before it is rounded, and one of it.
const REST: u32 = 12;
const UNIT: i64 = 1 << REST;
/// Most binary places of vertices, and bits of their whole numbers.
const VERTEX: i32 = 24;
const BITS: i32 = 30;
/// Distances beyond this many mm are left to doubles.
const FAR: f64 = 1_048_576.0;
/// Off the axis at most, as a tangent.
const ASIDE: f64 = 0.5;

/// A camera and a pose in whole numbers.
pub(super) struct WholeImages {
    /// What makes whole numbers of a vertex: `2^s`.
    scale: f32,
    rotation: [[i32; 3]; 3],
    /// In `2^-(s + FINER)` mm, as is the least distance.
    translation: [i64; 3],
    nearest: i64,
    /// Bits by which places aside may be finer than distances.
    aside: u32,
    /// Focal lengths, and how far products with them are to be shifted.
    focal: [(i32, u32); 2],
    principal: [i64; 2],
    /// Nearer to the middle between two roundings it is not certain which is right.
    doubt: i64,
}

impl WholeImages {
    /// `None` where numbers are too large, or so few images certain that it is not worth it.
    pub(super) fn new(camera: &Camera, pose: &Pose, bounds: &Bounds) -> Option<Self> {
        let Bounds { centre, radius } = bounds;
        let middle = pose.transform(centre);
        let (near, far) = (-middle[2] - radius, -middle[2] + radius);
        let largest = centre.iter().fold(0.0, |most: f64, x| most.max(x.abs())) + radius;
        let tangents = [middle[0], middle[1]].map(|x| (x.abs() + radius) / near);
        let tangent = tangents[0].max(tangents[1]);
        let is_possible = near > 0.0
            && far < FAR
            && tangent < ASIDE
            && largest < FAR
            && pose.is_rigid(RIGID)
            && pose.translation.iter().all(|x| x.abs() < FAR);
        if !is_possible {
            return None;
        }
        let places = (BITS - 1 - exponent(largest)).min(VERTEX);
        let aside = (-2 - exponent(tangent)).clamp(0, 8) as u32;
        let fine = power(places + FINER as i32);
        let focal = camera.focal().map(|focal| focal * ONE as f64);
        let place_mm = 4.0 / power(places);
        let longest = focal[0].max(focal[1]);
        // Of vertices and rotations; of what is cut off two quotients; of distance, reciprocal and focal length.
        let places_off = (1.0 + tangent) * place_mm / near;
        let cut_off = (2.0 / power(aside as i32) + 8.0 * tangent) / power(31);
        let doubt = UNIT as f64 * longest * (places_off + cut_off) + 4.0;
        if doubt > UNIT as f64 / 8.0 {
            return None;
        }
        Some(Self {
            scale: power(places) as f32,
            rotation: pose
                .rotation
                .map(|row| row.map(|x| (x * power(TURN as i32)) as i32)),
            translation: pose.translation.map(|x| (x * fine) as i64),
            nearest: (near * fine) as i64,
            aside,
            focal: focal.map(|focal| {
                let finer = 30 - exponent(focal);
                let shift = 31 + aside as i32 + finer - REST as i32;
                ((focal * power(finer)) as i32, shift as u32)
            }),
            principal: camera
                .principal_point()
                .map(|x| (x * (ONE * UNIT) as f64) as i64),
            doubt: doubt as i64 + 1,
        })
    }

    /// The image of a vertex, where it is certain.
    pub(super) fn of(&self, vertex: &[f32; 3]) -> Option<FixedPoint> {
        let [x, y, z] = vertex.map(|x| (x * self.scale) as i32);
        let is_small = |x: i32| x.unsigned_abs() < 1 << BITS;
        if !(is_small(x) && is_small(y) && is_small(z)) {
            return None;
        }
        let [to_right, upwards, depth] = [0, 1, 2].map(|k| {
            let [a, b, c] = self.rotation[k];
            let sum = product(a, x)
                .wrapping_add(product(b, y))
                .wrapping_add(product(c, z));
            (sum >> (TURN - FINER)) + self.translation[k]
        });
        let depth = -depth;
        if depth < self.nearest {
            return None;
        }
        // Distance from its highest bit on, and places aside as many times finer.
        let up = depth.leading_zeros();
        let reciprocal = reciprocal((depth << up >> 32) as u32);
        let from_axis = |place: i64, (focal, shift): (i32, u32)| {
            let limit = depth.unsigned_abs() >> (self.aside + 1);
            if place.unsigned_abs() > limit {
                return None;
            }
            let place = (place << (up + self.aside) >> 32) as i32;
            let ratio = (i64::from(place) * i64::from(reciprocal)) >> 31;
            Some(product(focal, ratio as i32) >> shift)
        };
        let column = self.principal[0] + from_axis(to_right, self.focal[0])?;
        let row = self.principal[1] - from_axis(upwards, self.focal[1])?;
        Some(FixedPoint::of_units(
            self.rounded(column)?,
            self.rounded(row)?,
        ))
    }

    /// The nearest whole number of units.
    fn rounded(&self, value: i64) -> Option<i32> {
        let value = value + UNIT / 2;
        let rest = value & (UNIT - 1);
        let is_certain = rest > self.doubt && rest < UNIT - self.doubt;
        let units = value >> REST;
        (is_certain && units.unsigned_abs() < FixedPoint::BEYOND).then_some(units as i32)
    }
}

/// Poses are rigid but for this.
const RIGID: f64 = 1e-9;

#[inline(always)]
fn product(a: i32, b: i32) -> i64 {
    i64::from(a) * i64::from(b)
}

/// `2^62 / x` to five parts in `2^31`, of a number whose highest bit is set: by division of a half of its bits and one step of
/// Newton's.
fn reciprocal(x: u32) -> u32 {
    let rough = u32::MAX.checked_div(x >> 16).unwrap_or(0) << 14;
    let product = (u64::from(x) * u64::from(rough)) >> 31;
    let rest = (1u64 << 32).wrapping_sub(product);
    ((u64::from(rough) * rest) >> 31) as u32
}

/// The whole number `e` for which `2^e <= x < 2^(e + 1)`, of a number that is neither below the least normal one nor infinite.
fn exponent(x: f64) -> i32 {
    (x.to_bits() >> 52 & 0x7ff) as i32 - 1023
}

/// `2^e` of a small whole number.
fn power(e: i32) -> f64 {
    f64::from_bits(((e + 1023) as u64) << 52)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose::EulerPose;
    use crate::render::project::image_of;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]
        #[test]
        fn an_image_is_that_of_doubles_or_none(
            vertex in proptest::array::uniform3(-1.0..1.0f32), radius in 0.0..9.0f64,
            angles in proptest::array::uniform3(-180.0..180.0f64),
            place in proptest::array::uniform3(-0.3..0.3f64), distance in 0.1..13.0f64,
            focal in 1.0..13.0f64, principal in proptest::array::uniform2(-900.0..900.0f64),
        ) {
            let radius = libm::exp(radius - 2.0);
            let [z_rot_deg, x_rot_deg, y_rot_deg] = angles;
            let z_mm = -radius * (1.0 + libm::exp(distance - 3.0));
            let pose = Pose::from(EulerPose {
                x_mm: place[0] * z_mm, y_mm: place[1] * z_mm, z_mm, z_rot_deg, x_rot_deg, y_rot_deg
            });
            let focal = [libm::exp(focal), 1.1 * libm::exp(focal)];
            let camera = Camera::new(512, 512, focal, principal).expect("valid");
            let vertex = vertex.map(|x| x * radius as f32 * 0.577);
            let bounds = Bounds { centre: [0.0; 3], radius };
            let whole = WholeImages::new(&camera, &pose, &bounds);
            if let Some(image) = whole.and_then(|whole| whole.of(&vertex)) {
                prop_assert_eq!((image, true), image_of(&camera, &pose, &vertex));
            }
        }

        #[test]
        fn a_reciprocal_is_within_five_parts(x in 1u32 << 31..=u32::MAX) {
            let exact = 2f64.powi(62) / f64::from(x);
            prop_assert!((f64::from(reciprocal(x)) / exact - 1.0).abs() < 5.0 / 2f64.powi(31));
        }
    }

    #[test]
    fn of_a_knee_few_images_are_not_certain() {
        let bounds = Bounds {
            centre: [1.0, -2.0, 3.0],
            radius: 45.0,
        };
        let spread = |k: u32, square: f64, reach: f64| {
            reach * (2.0 * (f64::from(k) * libm::sqrt(square)).fract() - 1.0)
        };
        let (mut certain, mut count) = (0, 0);
        for pose in 1..20 {
            let (pitch, turn) = (0.2 + 0.02 * f64::from(pose), f64::from(pose));
            let offset = [spread(pose, 2.0, 20.0), spread(pose, 3.0, 20.0)];
            let camera = Camera::from_principal_distance(512, 512, 1000.0, pitch, offset);
            let camera = camera.expect("valid");
            let pose = Pose::from(EulerPose {
                x_mm: spread(pose, 2.0, 60.0),
                y_mm: spread(pose, 3.0, 60.0),
                z_mm: -600.0 - 20.0 * turn,
                z_rot_deg: 17.0 * turn,
                x_rot_deg: 3.4 * turn,
                y_rot_deg: -4.3 * turn,
            });
            let whole = WholeImages::new(&camera, &pose, &bounds).expect("possible");
            for k in 0..5000 {
                let vertex = [2.0, 3.0, 5.0].map(|square| spread(k, square, 25.0) as f32);
                let image = whole.of(&vertex);
                if let Some(image) = image {
                    assert_eq!((image, true), image_of(&camera, &pose, &vertex));
                }
                certain += u32::from(image.is_some());
                count += 1;
            }
        }
        assert!(certain > count / 10 * 9, "{certain} of {count}");
    }
}
