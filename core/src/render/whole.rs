//! Images of vertices by whole numbers, for processors without doubles: where it is certain that those of doubles are rounded to the same
//! 1/4096 pixel, which they are but for a few in a hundred. The others are left to doubles, so that every target draws the same pixels.

use crate::camera::Camera;
use crate::image::scan::{FixedPoint, ONE, WHOLE};
use crate::mesh::Bounds;
use crate::pose::Pose;
use crate::render::reach::Reach;

/// Whether the processor reckons doubles by functions of hundreds of instructions each.
pub(super) const WORTH_IT: bool = cfg!(any(target_arch = "arm", target_arch = "riscv32"));

/// Binary places of an image before it is rounded: those of 64 bits that fall below the lower half, and of the whole number.
const BELOW: u32 = 6;
const REST: u32 = 32 + BELOW;
/// Farthest from the frame's corner that such an image may be, pixels; those beyond are left to doubles.
const BEYOND_PX: f64 = 4096.0;
/// Bits of vertices, and most binary places.
const BITS: i32 = 31;
const VERTEX: i32 = 26;
/// Distances beyond this many mm are left to doubles.
const FAR: f64 = 1_048_576.0;
/// Off the axis at most, as a tangent.
const ASIDE: f64 = 0.5;
/// A reciprocal is within so many parts in `2^31`.
const RECIPROCAL_PARTS: f64 = 5.0;
/// What is left of a range for what rounding adds.
const ROOM: f64 = 1.0 - 1.0 / 1_048_576.0;
/// A distance from which on its reciprocal has 31 bits.
const NEAREST: u32 = (1 << 31) + 16;
/// Of a unit, for what is not counted.
const SPARE: f64 = 1.0 / 2048.0;

/// A camera and a pose in whole numbers of 32 bits. Distances are counted so that all of a model's have their highest bit set; places aside
/// several times as finely.
pub(super) struct WholeImages {
    /// What makes whole numbers of a vertex.
    scale: f32,
    /// Aside, upwards, away: each so that the upper half of a product with a vertex is a place or distance.
    rotation: [[i32; 3]; 3],
    translation: [i32; 3],
    focal: [i32; 2],
    /// The principal point, with half a unit, and half of what is cut off before it is added.
    principal: [i64; 2],
    /// Nearer to the middle between two roundings it is not certain which is right, parts of a unit in 32 bits.
    doubt: u32,
}

/// In how many units a mm is counted.
struct Units {
    /// Of a vertex, as a power of two.
    places: i32,
    /// Along the view.
    away: f64,
    /// By how much finer aside, as a power of two.
    finer: i32,
}

impl Units {
    /// For a model none of whose numbers is larger than `largest`, that lies no farther away than `far` and no farther aside than `tangent` of its
    /// distance. `None` where no units are fine enough.
    fn of(largest: f64, far: f64, tangent: f64) -> Option<Self> {
        let places = (BITS - 1 - exponent(largest)).min(VERTEX);
        let away = ROOM * power(32) / far;
        let turn = away * power(32 - places);
        // Ratios of places aside to distances stay below a half; rotations have 31 bits and a sign.
        let finer = (-2 - exponent(tangent)).min(BITS - 1 - exponent(turn));
        (finer >= 0).then_some(Self {
            places,
            away,
            finer,
        })
    }

    fn aside(&self) -> f64 {
        self.away * power(self.finer)
    }

    /// What a place errs by that is counted so, of its distance: three numbers of a vertex cut off, rotations rounded, a sum cut off and a
    /// translation rounded.
    fn places_off(&self, largest: f64, tangent: f64, near: f64) -> f64 {
        let off = |of_a_mm: f64| {
            1.75 / power(self.places) + (1.5 * largest * power(self.places - 32) + 1.0) / of_a_mm
        };
        (off(self.aside()) + tangent * off(self.away)) / near
    }

    /// The same of quotients, in parts of 2 to the 31st.
    fn quotients_off(&self, tangent: f64, least_focal: f64) -> f64 {
        tangent * (RECIPROCAL_PARTS + power(30) / least_focal) + 0.5 / power(self.finer)
    }
}

impl WholeImages {
    /// `None` where numbers are too large, or so few images certain that it is not worth it.
    pub(super) fn new(
        camera: &Camera,
        pose: &Pose,
        bounds: &Bounds,
        reach: &Reach,
    ) -> Option<Self> {
        let Bounds { centre, radius } = bounds;
        let &Reach {
            near, far, aside, ..
        } = reach;
        let largest = centre.iter().fold(0.0, |most: f64, x| most.max(x.abs())) + radius;
        let tangent = aside[0].max(aside[1]);
        let is_possible = reach.in_front
            && far < FAR
            && far < ROOM * 2.0 * near
            && tangent < ASIDE
            && largest < FAR
            && pose.translation.iter().all(|x| x.abs() < FAR);
        if !is_possible {
            return None;
        }
        let units = Units::of(largest, far, tangent)?;
        let (aside, away) = (units.aside(), units.away);
        let focal = camera
            .focal()
            .map(|focal| focal * ONE as f64 * power(REST as i32 - 31 - units.finer));
        let longest_px = camera.focal()[0].max(camera.focal()[1]);
        let principal = camera.principal_point();
        let farthest = principal[0].abs().max(principal[1].abs()) + longest_px * tangent;
        if focal[0].max(focal[1]) >= power(31) || farthest >= BEYOND_PX {
            return None;
        }
        let least_focal = focal[0].min(focal[1]);
        let off = units.places_off(largest, tangent, near)
            + units.quotients_off(tangent, least_focal) / power(31);
        let doubt = longest_px * ONE as f64 * off + SPARE;
        if doubt > 0.125 {
            return None;
        }
        let [x, y, z] = pose.translation;
        let half = power(REST as i32 - 1);
        let principal = principal.map(|x| x * ONE as f64 * power(REST as i32) + half);
        let counted = [aside, aside, away];
        Some(Self {
            scale: power(units.places) as f32,
            rotation: core::array::from_fn(|k| {
                let of_a_turn = counted[k] * power(32 - units.places);
                pose.rotation[k].map(|x| nearest(x * of_a_turn))
            }),
            // With half of what is cut off of a product.
            translation: [
                nearest(x * aside + 0.5),
                nearest(y * aside + 0.5),
                nearest(-z * away - 0.5),
            ],
            focal: focal.map(nearest),
            principal: [
                (principal[0] + 0.5 * focal[0]) as i64,
                (principal[1] - 0.5 * focal[1]) as i64,
            ],
            doubt: (doubt * power(32)) as u32 + 1,
        })
    }

