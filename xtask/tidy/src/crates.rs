//! The crates of the repository: their graphs, and each Rust file by itself.

use std::path::Path;
use std::thread;

use anyhow::{Context, Result};

use crate::code;
use crate::findings::Findings;
use crate::graph::Graph;
use crate::rust::{self, Source, Sources};
use crate::words::Words;

/// A folder with a manifest, and the Rust files that no folder further in has for itself.
#[derive(Debug, PartialEq, Eq)]
struct Crate {
    /// The package's name; none for a workspace.
    name: Option<String>,
    folder: String,
    files: Vec<String>,
}

/// Reads every crate, each in a thread of its own, and looks at each of its files.
pub fn read(
    root: &Path,
    files: &[String],
    words: &Words,
    findings: &mut Findings,
) -> Result<Vec<Graph>> {
    let crates = find(root, files)?;
    let read = thread::scope(|scope| {
        let started: Vec<_> = crates
            .iter()
            .map(|one| scope.spawn(|| one.read(root, words)))
            .collect();
        let join = |thread: thread::ScopedJoinHandle<'_, _>| {
            thread
                .join()
                .unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        };
        started.into_iter().map(join).collect::<Result<Vec<_>>>()
    })?;
    let mut graphs = Vec::new();
    for (graph, found) in read {
        graphs.extend(graph);
        findings.extend(found);
    }
    Ok(graphs)
}

/// The crates; the deepest folders come first, so that each takes the files of its own.
fn find(root: &Path, files: &[String]) -> Result<Vec<Crate>> {
    let mut folders: Vec<&str> = files
        .iter()
        .filter_map(|file| file.strip_suffix("Cargo.toml"))
        .collect();
    folders.sort_by_key(|folder| std::cmp::Reverse(folder.len()));
    let mut rust: Vec<&String> = files.iter().filter(|file| file.ends_with(".rs")).collect();
    let mut crates = Vec::new();
    for folder in folders {
        let manifest = std::fs::read_to_string(root.join(folder).join("Cargo.toml"))?;
        let (own, others): (Vec<&String>, Vec<&String>) =
            rust.into_iter().partition(|file| file.starts_with(folder));
        rust = others;
        crates.push(Crate {
            name: package_name(&manifest).map(String::from),
            folder: folder.trim_end_matches('/').to_string(),
            files: own.into_iter().cloned().collect(),
        });
    }
    crates.sort_by(|one, other| one.folder.cmp(&other.folder));
    Ok(crates)
}

impl Crate {
    fn read(&self, root: &Path, words: &Words) -> Result<(Option<Graph>, Findings)> {
        let read = |file: &String| Ok((file.clone(), Source::read(&root.join(file))?));
        let sources: Sources = self.files.iter().map(read).collect::<Result<_>>()?;
        let mut findings = Findings::default();
        for (file, source) in &sources {
            code::check(file, &source.facts, words, &mut findings);
        }
        let Some(name) = &self.name else {
            return Ok((None, findings));
        };
        let graph =
            rust::graph(name, &self.folder, &sources).with_context(|| format!("crate {name}"))?;
        Ok((
            Some(graph).filter(|graph| !graph.files.is_empty()),
            findings,
        ))
    }
}

/// The name in the section `[package]` of a manifest.
fn package_name(manifest: &str) -> Option<&str> {
    let package = manifest
        .split("\n[")
        .find(|section| section.trim_start_matches('[').starts_with("package]"))?;
    let line = package.lines().find(|line| {
        line.split('=')
            .next()
            .is_some_and(|key| key.trim() == "name")
    })?;
    line.split('"').nth(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_is_that_of_the_package() {
        let manifest =
            "[[bin]]\nname = \"tool\"\n\n[package]\nnamely = \"x\"\nname = \"fluoropose\"\n";
        assert_eq!(package_name(manifest), Some("fluoropose"));
        assert_eq!(package_name("[workspace]\nname = \"none\"\n"), None);
    }
}
