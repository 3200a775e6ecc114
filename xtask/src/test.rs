//! Verb `test`: sets up what is missing, runs the suites and sums them up.

use anyhow::{Result, ensure};

use crate::suite::report::Report;
use crate::suite::{browser, firmware, native};

/// Options of `test`.
///
/// Without an option every suite runs. What a suite needs (Rust targets, npm packages, Chromium, QEMU) is
/// installed where that is possible. What could not be had gives one line, and its steps count as skipped;
/// with CI=true they count as failed, unless getting it was tried and its source did not have it.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Formatting, lints and the Rust tests on this machine
    #[arg(long)]
    native: bool,
    /// The page: types, unit tests, and the whole of it in headless Chromium
    #[arg(long)]
    browser: bool,
    /// The Cortex-M4F application under QEMU, compared with this machine line by line
    #[arg(long)]
    firmware: bool,
}

impl Args {
    /// Every suite.
    pub(crate) fn everything() -> Self {
        Self {
            native: true,
            browser: true,
            firmware: true,
        }
    }
}

/// Runs the verb.
pub(crate) fn run(args: Args) -> Result<()> {
    let nothing_chosen = !(args.native || args.browser || args.firmware);
    let mut report = Report::new();
    if args.native || nothing_chosen {
        native::run(&mut report);
    }
    if args.firmware || nothing_chosen {
        firmware::run(&mut report);
    }
    if args.browser || nothing_chosen {
        browser::run(&mut report);
    }
    print!("{report}");
    ensure!(
        !report.has_failed(),
        "some steps failed; the lines marked FAILED above say which"
    );
    Ok(())
}
