//! Builds the page: its WASM modules, their JavaScript, the demonstration data and the bundle.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, ensure};
use fluoropose_phantom::sequence;
use wasm_bindgen_cli_support::Bindgen;

use crate::setup::rust_target::{self, Toolchain};
use crate::setup::{announce, command, node};
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

/// Sets up what is missing, builds everything and returns the folder to serve (`web/dist`).
pub(crate) fn build() -> Result<PathBuf> {
    // Said now rather than after a minute of building.
    node::npm()?;
    let web = workspace::root().join("web");
    build_wasm(&web)?;
    write_demonstration(&web)?;
    node::install(&web)?;
    announce("bundling the page (npm run build)");
    command::run(&mut node::script(&web, "build")?)?;
    let dist = web.join("dist");
    ensure!(
        dist.join("index.html").is_file(),
        "`npm run build` left no index.html in web/dist"
    );
    Ok(dist)
}

/// Builds the WASM modules and writes their JavaScript and TypeScript into `web/src/pkg`.
pub(crate) fn build_wasm(web: &Path) -> Result<()> {
    let toolchain = rust_target::ensure(rust_target::WASM)?;
    for module in &MODULES {
        let folder = web.join("src/pkg").join(module.folder);
        let file = build_module(&toolchain, module, &[])?;
        generate_bindings(&file, &folder)?;
        if module.with_simd {
            add_simd(&toolchain, module, &folder)?;
        }
    }
    Ok(())
}

/// Puts the module for engines with 128-bit vectors beside the plain one. It has no JavaScript of its own: both are
/// entered in the same way, which is checked.
fn add_simd(toolchain: &Toolchain, module: &Module, folder: &Path) -> Result<()> {
    const WIDE: [&str; 2] = [
        "--config",
        "target.wasm32-unknown-unknown.rustflags=['-Ctarget-feature=+simd128']",
    ];
    let file = build_module(toolchain, module, &WIDE)?;
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

fn build_module(toolchain: &Toolchain, module: &Module, flags: &[&str]) -> Result<PathBuf> {
    let Module {
        package,
        features,
        folder,
        ..
    } = module;
    let kind = if flags.is_empty() { "" } else { ", with SIMD" };
    announce(&format!("building {package} for the page ({folder}{kind})"));
    let target_dir = workspace::target_dir();
    let mut cargo = toolchain.cargo("build", &target_dir);
    cargo
        .args(["--profile", "wasm", "--lib", "--package", package])
        .args(*features)
        .args(flags);
    command::run(&mut cargo)?;
    let file = format!("{}.wasm", package.replace('-', "_"));
    Ok(toolchain.output_dir("wasm", &target_dir).join(file))
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
    announce("drawing the demonstration");
    if folder.exists() {
        let cannot = || format!("cannot empty {}", folder.display());
        std::fs::remove_dir_all(&folder).with_context(cannot)?;
    }
    sequence::write(&sequence::Options::default(), &folder)?;
    stamp.write()
}

/// The code that decides what is in the demonstration.
fn demonstration_sources() -> Vec<PathBuf> {
    ["core/src", "xtask/phantom/src"]
        .map(|folder| workspace::root().join(folder))
        .into()
}
