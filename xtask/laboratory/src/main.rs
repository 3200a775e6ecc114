//! The program `fluoropose`: the laboratory's verbs.

use clap::{Parser, Subcommand};
use fluoropose_laboratory::verbs;

/// Poses of implants from masks and grey frames, and how good they are.
#[derive(Parser)]
#[command(name = "fluoropose", version, about)]
struct Cli {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Subcommand)]
enum Verb {
    /// Render the views of a model into a library file
    Library(verbs::library::Args),
    /// Find the pose of an implant in each mask of a folder
    Pose(verbs::pose::Args),
    /// Find one pose in the masks of two calibrated cameras
    Biplane(verbs::biplane::Args),
    /// Measure accuracy on random known poses (the protocol of Walker et al. 1996)
    Synthetic(Box<verbs::synthetic::Args>),
    /// Tell which implant of a catalogue each mask of a folder is of
    Identify(verbs::identify::Args),
    /// Compare poses from a study's masks with its reference poses
    Evaluate(verbs::evaluate::Args),
    /// Follow the components of a study through its film
    Track(verbs::track::Args),
    /// Measure one-click outlines on a study's grey frames against its masks
    Outline(verbs::outline::Args),
    /// How well a pose can be known from a noisy outline (Cramer and Rao)
    Bound(verbs::bound::Args),
    /// Find camera and distortion in a picture of a bead grid
    Calibrate(verbs::calibrate::Args),
    /// Write frames without their distortion
    Undistort(verbs::undistort::Args),
    /// Turn femoral and tibial poses into joint kinematics
    Kinematics(verbs::kinematics::Args),
    /// Write a study's joint motion as table, files, figure and report
    Report(verbs::report::Args),
    /// Measure this machine at the core's work, beside other libraries
    Bench(verbs::bench::Args),
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
        Verb::Library(args) => verbs::library::run(args),
        Verb::Pose(args) => verbs::pose::run(args),
        Verb::Biplane(args) => verbs::biplane::run(args),
        Verb::Synthetic(args) => verbs::synthetic::run(*args),
        Verb::Identify(args) => verbs::identify::run(args),
        Verb::Evaluate(args) => verbs::evaluate::run(args),
        Verb::Track(args) => verbs::track::run(args),
        Verb::Outline(args) => verbs::outline::run(args),
        Verb::Bound(args) => verbs::bound::run(args),
        Verb::Calibrate(args) => verbs::calibrate::run(args),
        Verb::Undistort(args) => verbs::undistort::run(args),
        Verb::Kinematics(args) => verbs::kinematics::run(args),
        Verb::Report(args) => verbs::report::run(args),
        Verb::Bench(args) => verbs::bench::run(args),
    }
}
