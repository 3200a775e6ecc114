//! Verb `bench`: this machine at the core's work, beside what a user would otherwise take.

mod catalogue;
mod films;
mod native;
mod peers;
mod row;
mod studies;

use std::path::PathBuf;

use anyhow::{Result, ensure};

use crate::files::write_json;

/// Options of `bench`.
#[derive(clap::Args)]
#[command(
    after_help = "Speed beside FAISS, USearch, OpenCV, NumPy and VTK, which are installed with pip into a folder of their own. All work on \
the same data by turns; medians are printed, and whether the answers are the same."
)]
pub struct Args {
    /// Implants of the catalogue among which one is to be identified; building it takes about a second for each
    #[arg(long, value_name = "N", default_value_t = 500)]
    implants: usize,
    /// Folder of real studies (left8, film70), whose masks, models and films are measured too
    #[arg(long, value_name = "DIR")]
    studies: Option<PathBuf>,
    /// With --studies: those rows alone
    #[arg(long, requires = "studies")]
    studies_only: bool,
    /// Write the figures to this file too: {"rows": [{"work", "ours_ms", "peer", "peer_ms", "ratio", "same_answer"}]}
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Folder for the other libraries and for the data that all work on
    #[arg(long, value_name = "DIR", default_value = "target/bench")]
    work: PathBuf,
}

/// Runs the verb.
///
/// # Errors
/// For what cannot be drawn, searched or written. A peer that cannot be had is left out and said.
pub fn run(args: Args) -> Result<()> {
    ensure!(args.implants > 0, "a catalogue has at least one implant");
    let mut rows = Vec::new();
    if !args.studies_only {
        rows.extend(native::measure(args.implants, &args.work)?);
    }
    if let Some(studies) = &args.studies {
        rows.extend(studies::measure(studies)?);
        rows.extend(films::measure(studies, &args.work)?);
    }
    print_rows(&rows);
    write_json(args.json.as_deref(), &serde_json::json!({ "rows": rows }))
}

fn print_rows(rows: &[row::Row]) {
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
