//! `track.csv`: a row for each frame and component.

use std::fmt::Write as _;

use fluoropose::film::{FilmModel, Sharpening};
use fluoropose::follow::{Cell, Conclusion, State};
use fluoropose::math::Vector3;
use fluoropose::pose::EulerPose;
use fluoropose::pose::covariance::Deviations;
use fluoropose_report::cell::quoted;

use crate::files::Uncertain;

/// A frame of a component.
#[derive(Clone, Debug)]
pub struct Row {
    /// Number of the frame, from 1.
    pub frame: usize,
    /// What is known of it.
    pub state: State,
    /// The pose.
    pub pose: Option<EulerPose>,
    /// One standard deviation of each number.
    pub sd: Option<Deviations>,
    /// What remains between outline and edges, pixels.
    pub misfit_px: Option<f64>,
    /// How bad it is: above 1 it is doubtful.
    pub badness: f64,
    /// Why, in a sentence.
    pub because: String,
}

/// The file of the table.
pub(super) const TABLE: &str = "track.csv";
/// First line of the table.
pub(super) const HEADING: &str = "frame,component,state,verdict,because,x_mm,y_mm,z_mm,z_rot_deg,x_rot_deg,y_rot_deg,\
sd_x_mm,sd_y_mm,sd_z_mm,sd_z_rot_deg,sd_x_rot_deg,sd_y_rot_deg,misfit_px,badness,file,frame_of_file\n";

/// The constants of the film as each component is seen on it, those of which they are known, with one standard deviation of each. Pixels are
/// those of the file.
pub(super) fn film_table<'p>(films: impl Iterator<Item = (&'p str, Option<FilmModel>)>) -> String {
    let mut text = String::from(
        "component,curvature_a_grey_value,sd_curvature,blur_px,sd_blur_px,attenuation_a_mm,sd_attenuation_a_mm,edges_enhanced,enhanced_within_px,square_px\n",
    );
    for (name, film) in films {
        let Some(film) = film else { continue };
        let square_px = film.constants.square_px;
        let pixels = square_px as f64;
        let blur_px = film.constants.blur_px * pixels;
        let values = [film.constants.curvature, blur_px, film.attenuation];
        text.push_str(&quoted(name));
        for (k, value) in values.into_iter().enumerate() {
            // Of blur and attenuation the logarithm's is known.
            let unit = if k == 0 { 1.0 } else { value };
            let deviation = unit * film.covariance[k][k].max(0.0).sqrt();
            text.push_str(&format!(",{value},{deviation}"));
        }
        let Sharpening { amount, radius_px } = film.constants.sharpening;
        let radius_px = radius_px * pixels;
        text.push_str(&format!(",{amount},{radius_px},{square_px}\n"));
    }
    text
}

/// How uncertain each pose is that has a covariance.
pub(super) fn uncertain(cell: &Cell) -> Option<Uncertain> {
    let found = cell.found().filter(|_| !cell.fixed)?;
    Some(Uncertain {
        covariance: found.covariance?,
        film_steps: Some(found.film_steps),
    })
}

impl Row {
    /// Of a component with such a `middle`, in a film that is read in squares with sides of so many pixels.
    pub(super) fn of(
        frame: usize,
        cell: &Cell,
        judged: &Conclusion,
        (middle, side): (&Vector3, usize),
    ) -> Self {
        let found = cell.found().filter(|_| !cell.fixed);
        let sd = found.and_then(|found| Some(found.covariance?.deviations(&found.pose, middle)));
        Self {
            frame: frame + 1,
            state: judged.state,
            pose: judged.pose.map(EulerPose::from),
            sd,
            misfit_px: cell.found().map(|found| found.in_pixels(side).misfit_px),
            badness: judged.badness,
            because: judged.to_string(),
        }
    }

    /// The word for how far the pose is to be trusted.
    pub fn verdict(&self) -> &'static str {
        match self.state {
            State::Fixed if self.badness > 1.0 => "doubtful",
            State::Fixed | State::Followed => "good",
            State::Doubtful | State::Interpolated => "doubtful",
            State::Untrackable | State::Unsolved => "none",
        }
    }

    /// Writes the row of a component; `file` is where the frame stands, and its number in that, from 1.
    pub(super) fn write(&self, component: &str, (file, place): (&str, usize), out: &mut String) {
        let number =
            |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:.6}"));
        let mut cells = vec![
            self.frame.to_string(),
            quoted(component),
            self.state.word().to_owned(),
            self.verdict().to_owned(),
            quoted(&self.because),
        ];
        let pose = self.pose.map(|pose| {
            let turns = [pose.z_rot_deg, pose.x_rot_deg, pose.y_rot_deg];
            ([pose.x_mm, pose.y_mm, pose.z_mm], turns)
        });
        let sd = self.sd.map(|sd| {
            let turns = [sd.z_rot_deg, sd.x_rot_deg, sd.y_rot_deg];
            ([sd.x_mm, sd.y_mm, sd.z_mm], turns)
        });
        for six in [pose, sd] {
            for k in 0..6 {
                let at = |(places, turns): ([f64; 3], [f64; 3])| {
                    if k < 3 { places[k] } else { turns[k - 3] }
                };
                cells.push(number(six.map(at)));
            }
        }
        cells.push(number(self.misfit_px));
        cells.push(number(self.pose.map(|_| self.badness)));
        cells.extend([quoted(file), place.to_string()]);
        // A string takes everything.
        let _ = writeln!(out, "{}", cells.join(","));
    }
}
