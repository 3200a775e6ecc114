//! The tests that a change can touch, for work in progress.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result};
use serde::Deserialize;

use super::report::Report;
use super::{native, python};
use crate::output::announce;
use crate::setup::rust_target::own_cargo;
use crate::setup::{command, components, node, telling};
use crate::workspace;

/// Tests of many poses, which take most of a minute.
const LONG: &str = "accuracy::";

/// A package of the workspace.
#[derive(Debug, Clone, Deserialize)]
struct Package {
    name: String,
    manifest_path: PathBuf,
    dependencies: Vec<Dependency>,
}

#[derive(Debug, Clone, Deserialize)]
struct Dependency {
    name: String,
}

#[derive(Deserialize)]
struct Metadata {
    packages: Vec<Package>,
}

/// Tests what differs from the revision `since`, or from where this branch left that of its origin.
///
/// # Errors
/// Where git or cargo cannot say what has changed.
pub(crate) fn run(since: Option<&str>) -> Result<Report> {
    let root = workspace::root();
    let changed = changed_paths(&root, since)?;
    let packages = packages()?;
    let mut rust = touched(&packages, &root, &changed);
    // Cargo has no tests of it.
    let python = rust.remove(python::PACKAGE);
    let web = page_sources(&changed);
    let mut report = Report::new();
    if !rust.is_empty() {
        report.step("changed: formatting", || {
            components::ensure("fmt")?;
            Ok(command::run(own_cargo().args(["fmt", "--all", "--check"]))?.into())
        });
        report.step("changed: tests of packages", || {
            announce(&rust.iter().cloned().collect::<Vec<_>>().join(", "));
            native::tests(&mut cargo_test(&rust), "changed")
        });
    }
    if python {
        python::alone(&mut report);
    }
    if !web.is_empty() {
        report.step("changed: unit tests of the page", || page_tests(&web));
    }
    tell_what_is_left_out(&changed, &rust, &web);
    Ok(report)
}

/// The paths that differ from a revision, and new files, relative to the top folder.
fn changed_paths(root: &Path, since: Option<&str>) -> Result<Vec<String>> {
    let git = |words: &[&str]| command::output(Command::new("git").args(words).current_dir(root));
    let base = match since {
        Some(revision) => revision.to_owned(),
        None => ["@{upstream}", "origin/HEAD"]
            .iter()
            .find_map(|branch| git(&["merge-base", "HEAD", branch]).ok())
            .unwrap_or_else(|| "HEAD".into()),
    };
    let base = base.trim();
    let differing = git(&["diff", "--name-only", base]).context("what has changed is not known")?;
    let new = git(&["ls-files", "--others", "--exclude-standard"])?;
    let paths: BTreeSet<String> = differing
        .lines()
        .chain(new.lines())
        .map(str::to_owned)
        .collect();
    announce(&format!("{} files differ from {base}", paths.len()));
    Ok(paths.into_iter().collect())
}

fn packages() -> Result<Vec<Package>> {
    let said =
        command::output(own_cargo().args(["metadata", "--no-deps", "--format-version", "1"]))?;
    let metadata: Metadata =
        serde_json::from_str(&said).context("cargo's metadata cannot be read")?;
    Ok(metadata.packages)
}

/// The packages that changed, and those that depend on them.
fn touched(packages: &[Package], root: &Path, changed: &[String]) -> BTreeSet<String> {
    let folder = |package: &Package| package.manifest_path.parent().map(Path::to_path_buf);
    // A package may lie in the folder of another: the deepest that holds a file has it.
    let owner = |path: &String| {
        let path = root.join(path);
        let holding = packages
            .iter()
            .filter(|package| folder(package).is_some_and(|folder| path.starts_with(folder)));
        holding.max_by_key(|package| package.manifest_path.components().count())
    };
    let everything = |path: &String| ["Cargo.toml", "Cargo.lock"].contains(&path.as_str());
    if changed.iter().any(everything) {
        return packages
            .iter()
            .map(|package| package.name.clone())
            .collect();
    }
    let tested = |path: &&String| {
        !path.starts_with("tests/browser/") && !path.starts_with("tests/firmware/")
    };
    let mut touched: BTreeSet<String> = changed
        .iter()
        .filter(tested)
        .filter_map(|path| Some(owner(path)?.name.clone()))
        .collect();
    loop {
        let depends = |package: &&Package| {
            package
                .dependencies
                .iter()
                .any(|other| touched.contains(&other.name))
        };
        let more: Vec<String> = packages
            .iter()
            .filter(depends)
            .map(|p| p.name.clone())
            .collect();
        let before = touched.len();
        touched.extend(more);
        if touched.len() == before {
            return touched;
        }
    }
}

