//! Coarser levels of a model, for callers that have an allocator.

use alloc::collections::BTreeMap;
use alloc::vec::Vec;

use super::model::Model;
use super::owned::OwnedModel;
use crate::math::floor;

/// A coarser level is worth its making for a search where it has at most one of this many triangles.
const WORTH: usize = 2;

/// A model with at most half as many triangles, as [`clustered`] makes it. `None` where that would save less, or nothing would be
/// left.
///
/// It serves a search, never an answer: its silhouette is not the model's, and its digest another.
#[must_use]
pub fn coarser(model: &Model<'_>, cell_mm: f64) -> Option<OwnedModel> {
    drawn_together(model, cell_mm, model.triangles().len() / WORTH)
}

/// A model with fewer triangles, all vertices within a cube of the side `cell_mm` drawn together to their mean (vertex
/// clustering: Rossignac and Borrel, *Multi-resolution 3D approximations for rendering complex scenes*, 1993), so that no
/// vertex moves by more than the cube's diagonal. `None` where that would save no triangle, or nothing would be left.
#[must_use]
pub fn clustered(model: &Model<'_>, cell_mm: f64) -> Option<OwnedModel> {
    drawn_together(model, cell_mm, model.triangles().len().saturating_sub(1))
}

/// [`clustered`], `None` where more than `most` triangles would be left.
fn drawn_together(model: &Model<'_>, cell_mm: f64, most: usize) -> Option<OwnedModel> {
    if cell_mm.is_nan() || cell_mm <= 0.0 {
        return None;
    }
    let mut cells: BTreeMap<[i64; 3], u32> = BTreeMap::new();
    let mut sums: Vec<([f64; 3], f64)> = Vec::new();
    let mut cell_of = Vec::with_capacity(model.vertices().len());
    for vertex in model.vertices() {
        let vertex = vertex.map(f64::from);
        let key = vertex.map(|x| floor(x / cell_mm) as i64);
        let cell = *cells.entry(key).or_insert(sums.len() as u32);
        if cell as usize == sums.len() {
            sums.push(([0.0; 3], 0.0));
        }
        let (sum, count) = &mut sums[cell as usize];
        for (sum, x) in sum.iter_mut().zip(vertex) {
            *sum += x;
        }
        *count += 1.0;
        cell_of.push(cell);
    }
    let drawn = |triangle: &[u32; 3]| triangle.map(|vertex| cell_of[vertex as usize]);
    let is_left = |[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
    let triangles: Vec<u32> = model
        .triangles()
        .iter()
        .map(drawn)
        .filter(is_left)
        .flatten()
        .collect();
    if triangles.len() / 3 > most {
        return None;
    }
    let means = sums
        .iter()
        .flat_map(|(sum, count)| sum.map(|x| (x / count) as f32));
    OwnedModel::new(means.collect(), triangles).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Camera;
    use crate::image::mask::{MaskMut, words_needed};
    use crate::mesh::Mesh;
    use crate::mesh::edges::fake;
    use crate::pose::{EulerPose, Pose};
    use crate::render::{Projected, render, scratch_needed};
    use proptest::collection::vec as vec_of;
    use proptest::prelude::*;
    use std::vec;

    fn drawn(model: &Model<'_>) -> Vec<u32> {
        let camera = Camera::new(256, 256, [900.0; 2], [128.0; 2]).expect("valid");
        let pose = Pose::from(EulerPose {
            z_mm: -200.0,
            x_rot_deg: 40.0,
            y_rot_deg: 10.0,
            ..EulerPose::default()
        });
        let mut words = vec![0; words_needed(256, 256)];
        let mut mask = MaskMut::new(&mut words, 256, 256).expect("valid");
        let mut scratch = vec![Projected::default(); scratch_needed(model)];
        render(model, &camera, &pose, &mut scratch, &mut mask).expect("in front");
        words
    }

    properties! {
        /// Oracle: every vertex beside every other. Cells lie around the origin, so that some have negative numbers.
        #[test]
        fn vertices_of_a_cell_are_drawn_to_their_mean(
            vertices in vec_of(proptest::array::uniform3(-9.0..9.0f32), 3..30),
            corners in vec_of(proptest::array::uniform3(0u32..30), 1..40),
            cell_mm in 0.5..20.0f64,
        ) {
            let count = vertices.len() as u32;
            let triangles: Vec<[u32; 3]> = corners.iter().map(|corners| corners.map(|corner| corner % count)).collect();
            let model = Model::from_triangles(&vertices, &triangles).expect("valid");
            let cell = |corner: &[f32; 3]| corner.map(|x| (f64::from(x) / cell_mm).floor() as i64);
            let mean = |vertex: u32| {
                let own = cell(&vertices[vertex as usize]);
                let beside: Vec<_> = vertices.iter().filter(|other| cell(other) == own).collect();
                let sum = |k: usize| beside.iter().map(|other| f64::from(other[k])).sum::<f64>();
                core::array::from_fn(|k| (sum(k) / beside.len() as f64) as f32)
            };
            let drawn = triangles.iter().map(|triangle| triangle.map(mean));
            let expected: Vec<[[f32; 3]; 3]> = drawn.filter(|[a, b, c]| a != b && b != c && c != a).collect();
            let found = clustered(&model, cell_mm);
            prop_assert_eq!(found.is_some(), !expected.is_empty() && expected.len() < triangles.len());
            let is_worth = found.is_some() && 2 * expected.len() <= triangles.len();
            prop_assert_eq!(coarser(&model, cell_mm).is_some(), is_worth);
            if let Some(found) = found {
                let model = found.as_model();
                let places = |triangle: &[u32; 3]| triangle.map(|vertex| model.vertices()[vertex as usize]);
                // Triangles are turned alike, which is not looked at here.
                let sorted = |mut places: [[f32; 3]; 3]| {
                    places.sort_by(|a, b| a.partial_cmp(b).expect("no NaN"));
                    places
                };
                let found: Vec<_> = model.triangles().iter().map(places).map(sorted).collect();
                prop_assert_eq!(found, expected.into_iter().map(sorted).collect::<Vec<_>>());
            }
        }
    }

    #[test]
    fn few_pixels_of_the_silhouette_change_and_a_coarse_model_stays_as_it_is() {
        let (vertices, triangles) = fake::torus(&[0.0; 40]);
        let mesh = Mesh::new(&vertices, &triangles).expect("valid");
        let model = Model::new(mesh);
        let radius = model.bounds().radius;
        assert!(coarser(&model, radius / 1000.0).is_none());
        assert!(coarser(&model, f64::NAN).is_none());
        assert!(clustered(&model, f64::NAN).is_none());
        let (fine, cell) = (drawn(&model), radius / 3.0);
        let Some(coarse) = coarser(&model, cell) else {
            panic!("a third of the radius draws vertices together");
        };
        let same = clustered(&model, cell).expect("fewer triangles");
        assert_eq!(same.as_model().triangles(), coarse.as_model().triangles());
        assert!(2 * coarse.as_model().triangles().len() <= triangles.len());
        let differ: u32 = fine
            .iter()
            .zip(drawn(&coarse.as_model()))
            .map(|(a, b)| (a ^ b).count_ones())
            .sum();
        let area: u32 = fine.iter().map(|word| word.count_ones()).sum();
        assert!(differ > 0 && differ < area / 2, "{differ} of {area}");
    }
}
