//! The page as it is shipped, served and driven in a browser without a window by a program of `tests/browser`.

use std::ffi::OsStr;
use std::process::Command;

use anyhow::Result;

use crate::output::announce;
use crate::page::{self, Build};
use crate::setup::{node, programs};
use crate::static_server::Server;
use crate::{package, workspace};

/// Which browser.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Browser {
    Chromium,
    Firefox,
}

/// Builds what is needed and runs the program with these words in headless Chromium. True where it says that all went well.
///
/// # Errors
/// For what could not be had, built or started.
pub(crate) fn drive(words: &[impl AsRef<OsStr>]) -> Result<bool> {
    drive_in(Browser::Chromium, words)
}

/// The same in either browser.
///
/// # Errors
/// For what could not be had, built or started.
pub(crate) fn drive_in(browser: Browser, words: &[impl AsRef<OsStr>]) -> Result<bool> {
    let (name, variable, program) = match browser {
        Browser::Chromium => ("Chromium", "FLUOROPOSE_CHROMIUM", programs::chromium()?),
        Browser::Firefox => ("Firefox", "FLUOROPOSE_FIREFOX", programs::firefox()?),
    };
    let dist = page::build(Build::Shipped)?;
    package::make(&dist, &package::usual_folder())?;
    let folder = workspace::root().join("tests/browser");
    node::install(&folder)?;
    let server = Server::start(&dist, 0)?;
    announce(&format!("driving the page in {name}"));
    let mut driver = Command::new(node::node()?);
    driver
        .args(words)
        .current_dir(&folder)
        .env("FLUOROPOSE_URL", server.url())
        .env(variable, program)
        .env("FLUOROPOSE_PACKAGE", package::usual_folder());
    Ok(driver.status()?.success())
}
