//! Anatomical axes in words: which of the file's axes are anterior, superior and to the right.

use core::fmt;

use thiserror::Error;

use super::AnatomicalAxes;
use crate::math::{Vector3, cross, dot, norm, scale};
use crate::pose::Pose;

/// Why words are no axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum AxesError {
    /// Another number of words than three, or one that names no axis and no direction.
    #[error(
        "axes are three of x, -x, y, -y, z and -z, or directions between them as (0.6, 0, 0.8): the file's anterior, superior and right, as in \"x y z\""
    )]
    Words,
    /// Directions that are not at right angles.
    #[error("two of the three directions are not at right angles to within a degree")]
    Oblique,
    /// Two words name one axis, or the three are those of a mirrored part.
    #[error(
        "the three axes are not those of a right-handed frame: anterior x superior must be the patient's right"
    )]
    Handed,
}

/// Sine of a degree: what a person measures is at right angles to within that.
const SQUARE: f64 = 0.017_452;

impl AnatomicalAxes {
    /// Axes that a person states: three of `x`, `-x`, `y`, `-y`, `z` and `-z`, which of the file's axes points anteriorly,
    /// superiorly and to the patient's right; or, where the file's are oblique to the part, directions in its coordinates as
    /// `(0.6, 0, 0.8)`, of any length. Of directions that are not quite at right angles the superior one stays.
    ///
    /// # Errors
    /// [`AxesError`].
    pub fn from_words(words: &str) -> Result<Self, AxesError> {
        let mut rest = words.trim_start();
        let mut next = || {
            let (found, behind) = first(rest).ok_or(AxesError::Words)?;
            rest = behind.trim_start();
            Ok(found)
        };
        let all = [next()?, next()?, next()?];
        if !rest.is_empty() {
            return Err(AxesError::Words);
        }
        let [anterior, superior, right] = square(all)?;
        Ok(Self {
            model_from_field: Pose {
                rotation: core::array::from_fn(|k| [anterior[k], superior[k], right[k]]),
                translation: [0.0; 3],
            },
            front_is_known: true,
            are_files_own: true,
        })
    }
}

/// The direction that a text begins with, a unit, and what comes behind it.
fn first(text: &str) -> Option<(Vector3, &str)> {
    let Some(inside) = text.strip_prefix('(') else {
        let end = text.find(|c: char| c.is_whitespace() || c == '(');
        let (word, behind) = text.split_at(end.unwrap_or(text.len()));
        return Some((axis(word)?, behind));
    };
    let (inside, behind) = inside.split_once(')')?;
    let mut numbers = inside.split(',').map(|number| number.trim().parse().ok());
    let mut next = || numbers.next().flatten();
    let direction = [next()?, next()?, next()?];
    let length = norm(&direction);
    let is_one = numbers.next().is_none() && length.is_finite() && length > 0.0;
    is_one.then(|| (scale(&direction, 1.0 / length), behind))
}

/// Three units at right angles.
fn square([anterior, superior, right]: [Vector3; 3]) -> Result<[Vector3; 3], AxesError> {
    if dot(&cross(&anterior, &superior), &right) < 0.5 {
        return Err(AxesError::Handed);
    }
    let pairs = [
        (&anterior, &superior),
        (&superior, &right),
        (&right, &anterior),
    ];
    if pairs.iter().any(|(a, b)| dot(a, b).abs() > SQUARE) {
        return Err(AxesError::Oblique);
    }
    let across = cross(&anterior, &superior);
    let right = scale(&across, 1.0 / norm(&across));
    Ok([cross(&superior, &right), superior, right])
}

fn axis(word: &str) -> Option<Vector3> {
    let (sign, name) = match word.strip_prefix('-') {
        Some(name) => (-1.0, name),
        None => (1.0, word.strip_prefix('+').unwrap_or(word)),
    };
    let at = ["x", "y", "z"].iter().position(|axis| *axis == name)?;
    let mut axis = [0.0; 3];
    axis[at] = sign;
    Some(axis)
}

/// Three words as [`AnatomicalAxes::from_words`] reads them, or three directions where they are none of the file's axes.
impl fmt::Display for AnatomicalAxes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for column in 0..3 {
            let axis = self.model_from_field.rotation.map(|row| row[column]);
            if column > 0 {
                f.write_str(" ")?;
            }
            match own_word(&axis) {
                Some(word) => f.write_str(word)?,
                None => write!(f, "({:.3}, {:.3}, {:.3})", axis[0], axis[1], axis[2])?,
            }
        }
        Ok(())
    }
}

fn own_word(axis: &Vector3) -> Option<&'static str> {
    const WORDS: [[&str; 2]; 3] = [["x", "-x"], ["y", "-y"], ["z", "-z"]];
    let at = axis.iter().position(|x| x.abs() > 1.0 - 1e-9)?;
    Some(WORDS[at][usize::from(axis[at] < 0.0)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::format;

    #[test]
    fn what_is_written_is_read_and_mirrored_axes_are_refused() {
        for words in ["x y z", "-z y x", "y z x", "-x -y z"] {
            let axes = AnatomicalAxes::from_words(words).expect("right-handed");
            assert_eq!(format!("{axes}"), words);
            assert!(axes.model_from_field.is_rigid(1e-12));
        }
        for words in ["x y -z", "x x y", "z y x", "(8, 6, 0) (-6, 8, 0) -z"] {
            assert_eq!(
                AnatomicalAxes::from_words(words),
                Err(AxesError::Handed),
                "{words}"
            );
        }
        // Told of a shape, and stated again.
        let oblique = "(0.800, 0.600, 0.000) (-0.600, 0.800, 0.000) z";
        let axes = AnatomicalAxes::from_words(oblique).expect("right-handed");
        assert_eq!(format!("{axes}"), oblique);
        assert!(axes.model_from_field.is_rigid(1e-12));
        for words in [
            "(8, 6, 0)(-6,8,0)( 0 , 0 , 2 )",
            " (8.05, 6, 0) (-6, 8, 0) z ",
        ] {
            let same = AnatomicalAxes::from_words(words).expect("to within a degree");
            assert_eq!(format!("{same}"), oblique, "{words}");
            assert!(same.model_from_field.is_rigid(1e-12));
        }
        for words in ["(1, 1, 0) y z", "x y (0, 0.02, 1)"] {
            let refused = AnatomicalAxes::from_words(words);
            assert_eq!(refused, Err(AxesError::Oblique), "{words}");
        }
        for words in [
            "",
            "x y",
            "x y z x",
            "x y w",
            "(1, 0) y z",
            "(1, 0, 0, 0) y z",
            "(0, 0, 0) y z",
            "(NaN, 0, 0) y z",
            "(1, 0, 0 y z",
            "x y z (0, 0, 1)",
        ] {
            assert_eq!(
                AnatomicalAxes::from_words(words),
                Err(AxesError::Words),
                "{words}"
            );
        }
    }
}
