//! Words of a study that become a part of the name of a file.

use anyhow::{Result, ensure};

/// Names that Windows keeps for devices, with any ending.
const DEVICES: [&str; 4] = ["AUX", "CON", "NUL", "PRN"];
/// Longer ones leave no room for what stands beside them: file systems take 255 bytes.
const LONGEST: usize = 100;

/// Refuses a word that would lead out of its folder, or that some system cannot keep as a file's name.
///
/// # Errors
/// Names the word, or its beginning, and says what it may be.
pub fn check_file_name(word: &str) -> Result<()> {
    let parts = |letter: char| letter.is_control() || "/\\:*?\"<>|".contains(letter);
    let ends = word.starts_with(['.', ' ']) || word.ends_with(['.', ' ']);
    let sound = !word.is_empty() && word.len() <= LONGEST && !ends && !word.contains(parts);
    let beginning: String = word.chars().take(40).collect();
    ensure!(
        sound && !is_device(word),
        "{beginning:?} is no name for a file: up to {LONGEST} bytes without / \\ : * ? \" < > |, no point or space first or last, no device"
    );
    Ok(())
}

fn is_device(word: &str) -> bool {
    let stem = word.split('.').next().unwrap_or_default().trim_end();
    let stem = stem.to_uppercase();
    let is_numbered = |device| {
        stem.strip_prefix(device).is_some_and(|rest: &str| {
            rest.chars().count() == 1 && rest != "0" && rest.chars().all(char::is_numeric)
        })
    };
    DEVICES.contains(&stem.as_str()) || is_numbered("COM") || is_numbered("LPT")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_stays_in_its_folder_on_every_system() {
        for word in [
            "femur",
            "tray 2",
            "left-knee_1.5",
            "Oberschenkel (größer)",
            "console",
            "com",
            "COM10",
        ] {
            assert!(check_file_name(word).is_ok(), "{word}");
        }
        let long = "x".repeat(10_000);
        for word in [
            "",
            ".",
            "..",
            "../femur",
            "a/b",
            "a\\b",
            "C:femur",
            "/etc/femur",
            "a\0b",
            "a\nb",
            " a",
            "a ",
            "a.",
            ".a",
            "con",
            "NUL.txt",
            "com1",
            "LPT9.x",
            "COM¹",
            "con .x",
            "a?",
            &long,
        ] {
            let error = check_file_name(word).unwrap_err().to_string();
            assert!(error.len() < 300 && !error.contains('\n'), "{error}");
        }
    }
}
