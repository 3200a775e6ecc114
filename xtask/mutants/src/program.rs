//! The way from a copy of the sources to which of some changes its tests miss.

use std::collections::{BTreeMap, HashSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, ensure};

use crate::change::Change;
use crate::crates::{self, Package, package};
use crate::switch::{self, FIRST};
use crate::trial::{self, Test};
use crate::weave::{Woven, weave};

/// What is changed, and by what it is tried.
#[derive(clap::Args)]
pub struct Options {
    /// How many, chosen at random
    #[arg(long, value_name = "N", default_value_t = 400)]
    pub sample: usize,
    /// Another choice
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// The crate that is changed and tested
    #[arg(long, value_name = "NAME", default_value = "fluoropose")]
    pub package: String,
    /// Only files whose path begins with this, as core/src/pose
    #[arg(long, value_name = "BEGINNING")]
    pub file: Vec<String>,
    /// Only tests of which the name has one of these parts, as pose::
    #[arg(long, value_name = "PART")]
    pub test: Vec<String>,
    /// Tests of this crate too, with all that are not unit tests
    #[arg(long, value_name = "NAME")]
    pub also: Vec<String>,
    /// Tests that take longer without a change are left out, and counted
    #[arg(long, value_name = "SECONDS", default_value_t = 20.0)]
    pub longest: f64,
    /// No change is begun after so long; those that were not tried are counted
    #[arg(long, value_name = "N", default_value_t = 120.0)]
    pub minutes: f64,
}

/// What became of a change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fate {
    Caught,
    Missed,
    /// No test comes there.
    Unreached,
    Untried,
}

/// Changes a copy of the sources and prints what its tests miss.
///
/// # Errors
/// For what cannot be read, and where tests fail without a change. A change that is missed is no error: it is listed.
pub fn run(root: &Path, options: &Options) -> Result<()> {
    let start = Instant::now();
    let root = &fs::canonicalize(root)?;
    let package = package(root, &options.package)?;
    let mut all = crates::changes(root, &package)?;
    all.retain(|change| {
        options.file.is_empty()
            || options
                .file
                .iter()
                .any(|begin| change.file.starts_with(begin.as_str()))
    });
    ensure!(!all.is_empty(), "nothing can be changed there");
    let count = all.len();
    let mut chosen = sample(all, options.sample, options.seed);
    chosen.sort_by(|a, b| (&a.file, a.line).cmp(&(&b.file, b.line)));
    println!(
        "{} of {count} changes of {}, seed {}",
        chosen.len(),
        package.name,
        options.seed
    );
    switch::write(root, &package.manifest)?;
    let mut numbered: Vec<(usize, Change)> = chosen
        .into_iter()
        .enumerate()
        .map(|(at, change)| (FIRST + at, change))
        .collect();
    let unviable = compiled(root, &package, &mut numbered)?;
    println!(
        "{unviable} do not compile, {:.0} s",
        start.elapsed().as_secs_f64()
    );
    let tests = tests(root, options)?;
    let end = start + Duration::from_secs_f64((60.0 * options.minutes).clamp(0.0, 1e7));
    let fates = fates(&numbered, &tests, end)?;
    tell(&numbered, &fates, start.elapsed());
    Ok(())
}

/// Weaves the changes in, and takes those out again that do not compile; how many these are.
fn compiled(root: &Path, package: &Package, numbered: &mut Vec<(usize, Change)>) -> Result<usize> {
    let count = numbered.len();
    let mut originals: BTreeMap<String, String> = BTreeMap::new();
    for (_, change) in &*numbered {
        if !originals.contains_key(&change.file) {
            originals.insert(
                change.file.clone(),
                fs::read_to_string(root.join(&change.file))?,
            );
        }
    }
    loop {
        let woven = written(root, &originals, numbered)?;
        let check = [
            "check",
            "--tests",
            "--release",
            "--all-features",
            "--package",
            &package.name,
            "--lib",
        ];
        let refused = crates::refused(root, &check)?;
        if refused.is_empty() {
            return Ok(count - numbered.len());
        }
        let mut bad: HashSet<usize> = HashSet::new();
        for spans in &refused {
            let found = spans
                .iter()
                .find_map(|(file, bytes)| innermost(woven.get(file)?, bytes));
            bad.insert(
                found
                    .with_context(|| format!("without a change it does not compile: {spans:?}"))?,
            );
        }
        numbered.retain(|(number, _)| !bad.contains(number));
    }
}

