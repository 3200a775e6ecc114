//! What comes from elsewhere, as `cargo metadata` and the lock files tell it.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use serde::Deserialize;
use serde_json::Value;

use super::licence;
use crate::setup::command;
use crate::setup::rust_target::own_cargo;
use crate::workspace;

/// A package of another origin.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Part {
    /// Where it comes from: `cargo` or `npm`, as package addresses (purl) call them; `generic` for Rust's own library.
    pub(crate) kind: &'static str,
    pub(crate) name: String,
    pub(crate) version: String,
    /// SPDX expression; empty where none is stated.
    pub(crate) licence: String,
    /// Digest of what the registry gave: an algorithm's name, and hexadecimal digits.
    pub(crate) digest: Option<(&'static str, String)>,
    /// Where it lies on this machine; in no file that leaves the house.
    pub(crate) folder: Option<PathBuf>,
    /// Whether the registry gave it.
    pub(crate) from_registry: bool,
}

#[derive(Deserialize)]
struct Metadata {
    packages: Vec<Package>,
    resolve: Resolve,
}

#[derive(Deserialize)]
struct Package {
    id: String,
    name: String,
    version: String,
    license: Option<String>,
    source: Option<String>,
    manifest_path: PathBuf,
}

#[derive(Deserialize)]
struct Resolve {
    nodes: Vec<Node>,
}

#[derive(Deserialize)]
struct Node {
    id: String,
    deps: Vec<Edge>,
}

#[derive(Deserialize)]
struct Edge {
    pkg: String,
    dep_kinds: Vec<EdgeKind>,
}

#[derive(Deserialize)]
struct EdgeKind {
    kind: Option<String>,
}

const REGISTRY: &str = "registry+https://github.com/rust-lang/crates.io-index";

/// All crates that a workspace's lock file names, whatever for and on whatever machine.
///
/// Errors where cargo cannot tell.
pub(crate) fn crates(folder: &Path) -> Result<Vec<Part>> {
    let metadata = metadata(folder, None)?;
    let checksums = checksums(&fs::read_to_string(folder.join("Cargo.lock"))?);
    let foreign = metadata.packages.iter().filter(|one| one.source.is_some());
    Ok(foreign.map(|package| part(package, &checksums)).collect())
}

/// The crates that are compiled into ours for a target, with Rust's own library. Features are those of the whole workspace: a crate
/// may be named that is not in it, none is left out.
///
/// Errors where cargo cannot tell, or knows no such crate.
pub(crate) fn compiled_into(roots: &[&str], target: &str) -> Result<Vec<Part>> {
    let root = workspace::root();
    let metadata = metadata(&root, Some(target))?;
    let checksums = checksums(&fs::read_to_string(root.join("Cargo.lock"))?);
    let nodes: BTreeMap<&str, &Node> = metadata
        .resolve
        .nodes
        .iter()
        .map(|node| (node.id.as_str(), node))
        .collect();
    let is_root =
        |package: &&Package| package.source.is_none() && roots.contains(&package.name.as_str());
    let mut open: Vec<&str> = metadata
        .packages
        .iter()
        .filter(is_root)
        .map(|package| package.id.as_str())
        .collect();
    if open.len() != roots.len() {
        bail!("not all of {} are crates here", roots.join(", "));
    }
    let mut seen: BTreeSet<&str> = open.iter().copied().collect();
    while let Some(id) = open.pop() {
        let edges = nodes.get(id).map_or(&[][..], |node| &node.deps);
        let compiled = edges
            .iter()
            .filter(|edge| edge.dep_kinds.iter().any(|one| one.kind.is_none()));
        open.extend(
            compiled
                .map(|edge| edge.pkg.as_str())
                .filter(|id| seen.insert(id)),
        );
    }
    let used = metadata
        .packages
        .iter()
        .filter(|package| package.source.is_some() && seen.contains(package.id.as_str()));
    let mut parts: Vec<Part> = used.map(|package| part(package, &checksums)).collect();
    parts.push(rusts_library()?);
    parts.sort();
    Ok(parts)
}

fn part(package: &Package, checksums: &BTreeMap<(String, String), String>) -> Part {
    let key = (package.name.clone(), package.version.clone());
    Part {
        kind: "cargo",
        licence: licence::expression(package.license.as_deref().unwrap_or_default()),
        digest: checksums.get(&key).map(|hex| ("SHA-256", hex.clone())),
        folder: package.manifest_path.parent().map(Path::to_path_buf),
        from_registry: package.source.as_deref() == Some(REGISTRY) && checksums.contains_key(&key),
        name: package.name.clone(),
        version: package.version.clone(),
    }
}

/// It is in whatever a compiler makes, and in no lock file.
fn rusts_library() -> Result<Part> {
    Ok(Part {
        kind: "generic",
        name: "rust-std".to_owned(),
        version: compiler("release: ")?,
        licence: "MIT OR Apache-2.0".to_owned(),
        digest: None,
        folder: None,
        from_registry: true,
    })
}

/// Letters of figures that are pictures: a part of a font, which stands in the repository with its licence.
pub(crate) fn letters() -> Part {
    Part {
        kind: "generic",
        name: "Arimo".to_owned(),
        version: "1.33".to_owned(),
        licence: "OFL-1.1".to_owned(),
        digest: None,
        folder: Some(workspace::root().join("core/report/fonts")),
        from_registry: false,
    }
}

/// The target that is this machine.
///
/// Errors where the compiler does not say.
pub(crate) fn this_machine() -> Result<String> {
    compiler("host: ")
}

/// What the compiler says of itself.
fn compiler(key: &str) -> Result<String> {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let said = command::output(std::process::Command::new(rustc).arg("-vV"))?;
    let told = said.lines().find_map(|line| line.strip_prefix(key));
    Ok(told.context("rustc does not say what it is")?.to_owned())
}

