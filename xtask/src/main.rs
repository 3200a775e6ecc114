//! `cargo xtask`: every job of the project, one file a verb.
#![cfg_attr(test, allow(clippy::unwrap_used, reason = "it fails the test"))]

mod bench;
mod ci;
mod clock;
mod conformance;
mod demo;
mod driver;
mod firmware;
mod fuzz;
mod kill;
mod laboratory;
mod models;
mod mutants;
mod options;
mod output;
mod package;
mod page;
mod serve;
mod setup;
mod soak;
mod sources;
mod static_server;
mod suite;
mod supply;
mod test;
mod tidy;
mod wheel;
mod workspace;

use clap::{Parser, Subcommand};
use laboratory::Words;

/// Jobs of fluoropose: the page and its tests, models and synthetic films, and the laboratory's verbs.
#[derive(Parser)]
#[command(name = "cargo xtask", version, about)]
struct Cli {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Subcommand)]
enum Verb {
    /// Build the page and serve it on this machine
    Serve(serve::Args),
    /// Set up what is missing and run the tests
    Test(test::Args),
    /// Package the page for hosts and as one file, and the npm module; or the Python package
    Package(package::Args),
    /// Measure this machine at the core's work, or the page in headless Chromium
    Bench(bench::Args),
    /// Read the image files that other readers ship, beside those readers
    Conformance(conformance::Args),
    /// Give changed files to every reader, until one panics or the time is over
    Fuzz(fuzz::Args),
    /// End work in the page in every way, and tell what was lost
    Kill(kill::Args),
    /// Work in one page at random for long, and tell what it holds in memory
    Soak(soak::Args),
    /// Change the sources at random, and tell which changes no test notices
    Mutants(mutants::Args),
    /// Check the layout of the sources: layers, cycles between files, words
    Tidy(tidy::Args),
    /// Check what comes from elsewhere: licences, sources, what was taken back
    Supply(supply::Args),
    /// What continuous integration runs
    Ci(ci::Args),
    /// Write the built-in implants as STL files
    Models(models::Args),
    /// Write a synthetic fluoroscopy sequence with known poses
    Demo(demo::Args),
    /// Render the views of a model into a library file
    Library(Words),
    /// Find the pose of an implant in each mask of a folder
    Pose(Words),
    /// Find one pose in the masks of two calibrated cameras
    Biplane(Words),
    /// Measure accuracy on random known poses (the protocol of Walker et al. 1996)
    Synthetic(Words),
    /// Tell which implant of a catalogue each mask of a folder is of
    Identify(Words),
    /// Compare poses from a study's masks with its reference poses
    Evaluate(Words),
    /// Follow the components of a study through its film
    Track(Words),
    /// Measure one-click outlines on a study's grey frames against its masks
    Outline(Words),
    /// How well a pose can be known from a noisy outline (Cramer and Rao)
    Bound(Words),
    /// Find camera and distortion in a picture of a bead grid
    Calibrate(Words),
    /// Write frames without their distortion
    Undistort(Words),
    /// Turn femoral and tibial poses into joint kinematics
    Kinematics(Words),
    /// Write a study's joint motion as table, files, figure and report
    Report(Words),
    /// Track and report many studies, some of them on each of many machines
    Batch(Words),
    /// Put the joint motion of many studies together: knee first, then group
    Collect(Words),
    /// Compare the poses of a followed film with its reference poses
    Compare(Words),
    /// Write a study's film as others would have taken it, with its truth, and follow it
    Disguise(Words),
}

fn main() -> std::process::ExitCode {
    clock::since_the_command();
    end_with_the_reader();
    match run(Cli::parse().verb) {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(error) => {
            // A sentence for a person; no backtrace, whatever the environment asks for.
            eprintln!("error: {error:#}");
            std::process::ExitCode::FAILURE
        }
    }
}

/// Behind `| head` the program ends when that has read enough, without a word, as programs do on Unix.
fn end_with_the_reader() {
    #[cfg(unix)]
    {
        use std::sync::{Arc, atomic::AtomicBool};
        let always = Arc::new(AtomicBool::new(true));
        let pipe = signal_hook::consts::SIGPIPE;
        // Without it a write fails, and the macros that print break off over that.
        let _ = signal_hook::flag::register_conditional_default(pipe, always);
    }
}

fn run(verb: Verb) -> anyhow::Result<()> {
    match verb {
        Verb::Serve(args) => serve::run(args),
        Verb::Test(args) => test::run(args),
        Verb::Package(args) => package::run(args),
        Verb::Bench(args) => bench::run(args),
        Verb::Conformance(args) => conformance::run(args),
        Verb::Fuzz(args) => fuzz::run(args),
        Verb::Kill(args) => kill::run(args),
        Verb::Soak(args) => soak::run(args),
        Verb::Mutants(args) => mutants::run(args),
        Verb::Tidy(args) => tidy::run(args),
        Verb::Supply(args) => supply::run(args),
        Verb::Ci(args) => ci::run(args),
        Verb::Models(args) => models::run(args),
        Verb::Demo(args) => demo::run(args),
        Verb::Library(words) => laboratory::run("library", &words),
        Verb::Pose(words) => laboratory::run("pose", &words),
        Verb::Biplane(words) => laboratory::run("biplane", &words),
        Verb::Synthetic(words) => laboratory::run("synthetic", &words),
        Verb::Identify(words) => laboratory::run("identify", &words),
        Verb::Evaluate(words) => laboratory::run("evaluate", &words),
        Verb::Track(words) => laboratory::run("track", &words),
        Verb::Outline(words) => laboratory::run("outline", &words),
        Verb::Bound(words) => laboratory::run("bound", &words),
        Verb::Calibrate(words) => laboratory::run("calibrate", &words),
        Verb::Compare(words) => laboratory::run("compare", &words),
        Verb::Disguise(words) => laboratory::run("disguise", &words),
        Verb::Undistort(words) => laboratory::run("undistort", &words),
        Verb::Kinematics(words) => laboratory::run("kinematics", &words),
        Verb::Report(words) => laboratory::run("report", &words),
        Verb::Batch(words) => laboratory::run("batch", &words),
        Verb::Collect(words) => laboratory::run("collect", &words),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    /// The laboratory's program has the same verbs, told in the same words.
    #[test]
    fn the_laboratorys_verbs_are_told_as_it_tells_them() {
        const ITS: &str = include_str!("../laboratory/src/cli.rs");
        let ours = Cli::command();
        // The variants of its verbs alone are indented.
        let its = ITS.lines().filter_map(|line| line.strip_prefix("    /// "));
        let its: Vec<&str> = its
            .filter(|about| !about.contains("this machine"))
            .collect();
        assert_eq!(its.len(), 17);
        for about in its {
            let told =
                |verb: &clap::Command| verb.get_about().is_some_and(|a| a.to_string() == about);
            assert!(ours.get_subcommands().any(told), "{about}");
        }
    }

    #[test]
    fn what_follows_a_laboratorys_verb_is_left_to_it() {
        let words = ["cargo xtask", "pose", "--help", "--masks", "-1", "--", "x"];
        match Cli::try_parse_from(words).ok().unwrap().verb {
            Verb::Pose(found) => assert_eq!(found.len(), 5),
            _ => panic!("another verb"),
        }
    }
}