/// Writes each file with its changes.
fn written(
    root: &Path,
    originals: &BTreeMap<String, String>,
    numbered: &[(usize, Change)],
) -> Result<BTreeMap<String, Woven>> {
    let mut all = BTreeMap::new();
    for (file, text) in originals {
        let own: Vec<(usize, &Change)> = numbered
            .iter()
            .filter(|(_, change)| change.file == *file)
            .map(|(number, change)| (*number, change))
            .collect();
        let woven = weave(text, &own);
        fs::write(root.join(file), &woven.text)?;
        all.insert(file.clone(), woven);
    }
    Ok(all)
}

/// The change with the smallest place around some bytes.
fn innermost(woven: &Woven, bytes: &std::ops::Range<usize>) -> Option<usize> {
    let around = woven
        .places
        .iter()
        .filter(|(_, place)| place.start <= bytes.start && bytes.end <= place.end);
    around
        .min_by_key(|(_, place)| place.len())
        .map(|(number, _)| *number)
}

/// The tests, compiled with the changes, and what each reaches.
fn tests(root: &Path, options: &Options) -> Result<Vec<Test>> {
    let start = Instant::now();
    let base = [
        "test",
        "--release",
        "--config",
        ".cargo/checked.toml",
        "--package",
    ];
    let mut programs: Vec<(PathBuf, PathBuf)> = Vec::new();
    let own = [&base[..], &[&options.package, "--lib", "--all-features"]].concat();
    programs.extend(crates::test_programs(root, &own)?);
    for also in &options.also {
        programs.extend(crates::test_programs(
            root,
            &[&base[..], &[also.as_str(), "--tests"]].concat(),
        )?);
    }
    println!("tests compiled, {:.0} s", start.elapsed().as_secs_f64());
    let longest = Duration::from_secs_f64(options.longest.clamp(0.0, 1e6));
    let (tests, long) = trial::recorded(&programs, &options.test, longest, &root.join("target"))?;
    let takes: Duration = tests.iter().map(|test| test.takes).sum();
    println!(
        "{} tests, one by one {:.0} s; {} take too long and are left out",
        tests.len(),
        takes.as_secs_f64(),
        long.len()
    );
    for name in long {
        println!("left out  {name}");
    }
    Ok(tests)
}

fn fates(numbered: &[(usize, Change)], tests: &[Test], end: Instant) -> Result<Vec<Fate>> {
    trial::by_all_processors(numbered, |_, (number, change)| {
        if !tests.iter().any(|test| test.reaches.contains(number)) {
            println!("unreached {change}");
            return Ok(Fate::Unreached);
        }
        if Instant::now() >= end {
            return Ok(Fate::Untried);
        }
        if trial::noticed(*number, tests)? {
            return Ok(Fate::Caught);
        }
        println!("missed    {change}");
        Ok(Fate::Missed)
    })
}

fn tell(numbered: &[(usize, Change)], fates: &[Fate], took: Duration) {
    let count = |fate| fates.iter().filter(|own| **own == fate).count();
    let (caught, missed, unreached) = (
        count(Fate::Caught),
        count(Fate::Missed),
        count(Fate::Unreached),
    );
    let tried = caught + missed + unreached;
    println!(
        "{tried} of {} tried in {:.0} min: {caught} caught, {missed} missed, {unreached} where no test comes; {:.1} % caught",
        numbered.len(),
        took.as_secs_f64() / 60.0,
        100.0 * caught as f64 / tried.max(1) as f64
    );
}

/// So many of some, none twice; the same for the same seed.
fn sample<T>(mut all: Vec<T>, count: usize, seed: u64) -> Vec<T> {
    // SplitMix64.
    let mut state = seed;
    let mut random = || {
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut mixed = state;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ (mixed >> 31)
    };
    let count = count.min(all.len());
    for at in 0..count {
        let left = (all.len() - at) as u64;
        all.swap(at, at + (random() % left) as usize);
    }
    all.truncate(count);
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sample_holds_nothing_twice_and_is_told_by_its_seed() {
        let all: Vec<usize> = (0..50).collect();
        let chosen = sample(all.clone(), 20, 7);
        assert_eq!(chosen, sample(all.clone(), 20, 7));
        assert_ne!(chosen, sample(all.clone(), 20, 8));
        let kinds: HashSet<usize> = chosen.iter().copied().collect();
        assert_eq!(kinds.len(), 20);
        let mut whole = sample(all.clone(), 99, 1);
        whole.sort_unstable();
        assert_eq!(whole, all);
    }
}
