//! Which row of a folder of poses is of which frame: a `track.csv` beside them names each frame's file.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::Path;

use anyhow::{Context, Result, bail, ensure};
use fluoropose::pose::Pose;
use fluoropose_report::cell::plain;

use super::listing::files_in;
use super::poses::{doubt_of_lengths, read_poses};
use super::text::{csv_fields, name_of, read_text};

/// The table of states beside poses.
const TABLE: &str = "track.csv";
/// So many names stand in a sentence.
const LISTED: usize = 5;

/// Of each frame, in the order of their files' names, the row of poses that is its own, from 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PoseRows(Vec<usize>);

impl PoseRows {
    /// Of the poses of a folder for the frames of another; `None` where rows stand as the frames do, where no table names files, and where
    /// the frames are not at hand.
    ///
    /// # Errors
    /// For a table that names other files than there are.
    pub fn of(poses: &Path, frames: Option<&Path>) -> Result<Option<Self>> {
        let table = poses.join(TABLE);
        let Some(frames) = frames.filter(|frames| frames.exists() && table.is_file()) else {
            return Ok(None);
        };
        let files: Vec<String> = files_in(frames)?.iter().map(|path| name_of(path)).collect();
        Self::of_table(&read_text(&table)?, &files).with_context(|| {
            format!(
                "{} and the frames of {} are not of the same film",
                table.display(),
                frames.display()
            )
        })
    }

    fn of_table(table: &str, files: &[String]) -> Result<Option<Self>> {
        let Some(rows) = files_of_rows(table)? else {
            return Ok(None);
        };
        let places: HashMap<&str, usize> = files.iter().map(String::as_str).zip(0..).collect();
        let mut order = BTreeMap::new();
        for (&row, (file, number)) in &rows {
            let Some(&place) = places.get(file.as_str()) else {
                bail!("{}", Unlike::of(&rows, files).words());
            };
            if order.insert((place, *number), row).is_some() {
                bail!("two of its frames are of the file {file}");
            }
        }
        let lacking = |place: &usize| order.range((*place, 0)..(*place + 1, 0)).next().is_none();
        if let Some(place) = (0..files.len()).find(lacking) {
            bail!("it has no row of the file {}", files[place]);
        }
        ensure!(
            rows.keys().copied().eq(0..rows.len()),
            "its frames are not numbered from 1 to {}",
            rows.len()
        );
        let order: Vec<usize> = order.into_values().collect();
        Ok((!order.iter().copied().eq(0..order.len())).then_some(Self(order)))
    }

    /// Rows that stand as the frames do.
    ///
    /// # Errors
    /// Where there are more or fewer rows than the table has.
    pub fn rows<T: Clone>(&self, rows: &[T]) -> Result<Vec<T>> {
        let (own, count) = (rows.len(), self.0.len());
        ensure!(
            own == count,
            "there are {own} rows of poses, but {TABLE} has {count} frames"
        );
        Ok(self.0.iter().map(|&row| rows[row].clone()).collect())
    }

    /// The frame of a row, both from 0.
    pub fn frame_of(&self, row: usize) -> Option<usize> {
        self.0.iter().position(|&own| own == row)
    }

    /// That rows were put into another order, in words.
    pub fn words(&self, poses: &Path) -> String {
        format!(
            "{}: its rows stand in another order than the frames' names; each was taken for the file that {TABLE} names",
            poses.display()
        )
    }
}

/// Files of a table and of a folder that have no part among the others.
struct Unlike<'t> {
    /// With the frame, from 1, that the table has of it.
    of_table: Vec<(usize, &'t str)>,
    of_folder: Vec<&'t str>,
}

impl<'t> Unlike<'t> {
    fn of(rows: &'t BTreeMap<usize, (String, usize)>, files: &'t [String]) -> Self {
        let there: HashSet<&str> = files.iter().map(String::as_str).collect();
        let named = rows.iter().map(|(row, (file, _))| (row + 1, file.as_str()));
        let told: HashSet<&str> = named.clone().map(|(_, file)| file).collect();
        let folder = files.iter().map(String::as_str);
        Self {
            of_table: named.filter(|(_, file)| !there.contains(file)).collect(),
            of_folder: folder.filter(|file| !told.contains(file)).collect(),
        }
    }

    /// Which names differ, and what to do: never to pair what is left by its place, of which nothing says that it is the same order.
    fn words(&self) -> String {
        let named = self.of_table.iter();
        let named = named.map(|(frame, file)| format!("frame {frame} is of the file {file}"));
        let mut text = format!("its {}: not among the frames", listed(named));
        let left = self.of_folder.iter();
        match self.of_folder.is_empty() {
            true => text.push_str("; every file of the frames has a row of its own"),
            false => {
                let left = listed(left.map(|&file| file.to_owned()));
                text.push_str(&format!("; the frames have {left}, of which no row is"));
            }
        }
        text + ". Where only names were changed, give the frames the names that the table has, or write each frame's new name into the table's \
                column file, in every row of that frame. Rows are not paired with frames by their order: nothing would tell if it were another one"
    }
}

/// The first of them, and how many more there are.
fn listed(all: impl ExactSizeIterator<Item = String>) -> String {
    let more = all.len().saturating_sub(LISTED);
    let text = all.take(LISTED).collect::<Vec<_>>().join(", ");
    match more {
        0 => text,
        _ => format!("{text} and {more} more"),
    }
}

