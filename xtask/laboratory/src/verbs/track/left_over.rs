//! Files that an earlier run left for components that the study has no more: who reads the folder would take them for its own.

use std::fs;
use std::path::Path;

use crate::files::{Study, name_of};

/// What is left in the folder, a sentence without its full stop; nothing where nothing is.
pub(super) fn left_over(out: &Path, study: &Study) -> Option<String> {
    // Nobody writes such a pair who does not write poses: of a folder of `pose` it is told too.
    let end = ".covariances.csv";
    let names = fs::read_dir(out).ok()?.flatten();
    let names = names.map(|entry| name_of(&entry.path()));
    let left = names.filter_map(|name| Some(name.strip_suffix(end)?.to_owned()));
    let is_other = |name: &String| study.components.iter().all(|one| one.name != *name);
    let mut left: Vec<String> = left.filter(is_other).collect();
    left.sort();
    let named = left
        .iter()
        .map(|name| format!("{name}.jts and {name}{end}"));
    let named: Vec<String> = named.collect();
    (!named.is_empty()).then(|| {
        format!(
            "{} holds {} of an earlier run, and the study has no such component: remove them, they are not written again",
            out.display(),
            named.join(", ")
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses_of_a_component_that_was_renamed_are_told() {
        let out = std::env::temp_dir().join(format!("fluoropose-left-{}", std::process::id()));
        fs::create_dir_all(&out).unwrap();
        let study = out.join("study.toml");
        let text =
            "name = 's'\ncalibration = 'c.txt'\n[[component]]\nname = 'femur'\nmodel = 'f.stl'\n";
        fs::write(&study, text).unwrap();
        let study = Study::read(&study).unwrap();
        fs::write(out.join("femur.covariances.csv"), "").unwrap();
        let nothing = left_over(&out, &study);
        fs::write(out.join("Femur.covariances.csv"), "").unwrap();
        let told = left_over(&out, &study).unwrap();
        fs::remove_dir_all(&out).unwrap();
        assert_eq!(nothing, None);
        assert!(
            told.contains(" holds Femur.jts and Femur.covariances.csv of an"),
            "{told}"
        );
        assert_eq!(left_over(&out, &study), None);
    }
}