/// Sources and tests of the page, relative to `web`.
fn page_sources(changed: &[String]) -> Vec<String> {
    let inside = changed.iter().filter_map(|path| path.strip_prefix("web/"));
    let code = inside.filter(|path| path.ends_with(".ts") || path.ends_with(".tsx"));
    let there = code.filter(|path| workspace::root().join("web").join(path).is_file());
    there.map(str::to_owned).collect()
}

/// Tests with the profile `dev`, which compiles anew only what has changed.
fn cargo_test(packages: &BTreeSet<String>) -> Command {
    let mut cargo = own_cargo();
    cargo.args(["test", "--no-fail-fast"]);
    for package in packages {
        cargo.args(["--package", package]);
    }
    cargo.args(["--", "--skip", LONG]);
    cargo
}

fn page_tests(sources: &[String]) -> Result<super::report::Said> {
    let web = workspace::root().join("web");
    node::install(&web)?;
    let mut vitest = Command::new(node::npm()?);
    vitest
        .args([
            "exec",
            "--",
            "vitest",
            "related",
            "--run",
            "--passWithNoTests",
        ])
        .args(sources)
        .current_dir(web);
    let told = command::tee(&mut vitest)?;
    told.or_failed("a unit test of the page", telling::of_vitest)?;
    // A source that no test reads has none.
    Ok(super::counts::of_vitest(&told.output).map_or_else(|_| ().into(), Into::into))
}

fn tell_what_is_left_out(changed: &[String], rust: &BTreeSet<String>, web: &[String]) {
    let mut left: Vec<String> = Vec::new();
    if !rust.is_empty() {
        left.push("lints".into());
        left.push(format!("the long tests {LONG}*"));
    }
    if rust.contains("fluoropose") || changed.iter().any(|p| p.starts_with("tests/firmware/")) {
        left.push("the firmware".into());
    }
    let of_page = |path: &String| {
        ["web/", "wasm/", "core/", "tests/browser/"]
            .iter()
            .any(|f| path.starts_with(f))
    };
    if changed.iter().any(of_page) {
        left.push("the page in browsers, its types and its packages".into());
    }
    if web.is_empty() && rust.contains("fluoropose-wasm") {
        left.push("the page's unit tests".into());
    }
    if left.is_empty() {
        announce("nothing that the change can touch is left out");
    } else {
        announce(&format!(
            "left out: {}; `cargo xtask test` runs all",
            left.join(", ")
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn package(name: &str, folder: &str, needs: &[&str]) -> Package {
        let dependency = |name: &&str| Dependency {
            name: (*name).to_owned(),
        };
        Package {
            name: name.into(),
            manifest_path: Path::new("/w").join(folder).join("Cargo.toml"),
            dependencies: needs.iter().map(dependency).collect(),
        }
    }

    fn touched_by(paths: &[&str]) -> Vec<String> {
        let packages = [
            package("core", "core", &[]),
            package("kernels", "core/kernels", &["core"]),
            package("wasm", "wasm", &["core"]),
            package("decode", "wasm/decode", &[]),
            package("laboratory", "xtask/laboratory", &["kernels", "decode"]),
            package("tests", "tests", &["laboratory"]),
        ];
        let paths: Vec<String> = paths.iter().map(|path| (*path).to_owned()).collect();
        touched(&packages, Path::new("/w"), &paths)
            .into_iter()
            .collect()
    }

    #[test]
    fn a_package_touches_what_depends_on_it_near_and_far() {
        assert_eq!(
            touched_by(&["core/kernels/src/lib.rs"]),
            ["kernels", "laboratory", "tests"]
        );
        assert_eq!(
            touched_by(&["wasm/decode/src/lib.rs"]),
            ["decode", "laboratory", "tests"]
        );
        assert_eq!(touched_by(&["wasm/src/lib.rs", "README.md"]), ["wasm"]);
        assert_eq!(touched_by(&["core/src/lib.rs"]).len(), 5);
        assert_eq!(touched_by(&["Cargo.lock"]).len(), 6);
        assert!(touched_by(&["tests/browser/keys.test.mjs", "web/src/main.ts"]).is_empty());
    }
}
