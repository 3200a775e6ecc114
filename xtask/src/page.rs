//! Builds the page: its WASM modules, their JavaScript, the demonstration data and the bundle.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, ensure};
use fluoropose_phantom::sequence;
use wasm_bindgen_cli_support::Bindgen;

use crate::clock::timed;
use crate::setup::rust_target::{self, Toolchain};
use crate::setup::{command, node};
use crate::workspace::{self, Stamp};

/// One of the page's WASM modules.
struct Module {
    package: &'static str,
    /// The folder of `web/src/pkg` for its JavaScript.
    folder: &'static str,
}

/// What the page's own thread needs, and has to load first.
const PAGE: Module = Module {
    package: "fluoropose-page",
    folder: "page",
};
/// All of the core, for workers.
const CORE: Module = Module {
    package: "fluoropose-wasm",
    folder: "core",
};
const DECODE: Module = Module {
    package: "fluoropose-decode",
    folder: "decode",
};
const MODULES: [&Module; 3] = [&PAGE, &CORE, &DECODE];

/// How WASM modules are compiled.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Build {
    /// As they are shipped: as small as can be.
    Shipped,
    /// In a third of the time, for a page on this machine: each crate compiled in several pieces side by side.
    /// Results are the same. It has the profile of this program, with which it shares macros and build scripts.
    Quick,
}

impl Build {
    fn profile(self) -> &'static str {
        match self {
            Self::Shipped => "wasm",
            Self::Quick => "release",
        }
    }
}

/// With 128-bit vectors, which every engine has that the page's own language asks for (but Safari 16.0 to 16.3), and without the
/// folders of this machine, which would stand in the text of panics: they may name a person, and two machines would build two pages.
fn compiler_settings() -> Result<[String; 2]> {
    let mut flags = vec!["-Ctarget-feature=+simd128".to_owned()];
    for (folder, instead) in [
        (workspace::cargo_home()?, "/cargo"),
        (workspace::root(), "/fluoropose"),
    ] {
        flags.push(format!(
            "--remap-path-prefix={}={instead}",
            folder.display()
        ));
    }
    // A list of texts in JSON is one in TOML.
    let flags = serde_json::to_string(&flags)?;
    let setting = format!("target.wasm32-unknown-unknown.rustflags={flags}");
    Ok(["--config".to_owned(), setting])
}

/// Sets up what is missing, builds everything and returns the folder to serve (`web/dist`).
///
/// Packages are fetched and the demonstration is drawn while the modules are compiled.
pub(crate) fn build(how: Build) -> Result<PathBuf> {
    // Said now rather than after a minute of building.
    node::npm()?;
    let web = workspace::root().join("web");
    let (packages, demonstration, modules) = std::thread::scope(|scope| {
        let packages = scope.spawn(|| node::install(&web));
        let demonstration = scope.spawn(|| write_demonstration(&web));
        let modules = build_wasm(&web, how);
        (packages.join(), demonstration.join(), modules)
    });
    modules?;
    let panicked = |_| anyhow!("a thread that builds the page ended in a panic");
    packages.map_err(panicked)??;
    demonstration.map_err(panicked)??;
    timed("bundling the page (npm run build)", || {
        command::run(&mut node::script(&web, "build")?)
    })?;
    let dist = web.join("dist");
    ensure!(
        dist.join("index.html").is_file(),
        "`npm run build` left no index.html in web/dist"
    );
    Ok(dist)
}

/// Builds the WASM modules and writes their JavaScript and TypeScript into `web/src/pkg`.
fn build_wasm(web: &Path, how: Build) -> Result<()> {
    let toolchain = rust_target::ensure(rust_target::WASM)?;
    let files = build_modules(&toolchain, how)?;
    for (module, file) in MODULES.iter().zip(files) {
        generate_bindings(&file, &web.join("src/pkg").join(module.folder))?;
    }
    Ok(())
}

impl Module {
    /// The file that the compiler writes.
    fn file(&self) -> String {
        format!("{}.wasm", self.package.replace('-', "_"))
    }
}

/// Builds modules side by side: what one alone needs is compiled while another is put together.
fn build_modules(toolchain: &Toolchain, how: Build) -> Result<Vec<PathBuf>> {
    let target_dir = workspace::target_dir();
    let mut cargo = toolchain.cargo("build", &target_dir);
    cargo.args(["--profile", how.profile(), "--lib"]);
    cargo.args(compiler_settings()?);
    for module in MODULES {
        cargo.args(["--package", module.package]);
    }
    let folders = MODULES.map(|module| module.folder);
    let what = format!("building the page's modules ({})", folders.join(", "));
    timed(&what, || command::run(&mut cargo))?;
    let built = toolchain.output_dir(how.profile(), &target_dir);
    let files = MODULES.map(|module| built.join(module.file()));
    Ok(files.into())
}

fn generate_bindings(module: &Path, folder: &Path) -> Result<()> {
    let mut bindgen = Bindgen::new();
    bindgen
        .input_path(module)
        .typescript(true)
        .remove_name_section(true);
    bindgen
        .web(true)
        .and_then(|bindgen| bindgen.generate(folder))
        .map_err(|error| anyhow!("{error:#}"))
        .with_context(|| format!("cannot write the JavaScript of {}", module.display()))
}

/// The demonstration that the page opens, made again when the code that makes it has changed.
fn write_demonstration(web: &Path) -> Result<()> {
    let folder = web.join("public/demo");
    let stamp = Stamp::new(folder.join(".made-from"), &demonstration_sources())?;
    if stamp.is_current() {
        return Ok(());
    }
    if folder.exists() {
        let cannot = || format!("cannot empty {}", folder.display());
        std::fs::remove_dir_all(&folder).with_context(cannot)?;
    }
    timed("drawing the demonstration", || {
        sequence::write(&sequence::Options::default(), &folder)
    })?;
    stamp.write()
}

/// The code that decides what is in the demonstration.
fn demonstration_sources() -> Vec<PathBuf> {
    ["core/src", "xtask/phantom/src"]
        .map(|folder| workspace::root().join(folder))
        .into()
}
