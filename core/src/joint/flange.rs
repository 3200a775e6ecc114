//! Which knee a femoral component is made for, as its anterior flange tells.
//!
//! Most designs are made for one side: their flange is raised laterally, their groove leads there, or both (Bindelglass and Dorr 1998,
//! J Arthroplasty 13:939), as the kneecap comes from there. Such a flange reaches higher at its lateral half. Where somebody states the other side,
//! every sign of internal rotation and abduction is wrong, and no pose tells.

use core::fmt;

use crate::joint::kinematics::Side;
use crate::math::{Vector3, add, dot, scale, subtract};
use crate::mesh::Mesh;
use crate::mesh::anatomy::{AnatomicalAxes, reach};

/// Heights are compared at so many places of either half.
const PLACES: usize = 10;
/// Places lie between these parts of half the component's width off its middle: further in both halves are one ridge or the groove, further
/// out no flange has a tip.
const PLACED: (f64, f64) = (0.15, 0.6);
/// The flange lies within this part of the component's depth from its front; a stem or a box stands behind it.
const FLANGE: f64 = 0.25;
/// A half is the higher one where it is so by more than this part of the width in the median. A flange that is its own mirror image is 0; those
/// of three designs that are made for one side are 0.09, 0.18 and 0.21.
const HIGHER_PART: f64 = 0.04;

/// The knee that a femoral component is made for. `None` where its flange is as high on both halves, or its axes do not tell front from back;
/// it never tells of a component whose flange is not the higher arm of its bow.
#[must_use]
pub fn side_by_flange(mesh: &Mesh<'_>, axes: &AnatomicalAxes) -> Option<Side> {
    let leans = axes.front_is_known.then(|| leaning(mesh, axes)).flatten()?;
    match leans {
        leans if leans > HIGHER_PART => Some(Side::Right),
        leans if leans < -HIGHER_PART => Some(Side::Left),
        _ => None,
    }
}

/// A side that is stated, where a femoral component's flange tells the other one. In words it is a sentence without its full stop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct OtherSide {
    /// The knee that the component is made for.
    pub told: Side,
}

impl OtherSide {
    /// What there is to say of a femoral component on the side that is stated.
    #[must_use]
    pub fn than(stated: Side, mesh: &Mesh<'_>, axes: &AnatomicalAxes) -> Option<Self> {
        let told = side_by_flange(mesh, axes)?;
        (told != stated).then_some(Self { told })
    }
}

impl fmt::Display for OtherSide {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (told, stated) = (self.told, self.told.other());
        write!(
            f,
            "the femoral component's flange is higher at its {told} half, as those of {told} knees are, but the side is stated as {stated}: of a {told} knee internal rotation and abduction would have the other sign, and medial would be lateral"
        )
    }
}

/// By how much of the component's width the flange's right half is higher than its left one. `None` where a place has no flange.
fn leaning(mesh: &Mesh<'_>, axes: &AnatomicalAxes) -> Option<f64> {
    let column = |at: usize| axes.model_from_field.rotation.map(|row| row[at]);
    let [forward, up, right] = [column(0), column(1), column(2)];
    let ((left_end, right_end), (back, front)) = (reach(mesh, &right), reach(mesh, &forward));
    let (width, middle) = (right_end - left_end, (left_end + right_end) / 2.0);
    let height = |across: f64| {
        let cut = sides(mesh).filter_map(|side| at_distance(&side, &right, middle + across));
        let flange = cut.filter(|point| dot(point, &forward) > front - FLANGE * (front - back));
        flange
            .map(|point| dot(&point, &up))
            .fold(f64::NEG_INFINITY, f64::max)
    };
    // In the median, as a stem that leans over the flange is higher.
    let mut higher: [f64; PLACES] = core::array::from_fn(|place| {
        let across = off_middle(place) * width / 2.0;
        height(across) - height(-across)
    });
    higher.sort_unstable_by(f64::total_cmp);
    let leaning = (higher[PLACES / 2 - 1] + higher[PLACES / 2]) / (2.0 * width);
    higher.iter().all(|mm| mm.is_finite()).then_some(leaning)
}

