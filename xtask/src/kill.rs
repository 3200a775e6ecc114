//! Verb `kill`: work in the page is ended in every way, again and again.

use anyhow::{Result, ensure};

use crate::driver::{self, Browser};

/// Options of `kill`.
#[derive(clap::Args)]
#[command(
    after_help = "Tabs, workers and browsers crash, storage is full, small or evicted, clocks go back, pages are reloaded and upgraded, all in the middle of \
random work. What comes back has to be a state of the work no older than the last that the page showed as saved, with its files; else it is lost, and the verb fails."
)]
pub(crate) struct Args {
    /// How many
    #[arg(long, value_name = "N", default_value_t = 200)]
    trials: u32,
    /// Other work
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u32,
    /// Only ways of which the name has this part, as "evicted"
    #[arg(long, value_name = "WORDS", default_value = "")]
    only: String,
    /// In Firefox, whose driver can kill the browser and load the page anew, and no more
    #[arg(long)]
    firefox: bool,
}

/// Runs the verb.
///
/// # Errors
/// For what cannot be built or driven, and where work was lost.
pub(crate) fn run(args: Args) -> Result<()> {
    let (trials, seed) = (args.trials.to_string(), args.seed.to_string());
    let browser = match args.firefox {
        true => Browser::Firefox,
        false => Browser::Chromium,
    };
    let words = ["kills/main.mjs", &trials, &seed, &args.only];
    let all_well = driver::drive_in(browser, &words)?;
    ensure!(
        all_well,
        "work was lost, or trials did not come to their end"
    );
    Ok(())
}
