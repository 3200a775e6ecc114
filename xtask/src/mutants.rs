//! Verb `mutants`: changes of the sources, one at a time, that the tests have to notice.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail, ensure};

use crate::output::announce;
use crate::setup::command;
use crate::setup::rust_target::own_cargo;
use crate::{sources, workspace};

/// What makes the changes and runs the tests.
const CARGO_MUTANTS: &str = "27.1.0";

/// A test that takes so many times as long as without a change goes round in a circle.
const MOST_TIMES: u32 = 5;
const LEAST_LIMIT: Duration = Duration::from_secs(60);

/// Options of `mutants`.
#[derive(clap::Args)]
#[command(
    after_help = "Functions return something else, comparisons and signs are exchanged, arms of a match are taken out (cargo-mutants, installed below target/mutants). A change counts as \
caught where the package's own unit tests fail or go round in a circle; tests of other crates may catch what they miss. They run in a copy of the sources below target/mutants.\n\n\
Example: cargo xtask mutants --sample 40 --minutes 30 --file 'core/src/pose/*.rs'"
)]
pub(crate) struct Args {
    /// How many, chosen at random
    #[arg(long, value_name = "N", default_value_t = 20)]
    sample: usize,
    /// Another choice
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// The crate that is changed and tested
    #[arg(long, value_name = "NAME", default_value = "fluoropose")]
    package: String,
    /// Only files of these names, as 'core/src/pose/*.rs'
    #[arg(long, value_name = "PATTERN")]
    file: Vec<String>,
    /// Only unit tests of which the name has one of these parts, as 'pose::': sooner done, and what others catch is missed
    #[arg(long, value_name = "PART")]
    test: Vec<String>,
    /// No change is begun after so long; those that were not tried are counted
    #[arg(long, value_name = "N", default_value_t = 60.0)]
    minutes: f64,
}

/// What became of a change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fate {
    Caught,
    Missed,
    /// It does not compile.
    Unviable,
}

/// Runs the verb.
///
/// # Errors
/// For what cannot be installed, and where tests fail without a change. A change that is missed is no error: it is listed.
pub(crate) fn run(args: Args) -> Result<()> {
    let start = Instant::now();
    let end = start + Duration::from_secs_f64((60.0 * args.minutes).clamp(0.0, 1e7));
    let program = installed()?;
    let folder = workspace::target_dir().join("mutants");
    let sources = folder.join("sources");
    sources::copy(&sources)?;
    let all = listed(&program, &sources, &args)?;
    let chosen = sample(all.clone(), args.sample, args.seed);
    let tests = tests_of(&args);
    let limit = limit_of(&args.package, &tests, &sources)?;
    println!(
        "{} of {} changes of {}, seed {}; tests may take {} s",
        chosen.len(),
        all.len(),
        args.package,
        args.seed,
        limit.as_secs()
    );
    let mut fates = Vec::new();
    for name in &chosen {
        if Instant::now() >= end {
            break;
        }
        let fate = tried(
            &program,
            (&sources, &folder),
            (&args.package, &tests),
            name,
            limit,
        )?;
        println!("{:<9} {name}", format!("{fate:?}").to_lowercase());
        fates.push((name, fate));
    }
    tell(&fates, chosen.len(), start.elapsed());
    Ok(())
}

fn tell(fates: &[(&String, Fate)], chosen: usize, took: Duration) {
    let count = |fate| fates.iter().filter(|(_, own)| *own == fate).count();
    let (caught, missed) = (count(Fate::Caught), count(Fate::Missed));
    println!(
        "{} of {chosen} tried in {:.0} min: {caught} caught, {missed} missed, {} do not compile; {:.0} % caught of those that do",
        fates.len(),
        took.as_secs_f64() / 60.0,
        count(Fate::Unviable),
        100.0 * caught as f64 / (caught + missed).max(1) as f64
    );
    for (name, _) in fates.iter().filter(|(_, fate)| *fate == Fate::Missed) {
        println!("missed    {name}");
    }
}

/// The program, installed where it is not there.
fn installed() -> Result<PathBuf> {
    let root = workspace::target_dir().join("mutants");
    let program = root.join(format!("bin/cargo-mutants{}", std::env::consts::EXE_SUFFIX));
    let version = || command::output(Command::new(&program).args(["mutants", "--version"]));
    if version().is_ok_and(|said| said.trim().ends_with(CARGO_MUTANTS)) {
        return Ok(program);
    }
    announce(&format!("installing cargo-mutants {CARGO_MUTANTS}"));
    let mut install = own_cargo();
    install.args(["install", "cargo-mutants", "--locked", "--debug", "--force"]);
    install.args(["--version", &format!("={CARGO_MUTANTS}")]);
    install.arg("--root").arg(&root);
    command::run(install.env("CARGO_TARGET_DIR", root.join("build")))?;
    Ok(program)
}

/// The names of all changes of a package, in order.
fn listed(program: &Path, sources: &Path, args: &Args) -> Result<Vec<String>> {
    let mut list = mutants(program, sources, &args.package);
    list.arg("--list");
    for file in &args.file {
        list.args(["--file", file]);
    }
    let said = command::output(&mut list)?;
    let mut names: Vec<String> = said.lines().map(str::to_owned).collect();
    names.retain(|name| name.contains(".rs:"));
    names.sort();
    ensure!(!names.is_empty(), "nothing can be changed there");
    Ok(names)
}

