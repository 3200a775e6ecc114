//! The largest whole number not above another, in a third of the code that `libm` has for it.

/// From here on every number is whole.
const WHOLE: f64 = 1.0 / f64::EPSILON;

/// Largest whole number not above `x`.
#[must_use]
#[cfg_attr(target_os = "none", inline(never))]
pub fn floor(x: f64) -> f64 {
    let size = x.abs();
    // Nor what is no number.
    if size.to_bits() >= WHOLE.to_bits() {
        return x;
    }
    let nearest = ((size + WHOLE) - WHOLE).copysign(x);
    if nearest > x { nearest - 1.0 } else { nearest }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    properties! {
        #[test]
        fn bits_are_libms(any in any::<u64>(), near in -3.0..3.0f64, whole in -1e15..1e15f64) {
            let tie = libm::floor(whole) + 0.5;
            let next = |x: f64| [x.next_down(), x, x.next_up()];
            let numbers = [f64::from_bits(any), near, whole, WHOLE - near, near - WHOLE, WHOLE / 2.0 + near];
            for x in numbers.into_iter().chain(next(tie)).chain(next(libm::floor(whole))) {
                let (own, there) = (floor(x), libm::floor(x));
                prop_assert!(own.to_bits() == there.to_bits() || x.is_nan() && own.is_nan(), "{:e}", x);
            }
        }
    }

    #[test]
    fn signs_of_nothing_are_kept() {
        for x in [
            0.0,
            -0.0,
            0.3,
            -0.3,
            0.5,
            -0.5,
            1.0,
            -1.0,
            f64::INFINITY,
            f64::NEG_INFINITY,
        ] {
            assert_eq!(floor(x).to_bits(), libm::floor(x).to_bits(), "{x}");
        }
    }
}
