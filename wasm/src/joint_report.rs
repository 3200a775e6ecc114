//! What is published of a joint, as text: the same from the page as from the command line.

use fluoropose::joint::JointFrame;
use fluoropose::joint::numbers::{COLUMNS, NUMBERS};
use fluoropose::pose::Pose;
use fluoropose_report::{Facts, Input, JointFilm, JointRow, figure, html, write};
use wasm_bindgen::prelude::*;

use crate::joint::{BORDER, KneeJoint, OUT, SHOWN};
use fluoropose_page::error::sentence;
use fluoropose_page::pose_numbers::{all_poses, from_numbers};

/// A joint's motion on its way into files. Frames come one by one, in the order of the film.
#[wasm_bindgen]
pub struct JointReport {
    film: JointFilm,
    facts: Facts,
}

#[wasm_bindgen]
impl JointReport {
    /// Of a joint, without frames yet. `frames_per_s` is NaN where it is not known.
    ///
    /// # Errors
    /// The core's sentence about a mesh.
    #[wasm_bindgen(constructor)]
    pub fn new(knee: &KneeJoint, name: String, frames_per_s: f64) -> Result<Self, JsError> {
        let mut film = JointFilm {
            name,
            side: knee.side,
            plate_depth_mm: 0.0,
            plate_width_mm: 0.0,
            plate_outline: Vec::new(),
            frames_per_s: (frames_per_s > 0.0).then_some(frames_per_s),
            cutoff_hz: None,
            remarks: Vec::new(),
            has_verdicts: true,
            rows: Vec::new(),
        };
        if let Some(joint) = knee.joint()? {
            film.plate_outline = vec![[0.0; 2]; BORDER];
            joint.plate_outline(&mut film.plate_outline);
            film.plate_depth_mm = joint.plate().depth_mm;
            film.plate_width_mm = joint.plate().width_mm;
        }
        let mut facts = Facts::default();
        facts.set_axes("femoral", &knee.femur.anatomical_axes());
        facts.set_axes("tibial", &knee.tibia.anatomical_axes());
        film.remarks
            .extend(knee.other_side()?.map(Facts::side_remark));
        facts.remarks.clone_from(&film.remarks);
        Ok(Self { film, facts })
    }

    /// The next frame: its numbers as `KneeJoint.numbers` gives them, empty where there are none. `doubt` says why it is doubtful, `accepted`
    /// why it was until a person accepted it.
    ///
    /// # Errors
    /// When the numbers are of another count.
    #[wasm_bindgen(js_name = addFrame)]
    pub fn add_frame(
        &mut self,
        numbers: &[f64],
        checked: bool,
        doubt: Option<String>,
        accepted: Option<String>,
    ) -> Result<(), JsError> {
        let joint = match numbers {
            [] => None,
            numbers => Some(frame_of(numbers)?),
        };
        let number = self.film.rows.len() + 1;
        self.film.rows.push(JointRow {
            checked,
            accepted,
            ..JointRow::new(number, joint, doubt)
        });
        Ok(())
    }

    /// A file that it was made from: what it is, its name and the digest of its bytes.
    #[wasm_bindgen(js_name = addInput)]
    pub fn add_input(&mut self, what: String, name: String, sha256: String) {
        self.facts.inputs.push(Input { what, name, sha256 });
    }

    /// What was chosen: a name and a value.
    #[wasm_bindgen(js_name = addSetting)]
    pub fn add_setting(&mut self, name: &str, value: String) {
        self.facts.set(name, value);
    }

    /// What a reader has to know of these data: a sentence.
    #[wasm_bindgen(js_name = addRemark)]
    pub fn add_remark(&mut self, remark: String) {
        self.facts.remarks.push(remark);
    }

    /// Every number of every frame, with commas.
    pub fn table(&self) -> String {
        write::table(&self.film)
    }

    /// OpenSim's motion.
    ///
    /// # Errors
    /// A sentence where the frames a second are not known.
    pub fn mot(&self) -> Result<String, JsError> {
        write::mot(&self.film).map_err(sentence)
    }

    /// One number, named as in the table, at 101 points.
    ///
    /// # Errors
    /// A sentence for a name that is none.
    pub fn cycle(&self, column: &str) -> Result<String, JsError> {
        let number = COLUMNS.iter().position(|one| one.name == column);
        let number = number.ok_or_else(|| JsError::new("There is no number of this name"))?;
        Ok(write::matrix(&[&self.film], number))
    }

    /// Names of the numbers that have a row of 101 points.
    #[wasm_bindgen(getter, js_name = cycleColumns)]
    pub fn cycle_columns(&self) -> Vec<String> {
        COLUMNS.iter().map(|one| one.name.to_owned()).collect()
    }

    /// The figure of four panels, as SVG.
    pub fn figure(&self) -> String {
        figure(&self.film).svg()
    }

    /// The same as PDF.
    #[wasm_bindgen(js_name = figurePdf)]
    pub fn figure_pdf(&self) -> Vec<u8> {
        figure(&self.film).pdf()
    }

    /// The report, as HTML.
    pub fn html(&self) -> String {
        html(&self.film, &self.facts)
    }
}

