//! Verb `package`: the page as a folder for any static host, the page as one file, and the npm module.

mod twice;

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};

use crate::output::announce;
use crate::page::{self, Build};
use crate::setup::{command, node};
use crate::supply::{self, notices};
use crate::{wheel, workspace};

/// Options of `package`.
///
/// Builds the page as `serve` does and writes three things into the folder:
/// `site`, to be copied to any static host, into any folder of it; `fluoropose.html`, the same page in one file,
/// which a browser opens from the disk; `npm`, the module for other programs (see its README.md). With `--python` it builds the wheel of the
/// Python package instead (see core/python/README.md), and sets up what builds it. Each holds THIRD-PARTY.txt, the parts of others with their
/// licences (the one file at its end), and the same for programs, sbom.cdx.json.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Folder to write to [default: package in cargo's target folder]
    #[arg(long)]
    out: Option<PathBuf>,
    /// The Python package, as a wheel for this kind of machine and Python 3.10 or later
    #[arg(long)]
    python: bool,
    /// Then package a copy of the sources in another folder, and fail where a bit differs
    #[arg(long, conflicts_with = "python")]
    twice: bool,
}

/// Runs the verb.
pub(crate) fn run(args: Args) -> Result<()> {
    // Parts are made by programs that run in other folders.
    let out = std::path::absolute(args.out.unwrap_or_else(usual_folder))?;
    if args.python {
        println!("For pip:           {}", wheel::make(&out)?.display());
        return Ok(());
    }
    let dist = page::build(Build::Shipped)?;
    let package = make(&dist, &out)?;
    let size = |bytes: u64| format!("{:.1} MB", bytes as f64 / 1e6);
    println!("For a static host: {}", package.site.display());
    let bytes = fs::metadata(&package.single)?.len();
    println!(
        "In one file:       {} ({})",
        package.single.display(),
        size(bytes)
    );
    println!("For npm:           {}", package.module.display());
    if args.twice {
        twice::compare(&out)?;
    }
    Ok(())
}

/// Where packages go unless somebody says otherwise.
pub(crate) fn usual_folder() -> PathBuf {
    workspace::target_dir().join("package")
}

/// What was written.
pub(crate) struct Package {
    /// Folder for a static host.
    pub site: PathBuf,
    /// The page in one file.
    pub single: PathBuf,
    /// Folder of the npm module.
    pub module: PathBuf,
}

/// Writes all three into `out`; `dist` is the page as [`page::build`] left it.
///
/// Errors name the part that could not be made.
pub(crate) fn make(dist: &Path, out: &Path) -> Result<Package> {
    Ok(Package {
        site: site(dist, &out.join("site")).context("cannot package the page's folder")?,
        single: single(&out.join("fluoropose.html"))
            .context("cannot package the page in one file")?,
        module: module(&out.join("npm")).context("cannot package the npm module")?,
    })
}

fn site(dist: &Path, to: &Path) -> Result<PathBuf> {
    empty(to)?;
    copy_folder(dist, to)?;
    notices::write(to, "the page of fluoropose", &supply::of_page()?)?;
    names_no_folder(to, &folders_here()?)?;
    Ok(to.to_path_buf())
}

fn single(to: &Path) -> Result<PathBuf> {
    let web = workspace::root().join("web");
    announce("bundling the page into one file (npm run build-embedded)");
    command::run(&mut node::script(&web, "build-embedded")?)?;
    let made = web.join("dist-embedded/fluoropose.html");
    let mut page = fs::read(&made).with_context(|| format!("cannot read {}", made.display()))?;
    let parts = notices::comment("the page of fluoropose", &supply::of_page()?)?;
    page.extend_from_slice(parts.as_bytes());
    fs::write(to, page).with_context(|| format!("cannot write {}", to.display()))?;
    Ok(to.to_path_buf())
}

/// The module's own TypeScript compiled, and beside it what `wasm-bindgen` made for the page.
fn module(to: &Path) -> Result<PathBuf> {
    let root = workspace::root();
    let (web, npm) = (root.join("web"), root.join("web/npm"));
    empty(to)?;
    announce("compiling the npm module (npm run build-module)");
    let mut compile = node::script(&web, "build-module")?;
    command::run(compile.arg("--").arg("--outDir").arg(to))?;
    for part in ["core", "decode"] {
        copy_folder(&web.join("src/pkg").join(part), &to.join("pkg").join(part))?;
    }
    copy_folder(&npm.join("example"), &to.join("example"))?;
    for name in ["package.json", "README.md"] {
        fs::copy(npm.join(name), to.join(name))?;
    }
    fs::copy(root.join("LICENSE"), to.join("LICENSE"))?;
    notices::write(to, "the npm module fluoropose", &supply::of_module()?)?;
    ensure!(
        to.join("index.js").is_file() && to.join("index.d.ts").is_file(),
        "the compiler left no index.js with types in {}",
        to.display()
    );
    types_stand_alone(to)?;
    names_no_folder(to, &folders_here()?)?;
    Ok(to.to_path_buf())
}

