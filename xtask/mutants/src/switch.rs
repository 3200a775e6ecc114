//! The crate that a run asks which change counts, written beside the copy of the sources.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

/// The name of the change that counts, a number from [`FIRST`] on; without it none counts.
pub(crate) const CHANGE: &str = "MUTANT";
/// The file that is told which changes a run reaches.
pub(crate) const REACHED: &str = "MUTANTS_REACHED";
/// The number of the first change.
pub(crate) const FIRST: usize = 2;

const MANIFEST: &str = "[package]\nname = \"fluoropose-switch\"\nversion = \"0.0.0\"\nedition = \"2024\"\npublish = false\n\n[lib]\n";

const SOURCE: &str = r#"//! Which change counts in this run.

use std::io::Write as _;
use std::sync::atomic::{AtomicU8, AtomicU32, Ordering::Relaxed};

const UNKNOWN: u32 = 0;
const RECORDED: u32 = 1;
static CHANGE: AtomicU32 = AtomicU32::new(UNKNOWN);

/// Whether this change counts.
#[inline]
pub fn on(change: u32) -> bool {
    let counts = CHANGE.load(Relaxed);
    if counts < 2 { asked(change, counts) } else { counts == change }
}

#[cold]
#[inline(never)]
fn asked(change: u32, counts: u32) -> bool {
    if counts == UNKNOWN {
        let told = std::env::var("MUTANT").ok().and_then(|told| told.parse().ok());
        let recorded = std::env::var_os("MUTANTS_REACHED").is_some();
        let counts = told.unwrap_or(if recorded { RECORDED } else { u32::MAX });
        CHANGE.store(counts, Relaxed);
        return on(change);
    }
    static REACHED: [AtomicU8; 1 << 16] = [const { AtomicU8::new(0) }; 1 << 16];
    if REACHED[change as usize & 0xffff].swap(1, Relaxed) == 0 {
        if let Some(name) = std::env::var_os("MUTANTS_REACHED") {
            let file = std::fs::OpenOptions::new().create(true).append(true).open(name);
            let _ = file.and_then(|mut file| file.write_all(format!("{change}\n").as_bytes()));
        }
    }
    false
}
"#;

/// Writes the crate, and makes a package of the copy stand on it.
///
/// # Errors
/// For files that cannot be written, and a manifest without dependencies.
pub(crate) fn write(root: &Path, manifest: &Path) -> Result<()> {
    let folder = root.join("switch");
    fs::create_dir_all(folder.join("src"))?;
    fs::write(folder.join("Cargo.toml"), MANIFEST)?;
    fs::write(folder.join("src/lib.rs"), SOURCE)?;
    let text = fs::read_to_string(manifest)
        .with_context(|| format!("cannot read {}", manifest.display()))?;
    let (before, behind) = text
        .split_once("[dependencies]\n")
        .with_context(|| format!("{} has no dependencies", manifest.display()))?;
    let at = folder.display();
    let text =
        format!("{before}[dependencies]\nfluoropose-switch = {{ path = \"{at}\" }}\n{behind}");
    fs::write(manifest, text).with_context(|| format!("cannot write {}", manifest.display()))
}
