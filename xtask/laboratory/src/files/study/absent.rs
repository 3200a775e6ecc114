//! Why a file that a study names is perhaps not there.

use std::path::Path;

use super::keys::distance;
use crate::files::text::name_of;

/// What is beside a path that leads nowhere and may be meant, to go behind its name; nothing where nothing is.
pub(super) fn why_absent(path: &Path) -> String {
    let (name, folder) = (name_of(path), path.parent().unwrap_or(Path::new("")));
    if name.contains(['*', '?']) {
        return ": patterns are not read, name the folder or one file".to_owned();
    }
    if of_elsewhere(path) {
        return ": that is a path of another system or of a person's own folder, write it from the study's folder".to_owned();
    }
    let beside = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let nearest = beside
        .map(|entry| name_of(&entry.path()))
        .filter_map(|other| Some((likeness(&name, &other)?, other)))
        .min();
    let Some((_, other)) = nearest else {
        return match folder.exists() || folder.as_os_str().is_empty() {
            true => String::new(),
            false => format!(": its folder {} is not there", folder.display()),
        };
    };
    match looks_alike(&other, &name) && other.to_lowercase() != name.to_lowercase() {
        // Letters with marks are written in two ways, and look alike.
        true => format!(
            ": {other:?} is there, which is written with other characters that look alike; copy its name"
        ),
        false => format!(": was {other:?} meant?"),
    }
}

/// Whether a drive's letter or a tilde stands in it, which lead nowhere here.
fn of_elsewhere(path: &Path) -> bool {
    let drive = |part: &str| part.len() == 2 && part.ends_with(':');
    path.iter()
        .filter_map(|part| part.to_str())
        .any(|part| drive(part) || part == "~")
}

/// How many letters make one name of another, where few do.
fn likeness(name: &str, other: &str) -> Option<usize> {
    let [small, theirs] = [name, other].map(str::to_lowercase);
    let stem = |name: &str| name.rsplit_once('.').map(|(stem, _)| stem.to_owned());
    let is_other_end = stem(&small).is_some() && stem(&small) == stem(&theirs);
    let letters = distance(&small, &theirs);
    let is_like =
        letters <= 2.min(name.chars().count() / 3) || is_other_end || looks_alike(&theirs, &small);
    is_like.then_some(letters)
}

fn looks_alike(one: &str, other: &str) -> bool {
    seen(one).is_some() && seen(one) == seen(other)
}

/// A name without letters that have marks, and without marks.
fn seen(name: &str) -> Option<String> {
    let is_decomposed = |letter: char| ('\u{300}'..'\u{370}').contains(&letter);
    let composed = name.chars().filter(|letter| !letter.is_ascii()).count();
    let mut letters: Vec<char> = Vec::new();
    for letter in name.chars() {
        match letter {
            // The letter that it stands on goes with it.
            mark if is_decomposed(mark) => drop(letters.pop()),
            plain if plain.is_ascii() => letters.push(plain),
            _ => {}
        }
    }
    (composed > 0).then(|| letters.into_iter().collect())
}
