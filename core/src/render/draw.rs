//! The only rasteriser: a model in perspective to a mask.

use crate::camera::Camera;
use crate::image::mask::MaskMut;
use crate::image::scan::triangle_spans;
use crate::memory::first;
use crate::mesh::Model;
use crate::pose::Pose;
use crate::render::facing::FacingTest;
use crate::render::project::{Images, Projected, RenderError, VERTICES, check_images};
use crate::render::reach::Reach;
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
/// edges. Rows are then drawn some at a time, and images of vertices made again where they made way for others. Where a pose
/// has more edges its triangles are drawn: the same pixels, later.
#[must_use]
pub const fn scratch_for(vertices: usize, rows: usize, edges: usize) -> usize {
    let room = winding::room_for(rows, edges);
    let images = room.div_ceil(IMAGES - 1);
    if images < vertices {
        room + images
    } else {
        room + vertices
    }
}

/// One of so many places is for images of vertices where there are not places for all.
const IMAGES: usize = 8;

/// Working memory as it is used: images of vertices, and room for silhouette edges; none of a model without.
///
/// # Errors
/// [`RenderError::Memory`] where there is less than one for each vertex of a model without edges.
fn parts<'m>(
    model: &Model<'_>,
    scratch: &'m mut [Projected],
) -> Result<(&'m mut [Projected], &'m mut [Projected]), RenderError> {
    let vertices = model.vertices().len();
    let most = scratch.len().min(scratch_needed(model));
    if model.edges().is_none() {
        return Ok((first(VERTICES, vertices, scratch)?, &mut []));
    }
    let scratch = first(VERTICES, most, scratch)?;
    let images = match most < scratch_needed(model) {
        true => (most / IMAGES).min(vertices),
        false => vertices,
    };
    Ok(scratch.split_at_mut_checked(images).unwrap_or_default())
}

/// Adds the silhouette of `model` at `pose` to `out`: every pixel whose centre lies in the
/// projection of any triangle, whatever the winding. What is beyond the frame is cut off. A model
/// with edges gives the same pixels sooner.
///
/// # Errors
/// [`RenderError`]; nothing has been drawn then. Working memory of a model without edges is too short below one for each vertex.
pub fn render(
    model: &Model<'_>,
    camera: &Camera,
    pose: &Pose,
    scratch: &mut [Projected],
    out: &mut MaskMut<'_>,
) -> Result<(), RenderError> {
    render_with(model, camera, pose, scratch, out, false).map(drop)
}

/// The same; where `all` images of vertices are wanted, for whoever asks all triangles afterwards, they are made at once, several side by
/// side. Gives whether working memory holds them.
///
/// # Errors
/// Those of [`render`].
pub(crate) fn render_with(
    model: &Model<'_>,
    camera: &Camera,
    pose: &Pose,
    scratch: &mut [Projected],
    out: &mut MaskMut<'_>,
    all: bool,
) -> Result<bool, RenderError> {
    if (out.width(), out.height()) != (camera.width(), camera.height()) {
        return Err(RenderError::Size);
    }
    let (slots, room) = parts(model, scratch)?;
    let all = cfg!(feature = "frames") && all && slots.len() == model.vertices().len();
    if all {
        Images::left(model.mesh(), camera, pose, slots).make_all()?;
    }
    if let Some(edges) = model.edges() {
        let reach = Reach::of(&model.bounds(), pose);
        let facing = FacingTest::new(model.mesh(), camera, pose, &reach);
        if !all && !facing.sees_all() {
            check_images(model.vertices(), camera, pose)?;
        }
        let images = match all {
            true => Images::left(model.mesh(), camera, pose, slots),
            false => Images::new(model.mesh(), camera, pose, slots),
        };
        if winding::fill(&facing, &edges, &mut images.reaching(reach), room, out) {
            return Ok(all);
        }
    }
    let mut images = Images::new(model.mesh(), camera, pose, slots);
    images.make_all()?;
    let height = out.height();
    for_each_span(
        model,
        |vertex| images.of(vertex),
        height,
        |_| true,
        |_, row, from, to| {
            out.fill_span(row, from, to);
        },
    );
    Ok(all)
}

/// Calls `visit(triangle, row, from, to)` for each row of each triangle that is `wanted` and
/// covers pixel centres: columns `from..to`, not yet cut to the frame's width. `image` gives that of a vertex.
pub(crate) fn for_each_span(
    model: &Model<'_>,
    mut image: impl FnMut(u32) -> Projected,
    height: usize,
    wanted: impl Fn([Projected; 3]) -> bool,
    mut visit: impl FnMut(&[u32; 3], usize, i64, i64),
) {
    model.for_each_triangle(|triangle| {
        let corners = triangle.map(&mut image);
        if wanted(corners) {
            triangle_spans(corners, height, |row, from, to| {
                visit(triangle, row, from, to)
            });
        }
    });
}

/// What [`render`] left in its working memory of a model at a pose.
pub(crate) struct Remains<'s> {
    pub(crate) images: Images<'s>,
    room: &'s [Projected],
}

/// The images and silhouette edges of `model` as [`render`] left them in its working memory at the same pose.
pub(crate) fn remains<'s>(
    model: &Model<'s>,
    camera: &'s Camera,
    pose: &'s Pose,
    scratch: &'s mut [Projected],
) -> Option<Remains<'s>> {
    let (slots, room) = parts(model, scratch).ok()?;
    Some(Remains {
        images: Images::left(model.mesh(), camera, pose, slots),
        room,
    })
}

impl Remains<'_> {
    /// Calls `visit` for each silhouette edge, run along as the triangles that face the camera do, with the images of its ends.
    /// Gives `false` where the model was drawn triangle by triangle.
    pub(crate) fn contour(&self, visit: impl FnMut(([u32; 2], [Projected; 2]))) -> bool {
        winding::contour(self.room)
            .map(|edges| edges.for_each(visit))
            .is_some()
    }
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

    properties! {
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
