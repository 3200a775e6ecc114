//! The protocol: random known poses, drawn, disturbed and found again.

use std::str::FromStr;

use anyhow::{Context, Result, bail};
use fluoropose::camera::Camera;
use fluoropose::library::{ViewAxis, ViewGrid};
use fluoropose::math::{Vector3, add, apply, multiply, norm, rotation_by, scale};
use fluoropose::mesh::Model;
use fluoropose::mesh::symmetry::symmetry_planes;
use fluoropose::pose::covariance::{Deviations, PoseCovariance};
use fluoropose::pose::{EulerPose, Pose};
use fluoropose::refine::CameraView;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::Serialize;

use super::ranges::{DEPTH_MM, FAILURE_DEG, LATERAL_MM};
use crate::files::MaskBuffer;
use crate::finding::biplane::turned_about;
use crate::finding::{Finder, Method, ViewOptions, build_library};
use crate::measure::accuracy::{Errors, is_wrong_side, mean_absolute, median_absolute, rms};
use crate::measure::bound::{Comparison, Outlines, PoseLimits};
use crate::measure::coverage::Coverage;
use crate::noise::{DisturbanceOptions, Disturbed, Noise, Scene};
use crate::progress::progress;

/// Out-of-plane rotations keep this far from the library's border, degrees: an object 40 mm off
/// the axis in x and y is seen from a direction that differs by up to 3 degrees.
const MARGIN_DEG: f64 = 3.5;

/// How far from the truth a refinement starts: degrees, mm aside, mm along the view.
#[derive(Clone, Copy, Debug)]
pub struct StartOff(pub [f64; 3]);

impl FromStr for StartOff {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> Result<Self> {
        let numbers: Result<Vec<f64>, _> = text.split(',').map(|n| n.trim().parse()).collect();
        match numbers.unwrap_or_default().as_slice() {
            &[turn, aside, along] if turn.is_finite() && aside.is_finite() && along.is_finite() => {
                Ok(Self([turn, aside, along]))
            }
            _ => bail!("'{text}' is not degrees,mm,mm"),
        }
    }
}

impl StartOff {
    /// `pose` moved by so much about `middle`, a point of the model.
    fn of(self, pose: &Pose, middle: &Vector3, random: &mut ChaCha8Rng) -> Pose {
        let Self([turn, aside, along]) = self;
        let mut draw = || random.random_range(-1.0..=1.0f64);
        // A direction that is equally likely everywhere, by rejection.
        let axis = loop {
            let axis = [draw(), draw(), draw()];
            let length = norm(&axis);
            if (0.1..=1.0).contains(&length) {
                break scale(&axis, turn.to_radians() / length);
            }
        };
        let direction = core::f64::consts::PI * draw();
        let along = along.copysign(draw());
        let shift = [aside * direction.cos(), aside * direction.sin(), along];
        let rotation = multiply(&rotation_by(&axis), &pose.rotation);
        let centre = add(&pose.transform(middle), &shift);
        Pose {
            rotation,
            translation: add(&centre, &scale(&apply(&rotation, middle), -1.0)),
        }
    }
}

/// What is drawn and how it is found again.
#[derive(Clone, Copy, Debug)]
pub struct Protocol {
    /// How poses are found.
    pub method: Method,
    /// Middle of the range of z, and distance of the library's views, mm.
    pub distance: f64,
    /// Number of poses.
    pub poses: usize,
    /// Seed of the random poses.
    pub seed: u64,
    /// What is done to each mask before its pose is found.
    pub disturbance: DisturbanceOptions,
}

/// How a pose is looked for, if not from the library and by one camera.
#[derive(Clone, Copy, Debug, Default)]
pub struct Variant {
    /// Where refinement starts, if not at the library's poses.
    pub start_off: Option<StartOff>,
    /// Angle to a second camera, degrees.
    pub biplane: Option<f64>,
}

