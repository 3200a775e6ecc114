//! The bound against formulas, drawn outlines and simulated noise.

use super::cholesky::Cholesky;
use super::limits::{covariance, limits, white_information};
use super::sites::Site;
use crate::jitter::{Correlation, Waves};
use crate::{DisturbanceOptions, Noise};
use fluoropose::camera::Camera;
use fluoropose::math::{Matrix3, add, apply, multiply, scale};
use fluoropose::mesh::Model;
use fluoropose::pose::covariance::{Matrix6, PoseCovariance};
use fluoropose::pose::{EulerPose, Pose, Quaternion};
use fluoropose::refine::{OutlineSample, RefineBuffers, outline_samples};
use fluoropose::render::{render, scratch_needed};
use fluoropose_phantom::implant::{Parameters, femur};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Variance of a number rounded to whole pixels.
const ROUNDED: f64 = 1.0 / 12.0;
const ROUND: f64 = 600.0;

/// A closed outline of 600 pieces of one pixel whose Jacobian has slow and fast waves.
fn ring() -> Vec<Site> {
    let piece = |k: usize| {
        let along = k as f64;
        let wave = |turns: f64, phase: f64| {
            libm::cos(std::f64::consts::TAU * turns * along / ROUND + phase)
        };
        Site {
            curve: 0,
            along,
            round: ROUND,
            length: 1.0,
            jacobian: [
                wave(2.0, 0.1) + 0.3 * wave(31.0, 0.7),
                wave(3.0, 0.2),
                wave(5.0, 1.0) + 0.2 * wave(44.0, 0.0),
                wave(1.0, 0.0),
                wave(1.0, 1.5),
                0.4 + 0.1 * wave(7.0, 0.3),
            ],
        }
    };
    (0..ROUND as usize).map(piece).collect()
}

fn noise(white_px2: f64, jitter_px: f64, correlation_px: f64) -> Noise {
    Noise {
        white_px2,
        jitter_px,
        correlation_px,
    }
}

fn assert_matrices_agree(a: &PoseCovariance, b: &PoseCovariance, factor: f64, tolerance: f64) {
    for (row, (a_row, b_row)) in a.matrix.iter().zip(&b.matrix).enumerate() {
        for (column, (a_value, b_value)) in a_row.iter().zip(b_row).enumerate() {
            let size = (b.matrix[row][row] * b.matrix[column][column]).sqrt() * factor;
            let error = (a_value - factor * b_value).abs() / size;
            assert!(error < tolerance, "{row} {column}: {a_value} {b_value}");
        }
    }
}

#[test]
fn the_bound_grows_linearly_with_the_noise() {
    let sites = ring();
    for [white, jitter] in [[ROUNDED, 0.0], [ROUNDED, 1.0]] {
        let once = limits(&sites, &noise(white, jitter, 10.0)).unwrap();
        let thrice = limits(&sites, &noise(9.0 * white, 3.0 * jitter, 10.0)).unwrap();
        assert_matrices_agree(&thrice.bound, &once.bound, 9.0, 1e-9);
        assert_matrices_agree(&thrice.least_squares, &once.least_squares, 9.0, 1e-9);
    }
}

#[test]
fn without_correlation_the_bound_is_that_of_white_noise() {
    let sites = ring();
    let white = limits(&sites, &noise(0.5, 0.0, 0.0)).unwrap();
    assert_eq!(white.bound, white.least_squares);
    // Pieces of one pixel that are not correlated: half of the variance each way.
    let split = limits(&sites, &noise(0.25, 0.5, 0.05)).unwrap();
    assert_matrices_agree(&split.bound, &white.bound, 1.0, 1e-9);
    assert_matrices_agree(&split.least_squares, &white.bound, 1.0, 1e-9);
    // Jitter that vanishes leaves the rounding.
    let rounding = limits(&sites, &Noise::ROUNDING).unwrap();
    let faint = limits(&sites, &noise(ROUNDED, 1e-6, 4.0)).unwrap();
    assert_matrices_agree(&faint.bound, &rounding.bound, 1.0, 1e-6);
}

#[test]
fn pieces_may_be_taken_together() {
    let sites = ring();
    let jittered = noise(ROUNDED, 1.0, 10.0);
    let coarse = limits(&sites, &jittered).unwrap();
    let fine: Vec<Site> = sites
        .iter()
        .flat_map(|site| [-0.25, 0.25].map(|shift| (site, shift)))
        .map(|(site, shift)| Site {
            along: site.along + shift + 0.25,
            length: 0.5,
            ..*site
        })
        .collect();
    let halved = limits(&fine, &jittered).unwrap();
    assert_matrices_agree(&halved.bound, &coarse.bound, 1.0, 0.02);
    assert_matrices_agree(&halved.least_squares, &coarse.least_squares, 1.0, 0.02);
}

