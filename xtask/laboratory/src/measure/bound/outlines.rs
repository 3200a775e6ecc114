//! Where a model's outline is sampled, and how far along the outline each sample lies.

use std::collections::HashMap;

use anyhow::{Context, Result};
use fluoropose::camera::Camera;
use fluoropose::image::mask::Mask;
use fluoropose::math::Vector3;
use fluoropose::mesh::Model;
use fluoropose::pose::Pose;
use fluoropose::refine::{OutlineSample, RefineOptions, outline_samples};
use fluoropose::render::render;
use fluoropose_noise::bound::{Limits, Site, limits};

use super::table::{Limit, PoseLimits};
use crate::files::MaskBuffer;
use crate::finding::Refiner;
use crate::noise::curve::Curve;
use crate::noise::{DisturbanceOptions, Noise};

/// A model in frames of one camera, with working memory to sample its outline.
pub struct Outlines<'m> {
    mesh: Model<'m>,
    camera: Camera,
    refiner: Refiner<'m>,
    middle: Vector3,
}

impl<'m> Outlines<'m> {
    /// Working memory for a model and a camera.
    pub fn new(mesh: Model<'m>, camera: Camera) -> Self {
        Self {
            mesh,
            camera,
            refiner: Refiner::new(mesh, RefineOptions::default()),
            middle: mesh.bounds().centre,
        }
    }

    /// The pieces of the model's outline at a pose that are in the frame and not `unknown`.
    ///
    /// # Errors
    /// Where the model cannot be drawn, and where a sample lies on no outline.
    pub fn sites(&mut self, pose: &Pose, unknown: Option<&Mask<'_>>) -> Result<Vec<Site>> {
        let mut drawn = MaskBuffer::new(self.camera.width(), self.camera.height())?;
        let memory = &mut self.refiner.memory(&self.camera);
        drawn.draw(|mask| render(&self.mesh, &self.camera, pose, memory.projected, mask))?;
        let curves = DisturbanceOptions::default().curves(&drawn.mask(), 1)?;
        let places = Places::new(&curves);
        let mut samples = Vec::new();
        outline_samples(&self.mesh, &self.camera, pose, memory, |sample| {
            samples.push(*sample);
        })?;
        let known = |sample: &OutlineSample| {
            let (column, row) = (sample.column as usize, sample.row as usize);
            !unknown.is_some_and(|unknown| unknown.get(column, row))
        };
        let known = samples.iter().filter(|sample| known(sample));
        known.map(|sample| places.site(sample)).collect()
    }

    /// The limits of a pose under noise; nothing is known of the pixels of `unknown`.
    ///
    /// # Errors
    /// Those of [`Self::sites`].
    pub fn limits(
        &mut self,
        pose: &Pose,
        noise: &Noise,
        unknown: Option<&Mask<'_>>,
    ) -> Result<Option<Limits>> {
        Ok(limits(&self.sites(pose, unknown)?, noise))
    }

    /// The same in the numbers of a table; infinite where the outline does not determine the
    /// pose.
    ///
    /// # Errors
    /// Those of [`Self::sites`].
    pub fn pose_limits(
        &mut self,
        pose: &Pose,
        noise: &Noise,
        unknown: Option<&Mask<'_>>,
    ) -> Result<PoseLimits> {
        let none = PoseLimits {
            bound: Limit::NONE,
            least_squares: Limit::NONE,
        };
        let found = self.limits(pose, noise, unknown)?;
        Ok(found.map_or(none, |found| PoseLimits {
            bound: found.bound.deviations(pose, &self.middle).into(),
            least_squares: found.least_squares.deviations(pose, &self.middle).into(),
        }))
    }
}

/// Vertices of curves by where they are.
struct Places<'c> {
    curves: &'c [Curve],
    cells: HashMap<[i64; 2], Vec<(usize, usize)>>,
}

/// Side of a cell, pixels: a sample is much nearer than this to its outline.
const CELL: f64 = 3.0;

fn cell(column: f64, row: f64) -> [i64; 2] {
    [column, row].map(|value| (value / CELL).floor() as i64)
}

impl<'c> Places<'c> {
    fn new(curves: &'c [Curve]) -> Self {
        let mut cells: HashMap<[i64; 2], Vec<(usize, usize)>> = HashMap::new();
        for (index, curve) in curves.iter().enumerate() {
            for (vertex, point) in curve.points.iter().enumerate() {
                let place = cell(point.column, point.row);
                cells.entry(place).or_default().push((index, vertex));
            }
        }
        Self { curves, cells }
    }

    /// The sample on the outline that it belongs to: of the vertices near it that with the
    /// nearest place, where an outline that faces the other way, as that of the other side of a thin part,
    /// counts as this much farther off.
    fn site(&self, sample: &OutlineSample) -> Result<Site> {
        const OTHER_SIDE: f64 = 2.0;
        let badness = |&(curve, vertex): &(usize, usize)| {
            let (point, normal) = (
                self.curves[curve].points[vertex],
                self.curves[curve].normals[vertex],
            );
            let cosine = normal[0] * sample.normal[0] + normal[1] * sample.normal[1];
            libm::hypot(point.column - sample.column, point.row - sample.row)
                + OTHER_SIDE * (1.0 - cosine)
        };
        let [column, row] = cell(sample.column, sample.row);
        let near = (-1..=1).flat_map(|right| (-1..=1).map(move |down| [right, down]));
        let near = near
            .filter_map(|[right, down]| self.cells.get(&[column + right, row + down]))
            .flatten();
        let &(curve, vertex) = near
            .min_by(|a, b| badness(a).total_cmp(&badness(b)))
            .with_context(|| {
                format!(
                    "the outline's sample at column {:.1}, row {:.1} lies on no border of the mask",
                    sample.column, sample.row
                )
            })?;
        Ok(Site {
            curve,
            along: self.curves[curve].along[vertex],
            round: self.curves[curve].length,
            length: sample.length,
            jacobian: sample.jacobian,
        })
    }
}
