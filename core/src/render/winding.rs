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
const PLACES: usize = 32_768;

/// In place of the number of silhouette edges where the surface was not drawn from them.
const NONE: u64 = u64::MAX;

/// Working memory of [`fill`].
pub(crate) fn room_needed(edges: &Edges<'_>) -> usize {
    PLACES + 2 * (KEPT + 1) * edges.rims().count()
}

/// The same for frames of so many rows, and contours of at most so many edges, each of which crosses a row once at most: what
/// holds the crossings of any one row holds those of several at a time.
pub(crate) const fn room_for(rows: usize, edges: usize) -> usize {
    1 + rows + (KEPT + 1) * edges
}

/// What is kept of a silhouette edge: its vertices and their images.
const KEPT: usize = 3;
type Kept = [FixedPoint; KEPT];

/// Adds the silhouette of a surface to `out`. Gives `false`, and has drawn a part of it at most, where
/// the room does not hold all edges and the crossings of one row. Afterwards [`contour`] reads the edges from `room`.
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
    let crossings = room.len().saturating_sub(KEPT * chains.all());
    let (crossings, kept) = room.split_at_mut_checked(crossings).unwrap_or_default();
    let kept = kept.as_chunks_mut::<KEPT>().0;
    for [vertices, from, to] in &mut *kept {
        [*from, *to] = vertices_of(*vertices).map(|vertex| images.of(vertex));
    }
    let (away, towards) = kept.split_at_checked(chains.away).unwrap_or_default();
    let (towards, both) = towards.split_at_checked(chains.towards).unwrap_or_default();
    let parts = [
        (Chain::Both, both),
        (Chain::Towards, towards),
        (Chain::Away, away),
    ];
    count_crossings(parts, rows);
    let mut start = 0;
    while start < out.height() {
        let Some(band) = Band::from(start, rows, crossings.len()) else {
            return false;
        };
        start = band.rows.end;
        band.fill(parts, (&mut *rows, &mut *crossings), out);
    }
    *count = (chains.all() as u64).into();
    true
}

/// The edges that [`fill`] drew a surface from, as their vertices and the images of these, read from its working memory; nothing
/// where it was not drawn.
pub(crate) fn contour(
    room: &[FixedPoint],
) -> Option<impl Iterator<Item = ([u32; 2], [FixedPoint; 2])> + use<'_>> {
    let count = usize::try_from(u64::from(*room.first()?)).ok()?;
    let first = room.len().checked_sub(count.checked_mul(KEPT)?)?;
    let kept = room.get(first..)?.as_chunks::<KEPT>().0.iter();
    Some(kept.map(|&[vertices, from, to]| (vertices_of(vertices), [from, to])))
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
    let mut free = room.as_rchunks_mut::<KEPT>().1.iter_mut().rev();
    let mut fits = true;
    let mut keep = |[from, to]: [u32; 2], count: &mut usize| {
        match free.next() {
            Some([vertices, ..]) => *vertices = (u64::from(from) << 32 | u64::from(to)).into(),
            None => fits = false,
        }
        *count += 1;
    };
    let (mut both, mut towards, mut away) = (0, 0, 0);
    for (bounds, group) in edges.groups() {
        facing.contour(bounds, group, images, |ends| keep(ends, &mut both));
    }
    if let Some(packed) = edges.packed() {
        facing.packed_contour(packed, images, |ends| keep(ends, &mut both));
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
type Parts<'p> = [(Chain, &'p [Kept]); 3];

/// Calls `visit` for each edge that crosses rows, with these.
fn for_each_edge(
    parts: Parts<'_>,
    height: usize,
    mut visit: impl FnMut(Chain, [FixedPoint; 2], Range<usize>),
) {
    for (chain, edges) in parts {
        for &[_, from, to] in edges {
            let ends = [from, to];
            let rows = rows_between(ends, height);
            // Most edges of a CAD model are shorter than a pixel.
            if !rows.is_empty() {
                visit(chain, ends, rows);
            }
        }
    }
}

