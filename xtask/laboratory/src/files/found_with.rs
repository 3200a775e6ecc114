//! What poses were found with, beside them: a calibration or a model that is another since says nothing of them.

use std::path::Path;

use anyhow::Result;
use fluoropose::camera::calibration::Calibration;
use fluoropose::mesh::Model;
use fluoropose::pose::Pose;
use fluoropose_report::cell::{plain, quoted};

use super::text::{csv_fields, read_text, sha256, write_text};

/// Its file in a folder of poses.
const FILE: &str = "found_with.csv";

/// What poses are found with: each thing in words, and the digest of what it says, whatever its file's form.
pub struct FoundWith(Vec<(String, String)>);

impl FoundWith {
    /// Of a calibration and the models of components.
    pub fn of<'m>(
        calibration: &Calibration,
        models: impl Iterator<Item = (&'m str, Model<'m>)>,
    ) -> Self {
        let of_calibration = sha256(text_of(calibration).as_bytes());
        let mut all = vec![("calibration".to_owned(), of_calibration)];
        all.extend(models.map(|(name, model)| {
            let digest = model.digest();
            let hexadecimal = digest.iter().map(|byte| format!("{byte:02x}"));
            (format!("model of the {name}"), hexadecimal.collect())
        }));
        Self(all)
    }

    /// Writes it beside poses.
    ///
    /// # Errors
    /// For a folder that cannot be written to.
    pub fn write(&self, folder: &Path) -> Result<()> {
        let row = |(what, digest): &(String, String)| format!("{},{digest}\n", quoted(what));
        let rows: String = self.0.iter().map(row).collect();
        write_text(&folder.join(FILE), &format!("what,sha256\n{rows}"))
    }

    /// What is another than the poses of a folder were found with, as far as that is known: a sentence each.
    ///
    /// # Errors
    /// For a file that cannot be read.
    pub fn changed_since(&self, folder: &Path) -> Result<Vec<String>> {
        let file = folder.join(FILE);
        if !file.is_file() {
            return Ok(Vec::new());
        }
        let text = read_text(&file)?;
        let rows: Vec<Vec<String>> = text.lines().skip(1).map(csv_fields).collect();
        let then = |what: &str| {
            let row = rows
                .iter()
                .find(|row| row.first().is_some_and(|own| plain(own) == what));
            row.and_then(|row| row.get(1))
        };
        let changed = |(what, digest): &(String, String)| {
            then(what).is_some_and(|then| then != digest).then(|| {
                format!("The {what} is another than the one that the poses were found with: they may be wrong with it.")
            })
        };
        Ok(self.0.iter().filter_map(changed).collect())
    }
}

/// As a file says it. One that does not say where its camera stands was written as one where the laboratory begins, and poses do not
/// depend on that.
fn text_of(calibration: &Calibration) -> String {
    let mut placed = *calibration;
    if let Calibration::CameraMatrix { laboratory, .. } = &mut placed {
        laboratory.get_or_insert(Pose::IDENTITY);
    }
    placed.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::owned;
    use fluoropose_phantom::implant::{Parameters, femur, tibia};

    #[test]
    fn what_is_another_since_is_told_and_a_file_in_another_form_is_not() {
        let folder = std::env::temp_dir().join(format!("fluoropose-with-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let parse = |text: &str| Calibration::parse(text).unwrap();
        let parameters = Parameters::default();
        let [one, other] =
            [femur(&parameters), tibia(&parameters)].map(|made| owned(made.unwrap()).unwrap());
        let with = |calibration: &str, model| {
            FoundWith::of(&parse(calibration), [("femur", model)].into_iter())
        };
        let now = with("JT_INTCALIB\n1000\n0\n0\n0.3\n", one.as_model());
        assert!(now.changed_since(&folder).unwrap().is_empty());
        now.write(&folder).unwrap();
        let again = with("JT_INTCALIB\r\n1000.0\n0\n0\n0.30\n", one.as_model());
        assert!(again.changed_since(&folder).unwrap().is_empty());
        let matrix = "image size\n64,48\ncamera matrix\n500,0,32\n0,500,24\n0,0,1\n";
        with(matrix, one.as_model()).write(&folder).unwrap();
        let placed = format!("{matrix}rotation\n1,0,0\n0,1,0\n0,0,1\ntranslation\n0,0,0\n");
        let placed = with(&placed, one.as_model()).changed_since(&folder);
        assert!(placed.unwrap().is_empty());
        now.write(&folder).unwrap();
        let then = with("JT_INTCALIB\n1000\n0\n0\n0.31\n", other.as_model());
        let told = then.changed_since(&folder).unwrap();
        assert!(
            told.len() == 2 && told[0].starts_with("The calibration is another"),
            "{told:?}"
        );
        assert!(told[1].starts_with("The model of the femur is another"));
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