/// How far a place lies off the middle, of half the width.
fn off_middle(place: usize) -> f64 {
    let (from, to) = PLACED;
    from + (to - from) * place as f64 / (PLACES - 1) as f64
}

/// Both ends of every triangle's sides.
fn sides<'m>(mesh: &Mesh<'m>) -> impl Iterator<Item = [Vector3; 2]> + 'm {
    let corners = mesh.vertices();
    mesh.triangles().iter().flat_map(move |triangle| {
        let [a, b, c] = triangle.map(|vertex| corners[vertex as usize].map(f64::from));
        [[a, b], [b, c], [c, a]]
    })
}

/// Where a side meets the plane that is so far along an axis, mm.
fn at_distance([a, b]: &[Vector3; 2], axis: &Vector3, mm: f64) -> Option<Vector3> {
    let (from, to) = (dot(a, axis), dot(b, axis));
    let meets = (from < mm) != (to < mm);
    meets.then(|| add(a, &scale(&subtract(b, a), (mm - from) / (to - from))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::edges::fake::add_box;
    use crate::pose::Pose;
    use std::vec::Vec;

    /// A bow of strips across the knee, x forwards, y up, z to the right: a condyle behind, 50 mm wide plate, and a flange whose corner at z
    /// is `left` and `right` mm high.
    fn bow(left: f32, right: f32) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
        let rows = [
            [[-30.0, 20.0, -35.0], [-30.0, 20.0, 35.0]],
            [[-20.0, 0.0, -35.0], [-20.0, 0.0, 35.0]],
            [[20.0, 0.0, -35.0], [20.0, 0.0, 35.0]],
            [[30.0, left, -35.0], [30.0, right, 35.0]],
        ];
        let vertices = rows.concat();
        let strips = (0..3).flat_map(|row| {
            let at = 2 * row;
            [[at, at + 1, at + 2], [at + 1, at + 3, at + 2]]
        });
        (vertices, strips.collect())
    }

    fn told(vertices: &[[f32; 3]], triangles: &[[u32; 3]], front_is_known: bool) -> Option<Side> {
        let mesh = Mesh::new(vertices, triangles).expect("valid");
        let axes = AnatomicalAxes {
            model_from_field: Pose::IDENTITY,
            front_is_known,
            are_files_own: true,
        };
        side_by_flange(&mesh, &axes)
    }

    #[test]
    fn the_higher_half_is_lateral_and_one_as_high_as_the_other_tells_nothing() {
        for (left, right, side) in [
            (50.0, 30.0, Some(Side::Left)),
            (30.0, 50.0, Some(Side::Right)),
            (40.0, 40.0, None),
            (40.0, 42.0, None),
        ] {
            let (vertices, triangles) = bow(left, right);
            assert_eq!(told(&vertices, &triangles, true), side, "{left} {right}");
            assert_eq!(told(&vertices, &triangles, false), None, "front unknown");
        }
    }

    /// A flange that rises evenly from one side to the other: a place that lies a part of half the width off the middle is higher than the
    /// one across from it by that part of what the corners differ by, and in the median it is the middle of [`PLACED`].
    #[test]
    fn an_evenly_rising_flange_leans_by_what_its_corners_differ_by_wherever_it_lies() {
        let field = Pose {
            rotation: crate::math::rotation_by(&[0.4, -0.7, 0.3]),
            translation: [50.0, -20.0, 300.0],
        };
        for (left, right) in [(50.0, 30.0), (31.0, 47.0), (40.0, 40.0)] {
            let (vertices, triangles) = bow(left, right);
            // Far beside the middle of its axes.
            let place = |[x, y, z]: &[f32; 3]| {
                let moved = field.transform(&[x + 11.0, y - 7.0, z + 90.0].map(f64::from));
                moved.map(|mm| mm as f32)
            };
            let moved: Vec<[f32; 3]> = vertices.iter().map(place).collect();
            let mesh = Mesh::new(&moved, &triangles).expect("valid");
            let axes = AnatomicalAxes {
                model_from_field: field,
                front_is_known: true,
                are_files_own: true,
            };
            let wanted = (PLACED.0 + PLACED.1) / 2.0 * f64::from(right - left) / 70.0;
            let found = leaning(&mesh, &axes).expect("a flange");
            assert!((found - wanted).abs() < 1e-5, "{found} {wanted}");
        }
    }

    /// From either end, and with an end in the very plane, of which just one of two sides that go on from it may be met.
    #[test]
    fn a_side_meets_a_plane_in_one_point_whichever_end_comes_first() {
        let axis = [0.0, 0.6, 0.8];
        let at = |mm: f64, aside: f64| [aside, 0.6 * mm, 0.8 * mm];
        for low in -3..=3 {
            for high in low..=3 {
                let ends = [at(f64::from(low), 5.0), at(f64::from(high), -1.0)];
                for mm in [-2.5, -1.0, 0.0, 0.5, 2.0] {
                    let met = at_distance(&ends, &axis, mm);
                    let turned = at_distance(&[ends[1], ends[0]], &axis, mm);
                    assert_eq!(met.is_some(), turned.is_some(), "{low} {high} {mm}");
                    let (from, to) = (f64::from(low), f64::from(high));
                    if from < mm && mm < to {
                        let aside = 5.0 - 6.0 * (mm - from) / (to - from);
                        for point in [met, turned] {
                            let off = subtract(&point.expect("between"), &at(mm, aside));
                            assert!(dot(&off, &off) < 1e-18, "{point:?}");
                        }
                    }
                    if mm < from || to < mm || from == to {
                        assert_eq!(met, None, "{low} {high} {mm}");
                    }
                }
            }
        }
    }

    #[test]
    fn the_other_side_is_told_and_the_right_one_is_not() {
        let (vertices, triangles) = bow(50.0, 30.0);
        let mesh = Mesh::new(&vertices, &triangles).expect("valid");
        let axes = AnatomicalAxes::from_words("x y z").expect("axes");
        assert_eq!(OtherSide::than(Side::Left, &mesh, &axes), None);
        let other = OtherSide::than(Side::Right, &mesh, &axes).expect("told");
        let told = std::format!("{other}");
        assert!(
            told.contains("higher at its left half") && told.contains("stated as right"),
            "{told}"
        );
    }

    #[test]
    fn a_stem_beside_the_middle_is_no_flange() {
        for (left, right, side) in [(40.0, 40.0, None), (50.0, 30.0, Some(Side::Left))] {
            let (mut vertices, mut triangles) = bow(left, right);
            add_box(
                [5.0, 0.0, -4.0],
                [12.0, 120.0, 10.0],
                &mut vertices,
                &mut triangles,
            );
            assert_eq!(told(&vertices, &triangles, true), side, "{left} {right}");
        }
    }

    /// However wide it is, and however far to one side.
    #[test]
    fn an_offset_stem_is_no_flange() {
        for (left, right, side) in [
            (40.0, 40.0, None),
            (50.0, 30.0, Some(Side::Left)),
            (30.0, 50.0, Some(Side::Right)),
        ] {
            for (from, to) in [(-15.0, 3.0), (-3.0, 15.0), (2.0, 20.0)] {
                let (mut vertices, mut triangles) = bow(left, right);
                add_box(
                    [-6.0, 0.0, from],
                    [12.0, 120.0, to],
                    &mut vertices,
                    &mut triangles,
                );
                assert_eq!(
                    told(&vertices, &triangles, true),
                    side,
                    "{left} {right} {from}"
                );
            }
        }
    }

    #[test]
    fn what_stands_behind_is_no_flange() {
        let (mut vertices, triangles) = bow(40.0, 40.0);
        vertices[0][1] = 39.0;
        assert_eq!(told(&vertices, &triangles, true), None);
    }
}
