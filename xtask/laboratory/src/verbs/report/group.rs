//! Knees that are published together, from the tables of their reports.

use std::path::Path;

use anyhow::{Context, Result};
use fluoropose_report::{Group, Knee, group_figure, read, write};

use super::out::{make_folder, write_cycles};
use crate::files::{name_of, read_text, write_text};

pub(super) fn run(tables: &[String], out: &Path) -> Result<()> {
    let group = group(tables, name_of(out))?;
    make_folder(out)?;
    write_text(&out.join("group.csv"), &write::group_table(&group))?;
    write_text(&out.join("figure.svg"), &group_figure(&group))?;
    write_cycles(out, &group.films())?;
    let (knees, films) = (group.knees().len(), group.films().len());
    println!("{knees} knees with {films} films");
    for film in group.films() {
        for told in film.impossibilities() {
            println!("{}: {told}", film.name);
        }
    }
    println!("{}", out.join("figure.svg").display());
    Ok(())
}

/// Of words `KNEE=FILE`; tables of one knee stand together, in the order in which knees are first named.
fn group(tables: &[String], name: String) -> Result<Group> {
    let mut knees: Vec<Knee> = Vec::new();
    for words in tables {
        let (knee, file) = words.split_once('=').with_context(|| {
            format!("{words} does not say whose knee it is: write KNEE={words}")
        })?;
        let film =
            read::film(&read_text(Path::new(file))?).with_context(|| format!("in {file}"))?;
        match knees.iter_mut().find(|known| known.name == knee) {
            Some(known) => known.films.push(film),
            None => knees.push(Knee {
                name: knee.to_owned(),
                films: vec![film],
            }),
        }
    }
    Ok(Group::new(name, knees))
}
