//! The folders of TypeScript in the repository and the graphs of their files.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, Result};

use crate::graph::Graph;
use crate::typescript;
use crate::typescript::module::Module;

/// The graph of every folder `src` of TypeScript that stands beside a `package.json`.
pub fn graphs(root: &Path, files: &[String]) -> Result<Vec<Graph>> {
    let mut graphs = Vec::new();
    for package in files
        .iter()
        .filter_map(|file| file.strip_suffix("/package.json"))
    {
        let src = format!("{package}/src");
        let modules = modules(root, &src, files)?;
        if !modules.is_empty() {
            graphs.push(typescript::graph(&src, &modules));
        }
    }
    Ok(graphs)
}

/// The files below a folder, declarations of types and tests aside.
fn modules(root: &Path, src: &str, files: &[String]) -> Result<BTreeMap<String, Module>> {
    let below = files
        .iter()
        .filter_map(|file| file.strip_prefix(src)?.strip_prefix('/'));
    let code = below.filter(|file| file.ends_with(".ts") || file.ends_with(".tsx"));
    let own = code.filter(|file| !file.ends_with(".d.ts") && !file.contains(".test."));
    own.map(|file| {
        let path = root.join(src).join(file);
        let text = std::fs::read_to_string(&path)
            .with_context(|| format!("cannot read {}", path.display()))?;
        Ok((file.to_string(), Module::parse(&text)))
    })
    .collect()
}
