//! The files of a folder of frames or masks.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};

use super::name_order::{Piece, name_order, pieces};
use super::text::name_of;

/// What systems put into folders by themselves, in small letters; so are names that begin with a point.
const OF_SYSTEMS: [&str; 4] = ["thumbs.db", "ehthumbs.db", "desktop.ini", "icon\r"];

/// Fewer files do not tell that one is missing among them.
const ENOUGH: usize = 4;
/// Missing files that are named.
const NAMED: usize = 3;

/// The files of a folder in the order of their names ([`name_order`]): the order of the frames. Files that systems put there are passed over.
///
/// # Errors
/// When the folder cannot be listed or holds no file.
pub fn files_in(folder: &Path) -> Result<Vec<PathBuf>> {
    let entries =
        fs::read_dir(folder).with_context(|| format!("cannot list {}", folder.display()))?;
    let mut files: Vec<(String, PathBuf)> = entries
        .map(|entry| entry.map(|entry| entry.path()))
        .map(|path| path.map(|path| (name_of(&path), path)))
        .collect::<Result<_, _>>()
        .with_context(|| format!("cannot list {}", folder.display()))?;
    files.retain(|(name, path)| path.is_file() && !is_of_system(name));
    files.sort_by(|(a, _), (b, _)| name_order(a, b));
    if files.is_empty() {
        bail!("{} holds no files", folder.display());
    }
    Ok(files.into_iter().map(|(_, path)| path).collect())
}

fn is_of_system(name: &str) -> bool {
    name.starts_with('.') || OF_SYSTEMS.contains(&name.to_lowercase().as_str())
}

/// What files that are numbered evenly but for gaps lack, a sentence without its full stop: poses of neighbours are taken to be near each
/// other, and times to be even. `files` are in their order.
pub fn gaps_in(files: &[PathBuf]) -> Option<String> {
    let names: Vec<String> = files.iter().map(|path| name_of(path)).collect();
    let numbers = running_numbers(&names)?;
    let steps: Vec<u64> = numbers.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let step = *steps.iter().min()?;
    let even = steps.iter().filter(|&&other| other == step).count();
    let gaps: Vec<usize> = (0..steps.len()).filter(|&at| steps[at] != step).collect();
    let is_even = names.len() >= ENOUGH && step > 0 && 2 * even > steps.len();
    if !is_even || gaps.is_empty() || !steps.iter().all(|other| other.is_multiple_of(step)) {
        return None;
    }
    let missing: u64 = gaps.iter().map(|&at| steps[at] / step - 1).sum();
    let between = |&at: &usize| format!("{} and {}", names[at], names[at + 1]);
    let named: Vec<String> = gaps.iter().take(NAMED).map(between).collect();
    let more = match gaps.len() - named.len() {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    Some(format!(
        "{missing} of the numbered files {} missing, between {}{more}: the frames at hand are taken for neighbours at even times",
        if missing == 1 { "is" } else { "are" },
        named.join(", ")
    ))
}

/// The number that tells names apart, where that is all that does.
fn running_numbers(names: &[String]) -> Option<Vec<u64>> {
    let all: Vec<Vec<Piece>> = names.iter().map(|name| pieces(name).collect()).collect();
    let (first, others) = all.split_first()?;
    let differs = |at: usize| others.iter().any(|other| other.get(at) != first.get(at));
    let mut differing = (0..first.len()).filter(|&at| differs(at));
    let (Some(at), None) = (differing.next(), differing.next()) else {
        return None;
    };
    let number = |pieces: &Vec<Piece>| match pieces.get(at) {
        // No digits are 0.
        Some(Piece::Number(_, digits)) if digits.is_empty() => Some(0),
        Some(Piece::Number(_, digits)) => digits.parse().ok(),
        _ => None,
    };
    let numbers = all
        .iter()
        .map(|pieces| number(pieces).filter(|_| pieces.len() == first.len()));
    numbers.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_stand_by_their_numbers_and_what_systems_left_is_none() {
        let folder = std::env::temp_dir().join(format!("fluoropose-listed-{}", std::process::id()));
        fs::create_dir_all(folder.join("f3.png")).unwrap();
        for name in [
            "f10.png",
            "f2.png",
            "f1.png",
            "Thumbs.db",
            ".DS_Store",
            "desktop.ini",
        ] {
            fs::write(folder.join(name), name).unwrap();
        }
        let files = files_in(&folder).unwrap();
        fs::remove_dir_all(&folder).unwrap();
        let names: Vec<String> = files.iter().map(|path| name_of(path)).collect();
        assert_eq!(names, ["f1.png", "f2.png", "f10.png"]);
    }

    #[test]
    fn what_is_missing_among_numbers_is_told() {
        let of = |numbers: &[u32]| {
            let path = |number: &u32| PathBuf::from(format!("a/k2_{number:03}.png"));
            gaps_in(&numbers.iter().map(path).collect::<Vec<_>>())
        };
        let told = of(&[0, 1, 2, 3, 4, 6, 7]).unwrap();
        assert!(
            told.starts_with(
                "1 of the numbered files is missing, between k2_004.png and k2_006.png:"
            ),
            "{told}"
        );
        let told = of(&[0, 4, 8, 20, 24, 28, 36]).unwrap();
        assert!(
            told.starts_with("3 of the numbered files are missing"),
            "{told}"
        );
        // Even steps, no steps that anybody meant, too few.
        for numbers in [
            &[5, 6, 7, 8][..],
            &[0, 4, 8, 12],
            &[0, 3, 4, 9, 11],
            &[1, 2, 5],
        ] {
            assert_eq!(of(numbers), None, "{numbers:?}");
        }
        assert_eq!(
            gaps_in(&["a1.png", "b2.png", "c4.png", "d5.png"].map(PathBuf::from)),
            None
        );
    }
}
