//! Numbers in sentences: a few decimals, by whole numbers. The language's own way takes 14 KB of a microcontroller's flash,
//! because it writes every number to the last digit.

use core::fmt;

use super::basic::round;

/// Beyond this a number is written as if it were this: all that has such decimals is far smaller.
const MOST: f64 = 1e15;

/// A number as it stands in a sentence.
#[derive(Clone, Copy, Debug)]
pub struct Decimal {
    value: f64,
    /// Digits behind the point.
    digits: u32,
    /// Whether zeros at their end are left out.
    brief: bool,
}

impl Decimal {
    /// With so many digits behind the point, at most six.
    #[must_use]
    pub fn new(value: f64, digits: u32) -> Self {
        Self {
            value,
            digits: digits.min(6),
            brief: false,
        }
    }

    /// A number and the limit that it passes, with `digits` behind the point, and more, three at most, where they would be written alike.
    #[must_use]
    pub fn told_apart(value: f64, limit: f64, digits: u32) -> [Self; 2] {
        let differ = |digits: &u32| {
            let unit = f64::from(10u32.pow(*digits));
            round(value * unit) != round(limit * unit)
        };
        let digits = (digits..3).find(differ).unwrap_or(digits.max(3));
        [value, limit].map(|value| Self::new(value, digits))
    }

    /// With as many digits as it has, of six.
    #[must_use]
    pub fn brief(value: f64) -> Self {
        Self {
            brief: true,
            ..Self::new(value, 6)
        }
    }
}

impl fmt::Display for Decimal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { value, brief, .. } = *self;
        if value.is_nan() {
            return f.write_str("NaN");
        }
        if value.is_sign_negative() {
            f.write_str("-")?;
        }
        if value.is_infinite() {
            return f.write_str("inf");
        }
        let mut unit = 10u64.pow(self.digits);
        let mut all = round(value.abs().min(MOST) * unit as f64) as u64;
        while brief && unit > 1 && all.is_multiple_of(10) {
            (all, unit) = (all / 10, unit / 10);
        }
        let unit_of = unit.max(1);
        write!(f, "{}", all / unit_of)?;
        let mut rest = all % unit_of;
        if unit > 1 {
            f.write_str(".")?;
        }
        while unit > 1 {
            unit = (unit / 10).max(1);
            write!(f, "{}", rest / unit)?;
            rest %= unit;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::format;
    use std::string::ToString;

    properties! {
        /// Oracle: the language's own way, but for numbers in the middle between two.
        #[test]
        fn numbers_are_written_as_the_language_writes_them(
            millionths in -2_000_000_000i64..2_000_000_000, digits in 0u32..=6,
        ) {
            prop_assume!(digits == 6 || millionths % 10 != 5);
            let value = millionths as f64 / 1e6;
            let unit = 10f64.powi(digits as i32);
            prop_assume!(((value * unit).fract().abs() - 0.5).abs() > 1e-7);
            let wanted = format!("{value:.*}", digits as usize);
            prop_assert_eq!(Decimal::new(value, digits).to_string(), wanted);
            prop_assert_eq!(Decimal::brief(value).to_string(), value.to_string());
        }
    }

    #[test]
    fn a_number_is_never_written_as_the_limit_that_it_passes() {
        for (value, limit, digits, wanted) in [
            (28.4, 15.0, 0, ["28", "15"]),
            (28.4, 15.0, 1, ["28.4", "15.0"]),
            (15.3, 15.0, 0, ["15.3", "15.0"]),
            (15.04, 15.0, 1, ["15.04", "15.00"]),
            (15.6, 15.0, 0, ["16", "15"]),
            (15.0, 15.0, 2, ["15.000", "15.000"]),
            (15.000_000_1, 15.0, 0, ["15.000", "15.000"]),
        ] {
            assert_eq!(
                Decimal::told_apart(value, limit, digits).map(|one| one.to_string()),
                wanted
            );
        }
    }

    #[test]
    fn what_is_no_number_and_what_has_no_sentence_have_words_too() {
        for value in [f64::NAN, f64::INFINITY, -f64::INFINITY, 0.0, -0.0, 7.0] {
            assert_eq!(Decimal::brief(value).to_string(), value.to_string());
        }
        assert_eq!(Decimal::new(-0.3, 0).to_string(), "-0");
        assert_eq!(Decimal::new(3e200, 1).to_string(), "1000000000000000.0");
        assert_eq!(Decimal::brief(1e-9).to_string(), "0");
    }
}
