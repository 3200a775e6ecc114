//! Sine and cosine with the bits of `libm`, without what it has for angles that nobody turns by: a third of its code, a sixth of its
//! stack.
//!
//! The reduction and the polynomials are those of FreeBSD's `e_rem_pio2.c`, `k_sin.c` and `k_cos.c`, which `libm` follows
//! (copyright 1993 Sun Microsystems, Inc.; permission to use, copy, modify, and distribute is freely granted, provided that this
//! notice is preserved).

use core::f64::consts::{FRAC_2_PI, TAU};

/// Pi / 2 in parts of 33 bits, each with all that is left after it.
const QUARTER: [[f64; 2]; 3] = [
    [1.570_796_326_734_125_6, 6.077_100_506_506_192e-11],
    [6.077_100_506_303_966e-11, 2.022_266_248_795_950_6e-21],
    [2.022_266_248_711_166_5e-21, 8.478_427_660_368_9e-32],
];
/// Sums with this are whole numbers.
const TO_WHOLE: f64 = 1.5 / f64::EPSILON;

const SINE: [f64; 6] = [
    -1.666_666_666_666_663_2e-1,
    8.333_333_333_322_49e-3,
    -1.984_126_982_985_795e-4,
    2.755_731_370_707_006_8e-6,
    -2.505_076_025_340_686_3e-8,
    1.589_690_995_211_55e-10,
];
const COSINE: [f64; 6] = [
    4.166_666_666_666_66e-2,
    -1.388_888_888_887_411e-3,
    2.480_158_728_947_673e-5,
    -2.755_731_435_139_066_3e-7,
    2.087_572_321_298_175e-9,
    -1.135_964_755_778_819_5e-11,
];

/// The upper half of a number's bits without its sign.
const fn high(x: f64) -> u32 {
    (x.to_bits() >> 32) as u32 & 0x7fff_ffff
}

/// The exponent in such a half.
const fn exponent(high: u32) -> i32 {
    (high >> 20) as i32
}

/// Up to these halves an angle has 1, 2, 3, 4 quarter turns.
const COUNTED: [u32; 4] = [0x4002_d97c, 0x400f_6a7a, 0x4015_fdbc, 0x401c_463b];

/// From here on, 2^20 quarter turns, an angle is brought near zero first, to as many digits as it has.
const FAR: u32 = 0x4139_21fb;

/// Sine and cosine of an angle in radians.
#[must_use]
#[cfg_attr(target_os = "none", inline(never))]
pub fn sin_cos(radians: f64) -> (f64, f64) {
    let near = match high(radians) < FAR {
        true => radians,
        false => radians - TAU * libm::floor(radians / TAU + 0.5),
    };
    match high(near) {
        ..0x3e46_a09e => (near, 1.0),
        0x3e46_a09e..=0x3fe9_21fb => (sine(near, 0.0, false), cosine(near, 0.0)),
        0x3fe9_21fc..FAR => {
            let (quarters, rest, tail) = reduced(near);
            let (sin, cos) = (sine(rest, tail, true), cosine(rest, tail));
            match quarters & 3 {
                0 => (sin, cos),
                1 => (cos, -sin),
                2 => (-sin, -cos),
                _ => (-cos, sin),
            }
        }
        FAR.. => (f64::NAN, f64::NAN),
    }
}

/// Quarter turns in an angle, and what is left of it, in two parts.
fn reduced(x: f64) -> (i32, f64, f64) {
    let bits = high(x);
    // Up to 9/4 pi `libm` counts quarters by these bits, and takes the first part of pi / 2 alone where they are not a multiple's.
    let counted = COUNTED.iter().position(|&last| bits <= last);
    let is_multiple = match bits {
        ..=0x400f_6a7a => bits & 0xf_ffff == 0x9_21fb,
        _ => bits == 0x4012_d97c || bits == 0x4019_21fb,
    };
    let counted = counted.filter(|_| !is_multiple);
    let count = match counted {
        Some(before) => f64::copysign((before + 1) as f64, x),
        None => (x * FRAC_2_PI + TO_WHOLE) - TO_WHOLE,
    };
    let [first, second, third] = QUARTER;
    let (mut left, mut after) = (x - count * first[0], count * first[1]);
    let lost = |left: f64, after: f64| exponent(bits) - exponent(high(left - after));
    if counted.is_none() && lost(left, after) > 16 {
        (left, after) = further(left, count, second);
        if lost(left, after) > 49 {
            (left, after) = further(left, count, third);
        }
    }
    let rest = left - after;
    (count as i32, rest, (left - rest) - after)
}

