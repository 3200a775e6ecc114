//! Verb `test`: sets up what is missing, runs the suites and sums them up.

use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result, ensure};

use crate::clock::since_the_command;
use crate::suite::changed;
use crate::suite::side_by_side::{self, Chosen};
use crate::suite::{boards, browser, cluster, firmware, miri, python};

/// Options of `test`.
///
/// Without an option every suite runs, side by side: each line of output begins with its suite. What a suite needs (Rust targets, npm packages, Chromium, QEMU) is
/// installed where that is possible. What could not be had gives one line, and its steps count as skipped;
/// with CI=true they count as failed, unless getting it was tried and its source did not have it.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Formatting, lints and the Rust tests on this machine
    #[arg(long)]
    native: bool,
    /// The page: types, unit tests, and the whole of it in headless Chromium and Firefox; then what no other run has: tools in both
    #[arg(long)]
    browser: bool,
    /// The Cortex-M4F application under QEMU, compared with this machine line by line; then what no other run has: the same on a Cortex-M0+
    /// and a RISC-V, the example in C, and the core's tests on 32 bits
    #[arg(long)]
    firmware: bool,
    /// The Python package as a wheel in a clean environment: types, all tests, the notebook (a quick part is in --native)
    #[arg(long)]
    python: bool,
    /// Batches on a Slurm of one node, set up here as root
    #[arg(long)]
    cluster: bool,
    /// Undefined behaviour and the other order of bytes: kernels and the core's readers in Miri, an interpreter
    #[arg(long)]
    miri: bool,
    /// With --firmware: write what the board took to this file too, {"rows": [{"board", "work", "value", "unit"}]}
    #[arg(long, value_name = "FILE", requires = "firmware")]
    json: Option<PathBuf>,
    /// For work in progress: only what differs from the branch's origin can touch, and says what is left out
    #[arg(long, conflicts_with_all = ["native", "browser", "firmware", "python", "cluster", "miri"])]
    changed: bool,
    /// With --changed: what differs from this revision instead
    #[arg(long, value_name = "REV", requires = "changed")]
    since: Option<String>,
}

impl Args {
    /// Every suite.
    pub(crate) fn everything() -> Self {
        Self {
            native: false,
            browser: false,
            // All three, none being named; other boards are for who asks for the firmware.
            firmware: false,
            python: false,
            cluster: false,
            miri: false,
            json: None,
            changed: false,
            since: None,
        }
    }

    fn chosen(&self) -> Chosen {
        let chosen = Chosen {
            native: self.native,
            firmware: self.firmware,
            browser: self.browser,
        };
        if chosen.any() || self.python || self.cluster || self.miri {
            chosen
        } else {
            Chosen::ALL
        }
    }
}

/// Runs the verb.
pub(crate) fn run(args: Args) -> Result<()> {
    let mut report = if args.changed {
        changed::run(args.since.as_deref())?
    } else {
        side_by_side::run(args.chosen())
    };
    if args.browser {
        browser::tools_in_chromium(&mut report);
    }
    if args.firmware {
        boards::run(&mut report);
    }
    if args.python {
        python::run(&mut report);
    }
    if args.cluster {
        cluster::run(&mut report);
    }
    if args.miri {
        miri::run(&mut report);
    }
    print!("{report}");
    if let Some(file) = args.json {
        let figures = firmware::figures();
        fs::copy(&figures, &file).with_context(|| format!("cannot write {}", file.display()))?;
    }
    let seconds = since_the_command().as_secs_f64();
    println!("{seconds:.0} s since the command was entered");
    ensure!(
        !report.has_failed(),
        "some steps failed; the lines marked FAILED above say which"
    );
    Ok(())
}
