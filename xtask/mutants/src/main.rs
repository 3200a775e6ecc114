//! The program behind `cargo xtask mutants`, which makes the copy that is changed.

use std::path::PathBuf;

use clap::Parser;

#[derive(Parser)]
#[command(
    override_usage = "cargo xtask mutants [OPTIONS]",
    about = "Changes of the sources, one at a time, that the tests have to notice: which they miss, and where no test comes",
    after_help = "Functions return something else, operators and signs are exchanged, arms of a match are taken out, in a copy of the sources below target/mutants. A change counts as \
caught where a test fails or goes round in a circle.\n\n\
Example: cargo xtask mutants --sample 200 --file core/src/pose --file core/src/camera --test pose:: --test camera::"
)]
struct Arguments {
    /// A copy of the repository; its sources are changed
    #[arg(long, hide = true)]
    root: PathBuf,
    #[command(flatten)]
    options: fluoropose_mutants::Options,
}

fn main() -> anyhow::Result<()> {
    let arguments = Arguments::parse();
    fluoropose_mutants::run(&arguments.root, &arguments.options)
}
