//! A Rust file, read and parsed once for all checks.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, Result, anyhow};
use proc_macro2::{Delimiter, TokenStream, TokenTree};
use syn::visit::{self, Visit};
use syn::{Block, ImplItemFn, ItemFn, Signature, TraitItemFn};

use crate::facts::Facts;

/// A parsed file.
pub struct Source {
    /// Its items.
    pub syntax: syn::File,
    /// What checks of single files look at.
    pub facts: Facts,
}

/// Rust files by their paths below the repository's root.
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
        let mut facts = Facts {
            lines: text.lines().count(),
            ..Facts::default()
        };
        scan(tokens.clone(), &mut facts);
        let syntax = syn::parse2(tokens).map_err(at_line)?;
        Functions(&mut facts).visit_file(&syntax);
        Ok(Self { syntax, facts })
    }

    /// Reads and parses a file.
    pub fn read(path: &Path) -> Result<Self> {
        let text = std::fs::read_to_string(path);
        let parsed = text
            .map_err(anyhow::Error::from)
            .and_then(|text| Self::parse(&text));
        parsed.with_context(|| format!("cannot read {}", path.display()))
    }
}

/// Notes names, `#[ignore]` and `todo!`, in macros too.
fn scan(tokens: TokenStream, facts: &mut Facts) {
    let mut before: Option<TokenTree> = None;
    for token in tokens {
        match &token {
            TokenTree::Group(group) => {
                let is_attribute =
                    group.delimiter() == Delimiter::Bracket && is_sign(before.as_ref(), '#');
                let first = group.stream().into_iter().next();
                if is_attribute && is_name(first.as_ref(), "ignore") {
                    facts
                        .unfinished
                        .push((group.span_open().start().line, "#[ignore]"));
                }
                scan(group.stream(), facts);
            }
            TokenTree::Ident(name) => facts.note_name(&name.to_string(), name.span().start().line),
            TokenTree::Punct(sign) => {
                if sign.as_char() == '!' && is_name(before.as_ref(), "todo") {
                    facts.unfinished.push((sign.span().start().line, "todo!"));
                }
            }
            TokenTree::Literal(_) => {}
        }
        before = Some(token);
    }
}

fn is_sign(token: Option<&TokenTree>, wanted: char) -> bool {
    matches!(token, Some(TokenTree::Punct(sign)) if sign.as_char() == wanted)
}

fn is_name(token: Option<&TokenTree>, wanted: &str) -> bool {
    matches!(token, Some(TokenTree::Ident(name)) if name == wanted)
}

/// Notes every function with a body.
struct Functions<'a>(&'a mut Facts);

impl Functions<'_> {
    fn note(&mut self, signature: &Signature, body: &Block) {
        let first = signature.fn_token.span.start().line;
        let last = body.brace_token.span.close().end().line;
        self.0
            .note_function(&signature.ident.to_string(), first, last);
    }
}

impl<'ast> Visit<'ast> for Functions<'_> {
    fn visit_item_fn(&mut self, function: &'ast ItemFn) {
        self.note(&function.sig, &function.block);
        visit::visit_item_fn(self, function);
    }

    fn visit_impl_item_fn(&mut self, function: &'ast ImplItemFn) {
        self.note(&function.sig, &function.block);
        visit::visit_impl_item_fn(self, function);
    }

    fn visit_trait_item_fn(&mut self, function: &'ast TraitItemFn) {
        if let Some(body) = &function.default {
            self.note(&function.sig, body);
        }
        visit::visit_trait_item_fn(self, function);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tests_switched_off_and_code_to_come_are_seen_in_macros_too() {
        let text = "proptest! {\n#[ignore = \"slow\"]\nfn f() {}\n}\nfn g() {\n  h(todo!())\n}\n\
                    fn fine(todo: [u8; 1]) { x.skip(1); [ignore] }";
        let unfinished = Source::parse(text).unwrap().facts.unfinished;
        assert_eq!(unfinished, [(2, "#[ignore]"), (6, "todo!")]);
    }

    #[test]
    fn functions_are_measured_from_their_name_to_their_last_brace() {
        let text = "/// Docs.\npub fn one() {}\nimpl X {\n  fn two(\n    a: u8,\n  ) {\n    fn three() {\n    }\n  }\n}";
        let facts = Source::parse(text).unwrap().facts;
        let told: Vec<_> = facts
            .functions
            .iter()
            .map(|f| (f.name.as_str(), f.line, f.lines))
            .collect();
        assert_eq!(told, [("one", 2, 1), ("two", 4, 6), ("three", 7, 2)]);
        assert_eq!(facts.names["three"], 7);
    }
}