/// Bits of a crossing below its column: that it leaves, and its chains.
const LEAVES: u32 = 4;
const COLUMN_BIT: u32 = 3;

/// Writes how many edges cross each row.
fn count_crossings(parts: Parts<'_>, counts: &mut [FixedPoint]) {
    counts.fill(FixedPoint::ZERO);
    for_each_edge(parts, counts.len(), |_, _, rows| {
        add_to(counts, rows.start, 1);
        add_to(counts, rows.end, u32::MAX);
    });
    let mut in_row = 0u32;
    for count in counts {
        in_row = in_row.wrapping_add(count.number());
        *count = in_row.into();
    }
}

/// Some rows whose crossings are found and filled at a time.
struct Band {
    rows: Range<usize>,
}

impl Band {
    /// As many rows from one on as there is room for the crossings of; `None` where those of that one do not fit.
    fn from(start: usize, counts: &[FixedPoint], room: usize) -> Option<Self> {
        let mut left = room;
        let mut end = start;
        for &count in counts.get(start..)? {
            let Some(rest) = left.checked_sub(count.number() as usize) else {
                break;
            };
            (left, end) = (rest, end + 1);
        }
        (end > start).then_some(Self { rows: start..end })
    }

    /// Fills the spans in which the winding number of either chain is not zero. `counts` are those of all rows; of the band's they
    /// are not needed any more.
    fn fill(
        &self,
        parts: Parts<'_>,
        (counts, places): (&mut [FixedPoint], &mut [FixedPoint]),
        out: &mut MaskMut<'_>,
    ) {
        let ends = counts.get_mut(self.rows.clone()).unwrap_or_default();
        // Where the crossings of each row begin; as each is written, where they end.
        let mut before = 0u32;
        for end in &mut *ends {
            let count = end.number();
            *end = before.into();
            before += count;
        }
        let (width, height) = (out.width() as i32, out.height());
        for_each_edge(parts, height, |chain, ends_of, rows| {
            let rows = rows.start.max(self.rows.start)..rows.end.min(self.rows.end);
            if rows.is_empty() {
                return;
            }
            // Facing triangles are run clockwise: what is run upwards has them to its right.
            let [from, to] = ends_of;
            let leaves = if to.is_above(from) { 0 } else { LEAVES };
            let edge = Edge::new(ends_of);
            let first = rows.start;
            let own_ends = ends.get_mut(first - self.rows.start..).unwrap_or_default();
            // By a function that is called: a loop of its own would ask the iterator, which is not inlined.
            edge.columns(rows).for_each(|(row, column)| {
                let column = (column as i32).max(0).min(width) as u32;
                let Some(end) = own_ends.get_mut(row - first) else {
                    return;
                };
                let place = u64::from(*end);
                if let Some(crossing) = places.get_mut(place as usize) {
                    *crossing = u64::from(column << COLUMN_BIT | leaves | chain as u32).into();
                }
                *end = (place + 1).into();
            });
        });
        let mut start = 0;
        for (row, &end) in self.rows.clone().zip(&*ends) {
            let end = end.number() as usize;
            let crossings = places.get_mut(start..end).unwrap_or_default();
            sort(crossings);
            fill_row(row, crossings, out);
            start = end;
        }
    }
}

/// Adds to the number of a row, where there is such a row.
fn add_to(rows: &mut [FixedPoint], row: usize, more: u32) {
    if let Some(number) = rows.get_mut(row) {
        *number = number.number().wrapping_add(more).into();
    }
}

/// By insertion: few edges cross one row.
fn sort(crossings: &mut [FixedPoint]) {
    for at in 1..crossings.len() {
        let Some((own, before)) = crossings
            .get_mut(..=at)
            .and_then(<[FixedPoint]>::split_last_mut)
        else {
            continue;
        };
        // As one number: it was written as one, though of 32 bits.
        let number = |crossing: FixedPoint| u64::from(crossing) as u32;
        let (moved, mut free) = (*own, own);
        for other in before.iter_mut().rev() {
            if number(*other) <= number(moved) {
                break;
            }
            *free = *other;
            free = other;
        }
        *free = moved;
    }
}

