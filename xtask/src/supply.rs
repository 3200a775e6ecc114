//! Verb `supply`: what comes from elsewhere: licences, sources, what was taken back.

pub(crate) mod index;
mod licence;
pub(crate) mod notices;
pub(crate) mod parts;
mod sbom;

use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

use anyhow::{Result, bail};
use parts::Part;

use crate::setup::rust_target::WASM;
use crate::setup::{command, node};
use crate::workspace;

/// Options of `supply`.
#[derive(clap::Args)]
#[command(
    after_help = "Of every crate and npm package that the lock files name: a licence of the short list, the registry as its source with a digest, and \
not taken back (yanked). Crates in several versions are told. What cannot be asked here (signatures, known faults) is named as skipped. The lists that \
`package` writes beside each package come from the same source."
)]
pub(crate) struct Args {
    /// Ask no registry
    #[arg(long)]
    offline: bool,
}

/// Runs the verb.
///
/// Errors where a part may not be used.
pub(crate) fn run(args: Args) -> Result<()> {
    let all = everything()?;
    println!("{} crates and npm packages", all.len());
    let mut faults = faults(&all);
    println!("licences and sources: {} at fault", faults.len());
    for told in in_several_versions(&all) {
        println!("in several versions: {told}");
    }
    faults.extend(taken_back(&all, args.offline));
    faults.extend(npm(args.offline));
    println!(
        "skipped: known faults of crates (no registry has their database; `cargo audit` elsewhere)"
    );
    for fault in &faults {
        println!("{fault}");
    }
    match faults.len() {
        0 => Ok(()),
        count => bail!("{count} faults in what comes from elsewhere"),
    }
}

/// What is compiled into the page, and what of npm is bundled with it.
///
/// Errors where cargo or a lock file cannot tell.
pub(crate) fn of_page() -> Result<Vec<Part>> {
    let mut parts = of_module()?;
    parts.extend(parts::packages(&workspace::root().join("web"), true)?);
    Ok(parts)
}

/// What is compiled into the page's modules and the npm module's.
///
/// Errors as [`of_page`].
pub(crate) fn of_module() -> Result<Vec<Part>> {
    parts::compiled_into(
        &["fluoropose-page", "fluoropose-wasm", "fluoropose-decode"],
        WASM,
    )
}

/// What is compiled into the Python package on this machine; NumPy is not in it.
///
/// Errors as [`of_page`].
pub(crate) fn of_wheel() -> Result<Vec<Part>> {
    let mut parts = parts::compiled_into(&["fluoropose-python"], &parts::this_machine()?)?;
    parts.push(parts::letters());
    Ok(parts)
}

/// Every part, also what only builds and tests.
fn everything() -> Result<Vec<Part>> {
    let root = workspace::root();
    let mut all = parts::crates(&root)?;
    all.extend(parts::crates(&root.join("tests/firmware"))?);
    all.extend(parts::packages(&root.join("web"), false)?);
    all.extend(parts::packages(&root.join("tests/browser"), false)?);
    all.sort();
    all.dedup_by(|a, b| (a.kind, &a.name, &a.version) == (b.kind, &b.name, &b.version));
    Ok(all)
}

fn faults(parts: &[Part]) -> Vec<String> {
    let mut faults = Vec::new();
    for part in parts {
        let name = format!("{} {} ({})", part.name, part.version, part.kind);
        if part.licence.is_empty() {
            faults.push(format!("{name} states no licence"));
        } else if !licence::is_allowed(&part.licence).unwrap_or(false) {
            faults.push(format!(
                "{name}: {} is no licence of the list",
                part.licence
            ));
        }
        if !part.from_registry {
            faults.push(format!("{name} is not from the registry with a digest"));
        }
    }
    faults
}

/// Crates in versions that do not go together: each is compiled, and downloaded, by itself.
fn in_several_versions(parts: &[Part]) -> Vec<String> {
    let mut versions: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for part in parts.iter().filter(|part| part.kind == "cargo") {
        versions
            .entry(&part.name)
            .or_default()
            .insert(&part.version);
    }
    let several = versions.into_iter().filter(|(_, versions)| {
        let lines: BTreeSet<String> = versions.iter().map(|version| line(version)).collect();
        lines.len() > 1
    });
    several
        .map(|(name, versions)| {
            format!(
                "{name} {}",
                versions.into_iter().collect::<Vec<_>>().join(", ")
            )
        })
        .collect()
}