/// What the protocol measures.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Accuracy {
    /// Number of poses drawn.
    pub poses: usize,
    /// Of these, masks of which no pose was found.
    pub not_found: usize,
    /// Poses wrong by more than 4 degrees or not found: not in the means.
    pub failures: usize,
    /// Poses nearer to a mirror image of the pose drawn than to it, in a plane in which the model
    /// is nearly symmetric.
    pub wrong_side: usize,
    /// Poses wrong by at most 1 degree.
    pub within_1_deg: usize,
    /// Of the poses wrong by at most 4 degrees, those with a covariance, and those of them that
    /// lie in their own region of 95 %.
    pub regions: usize,
    /// See `regions`.
    pub covered: usize,
    /// The parts of the same poses whose regions hold the truth, number by number.
    pub inside: Coverage,
    /// Mean absolute error of z_rot, degrees.
    pub in_plane_deg: f64,
    /// Mean absolute error of x_rot and y_rot, degrees.
    pub out_of_plane_deg: f64,
    /// Mean absolute error of x and y, mm.
    pub in_plane_mm: f64,
    /// Mean absolute error of z, mm.
    pub out_of_plane_mm: f64,
    /// Root mean square errors of all poses found, those over 4 degrees among them.
    pub rms: Errors,
    /// Median absolute errors of the same poses.
    pub median: Errors,
    /// The limits of the same poses, and the root mean square errors against them.
    pub limits: Comparison,
}

/// Builds a library of `mesh` and finds random poses again.
///
/// # Errors
/// Those of the core's builder and rasteriser, and for an impossible disturbance. A mask of which
/// no pose is found is counted, and named on standard error.
pub fn measure(
    mesh: Model<'_>,
    camera: Camera,
    views: &ViewOptions,
    protocol: &Protocol,
) -> Result<Accuracy> {
    measure_as(mesh, camera, views, protocol, Variant::default())
}

/// The same, from other starts or by two cameras. A second camera and a start of one's own need no
/// library; the method is then refinement.
///
/// # Errors
/// Those of [`measure`].
pub fn measure_as(
    mesh: Model<'_>,
    camera: Camera,
    views: &ViewOptions,
    protocol: &Protocol,
    variant: Variant,
) -> Result<Accuracy> {
    let distance = protocol.distance;
    let mut scene = Scene::new(mesh, camera, protocol.disturbance)?;
    let built = build_library(mesh, camera, views, distance)?;
    let mut search = Search {
        finder: Finder::open(&built.bytes, mesh, camera, protocol.method)?,
        camera,
        middle: mesh.bounds().centre,
        protocol: *protocol,
        variant,
    };
    let mut outlines = Outlines::new(mesh, camera);
    let mut random = ChaCha8Rng::seed_from_u64(protocol.seed);
    let bar = progress(protocol.poses, "poses");
    let planes = symmetry_planes(mesh.mesh());
    let (mut tries, mut limits) = (Vec::new(), Vec::new());
    for frame in 0..protocol.poses {
        let pose = random_pose(&mut random, &views.grid(), &mesh, distance);
        let (reference, seen) = scene.observe(&pose, frame as u64)?;
        match search.find(&mut scene, &reference, &seen, frame as u64) {
            Ok((found, covariance)) => tries.push(Try {
                errors: Errors::of(&found, &reference),
                wrong_side: is_wrong_side(&found, &reference, &planes),
                covered: covariance
                    .and_then(|c| c.holds(&found, &reference, &search.middle, WITHIN_95)),
                told: covariance.map(|c| c.deviations(&found, &search.middle)),
            }),
            Err(error) => bar.suspend(|| {
                eprintln!("no pose for {:?}: {error:#}", EulerPose::from(reference));
            }),
        }
        let hidden = seen.hidden.as_ref().map(MaskBuffer::mask);
        limits.push(outlines.pose_limits(&reference, &scene.noise(), hidden.as_ref())?);
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok(summary(&tries, scene.noise(), &limits))
}

/// Squared radius that holds 95 % of a normal distribution in six dimensions.
const WITHIN_95: f64 = 12.592;

/// One pose looked for.
struct Try {
    errors: Errors,
    wrong_side: bool,
    /// Whether the truth lies in the region of 95 %.
    covered: Option<bool>,
    told: Option<Deviations>,
}

/// How a pose is looked for.
struct Search<'l> {
    finder: Finder<'l>,
    camera: Camera,
    middle: Vector3,
    protocol: Protocol,
    variant: Variant,
}

