//! Verb `serve`: builds the page and serves it on this machine.

use std::io::IsTerminal;

use anyhow::Result;

use crate::clock::since_the_command;
use crate::page::{self, Build};
use crate::static_server::Server;

/// The port when none is asked for.
const USUAL_PORT: u16 = 8080;

/// Options of `serve`.
///
/// Gets what is missing (the WASM target, npm packages), builds the page with the demonstration data, serves
/// it on 127.0.0.1 and opens the browser where there is a display. Ctrl-C ends it.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Port to listen on; 0 takes a free one [default: 8080, or a free one where that is taken]
    #[arg(long)]
    port: Option<u16>,
    /// Build the page into web/dist and stop
    #[arg(long)]
    build_only: bool,
}

/// Runs the verb.
pub(crate) fn run(args: Args) -> Result<()> {
    let dist = page::build(Build::Quick)?;
    if args.build_only {
        println!("The page is in {}", dist.display());
        return Ok(());
    }
    let server = match args.port {
        Some(port) => Server::start(&dist, port)?,
        None => Server::start(&dist, USUAL_PORT).or_else(|_| Server::start(&dist, 0))?,
    };
    server.check()?;
    let seconds = since_the_command().as_secs_f64();
    println!(
        "The page answers at {} after {seconds:.0} s (Ctrl-C ends it)",
        server.url()
    );
    if has_display() {
        // Without a browser the line above is enough.
        let _ = open::that_detached(server.url());
    }
    server.wait()
}

/// Whether somebody sits before this machine: a terminal, and a desktop to open a browser on.
fn has_display() -> bool {
    let desktop = cfg!(any(windows, target_os = "macos"))
        || ["DISPLAY", "WAYLAND_DISPLAY"]
            .iter()
            .any(|name| std::env::var_os(name).is_some());
    desktop && std::io::stdout().is_terminal()
}
