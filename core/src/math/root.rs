//! Square root, rounded as it must be: there is one right answer, whoever computes it.

/// Square root.
#[must_use]
#[cfg_attr(target_os = "none", inline(never))]
pub fn sqrt(x: f64) -> f64 {
    // A device takes a thousand for a pose, and `libm` has a table and five times the code for them.
    match cfg!(target_os = "none") {
        true => digit_by_digit(x),
        false => libm::sqrt(x),
    }
}

/// The first of a fraction's 53 digits, which no number has but the smallest.
const LEADING: u64 = 1 << 52;

/// The same in binary digits, as by hand (FreeBSD's `e_sqrt.c`).
fn digit_by_digit(x: f64) -> f64 {
    let bits = x.to_bits();
    // Nothing, no number, beyond all numbers, or below zero.
    if !(1..f64::INFINITY.to_bits()).contains(&bits) {
        let is_own = bits << 1 == 0 || x == f64::INFINITY;
        return if is_own { x } else { f64::NAN };
    }
    let (mut number, mut exponent) = (bits & (LEADING - 1), (bits >> 52) as u32);
    match exponent {
        0 => exponent = 1,
        _ => number |= LEADING,
    }
    while number < LEADING {
        number *= 2;
        exponent = exponent.wrapping_sub(1);
    }
    // Of a number whose exponent is even: 1023 stands for 0.
    let (mut rest, mut root, mut digit) = (number << (1 + (exponent & 1 ^ 1)), 0, 2 * LEADING);
    while digit != 0 {
        let taken = 2 * root + digit;
        if taken <= rest {
            rest -= taken;
            root += digit;
        }
        rest *= 2;
        digit /= 2;
    }
    // One digit more than there is room for; no root lies in the middle between two numbers.
    let rounded = root.div_ceil(2);
    let half = exponent.wrapping_sub(1023) as i32 >> 1;
    f64::from_bits((((1023 + half) as u64) << 52) + rounded - LEADING)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn is_libms(x: f64) -> Result<(), TestCaseError> {
        let (own, there) = (digit_by_digit(x), libm::sqrt(x));
        prop_assert!(
            own.to_bits() == there.to_bits() || own.is_nan() && there.is_nan(),
            "of {:e}",
            x
        );
        Ok(())
    }

    properties! {
        #[test]
        fn roots_are_libms(bits in any::<u64>(), near in 0.0..4.0f64, root in any::<u32>(), off in -3..=3i64, tiny in 0..1u64 << 52) {
            let square = f64::from(root) * f64::from(root);
            let beside = f64::from_bits((square.to_bits() as i64 + off).max(0) as u64);
            for x in [f64::from_bits(bits), f64::from_bits(bits >> 1), near, square, beside, f64::from_bits(tiny)] {
                is_libms(x)?;
            }
        }
    }

    #[test]
    fn what_has_no_root_has_none() {
        for x in [
            0.0,
            -0.0,
            -1.0,
            f64::NAN,
            f64::INFINITY,
            f64::NEG_INFINITY,
            f64::MAX,
            f64::MIN_POSITIVE,
        ] {
            is_libms(x).expect("the bits of libm");
        }
        assert!(digit_by_digit(-0.0).is_sign_negative());
    }
}
