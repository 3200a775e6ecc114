use super::*;
use crate::math::{add, cross, norm, scale, subtract};
use crate::mesh::Model;
use crate::mesh::edges::fake;
use crate::pose::EulerPose;
use crate::render::scratch_needed;
use proptest::prelude::*;
use std::vec;
use std::vec::Vec;

const SIDE: usize = 256;

fn camera() -> Camera {
    Camera::new(SIDE, SIDE, [1500.0, 1480.0], [127.3, 129.1]).expect("valid")
}

fn measured(model: &Model<'_>, pose: &Pose, lines: &mut [PathLine]) {
    let mut scratch = vec![Projected::default(); scratch_needed(model)];
    let mut heads = vec![0; heads_needed()];
    let mut groups = vec![LineGroup::default(); groups_needed(lines.len())];
    measure(
        model,
        &camera(),
        pose,
        &mut scratch,
        lines,
        &mut heads,
        &mut groups,
    )
    .expect("in front");
}

/// Place and ray of each point of a line, the ray with depth 1.
fn rays(line: &PathLine) -> impl Iterator<Item = [f64; 3]> + use<> {
    let Course {
        origin, direction, ..
    } = line.course;
    let ([fx, fy], [cx, cy]) = (camera().focal(), camera().principal_point());
    (0..POINTS).map(move |k| {
        let along = STEP * k as f64 - INNER;
        let [column, row] = [0, 1].map(|axis| origin[axis] + along * direction[axis]);
        [(column - cx) / fx, -(row - cy) / fy, -1.0]
    })
}

/// Oracle: the signed sum over all triangles that a ray meets, by the formula of Möller and Trumbore.
fn through_triangles(model: &Model<'_>, pose: &Pose, ray: &[f64; 3]) -> f64 {
    let mut sum = 0.0;
    for triangle in model.triangles() {
        let [a, b, c] = triangle
            .map(|vertex| pose.transform(&model.vertices()[vertex as usize].map(f64::from)));
        let (one, two) = (subtract(&b, &a), subtract(&c, &a));
        let p = cross(ray, &two);
        let determinant = dot(&one, &p);
        if determinant == 0.0 {
            continue;
        }
        let from = scale(&a, -1.0);
        let u = dot(&from, &p) / determinant;
        let q = cross(&from, &one);
        let v = dot(ray, &q) / determinant;
        if u >= 0.0 && v >= 0.0 && u + v <= 1.0 {
            sum += determinant.signum() * dot(&two, &q) / determinant * norm(ray);
        }
    }
    sum.abs()
}

fn sphere(radius: f64, around: u32, across: u32) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    use core::f64::consts::{PI, TAU};
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for k in 0..around * (across + 1) {
        let (s, c) = libm::sincos(f64::from(k % around) / f64::from(around) * TAU);
        let (ring, height) = libm::sincos(f64::from(k / around) / f64::from(across) * PI);
        // At the poles rings are points, all of one place.
        let ring = if [0, across].contains(&(k / around)) {
            0.0
        } else {
            ring
        };
        vertices.push([ring * c, height, ring * s].map(|x| (radius * x) as f32));
    }
    let at = |i: u32, j: u32| j * around + i % around;
    for (i, j) in (0..around).flat_map(|i| (0..across).map(move |j| (i, j))) {
        triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
        triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
    }
    (vertices, triangles)
}

/// A box of these half widths.
fn slab(half: [f32; 3]) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    fake::add_box(half.map(|x| -x), half, &mut vertices, &mut triangles);
    (vertices, triangles)
}

/// Lines of all directions about a circle.
fn lines_about(centre: [f64; 2], radius: f64, count: usize) -> Vec<PathLine> {
    let line = |k: usize| {
        let (s, c) = libm::sincos(k as f64 / count as f64 * core::f64::consts::TAU + 0.1);
        PathLine::at([centre[0] + radius * c, centre[1] + radius * s], [c, s])
    };
    (0..count).map(line).collect()
}

#[test]
fn paths_through_a_sphere_are_its_chords() {
    let (radius, distance) = (30.0, 700.0);
    let (vertices, triangles) = sphere(radius, 240, 120);
    let model = Model::from_triangles(&vertices, &triangles).expect("valid");
    let centre = [8.0, -5.0, -distance];
    let pose = Pose {
        translation: centre,
        ..Pose::IDENTITY
    };
    let middle = camera().project(&centre).expect("in front");
    let mut lines = lines_about([middle.column, middle.row], 64.2, 90);
    measured(&model, &pose, &mut lines);
    let (mut inside, mut worst) = (0, 0.0f64);
    for line in &lines {
        let paths = line.paths().expect("closed");
        for (&path, ray) in paths.iter().zip(rays(line)) {
            let along = dot(&ray, &centre) / norm(&ray);
            let off = dot(&centre, &centre) - along * along;
            let chord = 2.0 * libm::sqrt((radius * radius - off).max(0.0));
            inside += usize::from(chord > 0.0);
            // Facets lie up to 0.02 mm within the sphere, where rays graze that is much of the chord.
            let limit = 0.15 + 2.0 * 0.03 * radius / chord.max(1.0);
            worst = worst.max((f64::from(path) - chord).abs() / limit);
        }
    }
    assert!(worst < 1.0 && inside > 3000, "{worst} {inside}");
}

