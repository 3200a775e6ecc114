//! Compilers for targets other than this machine: WASM, microcontrollers, 32 bits.

use std::path::{Path, PathBuf};
use std::process::Command;

use super::missing::Missing;
use super::{command, debian};
use crate::output::announce;
use crate::workspace;

/// The page's target.
pub(crate) const WASM: &str = "wasm32-unknown-unknown";
/// The firmware's target: Cortex-M4F.
pub(crate) const CORTEX_M4F: &str = "thumbv7em-none-eabihf";
/// A processor without floating point, wide products and atomics: Cortex-M0+.
pub(crate) const CORTEX_M0: &str = "thumbv6m-none-eabi";
/// RISC-V without floating point.
pub(crate) const RISCV32: &str = "riscv32imac-unknown-none-elf";
/// This kind of machine with 32 bits.
pub(crate) const I686: &str = "i686-unknown-linux-gnu";

/// A compiler that has the standard (or core) library of a target, or builds it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Toolchain {
    /// The one that builds this workspace.
    Own {
        /// The target triple.
        target: &'static str,
    },
    /// Debian's `rustc-web` with its sources, which builds the target's library itself.
    Debian {
        /// The target triple.
        target: &'static str,
        /// The target's linker, from Debian's `lld`.
        linker: PathBuf,
    },
}

impl Toolchain {
    /// A `cargo` with this subcommand for the target; `target_dir` is where its output goes.
    ///
    /// The output of a profile `p` is then in [`Toolchain::output_dir`].
    pub(crate) fn cargo(&self, subcommand: &str, target_dir: &Path) -> Command {
        match self {
            Self::Own { target } => {
                let mut cargo = own_cargo();
                cargo.arg(subcommand).args(["--target", target]);
                cargo.arg("--target-dir").arg(target_dir);
                cargo
            }
            Self::Debian { target, linker } => debian_cargo(subcommand, target, linker, target_dir),
        }
    }

    /// The folder of a profile's artifacts under `target_dir`.
    pub(crate) fn output_dir(&self, profile: &str, target_dir: &Path) -> PathBuf {
        match self {
            Self::Own { target } => target_dir.join(target).join(profile),
            Self::Debian { target, .. } => debian_dir(target_dir).join(target).join(profile),
        }
    }
}

/// The cargo that runs us.
pub(crate) fn own_cargo() -> Command {
    let mut cargo = command::of_lane(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.current_dir(workspace::root());
    // The linter that may have compiled us (`.ci/run`) is for those who ask for it.
    cargo.env_remove(COMPILER_OF_MEMBERS);
    cargo
}

/// By what cargo compiles the members of a workspace, where that is not the compiler alone.
pub(crate) const COMPILER_OF_MEMBERS: &str = "RUSTC_WORKSPACE_WRAPPER";

/// Debian's compiler shares nothing with the main one, so it gets a folder of its own.
fn debian_dir(target_dir: &Path) -> PathBuf {
    target_dir.join("debian")
}

fn debian_cargo(subcommand: &str, target: &str, linker: &Path, target_dir: &Path) -> Command {
    let mut cargo = Command::new("/usr/bin/cargo");
    cargo.current_dir(workspace::root());
    // What rustup and the outer cargo set for themselves would lead Debian's cargo to the wrong compiler.
    for name in [
        "RUSTUP_TOOLCHAIN",
        "RUSTC_WRAPPER",
        COMPILER_OF_MEMBERS,
        "CARGO",
        "RUSTFLAGS",
        "LD_LIBRARY_PATH",
    ] {
        cargo.env_remove(name);
    }
    cargo
        .env("RUSTC", "/usr/bin/rustc")
        .env("RUSTC_BOOTSTRAP", "1");
    let variable = target.to_uppercase().replace('-', "_");
    cargo.env(format!("CARGO_TARGET_{variable}_LINKER"), linker);
    let library = if target == WASM {
        "-Zbuild-std=std,panic_abort"
    } else {
        "-Zbuild-std=core"
    };
    cargo.arg(subcommand).args(["--target", target, library]);
    cargo.arg("--target-dir").arg(debian_dir(target_dir));
    cargo
}

/// A compiler for `target`: the installed one, else with the target added by rustup, else Debian's.
pub(crate) fn ensure(target: &'static str) -> Result<Toolchain, Missing> {
    let _turn = super::turns::RUSTUP.turn();
    if is_installed(target) {
        return Ok(Toolchain::Own { target });
    }
    let rustup_said = match add_with_rustup(target) {
        Ok(()) => return Ok(Toolchain::Own { target }),
        Err(said) => said,
    };
    debian_toolchain(target).map_err(|debian_said| Missing {
        what: format!("Rust target {target}"),
        why: format!(
            "{rustup_said}; Debian's compiler neither ({})",
            debian_said.why
        ),
        remedy: format!("run `rustup target add {target}`"),
        tried: debian_said.tried || command::find(&["rustup"]).is_some(),
    })
}

/// Looks for the target's core library beside the compiler: true for rustup and for distributions alike.
fn is_installed(target: &str) -> bool {
    let mut rustc = Command::new(std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()));
    rustc.args(["--print", "target-libdir", "--target", target]);
    command::output(&mut rustc).is_ok_and(|folder| has_core(Path::new(folder.trim())))
}

