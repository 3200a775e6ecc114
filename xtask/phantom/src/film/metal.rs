//! Transmission through an implant.

use super::physics::Sampling;
use super::placed::{Placed, silhouette};
use super::plane::Plane;
use super::sagittal::ray;
use anyhow::Result;
use fluoropose::camera::Camera;
use fluoropose::image::mask::Mask;
use fluoropose::image::mask::Word;
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// The ways of all rays through an implant, at each moment of the exposure.
pub(super) struct Shadow {
    moments: Vec<Moment>,
    sampling: Sampling,
}

struct Moment {
    covered: Vec<Word>,
    fine: Camera,
    paths: Paths,
}

impl Shadow {
    /// Follows the rays through an implant.
    ///
    /// # Errors
    /// Where it cannot be projected.
    pub(super) fn cast(camera: &Camera, placed: &Placed<'_>, sampling: Sampling) -> Result<Self> {
        let fine = camera.supersampled(sampling.samples)?;
        let moment = |placed: Placed<'_>| -> Result<Moment> {
            Ok(Moment {
                covered: silhouette(&fine, &placed)?,
                paths: Paths::through(&fine, &placed, sampling.samples),
                fine,
            })
        };
        let moments = placed.moments();
        Ok(Self {
            moments: moments.into_iter().map(moment).collect::<Result<_>>()?,
            sampling,
        })
    }

    /// Darkens a transmission picture by the implant, of this linear attenuation (per mm).
    pub(super) fn shade(&self, picture: &mut Plane, density: f64) -> Result<()> {
        let count = self.moments.len() as f64;
        let mut mean = vec![0.0; picture.values.len()];
        for moment in &self.moments {
            let passed =
                moment.passed(picture.width, picture.values.len(), density, self.sampling)?;
            for (mean, passed) in mean.iter_mut().zip(passed) {
                *mean += passed / count;
            }
        }
        for (value, mean) in picture.values.iter_mut().zip(mean) {
            *value *= mean;
        }
        Ok(())
    }
}

impl Moment {
    /// What passes to each pixel of a picture.
    fn passed(
        &self,
        width: usize,
        pixels: usize,
        density: f64,
        sampling: Sampling,
    ) -> Result<Vec<f64>> {
        let mask = Mask::new(&self.covered, self.fine.width(), self.fine.height())?;
        let (paths, samples) = (&self.paths, sampling.samples);
        let mut passed = vec![1.0; pixels];
        let rows = passed.par_chunks_mut(width).enumerate();
        let lit = rows.filter(|(row, _)| paths.rows().contains(row));
        lit.for_each(|(row, out)| {
            for column in paths.columns() {
                let mut sum = 0.0;
                for k in 0..samples * samples {
                    let (x, y) = (column * samples + k % samples, row * samples + k / samples);
                    sum += if mask.get(x, y) {
                        libm::exp(-density * paths.at(x, y).max(sampling.least_path_mm))
                    } else {
                        1.0
                    };
                }
                out[column] = sum / (samples * samples) as f64;
            }
        });
        Ok(passed)
    }
}

/// Lengths of rays inside a closed mesh, for the samples of a box of whole pixels.
struct Paths {
    samples: usize,
    from: [usize; 2],
    to: [usize; 2],
    lengths: Vec<f64>,
}

impl Paths {
    /// Adds up distances to surfaces that a ray leaves by and subtracts those that it enters by.
    fn through(camera: &Camera, placed: &Placed<'_>, samples: usize) -> Self {
        let points: Vec<DVec3> = placed
            .mesh
            .vertices
            .iter()
            .map(|v| DVec3::from(placed.pose.transform(&v.map(f64::from))))
            .collect();
        let images: Vec<DVec2> = points.iter().map(|point| project(camera, point)).collect();
        let mut paths = Self::around(camera, &images, samples);
        for triangle in &placed.mesh.triangles {
            let corners = triangle.map(|v| images[v as usize]);
            let [a, b, c] = triangle.map(|v| points[v as usize]);
            let normal = (b - a).cross(c - a);
            let offset = normal.dot(a);
            let sign = if offset > 0.0 { 1.0 } else { -1.0 };
            paths.scan(corners, |column, row| {
                let ray = ray(camera, column, row);
                sign * ray.length() * offset / ray.dot(normal)
            });
        }
        paths
    }

