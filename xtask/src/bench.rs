//! Verb `bench`: figures of speed and size, printed and written as JSON.

use std::ffi::OsString;
use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result};

mod browser;
mod figures;

use crate::{laboratory, workspace};
use figures::{Figures, Row};

/// Options of `bench`.
#[derive(clap::Args)]
#[command(
    after_help = "Without --browser: this machine's speed beside FAISS, USearch, OpenCV, NumPy and VTK, which are installed with pip into a folder of \
their own under target/. All work on the same data by turns; medians are printed, and whether the answers are the same."
)]
pub(crate) struct Args {
    /// The page in headless Chromium: frame times, clicks and seconds to a pose, bytes of the first load
    #[arg(long)]
    browser: bool,
    /// Implants of the catalogue among which one is to be identified; building it takes about a second for each
    #[arg(long, value_name = "N", default_value_t = 500)]
    implants: usize,
    /// Folder of real studies (left8, film70), whose masks and models are measured too
    #[arg(long, value_name = "DIR")]
    studies: Option<PathBuf>,
    /// With --studies: those rows alone
    #[arg(long, requires = "studies")]
    studies_only: bool,
    /// Write the figures to this file too: {"rows": [{"work", "ours_ms", "peer", "peer_ms", "ratio", "same_answer"}]}, with --browser
    /// {"rows": [{"work", "value", "unit"}]}
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// Runs the verb.
///
/// # Errors
/// For what cannot be built, driven or written. A peer that cannot be had is left out and said.
pub(crate) fn run(args: Args) -> Result<()> {
    if !args.browser {
        return laboratory::run("bench", &args.for_the_laboratory());
    }
    let figures = browser::measure()?;
    print(&figures);
    if let Some(file) = args.json {
        let text = serde_json::to_string_pretty(&figures)? + "\n";
        fs::write(&file, text).with_context(|| format!("cannot write {}", file.display()))?;
    }
    Ok(())
}

impl Args {
    /// What the laboratory's verb of the same name is asked for.
    fn for_the_laboratory(&self) -> Vec<OsString> {
        let work = workspace::target_dir().join("bench");
        let mut words: Vec<OsString> = vec!["--implants".into(), self.implants.to_string().into()];
        words.extend(["--work".into(), work.into()]);
        if let Some(studies) = &self.studies {
            words.extend(["--studies".into(), studies.into()]);
        }
        if self.studies_only {
            words.push("--studies-only".into());
        }
        if let Some(file) = &self.json {
            words.extend(["--json".into(), file.into()]);
        }
        words
    }
}

fn print(figures: &Figures) {
    let widest = figures
        .rows
        .iter()
        .map(|row| row.work.chars().count())
        .max();
    for Row { work, value, unit } in &figures.rows {
        println!(
            "{work:<width$}  {value:>10} {unit}",
            width = widest.unwrap_or(0)
        );
    }
}
