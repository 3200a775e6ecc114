//! The check by itself, for a folder other than that of the running cargo: `tidy [--root FOLDER] [--graph FOLDER]`.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Result, bail};

fn main() -> ExitCode {
    match run() {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<bool> {
    let mut root = PathBuf::from(".");
    let mut wanted = None;
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match (argument.as_str(), arguments.next()) {
            ("--root", Some(folder)) => root = folder.into(),
            ("--graph", Some(folder)) => wanted = Some(folder),
            _ => bail!("`{argument}` is not understood; tidy [--root FOLDER] [--graph FOLDER]"),
        }
    }
    if let Some(folder) = wanted {
        print!("{}", fluoropose_tidy::graph_text(&root, &folder)?);
        return Ok(true);
    }
    let findings = fluoropose_tidy::check(&root)?;
    for error in &findings.errors {
        println!("error: {error}");
    }
    println!("{} errors", findings.errors.len());
    Ok(findings.errors.is_empty())
}