/// What versions that go together share: all up to the first number that is not 0.
fn line(version: &str) -> String {
    let mut numbers: Vec<&str> = Vec::new();
    for number in version.split('.') {
        numbers.push(number);
        if number != "0" {
            break;
        }
    }
    numbers.join(".")
}

fn taken_back(parts: &[Part], offline: bool) -> Vec<String> {
    let crates: Vec<Part> = parts
        .iter()
        .filter(|part| part.kind == "cargo")
        .cloned()
        .collect();
    if !offline && let Err(error) = index::refresh() {
        println!("the registry's index could not be asked, its last copy is read: {error:#}");
    }
    match index::yanked(&crates) {
        Ok((yanked, unknown)) => {
            println!(
                "taken back: {} of {} crates ({unknown} are not in the index's copy)",
                yanked.len(),
                crates.len()
            );
            let told = yanked.iter();
            told.map(|part| format!("{} {} was taken back", part.name, part.version))
                .collect()
        }
        Err(error) => {
            println!("skipped: what was taken back ({error:#})");
            Vec::new()
        }
    }
}

/// Signatures and known faults, where npm's registry tells them.
fn npm(offline: bool) -> Vec<String> {
    let mut faults = Vec::new();
    for (what, words) in [
        ("signatures of npm packages", &["audit", "signatures"][..]),
        ("known faults of npm packages", &["audit"]),
    ] {
        if offline {
            println!("skipped: {what} (offline)");
            continue;
        }
        let asked = node::npm().map_err(anyhow::Error::from).and_then(|npm| {
            let mut npm = Command::new(npm);
            npm.args(words).args(["--fetch-retries", "0"]);
            command::tee_all(npm.current_dir(workspace::root().join("web")))
        });
        match asked {
            Ok(told) if told.success => println!("{what}: none at fault"),
            // What npm could not ask it calls an error of its own; of what it asked, it says what it found.
            Ok(told) if !told.all().contains("npm error") => {
                faults.push(format!("{what}: npm tells of some, above"))
            }
            Ok(_) => println!("skipped: {what} (the registry here does not tell)"),
            Err(error) => println!("skipped: {what} ({error:#})"),
        }
    }
    faults
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_part_has_a_licence_of_the_list_and_comes_from_the_registry() {
        let all = everything().unwrap();
        assert!(all.len() > 200, "{}", all.len());
        assert_eq!(faults(&all), Vec::<String>::new());
        let page = of_page().unwrap();
        for name in ["mediabunny", "png", "wasm-bindgen", "rust-std"] {
            assert!(page.iter().any(|part| part.name == name), "{name}");
        }
        assert!(page.iter().all(|part| part.name != "vite"));
    }

    #[test]
    fn a_part_without_a_licence_or_with_another_is_a_fault() {
        let sound = everything().unwrap().remove(0);
        let none = Part {
            licence: String::new(),
            ..sound.clone()
        };
        let other = Part {
            licence: "GPL-3.0-only".to_owned(),
            ..sound.clone()
        };
        let elsewhere = Part {
            from_registry: false,
            ..sound.clone()
        };
        for (part, word) in [
            (none, "no licence"),
            (other, "GPL"),
            (elsewhere, "registry"),
        ] {
            let faults = faults(&[part]);
            assert!(faults.len() == 1 && faults[0].contains(word), "{faults:?}");
        }
    }

    #[test]
    fn versions_that_do_not_go_together_are_told() {
        let sound = everything().unwrap().remove(0);
        let of = |version: &str| Part {
            kind: "cargo",
            name: "a".to_owned(),
            version: version.to_owned(),
            ..sound.clone()
        };
        assert!(in_several_versions(&[of("1.2.0"), of("1.3.0")]).is_empty());
        assert_eq!(
            in_several_versions(&[of("0.2.0"), of("0.3.0")]),
            ["a 0.2.0, 0.3.0"]
        );
        assert_eq!(in_several_versions(&[of("1.2.0"), of("2.0.0")]).len(), 1);
    }
}
