//! The silhouette of any surface from its silhouette edges.
//!
//! The boundaries of all triangles that face the camera, run as the triangles run them, add up to a
//! chain in which sides between two of them cancel: what is left are edges beside which one triangle
//! faces the camera and the other does not, and rims of triangles that do. The winding number of that
//! chain about a pixel's centre is the number of facing triangles that cover it. The same holds for
//! the triangles that face away, run backwards: the same silhouette edges, and the other rims. A pixel
//! is covered where one of the two numbers is above zero; of a closed surface, which has no rims, the
//! two chains are one. Facing is decided by the sign of the area between the rounded vertices, and
//! crossings are those of the scan conversion, so this holds exactly, for any triangles.

use crate::image::mask::MaskMut;
use crate::image::scan::{Edge, FixedPoint};
use crate::mesh::edges::{Edges, RimEdge};
use crate::render::facing::FacingTest;
use crate::render::project::Images;

/// Room for rows of the frame, silhouette edges and their crossings with rows.
const PLACES: usize = 16_384;

/// In place of the number of silhouette edges where the surface was not drawn from them.
const NONE: u64 = u64::MAX;

/// Working memory of [`fill`].
pub(crate) fn room_needed(edges: &Edges<'_>) -> usize {
    PLACES + 4 * edges.rims().len()
}

/// Adds the silhouette of a surface to `out`. Gives `false`, and has drawn a part of it at most, where
/// the room does not hold all crossings. Afterwards [`contour`] reads the edges from `room`.
pub(crate) fn fill(
    facing: &FacingTest<'_>,
    edges: &Edges<'_>,
    images: &mut Images<'_>,
    room: &mut [FixedPoint],
    out: &mut MaskMut<'_>,
) -> bool {
    let Some((count, room)) = room.split_first_mut() else {
        return false;
    };
    *count = NONE.into();
    let Some((rows, room)) = room.split_at_mut_checked(out.height()) else {
        return false;
    };
    let Some(chains) = find_contour(facing, edges, images, room) else {
        return false;
    };
    let (crossings, kept) = room.split_at_mut(room.len() - chains.all());
    let (away, towards) = kept.split_at(chains.away);
    let (rims, both) = towards.split_at(chains.towards);
    let mut lists = Lists {
        rows,
        crossings,
        count: 0,
    };
    // Of a closed surface the two chains are one.
    let second = (!edges.rims().is_empty()).then_some(away);
    for chain in [Some(rims), second].into_iter().flatten() {
        lists.clear();
        if !lists.add_all([both, chain], images, out.width()) {
            return false;
        }
        lists.fill(out);
    }
    *count = (chains.all() as u64).into();
    true
}

/// The edges that [`fill`] drew a surface from, as their vertices, read from its working memory; nothing
/// where it was not drawn.
pub(crate) fn contour(room: &[FixedPoint]) -> Option<impl Iterator<Item = [u32; 2]>> {
    let count = usize::try_from(u64::from(*room.first()?)).ok()?;
    let first = room.len().checked_sub(count)?;
    Some(room.get(first..)?.iter().map(|&kept| vertices_of(kept)))
}

/// How many edges a contour has.
struct Chains {
    /// Between a triangle that faces the camera and one that does not.
    both: usize,
    /// Rims of triangles that face the camera, and of those that do not.
    towards: usize,
    away: usize,
}

impl Chains {
    fn all(&self) -> usize {
        self.both + self.towards + self.away
    }
}

/// Writes the edges of the contour to the end of the room: from the back those of both chains, rims of triangles that face
/// the camera, other rims. `None` where it does not hold them.
fn find_contour(
    facing: &FacingTest<'_>,
    edges: &Edges<'_>,
    images: &mut Images<'_>,
    room: &mut [FixedPoint],
) -> Option<Chains> {
    let mut free = room.iter_mut().rev();
    let mut fits = true;
    let mut keep = |[from, to]: [u32; 2], count: &mut usize| {
        match free.next() {
            Some(place) => *place = (u64::from(from) << 32 | u64::from(to)).into(),
            None => fits = false,
        }
        *count += 1;
    };
    let (mut both, mut towards, mut away) = (0, 0, 0);
    for (bounds, group) in edges.groups() {
        facing.contour(bounds, group, images, |ends| keep(ends, &mut both));
    }
    let faces = |rim: &RimEdge, images: &mut Images<'_>| {
        let corners = [rim.from, rim.to, rim.third].map(|vertex| images.of(vertex));
        FixedPoint::doubled_area(corners) > 0
    };
    for rim in edges.rims() {
        if faces(rim, images) {
            keep([rim.from, rim.to], &mut towards);
        }
    }
    for rim in edges.rims() {
        if !faces(rim, images) {
            keep([rim.to, rim.from], &mut away);
        }
    }
    fits.then_some(Chains {
        both,
        towards,
        away,
    })
}

