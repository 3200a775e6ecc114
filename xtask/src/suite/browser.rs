//! The page: its types, its unit tests, and the whole of it in headless Chromium and Firefox.

use std::path::PathBuf;
use std::process::Command;

use anyhow::Result;

use super::report::{Report, Said};
use super::{checked_profile, counts, test_files};
use crate::output::Lane;
use crate::page::{self, Build};
use crate::setup::{command, node, programs, telling};
use crate::static_server::Server;
use crate::{package, workspace};

const TYPES: &str = "browser: types of the page";
const UNITS: &str = "browser: unit tests of the page";
const PACKAGES: &str = "browser: packages of the page";
const CHROMIUM: &str = "browser: the page in Chromium";
const FIREFOX: &str = "browser: the page in Firefox";

/// What Firefox is driven by: the way from opening to a pose, every tool that has a pointer, and the keys. For most of the rest its driver has no words (downloads, dropped
/// files). Chromium has it too where somebody asks for this suite ([`tools_in_chromium`]), and where no Firefox is to be had.
///
/// All of it in one program: each start of Firefox takes 3.5 s of a processor.
const TOOLS: &str = "together/tools.mjs";

/// Runs the suite.
pub(crate) fn run(report: &mut Report) {
    if !report.step("browser: page built", || {
        page::build(Build::Shipped).map(|_| Said::default())
    }) {
        for name in [TYPES, UNITS, PACKAGES, FIREFOX, CHROMIUM] {
            report.skip(name, "the page was not built");
        }
        return;
    }
    let web = workspace::root().join("web");
    report.step(TYPES, || {
        Ok(command::run(&mut node::script(&web, "typecheck")?)?.into())
    });
    report.step(UNITS, || {
        let told = command::tee(&mut node::script(&web, "test")?)?;
        told.or_failed("a unit test of the page", telling::of_vitest)?;
        Ok(counts::of_vitest(&told.output)?.into())
    });
    report.step(PACKAGES, || {
        package::make(&dist(), &package::usual_folder()).map(|_| Said::default())
    });
    // Of an earlier page.
    let _ = std::fs::remove_dir_all(kept_libraries());
    // Beside each other: Chromium waits for the laboratory's program, which the native suite compiles meanwhile, and both wait for
    // screen frames most of the time.
    let lane = |name| Lane { name, gives_way: 0 };
    report.side_by_side(&[
        (lane("firefox"), &|report| {
            report.step(FIREFOX, in_firefox);
        }),
        (lane("chromium"), &|report| {
            report.step(CHROMIUM, in_chromium);
        }),
    ]);
}

fn dist() -> PathBuf {
    workspace::root().join("web/dist")
}

/// The tools in the other browser, too.
pub(crate) fn tools_in_chromium(report: &mut Report) {
    report.step("browser: tools in Chromium", || {
        drive_chromium(vec![TOOLS.to_owned()])
    });
}

fn in_chromium() -> Result<Said> {
    let mut files = test_files::all_in(&folder())?;
    if programs::firefox().is_ok() {
        files.retain(|file| file != TOOLS);
    }
    drive_chromium(files)
}

fn drive_chromium(files: Vec<String>) -> Result<Said> {
    let (chromium, laboratory) = (programs::chromium()?, checked_profile::laboratory()?);
    drive(files, 3, &|tests| {
        // What the page writes is compared with what the command does.
        tests
            .env("FLUOROPOSE_CHROMIUM", &chromium)
            .env("FLUOROPOSE_LABORATORY", &laboratory)
            .envs(checked_profile::surroundings());
    })
}

fn in_firefox() -> Result<Said> {
    let firefox = programs::firefox()?;
    drive(vec![TOOLS.to_owned()], 1, &|tests| {
        tests.env("FLUOROPOSE_FIREFOX", &firefox);
    })
}

fn folder() -> PathBuf {
    workspace::root().join("tests/browser")
}

/// What pages of one run have built (`tests/browser/support/kept_libraries.mjs`).
fn kept_libraries() -> PathBuf {
    workspace::target_dir().join("libraries-of-pages")
}

/// Serves the page and runs files of `tests/browser` against it; `with` says in which browser.
///
/// Two cores are busy with few of them: six at a time take a fifth more processor time than two (`tests/records/tests.md`).
fn drive(files: Vec<String>, at_once: usize, with: &(dyn Fn(&mut Command) + Sync)) -> Result<Said> {
    let node = node::node()?;
    node::install(&folder())?;
    let libraries = kept_libraries();
    std::fs::create_dir_all(&libraries)?;
    let server = Server::start(&dist(), 0)?;
    test_files::run(&folder(), files, at_once, &|| {
        let mut tests = Command::new(&node);
        tests
            .env("FLUOROPOSE_URL", server.url())
            .env("FLUOROPOSE_PACKAGE", package::usual_folder())
            .env("FLUOROPOSE_LIBRARIES", &libraries);
        with(&mut tests);
        tests
    })
}
