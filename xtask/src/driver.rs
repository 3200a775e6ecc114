//! The page as it is shipped, served and driven in headless Chromium by a program of `tests/browser`.

use std::ffi::OsStr;
use std::process::Command;

use anyhow::Result;

use crate::output::announce;
use crate::page::{self, Build};
use crate::setup::{node, programs};
use crate::static_server::Server;
use crate::{package, workspace};

/// Builds what is needed and runs the program with these words. True where it says that all went well.
///
/// # Errors
/// For what could not be had, built or started.
pub(crate) fn drive(words: &[impl AsRef<OsStr>]) -> Result<bool> {
    let chromium = programs::chromium()?;
    let dist = page::build(Build::Shipped)?;
    package::make(&dist, &package::usual_folder())?;
    let folder = workspace::root().join("tests/browser");
    node::install(&folder)?;
    let server = Server::start(&dist, 0)?;
    announce("driving the page in Chromium");
    let mut driver = Command::new(node::node()?);
    driver
        .args(words)
        .current_dir(&folder)
        .env("FLUOROPOSE_URL", server.url())
        .env("FLUOROPOSE_CHROMIUM", chromium)
        .env("FLUOROPOSE_PACKAGE", package::usual_folder());
    Ok(driver.status()?.success())
}
