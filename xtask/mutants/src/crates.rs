//! Packages, their sources and their tests, as cargo tells of them.

use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, ensure};
use serde_json::Value;

use crate::change::Change;
use crate::places;

/// A package of a workspace.
pub struct Package {
    /// Its name.
    pub name: String,
    /// Its manifest.
    pub manifest: PathBuf,
    /// The first file of its library.
    pub library: PathBuf,
}

/// A package by its name.
///
/// # Errors
/// Where cargo does not know it, or where it has no library.
pub fn package(root: &Path, name: &str) -> Result<Package> {
    let mut command = cargo(root);
    command.args([
        "metadata",
        "--no-deps",
        "--format-version",
        "1",
        "--offline",
    ]);
    let told = command.stderr(Stdio::inherit()).output()?;
    ensure!(
        told.status.success(),
        "cargo does not tell of {}",
        root.display()
    );
    let told: Value = serde_json::from_slice(&told.stdout)?;
    let packages = told["packages"].as_array().into_iter().flatten();
    let mut named = packages.filter(|one| one["name"] == name);
    let one = named
        .next()
        .with_context(|| format!("no package is called {name}"))?;
    let is_library = |target: &&Value| {
        let kinds = target["kind"].as_array().into_iter().flatten();
        kinds
            .into_iter()
            .any(|kind| kind.as_str().is_some_and(|kind| kind.ends_with("lib")))
    };
    let mut libraries = one["targets"]
        .as_array()
        .into_iter()
        .flatten()
        .filter(is_library);
    let library = libraries
        .next()
        .with_context(|| format!("{name} has no library"))?;
    let path = |value: &Value| value.as_str().map(PathBuf::from).context("no path");
    Ok(Package {
        name: name.to_owned(),
        manifest: path(&one["manifest_path"])?,
        library: path(&library["src_path"])?,
    })
}

/// Cargo, which gets none of our standard input.
pub(crate) fn cargo(root: &Path) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.current_dir(root).stdin(Stdio::null());
    command.env("CARGO_TARGET_DIR", root.join("target"));
    // Of a linter that is put before the compiler, what `cargo xtask` itself was called with.
    command.env_remove("RUSTC_WORKSPACE_WRAPPER");
    command
}

/// All changes of a library, module by module.
///
/// # Errors
/// For a module whose file is not there, and what is no Rust.
pub(crate) fn changes(root: &Path, package: &Package) -> Result<Vec<Change>> {
    let mut all = Vec::new();
    let mut left = vec![(
        package.library.clone(),
        package.library.parent().map(Path::to_owned),
    )];
    while let Some((file, folder)) = left.pop() {
        let folder = folder.context("a file at the root")?;
        let text =
            fs::read_to_string(&file).with_context(|| format!("cannot read {}", file.display()))?;
        let name = file
            .strip_prefix(root)
            .unwrap_or(&file)
            .display()
            .to_string();
        let (changes, modules) = places::of_file(&name, &text)?;
        all.extend(changes);
        for module in modules {
            let inside = folder.join(&module);
            let beside = folder.join(format!("{module}.rs"));
            let file = if beside.is_file() {
                beside
            } else {
                inside.join("mod.rs")
            };
            left.push((file, Some(inside)));
        }
    }
    all.sort_by(|a, b| (&a.file, a.line).cmp(&(&b.file, b.line)));
    Ok(all)
}

/// Files below the root, and bytes of them.
pub(crate) type Places = Vec<(String, Range<usize>)>;

/// What the compiler does not take: the file below the root, and the bytes that it speaks of, of each error.
///
/// # Errors
/// Where cargo cannot be started, or fails for another reason.
pub(crate) fn refused(root: &Path, arguments: &[&str]) -> Result<Vec<Places>> {
    let mut command = cargo(root);
    command.args(arguments).arg("--message-format=json");
    let said = command.stderr(Stdio::piped()).output()?;
    let mut all = Vec::new();
    for line in String::from_utf8_lossy(&said.stdout).lines() {
        let Ok(line) = serde_json::from_str::<Value>(line) else {
            continue;
        };
        let message = &line["message"];
        if line["reason"] != "compiler-message" || message["level"] != "error" {
            continue;
        }
        let spans: Places = message["spans"]
            .as_array()
            .into_iter()
            .flatten()
            .filter_map(span)
            .collect();
        if !spans.is_empty() {
            all.push(spans);
        }
    }
    ensure!(
        said.status.success() || !all.is_empty(),
        "cargo {} failed: {}",
        arguments.join(" "),
        String::from_utf8_lossy(&said.stderr)
    );
    Ok(all)
}

fn span(span: &Value) -> Option<(String, Range<usize>)> {
    let byte = |name: &str| span[name].as_u64().map(|byte| byte as usize);
    let name = span["file_name"].as_str()?;
    Some((name.to_owned(), byte("byte_start")?..byte("byte_end")?))
}

/// The programs that hold a package's tests, compiled, and the folder that they run in.
///
/// # Errors
/// Where they do not compile.
pub(crate) fn test_programs(root: &Path, arguments: &[&str]) -> Result<Vec<(PathBuf, PathBuf)>> {
    let mut command = cargo(root);
    command
        .args(arguments)
        .args(["--no-run", "--message-format=json-render-diagnostics"]);
    let said = command
        .env("RUSTFLAGS", "--cap-lints=allow")
        .stderr(Stdio::inherit())
        .output()?;
    ensure!(said.status.success(), "the tests do not compile");
    let program = |line: &str| {
        let line: Value = serde_json::from_str(line).ok()?;
        let file = line["executable"].as_str()?;
        let folder = Path::new(line["manifest_path"].as_str()?).parent()?;
        line["profile"]["test"]
            .as_bool()?
            .then(|| (file.into(), folder.to_owned()))
    };
    Ok(String::from_utf8_lossy(&said.stdout)
        .lines()
        .filter_map(program)
        .collect())
}
