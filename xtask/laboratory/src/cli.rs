//! The command `fluoropose`: the laboratory's verbs. The program of that name, `cargo xtask` and the Python package run it.

use std::ffi::OsString;

use anyhow::Result;
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

use crate::exit;
use crate::signals::end_with_the_reader;
use crate::verbs;

/// Who runs the command tells by this variable under which name a person knows it.
pub const NAME: &str = "FLUOROPOSE_COMMAND";
/// The name in the verbs' own examples.
const IN_EXAMPLES: &str = "cargo xtask ";

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
    /// Track and report many studies, some of them on each of many machines
    Batch(verbs::batch::Args),
    /// Put the joint motion of many studies together: knee first, then group
    Collect(verbs::collect::Args),
    /// Compare the poses of a followed film with its reference poses
    Compare(verbs::compare::Args),
    /// Write a study's film as others would have taken it, with its truth, and follow it
    Disguise(Box<verbs::disguise::Args>),
    /// Measure this machine at the core's work, beside other libraries
    Bench(verbs::bench::Args),
}

/// Runs a command line, the program's name first, and says what went wrong on standard error. Returns the code to exit with; help and
/// words that cannot be understood end the process.
pub fn run(words: impl IntoIterator<Item = OsString>) -> u8 {
    end_with_the_reader();
    let name = std::env::var(NAME).unwrap_or_else(|_| "fluoropose".to_owned());
    let matches = known_as(&name).get_matches_from(words);
    let done = match Cli::from_arg_matches(&matches) {
        Ok(cli) => verb(cli.verb),
        Err(error) => error.exit(),
    };
    match done {
        Ok(code) => code,
        Err(error) => {
            // A sentence for a person; no backtrace, whatever the environment asks for.
            eprintln!("error: {error:#}");
            1
        }
    }
}

/// The command with examples that can be typed as they stand, and with the codes that it exits with.
fn known_as(name: &str) -> clap::Command {
    let renamed = |text: &clap::builder::StyledStr| {
        text.to_string().replace(IN_EXAMPLES, &format!("{name} "))
    };
    let argument = |argument: clap::Arg| match argument.get_help().map(renamed) {
        Some(help) => argument.help(help),
        None => argument,
    };
    let mut command = Cli::command().after_help(exit::CODES);
    let verbs: Vec<String> = command
        .get_subcommands()
        .map(|verb| verb.get_name().to_owned())
        .collect();
    for verb in verbs {
        command = command.mut_subcommand(verb, |verb| {
            let after = verb.get_after_help().map(renamed);
            let after = after.into_iter().chain([exit::CODES.to_owned()]);
            let after = after.collect::<Vec<_>>().join("\n\n");
            verb.mut_args(argument).after_help(after)
        });
    }
    command
}

fn verb(verb: Verb) -> Result<u8> {
    match verb {
        Verb::Batch(args) => return verbs::batch::run(args),
        Verb::Collect(args) => return verbs::collect::run(args),
        Verb::Pose(args) => return verbs::pose::run(args),
        Verb::Track(args) => return verbs::track::run(args),
        Verb::Kinematics(args) => return verbs::kinematics::run(args),
        Verb::Report(args) => return verbs::report::run(args),
        Verb::Library(args) => return verbs::library::run(args),
        Verb::Biplane(args) => return verbs::biplane::run(args),
        Verb::Synthetic(args) => verbs::synthetic::run(*args),
        Verb::Identify(args) => return verbs::identify::run(args),
        Verb::Evaluate(args) => verbs::evaluate::run(args),
        Verb::Outline(args) => verbs::outline::run(args),
        Verb::Bound(args) => verbs::bound::run(args),
        Verb::Calibrate(args) => return verbs::calibrate::run(args),
        Verb::Undistort(args) => verbs::undistort::run(args),
        Verb::Compare(args) => verbs::compare::run(args),
        Verb::Disguise(args) => verbs::disguise::run(*args),
        Verb::Bench(args) => verbs::bench::run(args),
    }?;
    Ok(0)
}
