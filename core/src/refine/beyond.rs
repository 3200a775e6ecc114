//! How much of a model lies beyond the frame's border.

use crate::camera::Camera;
use crate::image::contour::Point;
use crate::mesh::Model;
use crate::pose::Pose;

/// Triangles that are asked, about, whether they are in the frame.
const ASKED: usize = 1024;

/// Part of a model that lies beyond the frame, by what its triangles cover as seen, of however many of them a piece of its surface is made; `pose` is
/// `camera_from_model`. A triangle at the border is as far beyond as its corners are. 1 where nothing can be seen.
pub(crate) fn part_beyond(model: &Model<'_>, camera: &Camera, pose: &Pose) -> f64 {
    if is_ball_within(model, camera, pose) {
        return 0.0;
    }
    let (mut count, mut at) = (0, 0);
    model.for_each_triangle(|_| count += 1);
    let every = (count / ASKED).max(1);
    let (mut beyond, mut all) = (0.0, 0.0);
    model.for_each_triangle(|triangle| {
        let is_asked = at % every == 0;
        at += 1;
        if let (true, Some(corners)) = (is_asked, corners(model, camera, pose, triangle)) {
            let outside = corners.iter().filter(|corner| !is_within(camera, corner));
            let area = covered(&corners);
            all += area;
            beyond += area * outside.count() as f64 / 3.0;
        }
    });
    if all > 0.0 { beyond / all } else { 1.0 }
}

/// Whether the cube about the ball about the model's box lies in the frame, so that the model does.
fn is_ball_within(model: &Model<'_>, camera: &Camera, pose: &Pose) -> bool {
    let bounds = model.bounds();
    let middle = pose.transform(&bounds.centre);
    (0..8).all(|corner| {
        let side = |axis: usize| if corner >> axis & 1 == 0 { 1.0 } else { -1.0 };
        let place = [0, 1, 2].map(|axis| middle[axis] + side(axis) * bounds.radius);
        let place = camera.project(&place);
        place.is_some_and(|place| is_within(camera, &place))
    })
}

/// A triangle's corners in the frame, pixels; none where one of them lies behind the source.
fn corners(
    model: &Model<'_>,
    camera: &Camera,
    pose: &Pose,
    triangle: &[u32; 3],
) -> Option<[Point; 3]> {
    let corner = |&vertex: &u32| {
        let vertex = model.vertices().get(vertex as usize)?;
        camera.project(&pose.transform(&vertex.map(f64::from)))
    };
    let [a, b, c] = triangle;
    Some([corner(a)?, corner(b)?, corner(c)?])
}

fn is_within(camera: &Camera, place: &Point) -> bool {
    let within = |at: f64, side: usize| (0.0..side as f64).contains(&at);
    within(place.column, camera.width()) && within(place.row, camera.height())
}

/// Twice a triangle's area, square pixels.
fn covered([a, b, c]: &[Point; 3]) -> f64 {
    let [right, down] = [b.column - a.column, b.row - a.row];
    (right * (c.row - a.row) - down * (c.column - a.column)).abs()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec::Vec;

    /// A square of 20 mm in cells of `sides` mm, one after another from the left, of two triangles a millimetre of height each.
    fn square(sides: impl IntoIterator<Item = f32>) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
        let (mut vertices, mut triangles, mut left) = (Vec::new(), Vec::new(), -10.0);
        for side in sides {
            for down in (0..20u8).map(|mm| f32::from(mm) - 10.0) {
                let first = vertices.len() as u32;
                let corners = [[0.0, 0.0], [side, 0.0], [side, 1.0], [0.0, 1.0]];
                vertices.extend(corners.map(|[x, y]| [left + x, down + y, 0.0]));
                triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
            }
            left += side;
        }
        (vertices, triangles)
    }

    /// Beyond of a square a metre away, 20 pixels wide, so many to the right of the middle of a frame of 100 pixels.
    fn beyond(square: &(Vec<[f32; 3]>, Vec<[u32; 3]>), right_mm: f64) -> f64 {
        let model = Model::from_triangles(&square.0, &square.1).expect("a square");
        let camera = Camera::new(100, 100, [1000.0; 2], [50.0; 2]).expect("valid");
        let pose = Pose {
            translation: [right_mm, 0.0, -1000.0],
            ..Pose::IDENTITY
        };
        part_beyond(&model, &camera, &pose)
    }

    #[test]
    fn what_stands_across_the_border_is_beyond_by_what_it_covers() {
        let even = square([0.5; 40]);
        for (right_mm, wanted) in [
            (0.0, 0.0),
            (39.5, 0.0),
            (50.0, 0.5),
            (55.0, 0.75),
            (80.0, 1.0),
        ] {
            let part = beyond(&even, right_mm);
            assert!((part - wanted).abs() < 0.03, "{right_mm}: {part}");
        }
    }

    /// As of a stem with a thread, or of a file whose faces are of many sizes.
    #[test]
    fn where_triangles_are_small_does_not_count() {
        let fine_left = square([0.1; 100].into_iter().chain([1.0; 10]));
        let fine_right = square([1.0; 10].into_iter().chain([0.1; 100]));
        for right_mm in [43.0, 46.0, 50.0, 54.0, 57.0] {
            let wanted = (right_mm - 40.0) / 20.0;
            for uneven in [&fine_left, &fine_right] {
                let part = beyond(uneven, right_mm);
                assert!((part - wanted).abs() < 0.04, "{right_mm}: {part}");
            }
        }
    }

    #[test]
    fn behind_the_source_nothing_is_seen() {
        let even = square([1.0; 20]);
        let model = Model::from_triangles(&even.0, &even.1).expect("a square");
        let camera = Camera::new(100, 100, [1000.0; 2], [50.0; 2]).expect("valid");
        let behind = Pose {
            translation: [0.0, 0.0, 50.0],
            ..Pose::IDENTITY
        };
        assert_eq!(part_beyond(&model, &camera, &behind), 1.0);
    }
}
