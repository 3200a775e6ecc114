//! Which component of a knee a model has the shape of: a tray is a plate on a keel, a femoral component a bow.
//!
//! Two relations tell them. The first is the part of the surface that faces one way or its opposite. Of a plate ten times as wide as
//! thick ten twelfths do; keel, stem and rim may add as much surface again, and five twelfths are left. Any box, however it is
//! proportioned, shows at least a third of itself so; a bow whose normals go half way round shows a sixth. The second is how far the
//! middle of the surface lies from that of its outermost points: a convex body that is round on one side alone, half a ball, has them
//! 0.08 of its radius apart, a bow, whose inner side counts among its surface and reaches nowhere, half as much again and more, unless
//! it is thick.
//!
//! A tray on a long stem has them far apart too, and less of its surface is its plate: of what does not run along the stem, the plate is
//! nearly all.
//!
//! All of these are areas over areas and lengths over lengths, in the frame of the surface's own normals: units, axes, winding and
//! the size of triangles do not matter. What is neither a plate nor a bow, or a little of both, tells nothing.

use super::KneeComponent;
use super::faced::{FACING, faces, vertices};
use crate::math::eigen::eigen_symmetric;
use crate::math::{Matrix3, Vector3, add, apply, dot, norm, scale, subtract, transpose};
use crate::mesh::surface::Mesh;

/// Part of a tray's surface that faces one way, at least.
const PLATE: f64 = 5.0 / 12.0;
/// That of a box, at least.
const BOX: f64 = 1.0 / 3.0;
/// The middles of a bow's surface and of its outermost points lie so far apart, of its radius, at least.
const BOW: f64 = 0.11;
/// Faces within 15 degrees of running along a direction do: the sine of that.
const ASIDE: f64 = 0.258_819_045_102_520_76;
/// Of what does not run along the way to its outermost points a tray has at least this part across it. A bow has less than half.
const STANDING: f64 = 2.0 / 3.0;

/// The component that a model has the shape of; `None` where its shape tells neither, or it has no surface. It need not be closed.
#[must_use]
pub fn component_by_shape(mesh: &Mesh<'_>) -> Option<KneeComponent> {
    let frame = Surface::of(mesh)?;
    let plate = frame.plate_fraction(mesh);
    if plate > PLATE {
        return Some(KneeComponent::Tibia);
    }
    let out = frame.outwards(mesh)?;
    let is_bow =
        plate < BOX && norm(&out) > BOW * mesh.bounds().radius && !is_on_a_stem(mesh, &out);
    is_bow.then_some(KneeComponent::Femur)
}

/// Whether a plate stands across a direction, and little else but what runs along it: a tray whose stem has more surface than its plate.
fn is_on_a_stem(mesh: &Mesh<'_>, out: &Vector3) -> bool {
    let Some(along) = unit(out) else {
        return false;
    };
    let (mut facing, mut rest) = (0.0, 0.0);
    for (_, area, normal) in faces(mesh) {
        let part = dot(&normal, &along).abs();
        if part > ASIDE * area {
            rest += area;
            facing += if part >= FACING * area { area } else { 0.0 };
        }
    }
    facing > STANDING * rest
}

/// A surface and the frame of its own normals.
struct Surface {
    /// Doubled.
    area: f64,
    middle: Vector3,
    /// Its rows are the directions that most of the surface faces, second most, and least.
    own_from_model: Matrix3,
}

impl Surface {
    fn of(mesh: &Mesh<'_>) -> Option<Self> {
        let mut tensor: Matrix3 = [[0.0; 3]; 3];
        let (mut area, mut sum) = (0.0, [0.0; 3]);
        for (middle, doubled, normal) in faces(mesh).filter(|(_, doubled, _)| *doubled > 0.0) {
            area += doubled;
            sum = add(&sum, &scale(&middle, doubled));
            for (row, &x) in tensor.iter_mut().zip(&normal) {
                for (sum, &y) in row.iter_mut().zip(&normal) {
                    *sum += x * y / doubled;
                }
            }
        }
        let (_, own_from_model) = eigen_symmetric(&tensor);
        (area > 0.0).then(|| Self {
            area,
            middle: scale(&sum, 1.0 / area),
            own_from_model,
        })
    }