fn fill_row(row: usize, crossings: &[FixedPoint], out: &mut MaskMut<'_>) {
    let (mut towards, mut away, mut start) = (0i32, 0i32, 0);
    for &crossing in crossings {
        let crossing = u64::from(crossing) as u32;
        let column = i64::from(crossing >> COLUMN_BIT);
        if towards | away == 0 {
            start = column;
        }
        let turn = if crossing & LEAVES == 0 { 1 } else { -1 };
        if crossing & Chain::Towards as u32 != 0 {
            towards += turn;
        }
        if crossing & Chain::Away as u32 != 0 {
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
    use crate::render::reach::Reach;
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

    properties! {
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

    properties! {
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
            let facing = FacingTest::new(&mesh, &camera, &pose, &Reach::of(&mesh.bounds(), &pose));
            let mut room = vec![FixedPoint::default(); room_needed(&edges)];
            let mut words = vec![0; words_needed(SIDE, SIDE)];
            let mut out = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
            prop_assert!(fill(&facing, &edges, &mut images, &mut room, &mut out));
            prop_assert_eq!(&words, &draw(&Model::new(mesh), &pose));
            let packed = linked.packed();
            for edges in [packed.edges(), packed.tight_edges()] {
                let packed = Model::with_edges(mesh, edges).expect("its own");
                prop_assert_eq!(&words, &draw(&packed, &pose));
            }
        }
    }

    #[test]
    fn with_less_room_rows_are_drawn_some_at_a_time() {
        let (vertices, triangles) = fake::torus(&[0.0]);
        let model = Model::from_triangles(&vertices, &triangles).expect("valid");
        let linked = Linked::new(model.mesh());
        let (edges, packed) = (linked.edges(), linked.packed());
        let camera = camera();
        let facing = FacingTest::new(
            model.mesh(),
            &camera,
            &FAR,
            &Reach::of(&model.bounds(), &FAR),
        );
        let wanted = draw(&model, &FAR);
        // Whether it is drawn, with so much room and slots for so many images.
        let fits = |edges: &Edges<'_>, room: usize, slots: usize| {
            let mut words = vec![0; words_needed(SIDE, SIDE)];
            let mut out = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
            let mut slots = vec![FixedPoint::default(); slots];
            let mut images = Images::new(model.mesh(), &camera, &FAR, &mut slots);
            let mut room = vec![FixedPoint::default(); room];
            let fits = fill(&facing, edges, &mut images, &mut room, &mut out);
            assert!(!fits || words == wanted);
            fits
        };
        let silhouette = {
            let mut room = vec![FixedPoint::default(); 4000];
            let mut slots = vec![FixedPoint::default(); vertices.len()];
            let mut images = Images::new(model.mesh(), &camera, &FAR, &mut slots);
            let mut words = vec![0; words_needed(SIDE, SIDE)];
            let mut out = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
            assert!(fill(&facing, &edges, &mut images, &mut room, &mut out));
            contour(&room).expect("it was drawn").count()
        };
        for edges in [&edges, &packed.edges()] {
            for room in [0, 1, SIDE, SIDE + 1, SIDE + KEPT * silhouette] {
                assert!(!fits(edges, room, vertices.len()), "{room}");
            }
            let least = 1 + SIDE + KEPT * silhouette;
            let crossings = |more: &usize| fits(edges, least + more, vertices.len());
            let in_a_row = (0..).find(crossings).expect("that of all of them");
            assert!(in_a_row > 1 && 20 * in_a_row < SIDE * 4, "{in_a_row}");
            for more in [0, 1, 7, 50, 1000] {
                for slots in [0, 1, 2, 5, 64, vertices.len()] {
                    let room = least + in_a_row + more;
                    assert!(fits(edges, room, slots), "{more} {slots}");
                }
            }
            assert!(fits(edges, room_for(SIDE, silhouette), 9));
        }
    }
}
