//! Arc sine and the angle of a vector with the bits of `libm`, in less than half of its code: branches that differ in constants alone
//! are rows of a table, polynomials are loops.
//!
//! Polynomials and steps are those of FreeBSD's `e_asin.c`, `s_atan.c` and `e_atan2.c`, which `libm` follows
//! (copyright 1993 Sun Microsystems, Inc.; permission to use, copy, modify, and distribute is freely granted, provided that this
//! notice is preserved).

use core::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use super::angle::{high, polynomial};

/// What is left of pi / 2 behind its 53 bits.
const FRAC_PI_2_REST: f64 = 6.123_233_995_736_766e-17;

const ABOVE: [f64; 6] = [
    1.666_666_666_666_666_6e-1,
    -3.255_658_186_224_009e-1,
    2.012_125_321_348_629_3e-1,
    -4.005_553_450_067_941e-2,
    7.915_349_942_898_145e-4,
    3.479_331_075_960_212e-5,
];
const BELOW: [f64; 5] = [
    1.0,
    -2.403_394_911_734_414,
    2.020_945_760_233_505_7,
    -6.882_839_716_054_533e-1,
    7.703_815_055_590_194e-2,
];

const EVEN: [f64; 6] = [
    3.333_333_333_333_293e-1,
    1.428_571_427_250_346_6e-1,
    9.090_887_133_436_507e-2,
    6.661_073_137_387_531e-2,
    4.976_877_994_615_932e-2,
    1.628_582_011_536_578_2e-2,
];
const ODD: [f64; 5] = [
    -1.999_999_999_987_648_3e-1,
    -1.111_111_040_546_235_6e-1,
    -7.691_876_205_044_83e-2,
    -5.833_570_133_790_573_5e-2,
    -3.653_157_274_421_691_6e-2,
];

/// A slope is turned back by an angle that is known, to where the polynomial holds.
struct Turn {
    /// Slopes are below, upper half.
    below: u32,
    /// Of the angle: its slope is the second by the first.
    slope: [f64; 2],
    /// The angle, and what is left of it.
    angle: [f64; 2],
}

const fn turn(below: u32, slope: [f64; 2], angle: [f64; 2]) -> Turn {
    Turn {
        below,
        slope,
        angle,
    }
}

const TURNS: [Turn; 5] = [
    turn(0x3fdc_0000, [1.0, 0.0], [0.0, 0.0]),
    turn(
        0x3fe6_0000,
        [1.0, 0.5],
        [4.636_476_090_008_061e-1, 2.269_877_745_296_168_7e-17],
    ),
    turn(0x3ff3_0000, [1.0, 1.0], [FRAC_PI_4, FRAC_PI_2_REST / 2.0]),
    turn(
        0x4003_8000,
        [1.0, 1.5],
        [9.827_937_232_473_29e-1, 1.390_331_103_123_099_8e-17],
    ),
    turn(u32::MAX, [0.0, 1.0], [FRAC_PI_2, FRAC_PI_2_REST]),
];

/// The upper half of what is beyond all numbers.
const INFINITE: u32 = 0x7ff0_0000;

/// Arc sine in radians of a number from -1 to 1.
pub(super) fn arc_sine(x: f64) -> f64 {
    let ratio = |z: f64| z * polynomial(z, &ABOVE) / polynomial(z, &BELOW);
    if high(x) < 0x3fe0_0000 {
        return x + x * ratio(x * x);
    }
    let z = (1.0 - x.abs()) * 0.5;
    let (root, ratio) = (libm::sqrt(z), ratio(z));
    let arc = if high(x) >= 0x3fef_3333 {
        FRAC_PI_2 - (2.0 * (root + root * ratio) - FRAC_PI_2_REST)
    } else {
        let upper = f64::from_bits(root.to_bits() & !0xffff_ffff);
        let rest = (z - upper * upper) / (root + upper);
        let quarter = 0.5 * FRAC_PI_2;
        quarter - (2.0 * root * ratio - (FRAC_PI_2_REST - 2.0 * rest) - (quarter - 2.0 * upper))
    };
    arc.copysign(x)
}

/// Angle of the vector `(x, y)` in radians, -pi to pi.
#[must_use]
#[cfg_attr(target_os = "none", inline(never))]
pub fn atan2(y: f64, x: f64) -> f64 {
    if x.is_nan() || y.is_nan() {
        return f64::NAN;
    }
    // 2^64 times as high as it is wide, or of no width.
    let is_steep = x == 0.0 || high(y) == INFINITE || high(x) + (64 << 20) < high(y);
    let angle = match y == 0.0 {
        true => 0.0,
        false if high(x) == INFINITE && high(y) == INFINITE => FRAC_PI_4,
        false if is_steep => return FRAC_PI_2.copysign(y),
        false => of_slope((y / x).abs()),
    };
    match x.is_sign_negative() {
        true => (PI - (angle - 2.0 * FRAC_PI_2_REST)).copysign(y),
        false => angle.copysign(y),
    }
}

