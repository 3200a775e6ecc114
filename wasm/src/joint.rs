//! The joint's numbers, frame by frame, for curves and tables.

use fluoropose::joint::flange::OtherSide;
use fluoropose::joint::impossible::{impossible, origins_apart};
use fluoropose::joint::kinematics::{Side, joint_axes};
use fluoropose::joint::numbers::{NUMBERS, Posed};
use fluoropose::joint::relative::{Placed, Relative};
use fluoropose::joint::shared::{ERRORS, KnownTo};
use fluoropose::joint::{COLUMNS, Joint, JointFrame};
use fluoropose::math::Vector3;
use fluoropose::mesh::Mesh;
use fluoropose::mesh::anatomy::AnatomicalAxes;
use fluoropose::pose::Pose;
use fluoropose::pose::covariance::PoseCovariance;
use wasm_bindgen::prelude::*;

use crate::uncertainty::{FILM, UPPER, Uncertainty, covariance_of};
use fluoropose_page::error::sentence;
use fluoropose_page::pose_numbers::{axes_from, from_numbers};

/// Points of the tray's border.
pub(crate) const BORDER: usize = 180;

/// Thresholds of lift-off in use, mm.
const THRESHOLDS_MM: [f64; 2] = [0.7, 1.0];
/// Numbers of a component in a frame that come in: a pose and its uncertainty ([`crate::uncertainty::Uncertainty`]).
const PLACED: usize = 6 + UNCERTAIN;
/// And that go out: numbers, their standard deviations, the probability of lift-off beyond each threshold, and what errors of the
/// whole film do to each number.
pub(crate) const OUT: usize = SHOWN + ERRORS * NUMBERS;
/// Those of them that have names.
pub(crate) const SHOWN: usize = 2 * NUMBERS + THRESHOLDS_MM.len();
/// Numbers of a pose's uncertainty.
const UNCERTAIN: usize = core::mem::size_of::<Uncertainty>() / core::mem::size_of::<f64>();

/// A component: its mesh, empty where there is no model, and the anatomical axes of its file.
pub(crate) struct Part {
    vertices: Vec<f32>,
    triangles: Vec<u32>,
    pub(crate) axes: Pose,
}

impl Part {
    /// What the turns of a covariance leave in place.
    fn middle(&self) -> Result<Vector3, JsError> {
        if self.vertices.is_empty() {
            return Ok([0.0; 3]);
        }
        Ok(self.mesh()?.bounds().centre)
    }

    /// Axes as a joint has them: what their signs are has been told or stated.
    pub(crate) fn anatomical_axes(&self) -> AnatomicalAxes {
        AnatomicalAxes {
            model_from_field: self.axes,
            front_is_known: true,
            are_files_own: false,
        }
    }

    fn mesh(&self) -> Result<Mesh<'_>, JsError> {
        Mesh::new(self.vertices.as_chunks().0, self.triangles.as_chunks().0).map_err(sentence)
    }
}

/// Both components of a knee.
#[wasm_bindgen]
pub struct KneeJoint {
    pub(crate) femur: Part,
    pub(crate) tibia: Part,
    pub(crate) side: Side,
    memory: Vec<u32>,
}

#[wasm_bindgen]
impl KneeJoint {
    /// From the models and their axes (nine numbers each, as `axes_from` takes them). Without vertices there is no model, and
    /// the lowest points are not known. `left` is the side of the body.
    ///
    /// # Errors
    /// The core's sentence about a mesh, or about axes that are no right-handed frame.
    #[wasm_bindgen(constructor)]
    pub fn new(
        femur_vertices: Vec<f32>,
        femur_triangles: Vec<u32>,
        femur_axes: &[f64],
        tibia_vertices: Vec<f32>,
        tibia_triangles: Vec<u32>,
        tibia_axes: &[f64],
        left: bool,
    ) -> Result<Self, JsError> {
        let femur = Part {
            vertices: femur_vertices,
            triangles: femur_triangles,
            axes: axes_from(femur_axes)?,
        };
        let tibia = Part {
            vertices: tibia_vertices,
            triangles: tibia_triangles,
            axes: axes_from(tibia_axes)?,
        };
        let mut joint = Self {
            femur,
            tibia,
            side: if left { Side::Left } else { Side::Right },
            memory: Vec::new(),
        };
        let needed = joint.joint()?.map_or(0, |joint| joint.memory_needed());
        joint.memory = vec![0; needed];
        Ok(joint)
    }

