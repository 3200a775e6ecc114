//! Verb `bench`: figures of speed and size, printed and written as JSON.

use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result, ensure};
use serde::{Deserialize, Serialize};

mod browser;

/// Options of `bench`.
#[derive(clap::Args)]
pub struct Args {
    /// The page in headless Chromium: frame times, clicks and seconds to a pose, bytes of the first load
    #[arg(long)]
    browser: bool,
    /// Write the figures to this file too, as {"rows": [{"work", "value", "unit"}]}
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
pub fn run(args: Args) -> Result<()> {
    ensure!(args.browser, "say what to measure: --browser");
    let figures = browser::measure()?;
    print(&figures);
    if let Some(file) = args.json {
        let text = serde_json::to_string_pretty(&figures)?;
        fs::write(&file, text + "\n")
            .with_context(|| format!("cannot write {}", file.display()))?;
    }
    Ok(())
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
