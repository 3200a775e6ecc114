//! What a person should know of a model as it was read, in sentences.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use super::owned::OwnedModel;
use super::surface::Bounds;
use super::unit::{SuspectedUnit, has_knee_size, suspected_unit};

/// A splinter this part of the model's radius beside all else makes its box a third longer, and moves the middle by a quarter of the radius. A judgement.
const FAR: f64 = 0.5;

impl OwnedModel {
    /// What a person should know of the model: what is unusual of its surface and what was done about it, what is of its shape, and a size that
    /// is no knee component's in millimetres. Sentences without their full stops; none of a closed surface of usual shape and size.
    #[must_use]
    pub fn remarks(&self) -> Vec<String> {
        let mut remarks = self.surface_remarks();
        remarks.extend(self.shape_remarks());
        remarks.extend(size_remark(&self.as_model().bounds()));
        remarks
    }

    fn surface_remarks(&self) -> Vec<String> {
        let faults = self.faults();
        let mut remarks = Vec::new();
        if faults.rims > 0 {
            let sides = count(
                faults.rims,
                "side of a triangle has",
                "sides of triangles have",
            );
            remarks.push(format!(
                "the surface has holes or cracks ({sides} no neighbour); its silhouette is that of its triangles as they are"
            ));
        }
        if faults.flipped > 0 {
            remarks.push(count(
                faults.flipped,
                "triangle ran against the neighbours and was turned",
                "triangles ran against the neighbours and were turned",
            ));
        }
        if faults.degenerate > 0 {
            let triangles = count(faults.degenerate, "triangle covers", "triangles cover");
            remarks.push(format!("{triangles} nothing; this changes nothing"));
        }
        remarks
    }

    fn shape_remarks(&self) -> Vec<String> {
        let mut remarks = Vec::new();
        let bodies = self.bodies();
        if bodies > 1 {
            remarks.push(format!(
                "the file holds {bodies} bodies that lie apart, and all count as this one component: if another component is among them, give each a file of its own"
            ));
        }
        let beyond_mm = self.splinters_beyond_mm();
        if beyond_mm > FAR * self.as_model().bounds().radius {
            remarks.push(format!(
                "a splinter of the surface lies {beyond_mm:.0} mm beside the rest: take it out of the file, or poses are looked for about a middle that is not the part's"
            ));
        }
        if let Some(round) = self.as_model().revolution() {
            let about = match round.is_ball {
                true => "any axis",
                false => "its axis",
            };
            remarks.push(format!(
                "the part is round: turned about {about} it looks the same, and no frame tells that rotation"
            ));
        }
        remarks
    }
}

fn count(number: usize, one: &str, many: &str) -> String {
    match number {
        1 => format!("1 {one}"),
        _ => format!("{number} {many}"),
    }
}

