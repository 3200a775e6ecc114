//! The only rasteriser: a model in perspective to a mask.

use crate::camera::Camera;
use crate::image::mask::MaskMut;
use crate::image::scan::triangle_spans;
use crate::memory::first;
use crate::mesh::Model;
use crate::pose::Pose;
use crate::render::facing::FacingTest;
use crate::render::project::{Images, Projected, RenderError, VERTICES, project};
use crate::render::winding;

/// Working memory of [`render`] for `model`, in [`Projected`]: one for each vertex, and more where it is drawn from its
/// edges. No more is used; [`scratch_for`] tells how much less serves small frames.
#[must_use]
pub fn scratch_needed(model: &Model<'_>) -> usize {
    let edges = model
        .edges()
        .map_or(0, |edges| winding::room_needed(&edges));
    model.vertices().len() + edges
}

/// The same for a model of so many vertices in frames of so many rows, where its outline has at most `edges` silhouette
/// edges, which cross rows at most `crossings` times. Where a pose needs more, or there is only one for each vertex, its
/// triangles are drawn: the same pixels, later.
#[must_use]
pub const fn scratch_for(vertices: usize, rows: usize, edges: usize, crossings: usize) -> usize {
    vertices + winding::room_for(rows, edges, crossings)
}

/// The part of the working memory that a model is drawn in.
fn used<'m>(
    model: &Model<'_>,
    scratch: &'m mut [Projected],
) -> Result<&'m mut [Projected], RenderError> {
    let most = scratch.len().min(scratch_needed(model));
    Ok(first(VERTICES, most.max(model.vertices().len()), scratch)?)
}

/// Adds the silhouette of `model` at `pose` to `out`: every pixel whose centre lies in the
/// projection of any triangle, whatever the winding. What is beyond the frame is cut off. A model
/// with edges gives the same pixels sooner.
///
/// # Errors
/// [`RenderError`]; nothing has been drawn then. Working memory is too short below one for each vertex.
pub fn render(
    model: &Model<'_>,
    camera: &Camera,
    pose: &Pose,
    scratch: &mut [Projected],
    out: &mut MaskMut<'_>,
) -> Result<(), RenderError> {
    if (out.width(), out.height()) != (camera.width(), camera.height()) {
        return Err(RenderError::Size);
    }
    let scratch = used(model, scratch)?;
    if let Some(edges) = model.edges() {
        let facing = FacingTest::new(model.mesh(), camera, pose);
        if !facing.sees_all() {
            // Errors where a vertex has no image.
            project(model.mesh(), camera, pose, scratch)?;
        }
        let (slots, room) = scratch.split_at_mut(model.vertices().len());
        let mut images = Images::new(model.mesh(), camera, pose, slots);
        if winding::fill(&facing, &edges, &mut images, room, out) {
            return Ok(());
        }
    }
    let projected = project(model.mesh(), camera, pose, scratch)?;
    let height = out.height();
    for_each_span(
        model,
        projected,
        height,
        |_| true,
        |_, row, from, to| {
            out.fill_span(row, from, to);
        },
    );
    Ok(())
}

/// Calls `visit(triangle, row, from, to)` for each row of each triangle that is `wanted` and
/// covers pixel centres: columns `from..to`, not yet cut to the frame's width. `projected` holds
/// the vertices as [`project`] gives them.
pub(crate) fn for_each_span(
    model: &Model<'_>,
    projected: &[Projected],
    height: usize,
    wanted: impl Fn([Projected; 3]) -> bool,
    mut visit: impl FnMut(&[u32; 3], usize, i64, i64),
) {
    for triangle in model.triangles() {
        // Indices were checked when the model was made.
        let corners = triangle.map(|v| projected.get(v as usize).copied().unwrap_or_default());
        if !wanted(corners) {
            continue;
        }
        triangle_spans(corners, height, |row, from, to| {
            visit(triangle, row, from, to)
        });
    }
}

