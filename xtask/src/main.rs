//! `cargo xtask`: every job of the project, one file a verb.

use clap::{Parser, Subcommand};

/// Offline jobs of fluoropose: models, libraries, poses, measurements, the page and its tests.
#[derive(Parser)]
#[command(name = "cargo xtask", version, about)]
struct Cli {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Subcommand)]
enum Verb {
    /// Write the built-in implants as STL files
    Models(xtask::models::Args),
    /// Render the views of a model into a library file
    Library(xtask::library::Args),
    /// Write a synthetic fluoroscopy sequence with known poses
    Demo(xtask::demo::Args),
    /// Find the pose of an implant in each mask of a folder
    Pose(xtask::pose::Args),
    /// Find one pose in the masks of two calibrated cameras
    Biplane(xtask::biplane::Args),
    /// Measure accuracy on random known poses (the protocol of Walker et al. 1996)
    Synthetic(xtask::synthetic::Args),
    /// Tell which implant of a catalogue each mask of a folder is of
    Identify(xtask::identify::Args),
    /// Compare poses from a study's masks with its reference poses
    Evaluate(xtask::evaluate::Args),
    /// Measure one-click outlines on a study's grey frames against its masks
    Outline(xtask::outline::Args),
    /// How well a pose can be known from a noisy outline (Cramer and Rao)
    Bound(xtask::bound::Args),
    /// Find camera and distortion in a picture of a bead grid
    Calibrate(xtask::calibrate::Args),
    /// Write frames without their distortion
    Undistort(xtask::undistort::Args),
    /// Turn femoral and tibial poses into joint kinematics
    Kinematics(xtask::kinematics::Args),
    /// Build the page and serve it on this machine
    Serve(xtask::serve::Args),
    /// Package the page for hosts and as one file, and the npm module
    Package(xtask::package::Args),
    /// Measure the page in headless Chromium
    Bench(xtask::bench::Args),
    /// Set up what is missing and run the tests
    Test(xtask::test::Args),
    /// Check the layout of the sources: layers, cycles between files, words
    Tidy(xtask::tidy::Args),
    /// What continuous integration runs
    Ci(xtask::ci::Args),
}

fn main() -> std::process::ExitCode {
    match run(Cli::parse().verb) {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(error) => {
            // A sentence for a person; no backtrace, whatever the environment asks for.
            eprintln!("error: {error:#}");
            std::process::ExitCode::FAILURE
        }
    }
}

fn run(verb: Verb) -> anyhow::Result<()> {
    match verb {
        Verb::Models(args) => xtask::models::run(args),
        Verb::Library(args) => xtask::library::run(args),
        Verb::Demo(args) => xtask::demo::run(args),
        Verb::Pose(args) => xtask::pose::run(args),
        Verb::Biplane(args) => xtask::biplane::run(args),
        Verb::Synthetic(args) => xtask::synthetic::run(args),
        Verb::Identify(args) => xtask::identify::run(args),
        Verb::Evaluate(args) => xtask::evaluate::run(args),
        Verb::Outline(args) => xtask::outline::run(args),
        Verb::Bound(args) => xtask::bound::run(args),
        Verb::Calibrate(args) => xtask::calibrate::run(args),
        Verb::Undistort(args) => xtask::undistort::run(args),
        Verb::Kinematics(args) => xtask::kinematics::run(args),
        Verb::Serve(args) => xtask::serve::run(args),
        Verb::Package(args) => xtask::package::run(args),
        Verb::Bench(args) => xtask::bench::run(args),
        Verb::Test(args) => xtask::test::run(args),
        Verb::Tidy(args) => xtask::tidy::run(args),
        Verb::Ci(args) => xtask::ci::run(args),
    }
}
