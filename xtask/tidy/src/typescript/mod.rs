//! TypeScript: which file of a source folder uses which.
//!
//! An import, also one of types only, is an edge to the file that declares the name, through files that pass it on.
//! `export .. from` is no edge where it passes on what lies in the own folder. `import * as x` is an edge to the file
//! itself. A worker's address, `new URL('./worker.ts', import.meta.url)`, is none: it starts another program.

pub mod facts;
pub mod module;
pub mod tokens;

use std::collections::{BTreeMap, BTreeSet};

use crate::graph::Graph;
use crate::layers::module_path;
use module::{Import, Module};

/// The graph of a source folder from its files by their paths below it.
pub fn graph(src: &str, modules: &BTreeMap<String, Module>) -> Graph {
    let files: Vec<String> = modules.keys().cloned().collect();
    let mut graph = Graph {
        src: src.to_string(),
        files,
        ..Graph::default()
    };
    let scope = Scope { modules };
    for (from, (file, module)) in modules.iter().enumerate() {
        let passed_on = |import: &&Import| {
            let own = format!("{}/", module_path(file));
            scope
                .file(file, &import.from)
                .is_some_and(|target| target.starts_with(&own))
        };
        let uses = module.re_exports.iter().filter(|import| !passed_on(import));
        for import in module.imports.iter().chain(uses) {
            if let Some(target) = scope.definers(file, import, &mut BTreeSet::new())
                && let Some(to) = graph.files.iter().position(|file| *file == target)
            {
                graph.note(from, to, import.line, &import.name);
            }
        }
    }
    graph
}

struct Scope<'a> {
    modules: &'a BTreeMap<String, Module>,
}

/// Names asked for on the way to an answer, so that files that pass on to each other end.
type Asked = BTreeSet<(String, String)>;

impl Scope<'_> {
    /// The file that a relative path means.
    fn file(&self, user: &str, from: &str) -> Option<String> {
        if !from.starts_with('.') {
            return None;
        }
        let folder = user.rsplit_once('/').map_or("", |(folder, _)| folder);
        let path = within(&format!("{folder}/{from}"))?;
        let stem = path.strip_suffix(".js").unwrap_or(&path);
        let endings = ["", ".ts", ".tsx", "/index.ts", "/index.tsx"];
        let candidates = endings.iter().map(|ending| {
            format!("{stem}{ending}")
                .trim_start_matches('/')
                .to_string()
        });
        candidates
            .into_iter()
            .find(|file| self.modules.contains_key(file))
    }

    /// The file that declares what is imported; the file it is imported from where that cannot be told.
    fn definers(&self, user: &str, import: &Import, asked: &mut Asked) -> Option<String> {
        let target = self.file(user, &import.from)?;
        if import.name == "*" {
            return Some(target);
        }
        Some(
            self.declaring(&target, &import.name, asked)
                .unwrap_or(target),
        )
    }

    /// The file that declares a name which `file` exports.
    fn declaring(&self, file: &str, name: &str, asked: &mut Asked) -> Option<String> {
        if !asked.insert((file.to_string(), name.to_string())) {
            return None;
        }
        let module = &self.modules[file];
        if module.declared.contains(name) {
            return Some(file.to_string());
        }
        if let Some(import) = module.re_exports.iter().find(|import| import.local == name) {
            return self.definers(file, import, asked);
        }
        if let Some((_, inside)) = module.exports.iter().find(|(outside, _)| outside == name) {
            let import = module.imports.iter().find(|import| import.local == *inside);
            return import.map_or(Some(file.to_string()), |import| {
                self.definers(file, import, asked)
            });
        }
        let stars = module
            .re_exports
            .iter()
            .filter(|import| import.name == "*" && import.local.is_empty());
        let mut targets = stars.filter_map(|import| self.file(file, &import.from));
        targets.find_map(|target| self.declaring(&target, name, asked))
    }
}

/// A path without `.` and `..`; none when it leads out of the folder.
fn within(path: &str) -> Option<String> {
    let mut parts = Vec::new();
    for part in path.split('/') {
        match part {
            "." | "" => {}
            ".." => {
                parts.pop()?;
            }
            _ => parts.push(part),
        }
    }
    Some(parts.join("/"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn graph_of(files: &[(&str, &str)]) -> Graph {
        let modules = files
            .iter()
            .map(|(file, text)| ((*file).to_string(), Module::parse(text)));
        graph("web/src", &modules.collect())
    }

    #[test]
    fn a_cycle_is_seen_through_types_and_passed_on_names() {
        let knotted = graph_of(&[
            (
                "document/index.ts",
                "export { A } from './a';\nexport * from './b';",
            ),
            (
                "document/a.ts",
                "import type { View } from '../view/view';\nexport interface A { view: View }",
            ),
            ("document/b.ts", "export const b = 1;"),
            (
                "view/view.tsx",
                "import { b } from '../document';\nimport { A } from '../document';\nexport type View = A;",
            ),
        ]);
        assert_eq!(
            knotted.cycles(),
            [
                "cycle: web/src/document/a.ts:1 uses View -> web/src/view/view.tsx:2 uses A -> web/src/document/a.ts"
            ]
        );
        assert_eq!(knotted.uses.len(), 3);
    }

    #[test]
    fn what_is_passed_on_from_elsewhere_is_a_use() {
        let sideways = graph_of(&[
            (
                "a.ts",
                "export { B } from './b';\nexport { C } from './a/c';",
            ),
            (
                "b.ts",
                "import './styles.css';\nimport { x } from 'library';\nimport y from '../../out';\nexport class B {}",
            ),
            (
                "a/c.ts",
                "import { B } from '../a';\nimport * as all from '../a';\nexport class C {}",
            ),
        ]);
        let pairs: Vec<(usize, usize)> = sideways.uses.keys().copied().collect();
        // In the order of names: a.ts, a/c.ts, b.ts.
        assert_eq!(pairs, [(0, 2), (1, 0), (1, 2)]);
    }

    #[test]
    fn an_import_that_is_exported_again_is_followed() {
        let followed = graph_of(&[
            ("a.ts", "import { B } from './b';\nexport { B as Other };"),
            ("b.ts", "export class B {}"),
            ("c.ts", "import { Other } from './a';"),
        ]);
        let pairs: Vec<(usize, usize)> = followed.uses.keys().copied().collect();
        assert_eq!(pairs, [(0, 1), (2, 1)]);
    }

    #[test]
    fn files_that_pass_on_to_each_other_end() {
        let circle = graph_of(&[
            ("a.ts", "export * from './b';"),
            ("b.ts", "export * from './a';"),
            ("c.ts", "import { Missing } from './a';"),
        ]);
        assert_eq!(circle.cycles().len(), 1);
    }
}
