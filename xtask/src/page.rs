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
    features: &'static [&'static str],
    /// The folder of `web/src/pkg` for its JavaScript.
    folder: &'static str,
    /// Built a second time for engines that have 128-bit vectors.
    with_simd: bool,
}

/// They are built one by one: built together, cargo would unite the features of what they depend on.
const MODULES: [Module; 3] = [
    // What the page's own thread needs, and has to load first.
    Module {
        package: "fluoropose-page",
        features: &[],
        folder: "page",
        with_simd: false,
    },
    // All of the core, for workers.
    Module {
        package: "fluoropose-wasm",
        features: &[],
        folder: "core",
        with_simd: true,
    },
    Module {
        package: "fluoropose-decode",
        features: &[],
        folder: "decode",
        with_simd: false,
    },
];

/// How WASM modules are compiled.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Build {
    /// As they are shipped: as small as can be, with and without 128-bit vectors.
    Shipped,
    /// In a third of the time, for a page on this machine: with vectors alone, and not united into one piece of code
    /// (link-time optimisation). Results are the same.
    Quick,
}

/// Compiled with 128-bit vectors.
const WIDE: [&str; 2] = [
    "--config",
    "target.wasm32-unknown-unknown.rustflags=['-Ctarget-feature=+simd128']",
];

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
    for module in &MODULES {
        let folder = web.join("src/pkg").join(module.folder);
        let name = module.package.replace('-', "_");
        match how {
            Build::Quick => {
                generate_bindings(&build_module(&toolchain, module, how, true)?, &folder)?;
                if module.with_simd {
                    let [plain, wide] =
                        ["", "_simd"].map(|kind| folder.join(format!("{name}{kind}_bg.wasm")));
                    std::fs::copy(plain, wide)?;
                }
            }
            Build::Shipped => {
                generate_bindings(&build_module(&toolchain, module, how, false)?, &folder)?;
                if module.with_simd {
                    add_simd(&toolchain, module, &folder)?;
                }
            }
        }
    }
    Ok(())
}

/// Puts the module for engines with 128-bit vectors beside the plain one. It has no JavaScript of its own: both are
/// entered in the same way, which is checked.
fn add_simd(toolchain: &Toolchain, module: &Module, folder: &Path) -> Result<()> {
    let file = build_module(toolchain, module, Build::Shipped, true)?;
    let bindings = workspace::target_dir().join("simd-bindings");
    generate_bindings(&file, &bindings)?;
    let name = module.package.replace('-', "_");
    let glue = |folder: &Path| std::fs::read(folder.join(format!("{name}.js")));
    ensure!(
        glue(&bindings)? == glue(folder)?,
        "the JavaScript of {name} with SIMD differs from that without"
    );
    let wide = folder.join(format!("{name}_simd_bg.wasm"));
    std::fs::copy(bindings.join(format!("{name}_bg.wasm")), wide)?;
    Ok(())
}

fn build_module(toolchain: &Toolchain, module: &Module, how: Build, wide: bool) -> Result<PathBuf> {
    let Module {
        package,
        features,
        folder,
        ..
    } = module;
    let profile = match how {
        Build::Shipped => "wasm",
        Build::Quick => "wasm-quick",
    };
    let kind = if wide { ", with SIMD" } else { "" };
    let target_dir = workspace::target_dir();
    let mut cargo = toolchain.cargo("build", &target_dir);
    cargo
        .args(["--profile", profile, "--lib", "--package", package])
        .args(*features)
        .args(WIDE.iter().filter(|_| wide));
    let what = format!("building {package} for the page ({folder}{kind})");
    timed(&what, || command::run(&mut cargo))?;
    let file = format!("{}.wasm", package.replace('-', "_"));
    Ok(toolchain.output_dir(profile, &target_dir).join(file))
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