    /// The box of whole pixels round all images, cut to the frame.
    fn around(camera: &Camera, images: &[DVec2], samples: usize) -> Self {
        let low = images.iter().fold(DVec2::INFINITY, |low, p| low.min(*p));
        let high = images
            .iter()
            .fold(DVec2::NEG_INFINITY, |high, p| high.max(*p));
        let pixel =
            |place: f64, count: usize| ((place.max(0.0) as usize) / samples).min(count / samples);
        let from = [pixel(low.x, camera.width()), pixel(low.y, camera.height())];
        let to = [
            pixel(high.x + samples as f64, camera.width()),
            pixel(high.y + samples as f64, camera.height()),
        ];
        let size = (to[0] - from[0]) * (to[1] - from[1]) * samples * samples;
        Self {
            samples,
            from,
            to,
            lengths: vec![0.0; size],
        }
    }

    fn columns(&self) -> std::ops::Range<usize> {
        self.from[0]..self.to[0]
    }

    fn rows(&self) -> std::ops::Range<usize> {
        self.from[1]..self.to[1]
    }

    fn at(&self, x: usize, y: usize) -> f64 {
        self.lengths[self.index(x, y)]
    }

    fn index(&self, x: usize, y: usize) -> usize {
        (y - self.from[1] * self.samples) * (self.to[0] - self.from[0]) * self.samples + x
            - self.from[0] * self.samples
    }

    /// Adds a value at every sample centre inside a triangle. Edges are met at the same place from both
    /// sides, so neighbours neither overlap nor leave a gap.
    fn scan(&mut self, corners: [DVec2; 3], value: impl Fn(f64, f64) -> f64) {
        let [a, b, c] = corners;
        let (top, bottom) = (a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y));
        let rows = self.rows();
        let first = first_centre(top).max(rows.start * self.samples);
        let last = first_centre(bottom).min(rows.end * self.samples);
        let columns = self.columns();
        for row in first..last {
            let y = row as f64 + 0.5;
            let mut ends = [(a, b), (b, c), (c, a)]
                .into_iter()
                .filter_map(|(p, q)| crossing(p, q, y));
            let (Some(one), Some(two)) = (ends.next(), ends.next()) else {
                continue;
            };
            let from = first_centre(one.min(two)).max(columns.start * self.samples);
            let to = first_centre(one.max(two)).min(columns.end * self.samples);
            for column in from..to {
                let index = self.index(column, row);
                self.lengths[index] += value(column as f64 + 0.5, y);
            }
        }
    }
}

/// The first sample whose centre is at or beyond a place.
fn first_centre(place: f64) -> usize {
    (place - 0.5).ceil().max(0.0) as usize
}

/// Where an edge crosses a row's centre line; the same number whichever way the edge runs.
fn crossing(p: DVec2, q: DVec2, y: f64) -> Option<f64> {
    let (upper, lower) = if (p.y, p.x) <= (q.y, q.x) {
        (p, q)
    } else {
        (q, p)
    };
    (upper.y <= y && y < lower.y)
        .then(|| upper.x + (lower.x - upper.x) * ((y - upper.y) / (lower.y - upper.y)))
}