#[test]
fn what_is_hidden_tells_nothing() {
    let sites = ring();
    let all = limits(&sites, &Noise::ROUNDING).unwrap();
    let half = limits(&sites[..300], &Noise::ROUNDING).unwrap();
    assert!((0..6).all(|k| half.bound.matrix[k][k] > all.bound.matrix[k][k]));
    assert!(limits(&sites[..3], &Noise::ROUNDING).is_none());
    assert!(limits(&[], &noise(ROUNDED, 1.0, 10.0)).is_none());
}

/// Least squares: `(J' J)^-1 J'`.
struct Estimator {
    jacobian: Vec<[f64; 6]>,
    inverse: PoseCovariance,
}

impl Estimator {
    fn new(jacobian: Vec<[f64; 6]>) -> Self {
        let mut information = [[0.0; 6]; 6];
        for piece in &jacobian {
            for (row, a) in information.iter_mut().zip(piece) {
                for (value, b) in row.iter_mut().zip(piece) {
                    *value += a * b;
                }
            }
        }
        let inverse = PoseCovariance::from_information(&information).unwrap();
        Self { jacobian, inverse }
    }

    fn of(&self, noise: &[[f64; 1]]) -> [f64; 6] {
        let mut right = [0.0; 6];
        for (piece, [noise]) in self.jacobian.iter().zip(noise) {
            for (sum, j) in right.iter_mut().zip(piece) {
                *sum += j * noise;
            }
        }
        let row = |row: &[f64; 6]| row.iter().zip(&right).map(|(a, b)| a * b).sum();
        std::array::from_fn(|k| row(&self.inverse.matrix[k]))
    }
}

/// Estimates from simulated noise: plain least squares and least squares weighted by the inverse
/// of the noise's covariance have the covariances that are said.
#[test]
fn simulated_estimates_scatter_as_the_limits_say() {
    let (sites, law) = (ring(), noise(ROUNDED, 1.0, 10.0));
    let limits = limits(&sites, &law).unwrap();
    let factor = Cholesky::of(covariance(&sites, &law)).unwrap();
    let jacobian: Vec<[f64; 6]> = sites.iter().map(|site| site.jacobian).collect();
    let plain = Estimator::new(jacobian.clone());
    let best = Estimator::new(factor.whitened(&jacobian));
    let mut random = ChaCha8Rng::seed_from_u64(11);
    let correlation = Correlation {
        length: law.correlation_px,
    };
    let mut scatter: [Matrix6; 2] = [[[0.0; 6]; 6]; 2];
    let drawings = 3000;
    for _ in 0..drawings {
        let waves = Waves::draw(law.jitter_px, correlation, ROUND, &mut random);
        let rounding = |bits: u32| f64::from(bits) / 4_294_967_296.0 - 0.5;
        let noise: Vec<[f64; 1]> = sites
            .iter()
            .map(|site| [waves.at(site.along) + rounding(random.next_u32())])
            .collect();
        let estimates = [plain.of(&noise), best.of(&factor.whitened(&noise))];
        for (scatter, estimate) in scatter.iter_mut().zip(estimates) {
            for (row, a) in scatter.iter_mut().zip(estimate) {
                for (value, b) in row.iter_mut().zip(estimate) {
                    *value += a * b / f64::from(drawings);
                }
            }
        }
    }
    // A variance from 3000 drawings errs by 2.6 %.
    for (matrix, wanted) in scatter
        .into_iter()
        .zip([limits.least_squares, limits.bound])
    {
        assert_matrices_agree(&PoseCovariance { matrix }, &wanted, 1.0, 0.1);
    }
    let ratio = limits.least_squares.matrix[0][0] / limits.bound.matrix[0][0];
    assert!(ratio > 2.0, "the spectrum matters here: {ratio}");
}

/// The pose after a turn about the middle and a shift.
fn moved(pose: &Pose, middle: &[f64; 3], step: [f64; 6]) -> Pose {
    let turn = [step[0], step[1], step[2]].map(|angle| angle / 2.0);
    // To second order; the steps are small.
    let scalar = (1.0 - turn.iter().map(|t| t * t).sum::<f64>()).sqrt();
    let [x, y, z] = turn;
    let rotation = multiply(
        &Matrix3::from(Quaternion { w: scalar, x, y, z }),
        &pose.rotation,
    );
    let centre = add(&pose.transform(middle), &[step[3], step[4], step[5]]);
    let translation = add(&centre, &scale(&apply(&rotation, middle), -1.0));
    Pose {
        rotation,
        translation,
    }
}

