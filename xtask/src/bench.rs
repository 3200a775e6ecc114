//! Verb `bench`: figures of speed and size, printed and written as JSON.

use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result, ensure};
use serde::{Deserialize, Serialize};

mod browser;
mod catalogue;
mod native;
mod peers;

/// Options of `bench`.
#[derive(clap::Args)]
#[command(
    after_help = "Without --browser: this machine's speed beside FAISS, USearch, OpenCV, NumPy and VTK, which are installed with pip into a folder of \
their own under target/. All work on the same data by turns; medians are printed, and whether the answers are the same."
)]
pub struct Args {
    /// The page in headless Chromium: frame times, clicks and seconds to a pose, bytes of the first load
    #[arg(long)]
    browser: bool,
    /// Implants of the catalogue among which one is to be identified; building it takes about a second for each
    #[arg(long, value_name = "N", default_value_t = 500)]
    implants: usize,
    /// Write the figures to this file too: {"rows": [{"work", "ours_ms", "peer", "peer_ms", "ratio", "same_answer"}]}, with --browser
    /// {"rows": [{"work", "value", "unit"}]}
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// Figures in the order in which they were taken.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct Figures {
    /// One for each piece of work.
    pub rows: Vec<Row>,
}

/// One figure.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// What was measured, in words.
    pub work: String,
    /// How much.
    pub value: f64,
    /// Of what: "ms", "s", "bytes", "clicks".
    pub unit: String,
}

/// Runs the verb.
///
/// # Errors
/// For what cannot be built, driven or written. A peer that cannot be had is left out and said.
pub fn run(args: Args) -> Result<()> {
    let text = if args.browser {
        let figures = browser::measure()?;
        print(&figures);
        serde_json::to_string_pretty(&figures)?
    } else {
        ensure!(args.implants > 0, "a catalogue has at least one implant");
        let rows = native::measure(args.implants)?;
        print_rows(&rows);
        serde_json::to_string_pretty(&serde_json::json!({ "rows": rows }))?
    };
    if let Some(file) = args.json {
        fs::write(&file, text + "\n")
            .with_context(|| format!("cannot write {}", file.display()))?;
    }
    Ok(())
}

fn print_rows(rows: &[native::Row]) {
    for row in rows {
        let peer = match (row.peer_ms, row.ratio, row.same_answer) {
            (Some(ms), Some(ratio), Some(same)) => {
                let same = if same {
                    "same answer"
                } else {
                    "ANOTHER ANSWER"
                };
                format!("{} {ms:.3} ms: {ratio:.1} x, {same}", row.peer)
            }
            _ => row.peer.clone(),
        };
        println!("{}: {:.4} ms; {peer}", row.work, row.ours_ms);
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
