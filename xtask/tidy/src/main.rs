//! The check by itself, for a folder other than that of the running cargo: `tidy [--root FOLDER]
//! [--graph FOLDER] [--long]`.

use std::io::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use fluoropose_tidy::Findings;

fn main() -> ExitCode {
    match run() {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

const USAGE: &str = "tidy [--root FOLDER] [--graph FOLDER] [--long]";

/// Whether nothing is wrong.
fn run() -> Result<bool> {
    let mut root = PathBuf::from(".");
    let (mut wanted, mut long_counts) = (None, false);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        let mut value = || {
            arguments
                .next()
                .with_context(|| format!("{argument} needs a folder; {USAGE}"))
        };
        match argument.as_str() {
            "--root" => root = value()?.into(),
            "--graph" => wanted = Some(value()?),
            "--long" => long_counts = true,
            _ => bail!("`{argument}` is not understood; {USAGE}"),
        }
    }
    if let Some(folder) = wanted {
        say(&fluoropose_tidy::graph_text(&root, &folder)?);
        return Ok(true);
    }
    Ok(report(&fluoropose_tidy::check(&root)?, long_counts))
}

/// Prints what was found; long files and functions one by one only when they count. Whether nothing is wrong.
fn report(findings: &Findings, long_counts: bool) -> bool {
    for error in &findings.errors {
        say(&format!("error: {error}\n"));
    }
    if long_counts {
        for long in &findings.long {
            say(&format!("too long: {long}\n"));
        }
    }
    let long = findings.long.len();
    let (counted, hint) = match long_counts {
        true => (long, ""),
        false => (0, " (--long lists them and makes them errors)"),
    };
    let errors = findings.errors.len() + counted;
    say(&format!(
        "{errors} errors; {long} files or functions that are long{hint}\n"
    ));
    errors == 0
}

/// Prints; where nobody reads on, as behind `| head`, nothing is lost by that.
fn say(text: &str) {
    let _ = std::io::stdout().write_all(text.as_bytes());
}
