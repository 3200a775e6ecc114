//! `cargo xtask tidy`: what the layout of the sources promises, checked from their text.
#![cfg_attr(test, allow(clippy::unwrap_used, reason = "it fails the test"))]

pub mod crates;
pub mod files;
pub mod graph;
pub mod layers;
pub mod print;
pub mod rust;
pub mod scripts;
pub mod typescript;

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

use graph::Graph;
use layers::Layers;

/// What is wrong with the sources.
#[derive(Debug, Default)]
pub struct Findings {
    /// What must not stay.
    pub errors: Vec<String>,
}

/// Checks the repository at `root`.
///
/// Errors when a file cannot be read or parsed.
pub fn check(root: &Path) -> Result<Findings> {
    let mut findings = Findings::default();
    for graph in graphs(root)? {
        findings.errors.extend(graph.cycles());
        if let Some(layers) = layers_of(root, &graph)? {
            findings.errors.extend(layers.errors(&graph));
        }
    }
    Ok(findings)
}

/// Which file uses which, for the folders that `wanted` names or lies in, room by room.
///
/// Errors when `wanted` is neither a folder with sources nor one inside it.
pub fn graph_text(root: &Path, wanted: &str) -> Result<String> {
    let wanted = wanted.trim_end_matches('/');
    let mut text = String::new();
    for graph in graphs(root)? {
        if let Some(below) = print::asked_for(&graph, wanted) {
            text.push_str(&print::graph(
                &graph,
                layers_of(root, &graph)?.as_ref(),
                &below,
            ));
        }
    }
    anyhow::ensure!(
        !text.is_empty(),
        "`{wanted}` is no folder with sources of the repository"
    );
    Ok(text)
}

fn graphs(root: &Path) -> Result<Vec<Graph>> {
    let files = files::list(root)?;
    let sources = crates::sources(root, &files)?;
    let mut graphs = crates::graphs(root, &files, &sources)?;
    graphs.extend(scripts::graphs(root, &files)?);
    Ok(graphs)
}

/// The rooms of a source folder, when a `layers.txt` beside it names them.
fn layers_of(root: &Path, graph: &Graph) -> Result<Option<Layers>> {
    let folder = graph.src.trim_end_matches("src");
    let path = root.join(folder).join("layers.txt");
    if !path.is_file() {
        return Ok(None);
    }
    let text = fs::read_to_string(&path)?;
    let layers = Layers::parse(&text).with_context(|| format!("in {folder}layers.txt"))?;
    Ok(Some(layers))
}
