//! Verb `test`.

use anyhow::Result;

/// Options of `test`.
#[derive(clap::Args)]
pub struct Args {}

/// Runs the verb.
pub fn run(_args: Args) -> Result<()> {
    anyhow::bail!("not built yet")
}
