//! Knees that are published together, from the tables of their reports.

use std::path::Path;

use anyhow::{Context, Result};
use fluoropose_report::levels::FilmLevels;
use fluoropose_report::{Group, JointFilm, Knee, group_figure, read, write};

use super::out::{make_folder, write_cycles};
use crate::files::{name_of, read_text, write_figure, write_text};

pub(super) fn run(tables: &[String], out: &Path) -> Result<()> {
    let knees = knees(tables)?;
    let group = group(&knees, name_of(out));
    make_folder(out)?;
    write_text(&out.join("group.csv"), &write::group_table(&group))?;
    write_figure(out, "figure", &group_figure(&group))?;
    let films: Vec<&JointFilm> = knees.iter().flat_map(|(_, films)| films).collect();
    write_cycles(out, &films)?;
    println!("{} knees with {} films", knees.len(), films.len());
    for film in films {
        for told in film.impossibilities() {
            println!("{}: {told}", film.name);
        }
    }
    println!("{}", out.join("figure.svg").display());
    Ok(())
}

/// Of words `KNEE=FILE`; tables of one knee stand together, in the order in which knees are first named.
fn knees(tables: &[String]) -> Result<Vec<(&str, Vec<JointFilm>)>> {
    let mut knees: Vec<(&str, Vec<JointFilm>)> = Vec::new();
    for words in tables {
        let (knee, file) = words.split_once('=').with_context(|| {
            format!("{words} does not say whose knee it is: write KNEE={words}")
        })?;
        let film =
            read::film(&read_text(Path::new(file))?).with_context(|| format!("in {file}"))?;
        match knees.iter_mut().find(|(known, _)| *known == knee) {
            Some((_, films)) => films.push(film),
            None => knees.push((knee, vec![film])),
        }
    }
    Ok(knees)
}

fn group(knees: &[(&str, Vec<JointFilm>)], name: String) -> Group {
    let knee = |(name, films): &(&str, Vec<JointFilm>)| Knee {
        name: (*name).to_owned(),
        films: films.iter().map(FilmLevels::of).collect(),
    };
    Group::new(name, knees.iter().map(knee).collect())
}