/// Without the network where that will do: a machine that compiled for itself alone may lack crates of others.
fn metadata(folder: &Path, target: Option<&str>) -> Result<Metadata> {
    let ask = |more: &[&str]| {
        let mut cargo = own_cargo();
        cargo.args(["metadata", "--locked", "--format-version", "1"]);
        cargo
            .args(more)
            .arg("--manifest-path")
            .arg(folder.join("Cargo.toml"));
        if let Some(target) = target {
            cargo.args(["--filter-platform", target]);
        }
        command::output(&mut cargo)
    };
    let text = ask(&["--offline"]).or_else(|_| ask(&[]))?;
    serde_json::from_str(&text).context("cargo metadata says something else")
}

/// Checksums of a `Cargo.lock` by name and version.
fn checksums(lock: &str) -> BTreeMap<(String, String), String> {
    let value = |block: &str, key: &str| {
        let line = block.lines().find_map(|line| line.strip_prefix(key))?;
        Some(line.trim_matches([' ', '=', '"']).to_owned())
    };
    let blocks = lock.split("[[package]]").skip(1);
    let entry = |block| {
        let name = (value(block, "name")?, value(block, "version")?);
        Some((name, value(block, "checksum")?))
    };
    blocks.filter_map(entry).collect()
}

/// The packages that a folder's `package-lock.json` names; `shipped`: without those for building and testing alone.
///
/// Errors where the file cannot be read.
pub(crate) fn packages(folder: &Path, shipped: bool) -> Result<Vec<Part>> {
    let path = folder.join("package-lock.json");
    let text =
        fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
    let lock: Value = serde_json::from_str(&text).context("the lock file of npm is no JSON")?;
    let packages = lock["packages"].as_object();
    let packages = packages.context("the lock file of npm names no packages")?;
    let of_others = packages.iter().filter(|(place, _)| !place.is_empty());
    let wanted = of_others.filter(|(_, package)| !shipped || package["dev"] != true);
    let mut parts: Vec<Part> = wanted
        .map(|(place, package)| of_lock(folder, place, package))
        .collect();
    parts.sort();
    Ok(parts)
}

fn of_lock(folder: &Path, place: &str, package: &Value) -> Part {
    let text = |key: &str| package[key].as_str().unwrap_or_default();
    let name = place
        .rsplit_once("node_modules/")
        .map_or(place, |(_, name)| name);
    let digest = text("integrity")
        .strip_prefix("sha512-")
        .and_then(hex_of_base64);
    // Without an address npm takes the registry that it is set to.
    let address = text("resolved");
    let of_registry = address.is_empty() || address.starts_with("https://registry.npmjs.org/");
    Part {
        kind: "npm",
        name: name.to_owned(),
        version: text("version").to_owned(),
        licence: text("license").to_owned(),
        from_registry: of_registry && digest.is_some() && package["link"] != true,
        digest: digest.map(|hex| ("SHA-512", hex)),
        folder: Some(folder.join(place)),
    }
}

fn hex_of_base64(text: &str) -> Option<String> {
    const LETTERS: &str = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let (mut bits, mut held, mut hex) = (0_u32, 0, String::new());
    for letter in text.trim_end_matches('=').chars() {
        bits = bits << 6 | LETTERS.find(letter)? as u32;
        held += 6;
        // Four bits a hexadecimal digit.
        while held >= 4 {
            held -= 4;
            hex.push(char::from_digit(bits >> held & 15, 16)?);
        }
        bits &= (1 << held) - 1;
    }
    // What fills the last letter is no digit.
    hex.truncate(hex.len() / 2 * 2);
    Some(hex)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digests_are_read_from_both_lock_files() {
        assert_eq!(hex_of_base64("AAEC/v8=").unwrap(), "000102feff");
        assert_eq!(hex_of_base64("TWFu").unwrap(), "4d616e");
        assert_eq!(hex_of_base64("!"), None);
        let lock = "version = 4\n\n[[package]]\nname = \"a\"\nversion = \"1.0.0\"\nchecksum = \"ab\"\n\n[[package]]\nname = \"own\"\nversion = \"0.1.0\"\n";
        let found = checksums(lock);
        assert_eq!(found.len(), 1);
        assert_eq!(found[&("a".to_owned(), "1.0.0".to_owned())], "ab");
    }

    #[test]
    fn a_package_from_elsewhere_is_told_apart() {
        let sound = serde_json::json!({"version": "1.0.0", "integrity": "sha512-AAEC/v8=", "license": "MIT"});
        let of =
            |package: &Value| of_lock(Path::new(""), "node_modules/a/node_modules/@b/c", package);
        let part = of(&sound);
        assert_eq!((part.name.as_str(), part.from_registry), ("@b/c", true));
        for (key, value) in [
            ("resolved", serde_json::json!("git+ssh://x/y")),
            ("integrity", serde_json::json!("")),
            ("link", serde_json::json!(true)),
        ] {
            let mut other = sound.clone();
            other[key] = value;
            assert!(!of(&other).from_registry, "{key}");
        }
    }

    #[test]
    fn what_is_compiled_in_is_followed_and_what_only_tests_need_is_not() {
        let parts = compiled_into(&["fluoropose-decode"], "wasm32-unknown-unknown").unwrap();
        let has = |name: &str| parts.iter().any(|part| part.name == name);
        // Of its own, of another's, and of tests alone.
        assert!(has("png") && has("fdeflate") && has("rust-std"));
        assert!(!has("proptest") && !has("clap") && !has("fluoropose"));
        assert!(compiled_into(&["no-such-crate"], "wasm32-unknown-unknown").is_err());
    }
}
