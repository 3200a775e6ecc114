//! The page measured in headless Chromium, by the program that `tests/browser/bench` holds.

use std::fs;
use std::process::Command;

use anyhow::{Context, Result};

use super::figures::Figures;
use crate::output::announce;
use crate::page::{self, Build};
use crate::setup::{command, node, programs};
use crate::static_server::Server;
use crate::{package, workspace};

/// Builds the page, serves it and has it driven.
///
/// Errors when something that is needed could not be had, or when the page does not do what is to be measured.
pub(super) fn measure() -> Result<Figures> {
    let chromium = programs::chromium()?;
    let dist = page::build(Build::Shipped)?;
    package::make(&dist, &package::usual_folder())?;
    let folder = workspace::root().join("tests/browser");
    node::install(&folder)?;
    let server = Server::start(&dist, 0)?;
    let file = workspace::target_dir().join("bench-browser.json");
    announce("driving the page in Chromium");
    let mut driver = Command::new(node::node()?);
    driver.arg("bench/main.mjs").arg(&file).current_dir(&folder);
    driver
        .env("FLUOROPOSE_URL", server.url())
        .env("FLUOROPOSE_CHROMIUM", chromium)
        .env("FLUOROPOSE_PACKAGE", package::usual_folder());
    command::run(&mut driver)?;
    let text =
        fs::read_to_string(&file).with_context(|| format!("cannot read {}", file.display()))?;
    serde_json::from_str(&text).context("the measurements are not in the form agreed upon")
}