    /// The image of a vertex, where it is certain.
    #[inline(always)]
    pub(super) fn of(&self, vertex: &[f32; 3]) -> Option<FixedPoint> {
        // One after the other: of `map` some compilers leave a loop.
        let scale = self.scale;
        let vertex = [
            (vertex[0] * scale) as i32,
            (vertex[1] * scale) as i32,
            (vertex[2] * scale) as i32,
        ];
        let [right, up, away] = &self.rotation;
        let distance = self.translation[2].wrapping_sub(turned(away, &vertex)) as u32;
        if distance < NEAREST {
            return None;
        }
        let reciprocal = reciprocal(distance) as i32;
        let right = self.translation[0].wrapping_add(turned(right, &vertex));
        let up = self.translation[1].wrapping_add(turned(up, &vertex));
        let right = (product(right, reciprocal) >> 31) as i32;
        let up = (product(up, reciprocal) >> 31) as i32;
        let column = self.principal[0].wrapping_add(product(right, self.focal[0]));
        let row = self.principal[1].wrapping_sub(product(up, self.focal[1]));
        let is_certain = self.is_certain(column) & self.is_certain(row);
        is_certain.then(|| FixedPoint::of_units((column >> REST) as i32, (row >> REST) as i32))
    }

    /// Whether the whole number before an image is that of doubles, too.
    #[inline(always)]
    fn is_certain(&self, image: i64) -> bool {
        let rest = (image >> BELOW) as u32;
        rest.wrapping_sub(self.doubt) < (2 * self.doubt).wrapping_neg()
    }
}

/// The upper half of a vertex's product with a row of a rotation.
#[inline(always)]
fn turned(row: &[i32; 3], vertex: &[i32; 3]) -> i32 {
    let sum = product(row[0], vertex[0])
        .wrapping_add(product(row[1], vertex[1]))
        .wrapping_add(product(row[2], vertex[2]));
    (sum >> 32) as i32
}

/// The nearest whole number, of which the lower 32 bits are kept.
fn nearest(x: f64) -> i32 {
    (x + WHOLE).to_bits() as i32
}

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

    properties! {
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
            let whole = WholeImages::new(&camera, &pose, &bounds, &Reach::of(&bounds, &pose));
            if let Some(image) = whole.and_then(|whole| whole.of(&vertex)) {
                prop_assert_eq!((image, true), image_of(&camera, &pose, &vertex));
            }
        }

        /// Of a small part far from its own origin, seen through a long focal length, what errs most is how finely places are counted.
        #[test]
        fn an_image_of_what_lies_far_from_its_origin_is_that_of_doubles_or_none(
            vertex in proptest::array::uniform3(-1.0..1.0f64), distance in 3.0..9.0f64,
            radius in 0.005..0.02f64, axis in 0..3usize, away in 0.05..0.1f64,
            angles in proptest::array::uniform3(-180.0..180.0f64),
            place in proptest::array::uniform2(-0.01..0.01f64), focal in 6.0..11.5f64,
        ) {
            let distance = libm::exp(distance);
            let radius = distance * radius;
            // Of numbers much less than the largest some places are cut off.
            let mut centre = [0.0; 3];
            centre[axis] = distance * away;
            let [z_rot_deg, x_rot_deg, y_rot_deg] = angles;
            let mut pose = Pose::from(EulerPose { z_rot_deg, x_rot_deg, y_rot_deg, ..EulerPose::default() });
            let from_origin = pose.transform(&centre);
            let middle = [distance * place[0], distance * place[1], -distance];
            pose.translation = core::array::from_fn(|k| middle[k] - from_origin[k]);
            let focal = libm::exp(focal);
            let camera = Camera::new(512, 512, [focal, 1.1 * focal], [250.3, -90.7]).expect("valid");
            let vertex = core::array::from_fn(|k| (centre[k] + 0.1 * radius * vertex[k]) as f32);
            let bounds = Bounds { centre, radius };
            let whole = WholeImages::new(&camera, &pose, &bounds, &Reach::of(&bounds, &pose));
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
            let whole = WholeImages::new(&camera, &pose, &bounds, &Reach::of(&bounds, &pose))
                .expect("possible");
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
