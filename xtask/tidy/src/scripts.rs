//! TypeScript and JavaScript in the repository: the graphs of source folders, and each file by itself.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, Result};

use crate::code;
use crate::findings::Findings;
use crate::graph::Graph;
use crate::typescript::module::Module;
use crate::typescript::{self, tokens};
use crate::words::Words;

/// Looks at each file, and gives the graph of every folder `src` that stands beside a `package.json`.
pub fn read(
    root: &Path,
    files: &[String],
    words: &Words,
    findings: &mut Findings,
) -> Result<Vec<Graph>> {
    let packages = files
        .iter()
        .filter_map(|file| file.strip_suffix("package.json"));
    let mut folders: BTreeMap<String, BTreeMap<String, Module>> = packages
        .map(|package| (format!("{package}src"), BTreeMap::new()))
        .collect();
    for file in files.iter().filter(|file| is_script(file)) {
        let text = std::fs::read_to_string(root.join(file))
            .with_context(|| format!("cannot read {file}"))?;
        let tokens = tokens::tokens(&text);
        code::check(
            file,
            &typescript::facts::facts(&text, &tokens),
            words,
            findings,
        );
        for (src, modules) in &mut folders {
            let below = file
                .strip_prefix(src.as_str())
                .and_then(|rest| rest.strip_prefix('/'));
            if let Some(below) = below.filter(|below| is_module(below)) {
                modules.insert(below.to_string(), Module::from_tokens(&tokens));
            }
        }
    }
    let filled = folders.iter().filter(|(_, modules)| !modules.is_empty());
    Ok(filled
        .map(|(src, modules)| typescript::graph(src, modules))
        .collect())
}

fn is_script(file: &str) -> bool {
    [".ts", ".tsx", ".mjs"]
        .iter()
        .any(|ending| file.ends_with(ending))
}

/// Whether a file is part of a program: no declaration of types, no test.
fn is_module(file: &str) -> bool {
    !(file.ends_with(".d.ts") || file.contains(".test."))
}