fn project(camera: &Camera, point: &DVec3) -> DVec2 {
    let ([fx, fy], [cx, cy]) = (camera.focal(), camera.principal_point());
    DVec2::new(cx + fx * point.x / -point.z, cy - fy * point.y / -point.z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::implant::Triangles;
    use fluoropose::pose::Pose;

    /// A box from -10 to 10 mm in x and y, 7 mm thick.
    fn slab() -> Triangles {
        let corner = |k: u32| {
            [
                if k & 1 == 0 { -10.0 } else { 10.0 },
                if k & 2 == 0 { -10.0 } else { 10.0 },
                if k & 4 == 0 { -3.5 } else { 3.5 },
            ]
        };
        let quads = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        Triangles {
            vertices: (0..8).map(corner).collect(),
            triangles: quads
                .iter()
                .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
                .collect(),
        }
    }

    #[test]
    fn path_through_a_slab_is_its_thickness() {
        let mesh = slab();
        let pose = Pose {
            translation: [0.0, 0.0, -990.0],
            ..Pose::IDENTITY
        };
        let camera = Camera::from_principal_distance(64, 64, 1000.0, 0.5, [0.0, 0.0]).unwrap();
        let mut picture = Plane {
            width: 64,
            height: 64,
            values: vec![1.0; 64 * 64],
        };
        let placed = Placed::at_rest(&mesh, pose);
        let shadow = Shadow::cast(&camera, &placed, Sampling::default()).unwrap();
        shadow.shade(&mut picture, 0.1).unwrap();
        let middle = picture.values[32 * 64 + 32];
        assert!((-middle.ln() / 0.1 - 7.0).abs() < 1e-3, "{middle}");
        assert_eq!(picture.values[5 * 64 + 5], 1.0);
        // The slab's near face is 20 mm wide at 986.5 mm: 40.5 pixels, so its edge pixel is partly covered.
        let edge = picture.values[32 * 64 + 11];
        assert!(edge > middle && edge < 1.0, "{edge}");
    }

    /// What an opaque square hides is its projected area, to some hundredths of a pixel along its sides, whichever way it
    /// is turned.
    #[test]
    fn edges_are_true_to_hundredths_of_a_pixel() {
        let mesh = slab();
        let camera = Camera::from_principal_distance(96, 96, 1000.0, 0.4, [0.0, 0.0]).unwrap();
        let side = 20.0 * 1000.0 / 0.4 / (950.0 - 3.5);
        for turn in [3.0, 17.0, 31.0, 44.0] {
            let pose = Pose::from(fluoropose::pose::EulerPose {
                z_mm: -950.0,
                z_rot_deg: turn,
                ..Default::default()
            });
            let mut picture = Plane {
                width: 96,
                height: 96,
                values: vec![1.0; 96 * 96],
            };
            let placed = Placed::at_rest(&mesh, pose);
            let shadow = Shadow::cast(&camera, &placed, Sampling::EXACT).unwrap();
            shadow.shade(&mut picture, 1000.0).unwrap();
            let hidden: f64 = picture.values.iter().map(|value| 1.0 - value).sum();
            let outside = (hidden - side * side) / (4.0 * side);
            assert!(outside.abs() < 0.02, "{outside} px at {turn} degrees");
        }
    }

    /// The shadow of an opaque part and the core's silhouette of it have one centroid: no half pixel is lost between them.
    #[test]
    fn shadow_lies_where_the_silhouette_does() {
        let mesh = slab();
        let camera = Camera::from_principal_distance(96, 80, 1000.0, 0.5, [1.3, -0.7]).unwrap();
        for (x, y) in [(0.0, 0.0), (3.17, -5.4), (-4.03, 2.71)] {
            let turned = fluoropose::pose::EulerPose {
                x_mm: x,
                y_mm: y,
                z_mm: -950.0,
                z_rot_deg: 31.0,
                x_rot_deg: 8.0,
                y_rot_deg: -11.0,
            };
            let placed = Placed::at_rest(&mesh, Pose::from(turned));
            let mut picture = Plane {
                width: 96,
                height: 80,
                values: vec![1.0; 96 * 80],
            };
            let shadow = Shadow::cast(&camera, &placed, Sampling::default()).unwrap();
            shadow.shade(&mut picture, 1000.0).unwrap();
            let (mut sum, mut right, mut down) = (0.0, 0.0, 0.0);
            for (index, value) in picture.values.iter().enumerate() {
                sum += 1.0 - value;
                right += (1.0 - value) * ((index % 96) as f64 + 0.5);
                down += (1.0 - value) * ((index / 96) as f64 + 0.5);
            }
            let words = silhouette(&camera, &placed).unwrap();
            let truth = Mask::new(&words, camera.width(), camera.height()).unwrap();
            let truth = truth.moments().centroid();
            assert!(
                (right / sum - truth.column).abs() < 0.05,
                "{} {}",
                right / sum,
                truth.column
            );
            assert!(
                (down / sum - truth.row).abs() < 0.05,
                "{} {}",
                down / sum,
                truth.row
            );
        }
    }
}
