//! Verb `soak`: random work in one page for long, and what it holds in memory.

use anyhow::{Result, ensure};

use crate::driver;

/// Options of `soak`.
#[derive(clap::Args)]
#[command(
    after_help = "Clicks, drags, films that are followed, undo, exports, new works, and a second page that is loaded anew. Every minute a new work is begun and \
what the page, its workers and WebAssembly hold then is printed. The verb fails where at the end one of them is over 5 percent more than after 5 minutes."
)]
pub(crate) struct Args {
    /// How long
    #[arg(long, value_name = "N", default_value_t = 30)]
    minutes: u32,
    /// Other work
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u32,
}

/// Runs the verb.
///
/// # Errors
/// For what cannot be built or driven, and where memory grew.
pub(crate) fn run(args: Args) -> Result<()> {
    let (minutes, seed) = (args.minutes.to_string(), args.seed.to_string());
    let is_flat = driver::drive(&["soak/main.mjs", &minutes, &seed])?;
    ensure!(is_flat, "memory grew, or the work did not come to its end");
    Ok(())
}
