//! The list of studies: a table with a row a study.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};

use crate::files::{check_file_name, csv_fields, name_of, read_text};
use crate::verbs::track::{Click, FixedPoses};

/// A study of a list.
#[derive(Clone, Debug)]
pub struct Entry {
    /// What its results are called.
    pub name: String,
    /// Its study file.
    pub study: PathBuf,
    /// The knee that it is of.
    pub knee: String,
    /// The group that the knee belongs to.
    pub group: String,
    /// Clicks into components.
    pub clicks: Vec<Click>,
    /// Poses that a person fixed.
    pub fixed: Vec<FixedPoses>,
}

const COLUMNS: [&str; 6] = ["study", "name", "knee", "group", "click", "fixed"];

/// Reads a list; its paths are meant from its own folder.
///
/// # Errors
/// Names the file, and the line at fault.
pub fn read_list(path: &Path) -> Result<Vec<Entry>> {
    let text = read_text(path)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    entries(&text, folder).with_context(|| format!("in {}", path.display()))
}

fn entries(text: &str, folder: &Path) -> Result<Vec<Entry>> {
    let lines = text.trim_start_matches('\u{feff}').lines().enumerate();
    let mut lines = lines.filter(|(_, line)| !line.trim().is_empty() && !line.starts_with('#'));
    let (_, heading) = lines
        .next()
        .context("there is no first line with the names of the columns")?;
    let heading: Vec<String> = csv_fields(heading)
        .iter()
        .map(|name| name.trim().to_owned())
        .collect();
    for name in &heading {
        ensure!(
            COLUMNS.contains(&name.as_str()),
            "the column '{name}' is none of {}",
            COLUMNS.join(", ")
        );
    }
    ensure!(
        heading.iter().any(|name| name == "study"),
        "there is no column 'study'"
    );
    let mut names = BTreeSet::new();
    let mut entries = Vec::new();
    for (line, text) in lines {
        let entry = entry(&heading, &csv_fields(text), folder);
        let entry = entry.with_context(|| format!("line {}", line + 1))?;
        // Many systems keep no two folders whose names differ in capitals alone.
        if !names.insert(entry.name.to_lowercase()) {
            bail!(
                "line {}: there is another study called {}, capitals or not: give names in a column 'name'",
                line + 1,
                entry.name
            );
        }
        entries.push(entry);
    }
    ensure!(!entries.is_empty(), "there is no study");
    Ok(entries)
}

fn entry(heading: &[String], fields: &[String], folder: &Path) -> Result<Entry> {
    let quotes = match fields.len() > heading.len() {
        true => "; what has a comma in it, as a click, stands in quotes: \"femur:1:512,400\"",
        false => "",
    };
    ensure!(
        fields.len() == heading.len(),
        "there are {} columns and not {}{quotes}",
        fields.len(),
        heading.len()
    );
    let field = |name: &str| {
        let at = heading.iter().position(|column| column == name)?;
        Some(fields.get(at)?.trim()).filter(|field| !field.is_empty())
    };
    let mut study = folder.join(field("study").context("no study is named")?);
    // A folder that is not there is named like one that is.
    let is_file = study.is_file() || study.extension().is_some_and(|kind| kind == "toml");
    if !is_file {
        study.push("study.toml");
    }
    let of_folder = || study.parent().map(name_of).unwrap_or_default();
    let name = field("name").map_or_else(of_folder, str::to_owned);
    let plain = |letter: char| letter.is_alphanumeric() || "-_+.".contains(letter);
    ensure!(
        !name.is_empty() && !name.starts_with('.') && name.chars().all(plain),
        "'{name}' is no name for a folder: letters, digits, and - _ + . but not first"
    );
    check_file_name(&name)?;
    let several = |name: &str| {
        field(name)
            .unwrap_or_default()
            .split(';')
            .filter(|one| !one.trim().is_empty())
    };
    let fixed = |text: &str| -> Result<FixedPoses> {
        let fixed: FixedPoses = text.trim().parse()?;
        Ok(FixedPoses {
            file: folder.join(fixed.file),
            ..fixed
        })
    };
    Ok(Entry {
        knee: field("knee").unwrap_or(&name).to_owned(),
        group: field("group").unwrap_or("all").to_owned(),
        clicks: several("click")
            .map(|text| text.trim().parse())
            .collect::<Result<_>>()?,
        fixed: several("fixed").map(fixed).collect::<Result<_>>()?,
        study,
        name,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_needs_its_study_alone() {
        let text = "study,group\na/study.toml,\n\nb/left/study.toml,cruciate retaining\n";
        let list = entries(text, Path::new("/data")).unwrap();
        assert_eq!(list[0].study, Path::new("/data/a/study.toml"));
        assert_eq!(
            (
                list[0].name.as_str(),
                list[0].knee.as_str(),
                list[0].group.as_str()
            ),
            ("a", "a", "all")
        );
        assert_eq!(
            (list[1].name.as_str(), list[1].group.as_str()),
            ("left", "cruciate retaining")
        );
        let list = entries("study\n../s/nothere\n", Path::new("/data")).unwrap();
        assert_eq!(list[0].name, "nothere");
        let text = "name,study,fixed,click\nx,s.toml,femur=f.jts;tibia=t.jts,\"femur:1:5,6\"\n";
        let list = entries(text, Path::new("/data")).unwrap();
        assert_eq!(list[0].fixed[1].file, Path::new("/data/t.jts"));
        assert_eq!(list[0].clicks[0].place, [5.0, 6.0]);
    }

    #[test]
    fn faults_name_their_line() {
        for (text, word) in [
            ("", "first line"),
            ("name\nx\n", "column 'study'"),
            ("study,colour\na/s,red\n", "'colour'"),
            ("study\n", "no study"),
            ("study\na/s.toml\na/t.toml\n", "line 3"),
            (
                "study\nKnee/s.toml\nknee/s.toml\n",
                "another study called knee",
            ),
            ("study,name\na/s.toml,../x\n", "line 2"),
            ("study,name\na/s.toml,nul\n", "line 2"),
            ("study,name\na/s.toml\n", "line 2"),
            (
                "study,click\na,femur:1:5,6\n",
                "in quotes: \"femur:1:512,400\"",
            ),
        ] {
            let error = entries(text, Path::new("")).unwrap_err();
            assert!(format!("{error:#}").contains(word), "{error:#}");
        }
    }
}
