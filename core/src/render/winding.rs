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

use core::ops::Range;

use crate::image::mask::MaskMut;
use crate::image::scan::{Edge, FixedPoint, rows_between};
use crate::mesh::edges::{Edges, RimEdge};
use crate::render::facing::FacingTest;
use crate::render::project::Images;

/// Room for rows of the frame, silhouette edges and their crossings with rows.
const PLACES: usize = 16_384;

/// In place of the number of silhouette edges where the surface was not drawn from them.
const NONE: u64 = u64::MAX;

/// Working memory of [`fill`].
pub(crate) fn room_needed(edges: &Edges<'_>) -> usize {
    PLACES + 4 * edges.rims().count()
}

/// The same for frames of so many rows, and contours of so many edges that cross rows so many times.
pub(crate) const fn room_for(rows: usize, edges: usize, crossings: usize) -> usize {
    1 + rows + edges + crossings
}

/// Adds the silhouette of a surface to `out`. Gives `false`, and has drawn a part of it at most, where
/// the room does not hold all crossings. Afterwards [`contour`] reads the edges from `room`.
pub(crate) fn fill(
    facing: &FacingTest,
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
    let (towards, both) = towards.split_at(chains.towards);
    let parts = [
        (Chain::Both, both),
        (Chain::Towards, towards),
        (Chain::Away, away),
    ];
    let Some(mut crossings) = Crossings::of(parts, images, out.width(), rows, crossings) else {
        return false;
    };
    crossings.fill(out);
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
    facing: &FacingTest,
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
    if let Some((packed, faces)) = edges.packed() {
        for (bounds, group) in packed.groups() {
            facing.packed_contour(&bounds, (group, faces), images, |ends| {
                keep(ends, &mut both)
            });
        }
    }
    let faces = |rim: &RimEdge, images: &mut Images<'_>| {
        let corners = [rim.from, rim.to, rim.third].map(|vertex| images.of(vertex));
        FixedPoint::doubled_area(corners) > 0
    };
    for rim in edges.rims() {
        if faces(&rim, images) {
            keep([rim.from, rim.to], &mut towards);
        }
    }
    for rim in edges.rims() {
        if !faces(&rim, images) {
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

/// Which of the two chains edges belong to, as bits.
#[derive(Clone, Copy)]
enum Chain {
    Towards = 1,
    Away = 2,
    Both = 3,
}

/// Edges of the contour, by their chain.
type Parts<'p> = [(Chain, &'p [FixedPoint]); 3];

/// Calls `visit` for each edge that crosses rows, with these.
fn for_each_edge(
    parts: Parts<'_>,
    images: &mut Images<'_>,
    height: usize,
    mut visit: impl FnMut(Chain, [FixedPoint; 2], Range<usize>),
) {
    for (chain, edges) in parts {
        for &kept in edges {
            let ends = vertices_of(kept).map(|vertex| images.of(vertex));
            let rows = rows_between(ends, height);
            // Most edges of a CAD model are shorter than a pixel.
            if !rows.is_empty() {
                visit(chain, ends, rows);
            }
        }
    }
}

/// Bits of a crossing below its column: that it leaves, and its chains.
const LEAVES: u64 = 4;
const COLUMN_BIT: u32 = 3;

/// Where silhouette edges cross rows.
struct Crossings<'r> {
    /// Behind the last crossing of each row.
    ends: &'r [FixedPoint],
    /// Row by row.
    places: &'r mut [FixedPoint],
}

impl<'r> Crossings<'r> {
    /// The crossings of all edges; `None` where there is no room for them. They are counted first, so that each is written
    /// once, to where its row has its place.
    fn of(
        parts: Parts<'_>,
        images: &mut Images<'_>,
        width: usize,
        ends: &'r mut [FixedPoint],
        places: &'r mut [FixedPoint],
    ) -> Option<Self> {
        let height = ends.len();
        ends.fill(FixedPoint::ZERO);
        for_each_edge(parts, images, height, |_, _, rows| {
            add_to(ends, rows.start, 1);
            add_to(ends, rows.end, u64::MAX);
        });
        let (mut in_row, mut before) = (0u64, 0u64);
        for end in &mut *ends {
            in_row = in_row.wrapping_add(u64::from(*end));
            *end = before.into();
            before += in_row;
        }
        if before > places.len() as u64 {
            return None;
        }
        for_each_edge(parts, images, height, |chain, ends_of, rows| {
            // Facing triangles are run clockwise: what is run upwards has them to its right.
            let [from, to] = ends_of;
            let leaves = if to.is_above(from) { 0 } else { LEAVES };
            let edge = Edge::new(ends_of);
            for row in rows {
                let column = edge.column_at(row).clamp(0, width as i64) as u64;
                let place = u64::from(ends[row]) as usize;
                places[place] = (column << COLUMN_BIT | leaves | chain as u64).into();
                add_to(ends, row, 1);
            }
        });
        Some(Self { ends, places })
    }

    /// Fills the spans in which the winding number of either chain is not zero.
    fn fill(&mut self, out: &mut MaskMut<'_>) {
        let mut start = 0;
        for (row, &end) in self.ends.iter().enumerate() {
            let end = u64::from(end) as usize;
            let crossings = self.places.get_mut(start..end).unwrap_or_default();
            sort(crossings);
            fill_row(row, crossings, out);
            start = end;
        }
    }
}

/// Adds to the number of a row, where there is such a row.
fn add_to(rows: &mut [FixedPoint], row: usize, more: u64) {
    if let Some(number) = rows.get_mut(row) {
        *number = u64::from(*number).wrapping_add(more).into();
    }
}

/// By insertion: few edges cross one row.
fn sort(crossings: &mut [FixedPoint]) {
    for at in 1..crossings.len() {
        let own = crossings[at];
        let mut free = at;
        while free > 0 && u64::from(crossings[free - 1]) > u64::from(own) {
            crossings[free] = crossings[free - 1];
            free -= 1;
        }
        crossings[free] = own;
    }
}

fn fill_row(row: usize, crossings: &[FixedPoint], out: &mut MaskMut<'_>) {
    let (mut towards, mut away, mut start) = (0i32, 0i32, 0);
    for &crossing in crossings {
        let crossing = u64::from(crossing);
        let column = (crossing >> COLUMN_BIT) as i64;
        if towards | away == 0 {
            start = column;
        }
        let turn = if crossing & LEAVES == 0 { 1 } else { -1 };
        if crossing & Chain::Towards as u64 != 0 {
            towards += turn;
        }
        if crossing & Chain::Away as u64 != 0 {
            away += turn;
        }
        if towards | away == 0 {
            out.fill_span(row, start, column);
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
            prop_assert_eq!(&words, &draw(&Model::new(mesh), &pose));
            let packed = linked.packed();
            let packed = Model::with_edges(mesh, packed.edges()).expect("its own");
            prop_assert_eq!(words, draw(&packed, &pose));
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