/// How far the outline of the model drawn at `pose` lies beyond each sample along its normal.
fn distances(mesh: &Model<'_>, camera: &Camera, pose: &Pose, at: &[OutlineSample]) -> Vec<f64> {
    const FINE: usize = 4;
    let fine = camera.supersampled(FINE).unwrap();
    let mut drawn = crate::mask_buffer::MaskBuffer::new(fine.width(), fine.height()).unwrap();
    let mut scratch = vec![Default::default(); scratch_needed(mesh)];
    drawn
        .draw(|mask| render(mesh, &fine, pose, &mut scratch, mask))
        .unwrap();
    let options = DisturbanceOptions::default();
    let curves = options.curves(&drawn.mask(), FINE).unwrap();
    let points: Vec<_> = curves.iter().flat_map(|curve| &curve.points).collect();
    let distance = |sample: &OutlineSample| {
        let offsets = points.iter().filter_map(|point| {
            let (right, down) = (point.column - sample.column, point.row - sample.row);
            let [n_right, n_down] = sample.normal;
            let (out, aside) = (
                right * n_right + down * n_down,
                right * n_down - down * n_right,
            );
            (aside.abs() < 0.2 && out.abs() < 6.0).then_some(out)
        });
        offsets
            .min_by(|a, b| a.abs().total_cmp(&b.abs()))
            .unwrap_or(f64::NAN)
    };
    at.iter().map(distance).collect()
}

#[test]
fn the_information_is_that_of_outlines_drawn_at_neighbouring_poses() {
    let model = femur(&Parameters::default()).unwrap();
    let mesh = Model::from_triangles(&model.vertices, &model.triangles).unwrap();
    let camera = Camera::from_principal_distance(1024, 1024, 1198.0, 0.373, [0.0, 0.0]).unwrap();
    let pose = Pose::from(EulerPose {
        x_mm: 8.0,
        y_mm: -12.0,
        z_mm: -900.0,
        z_rot_deg: 20.0,
        x_rot_deg: 7.0,
        y_rot_deg: -11.0,
    });
    let mut buffers = RefineBuffers::default();
    let mut samples = Vec::new();
    outline_samples(
        &mesh,
        &camera,
        &pose,
        &mut buffers.borrow(&mesh, &camera),
        |sample| {
            samples.push(*sample);
        },
    )
    .unwrap();
    let middle = mesh.bounds().centre;
    // Half a pixel to a pixel of motion each.
    let steps = [0.01, 0.01, 0.01, 0.3, 0.3, 6.0];
    let unmoved = distances(&mesh, &camera, &pose, &samples);
    let mut slopes = vec![[f64::NAN; 6]; samples.len()];
    for (k, step) in steps.into_iter().enumerate() {
        let at = |sign: f64| {
            let mut motion = [0.0; 6];
            motion[k] = sign * step;
            distances(&mesh, &camera, &moved(&pose, &middle, motion), &samples)
        };
        let both = at(1.0).into_iter().zip(at(-1.0));
        for ((slope, (ahead, behind)), here) in slopes.iter_mut().zip(both).zip(&unmoved) {
            // Near a sharp corner another side comes before a sample, and what is measured is no
            // slope: there and back are not one way.
            if (ahead + behind - 2.0 * here).abs() < 0.25 {
                slope[k] = (ahead - behind) / (2.0 * step);
            }
        }
    }
    let whole: Vec<usize> = (0..samples.len())
        .filter(|&k| slopes[k].iter().all(|s| s.is_finite()))
        .collect();
    assert!(
        whole.len() * 100 > samples.len() * 90,
        "{} of {}",
        whole.len(),
        samples.len()
    );
    let site = |k: usize, jacobian: [f64; 6]| Site {
        curve: 0,
        along: k as f64,
        round: samples.len() as f64,
        length: samples[k].length,
        jacobian,
    };
    let analytic: Vec<Site> = whole
        .iter()
        .map(|&k| site(k, samples[k].jacobian))
        .collect();
    let numeric: Vec<Site> = whole.iter().map(|&k| site(k, slopes[k])).collect();
    let (a, b) = (
        white_information(&analytic, ROUNDED),
        white_information(&numeric, ROUNDED),
    );
    for row in 0..6 {
        for column in 0..6 {
            let size = (a[row][row] * a[column][column]).sqrt();
            let error = (a[row][column] - b[row][column]).abs() / size;
            assert!(
                error < 0.05,
                "{row} {column}: {} {}",
                a[row][column],
                b[row][column]
            );
        }
    }
}