    /// The largest part of the surface that faces one direction or its opposite.
    fn plate_fraction(&self, mesh: &Mesh<'_>) -> f64 {
        let cells = self.cells(mesh);
        let near = |along: &Vector3| {
            let parts = cells.iter().filter(|sum| norm(sum) > 0.0);
            parts.fold([0.0; 3], |all, sum| add(&all, &towards(sum, along)))
        };
        let sums = cells.iter().filter_map(|sum| Some(near(&unit(sum)?)));
        let most = sums.max_by(|a, b| norm(a).total_cmp(&norm(b)));
        let Some(along) = most.and_then(|sum| unit(&sum)) else {
            return 0.0;
        };
        let along = apply(&transpose(&self.own_from_model), &along);
        let facing = faces(mesh)
            .filter(|(_, area, normal)| *area > 0.0 && dot(normal, &along).abs() >= FACING * area);
        facing.map(|(_, area, _)| area).sum::<f64>() / self.area
    }

    /// Normals of the faces as long as their areas, opposite ones taken together, summed in cells of some eleven degrees.
    fn cells(&self, mesh: &Mesh<'_>) -> [Vector3; CELLS] {
        let mut cells = [[0.0; 3]; CELLS];
        for (.., normal) in faces(mesh).filter(|(_, area, _)| *area > 0.0) {
            let own = apply(&self.own_from_model, &normal);
            if let Some((cell, sign)) = cell_of(&own) {
                cells[cell] = add(&cells[cell], &scale(&own, sign));
            }
        }
        cells
    }

    /// The way from the middle of the surface to that of its outermost points, mm.
    fn outwards(&self, mesh: &Mesh<'_>) -> Option<Vector3> {
        let mut sum = [0.0; 3];
        for number in 0..ROUND {
            let sign = |bit: usize| if number >> bit & 1 == 0 { 1.0 } else { -1.0 };
            let own = core::array::from_fn(|k| sign(k) * OBLIQUE[(k + number / 8) % 3]);
            let along = apply(&transpose(&self.own_from_model), &own);
            let far = |a: &Vector3, b: &Vector3| dot(a, &along).total_cmp(&dot(b, &along));
            sum = add(&sum, &vertices(mesh).max_by(far)?);
        }
        let outermost = scale(&sum, 1.0 / ROUND as f64);
        Some(subtract(&outermost, &self.middle))
    }
}

/// Directions all round, none of them across an edge or a face of a part that lies as its axes do: there points are equally far out.
const ROUND: usize = 24;
const OBLIQUE: Vector3 = [1.0, 2.2, 3.7];

/// Cells of a side of the half cube, and of all three sides.
const SIDE: usize = 8;
const CELLS: usize = 3 * SIDE * SIDE;

/// The cell of a normal, and the sign that turns it to its half.
fn cell_of(own: &Vector3) -> Option<(usize, f64)> {
    let axis = (0..3).max_by(|&a, &b| own[a].abs().total_cmp(&own[b].abs()))?;
    let place = |other: usize| {
        let along = own[(axis + other) % 3] / own[axis];
        (((along + 1.0) / 2.0 * SIDE as f64) as usize).min(SIDE - 1)
    };
    let cell = (axis * SIDE + place(1)) * SIDE + place(2);
    Some((cell, if own[axis] < 0.0 { -1.0 } else { 1.0 }))
}

/// A cell's sum where it faces a direction, or its opposite, turned towards it; nothing where it does not.
fn towards(sum: &Vector3, along: &Vector3) -> Vector3 {
    let facing = dot(sum, along);
    if facing.abs() < FACING * norm(sum) {
        return [0.0; 3];
    }
    scale(sum, if facing < 0.0 { -1.0 } else { 1.0 })
}