/// The silhouette edges of `model` as [`render`] left them in its working memory, run along as the
/// triangles that face the camera do, with the images of their ends; nothing where it was drawn triangle by triangle.
pub(crate) fn contour<'s>(
    model: &Model<'_>,
    scratch: &'s [Projected],
) -> Option<impl Iterator<Item = ([u32; 2], [Projected; 2])> + use<'s>> {
    model.edges()?;
    let scratch = scratch.get(..scratch.len().min(scratch_needed(model)))?;
    let (images, room) = scratch.split_at_checked(model.vertices().len())?;
    let image = |vertex: u32| images.get(vertex as usize).copied().unwrap_or_default();
    Some(winding::contour(room)?.map(move |ends| (ends, ends.map(image))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::contour::Point;
    use crate::image::mask::words_needed;
    use crate::pose::EulerPose;
    use proptest::prelude::*;

    const SIDE: usize = 64;

    fn camera() -> Camera {
        Camera::new(SIDE, SIDE, [400.0, 380.0], [31.0, 33.5]).expect("valid")
    }

    /// Oracle: doubled areas that a point spans with the edges. A pixel is drawn when its centre is on the same side of
    /// all three.
    fn sides(corners: [Point; 3], x: f64, y: f64) -> [f64; 3] {
        let [a, b, c] = corners;
        [(a, b), (b, c), (c, a)]
            .map(|(a, b)| (b.column - a.column) * (y - a.row) - (b.row - a.row) * (x - a.column))
    }

    fn lengths([a, b, c]: [Point; 3]) -> [f64; 3] {
        [(a, b), (b, c), (c, a)].map(|(a, b)| libm::hypot(b.column - a.column, b.row - a.row))
    }

    proptest! {
        #[test]
        fn a_triangle_covers_the_centres_inside_it(
            corners in proptest::array::uniform3((-60.0..60.0f32, -60.0..60.0f32, -40.0..40.0f32)),
            z_rot in -180.0..180.0f64
        ) {
            let vertices = corners.map(|(x, y, z)| [x, y, z]);
            let Ok(model) = Model::from_triangles(&vertices, &[[0, 1, 2]]) else { return Ok(()) };
            let pose = Pose::from(EulerPose {
                z_mm: -600.0, z_rot_deg: z_rot, ..EulerPose::default()
            });
            let mut words = [0; words_needed(SIDE, SIDE)];
            let mut mask = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
            render(&model, &camera(), &pose, &mut [Projected::default(); 3], &mut mask)
                .expect("in front");
            let images = vertices.map(|v| {
                camera().project(&pose.transform(&v.map(f64::from))).expect("in front")
            });
            for (row, column) in (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| (row, column))) {
                let sides = sides(images, column as f64 + 0.5, row as f64 + 0.5);
                let inside = sides.iter().all(|&s| s > 0.0) || sides.iter().all(|&s| s < 0.0);
                // Vertices are rounded to 1/4096 pixel: a centre that near an edge may be on either side of it.
                let near = sides.iter().zip(lengths(images)).any(|(s, length)| s.abs() < length / 4096.0);
                prop_assert!(near || inside == mask.as_mask().get(column, row), "{}, {}", column, row);
            }
        }

        #[test]
        fn winding_and_order_do_not_matter(swap in 0usize..6) {
            let vertices = [[-20.0, -20.0, 5.0], [30.0, -10.0, 0.0], [5.0, 25.0, -9.0], [-30.0, 20.0, 3.0]];
            let orders = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
            let draw = |triangles: &[[u32; 3]]| {
                let model = Model::from_triangles(&vertices, triangles).expect("valid");
                let mut words = [0; words_needed(SIDE, SIDE)];
                let mut mask = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
                let pose = Pose { translation: [0.0, 0.0, -500.0], ..Pose::IDENTITY };
                render(&model, &camera(), &pose, &mut [Projected::default(); 4], &mut mask)
                    .expect("in front");
                words
            };
            prop_assert_eq!(draw(&[[0, 1, 2], [0, 2, 3]]), draw(&[[3, 2, 0], orders[swap]]));
        }
    }

    #[test]
    fn triangles_that_share_an_edge_leave_no_gap_and_no_overlap() {
        // A fan around a point inside the frame: the areas of its parts add up to the whole.
        let rim: [[f32; 3]; 7] = core::array::from_fn(|k| {
            let (s, c) = libm::sincosf(k as f32 * 0.897_598);
            [40.0 * c, 35.0 * s, 0.0]
        });
        let mut vertices = [[0.0; 3]; 8];
        vertices[1..].copy_from_slice(&rim);
        vertices[0] = [3.3, -2.7, 0.0];
        let triangles: [[u32; 3]; 7] =
            core::array::from_fn(|k| [0, k as u32 + 1, (k as u32 + 1) % 7 + 1]);
        let pose = Pose {
            translation: [0.0, 0.0, -500.0],
            ..Pose::IDENTITY
        };
        let area = |triangles: &[[u32; 3]]| {
            let model = Model::from_triangles(&vertices, triangles).expect("valid");
            let mut words = [0; words_needed(SIDE, SIDE)];
            let mut mask = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
            render(
                &model,
                &camera(),
                &pose,
                &mut [Projected::default(); 8],
                &mut mask,
            )
            .expect("in front");
            mask.as_mask().area()
        };
        let parts: u64 = triangles
            .iter()
            .map(|t| area(core::slice::from_ref(t)))
            .sum();
        assert_eq!(parts, area(&triangles));
    }

    #[test]
    fn behind_the_camera_is_an_error() {
        let vertices = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let model = Model::from_triangles(&vertices, &[[0, 1, 2]]).expect("valid");
        let mut words = [0; words_needed(SIDE, SIDE)];
        let mut mask = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
        let mut scratch = [Projected::default(); 3];
        for z in [0.0, 10.0, f64::NAN, -1e-9] {
            let pose = Pose {
                translation: [0.0, 0.0, z],
                ..Pose::IDENTITY
            };
            let result = render(&model, &camera(), &pose, &mut scratch, &mut mask);
            assert!(matches!(result, Err(RenderError::BehindCamera(_))), "{z}");
        }
    }
}
