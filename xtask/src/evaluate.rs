//! Verb `evaluate`.

use anyhow::Result;

/// Options of `evaluate`.
#[derive(clap::Args)]
pub struct Args {}

/// Runs the verb.
pub fn run(_args: Args) -> Result<()> {
    anyhow::bail!("not built yet")
}
