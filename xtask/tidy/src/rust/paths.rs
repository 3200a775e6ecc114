//! The paths that code mentions.

use proc_macro2::{TokenStream, TokenTree};
use syn::visit::{self, Visit};
use syn::{Attribute, ImplItem, Item, ItemUse, Local, Macro, Path, UseTree, Visibility};

use super::items;

/// A path as it stands in code: `crate::math::sqrt` on a line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mention {
    /// Its segments.
    pub path: Vec<String>,
    /// The line of its last segment.
    pub line: usize,
}

/// One name that a `use` brings in.
#[derive(Debug, Clone)]
pub struct Import {
    /// What is imported; for a glob what it is imported from.
    pub mention: Mention,
    /// The name it goes by here; none for a glob.
    pub name: Option<String>,
    /// Whether others can see it here: `pub use`.
    pub exported: bool,
}

/// What the code of a module mentions.
#[derive(Debug, Default)]
pub struct Mentions {
    /// Paths in code.
    pub paths: Vec<Mention>,
    /// What is imported in the module or in one of its functions.
    pub imports: Vec<Import>,
}

impl Mentions {
    /// Takes up a `use` with all its branches.
    pub fn import(&mut self, item: &ItemUse) {
        if item.leading_colon.is_some() {
            return;
        }
        let exported = match &item.vis {
            Visibility::Public(_) => true,
            Visibility::Restricted(restricted) => !restricted.path.is_ident("self"),
            Visibility::Inherited => false,
        };
        self.branch(&item.tree, &mut Vec::new(), exported);
    }

    fn branch(&mut self, tree: &UseTree, before: &mut Vec<String>, exported: bool) {
        match tree {
            UseTree::Path(path) => {
                before.push(path.ident.to_string());
                self.branch(&path.tree, before, exported);
                before.pop();
            }
            UseTree::Group(group) => {
                for tree in &group.items {
                    self.branch(tree, before, exported);
                }
            }
            UseTree::Name(leaf) => {
                let own = leaf.ident.to_string();
                let name = match (own.as_str(), before.last()) {
                    ("self", Some(module)) => module.clone(),
                    _ => own,
                };
                self.leaf(before, Some(&leaf.ident), Some(name), exported);
            }
            UseTree::Rename(leaf) => {
                let name = leaf.rename.to_string();
                self.leaf(before, Some(&leaf.ident), Some(name), exported);
            }
            UseTree::Glob(glob) => {
                let line = glob.star_token.spans[0].start().line;
                let mention = Mention {
                    path: before.clone(),
                    line,
                };
                self.imports.push(Import {
                    mention,
                    name: None,
                    exported,
                });
            }
        }
    }

    fn leaf(
        &mut self,
        before: &[String],
        last: Option<&syn::Ident>,
        name: Option<String>,
        exported: bool,
    ) {
        let mut path = before.to_vec();
        path.extend(last.map(ToString::to_string));
        let line = last.map_or(0, |ident| ident.span().start().line);
        let mention = Mention { path, line };
        self.imports.push(Import {
            mention,
            name,
            exported,
        });
    }

    /// Takes up everything that looks like a path in the tokens of a macro.
    fn scan(&mut self, tokens: TokenStream) {
        let tokens: Vec<TokenTree> = tokens.into_iter().collect();
        let mut at = 0;
        while at < tokens.len() {
            if let TokenTree::Group(group) = &tokens[at] {
                self.scan(group.stream());
            }
            let path = path_at(&tokens, at);
            if let (Some(last), true) = (path.last(), starts_path(&tokens[..at], &path)) {
                let line = last.span().start().line;
                let path = path.iter().map(ToString::to_string).collect();
                self.paths.push(Mention { path, line });
            }
            at += (3 * path.len()).saturating_sub(2).max(1);
        }
    }
}

/// The identifiers joined by `::` from a position on.
fn path_at(tokens: &[TokenTree], mut at: usize) -> Vec<proc_macro2::Ident> {
    let mut path = Vec::new();
    while let Some(TokenTree::Ident(ident)) = tokens.get(at) {
        path.push(ident.clone());
        if !(is_punct(tokens.get(at + 1), ':') && is_punct(tokens.get(at + 2), ':')) {
            break;
        }
        at += 3;
    }
    path
}

/// Whether an identifier after these tokens starts a path: it is no field, lifetime, macro variable or later segment.
fn starts_path(before: &[TokenTree], path: &[proc_macro2::Ident]) -> bool {
    let back = |steps: usize| {
        before
            .len()
            .checked_sub(steps)
            .and_then(|at| before.get(at))
    };
    let field = is_punct(back(1), '.') && !is_punct(back(2), '.');
    let variable = is_punct(back(1), '$') && path.first().is_none_or(|first| first != "crate");
    let later_segment = is_punct(back(1), ':') && is_punct(back(2), ':');
    !(field || variable || later_segment || is_punct(back(1), '\''))
}

fn is_punct(token: Option<&TokenTree>, wanted: char) -> bool {
    matches!(token, Some(TokenTree::Punct(punct)) if punct.as_char() == wanted)
}

impl<'ast> Visit<'ast> for Mentions {
    fn visit_path(&mut self, path: &'ast Path) {
        if let (None, Some(last)) = (&path.leading_colon, path.segments.last()) {
            let line = last.ident.span().start().line;
            let path = path
                .segments
                .iter()
                .map(|segment| segment.ident.to_string());
            self.paths.push(Mention {
                path: path.collect(),
                line,
            });
        }
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, called: &'ast Macro) {
        self.visit_path(&called.path);
        self.scan(called.tokens.clone());
    }

    fn visit_item_use(&mut self, item: &'ast ItemUse) {
        self.import(item);
    }

    fn visit_item(&mut self, item: &'ast Item) {
        if !items::is_test_only(items::attributes(item)) {
            visit::visit_item(self, item);
        }
    }

    fn visit_impl_item(&mut self, item: &'ast ImplItem) {
        if !items::is_test_only(items::impl_attributes(item)) {
            visit::visit_impl_item(self, item);
        }
    }

    fn visit_local(&mut self, local: &'ast Local) {
        if !items::is_test_only(&local.attrs) {
            visit::visit_local(self, local);
        }
    }

    // Neither an attribute nor a visibility makes a file need another.
    fn visit_attribute(&mut self, _: &'ast Attribute) {}
    fn visit_visibility(&mut self, _: &'ast Visibility) {}
}
