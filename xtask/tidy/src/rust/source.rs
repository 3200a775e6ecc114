//! A Rust file, read and parsed once for all checks.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, anyhow};
use proc_macro2::{TokenStream, TokenTree};

/// A parsed file.
pub struct Source {
    /// Its items.
    pub syntax: syn::File,
    /// How many lines it has.
    pub lines: usize,
    /// Each identifier of its code with the first line it stands on.
    pub names: BTreeMap<String, usize>,
}

/// Every Rust file below a folder, by its path below the repository's root.
pub type Sources = BTreeMap<String, Source>;

impl Source {
    /// Parses the text of a file.
    ///
    /// Errors, with the line, when it is no Rust.
    pub fn parse(text: &str) -> Result<Self> {
        let at_line = |error: syn::Error| anyhow!("line {}: {error}", error.span().start().line);
        let tokens: TokenStream = text
            .parse()
            .map_err(|error| at_line(syn::Error::from(error)))?;
        let mut names = BTreeMap::new();
        collect_names(tokens.clone(), &mut names);
        Ok(Self {
            syntax: syn::parse2(tokens).map_err(at_line)?,
            lines: text.lines().count(),
            names,
        })
    }

    /// Reads and parses a file.
    pub fn read(path: &Path) -> Result<Self> {
        let text = fs::read_to_string(path)?;
        Self::parse(&text).with_context(|| format!("cannot parse {}", path.display()))
    }
}

fn collect_names(tokens: TokenStream, names: &mut BTreeMap<String, usize>) {
    for token in tokens {
        match token {
            TokenTree::Group(group) => collect_names(group.stream(), names),
            TokenTree::Ident(name) => {
                let line = name.span().start().line;
                names.entry(name.to_string()).or_insert(line);
            }
            TokenTree::Punct(_) | TokenTree::Literal(_) => {}
        }
    }
}
