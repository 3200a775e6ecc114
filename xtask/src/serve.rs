//! Verb `serve`.

use anyhow::Result;

/// Options of `serve`.
#[derive(clap::Args)]
pub struct Args {}

/// Runs the verb.
pub fn run(_args: Args) -> Result<()> {
    anyhow::bail!("not built yet")
}