    /// Whether lowest points and lift-off are known: there are both models, and the tray has a plate.
    #[wasm_bindgen(getter, js_name = hasPlate)]
    pub fn has_plate(&self) -> bool {
        !self.memory.is_empty()
    }

    /// What the femoral component's flange says of the side where it tells the other one: a sentence without its full stop.
    ///
    /// # Errors
    /// The core's sentence about a mesh.
    #[wasm_bindgen(js_name = otherSide)]
    pub fn other_side_in_words(&self) -> Result<Option<String>, JsError> {
        Ok(self.other_side()?.map(|other| other.to_string()))
    }

    /// The names of all numbers that a frame gets, in their order.
    #[wasm_bindgen(getter)]
    pub fn columns(&self) -> Vec<String> {
        let names = COLUMNS.iter().map(|column| column.name.to_owned());
        let deviations = COLUMNS.iter().map(|column| format!("sd_{}", column.name));
        let beyond = THRESHOLDS_MM.map(|mm| format!("p_lift_off_over_{mm:.1}_mm"));
        names.chain(deviations).chain(beyond).collect()
    }

    /// The numbers of frames, as many for each as there are columns; NaN for what is not known. Of each frame the femoral
    /// pose (x, y, z in mm, then z, x and y rotation in degrees) with its uncertainty as `Match.uncertainty` gives it; then
    /// the tibial one. NaN is not known: where the standard deviations alone are, their errors are taken as independent.
    ///
    /// # Errors
    /// When a pose is not six finite numbers.
    pub fn numbers(&mut self, frames: &[f64]) -> Result<Vec<f64>, JsError> {
        let mut memory = core::mem::take(&mut self.memory);
        let found = self.all(frames, &mut memory);
        self.memory = memory;
        found
    }

    /// The border of the tray's plate as seen from above: anterior and medial place of each point, mm; empty where there is no plate.
    ///
    /// # Errors
    /// The core's sentence about a mesh.
    #[wasm_bindgen(js_name = plateOutline)]
    pub fn plate_outline(&self) -> Result<Vec<f64>, JsError> {
        let Some(joint) = self.joint()? else {
            return Ok(Vec::new());
        };
        let mut outline = vec![[0.0; 2]; BORDER];
        joint.plate_outline(&mut outline);
        Ok(outline.into_flattened())
    }

    /// Why no knee has one of a frame's numbers, as [`Self::numbers`] gives them: a sentence without its full stop. Nothing where it can
    /// have them all.
    pub fn impossible(&self, frame: &[f64]) -> Option<String> {
        let numbers = frame.first_chunk::<NUMBERS>()?;
        impossible(numbers).map(|wrong| wrong.to_string())
    }

    /// The largest of a frame's translations, mm, where it is no knee's because the origin of a model's file lies far off its component.
    #[wasm_bindgen(js_name = originsApart)]
    pub fn origins_apart(&self, frame: &[f64]) -> Option<f64> {
        origins_apart(frame.first_chunk::<NUMBERS>()?)
    }
}

impl KneeJoint {
    pub(crate) fn other_side(&self) -> Result<Option<OtherSide>, JsError> {
        if self.femur.vertices.is_empty() {
            return Ok(None);
        }
        let axes = self.femur.anatomical_axes();
        Ok(OtherSide::than(self.side, &self.femur.mesh()?, &axes))
    }