/// `.jtak`: poses (six numbers each: x, y, z in mm, then z, x and y rotation in degrees), a row a frame; NaN is none.
///
/// # Errors
/// When there are not six numbers for each.
#[wasm_bindgen(js_name = writeJtak)]
pub fn write_jtak(poses: &[f64]) -> Result<String, JsError> {
    Ok(write::jtak(&all_poses(poses)?))
}

/// `.jtap`: one pose.
///
/// # Errors
/// When it is not six finite numbers.
#[wasm_bindgen(js_name = writeJtap)]
pub fn write_jtap(pose: &[f64]) -> Result<String, JsError> {
    Ok(write::jtap(&Pose::from(from_numbers(pose)?)))
}

/// `.tra`: the poses of both components side by side, a row a frame.
///
/// # Errors
/// When there are not six numbers for each.
#[wasm_bindgen(js_name = writeTra)]
pub fn write_tra(femur: &[f64], tibia: &[f64]) -> Result<String, JsError> {
    Ok(write::tra(&[&all_poses(femur)?, &all_poses(tibia)?]))
}

/// Numbers and their standard deviations, NaN where these are not known. What comes after them follows from both.
fn frame_of(numbers: &[f64]) -> Result<JointFrame, JsError> {
    if numbers.len() != OUT {
        return Err(JsError::new(
            "A frame of a joint has other numbers than this",
        ));
    }
    let take = |from: usize| core::array::from_fn(|k| numbers[from + k]);
    let deviations: [f64; NUMBERS] = take(NUMBERS);
    Ok(JointFrame {
        numbers: take(0),
        deviations: deviations[0].is_finite().then_some(deviations),
        shared: core::array::from_fn(|error| take(SHOWN + error * NUMBERS)),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluoropose_report::read;

    const OWN: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

    /// Three frames without models; the second one has no joint.
    fn report() -> JointReport {
        let joint = KneeJoint::new(vec![], vec![], &OWN, vec![], vec![], &OWN, true);
        let mut joint = joint.ok().unwrap();
        let report = JointReport::new(&joint, "a".to_owned(), 15.0);
        let mut report = report.ok().unwrap();
        for frame in 0..3 {
            let femur = [1.0, 2.0, -900.0, 20.0 * f64::from(frame), 0.0, 0.0];
            let tibia = [0.0, -30.0, -900.0, 0.0, 0.0, 0.0];
            let mut placed = [f64::NAN; 90];
            placed[..6].copy_from_slice(&femur);
            placed[45..51].copy_from_slice(&tibia);
            let numbers = joint.numbers(&placed).ok().unwrap();
            let numbers = if frame == 1 { &[] } else { &numbers[..] };
            let doubt = (frame == 2).then(|| "a rim".to_owned());
            let added = report.add_frame(numbers, frame == 0, doubt, None);
            assert!(added.is_ok());
        }
        report
    }

    #[test]
    fn frames_come_out_as_they_went_in() {
        let report = report();
        let table = read::table(&report.table()).unwrap();
        let flexion = table.column("flexion_deg").unwrap();
        assert!((flexion[0]).abs() < 1e-9 && flexion[1].is_nan());
        assert!((flexion[2].abs() - 40.0).abs() < 1e-9);
        assert!(
            table
                .column("sd_flexion_deg")
                .unwrap()
                .iter()
                .all(|sd| sd.is_nan())
        );
        assert_eq!(table.column("time_s").unwrap()[2], 2.0 / 15.0);
        assert_eq!(table.column("checked").unwrap(), [1.0, 0.0, 0.0]);
        let mot = read::mot(&report.mot().ok().unwrap()).unwrap();
        assert_eq!(mot.column("flexion_deg").unwrap()[2], flexion[2]);
        assert!(
            report
                .cycle("flexion_deg")
                .ok()
                .unwrap()
                .contains("101 points")
        );
    }

    #[test]
    fn poses_keep_their_gaps() {
        let mut poses = [f64::NAN; 12];
        poses[..6].copy_from_slice(&[1.0, 2.0, -900.0, 20.0, 0.0, 0.0]);
        let text = write_tra(&poses, &poses).ok().unwrap();
        let bodies = read::tra(&text).unwrap();
        assert!(bodies[1][0].is_some() && bodies[0][1].is_none());
        assert!(write_jtak(&poses).ok().unwrap().contains("NOT_OPTIMIZED"));
        assert!(write_jtap(&poses[..6]).ok().unwrap().contains("-900"));
    }

    #[test]
    fn the_report_tells_what_it_was_told() {
        let mut report = report();
        report.add_input(
            "calibration".to_owned(),
            "c.txt".to_owned(),
            "00ff".to_owned(),
        );
        report.add_setting("poses", "by hand".to_owned());
        report.add_remark("One frame was not refined.".to_owned());
        let page = report.html();
        for words in [
            "00ff",
            "by hand",
            "One frame was not refined.",
            "a rim",
            "x y z",
            "<svg",
        ] {
            assert!(page.contains(words), "{words}");
        }
        assert!(report.figure().contains("lowest points are not known"));
    }
}