fn unit(vector: &Vector3) -> Option<Vector3> {
    let length = norm(vector);
    (length > 0.0).then(|| scale(vector, 1.0 / length))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::edges::fake::{add_box, add_prism, ellipse};
    use crate::pose::{EulerPose, Pose};
    use proptest::prelude::*;
    use std::vec::Vec;

    type Corners = Vec<[f32; 3]>;
    type Triangles = Vec<[u32; 3]>;

    /// A profile, closed from its last corner to its first, pulled out along z, without its two ends.
    fn pulled(profile: &[[f32; 2]], length: f32, steps: u32) -> (Corners, Triangles) {
        let count = profile.len() as u32;
        let (mut corners, mut triangles) = (Vec::new(), Vec::new());
        for step in 0..=steps {
            let z = length * step as f32 / steps as f32;
            corners.extend(profile.iter().map(|&[x, y]| [x, y, z]));
        }
        for step in 0..steps {
            for at in 0..count {
                let [a, b] = [at, (at + 1) % count].map(|k| step * count + k);
                triangles.push([a, b, a + count]);
                triangles.push([b, b + count, a + count]);
            }
        }
        (corners, triangles)
    }

    /// A ring's part of so many degrees, of radius 30, so thick and so wide.
    fn bow(degrees: f64, thick: f64, wide: f32) -> (Corners, Triangles) {
        const STEPS: usize = 40;
        let arc = |radius: f64| {
            (0..=STEPS).map(move |step| {
                let angle = (degrees * step as f64 / STEPS as f64).to_radians();
                let (sin, cos) = crate::math::sin_cos(angle);
                [radius * cos, radius * sin].map(|x| x as f32)
            })
        };
        let inner: Vec<[f32; 2]> = arc(30.0 - thick).collect();
        let profile: Vec<[f32; 2]> = arc(30.0).chain(inner.into_iter().rev()).collect();
        pulled(&profile, wide, 12)
    }

    /// A plate on a keel.
    fn tray(thick: f32, keel: [f32; 3]) -> (Corners, Triangles) {
        let (mut corners, mut triangles) = (Vec::new(), Vec::new());
        let [deep, wide, high] = keel;
        add_box(
            [-22.0, 0.0, -35.0],
            [22.0, thick, 35.0],
            &mut corners,
            &mut triangles,
        );
        let (low, high) = ([-deep, -high, -wide], [deep, 0.0, wide]);
        add_box(low, high, &mut corners, &mut triangles);
        (corners, triangles)
    }

    fn ball(half: bool) -> (Corners, Triangles) {
        const STEPS: usize = 24;
        let height = if half { 90.0 } else { 180.0 };
        let (mut corners, mut triangles) = (Vec::new(), Vec::new());
        for level in 0..=STEPS {
            let (sin, cos) =
                crate::math::sin_cos((height * level as f64 / STEPS as f64).to_radians());
            for step in 0..STEPS {
                let around = core::f64::consts::TAU * step as f64 / STEPS as f64;
                let (s, c) = crate::math::sin_cos(around);
                corners.push([30.0 * sin * c, 30.0 * sin * s, 30.0 * cos].map(|x| x as f32));
            }
        }
        let number = |level: usize, step: usize| (level * STEPS + step % STEPS) as u32;
        for (level, step) in (0..STEPS).flat_map(|level| (0..STEPS).map(move |step| (level, step)))
        {
            let [a, b] = [number(level, step), number(level, step + 1)];
            let [c, d] = [number(level + 1, step), number(level + 1, step + 1)];
            triangles.extend([[a, c, b], [b, c, d]]);
        }
        if half {
            corners.push([0.0; 3]);
            let middle = corners.len() as u32 - 1;
            triangles.extend(
                (0..STEPS).map(|step| [number(STEPS, step), middle, number(STEPS, step + 1)]),
            );
        }
        (corners, triangles)
    }

    fn told((corners, triangles): &(Corners, Triangles)) -> Option<KneeComponent> {
        component_by_shape(&Mesh::new(corners, triangles).expect("valid"))
    }

    properties! {
        /// Wherever it lies, however large it is, whichever way its triangles run.
        #[test]
        fn plates_are_trays_and_bows_are_femoral(
            angles in proptest::array::uniform3(-180.0..180.0f64),
            place in proptest::array::uniform3(-100.0..100.0f64),
            size in (-3.0..1.7f64).prop_map(libm::exp10),
            round in 150.0..270.0f64,
            thick in 3.0..6.5f64,
            wide in 35.0..62.0f32,
            plate in 2.5..5.0f32,
            keel in 15.0..45.0f32,
            flipped in any::<bool>(),
        ) {
            let [z_rot_deg, x_rot_deg, y_rot_deg] = angles;
            let pose = Pose::from(EulerPose { z_rot_deg, x_rot_deg, y_rot_deg, ..EulerPose::default() });
            let placed = |(corners, mut triangles): (Corners, Triangles)| {
                let put = |corner: &[f32; 3]| {
                    let turned = pose.transform(&corner.map(f64::from));
                    core::array::from_fn(|k| (size * (turned[k] + place[k])) as f32)
                };
                if flipped {
                    triangles.iter_mut().for_each(|triangle| triangle.swap(0, 1));
                }
                (corners.iter().map(put).collect(), triangles)
            };
            prop_assert_eq!(told(&placed(bow(round, thick, wide))), Some(KneeComponent::Femur));
            let tray = tray(plate, [6.0, 6.0, keel]);
            prop_assert_eq!(told(&placed(tray)), Some(KneeComponent::Tibia));
        }

        /// Of a box that is no plate, and of any box as a bow.
        #[test]
        fn boxes_are_nothing_but_plates(sides in proptest::array::uniform3(5.0..60.0f32)) {
            let (mut corners, mut triangles) = (Vec::new(), Vec::new());
            add_box([0.0; 3], sides, &mut corners, &mut triangles);
            let [a, b, c] = sides;
            let faces = [a * b, b * c, c * a];
            let part = faces.iter().fold(0.0f32, |most, &x| most.max(x)) / faces.iter().sum::<f32>();
            let told = told(&(corners, triangles));
            if (part - 5.0 / 12.0).abs() > 1e-4 {
                prop_assert_eq!(told, (part > 5.0 / 12.0).then_some(KneeComponent::Tibia));
            }
        }
    }

    properties! {
        /// The body of any triangles and of their images through a point, and one that lies elsewhere, with other axes.
        #[test]
        fn the_way_outwards_is_none_of_what_is_its_own_image_and_turns_with_the_axes(
            // Of so few digits that they are kept elsewhere.
            half in proptest::collection::vec(proptest::array::uniform3((-2560..2560i16).prop_map(|x| f32::from(x) / 64.0)), 9),
            turn in 0..3usize, signs in proptest::array::uniform3(prop_oneof![Just(-1.0f32), Just(1.0f32)]),
        ) {
            let triangles: Vec<[u32; 3]> = (0..6).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
            let outwards = |corners: &[[f32; 3]]| {
                let mesh = Mesh::new(corners, &triangles[..corners.len() / 3]).expect("valid");
                Surface::of(&mesh).and_then(|surface| surface.outwards(&mesh)).expect("a surface")
            };
            let whole: Corners = half.iter().copied().chain(half.iter().map(|corner| corner.map(|x| -x))).collect();
            prop_assert!(norm(&outwards(&whole)) < 1e-9);
            let placed = |corner: &[f32; 3]| core::array::from_fn(|k| signs[k] * corner[(k + turn) % 3] + 20.0 * k as f32);
            let own = outwards(&half);
            let found = outwards(&half.iter().map(placed).collect::<Corners>());
            let expected: Vector3 = core::array::from_fn(|k| f64::from(signs[k]) * own[(k + turn) % 3]);
            prop_assert!(norm(&subtract(&found, &expected)) < 1e-6, "{:?} {:?}", found, expected);
        }

        /// A cell is a quarter of a side wide at most: its corners are within 21 degrees of each other.
        #[test]
        fn normals_of_one_cell_are_alike(
            normals in proptest::collection::vec(proptest::array::uniform3(prop_oneof![Just(-1.0), Just(0.0), Just(1.0), -1.0..1.0f64]), 60),
        ) {
            let told: Vec<_> = normals
                .iter()
                .filter_map(|normal| {
                    let (cell, sign) = cell_of(normal)?;
                    Some((cell, scale(&unit(normal)?, sign)))
                })
                .collect();
            for (k, (cell, normal)) in told.iter().enumerate() {
                prop_assert!(*cell < CELLS);
                prop_assert_eq!(cell_of(&scale(normal, -3.0)), Some((*cell, -1.0)));
                let beside = told[..k].iter().filter(|(other, _)| other == cell);
                for (_, other) in beside {
                    prop_assert!(dot(normal, other) > 0.933, "{:?} {:?}", normal, other);
                }
            }
        }

        #[test]
        fn what_faces_a_direction_is_turned_towards_it(
            sum in proptest::array::uniform3(-9.0..9.0f64), along in proptest::array::uniform3(-1.0..1.0f64), part in 0.0..1.0f64,
        ) {
            let Some(along) = unit(&along) else { return Ok(()) };
            // Much of it along the direction, or any.
            let sum = add(&sum, &scale(&along, 90.0 * part * part));
            let angle = crate::math::atan2(norm(&crate::math::cross(&sum, &along)), dot(&sum, &along).abs());
            let found = towards(&sum, &along);
            let expected = if dot(&sum, &along) < 0.0 { scale(&sum, -1.0) } else { sum };
            prop_assert_eq!(found, if angle.to_degrees() < 15.0 { expected } else { [0.0; 3] });
            prop_assert_eq!(towards(&scale(&sum, -1.0), &along), found);
        }

        /// A box shows most of itself along its shortest side.
        #[test]
        fn rows_of_the_frame_are_what_is_faced_most_to_least(sides in proptest::array::uniform3(5.0..60.0f32)) {
            let (mut corners, mut triangles) = (Vec::new(), Vec::new());
            add_box([0.0; 3], sides, &mut corners, &mut triangles);
            let surface = Surface::of(&Mesh::new(&corners, &triangles).expect("valid")).expect("a surface");
            let mut order = [0, 1, 2];
            order.sort_by(|&a, &b| sides[a].total_cmp(&sides[b]));
            prop_assume!(order.windows(2).all(|two| sides[two[1]] - sides[two[0]] > 0.1));
            for (row, axis) in surface.own_from_model.iter().zip(order) {
                prop_assert!((row[axis].abs() - 1.0).abs() < 1e-6);
            }
            let [a, b, c] = sides.map(f64::from);
            prop_assert!((surface.area / 4.0 - (a * b + b * c + c * a)).abs() < 1e-6 * surface.area);
            prop_assert!((0..3).all(|k| (surface.middle[k] - f64::from(sides[k]) / 2.0).abs() < 1e-6));
        }
    }

    /// Its middle lies far from that of its outermost points too.
    #[test]
    fn a_tray_on_a_stem_with_more_surface_than_its_plate_is_no_bow() {
        for length in [60.0, 100.0, 150.0, 200.0] {
            let (mut corners, mut triangles) = tray(4.0, [1.5, 20.0, 25.0]);
            let stem = ellipse([0.0; 2], [9.0; 2]);
            add_prism(&stem, [-length, 0.0], &mut corners, &mut triangles);
            let told = told(&(corners, triangles));
            assert_ne!(told, Some(KneeComponent::Femur), "{length} mm");
        }
        for length in [40.0, 100.0, 160.0] {
            let (mut corners, mut triangles) = bow(200.0, 6.0, 60.0);
            let stem = ellipse([0.0, 30.0], [7.0; 2]);
            add_prism(&stem, [-length, 24.0], &mut corners, &mut triangles);
            let told = told(&(corners, triangles));
            assert_eq!(told, Some(KneeComponent::Femur), "{length} mm");
        }
    }

    #[test]
    fn round_bodies_and_nothing_are_neither() {
        assert_eq!(told(&ball(false)), None);
        assert_eq!(told(&ball(true)), None);
        let line = std::vec![[0.0; 3], [1.0; 3], [2.0; 3]];
        assert_eq!(told(&(line, std::vec![[0, 1, 2]])), None);
    }

    /// The cells and the window lose nothing that looking from everywhere finds.
    #[test]
    fn no_direction_sees_more() {
        for (corners, triangles) in [
            bow(200.0, 6.0, 60.0),
            tray(4.0, [6.0, 6.0, 35.0]),
            ball(true),
        ] {
            let mesh = Mesh::new(&corners, &triangles).expect("valid");
            let surface = Surface::of(&mesh).expect("a surface");
            let found = surface.plate_fraction(&mesh);
            let seen = (0..4000).map(|number| {
                let z = (f64::from(number) + 0.5) / 4000.0;
                let (sin, cos) = crate::math::sin_cos(f64::from(number) * 2.399_963_229_728_653);
                let r = crate::math::sqrt(1.0 - z * z);
                let along = [r * cos, r * sin, z];
                let facing = faces(&mesh)
                    .filter(|(_, area, normal)| dot(normal, &along).abs() >= FACING * area);
                facing.map(|(_, area, _)| area).sum::<f64>() / surface.area
            });
            let most = seen.fold(0.0, f64::max);
            assert!((most - found).abs() < 0.04, "{most} {found}");
        }
    }
}
