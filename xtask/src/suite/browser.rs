//! The page: its types, its unit tests, and the whole of it in headless Chromium.

use std::path::Path;
use std::process::Command;

use anyhow::{Result, ensure};

use super::counts;
use super::report::Report;
use crate::setup::{command, node, programs};
use crate::static_server::Server;
use crate::{page, workspace};

const TYPES: &str = "browser: types of the page";
const UNITS: &str = "browser: unit tests of the page";
const CHROMIUM: &str = "browser: the page in Chromium";

/// Runs the suite.
pub fn run(report: &mut Report) {
    if !report.step("browser: page built", || {
        page::build().map(|_| String::new())
    }) {
        for name in [TYPES, UNITS, CHROMIUM] {
            report.skip(name, "the page was not built");
        }
        return;
    }
    let web = workspace::root().join("web");
    report.step(TYPES, || {
        command::run(&mut node::script(&web, "typecheck")?).map(|()| String::new())
    });
    report.step(UNITS, || {
        let (success, output) = command::tee(&mut node::script(&web, "test")?)?;
        ensure!(
            success,
            "the page's unit tests failed; their output above says where"
        );
        counts::of_vitest(&output)
    });
    report.step(CHROMIUM, || in_chromium(&web.join("dist")));
}

/// Serves the page and runs the tests of `tests/browser` against it.
fn in_chromium(dist: &Path) -> Result<String> {
    let folder = workspace::root().join("tests/browser");
    let node = node::node()?;
    let chromium = programs::chromium()?;
    node::install(&folder)?;
    let server = Server::start(dist, 0)?;
    let mut tests = Command::new(node);
    tests
        .args(["--test", "--test-reporter=spec"])
        .current_dir(&folder);
    tests
        .env("FLUOROPOSE_URL", server.url())
        .env("FLUOROPOSE_CHROMIUM", chromium);
    let (success, output) = command::tee(&mut tests)?;
    ensure!(
        success,
        "the tests in Chromium failed; their output above says where"
    );
    counts::of_node(&output)
}
