//! The table of a sequence's poses with how sure they are: CSV or JSON, a row a frame.

use std::path::Path;

use anyhow::{Result, bail};
use fluoropose::finder::{Candidate, Verdict};
use fluoropose::math::Vector3;
use fluoropose::pose::{EulerPose, Pose};
use fluoropose_report::cell::quoted;
use serde::Serialize;

use super::decide::Decision;
use crate::files::{name_of, write_json, write_text};
use crate::finding::FrameFound;

/// What the tables hold, for the help of the verbs that write them.
pub const HELP: &str = "\
The uncertainty table has a row a frame: the pose (mm, degrees), one standard deviation (1 SD) of each of its numbers, of random errors \
along the outline, and of a trace that is half a pixel too wide or too narrow everywhere, or on one side (more is not in it; the library alone gives none), \
the residual (root of twice the robust loss, pixels), the offset of the edges where --edge-offset found one, the verdict (good, doubtful or none) and why, what decided for \
this pose, and the best of the other poses (one that nothing ruled out, where there is any) with its residual. A frame without a pose has a row that says so.";

/// Why standard deviations of two of the rotations may look large.
pub const NEAR_THE_POLE: &str = "\
Where x_rot_deg comes near 90 or -90, the rotations about z and y turn about nearly the same axis: both, and their standard deviations, may be \
large and change by much from frame to frame though the pose is well known (their errors cancel). That depends on the axes of the model's file alone.";

/// The six numbers of a pose, or a standard deviation of each.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Numbers {
    /// To the right, mm.
    pub x_mm: f64,
    /// Upwards, mm.
    pub y_mm: f64,
    /// Along the view, mm.
    pub z_mm: f64,
    /// In the image plane, degrees.
    pub z_rot_deg: f64,
    /// About x, degrees.
    pub x_rot_deg: f64,
    /// About y, degrees.
    pub y_rot_deg: f64,
}

impl From<[f64; 6]> for Numbers {
    /// In the order of a pose file.
    fn from([x_mm, y_mm, z_mm, z_rot_deg, x_rot_deg, y_rot_deg]: [f64; 6]) -> Self {
        Self {
            x_mm,
            y_mm,
            z_mm,
            z_rot_deg,
            x_rot_deg,
            y_rot_deg,
        }
    }
}

impl Numbers {
    /// The numbers in the order of a pose file.
    pub fn all(&self) -> [f64; 6] {
        [
            self.x_mm,
            self.y_mm,
            self.z_mm,
            self.z_rot_deg,
            self.x_rot_deg,
            self.y_rot_deg,
        ]
    }

    /// Standard deviations of a candidate's numbers; `middle` is that of the model's box.
    pub fn deviations(candidate: &Candidate, middle: &Vector3) -> Option<Self> {
        let deviations = candidate.covariance?.deviations(&candidate.pose, middle);
        Some(Self {
            x_mm: deviations.x_mm,
            y_mm: deviations.y_mm,
            z_mm: deviations.z_mm,
            z_rot_deg: deviations.z_rot_deg,
            x_rot_deg: deviations.x_rot_deg,
            y_rot_deg: deviations.y_rot_deg,
        })
    }
}

impl From<Pose> for Numbers {
    fn from(pose: Pose) -> Self {
        let pose = EulerPose::from(pose);
        Self {
            x_mm: pose.x_mm,
            y_mm: pose.y_mm,
            z_mm: pose.z_mm,
            z_rot_deg: pose.z_rot_deg,
            x_rot_deg: pose.x_rot_deg,
            y_rot_deg: pose.y_rot_deg,
        }
    }
}

/// One frame of the table.
#[derive(Clone, Debug, Serialize)]
pub struct FrameReport {
    /// Number of the frame, from 1.
    pub frame: usize,
    /// File of the mask.
    pub file: String,
    /// The pose; absent where none was found.
    pub pose: Option<Numbers>,
    /// One standard deviation of each number.
    pub sd: Option<Numbers>,
    /// What remains between the outlines, pixels.
    pub residual_px: Option<f64>,
    /// How far the target's edges lie beyond the model's outline, pixels.
    pub offset_px: Option<f64>,
    /// `good`, `doubtful` or `none`.
    pub verdict: &'static str,
    /// Why, in a sentence; where there is no pose, why not.
    pub because: String,
    /// What decided for this pose.
    pub decided_by: String,
    /// The best of the other poses.
    pub rival: Option<Numbers>,
    /// What remains at that one, pixels.
    pub rival_residual_px: Option<f64>,
}

impl FrameReport {
    fn new(frame: usize, found: &FrameFound, decision: Option<&Decision>, at: &Vector3) -> Self {
        let residual = |candidate: &Candidate| candidate.refined.map(|_| candidate.misfit());
        let posed = decision.filter(|decision| decision.pose().is_some());
        let chosen = posed.map(|decision| &decision.chosen);
        let rival = posed.and_then(|decision| decision.rival);
        Self {
            frame,
            file: name_of(&found.file),
            pose: chosen.map(|chosen| chosen.pose.into()),
            sd: chosen.and_then(|chosen| Numbers::deviations(chosen, at)),
            residual_px: chosen.and_then(residual),
            offset_px: chosen.and_then(|chosen| Some(chosen.refined?.offset_px)),
            verdict: decision.map_or("none", |decision| decision.verdict.word()),
            because: why(found, decision),
            decided_by: posed.map_or(String::new(), Decision::to_string),
            rival: rival.map(|rival| rival.pose.into()),
            rival_residual_px: rival.and_then(|rival| residual(&rival)),
        }
    }

