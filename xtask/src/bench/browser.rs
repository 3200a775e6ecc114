//! The page measured in headless Chromium, by the program that `tests/browser/bench` holds.

use std::ffi::OsStr;
use std::fs;

use anyhow::{Context, Result, ensure};

use super::figures::Figures;
use crate::{driver, workspace};

/// Builds the page, serves it and has it driven.
///
/// Errors when something that is needed could not be had, or when the page does not do what is to be measured.
pub(super) fn measure() -> Result<Figures> {
    let file = workspace::target_dir().join("bench-browser.json");
    let words = [OsStr::new("bench/main.mjs"), file.as_os_str()];
    ensure!(driver::drive(&words)?, "the page could not be measured");
    let text =
        fs::read_to_string(&file).with_context(|| format!("cannot read {}", file.display()))?;
    serde_json::from_str(&text).context("the measurements are not in the form agreed upon")
}
