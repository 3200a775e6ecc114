//! Verb `models`.

use anyhow::Result;

/// Options of `models`.
#[derive(clap::Args)]
pub struct Args {}

/// Runs the verb.
pub fn run(_args: Args) -> Result<()> {
    anyhow::bail!("not built yet")
}
