//! Which way a femoral component opens, from its bone cuts.
//!
//! Seen from the side the inside of a component for both condyles is five flats: the distal cut, the anterior and the posterior cut that stand
//! at its ends and face each other, and a chamfer in each corner, half way round. How its surface is spread does not tell the distal cut
//! from a chamfer: of a component without a box it leans towards the condyles behind by 36 to 47 degrees, and a chamfer may be as large.
//! What does is what stands beside it. Of a floor and its two walls a chamfer has the floor alone, an arm that is taken for
//! the floor has one wall, and nothing has the box's roof. So a direction is worth its floor times the lesser of its two walls: areas over areas, and
//! lengths over lengths, whatever the file's axes, units and winding are.

use super::faced::{between, faces, reach, vertices};
use super::perpendicular;
use crate::math::{Vector3, add, atan2, cross, degrees, dot, norm, scale, subtract};
use crate::mesh::surface::Mesh;

/// Directions round the side view that are tried, 2 degrees apart.
const AROUND: usize = 180;
/// Faces of a cut lie within 3 degrees of one direction in the side view: the cosine.
const FLAT: f64 = 0.9986;
/// They are along the way across within 8 degrees, of which the cosine: a stem that leans aside turns a plane of symmetry by 5.
const EDGEWAYS: f64 = 0.990_268_068_741_570_3;
/// A floor lies in the lowest part of a bow, of its depth.
const FLOOR: f64 = 0.35;
/// Walls stand on the floor, between these parts of the depth: were backwards up, the tips of the condyles would be high over the flange.
const STANDING: core::ops::Range<f64> = 0.15..0.75;
/// Walls stand within this part of the depth from either end.
const END: f64 = 0.25;
/// They lean by up to 12 degrees; windows of 6 degrees as wide as what is flat end at 15, of which the cosine.
const LEAN_DEG: f64 = 15.0;
const LEAN: f64 = 0.965_925_826_289_068_3;
const LEANS: usize = 30;
const WINDOW: usize = 6;
/// A floor and a wall are at least these parts of the surface. What is round has 1.7 of a hundred within as many degrees, but not all at an end.
const FLOOR_PART: f64 = 0.015;
const WALL_PART: f64 = 0.01;
/// The best direction is worth this many times what any other is that lies farther than 16 degrees from it.
const CLEAR: f64 = 2.0;
const OTHER_STEPS: usize = 8;

/// The normal of the floor between two walls, perpendicular to `across` and within a quarter turn of `out`, the way out of the bow as far as the
/// spread of its surface tells it: a box upside down is a floor between walls too. `None` where no direction has both, or two have nearly as
/// much of them.
pub(super) fn above_the_distal_cut(
    mesh: &Mesh<'_>,
    across: &Vector3,
    out: &Vector3,
) -> Option<Vector3> {
    let first = perpendicular(across);
    let second = cross(across, &first);
    let all = faces(mesh).map(|(_, area, _)| area).sum::<f64>();
    let direction = |step: usize| {
        let turn = core::f64::consts::TAU * step as f64 / AROUND as f64;
        between(&first, &second, turn)
    };
    let worths: [f64; AROUND] = core::array::from_fn(|step| {
        let up = direction(step);
        if dot(&up, out) > 0.0 {
            Seat::towards(mesh, &up, across).worth(all)
        } else {
            0.0
        }
    });
    let best = (0..AROUND).max_by(|&a, &b| worths[a].total_cmp(&worths[b]))?;
    let others = OTHER_STEPS + 1..AROUND - OTHER_STEPS;
    let other = others.fold(0.0f64, |most, off| most.max(worths[(best + off) % AROUND]));
    if worths[best] <= CLEAR * other {
        return None;
    }
    let normal = Seat::towards(mesh, &direction(best), across).normal;
    let square = subtract(&normal, &scale(across, dot(&normal, across)));
    Some(scale(&square, 1.0 / norm(&square)))
}

/// What lies and what stands in a bow, were a direction up. Areas are doubled.
struct Seat {
    floor: f64,
    /// The sum of the floor's normals, turned upwards.
    normal: Vector3,
    /// What stands at either end, by how it leans, a degree each.
    walls: [[f64; LEANS]; 2],
}

