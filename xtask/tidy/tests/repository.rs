//! The whole check on small made-up repositories.
#![allow(clippy::unwrap_used, reason = "it fails the test")]

use std::fs;
use std::path::PathBuf;

/// A repository in a temporary folder of its own.
struct Repository(PathBuf);

impl Repository {
    /// A repository with two rooms in a crate and two in the page, in which nothing is wrong.
    fn new(name: &str) -> Self {
        let folder =
            std::env::temp_dir().join(format!("fluoropose-tidy-{name}-{}", std::process::id()));
        let repository = Self(folder);
        for (file, text) in [
            ("Cargo.toml", "[workspace]\nmembers = [\"core\"]\n"),
            (".gitignore", "/target\n/made\n"),
            ("made/anything", ""),
            ("core/Cargo.toml", "[package]\nname = \"fluoropose\"\n"),
            ("core/layers.txt", "math\nsearch\n"),
            (
                "core/src/lib.rs",
                "pub mod math;\npub mod search;\npub use search::find;\n",
            ),
            ("core/src/math.rs", "pub fn sqrt() {}\n"),
            (
                "core/src/search/mod.rs",
                "mod query;\npub use query::find;\n",
            ),
            (
                "core/src/search/query.rs",
                "use crate::math::sqrt;\npub fn find() { sqrt() }\n",
            ),
            ("web/package.json", "{}"),
            ("web/layers.txt", "document # intent\nview\n"),
            ("web/src/document/types.ts", "export type Doc = string;\n"),
            (
                "web/src/view/page.tsx",
                "import type { Doc } from '../document/types';\nexport const page = (doc: Doc) => doc;\n",
            ),
            (
                "web/src/main.tsx",
                "import { page } from './view/page';\npage('');\n",
            ),
            ("xtask/tidy/words.txt", "tally -> count\n"),
        ] {
            repository.write(file, text);
        }
        repository
    }

    fn write(&self, file: &str, text: &str) {
        let path = self.0.join(file);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }

    fn errors(&self) -> Vec<String> {
        fluoropose_tidy::check(&self.0).unwrap().errors
    }
}

impl Drop for Repository {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[test]
fn nothing_is_wrong_with_a_tidy_repository() {
    assert_eq!(Repository::new("tidy").errors(), [""; 0]);
}

#[test]
fn a_use_of_a_room_above_is_an_error_in_both_languages() {
    let repository = Repository::new("layers");
    repository.write("core/src/math.rs", "pub fn sqrt() { crate::find() }\n");
    repository.write(
        "web/src/document/types.ts",
        "import type { page } from '../view/page';\nexport type Doc = string;\n",
    );
    assert_eq!(
        repository.errors(),
        [
            "cycle: core/src/math.rs:1 uses find -> core/src/search/query.rs:1 uses sqrt -> core/src/math.rs",
            "core/src/math.rs:1 uses find of core/src/search/query.rs: room `math` is below room `search`",
            "cycle: web/src/document/types.ts:1 uses page -> web/src/view/page.tsx:1 uses Doc -> web/src/document/types.ts",
            "web/src/document/types.ts:1 uses page of web/src/view/page.tsx: room `document` is below room `view`",
        ]
    );
}

#[test]
fn a_room_that_is_missing_or_empty_is_an_error() {
    let repository = Repository::new("rooms");
    repository.write("core/src/lib.rs", "pub mod math;\nmod loose;\n");
    repository.write("core/src/loose.rs", "");
    assert_eq!(
        repository.errors(),
        [
            "core/src/loose.rs is in no room of layers.txt",
            "core/src: room `search` of layers.txt holds no file",
        ]
    );
}

#[test]
fn each_further_fault_is_an_error() {
    let repository = Repository::new("faults");
    repository.write("notes.txt", "");
    repository.write("README.md", concat!("# fluoropose\n\nTO", "DO\n"));
    repository.write(
        "core/tests/one.rs",
        "#[test]\n#[ignore]\nfn one() { let tally = 1; }\n",
    );
    repository.write(
        "web/tests/two.test.ts",
        "it.skip('two', () => {});\nconst bestTally = 1;\n",
    );
    assert_eq!(
        repository.errors(),
        [
            "notes.txt has no place at the top of the repository",
            concat!("README.md:3 has TO", "DO"),
            "core/tests/one.rs:2 has #[ignore]",
            "core/tests/one.rs:3 `tally`: `tally` is called count here",
            "web/tests/two.test.ts:1 has .skip(",
            "web/tests/two.test.ts:2 `bestTally`: `tally` is called count here",
        ]
    );
}

#[test]
fn a_graph_is_told_room_by_room() {
    let repository = Repository::new("graph");
    let told = fluoropose_tidy::graph_text(&repository.0, "core").unwrap();
    let expected = "core/src\n\n  math\n    math.rs\n\n  search\n    search/mod.rs\n    search/query.rs\n      \
                    -> math.rs  sqrt (line 1)\n\n  top\n    lib.rs\n";
    assert_eq!(told, expected);
    assert!(
        fluoropose_tidy::graph_text(&repository.0, "core/src/search")
            .unwrap()
            .contains("query.rs")
    );
    assert!(fluoropose_tidy::graph_text(&repository.0, "nowhere").is_err());
}

#[test]
fn a_file_that_cannot_be_parsed_is_told_with_its_line() {
    let repository = Repository::new("broken");
    repository.write("core/src/math.rs", "pub fn sqrt() {}\nfn {}\n");
    let error = format!("{:#}", fluoropose_tidy::check(&repository.0).unwrap_err());
    assert!(error.ends_with("line 2: expected identifier"), "{error}");
}