    pub(crate) fn joint(&self) -> Result<Option<Joint<'_>>, JsError> {
        if self.femur.vertices.is_empty() || self.tibia.vertices.is_empty() {
            return Ok(None);
        }
        Ok(Joint::new(
            (self.femur.mesh()?, &self.femur.axes),
            (self.tibia.mesh()?, &self.tibia.axes),
            self.side,
        ))
    }

    fn all(&self, frames: &[f64], memory: &mut [u32]) -> Result<Vec<f64>, JsError> {
        let joint = self.joint()?;
        let placed = |part: &Part, middle: &Vector3, numbers: &[f64]| -> Result<Placed, JsError> {
            let posed = posed(numbers, middle)?;
            let axes = joint_axes(&part.axes, self.side);
            let placed = Placed::new(&posed.pose, &axes, middle, posed.covariance);
            Ok(placed.on_film(posed.film_steps))
        };
        let middles = [self.femur.middle()?, self.tibia.middle()?];
        let mut numbers = Vec::with_capacity(frames.len() / (2 * PLACED) * OUT);
        for frame in frames.as_chunks::<{ 2 * PLACED }>().0 {
            let (femur, tibia) = frame.split_at(PLACED);
            let femur = placed(&self.femur, &middles[0], femur)?;
            let tibia = placed(&self.tibia, &middles[1], tibia)?;
            let relative = Relative::new(&femur, &tibia, KnownTo::USUALLY);
            let found = match &joint {
                Some(joint) => joint.at(&relative, memory).map_err(sentence)?,
                None => JointFrame::without_models(&relative, self.side),
            };
            numbers.extend(found.numbers);
            numbers.extend(found.deviations.unwrap_or([f64::NAN; NUMBERS]));
            let beyond = |mm| found.lift_off_probability(mm).unwrap_or(f64::NAN);
            numbers.extend(THRESHOLDS_MM.map(beyond));
            numbers.extend(found.shared.as_flattened());
        }
        Ok(numbers)
    }
}

