//! The silhouette of a closed surface from its silhouette edges.
//!
//! The triangles that face the camera bound each other but where one that faces it meets one that
//! does not: the sides there, run as the facing triangle runs them, are the boundary of the
//! facing part, and its winding number about a pixel's centre is the number of facing triangles
//! that cover it. The surface is closed, so the same number that face away cover it too: the pixels of
//! winding number above zero are those that any triangle covers. Facing is decided by the sign of
//! the area between the rounded vertices, and crossings are those of the scan conversion, so this
//! holds exactly.

use crate::image::mask::MaskMut;
use crate::image::scan::{Edge, FixedPoint};
use crate::mesh::edges::Edges;
use crate::render::facing::FacingTest;
use crate::render::project::Images;

/// Room for rows of the frame, silhouette edges and their crossings with rows.
const PLACES: usize = 16_384;

/// In place of the number of silhouette edges where the surface was not drawn from them.
const NONE: u64 = u64::MAX;

/// Working memory of [`fill`].
pub(crate) const fn room_needed() -> usize {
    PLACES
}

/// Adds the silhouette of a closed surface to `out`. Gives `false`, and has drawn nothing, where
/// the room does not hold all crossings. Afterwards [`contour`] reads the edges from `room`.
pub(crate) fn fill(
    facing: &FacingTest<'_>,
    edges: &Edges<'_>,
    images: &mut Images<'_>,
    room: &mut [FixedPoint],
    out: &mut MaskMut<'_>,
) -> bool {
    let Some((count_slot, room)) = room.split_first_mut() else {
        return false;
    };
    *count_slot = NONE.into();
    let Some((rows, room)) = room.split_at_mut_checked(out.height()) else {
        return false;
    };
    let Some(count) = find_contour(facing, edges, images, room) else {
        return false;
    };
    let (crossings, contour) = room.split_at_mut(room.len() - count);
    rows.fill(END.into());
    let mut lists = Lists {
        rows,
        crossings,
        count: 0,
    };
    for &kept in &*contour {
        let ends = vertices_of(kept).map(|vertex| images.of(vertex));
        if !lists.add(ends, out.width()) {
            return false;
        }
    }
    lists.fill(out);
    *count_slot = (count as u64).into();
    true
}

/// The edges between triangles that face the camera and those that do not, from working memory as
/// [`fill`] left it; nothing where it did not draw. Each is a pair of vertices, in the direction of
/// the triangle that faces the camera: at each vertex the same number begin and end.
pub(crate) fn contour(room: &[FixedPoint]) -> Option<impl Iterator<Item = [u32; 2]>> {
    let count = usize::try_from(u64::from(*room.first()?)).ok()?;
    let first = room.len().checked_sub(count)?;
    Some(room.get(first..)?.iter().map(|&kept| vertices_of(kept)))
}

/// Keeps the silhouette edges at the end of `room`: their number, or nothing where there is no
/// room for all.
fn find_contour(
    facing: &FacingTest<'_>,
    edges: &Edges<'_>,
    images: &mut Images<'_>,
    room: &mut [FixedPoint],
) -> Option<usize> {
    let mut free = room.iter_mut().rev();
    let (mut count, mut fits) = (0, true);
    for (bounds, group) in edges.groups() {
        facing.contour(bounds, group, images, |[from, to]| {
            match free.next() {
                Some(place) => *place = (u64::from(from) << 32 | u64::from(to)).into(),
                None => fits = false,
            }
            count += 1;
        });
    }
    fits.then_some(count)
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
    use crate::mesh::Model;
    use crate::mesh::edges::fake::{self, Linked};
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
            prop_assert_eq!(draw(&model, &pose), draw(&Model::with_edges(*model.mesh(), linked.edges()), &pose));
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
