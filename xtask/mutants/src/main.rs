//! The program: `mutants ROOT [options]`, where ROOT is a copy of the repository that is changed.

use std::path::PathBuf;

use clap::Parser;

#[derive(Parser)]
struct Arguments {
    /// A copy of the repository; its sources are changed
    root: PathBuf,
    #[command(flatten)]
    options: fluoropose_mutants::Options,
}

fn main() -> anyhow::Result<()> {
    let arguments = Arguments::parse();
    fluoropose_mutants::run(&arguments.root, &arguments.options)
}