/// A pose, its covariance where that is known, or at least the standard deviations of its six numbers, and what of it is the film's.
fn posed(numbers: &[f64], middle: &Vector3) -> Result<Posed, JsError> {
    let (pose, uncertainty) = numbers.split_at(6);
    let (uncertainty, film) = uncertainty.split_at(UNCERTAIN - FILM);
    let pose = Pose::from(from_numbers(pose)?);
    let (deviations, upper) = uncertainty.split_at(6);
    let known = |numbers: &[f64]| numbers.iter().all(|number| number.is_finite());
    let covariance = match <&[f64; UPPER]>::try_from(upper) {
        Ok(upper) if known(upper) => Some(covariance_of(upper)),
        _ if known(deviations) => {
            let deviations = core::array::from_fn(|k| deviations[k]);
            Some(PoseCovariance::from_independent(&deviations, &pose, middle))
        }
        _ => None,
    };
    // Sessions from before it was kept do not have it.
    let film_steps = match film.as_chunks::<6>().0 {
        [curve, blur] if known(film) => [*curve, *blur],
        _ => [[0.0; 6]; 2],
    };
    Ok(Posed {
        pose,
        covariance,
        film_steps,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fake::add_box;

    const OWN: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

    /// A left knee of boxes: condyles whose undersides lie 10 and 9 mm below the origin, over a plate whose upper side
    /// lies at it. x is anterior, y superior, z to the right, which is medial.
    fn knee(with_models: bool) -> KneeJoint {
        let (mut femur, mut tibia) = <((Vec<f32>, Vec<u32>), (Vec<f32>, Vec<u32>))>::default();
        if with_models {
            for (low, high) in [
                ([-5.0, -10.0, 14.0], [5.0, 10.0, 34.0]),
                ([-5.0, -9.0, -34.0], [5.0, 10.0, -14.0]),
            ] {
                add_box(low, high, &mut femur.0, &mut femur.1);
            }
            for (low, high) in [
                ([-25.0, -4.0, -38.0], [25.0, 0.0, 38.0]),
                ([-7.0, -40.0, -5.0], [7.0, -4.0, 5.0]),
            ] {
                add_box(low, high, &mut tibia.0, &mut tibia.1);
            }
        }
        let joint = KneeJoint::new(femur.0, femur.1, &OWN, tibia.0, tibia.1, &OWN, true);
        joint.ok().unwrap()
    }

    /// The femoral component 3 mm in front and 30 mm above, 0.3 mm uncertain upwards and 0.2 forwards; all else is certain.
    fn frame() -> Vec<f64> {
        let mut frame = vec![3.0, 30.0, -1000.0, 0.0, 0.0, 0.0];
        frame.extend([0.2, 0.3, 0.0, 0.0, 0.0, 0.0]);
        frame.extend([f64::NAN; UPPER + FILM]);
        frame.extend([0.0, 0.0, -1000.0, 0.0, 0.0, 0.0]);
        frame.extend([0.0; 6]);
        frame.extend([f64::NAN; UPPER + FILM]);
        frame
    }

    fn named(joint: &KneeJoint, numbers: &[f64], name: &str) -> f64 {
        let at = joint.columns().iter().position(|column| column == name);
        numbers[at.unwrap()]
    }

    #[test]
    fn a_knee_of_boxes_has_the_numbers_that_its_drawing_has() {
        let mut joint = knee(true);
        assert!(joint.has_plate());
        let numbers = joint.numbers(&frame()).ok().unwrap();
        assert_eq!(numbers.len(), OUT);
        for (name, wanted) in [
            ("field_anterior_mm", 3.0),
            ("flexion_deg", 0.0),
            ("medial_ap_mm", 3.0),
            ("medial_ap_percent", 56.0),
            ("medial_height_mm", 20.0),
            ("lateral_height_mm", 21.0),
            ("lift_off_mm", 1.0),
            // Models whose size is known to a thousandth: their middles lie 3 and 0 mm right of the axis, 30 above and 20 below it.
            ("sd_field_anterior_mm", 0.2f64.hypot(0.003)),
            ("sd_medial_ap_mm", 0.2f64.hypot(0.003)),
            ("sd_medial_height_mm", 0.3f64.hypot(0.03).hypot(0.02)),
            ("sd_lift_off_mm", 0.0),
            ("sd_flexion_deg", 0.0),
            ("p_lift_off_over_0.7_mm", 1.0),
        ] {
            let found = named(&joint, &numbers, name);
            assert!((found - wanted).abs() < 1e-5, "{name}: {found}");
        }
    }

    #[test]
    fn a_femur_that_looks_the_other_way_is_told() {
        let mut joint = knee(true);
        let mut frame = frame();
        let here = joint.numbers(&frame).ok().unwrap();
        assert_eq!(joint.impossible(&here), None);
        assert_eq!(joint.origins_apart(&here), None);
        frame[2] += 400.0;
        let far = joint.numbers(&frame).ok().unwrap();
        assert!(joint.origins_apart(&far).is_some_and(|mm| mm.abs() > 200.0));
        frame[2] -= 400.0;
        frame[5] = 160.0;
        let there = joint.numbers(&frame).ok().unwrap();
        let told = joint.impossible(&there).unwrap();
        assert!(told.contains("160") && told.contains("no knee"), "{told}");
    }

    /// The tray may be turned about z by 0.01 rad and shifted forwards by 0.3 mm. The femoral origin is 50 mm above its middle, so
    /// it seems to move by 0.5 mm forwards and 0.3 mm back: together 0.2 mm, against each other 0.8 mm, and 0.2 mm of its own.
    #[test]
    fn a_whole_covariance_takes_errors_together() {
        let mut joint = knee(true);
        for (together, wanted) in [(1.0, 0.2), (0.0, 0.5f64.hypot(0.3)), (-1.0, 0.8)] {
            let mut frame = frame();
            let mut matrix = [[0.0; 6]; 6];
            (matrix[2][2], matrix[3][3]) = (1e-4, 0.09);
            (matrix[2][3], matrix[3][2]) = (together * 0.003, together * 0.003);
            let upper = (0..6).flat_map(|row| matrix[row][row..].to_vec());
            for (place, number) in frame[PLACED + 12..].iter_mut().zip(upper) {
                *place = number;
            }
            let numbers = joint.numbers(&frame).ok().unwrap();
            let found = named(&joint, &numbers, "sd_field_anterior_mm");
            assert!(
                (found - 0.2f64.hypot(wanted)).abs() < 1e-3,
                "{together}: {found}"
            );
        }
    }

    #[test]
    fn what_is_not_known_is_nan_frame_by_frame() {
        let mut joint = knee(false);
        assert!(!joint.has_plate());
        let mut frames = frame();
        frames.extend(frame());
        frames[3 * PLACED + 8] = f64::NAN;
        let numbers = joint.numbers(&frames).ok().unwrap();
        let (first, second) = numbers.split_at(OUT);
        assert!((named(&joint, first, "sd_field_anterior_mm") - 0.2f64.hypot(0.003)).abs() < 1e-9);
        assert!(named(&joint, first, "lift_off_mm").is_nan());
        assert!((named(&joint, second, "field_anterior_mm") - 3.0).abs() < 1e-9);
        assert!(named(&joint, second, "sd_field_anterior_mm").is_nan());
        assert!(named(&joint, second, "p_lift_off_over_0.7_mm").is_nan());
    }
}