fn size_remark(bounds: &Bounds) -> Option<String> {
    if has_knee_size(bounds) {
        return None;
    }
    let width = 2.0 * bounds.radius;
    let unit = match suspected_unit(bounds) {
        Some(SuspectedUnit::Metres) => ": is the file in metres?",
        Some(SuspectedUnit::CentimetresOrInches) => ": is the file in centimetres or inches?",
        None => ": is it in the unit that was stated?",
    };
    Some(format!(
        "the model is {width:.3} mm across, which is no knee component's size in millimetres{unit} Write it again in millimetres, or every length is wrong"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::edges::fake::{self, add_box};
    use std::vec;

    fn box_of(size: f32) -> OwnedModel {
        let (mut vertices, mut triangles) = (vec![], vec![]);
        add_box([0.0; 3], [size; 3], &mut vertices, &mut triangles);
        let (vertices, triangles) = (vertices.as_flattened(), triangles.as_flattened());
        OwnedModel::new(vertices.to_vec(), triangles.to_vec()).expect("a box")
    }

    #[test]
    fn a_size_that_is_no_knees_is_said_with_the_unit_that_it_speaks_for() {
        assert!(box_of(60.0).remarks().is_empty());
        for (size, unit) in [
            (0.06, "in metres?"),
            (6.0, "in centimetres or inches?"),
            (2.4, "in centimetres or inches?"),
        ] {
            let remarks = box_of(size).remarks();
            let across = format!("{:.3} mm across", f64::from(size) * 3f64.sqrt());
            assert!(
                remarks.len() == 1 && remarks[0].contains(unit) && remarks[0].contains(&across),
                "{size}: {remarks:?}"
            );
        }
    }

    #[test]
    fn what_is_read_in_the_suspected_unit_has_a_knees_size() {
        for size in [0.06, 6.0, 2.4] {
            let bounds = box_of(size).as_model().bounds();
            let unit = suspected_unit(&bounds).expect("no knee is so small");
            let radii = unit.mm().iter().map(|mm| mm * bounds.radius);
            assert!(
                radii
                    .into_iter()
                    .any(|radius| (15.0..250.0).contains(&radius))
            );
        }
    }

    #[test]
    fn bodies_that_lie_apart_are_said_and_splinters_are_not() {
        let of = |boxes: &[([f32; 3], [f32; 3])]| {
            let (mut vertices, mut triangles) = (vec![], vec![]);
            for &(low, high) in boxes {
                add_box(low, high, &mut vertices, &mut triangles);
            }
            let (vertices, triangles) = (vertices.as_flattened(), triangles.as_flattened());
            OwnedModel::new(vertices.to_vec(), triangles.to_vec()).expect("boxes")
        };
        let (tray, stem) = (
            ([0.0; 3], [60.0, 4.0, 40.0]),
            ([20.0, -50.0, 15.0], [30.0, -5.0, 25.0]),
        );
        assert_eq!(of(&[tray]).bodies(), 1);
        assert_eq!(of(&[tray, stem]).bodies(), 2);
        let remarks = of(&[tray, stem]).remarks();
        assert!(
            remarks.len() == 1 && remarks[0].contains("2 bodies that lie apart"),
            "{remarks:?}"
        );
    }

    #[test]
    fn a_splinter_far_beside_is_said_and_one_in_the_box_is_not() {
        let with_splinter = |at: f32| {
            let (mut vertices, mut triangles) = (vec![], vec![]);
            add_box([0.0; 3], [60.0, 4.0, 40.0], &mut vertices, &mut triangles);
            let first = vertices.len() as u32;
            vertices.extend([[at, 1.0, 1.0], [at + 1.0, 1.0, 1.0], [at, 2.0, 1.0]]);
            triangles.push([first, first + 1, first + 2]);
            let (vertices, triangles) = (vertices.as_flattened(), triangles.as_flattened());
            OwnedModel::new(vertices.to_vec(), triangles.to_vec()).expect("a box")
        };
        let said = |at: f32| {
            let remarks = with_splinter(at).remarks();
            remarks.iter().any(|said| said.contains("beside the rest"))
        };
        assert_eq!(with_splinter(30.0).splinters_beyond_mm(), 0.0);
        assert_eq!(with_splinter(300.0).splinters_beyond_mm(), 241.0);
        assert!(said(300.0) && said(-200.0) && !said(30.0) && !said(62.0));
    }

    #[test]
    fn a_round_part_is_said_to_be_round_and_a_box_is_not() {
        const SIDES: u32 = 48;
        let mut vertices = vec![0.0, 60.0, 0.0, 0.0, 0.0, 0.0];
        let mut triangles = vec![];
        for side in 0..SIDES {
            let (sine, cosine) = libm::sincosf(side as f32 / SIDES as f32 * core::f32::consts::TAU);
            vertices.extend([20.0 * cosine, 0.0, 20.0 * sine]);
            let [one, next] = [side, side + 1].map(|side| 2 + side % SIDES);
            triangles.extend([0, next, one, 1, one, next]);
        }
        let cone = OwnedModel::new(vertices, triangles).expect("a cone");
        let is_round =
            |owned: &OwnedModel| owned.remarks().iter().any(|said| said.contains("is round"));
        assert!(is_round(&cone) && cone.as_model().revolution().is_some());
        assert!(!is_round(&box_of(60.0)));
    }

    /// A box of twelve triangles beside two rings of many, of which one lies around the other.
    #[test]
    fn bodies_are_counted_alike_however_finely_they_are_cut() {
        let (mut vertices, mut triangles) = fake::torus(&[0.0; 40]);
        let fine = triangles.len();
        fake::add_box(
            [20.0, 0.0, 70.0],
            [60.0, 4.0, 130.0],
            &mut vertices,
            &mut triangles,
        );
        assert!(20 * (triangles.len() - fine) < fine);
        let (vertices, triangles) = (vertices.as_flattened(), triangles.as_flattened());
        let owned = OwnedModel::new(vertices.to_vec(), triangles.to_vec()).expect("valid");
        assert_eq!(owned.bodies(), 2);
    }

    #[test]
    fn holes_and_windings_are_said() {
        let vertices = [
            0.0, 0.0, 0.0, 60.0, 0.0, 0.0, 0.0, 60.0, 0.0, 60.0, 60.0, 0.0,
        ];
        let open = OwnedModel::new(vertices.to_vec(), [0, 1, 2, 1, 2, 3].to_vec()).expect("valid");
        let remarks = open.remarks();
        assert!(
            remarks[0].contains("4 sides of triangles have no neighbour"),
            "{remarks:?}"
        );
        assert!(remarks[1].contains("1 triangle ran against"), "{remarks:?}");
    }
}