/// What callers import the types of, and what these import.
const TYPES: [&str; 3] = ["index.d.ts", "film.d.ts", "types.d.ts"];

/// Refuses types that import those of `wasm-bindgen`, which want a library of TypeScript that who imports the module may not have asked for.
fn types_stand_alone(module: &Path) -> Result<()> {
    for path in TYPES.map(|name| module.join(name)) {
        let types =
            fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
        ensure!(
            !types.contains("/pkg/"),
            "{} imports types of pkg: keep what needs them apart from what callers import",
            path.display()
        );
    }
    Ok(())
}

/// Folders of this machine that compilers like to write down.
fn folders_here() -> Result<[PathBuf; 2]> {
    Ok([
        workspace::cargo_home()?.join("registry"),
        workspace::root().join("core/src"),
    ])
}

/// Refuses a package of which a file names one of the folders: it may name a person, and no two machines would build the same.
fn names_no_folder(package: &Path, folders: &[PathBuf]) -> Result<()> {
    for entry in fs::read_dir(package)? {
        let path = entry?.path();
        if path.is_dir() {
            names_no_folder(&path, folders)?;
            continue;
        }
        let bytes = fs::read(&path).with_context(|| format!("cannot read {}", path.display()))?;
        let text = String::from_utf8_lossy(&bytes);
        let named = folders
            .iter()
            .find(|folder| text.contains(&*folder.to_string_lossy()));
        if let Some(folder) = named {
            bail!("{} names the folder {}", path.display(), folder.display());
        }
    }
    Ok(())
}

/// An empty folder, whatever was in it before.
fn empty(folder: &Path) -> Result<()> {
    if folder.exists() {
        fs::remove_dir_all(folder).with_context(|| format!("cannot empty {}", folder.display()))?;
    }
    fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))
}

/// Copies a folder with all that is in it, but for hidden files: those are notes of the build.
fn copy_folder(from: &Path, to: &Path) -> Result<()> {
    fs::create_dir_all(to).with_context(|| format!("cannot make {}", to.display()))?;
    let entries = fs::read_dir(from).with_context(|| format!("cannot list {}", from.display()))?;
    for entry in entries {
        let entry = entry?;
        let (source, target) = (entry.path(), to.join(entry.file_name()));
        if entry.file_name().to_string_lossy().starts_with('.') {
            continue;
        }
        if entry.file_type()?.is_dir() {
            copy_folder(&source, &target)?;
        } else {
            fs::copy(&source, &target)
                .with_context(|| format!("cannot copy {}", source.display()))?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_is_copied_without_hidden_files() {
        let scratch = std::env::temp_dir().join(format!("fluoropose-copy-{}", std::process::id()));
        let (from, to) = (scratch.join("from"), scratch.join("to"));
        fs::create_dir_all(from.join("deep")).unwrap();
        fs::write(from.join("deep/file"), "text").unwrap();
        fs::write(from.join(".stamp"), "note").unwrap();
        copy_folder(&from, &to).unwrap();
        assert_eq!(fs::read_to_string(to.join("deep/file")).unwrap(), "text");
        assert!(!to.join(".stamp").exists());
        empty(&to).unwrap();
        assert_eq!(fs::read_dir(&to).unwrap().count(), 0);
        fs::remove_dir_all(scratch).unwrap();
    }

    #[test]
    fn a_package_that_names_a_folder_of_the_machine_is_refused() {
        let scratch = std::env::temp_dir().join(format!("fluoropose-names-{}", std::process::id()));
        fs::create_dir_all(scratch.join("deep")).unwrap();
        fs::write(
            scratch.join("deep/a.wasm"),
            b"\xff\0/home/x/.cargo/registry/src\xff",
        )
        .unwrap();
        let named = |folder: &str| names_no_folder(&scratch, &[PathBuf::from(folder)]);
        assert!(named("/home/y/.cargo/registry").is_ok());
        let error = named("/home/x/.cargo/registry").unwrap_err().to_string();
        assert!(error.contains("a.wasm"), "{error}");
        fs::remove_dir_all(scratch).unwrap();
    }
}