    /// Makes a pose that was to be trusted doubtful, for a reason that lies beyond the frame.
    pub(super) fn distrust(&mut self, because: &str) {
        if self.verdict == Verdict::Good.word() {
            self.verdict = "doubtful";
            self.because = because.to_owned();
        }
    }

    fn cells(&self) -> Vec<String> {
        let number =
            |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:.6}"));
        let six = |numbers: Option<Numbers>| match numbers {
            Some(numbers) => numbers.all().map(|value| number(Some(value))),
            None => Default::default(),
        };
        let mut cells = vec![self.frame.to_string(), quoted(&self.file)];
        cells.extend(six(self.pose));
        cells.extend(six(self.sd));
        cells.extend([
            number(self.residual_px),
            number(self.offset_px),
            self.verdict.to_owned(),
            quoted(&self.because),
            quoted(&self.decided_by),
        ]);
        cells.extend(six(self.rival));
        cells.push(number(self.rival_residual_px));
        cells
    }
}

/// Why a frame has its verdict, in a sentence.
fn why(found: &FrameFound, decision: Option<&Decision>) -> String {
    match (decision, &found.failure) {
        (Some(decision), _) => decision.verdict.to_string(),
        (None, Some(failure)) => failure.clone(),
        (None, None) => "no pose found".to_owned(),
    }
}

const HEADING: &str = "frame,file,x_mm,y_mm,z_mm,z_rot_deg,x_rot_deg,y_rot_deg,\
sd_x_mm,sd_y_mm,sd_z_mm,sd_z_rot_deg,sd_x_rot_deg,sd_y_rot_deg,residual_px,offset_px,verdict,because,decided_by,\
rival_x_mm,rival_y_mm,rival_z_mm,rival_z_rot_deg,rival_x_rot_deg,rival_y_rot_deg,rival_residual_px";

/// The table of a sequence; `middle` is that of the model's box.
pub fn report(
    found: &[FrameFound],
    decisions: &[Option<Decision>],
    middle: &Vector3,
) -> Vec<FrameReport> {
    let frames = found.iter().zip(decisions).enumerate();
    frames
        .map(|(at, (found, decision))| FrameReport::new(at + 1, found, decision.as_ref(), middle))
        .collect()
}

/// Whether a table can be written to a path: its name must end in .csv or .json.
///
/// # Errors
/// Names the path.
pub fn check_path(path: &Path) -> Result<()> {
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("csv" | "json") => Ok(()),
        _ => bail!(
            "{} must end in .csv or .json, which says how the table is written",
            path.display()
        ),
    }
}

/// Writes the table as CSV or as JSON, by the name's ending.
///
/// # Errors
/// Names the file.
pub fn write_report(path: &Path, frames: &[FrameReport]) -> Result<()> {
    check_path(path)?;
    if path
        .extension()
        .is_some_and(|extension| extension == "json")
    {
        return write_json(Some(path), &frames);
    }
    let mut text = format!("{HEADING}\n");
    for frame in frames {
        text.push_str(&frame.cells().join(","));
        text.push('\n');
    }
    write_text(path, &text)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn missing() -> FrameReport {
        FrameReport {
            frame: 3,
            file: "a \"mask\", of two.png".to_owned(),
            pose: None,
            sd: None,
            residual_px: None,
            offset_px: None,
            verdict: "none",
            because: "no pose found".to_owned(),
            decided_by: String::new(),
            rival: None,
            rival_residual_px: None,
        }
    }

    #[test]
    fn a_frame_without_a_pose_has_a_row_and_every_row_all_columns() {
        let columns = HEADING.split(',').count();
        let cells = missing().cells();
        assert_eq!(cells.len(), columns);
        assert_eq!(cells[1], "\"a \"\"mask\"\", of two.png\"");
        let numbers = Numbers::from(Pose::from(EulerPose {
            z_mm: -1000.0,
            ..EulerPose::default()
        }));
        let hostile = FrameReport {
            file: "=HYPERLINK(\"x\")\t.png".to_owned(),
            because: "-1+1".to_owned(),
            ..missing()
        };
        assert_eq!(hostile.cells()[1], "\"'=HYPERLINK(\"\"x\"\") .png\"");
        assert_eq!(hostile.cells()[17], "\"'-1+1\"");
        let full = FrameReport {
            pose: Some(numbers),
            sd: Some(numbers),
            residual_px: Some(0.5),
            offset_px: Some(0.0),
            rival: Some(numbers),
            rival_residual_px: Some(1.0),
            ..missing()
        };
        assert_eq!(full.cells().len(), columns);
        assert_eq!(full.cells()[4], "-1000.000000");
    }

    #[test]
    fn the_ending_says_how_a_table_is_written() {
        assert!(check_path(Path::new("poses.csv")).is_ok());
        assert!(check_path(Path::new("poses.json")).is_ok());
        let error = check_path(Path::new("poses.txt")).unwrap_err();
        assert!(error.to_string().contains(".csv or .json"));
    }
}
