//! Rust: which file of a crate uses which.
//!
//! A path is an edge to the file that defines what it names: re-exports are followed, so that a facade stands in
//! nobody's way. `mod` and the re-export of what lies inside the own module are no edges. Left out is what exists in
//! tests only. Not seen are methods of an `impl` in another file than its type, and names that macros make up.

pub mod items;
pub mod paths;
pub mod scope;
pub mod source;
pub mod tree;

use anyhow::Result;

use crate::graph::Graph;
use paths::{Import, Mention};
use scope::{Meaning, Scope};
pub use source::{Source, Sources};
use tree::Tree;

/// The graph of a crate, whose folder is given below the repository's root.
pub fn graph(name: &str, folder: &str, sources: &Sources) -> Result<Graph> {
    let src = if folder.is_empty() {
        "src".to_string()
    } else {
        format!("{folder}/src")
    };
    let tree = Tree::read(name, &src, sources)?;
    let below = |file: &String| {
        file.strip_prefix(&format!("{src}/"))
            .unwrap_or(file)
            .to_string()
    };
    let mut graph = Graph {
        files: tree.files.iter().map(below).collect(),
        src,
        ..Graph::default()
    };
    let scope = Scope::new(&tree);
    for (module, content) in tree.modules.iter().enumerate() {
        let edges = Edges {
            tree: &tree,
            scope: &scope,
            module,
        };
        for import in &content.mentions.imports {
            edges.of_import(import, &mut graph);
        }
        for mention in &content.mentions.paths {
            edges.of_mention(mention, &mut graph);
        }
    }
    Ok(graph)
}

/// What the code of one module adds to the graph.
struct Edges<'a> {
    tree: &'a Tree,
    scope: &'a Scope<'a>,
    module: usize,
}

impl Edges<'_> {
    fn of_import(&self, import: &Import, graph: &mut Graph) {
        for meaning in self.scope.meanings(self.module, &import.mention) {
            let (Meaning::ItemOf(definer) | Meaning::Module(definer)) = meaning;
            let passed_on = import.exported && self.scope.is_within(definer, self.module);
            let is_item = matches!(meaning, Meaning::ItemOf(_));
            // A module is used by the paths that lead through it; only who passes on all of it depends on it here.
            let whole_module = import.exported && import.name.is_none();
            if !passed_on && (is_item || whole_module) {
                self.note(definer, &import.mention, graph);
            }
        }
    }

    fn of_mention(&self, mention: &Mention, graph: &mut Graph) {
        for meaning in self.scope.meanings(self.module, mention) {
            if let Meaning::ItemOf(definer) = meaning {
                self.note(definer, mention, graph);
            }
        }
    }

    fn note(&self, definer: usize, mention: &Mention, graph: &mut Graph) {
        let file = |module: usize| self.tree.modules[module].file;
        let name = mention.path.last().map_or("", String::as_str);
        graph.note(file(self.module), file(definer), mention.line, name);
    }
}

#[cfg(test)]
mod tests;
