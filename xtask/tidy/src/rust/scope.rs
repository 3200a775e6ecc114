//! What a path means: the modules and items that it can name, followed through re-exports.

use std::cell::RefCell;
use std::collections::{HashMap, HashSet};

use super::paths::{Import, Mention};
use super::tree::Tree;

/// What a name stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Meaning {
    /// A module.
    Module(usize),
    /// Something that this module defines.
    ItemOf(usize),
}

/// Names asked for on the way to an answer, so that re-exports in a circle end.
type Asked = HashSet<(usize, String, bool)>;

/// The names of a crate.
pub struct Scope<'a> {
    tree: &'a Tree,
    named: Vec<HashMap<&'a str, Vec<&'a Import>>>,
    globs: Vec<Vec<&'a Import>>,
    known: RefCell<HashMap<(usize, String), Vec<Meaning>>>,
}

impl<'a> Scope<'a> {
    /// Sorts the imports of every module by name.
    pub fn new(tree: &'a Tree) -> Self {
        let mut named = Vec::new();
        let mut globs = Vec::new();
        for module in &tree.modules {
            let mut by_name: HashMap<&str, Vec<&Import>> = HashMap::new();
            let mut all = Vec::new();
            for import in &module.mentions.imports {
                match &import.name {
                    Some(name) => by_name.entry(name).or_default().push(import),
                    None => all.push(import),
                }
            }
            named.push(by_name);
            globs.push(all);
        }
        let known = RefCell::default();
        Self {
            tree,
            named,
            globs,
            known,
        }
    }

    /// All that a path in the code of a module can mean: nothing when it leads out of the crate.
    pub fn meanings(&self, module: usize, mention: &Mention) -> Vec<Meaning> {
        if let [name] = mention.path.as_slice() {
            let key = (module, name.clone());
            if let Some(known) = self.known.borrow().get(&key) {
                return known.clone();
            }
            let found = self.resolve(module, &mention.path, &mut Asked::new());
            self.known.borrow_mut().insert(key, found.clone());
            return found;
        }
        self.resolve(module, &mention.path, &mut Asked::new())
    }

    fn resolve(&self, module: usize, path: &[String], asked: &mut Asked) -> Vec<Meaning> {
        let Some((first, mut rest)) = path.split_first() else {
            return Vec::new();
        };
        let mut found = match first.as_str() {
            "crate" => vec![Meaning::Module(self.root(module))],
            "self" => vec![Meaning::Module(module)],
            "super" => self.parent(module),
            name => self.start(module, name, !rest.is_empty(), asked),
        };
        while let Some((segment, after)) = rest.split_first() {
            let inside = found.iter().find_map(|meaning| match meaning {
                Meaning::Module(module) => Some(*module),
                Meaning::ItemOf(_) => None,
            });
            // A variant or an associated item belongs to the type before it.
            let Some(inside) = inside else {
                return found;
            };
            found = match segment.as_str() {
                "super" => self.parent(inside),
                "self" => vec![Meaning::Module(inside)],
                name => self.look_up(inside, name, !after.is_empty(), asked),
            };
            rest = after;
        }
        found
    }

    /// The first name of a path: one of the module, a macro of a module around it, or the package's library.
    fn start(&self, module: usize, name: &str, leads_on: bool, asked: &mut Asked) -> Vec<Meaning> {
        let found = self.look_up(module, name, leads_on, asked);
        if !found.is_empty() {
            return found;
        }
        if leads_on {
            let library = self.tree.library.filter(|_| name == self.tree.name);
            return library.map(Meaning::Module).into_iter().collect();
        }
        let mut around = self.tree.modules[module].parent;
        while let Some(outer) = around {
            if self.tree.modules[outer].macros.contains(name) {
                return vec![Meaning::ItemOf(outer)];
            }
            around = self.tree.modules[outer].parent;
        }
        Vec::new()
    }

    /// What a name means in a module. A name that leads on to another is a module before it is an item.
    fn look_up(
        &self,
        module: usize,
        name: &str,
        leads_on: bool,
        asked: &mut Asked,
    ) -> Vec<Meaning> {
        let own = &self.tree.modules[module];
        let child = own.children.get(name).map(|child| Meaning::Module(*child));
        if leads_on && let Some(child) = child {
            return vec![child];
        }
        if !asked.insert((module, name.to_string(), leads_on)) {
            return Vec::new();
        }
        let mut found: Vec<Meaning> = child.into_iter().collect();
        if own.items.contains(name) {
            found.push(Meaning::ItemOf(module));
        }
        for import in self.named[module].get(name).into_iter().flatten() {
            found.extend(self.resolve(module, &import.mention.path, asked));
        }
        if found.is_empty() {
            for glob in &self.globs[module] {
                found.extend(self.through_glob(module, glob, name, leads_on, asked));
            }
        }
        found
    }

    fn through_glob(
        &self,
        module: usize,
        glob: &Import,
        name: &str,
        leads_on: bool,
        asked: &mut Asked,
    ) -> Vec<Meaning> {
        let from = self.resolve(module, &glob.mention.path, asked);
        let mut found = Vec::new();
        for meaning in from {
            if let Meaning::Module(from) = meaning {
                found.extend(self.look_up(from, name, leads_on, asked));
            }
        }
        found
    }

    fn parent(&self, module: usize) -> Vec<Meaning> {
        self.tree.modules[module]
            .parent
            .map(Meaning::Module)
            .into_iter()
            .collect()
    }

    fn root(&self, mut module: usize) -> usize {
        while let Some(parent) = self.tree.modules[module].parent {
            module = parent;
        }
        module
    }

    /// Whether `inner` is `outer` or lies inside it.
    pub fn is_within(&self, inner: usize, outer: usize) -> bool {
        let mut module = Some(inner);
        while let Some(here) = module {
            if here == outer {
                return true;
            }
            module = self.tree.modules[here].parent;
        }
        false
    }
}