/// The ends of a silhouette edge from its place in working memory.
fn vertices_of(kept: FixedPoint) -> [u32; 2] {
    let bits = u64::from(kept);
    [(bits >> 32) as u32, bits as u32]
}

/// In place of the crossing that follows the last of a row.
const END: u64 = u32::MAX as u64;

/// Where silhouette edges cross rows, each row's from left to right; where several meet, those that
/// enter come first.
struct Lists<'r> {
    /// The first crossing of each row.
    rows: &'r mut [FixedPoint],
    /// In the upper half of each its column and whether it leaves, in the lower the next of its row.
    crossings: &'r mut [FixedPoint],
    count: usize,
}

impl Lists<'_> {
    fn clear(&mut self) {
        self.rows.fill(END.into());
        self.count = 0;
    }

    /// The crossings of two parts of a chain; `false` where there is no room for all.
    fn add_all(
        &mut self,
        parts: [&[FixedPoint]; 2],
        images: &mut Images<'_>,
        width: usize,
    ) -> bool {
        parts.into_iter().flatten().all(|&kept| {
            let ends = vertices_of(kept).map(|vertex| images.of(vertex));
            self.add(ends, width)
        })
    }

    /// Adds the crossings of a silhouette edge; `false` where there is no room for all.
    fn add(&mut self, [from, to]: [FixedPoint; 2], width: usize) -> bool {
        // Facing triangles are run clockwise: what is run upwards has them to its right.
        let leaves = !to.is_above(from);
        let edge = Edge::new(from, to);
        for row in edge.rows(self.rows.len()) {
            let column = edge.column_at(row).clamp(0, width as i64) as u64;
            if !self.insert(row, column << 1 | u64::from(leaves)) {
                return false;
            }
        }
        true
    }

    fn insert(&mut self, row: usize, place: u64) -> bool {
        let new = self.count;
        if new >= self.crossings.len() {
            return false;
        }
        let mut before = None;
        let mut next = u64::from(self.rows[row]);
        while let Some(&crossing) = self.crossings.get(next as usize) {
            let crossing = u64::from(crossing);
            if crossing >> 32 >= place {
                break;
            }
            (before, next) = (Some(next as usize), crossing & END);
        }
        self.crossings[new] = (place << 32 | next).into();
        self.count += 1;
        match before {
            None => self.rows[row] = (new as u64).into(),
            Some(at) => {
                let crossing = u64::from(self.crossings[at]);
                self.crossings[at] = (crossing & !END | new as u64).into();
            }
        }
        true
    }

    /// Fills the spans in which the winding number is not zero.
    fn fill(&self, out: &mut MaskMut<'_>) {
        for (row, &first) in self.rows.iter().enumerate() {
            let (mut winding, mut start) = (0, 0);
            let mut next = u64::from(first);
            while let Some(&crossing) = self.crossings.get(next as usize) {
                let crossing = u64::from(crossing);
                next = crossing & END;
                let column = (crossing >> 33) as i64;
                if winding == 0 {
                    start = column;
                }
                winding += if crossing >> 32 & 1 == 0 { 1 } else { -1 };
                if winding == 0 {
                    out.fill_span(row, start, column);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Camera;
    use crate::image::mask::{Word, words_needed};
    use crate::mesh::edges::fake::{self, Linked};
    use crate::mesh::{Mesh, Model};
    use crate::pose::{EulerPose, Pose};
    use crate::render::{Projected, render, scratch_needed};
    use proptest::prelude::*;
    use std::vec;
    use std::vec::Vec;

    const SIDE: usize = 96;
    fn camera() -> Camera {
        Camera::new(SIDE, SIDE, [600.0, 580.0], [47.0, 49.5]).expect("valid")
    }

    const FAR: Pose = Pose {
        translation: [0.0, 0.0, -500.0],
        ..Pose::IDENTITY
    };

    fn draw(model: &Model<'_>, pose: &Pose) -> Vec<Word> {
        let camera = camera();
        let mut words = vec![0; words_needed(SIDE, SIDE)];
        let mut out = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
        let mut scratch = vec![Projected::default(); scratch_needed(model)];
        render(model, &camera, pose, &mut scratch, &mut out).expect("in front");
        words
    }

    proptest! {
        #[test]
        fn edges_draw_what_triangles_draw(
            dents in proptest::collection::vec(-1.0..1.0f32, 1..40),
            angles in proptest::array::uniform3(-180.0..180.0f64),
            place in proptest::array::uniform3(-40.0..40.0f64),
        ) {
            let (vertices, triangles) = fake::torus(&dents);
            let model = Model::from_triangles(&vertices, &triangles).expect("valid");
            let linked = Linked::new(model.mesh());
            let [z_rot_deg, x_rot_deg, y_rot_deg] = angles;
            let [x_mm, y_mm, nearer] = place;
            let pose = Pose::from(EulerPose {
                x_mm, y_mm, z_mm: nearer - 500.0, z_rot_deg, x_rot_deg, y_rot_deg
            });
            prop_assert_eq!(draw(&model, &pose), draw(&linked.model(*model.mesh()), &pose));
        }
    }

    proptest! {
        #[test]
        fn edges_draw_any_triangles(
            dents in proptest::collection::vec(-1.0..1.0f32, 1..40),
            angles in proptest::array::uniform3(-180.0..180.0f64),
            faults in proptest::collection::vec(0u8..24, 1..90),
        ) {
            // Holes, triangles that run against their neighbours, doubled ones, torn off ones.
            let (mut vertices, whole) = fake::torus(&dents);
            let mut triangles = Vec::new();
            for (&[a, b, c], fault) in whole.iter().zip(faults.iter().cycle()) {
                match fault {
                    0 => {}
                    1 | 2 => triangles.push([a, c, b]),
                    3 => triangles.extend([[a, b, c], [b, c, a]]),
                    4 => triangles.extend([[a, b, c], [a, c, b]]),
                    5 => {
                        let torn = [a, b, c].map(|vertex| {
                            vertices.push(vertices[vertex as usize]);
                            vertices.len() as u32 - 1
                        });
                        triangles.push(torn);
                    }
                    6 => triangles.extend([[a, b, c], [a, a, b]]),
                    _ => triangles.push([a, b, c]),
                }
            }
            let Ok(mesh) = Mesh::new(&vertices, &triangles) else { return Ok(()) };
            let linked = Linked::new(&mesh);
            let [z_rot_deg, x_rot_deg, y_rot_deg] = angles;
            let pose = Pose::from(EulerPose {
                z_mm: -480.0, z_rot_deg, x_rot_deg, y_rot_deg, ..EulerPose::default()
            });
            let edges = linked.edges();
            let camera = camera();
            let mut slots = vec![FixedPoint::default(); vertices.len()];
            let mut images = Images::new(&mesh, &camera, &pose, &mut slots);
            let facing = FacingTest::new(&mesh, &camera, &pose);
            let mut room = vec![FixedPoint::default(); room_needed(&edges)];
            let mut words = vec![0; words_needed(SIDE, SIDE)];
            let mut out = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
            prop_assert!(fill(&facing, &edges, &mut images, &mut room, &mut out));
            prop_assert_eq!(words, draw(&Model::new(mesh), &pose));
        }
    }

    #[test]
    fn without_room_for_the_crossings_triangles_are_drawn() {
        let (vertices, triangles) = fake::torus(&[0.0]);
        let model = Model::from_triangles(&vertices, &triangles).expect("valid");
        let linked = Linked::new(model.mesh());
        let edges = linked.edges();
        let camera = camera();
        let facing = FacingTest::new(model.mesh(), &camera, &FAR);
        let mut words = vec![0; words_needed(SIDE, SIDE)];
        let mut out = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
        let mut slots = vec![FixedPoint::default(); vertices.len()];
        let mut images = Images::new(model.mesh(), &camera, &FAR, &mut slots);
        let mut fits = |room: usize| {
            let mut room = vec![FixedPoint::default(); room];
            fill(&facing, &edges, &mut images, &mut room, &mut out)
        };
        for room in [0, 1, SIDE, SIDE + 1, SIDE + 40, 200] {
            assert!(!fits(room), "{room}");
        }
        assert!(fits(4000));
    }
}