/// The angle, up to a right one, of a slope below 2^65.
fn of_slope(slope: f64) -> f64 {
    let bits = high(slope);
    let mut turns = TURNS.iter();
    let Some(turn) = turns.find(|turn| bits < turn.below) else {
        return slope;
    };
    let ([along, up], [angle, rest]) = (turn.slope, turn.angle);
    let x = (along * slope - up) / (along + up * slope);
    let z = x * x;
    let w = z * z;
    let sum = z * polynomial(w, &EVEN) + w * polynomial(w, &ODD);
    angle - ((x * sum - rest) - x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn is_libms(y: f64, x: f64) -> Result<(), TestCaseError> {
        for (y, x) in [(y, x), (x, y)] {
            for (y, x) in [(y, x), (-y, x), (y, -x), (-y, -x)] {
                let (own, there) = (atan2(y, x), libm::atan2(y, x));
                prop_assert_eq!(own.to_bits(), there.to_bits(), "of {:e} and {:e}", y, x);
            }
        }
        Ok(())
    }

    fn is_sine_of_libms(x: f64) -> Result<(), TestCaseError> {
        for x in [x, -x] {
            let (own, there) = (arc_sine(x), libm::asin(x));
            prop_assert_eq!(own.to_bits(), there.to_bits(), "of {:e}", x);
        }
        Ok(())
    }

    /// A number by its logarithm, sign apart.
    fn far(exponent: i64, part: u64) -> f64 {
        f64::from_bits(((1023 + exponent) as u64) << 52 | part >> 12)
    }

    properties! {
        #[test]
        fn angles_have_libms_bits(
            exponents in [-1022..=1023i64, -1022..=1023i64],
            near in -70..=70i64,
            parts in [any::<u64>(), any::<u64>()],
        ) {
            is_libms(far(exponents[0], parts[0]), far(exponents[1], parts[1]))?;
            let beside = (exponents[0] + near).clamp(-1022, 1023);
            is_libms(far(beside, parts[0]), far(exponents[0], parts[1]))?;
            is_libms(far(near, parts[0]), 1.0)?;
            is_libms(far(near / 10, parts[0]), far(0, parts[1]))?;
        }

        #[test]
        fn angles_have_libms_bits_where_it_decides(
            which in 0..8usize, upper in -2..=2i64, lower in any::<u32>(), part in any::<u64>(),
        ) {
            let places: [u64; 8] = [
                0x3e40_0000, 0x3fdc_0000, 0x3fe6_0000, 0x3ff0_0000, 0x3ff3_0000, 0x4003_8000, 0x43f0_0000, 0x4410_0000,
            ];
            let high = places[which].wrapping_add_signed(upper);
            let slope = f64::from_bits(high << 32 | u64::from(lower));
            is_libms(slope, 1.0)?;
            let x = far(0, part);
            is_libms(slope * x, x)?;
        }

        #[test]
        fn arc_sines_have_libms_bits(x in -1.0..=1.0f64, exponent in -1022..0i64, part in any::<u64>()) {
            is_sine_of_libms(x)?;
            is_sine_of_libms(far(exponent, part))?;
            is_sine_of_libms(1.0 - far(exponent.max(-53), part))?;
        }

        #[test]
        fn arc_sines_have_libms_bits_where_it_decides(which in 0..4usize, upper in -2..=2i64, lower in any::<u32>()) {
            let places: [u64; 4] = [0x3e50_0000, 0x3fe0_0000, 0x3fef_3333, 0x0010_0000];
            let high = places[which].wrapping_add_signed(upper);
            is_sine_of_libms(f64::from_bits(high << 32 | u64::from(lower)))?;
        }
    }

    #[test]
    fn ends_and_what_is_no_number() {
        let ends = [
            0.0,
            1.0,
            f64::MIN_POSITIVE,
            f64::from_bits(1),
            f64::MAX,
            f64::INFINITY,
        ];
        for (y, x) in ends.iter().flat_map(|&y| ends.map(|x| (y, x))) {
            is_libms(y, x).expect("the bits of libm");
        }
        ends[..4].iter().for_each(|&x| {
            is_sine_of_libms(x).expect("the bits of libm");
        });
        assert!(atan2(f64::NAN, 1.0).is_nan() && atan2(1.0, f64::NAN).is_nan());
        assert!(atan2(f64::NAN, f64::NAN).is_nan() && arc_sine(f64::NAN).is_nan());
        assert!(atan2(f64::NAN, 0.0).is_nan() && atan2(0.0, f64::NAN).is_nan());
    }
}
