//! Anatomical axes in words: which of the file's axes are anterior, superior and to the right.

use core::fmt;

use thiserror::Error;

use super::AnatomicalAxes;
use crate::math::{Vector3, cross, dot};
use crate::pose::Pose;

/// Why words are no axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum AxesError {
    /// Another number of words than three, or one that names no axis.
    #[error(
        "axes are three of x, -x, y, -y, z and -z: the file's anterior, superior and right, as in \"x y z\""
    )]
    Words,
    /// Two words name one axis, or the three are those of a mirrored part.
    #[error(
        "the three axes are not those of a right-handed frame: anterior x superior must be the patient's right"
    )]
    Handed,
}

impl AnatomicalAxes {
    /// Axes that a person states: three of `x`, `-x`, `y`, `-y`, `z` and `-z`, which of the file's axes points anteriorly,
    /// superiorly and to the patient's right.
    ///
    /// # Errors
    /// [`AxesError`].
    pub fn from_words(words: &str) -> Result<Self, AxesError> {
        let mut axes = words.split_whitespace().map(axis);
        let mut next = || axes.next().flatten().ok_or(AxesError::Words);
        let [anterior, superior, right] = [next()?, next()?, next()?];
        if axes.next().is_some() {
            return Err(AxesError::Words);
        }
        if dot(&cross(&anterior, &superior), &right) < 0.5 {
            return Err(AxesError::Handed);
        }
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
        for words in ["x y -z", "x x y", "z y x"] {
            assert_eq!(
                AnatomicalAxes::from_words(words),
                Err(AxesError::Handed),
                "{words}"
            );
        }
        for words in ["", "x y", "x y z x", "x y w"] {
            assert_eq!(
                AnatomicalAxes::from_words(words),
                Err(AxesError::Words),
                "{words}"
            );
        }
    }
}
