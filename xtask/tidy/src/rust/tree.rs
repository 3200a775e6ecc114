//! The modules of a crate: which file holds each, what it defines, and what its code mentions.

use std::collections::{BTreeMap, BTreeSet};

use anyhow::{Result, ensure};
use syn::visit::Visit;
use syn::{Expr, Item, ItemMod, Lit, Meta};

use super::items;
use super::paths::Mentions;
use super::source::Sources;

/// One module.
#[derive(Debug, Default)]
pub struct Module {
    /// The file its code stands in, by its place in [`Tree::files`].
    pub file: usize,
    /// The module around it, by its place in [`Tree::modules`].
    pub parent: Option<usize>,
    /// The modules inside it by name.
    pub children: BTreeMap<String, usize>,
    /// The names it defines itself.
    pub items: BTreeSet<String>,
    /// The macros it defines with `macro_rules`.
    pub macros: BTreeSet<String>,
    /// What its code mentions.
    pub mentions: Mentions,
}

/// The modules of a crate, without those that only tests have.
#[derive(Debug, Default)]
pub struct Tree {
    /// Its name in paths.
    pub name: String,
    /// Its files, as paths below the repository's root.
    pub files: Vec<String>,
    /// Its modules, parents before children.
    pub modules: Vec<Module>,
    /// The root module of its library, if it has one.
    pub library: Option<usize>,
}

/// Where the files of a module's children are looked for.
struct Nest {
    folder: String,
    /// The folder that `#[path]` is relative to.
    beside: String,
}

impl Tree {
    /// Reads the modules below `src/lib.rs`, `src/main.rs` and `src/bin`.
    ///
    /// Errors when a module has no file.
    pub fn read(name: &str, src: &str, sources: &Sources) -> Result<Self> {
        let mut tree = Self {
            name: name.replace('-', "_"),
            ..Self::default()
        };
        let bin = format!("{src}/bin/");
        let programs = sources
            .keys()
            .filter(|file| file.starts_with(&bin) && !file[bin.len()..].contains('/'));
        let library = format!("{src}/lib.rs");
        let mut roots = vec![library.clone(), format!("{src}/main.rs")];
        roots.extend(programs.cloned());
        for root in roots.iter().filter(|root| sources.contains_key(*root)) {
            let module = tree.add_module(root, None);
            if *root == library {
                tree.library = Some(module);
            }
            let folder = root
                .rsplit_once('/')
                .map_or("", |(folder, _)| folder)
                .to_string();
            let nest = Nest {
                beside: folder.clone(),
                folder,
            };
            tree.read_items(module, &sources[root].syntax.items, &nest, sources)?;
        }
        Ok(tree)
    }

    fn add_module(&mut self, file: &str, parent: Option<usize>) -> usize {
        let known = self.files.iter().position(|other| other == file);
        let file = known.unwrap_or_else(|| {
            self.files.push(file.to_string());
            self.files.len() - 1
        });
        self.modules.push(Module {
            file,
            parent,
            ..Module::default()
        });
        self.modules.len() - 1
    }

    fn read_items(
        &mut self,
        module: usize,
        list: &[Item],
        nest: &Nest,
        sources: &Sources,
    ) -> Result<()> {
        for item in list {
            if items::is_test_only(items::attributes(item)) {
                continue;
            }
            if let Item::Mod(child) = item {
                self.read_child(module, child, nest, sources)?;
                continue;
            }
            let module = &mut self.modules[module];
            module.items.extend(items::names(item));
            if let Item::Macro(item) = item {
                module
                    .macros
                    .extend(item.ident.as_ref().map(ToString::to_string));
            }
            module.mentions.visit_item(item);
        }
        Ok(())
    }

    fn read_child(
        &mut self,
        parent: usize,
        child: &ItemMod,
        nest: &Nest,
        sources: &Sources,
    ) -> Result<()> {
        let name = child.ident.to_string();
        let inner = format!("{}/{name}", nest.folder);
        if let Some((_, list)) = &child.content {
            let file = self.files[self.modules[parent].file].clone();
            let module = self.add_module(&file, Some(parent));
            self.modules[parent].children.insert(name, module);
            let nest = Nest {
                beside: inner.clone(),
                folder: inner,
            };
            return self.read_items(module, list, &nest, sources);
        }
        let stated = stated_path(child);
        let candidates = match &stated {
            Some(path) => vec![plain(&format!("{}/{path}", nest.beside))],
            None => vec![format!("{inner}.rs"), format!("{inner}/mod.rs")],
        };
        let file = candidates.iter().find(|file| sources.contains_key(*file));
        ensure!(
            file.is_some(),
            "no file for module `{name}`; looked for {}",
            candidates.join(" and ")
        );
        let file = file.cloned().unwrap_or_default();
        let source = &sources[&file];
        if items::is_test_only(&source.syntax.attrs) {
            return Ok(());
        }
        let module = self.add_module(&file, Some(parent));
        self.modules[parent].children.insert(name, module);
        let beside = file
            .rsplit_once('/')
            .map_or("", |(folder, _)| folder)
            .to_string();
        let folder = if stated.is_some() {
            beside.clone()
        } else {
            inner
        };
        self.read_items(
            module,
            &source.syntax.items,
            &Nest { folder, beside },
            sources,
        )
    }
}

/// The file that `#[path = ".."]` names.
fn stated_path(module: &ItemMod) -> Option<String> {
    module
        .attrs
        .iter()
        .find_map(|attribute| match &attribute.meta {
            Meta::NameValue(pair) if pair.path.is_ident("path") => match &pair.value {
                Expr::Lit(literal) => match &literal.lit {
                    Lit::Str(path) => Some(path.value()),
                    _ => None,
                },
                _ => None,
            },
            _ => None,
        })
}

/// A path without `.` and `..`.
pub fn plain(path: &str) -> String {
    let mut parts = Vec::new();
    for part in path.split('/') {
        match part {
            "." | "" => {}
            ".." => {
                parts.pop();
            }
            _ => parts.push(part),
        }
    }
    parts.join("/")
}
