//! Numbers that no knee has: what they come from is wrong, and they are not published without saying so.

use core::fmt;
use core::ops::RangeInclusive;

use crate::joint::kinematics::Side;
use crate::joint::numbers::{NUMBERS, of_pose, place};
use crate::pose::Pose;

/// What a knee with an implant may do, with room for axes that are some degrees off. Judgements: deep kneeling bends it to 155 degrees,
/// and kneeling turns it by 30.
const FLEXION_DEG: RangeInclusive<f64> = -30.0..=170.0;
const ABDUCTION_DEG: RangeInclusive<f64> = -25.0..=25.0;
const ROTATION_DEG: RangeInclusive<f64> = -50.0..=50.0;
/// Where a lowest point may lie: of the tray's depth, percent, to either side of its middle, and above its plate, mm. The largest tray
/// is some 90 mm wide and the thickest insert 25 mm thick.
const AP_PERCENT: RangeInclusive<f64> = -50.0..=150.0;
const ACROSS_MM: RangeInclusive<f64> = -60.0..=60.0;
const HEIGHT_MM: RangeInclusive<f64> = -4.0..=60.0;

/// How far apart the middles of two components of a knee may lie along the tray's axes, mm: anterior, superior, medial. The field's translations
/// are those of the files' origins, which may lie anywhere.
const APART_MM: [f64; 3] = [60.0, 100.0, 60.0];

/// A number that no knee has. In words it is a sentence without its full stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Impossible {
    /// Flexion, degrees.
    Flexion(f64),
    /// Abduction, degrees.
    Abduction(f64),
    /// Internal rotation, degrees.
    Rotation(f64),
    /// A lowest point so far in front of the middle of the tray, mm.
    Before(f64),
    /// A lowest point so far beside the middle of the tray, mm.
    Beside(f64),
    /// A lowest point so high above the plate, mm.
    Above(f64),
}

impl fmt::Display for Impossible {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let either = |value: f64, words: [&'static str; 2]| words[usize::from(value < 0.0)];
        match *self {
            Self::Flexion(deg) => write!(f, "flexion would be {deg:.0}\u{b0}"),
            Self::Abduction(deg) => write!(f, "abduction would be {deg:.0}\u{b0}"),
            Self::Rotation(deg) => write!(f, "internal rotation would be {deg:.0}\u{b0}"),
            Self::Before(mm) => {
                let word = either(mm, ["in front of", "behind"]);
                write!(
                    f,
                    "a condyle would lie {:.0} mm {word} the middle of the tray",
                    mm.abs()
                )
            }
            Self::Beside(mm) => write!(
                f,
                "a condyle would lie {:.0} mm beside the middle of the tray",
                mm.abs()
            ),
            Self::Above(mm) => {
                let word = either(mm, ["above", "below"]);
                write!(
                    f,
                    "a condyle would lie {:.0} mm {word} the tray's plate",
                    mm.abs()
                )
            }
        }?;
        f.write_str(
            ", which no knee does: a pose, the side of the body or the axes of a model are wrong",
        )
    }
}

/// The first of a frame's numbers, in the order of [`COLUMNS`](super::COLUMNS), that no knee has. What is not known is not judged.
#[must_use]
pub fn impossible(numbers: &[f64; NUMBERS]) -> Option<Impossible> {
    let beyond = |number: usize, range: &RangeInclusive<f64>| {
        let value = numbers[number];
        (value.is_finite() && !range.contains(&value)).then_some(value)
    };
    let either = |medial: usize, lateral: usize, range: &RangeInclusive<f64>| {
        [medial, lateral]
            .into_iter()
            .find(|&number| beyond(number, range).is_some())
    };
    let before = || {
        let at = either(place::MEDIAL_AP + 2, place::LATERAL_AP + 2, &AP_PERCENT)?;
        Some(Impossible::Before(numbers[at - 2]))
    };
    let beside = || {
        let at = either(place::MEDIAL_ACROSS, place::LATERAL_ACROSS, &ACROSS_MM)?;
        Some(Impossible::Beside(numbers[at]))
    };
    let above = || {
        let at = either(
            place::MEDIAL_ACROSS + 2,
            place::LATERAL_ACROSS + 2,
            &HEIGHT_MM,
        )?;
        Some(Impossible::Above(numbers[at]))
    };
    beyond(place::FLEXION, &FLEXION_DEG)
        .map(Impossible::Flexion)
        .or_else(|| beyond(place::ABDUCTION, &ABDUCTION_DEG).map(Impossible::Abduction))
        .or_else(|| beyond(place::ROTATION, &ROTATION_DEG).map(Impossible::Rotation))
        .or_else(before)
        .or_else(beside)
        .or_else(above)
}