#[test]
fn depths_behind_an_origin_are_those_of_front_and_back() {
    let (radius, centre) = (30.0, [8.0, -5.0, -700.0]);
    let (vertices, triangles) = sphere(radius, 240, 120);
    let model = Model::from_triangles(&vertices, &triangles).expect("valid");
    let pose = Pose {
        translation: centre,
        ..Pose::IDENTITY
    };
    let middle = camera().project(&centre).expect("in front");
    let mut lines = lines_about([middle.column, middle.row], 45.0, 60);
    lines.push(PathLine::at([20.0, 20.0], [1.0, 0.0]));
    measured(&model, &pose, &mut lines);
    assert_eq!(lines.pop().expect("the last").depths(), None);
    for line in &lines {
        // Where the ray of depth 1, a times as long, meets the sphere.
        let ray = rays(line).nth(ORIGIN).expect("a place");
        let (a, b) = (dot(&ray, &ray), dot(&ray, &centre));
        let root = libm::sqrt(b * b - a * (dot(&centre, &centre) - radius * radius));
        let wanted = [(b - root) / a, (b + root) / a];
        let depths = line.depths().expect("metal");
        for (depth, wanted) in depths.iter().zip(wanted) {
            assert!((depth - wanted).abs() < 0.1, "{depths:?} {wanted}");
        }
    }
}

#[test]
fn the_path_through_a_slab_seen_from_the_front_is_its_thickness_and_inside_out_too() {
    let (vertices, mut triangles) = slab([20.0, 15.0, 4.0]);
    let pose = Pose {
        translation: [0.0, 0.0, -600.0],
        ..Pose::IDENTITY
    };
    for turned in [false, true] {
        if turned {
            triangles
                .iter_mut()
                .for_each(|[a, b, _]| core::mem::swap(a, b));
        }
        let model = Model::from_triangles(&vertices, &triangles).expect("valid");
        let mut lines = [
            PathLine::at([127.3, 129.1], [1.0, 0.0]),
            PathLine::at([127.3, 260.0], [0.0, 1.0]),
        ];
        measured(&model, &pose, &mut lines);
        for (path, ray) in lines[0]
            .paths()
            .expect("closed")
            .iter()
            .zip(rays(&lines[0]))
        {
            assert!((f64::from(*path) - 8.0 * norm(&ray)).abs() < 2e-3, "{path}");
        }
        assert_eq!(lines[1].paths(), Some(&[0.0; POINTS]));
    }
}

#[test]
fn a_line_over_a_hole_says_so() {
    let (vertices, triangles) = slab([20.0, 15.0, 4.0]);
    let model = Model::from_triangles(&vertices, &triangles[1..]).expect("valid");
    let pose = Pose {
        translation: [0.0, 0.0, -600.0],
        ..Pose::IDENTITY
    };
    let mut lines = lines_about([127.3, 129.1], 20.0, 40);
    measured(&model, &pose, &mut lines);
    let open = lines.iter().filter(|line| line.paths().is_none()).count();
    assert!((10..35).contains(&open), "{open}");
}

properties! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn paths_are_the_sums_over_all_triangles(
        dents in proptest::collection::vec(-1.0..1.0f32, 1..40),
        [z_rot_deg, x_rot_deg, y_rot_deg] in proptest::array::uniform3(-180.0..180.0f64),
        [x_mm, y_mm] in proptest::array::uniform2(-8.0..8.0f64),
        radius in 0.0..60.0f64,
    ) {
        let (vertices, triangles) = fake::torus(&dents);
        let model = Model::from_triangles(&vertices, &triangles).expect("valid");
        let size = model.bounds().radius;
        let pose = Pose::from(EulerPose {
            x_mm, y_mm, z_mm: -20.0 * size, z_rot_deg, x_rot_deg, y_rot_deg
        });
        let middle = add(&pose.transform(&model.centre()), &[0.0; 3]);
        let middle = camera().project(&middle).expect("in front");
        let mut lines = lines_about([middle.column, middle.row], radius, 12);
        measured(&model, &pose, &mut lines);
        let (mut all, mut off) = (0, 0);
        for line in &lines {
            let Some(paths) = line.paths() else { continue };
            for (&path, ray) in paths.iter().zip(rays(line)) {
                let sum = through_triangles(&model, &pose, &ray);
                all += 1;
                // Vertices are rounded to 1/4096 pixel: at the outline a ray may pass by.
                off += usize::from((f64::from(path) - sum).abs() > 2e-3 * size);
            }
        }
        prop_assert!(all >= 11 * POINTS, "{} of {} places on closed lines", all, 12 * POINTS);
        prop_assert!(50 * off <= all, "{} of {}", off, all);
    }
}
