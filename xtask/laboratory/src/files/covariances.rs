//! How uncertain the poses of a file are: a table beside it, which `report` reads.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use fluoropose::pose::covariance::PoseCovariance;

use super::text::write_text;

/// How uncertain a pose is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uncertain {
    /// Its covariance.
    pub covariance: PoseCovariance,
    /// What a step of each of the film's constants does to it; `None` where nobody knows: in files from before it was written, and of
    /// poses from masks that were brought onto frames.
    pub film_steps: Option<[[f64; 6]; 2]>,
}

/// The table beside a file of poses.
pub fn covariances_beside(poses: &Path) -> PathBuf {
    poses.with_extension("covariances.csv")
}

/// Writes the table beside a file of poses, whose rows these are. It is written without any row, too: one of an earlier run would be taken
/// for that of these poses.
///
/// # Errors
/// Names the file.
pub fn write_covariances(
    poses: &Path,
    rows: impl IntoIterator<Item = Option<Uncertain>>,
) -> Result<()> {
    write_text(&covariances_beside(poses), &covariance_table(rows))
}

/// The covariance of each pose that has one, a row a frame: the frame, and 36 numbers row by row, of a turn about the middle of
/// the model (radians) and a shift (mm), both in camera axes; then how the pose moves with one standard deviation of each of two constants
/// of the film, which is in the covariance and moves the other component too.
fn covariance_table(rows: impl IntoIterator<Item = Option<Uncertain>>) -> String {
    let mut text = String::from("frame");
    for row in 1..=6 {
        (1..=6).for_each(|column| text.push_str(&format!(",c{row}{column}")));
    }
    for constant in 1..=2 {
        (1..=6).for_each(|k| text.push_str(&format!(",film{constant}_{k}")));
    }
    text.push('\n');
    let known = (1..).zip(rows);
    for (frame, uncertain) in known.filter_map(|(frame, one)| Some((frame, one?))) {
        text.push_str(&i32::to_string(&frame));
        let steps = uncertain.film_steps.iter().flatten().flatten();
        let matrix = uncertain.covariance.matrix.as_flattened();
        for number in matrix.iter().chain(steps) {
            text.push_str(&format!(",{number}"));
        }
        text.push('\n');
    }
    text
}

/// What [`write_covariances`] wrote: a frame, from 1, 36 numbers, and twice six of the film where they are known. By frame, from 0.
///
/// # Errors
/// Names the line.
pub fn read_covariances(text: &str) -> Result<BTreeMap<usize, Uncertain>> {
    let mut all = BTreeMap::new();
    for (index, line) in text.lines().enumerate().skip(1) {
        let numbers: Result<Vec<f64>, _> = line.split(',').map(str::parse).collect();
        let numbers = numbers.with_context(|| format!("line {}", index + 1))?;
        let (rows, rest) = numbers.get(1..).unwrap_or_default().as_chunks::<6>();
        let whole = rest.is_empty() && matches!(rows.len(), 6 | 8);
        let matrix = rows.first_chunk::<6>().filter(|_| whole);
        let matrix = *matrix
            .with_context(|| format!("line {} does not hold 37 or 49 numbers", index + 1))?;
        let uncertain = Uncertain {
            covariance: PoseCovariance { matrix },
            film_steps: rows[6..].try_into().ok(),
        };
        let frame = numbers[0];
        ensure!(
            frame >= 1.0 && frame.fract() == 0.0,
            "line {} names no frame, a whole number from 1",
            index + 1
        );
        let is_known = numbers.iter().all(|number| number.is_finite());
        ensure!(
            is_known && (0..6).all(|k| matrix[k][k] >= 0.0),
            "line {} holds no covariance: its numbers have to be finite, and variances not negative",
            index + 1
        );
        all.insert(frame as usize - 1, uncertain);
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read() {
        let mut matrix = [[0.0; 6]; 6];
        (0..6).for_each(|k| matrix[k][k] = 1.0 / (k + 3) as f64);
        let covariance = PoseCovariance { matrix };
        let steps = [None, Some([[0.1; 6], [-1.0 / 3.0; 6]])];
        let [masks, film] = steps.map(|film_steps| Uncertain {
            covariance,
            film_steps,
        });
        let table = covariance_table([None, Some(masks), None, Some(film)]);
        let known = BTreeMap::from([(1, masks), (3, film)]);
        assert_eq!(read_covariances(&table).unwrap(), known);
        assert!(
            read_covariances(&covariance_table([None]))
                .unwrap()
                .is_empty()
        );
    }

    #[test]
    fn covariances_that_are_none_are_refused() {
        let table = |frame: &str, first: &str| {
            let identity = |k: usize| if k.is_multiple_of(7) { "1" } else { "0" };
            let numbers: Vec<&str> = (0..36).map(identity).collect();
            let row = numbers.join(",").replacen('1', first, 1);
            read_covariances(&format!("frame,c11\n{frame},{row}\n"))
        };
        assert_eq!(table("2", "0.5").unwrap()[&1].covariance.matrix[0][0], 0.5);
        for (frame, first, words) in [
            ("2", "nan", "holds no covariance"),
            ("2", "inf", "holds no covariance"),
            ("2", "-1", "holds no covariance"),
            ("0", "1", "names no frame"),
            ("1.5", "1", "names no frame"),
        ] {
            let error = table(frame, first).err().map(|error| error.to_string());
            assert!(
                error.is_some_and(|error| error.contains(words)),
                "{frame} {first}"
            );
        }
    }
}