impl Seat {
    fn towards(mesh: &Mesh<'_>, up: &Vector3, across: &Vector3) -> Self {
        let forward = cross(up, across);
        let low = reach(vertices(mesh), up).0;
        let (back, front) = reach(vertices(mesh), &forward);
        let depth = front - back;
        let mut seat = Self {
            floor: 0.0,
            normal: [0.0; 3],
            walls: [[0.0; LEANS]; 2],
        };
        for (middle, area, normal) in faces(mesh).filter(|(_, area, _)| *area > 0.0) {
            let height = (dot(&middle, up) - low) / depth;
            let along = (dot(&middle, &forward) - back) / depth;
            let (lies, stands) = (dot(&normal, up), dot(&normal, &forward));
            let seen = norm(&[lies, stands, 0.0]);
            if seen < EDGEWAYS * area {
                continue;
            }
            if lies.abs() > FLAT * seen && height < FLOOR {
                seat.floor += area;
                seat.normal = add(&seat.normal, &scale(&normal, lies.signum()));
            } else if stands.abs() > LEAN * seen && STANDING.contains(&height) {
                let ends = [along < END, along > 1.0 - END];
                let end = ends.iter().position(|is_at| *is_at);
                if let Some(wall) = end.map(|end| &mut seat.walls[end]) {
                    let lean = degrees(atan2(lies * stands.signum(), stands.abs()));
                    wall[((lean + LEAN_DEG) as usize).min(LEANS - 1)] += area;
                }
            }
        }
        seat
    }

    /// The floor times the lesser wall, in parts of the surface; nothing where one of them is missing.
    fn worth(&self, all: f64) -> f64 {
        let flattest = |wall: &[f64; LEANS]| {
            let windows = wall.windows(WINDOW).map(|window| window.iter().sum());
            windows.fold(0.0f64, f64::max)
        };
        let [one, other] = self.walls.each_ref().map(flattest);
        let (floor, wall) = (self.floor / all, one.min(other) / all);
        if floor > FLOOR_PART && wall > WALL_PART {
            floor * wall
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::apply;
    use crate::mesh::edges::fake::{add_box, placed_within};
    use proptest::prelude::*;
    use std::vec::Vec;

    /// Boxes that run 60 mm across, z, between two corners of the side view, at a pose.
    fn told(
        sides: &[([f32; 2], [f32; 2])],
        pose: &crate::pose::Pose,
        out: Vector3,
    ) -> Option<Vector3> {
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        for &([x, y], [front, top]) in sides {
            let (low, high) = ([x, y, -30.0], [front, top, 30.0]);
            add_box(low, high, &mut vertices, &mut triangles);
        }
        for vertex in &mut vertices {
            *vertex = pose.transform(&vertex.map(f64::from)).map(|x| x as f32);
        }
        let mesh = Mesh::new(&vertices, &triangles).expect("valid");
        let [across, out] = [[0.0, 0.0, 1.0], out].map(|axis| apply(&pose.rotation, &axis));
        above_the_distal_cut(&mesh, &across, &out)
    }

    properties! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        /// Not where it has one, nor where another side lies between two as well.
        #[test]
        fn a_floor_is_told_between_two_walls_alone(pose in placed_within(80.0), lean in -0.9..0.9f64) {
            const FLOOR: ([f32; 2], [f32; 2]) = ([-25.0, 0.0], [25.0, 4.0]);
            const BEHIND: ([f32; 2], [f32; 2]) = ([-25.0, 4.0], [-21.0, 36.0]);
            const AHEAD: ([f32; 2], [f32; 2]) = ([21.0, 4.0], [25.0, 46.0]);
            let up = apply(&pose.rotation, &[0.0, 1.0, 0.0]);
            // Wherever within a quarter turn of it the surface is spread.
            let out = [lean, 1.0, 0.0];
            let found = told(&[FLOOR, BEHIND, AHEAD], &pose, out);
            prop_assert!(found.is_some_and(|found| norm(&subtract(&found, &up)) < 1e-4), "{:?}", found);
            prop_assert_eq!(told(&[FLOOR, BEHIND], &pose, out), None);
            // A tube, of which two sides lie on the way out.
            let tube = [([-25.0, 0.0], [25.0, 4.0]), ([-25.0, 46.0], [25.0, 50.0]), ([-25.0, 4.0], [-21.0, 46.0]), ([21.0, 4.0], [25.0, 46.0])];
            prop_assert_eq!(told(&tube, &pose, [1.0, 1.0, 0.0]), None);
        }
    }
}