impl Search<'_> {
    /// The best pose of what was seen of `reference`, and how sure it is.
    fn find(
        &mut self,
        scene: &mut Scene<'_>,
        reference: &Pose,
        seen: &Disturbed,
        frame: u64,
    ) -> Result<(Pose, Option<PoseCovariance>)> {
        let starts = match self.variant.start_off {
            Some(off) => {
                let mut random = ChaCha8Rng::seed_from_u64(self.protocol.seed);
                random.set_stream(frame + 1);
                let start = off.of(reference, &self.middle, &mut random);
                seen.see(|silhouette| Ok(self.finder.nearby(&silhouette, &start)))?
            }
            None => {
                let all = seen.see(|silhouette| self.finder.all(&silhouette.into()))?;
                let all = all.candidates;
                let best = all.first().context("the library has no views")?;
                if self.variant.biplane.is_none() {
                    return Ok((best.pose, best.covariance));
                }
                all.iter().map(|answer| answer.pose).collect()
            }
        };
        let camera = self.camera;
        let found = match self.variant.biplane {
            None => seen.see(|silhouette| {
                let view = CameraView::only(&camera, silhouette);
                self.finder.refine_views(&[view], &starts)
            })?,
            Some(angle) => {
                let placement = turned_about(self.protocol.distance, angle);
                let other = scene.observe_from(&placement, reference, frame)?;
                seen.see(|first| {
                    other.see(|second| {
                        let second = CameraView {
                            placement,
                            ..CameraView::only(&camera, second)
                        };
                        let views = [CameraView::only(&camera, first), second];
                        self.finder.refine_views(&views, &starts)
                    })
                })?
            }
        };
        let (refined, covariance) = found.first().context("nothing to start from")?;
        Ok((refined.pose, *covariance))
    }
}

/// A pose inside the library's range, with the middle of the model's box near the axis.
fn random_pose(random: &mut ChaCha8Rng, grid: &ViewGrid, mesh: &Model<'_>, distance: f64) -> Pose {
    let inside = |axis: &ViewAxis| {
        let last = axis.at(axis.count as f64 - 1.0);
        let middle = (axis.first + last) / 2.0;
        let reach = ((last - axis.first) / 2.0 - MARGIN_DEG).max(0.0);
        (middle, reach)
    };
    let mut draw = |(middle, reach): (f64, f64)| middle + reach * random.random_range(-1.0..=1.0);
    let mut pose = Pose::from(EulerPose {
        x_mm: draw((0.0, LATERAL_MM)),
        y_mm: draw((0.0, LATERAL_MM)),
        z_mm: draw((-distance, DEPTH_MM)),
        z_rot_deg: draw((0.0, 180.0)),
        x_rot_deg: draw(inside(&grid.x)),
        y_rot_deg: draw(inside(&grid.y)),
    });
    let centre = fluoropose::math::apply(&pose.rotation, &mesh.bounds().centre);
    for (translation, centre) in pose.translation.iter_mut().zip(centre) {
        *translation -= centre;
    }
    pose
}

/// Statistics of the poses found; there are as many limits as poses were drawn.
fn summary(tries: &[Try], noise: Noise, limits: &[PoseLimits]) -> Accuracy {
    let errors: Vec<Errors> = tries.iter().map(|found| found.errors).collect();
    let right = |found: &&Try| found.errors.geodesic_deg <= FAILURE_DEG;
    let kept: Vec<Errors> = tries.iter().filter(right).map(|t| t.errors).collect();
    let covered = || tries.iter().filter(right).filter_map(|found| found.covered);
    let with_region = || {
        tries
            .iter()
            .filter(right)
            .filter(|found| found.covered.is_some())
    };
    let mean = Errors::summarise(&kept, mean_absolute);
    let rms = Errors::summarise(&errors, rms);
    Accuracy {
        poses: limits.len(),
        not_found: limits.len() - errors.len(),
        failures: limits.len() - kept.len(),
        wrong_side: tries.iter().filter(|found| found.wrong_side).count(),
        within_1_deg: errors.iter().filter(|e| e.geodesic_deg <= 1.0).count(),
        regions: covered().count(),
        covered: covered().filter(|&covered| covered).count(),
        inside: Coverage::of(with_region().map(|found| (&found.errors, found.told.as_ref()))),
        in_plane_deg: mean.z_rot_deg,
        out_of_plane_deg: (mean.x_rot_deg + mean.y_rot_deg) / 2.0,
        in_plane_mm: (mean.x_mm + mean.y_mm) / 2.0,
        out_of_plane_mm: mean.z_mm,
        rms,
        median: Errors::summarise(&errors, median_absolute),
        limits: Comparison::of(noise, limits, &rms),
    }
}