/// Reads poses as [`read_poses`] does, a row a frame in the order of the frames' names, as far as a table beside them tells it.
///
/// # Errors
/// Names the file and the line; for a table that names other files than there are.
pub fn read_poses_of(path: &Path, frames: Option<&Path>) -> Result<Vec<Option<Pose>>> {
    let poses = read_poses(path)?;
    if let Some(doubt) = doubt_of_lengths(&poses) {
        eprintln!("{}: {doubt}", path.display());
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    match PoseRows::of(folder, frames)? {
        Some(rows) => {
            eprintln!("{}", rows.words(folder));
            rows.rows(&poses)
                .with_context(|| format!("in {}", path.display()))
        }
        None => Ok(poses),
    }
}

/// By row, from 0, the file's name and the frame's number in it; `None` where the table does not name files.
fn files_of_rows(table: &str) -> Result<Option<BTreeMap<usize, (String, usize)>>> {
    let mut lines = table.lines();
    let heading = csv_fields(lines.next().unwrap_or_default());
    let column = |name: &str| heading.iter().position(|own| own == name);
    let (Some(frame), Some(file)) = (column("frame"), column("file")) else {
        return Ok(None);
    };
    let number = column("frame_of_file");
    let mut rows = BTreeMap::new();
    for fields in lines.map(csv_fields) {
        let text = |at: usize| plain(fields.get(at).map_or("", String::as_str));
        let row = text(frame).parse::<usize>().ok();
        let row = row.and_then(|row| row.checked_sub(1));
        let row = row.context("a row does not begin with its frame, from 1")?;
        let name = text(file).rsplit(['/', '\\']).next().unwrap_or_default();
        if name.is_empty() {
            return Ok(None);
        }
        let number = number.map_or(Ok(1), |at| text(at).parse());
        let number = number.with_context(|| format!("the row of {name} has no frame_of_file"))?;
        // Both components have a row of it.
        let own = (name.to_owned(), number);
        let known = rows.entry(row).or_insert_with(|| own.clone());
        ensure!(
            *known == own,
            "its frame {} is of two files, {} and {name}",
            row + 1,
            known.0
        );
    }
    Ok((!rows.is_empty()).then_some(rows))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(files: &[(&str, usize)]) -> String {
        let mut text = String::from("frame,component,state,file,frame_of_file\n");
        for (row, (file, number)) in files.iter().enumerate() {
            for component in ["femur", "tibia"] {
                text += &format!("{},\"{component}\",followed,\"{file}\",{number}\n", row + 1);
            }
        }
        text
    }

    fn of(rows: &[(&str, usize)], files: &[&str]) -> Result<Option<PoseRows>> {
        let files: Vec<String> = files.iter().map(|&name| name.to_owned()).collect();
        PoseRows::of_table(&table(rows), &files)
    }

    #[test]
    fn rows_are_put_to_the_frames_that_the_table_names() {
        let by_letters = [("f1.png", 1), ("f10.png", 1), ("f2.png", 1)];
        let rows = of(&by_letters, &["f1.png", "f2.png", "f10.png"]);
        let rows = rows.unwrap().expect("another order");
        assert_eq!(
            rows.rows(&["f1", "f10", "f2"]).unwrap(),
            ["f1", "f2", "f10"]
        );
        assert_eq!(rows.frame_of(1), Some(2));
        assert!(rows.rows(&["f1"]).is_err());
        let several = [("b.tif", 1), ("b.tif", 2), ("a.tif", 1)];
        let rows = of(&several, &["a.tif", "b.tif"]).unwrap().expect("another");
        assert_eq!(rows.rows(&[0, 1, 2]).unwrap(), [2, 0, 1]);
    }

    #[test]
    fn what_stands_as_the_frames_do_or_names_no_files_is_left_as_it_is() {
        let right = [("d/f1.png", 1), ("d\\f2.png", 1)];
        assert_eq!(of(&right, &["f1.png", "f2.png"]).unwrap(), None);
        assert_eq!(of(&[("", 1)], &["f1.png"]).unwrap(), None);
        let old = "frame,component,state,verdict,because\n1,femur,fixed,good,x\n";
        assert_eq!(
            PoseRows::of_table(old, &["f1.png".to_owned()]).unwrap(),
            None
        );
    }

    #[test]
    fn other_frames_are_refused() {
        let refused = |rows: &[(&str, usize)], files: &[&str]| {
            of(rows, files).expect_err("other frames").to_string()
        };
        let said = refused(&[("f1.png", 1), ("f3.png", 1)], &["f1.png", "f2.png"]);
        assert!(said.contains("frame 2 is of the file f3.png"), "{said}");
        let said = refused(&[("f1.png", 1)], &["f1.png", "f2.png"]);
        assert!(said.contains("no row of the file f2.png"), "{said}");
        let said = refused(&[("f1.png", 1), ("f1.png", 1)], &["f1.png"]);
        assert!(said.contains("two of its frames"), "{said}");
    }

    #[test]
    fn which_names_differ_is_told_and_nothing_is_to_be_paired_by_its_place() {
        let names = |prefix: &str| -> Vec<String> {
            (1..=8)
                .map(|number| format!("{prefix}{number}.png"))
                .collect()
        };
        let (old, mut new) = (names("a"), names("b"));
        new[0].clone_from(&old[0]);
        let rows: Vec<(&str, usize)> = old.iter().map(|name| (name.as_str(), 1)).collect();
        let said = PoseRows::of_table(&table(&rows), &new).expect_err("other names");
        let said = said.to_string();
        for words in [
            "its frame 2 is of the file a2.png, frame 3 is of the file a3.png,",
            "a6.png and 2 more: not among the frames",
            "the frames have b2.png, b3.png, b4.png, b5.png, b6.png and 2 more, of which no row is",
            "write each frame's new name into the table's column file",
        ] {
            assert!(said.contains(words), "{words}: {said}");
        }
        assert!(!said.contains("take the column"), "{said}");
    }
}