/// Cargo with the changes of a package. Those that leave a field out are left out: they are made whatever name is asked for.
fn mutants(program: &Path, sources: &Path, package: &str) -> Command {
    let mut command = Command::new(program);
    command.current_dir(sources).arg("mutants");
    command.args(["--exclude-re", "delete field .* from struct"]);
    command.args(["--package", package, "--colors", "never"]);
    command.env("CARGO_TARGET_DIR", sources.join("target"));
    command
}

/// So many of some names, none twice; the same for the same seed.
fn sample(mut names: Vec<String>, count: usize, seed: u64) -> Vec<String> {
    // SplitMix64.
    let mut state = seed;
    let mut random = || {
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut mixed = state;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ (mixed >> 31)
    };
    let count = count.min(names.len());
    for at in 0..count {
        let left = (names.len() - at) as u64;
        names.swap(at, at + (random() % left) as usize);
    }
    names.truncate(count);
    names
}

/// How long tests may take: some times as long as without a change, with which they have to pass.
fn limit_of(package: &str, tests: &[&str], sources: &Path) -> Result<Duration> {
    announce(&format!("the unit tests of {package} without a change"));
    let test = |tests: &[&str]| {
        let mut cargo = own_cargo();
        cargo.current_dir(sources);
        cargo.args(["test", "--package", package]).args(tests);
        cargo.env("CARGO_TARGET_DIR", sources.join("target"));
        command::run(&mut cargo)
    };
    test(&[&UNIT_TESTS[..], &["--no-run"]].concat())?;
    let start = Instant::now();
    test(&[&UNIT_TESTS[..], tests].concat())?;
    Ok((start.elapsed() * MOST_TIMES).max(LEAST_LIMIT))
}

/// What cargo is told of the tests of a package.
const UNIT_TESTS: [&str; 2] = ["--lib", "--all-features"];

fn tests_of(args: &Args) -> Vec<&str> {
    let names = args.test.iter().map(String::as_str);
    ["--"].into_iter().chain(names).collect()
}

/// Makes one change and runs the tests.
fn tried(
    program: &Path,
    (sources, folder): (&Path, &Path),
    (package, tests): (&str, &[&str]),
    name: &str,
    limit: Duration,
) -> Result<Fate> {
    let out = folder.join("last");
    let mut one = mutants(program, sources, package);
    one.args([
        "--in-place",
        "--baseline",
        "skip",
        "--no-shuffle",
        "--level",
        "error",
    ]);
    one.args(["--timeout", &limit.as_secs().to_string()]);
    one.arg("--output").arg(&out);
    one.args(["--re", &format!("^{}$", escaped(name))]);
    let file = name.split(':').next().unwrap_or_default();
    one.args(["--file", file]);
    // Examples are not built for it.
    one.args(UNIT_TESTS.map(|option| format!("--cargo-arg={option}")));
    one.arg("--").args(tests);
    // Its exit code tells of several changes; here there is one.
    let said = one.output().context("cargo-mutants cannot be started")?;
    let has = |list: &str| {
        let text = fs::read_to_string(out.join("mutants.out").join(list));
        text.is_ok_and(|text| !text.trim().is_empty())
    };
    let fates = [
        ("caught.txt", Fate::Caught),
        ("timeout.txt", Fate::Caught),
        ("missed.txt", Fate::Missed),
        ("unviable.txt", Fate::Unviable),
    ];
    let fate = fates.into_iter().find(|(list, _)| has(list));
    let Some((_, fate)) = fate else {
        let errors = String::from_utf8_lossy(&said.stderr);
        bail!("cargo-mutants did not try `{name}`: {}", errors.trim());
    };
    fs::remove_dir_all(&out).with_context(|| format!("cannot remove {}", out.display()))?;
    Ok(fate)
}

/// A regular expression of a text.
fn escaped(text: &str) -> String {
    let letter = |letter: char| match letter.is_alphanumeric() || letter == ' ' {
        true => letter.to_string(),
        false => format!("\\x{{{:x}}}", u32::from(letter)),
    };
    text.chars().map(letter).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sample_holds_no_name_twice_and_is_told_by_its_seed() {
        let names: Vec<String> = (0..50).map(|number| format!("name {number}")).collect();
        let chosen = sample(names.clone(), 20, 7);
        assert_eq!(chosen, sample(names.clone(), 20, 7));
        assert_ne!(chosen, sample(names.clone(), 20, 8));
        let mut kinds = chosen.clone();
        kinds.sort();
        kinds.dedup();
        assert_eq!(kinds.len(), 20);
        assert!(kinds.iter().all(|name| names.contains(name)));
        let mut all = sample(names.clone(), 99, 1);
        all.sort();
        let mut sorted = names;
        sorted.sort();
        assert_eq!(all, sorted);
    }

    #[test]
    fn letters_that_mean_something_are_written_as_numbers() {
        assert_eq!(
            escaped("a.rs:1: replace + with *"),
            "a\\x{2e}rs\\x{3a}1\\x{3a} replace \\x{2b} with \\x{2a}"
        );
    }
}