/// Another part of pi / 2, where those before it leave too few digits.
fn further(before: f64, count: f64, [part, rest]: [f64; 2]) -> (f64, f64) {
    let taken = count * part;
    let left = before - taken;
    (left, count * rest - ((before - left) - taken))
}

/// The sine of `x + tail`, at most a quarter of pi.
fn sine(x: f64, tail: f64, has_tail: bool) -> f64 {
    let [s1, s2, s3, s4, s5, s6] = SINE;
    let z = x * x;
    let w = z * z;
    let r = s2 + z * (s3 + z * s4) + z * w * (s5 + z * s6);
    let v = z * x;
    match has_tail {
        false => x + v * (s1 + z * r),
        true => x - ((z * (0.5 * tail - v * r) - tail) - v * s1),
    }
}

/// The cosine of `x + tail`, at most a quarter of pi.
fn cosine(x: f64, tail: f64) -> f64 {
    let [c1, c2, c3, c4, c5, c6] = COSINE;
    let z = x * x;
    let w = z * z;
    let r = z * (c1 + z * (c2 + z * c3)) + w * w * (c4 + z * (c5 + z * c6));
    let half = 0.5 * z;
    let w = 1.0 - half;
    w + (((1.0 - w) - half) + (z * r - x * tail))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn is_libms(radians: f64) -> Result<(), TestCaseError> {
        for radians in [radians, -radians] {
            let ((sin, cos), (sin_there, cos_there)) = (sin_cos(radians), libm::sincos(radians));
            prop_assert_eq!(sin.to_bits(), sin_there.to_bits(), "sine of {:e}", radians);
            prop_assert_eq!(
                cos.to_bits(),
                cos_there.to_bits(),
                "cosine of {:e}",
                radians
            );
        }
        Ok(())
    }

    properties! {
        #[test]
        fn bits_are_libms(turns in 0.0..10.0f64, exponent in -40.0..14.0f64, part in 0.0..1.0f64) {
            is_libms(turns)?;
            is_libms((1.0 + part) * libm::exp2(exponent))?;
        }

        /// Where a multiple of pi / 4 is taken away, where `libm` counts by bits, and one unit around each.
        #[test]
        fn bits_are_libms_near_multiples(count in 0..2_000u32, off in -40_000_000..40_000_000i64, near in -3..=3i64) {
            let multiple = f64::from(count) * core::f64::consts::FRAC_PI_4;
            is_libms(f64::from_bits((multiple.to_bits() as i64 + off).max(0) as u64))?;
            is_libms(f64::from_bits((multiple.to_bits() as i64 + near).max(0) as u64))?;
            is_libms(multiple + off as f64 * 1e-12)?;
        }

        #[test]
        fn bits_are_libms_where_it_decides(
            which in 0..15usize,
            upper in -3..=3i64,
            lower in any::<u32>(),
        ) {
            let places: [u32; 15] = [
                0x3e46_a09e, 0x3fe9_21fb, 0x3ff9_21fb, 0x4002_d97c, 0x4009_21fb, 0x400f_6a7a, 0x4012_d97c,
                0x4015_fdbc, 0x4019_21fb, 0x401c_463b, 0x4139_21fa, 0x4000_0000, 0x4010_0000, 0x0000_0003, 0x3ff0_0000,
            ];
            let high = (i64::from(places[which]) + upper).min(0x4139_21fa) as u64;
            is_libms(f64::from_bits(high << 32 | u64::from(lower)))?;
        }

        #[test]
        fn large_angles_are_those_of_the_circle(angle in 1.6e6..1e12f64) {
            let ((sin, cos), exact) = (sin_cos(angle), libm::sincos(angle));
            prop_assert!((sin - exact.0).abs() < 1e-15 * angle && (cos - exact.1).abs() < 1e-15 * angle);
        }
    }

    #[test]
    fn what_is_no_angle_has_no_sine() {
        for radians in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(sin_cos(radians).0.is_nan() && sin_cos(radians).1.is_nan());
        }
        assert!(sin_cos(-0.0).0.is_sign_negative());
        let (sin, cos) = sin_cos(f64::MAX);
        assert!(sin.is_nan() || (sin * sin + cos * cos - 1.0).abs() < 1e-12);
    }
}
