//! `cargo xtask tidy`: what the layout of the sources promises, checked from their text.
//!
//! No file uses another in a circle ([`graph`]); no room uses one above it ([`layers`]); nothing stands at the top of
//! the repository that has no place there ([`top`]); no script of the page makes markup of text ([`markup`]); no test is switched off ([`code`]), no work left to come
//! ([`texts`]), and no word comes back that was replaced ([`words`]).
#![cfg_attr(test, allow(clippy::unwrap_used, reason = "it fails the test"))]

pub mod code;
pub mod crates;
pub mod facts;
pub mod files;
pub mod findings;
pub mod graph;
pub mod layers;
pub mod markup;
pub mod print;
pub mod rust;
pub mod scripts;
pub mod texts;
pub mod top;
pub mod typescript;
pub mod words;

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, ensure};

pub use findings::Findings;
use graph::Graph;
use layers::Layers;
use words::Words;

/// Checks the repository at `root`.
///
/// Errors when a file cannot be read or parsed.
pub fn check(root: &Path) -> Result<Findings> {
    let files = files::list(root)?;
    let mut findings = Findings::default();
    findings.errors.extend(top::errors(root)?);
    findings.errors.extend(texts::errors(root, &files)?);
    findings.errors.extend(markup::errors(root, &files)?);
    for graph in graphs(root, &files, &mut findings)? {
        findings.errors.extend(graph.cycles());
        if let Some(layers) = layers_of(root, &graph)? {
            findings.errors.extend(layers.errors(&graph));
        }
    }
    Ok(findings)
}

/// Which file uses which in the source folder that `wanted` names or lies in, room by room.
///
/// Errors when `wanted` is neither a folder with sources nor one inside it.
pub fn graph_text(root: &Path, wanted: &str) -> Result<String> {
    let wanted = wanted.trim_end_matches('/');
    let mut text = String::new();
    for graph in graphs(root, &files::list(root)?, &mut Findings::default())? {
        if let Some(below) = print::asked_for(&graph, wanted) {
            text.push_str(&print::graph(
                &graph,
                layers_of(root, &graph)?.as_ref(),
                &below,
            ));
        }
    }
    ensure!(
        !text.is_empty(),
        "`{wanted}` is no folder with sources of the repository"
    );
    Ok(text)
}

/// The graphs of all source folders; what is wrong with single files goes to the findings.
fn graphs(root: &Path, files: &[String], findings: &mut Findings) -> Result<Vec<Graph>> {
    let words = words(root)?;
    let mut graphs = crates::read(root, files, &words, findings)?;
    graphs.extend(scripts::read(root, files, &words, findings)?);
    Ok(graphs)
}

/// The words that are gone, as far as the repository lists any.
fn words(root: &Path) -> Result<Words> {
    let path = root.join("xtask/tidy/words.txt");
    if !path.is_file() {
        return Ok(Words::default());
    }
    Words::parse(&fs::read_to_string(&path)?).context("in xtask/tidy/words.txt")
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
