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

use super::{Limit, Limits, Noise, PoseLimits, limits};
use crate::pipeline::disturb::DisturbanceOptions;
use crate::pipeline::disturb::curve::Curve;
use crate::pipeline::files::MaskBuffer;
use crate::pipeline::refiner::Refiner;

/// A piece of a model's outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site {
    /// Which closed curve it belongs to.
    pub curve: usize,
    /// Way along that curve, pixels.
    pub along: f64,
    /// Length of the whole curve, pixels.
    pub round: f64,
    /// Length of the piece, pixels.
    pub length: f64,
    /// How fast it moves along its normal: pixels per radian of three turns about the middle of
    /// the model's box, and per mm of three shifts, camera axes.
    pub jacobian: [f64; 6],
}

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
            refiner: Refiner::new(mesh, &[camera], RefineOptions::default()),
            middle: mesh.bounds().centre,
        }
    }

    /// The pieces of the model's outline at a pose that are in the frame and not `unknown`.
    ///
    /// # Errors
    /// Where the model cannot be drawn, and where a sample lies on no outline.
    pub fn sites(&mut self, pose: &Pose, unknown: Option<&Mask<'_>>) -> Result<Vec<Site>> {
        let mut drawn = MaskBuffer::new(self.camera.width(), self.camera.height())?;
        let memory = &mut self.refiner.memory();
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

/// Neighbouring pieces of one curve taken together to pieces of about `length` pixels; never
/// shorter than what is there.
pub(super) fn gathered(sites: &[Site], length: f64) -> Vec<Site> {
    let mut order = sites.to_vec();
    order.sort_by(|a, b| {
        (a.curve, a.along)
            .partial_cmp(&(b.curve, b.along))
            .unwrap_or(std::cmp::Ordering::Equal)
    });
    let bin = |site: &Site| (site.along / length) as i64;
    let mut all: Vec<Site> = Vec::new();
    for group in order.chunk_by(|a, b| a.curve == b.curve && bin(a) == bin(b)) {
        let total: f64 = group.iter().map(|site| site.length).sum();
        let mean = |value: &dyn Fn(&Site) -> f64| {
            let sum: f64 = group.iter().map(|site| site.length * value(site)).sum();
            sum / total
        };
        // A corner pixel may have no length of its own.
        if total > 0.0 {
            all.push(Site {
                along: mean(&|site| site.along),
                length: total,
                jacobian: std::array::from_fn(|k| mean(&|site| site.jacobian[k])),
                ..group[0]
            });
        }
    }
    all
}
