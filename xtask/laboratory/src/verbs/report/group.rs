//! Knees that are published together, from the tables of their reports.

use std::collections::BTreeSet;
use std::path::Path;

use anyhow::{Context, Result, bail, ensure};
use fluoropose_report::levels::FilmLevels;
use fluoropose_report::{Group, JointFilm, Knee, counted, group_figure, read, write};

use super::out::{make_folder, write_cycles};
use crate::files::{name_of, read_text, write_figure, write_text};

pub(super) fn run(tables: &[String], out: &Path) -> Result<()> {
    let knees = knees(tables)?;
    let group = group(&knees, name_of(out));
    if let Some(fault) = group.knees().iter().find_map(Knee::fault) {
        bail!("{fault}: name each knee's own tables");
    }
    make_folder(out)?;
    write_text(&out.join("group.csv"), &write::group_table(&group))?;
    write_figure(out, "figure", &group_figure(&group))?;
    let films: Vec<&JointFilm> = knees.iter().flat_map(|(_, films)| films).collect();
    write_cycles(out, &films)?;
    let [own, seen] =
        [(knees.len(), "knee"), (films.len(), "film")].map(|(count, what)| counted(count, what));
    println!("{own} with {seen}");
    for film in films {
        for told in film.impossibilities() {
            println!("{}: {told}", film.name);
        }
    }
    for told in group.told() {
        println!("{told}");
    }
    println!("{}", out.join("figure.svg").display());
    Ok(())
}

/// Of words `KNEE=FILE`; tables of one knee stand together, in the order in which knees are first named.
fn knees(tables: &[String]) -> Result<Vec<(&str, Vec<JointFilm>)>> {
    let mut knees: Vec<(&str, Vec<JointFilm>)> = Vec::new();
    let mut known = BTreeSet::new();
    for words in tables {
        let (knee, file) = words.split_once('=').with_context(|| {
            format!("{words} does not say whose knee it is: write KNEE={words}")
        })?;
        let place = Path::new(file).canonicalize();
        ensure!(
            place.map_or(true, |place| known.insert(place)),
            "{file} is named twice: a film counts once"
        );
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