fn has_core(folder: &Path) -> bool {
    let Ok(entries) = folder.read_dir() else {
        return false;
    };
    entries.flatten().any(|entry| {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        name.starts_with("libcore-") && name.ends_with(".rlib")
    })
}

fn add_with_rustup(target: &str) -> Result<(), String> {
    let Some(rustup) = command::find(&["rustup"]) else {
        return Err("there is no rustup to add it with".to_string());
    };
    announce(&format!(
        "adding the Rust target {target} (rustup target add)"
    ));
    command::output(Command::new(rustup).args(["target", "add", target]))
        .map_err(|error| format!("{error:#}"))?;
    if is_installed(target) {
        Ok(())
    } else {
        Err("rustup added it to another toolchain".into())
    }
}

fn debian_toolchain(target: &'static str) -> Result<Toolchain, Missing> {
    let packages = ["rustc-web", "cargo-web", "rust-web-src", "lld"];
    if !Path::new("/usr/lib/rustlib/src").exists() || !Path::new("/usr/bin/cargo").exists() {
        debian::install(&format!("a Rust compiler for {target}"), &packages)?;
    }
    let name = if target == WASM { "wasm-ld" } else { "ld.lld" };
    let linker = linker(Path::new("/usr/bin"), name).ok_or_else(|| Missing {
        what: "linker".into(),
        why: format!("lld brought no {name}"),
        remedy: "install lld".into(),
        tried: true,
    })?;
    Ok(Toolchain::Debian { target, linker })
}

/// The linker of this name, which Debian also ends with the version of its `lld`.
fn linker(folder: &Path, name: &str) -> Option<PathBuf> {
    let files = folder.read_dir().ok()?.flatten();
    let versioned = format!("{name}-");
    let is_linker = |file: &str| file == name || file.starts_with(&versioned);
    let mut linkers: Vec<PathBuf> = files
        .filter(|file| file.file_name().to_str().is_some_and(is_linker))
        .map(|file| file.path())
        .collect();
    linkers.sort();
    linkers.into_iter().next()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_linker_is_found_whatever_its_version() {
        let folder = std::env::temp_dir().join(format!("fluoropose-linker-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join("wasm-merge"), "").unwrap();
        assert_eq!(linker(&folder, "wasm-ld"), None);
        std::fs::write(folder.join("wasm-ld-21"), "").unwrap();
        assert_eq!(linker(&folder, "wasm-ld"), Some(folder.join("wasm-ld-21")));
        std::fs::remove_dir_all(folder).unwrap();
    }

    fn words(command: &Command) -> Vec<String> {
        command
            .get_args()
            .map(|word| word.to_string_lossy().into_owned())
            .collect()
    }

    #[test]
    fn the_host_is_installed_and_nonsense_is_not() {
        assert!(
            is_installed("x86_64-unknown-linux-gnu")
                || !cfg!(all(target_arch = "x86_64", target_os = "linux"))
        );
        assert!(!is_installed("pdp11-unknown-none"));
    }

    #[test]
    fn debian_builds_the_library_apart_from_the_main_output() {
        let toolchain = Toolchain::Debian {
            target: WASM,
            linker: "/usr/bin/wasm-ld-14".into(),
        };
        let cargo = toolchain.cargo("build", Path::new("out"));
        let words = words(&cargo);
        assert!(
            words.contains(&"-Zbuild-std=std,panic_abort".to_string()),
            "{words:?}"
        );
        assert_eq!(
            toolchain.output_dir("wasm", Path::new("out")),
            Path::new("out/debian").join(WASM).join("wasm")
        );
        let bootstrap = cargo
            .get_envs()
            .find(|(name, _)| *name == "RUSTC_BOOTSTRAP");
        assert!(bootstrap.is_some_and(|(_, value)| value.is_some()));
    }

    #[test]
    fn our_own_cargo_stays_free_of_nightly_switches() {
        let cargo = Toolchain::Own { target: CORTEX_M4F }.cargo("build", Path::new("out"));
        assert!(!words(&cargo).iter().any(|word| word.starts_with("-Z")));
        assert!(cargo.get_envs().eq([(COMPILER_OF_MEMBERS.as_ref(), None)]));
    }
}