/// What no knee of either side of the body does with components at this relative pose (`femur_from_tibia`): bending, tilting or turning.
#[must_use]
pub fn impossible_pose(relative: &Pose) -> Option<Impossible> {
    let of = |side: Side| {
        let mut numbers = [f64::NAN; NUMBERS];
        numbers[..place::MEDIAL_AP].copy_from_slice(&of_pose(relative, side));
        impossible(&numbers)
    };
    of(Side::Right).and(of(Side::Left))
}

/// The largest of a frame's translations by the field's convention, mm, where one is larger than components of a knee allow: the origins of
/// the models' files lie far off the components. Rotations and lowest points are free of it.
#[must_use]
pub fn origins_apart(numbers: &[f64; NUMBERS]) -> Option<f64> {
    let translations = || numbers.iter().zip(APART_MM);
    let is_far = |(value, most): (&f64, f64)| value.is_finite() && value.abs() > most;
    let far = translations().any(is_far);
    let largest = numbers.iter().take(APART_MM.len()).copied();
    let larger = |a: f64, b: f64| if b.abs() > a.abs() { b } else { a };
    far.then(|| largest.fold(0.0, larger))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::format;

    fn knee() -> [f64; NUMBERS] {
        let mut numbers = [0.0; NUMBERS];
        numbers[place::FLEXION] = 90.0;
        numbers[place::MEDIAL_AP + 2] = 40.0;
        numbers[place::LATERAL_AP + 2] = 30.0;
        numbers[place::MEDIAL_ACROSS + 2] = 9.0;
        numbers[place::LATERAL_ACROSS + 2] = 9.0;
        numbers
    }

    #[test]
    fn origins_that_lie_off_the_components_are_told_and_make_no_number_impossible() {
        let mut numbers = knee();
        numbers[..3].copy_from_slice(&[-24.0, 74.0, -14.0]);
        assert_eq!(origins_apart(&numbers), None);
        numbers[0] = -86.3;
        assert_eq!(origins_apart(&numbers), Some(-86.3));
        numbers[1] = f64::NAN;
        assert_eq!(origins_apart(&numbers), Some(-86.3));
        assert_eq!(impossible(&numbers), None);
    }

    #[test]
    fn what_a_knee_does_is_possible_and_what_it_does_not_is_told() {
        assert_eq!(impossible(&knee()), None);
        assert_eq!(impossible(&[f64::NAN; NUMBERS]), None);
        for (number, value, word) in [
            (place::FLEXION, -100.0, "flexion would be -100\u{b0}"),
            (place::ABDUCTION, 60.0, "abduction would be 60\u{b0}"),
            (
                place::ROTATION,
                160.0,
                "internal rotation would be 160\u{b0}",
            ),
            (place::LATERAL_ACROSS, -104.0, "104 mm beside"),
            (place::MEDIAL_ACROSS + 2, -12.0, "12 mm below"),
            (place::LATERAL_ACROSS + 2, 80.0, "80 mm above"),
        ] {
            let mut numbers = knee();
            numbers[number] = value;
            let told = impossible(&numbers).map_or_else(Default::default, |it| format!("{it}"));
            assert!(told.contains(word) && told.contains("no knee"), "{told}");
            numbers[number] = f64::NAN;
            assert_eq!(impossible(&numbers), None);
        }
        let mut numbers = knee();
        numbers[place::LATERAL_AP] = -100.0;
        numbers[place::LATERAL_AP + 2] = -150.0;
        let told = impossible(&numbers).map_or_else(Default::default, |it| format!("{it}"));
        assert!(told.contains("100 mm behind"), "{told}");
    }
}
