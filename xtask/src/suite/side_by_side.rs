//! Suites beside each other: compilers fill what browsers and downloads leave of the processor.

use std::thread;

use super::report::{Report, Steps};
use super::{browser, firmware, native};
use crate::output::Lane;
use crate::setup::{node, programs};
use crate::workspace;

/// Which suites run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Chosen {
    /// Formatting, lints and the Rust tests on this machine.
    pub native: bool,
    /// The application under QEMU.
    pub firmware: bool,
    /// The page.
    pub browser: bool,
}

impl Chosen {
    /// Every suite.
    pub(crate) const ALL: Self = Self {
        native: true,
        firmware: true,
        browser: true,
    };

    /// Whether there is one.
    pub(crate) fn any(self) -> bool {
        self.native || self.firmware || self.browser
    }
}

/// Runs the suites, each in a lane of its own; the report has them in their order.
pub(crate) fn run(chosen: Chosen) -> Report {
    let lane = |name, gives_way| Lane { name, gives_way };
    let suites: [(bool, Steps); 3] = [
        (chosen.native, (lane("native", 10), &native::run)),
        // It is done long before the native suite, which nothing is to hold up.
        (chosen.firmware, (lane("firmware", 15), &firmware::run)),
        // Its tests have clocks.
        (chosen.browser, (lane("browser", 0), &browser::run)),
    ];
    let suites = suites.into_iter().filter(|(chosen, _)| *chosen);
    let suites: Vec<Steps> = suites.map(|(_, suite)| suite).collect();
    let mut report = Report::new();
    match suites.as_slice() {
        [] => {}
        [(_, run)] => run(&mut report),
        several => thread::scope(|scope| {
            scope.spawn(|| lane("fetch", 10).work(|| fetch(chosen)));
            report.side_by_side(several);
        }),
    }
    report
}

/// Fetches what later steps need from elsewhere, while the first ones compile. What could not be had is told by the step
/// that wants it.
fn fetch(chosen: Chosen) {
    if chosen.firmware {
        let _ = programs::qemu_arm();
    }
    if chosen.browser {
        let _ = programs::chromium();
        let _ = programs::firefox();
        let _ = node::install(&workspace::root().join("tests/browser"));
    }
}
