//! The crates of the repository and the graphs of their files.

use std::path::Path;

use anyhow::{Context, Result};

use crate::graph::Graph;
use crate::rust::{self, Source, Sources};

/// Parses every Rust file.
pub fn sources(root: &Path, files: &[String]) -> Result<Sources> {
    let rust = files.iter().filter(|file| file.ends_with(".rs"));
    rust.map(|file| Ok((file.clone(), Source::read(&root.join(file))?)))
        .collect()
}

/// The graph of every crate that has a `src`.
pub fn graphs(root: &Path, files: &[String], sources: &Sources) -> Result<Vec<Graph>> {
    let mut graphs = Vec::new();
    for manifest in files
        .iter()
        .filter(|file| *file == "Cargo.toml" || file.ends_with("/Cargo.toml"))
    {
        let text = std::fs::read_to_string(root.join(manifest))?;
        let Some(name) = package_name(&text) else {
            continue;
        };
        let folder = manifest
            .trim_end_matches("Cargo.toml")
            .trim_end_matches('/');
        let graph = rust::graph(name, folder, sources).with_context(|| format!("crate {name}"))?;
        if !graph.files.is_empty() {
            graphs.push(graph);
        }
    }
    Ok(graphs)
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
