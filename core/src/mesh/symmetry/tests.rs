use super::*;
use crate::math::{apply, radians, subtract};
use crate::mesh::edges::fake::placed_within;
use crate::pose::Pose;
use proptest::prelude::*;
use std::vec::Vec as List;

/// A mesh that owns its lists.
#[derive(Clone)]
struct Body {
    vertices: List<[f32; 3]>,
    triangles: List<[u32; 3]>,
}

impl Body {
    fn planes(&self) -> Vec<SymmetryPlane, PLANES> {
        symmetry_planes(&Mesh::new(&self.vertices, &self.triangles).expect("a valid body"))
    }

    fn moved(mut self, pose: &Pose) -> Self {
        for vertex in &mut self.vertices {
            *vertex = pose.transform(&vertex.map(f64::from)).map(|x| x as f32);
        }
        self
    }

    fn joined(mut self, other: Self) -> Self {
        let first = self.vertices.len() as u32;
        let shifted = other.triangles.iter().map(|t| t.map(|v| v + first));
        self.triangles.extend(shifted);
        self.vertices.extend(other.vertices);
        self
    }

    /// Each triangle that `pick` accepts in four.
    fn divided(mut self, pick: impl Fn(&Vector3) -> bool) -> Self {
        let old = core::mem::take(&mut self.triangles);
        for [a, b, c] in old {
            let corner = |v: u32| self.vertices[v as usize].map(f64::from);
            if !pick(&corner(a)) {
                self.triangles.push([a, b, c]);
                continue;
            }
            let mut middle = |a: u32, b: u32| {
                let (a, b) = (self.vertices[a as usize], self.vertices[b as usize]);
                self.vertices
                    .push(core::array::from_fn(|k| (a[k] + b[k]) / 2.0));
                self.vertices.len() as u32 - 1
            };
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            self.triangles
                .extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        self
    }
}

/// A box between two corners: 12 triangles.
fn cuboid(low: [f64; 3], high: [f64; 3]) -> Body {
    let corner = |number: usize| {
        core::array::from_fn(|k| if number >> k & 1 == 1 { high[k] } else { low[k] } as f32)
    };
    let sides = [
        [0, 1, 3, 2],
        [4, 6, 7, 5],
        [0, 4, 5, 1],
        [2, 3, 7, 6],
        [0, 2, 6, 4],
        [1, 5, 7, 3],
    ];
    Body {
        vertices: (0..8).map(corner).collect(),
        triangles: sides
            .iter()
            .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
            .collect(),
    }
}

/// A closed body round the origin: its radius in the direction with the cosines `x`, `y`, `z`.
fn star(radius: impl Fn(f64, f64, f64) -> f64) -> Body {
    const ROUND: u32 = 36;
    const DOWN: u32 = 18;
    let mut vertices = List::new();
    for row in 0..=DOWN {
        for column in 0..ROUND {
            let (s, c) = sin_cos(radians(180.0 * f64::from(row) / f64::from(DOWN)));
            let (sine, cosine) = sin_cos(radians(360.0 * f64::from(column) / f64::from(ROUND)));
            let [x, y, z] = [s * cosine, c, s * sine];
            vertices.push([x, y, z].map(|k| (k * radius(x, y, z)) as f32));
        }
    }
    let at = |row: u32, column: u32| row * ROUND + column % ROUND;
    let triangles = (0..DOWN).flat_map(|row| {
        (0..ROUND).flat_map(move |column| {
            let (a, b) = (at(row, column), at(row, column + 1));
            let (c, d) = (at(row + 1, column), at(row + 1, column + 1));
            [[a, b, c], [b, d, c]]
        })
    });
    Body {
        vertices,
        triangles: triangles.collect(),
    }
}

/// A plate with a keel and a stem that leans back: symmetric in z alone, as a tibial tray is.
fn tray() -> Body {
    cuboid([-20.0, -2.0, -32.0], [24.0, 2.0, 32.0])
        .joined(cuboid([-20.0, 2.0, -9.0], [-14.0, 9.0, 9.0]))
        .joined(cuboid([-9.0, -38.0, -6.0], [1.0, -2.0, 6.0]))
        .joined(cuboid([-14.0, -18.0, -18.0], [-9.0, -2.0, 18.0]))
}

/// A tray with a tower on one side.
fn lopsided() -> Body {
    tray().joined(cuboid([2.0, -1.0, 12.0], [20.0, 40.0, 30.0]))
}

/// Angle between the normal of a plane and a direction of the body before `pose`, degrees.
fn off_deg(plane: &SymmetryPlane, pose: &Pose, direction: &Vector3) -> f64 {
    let direction = apply(&pose.rotation, direction);
    let sine = norm(&crate::math::cross(&plane.normal, &direction));
    crate::math::degrees(crate::math::asin(sine))
}

/// Distance of a point of the body before `pose` from a plane, mm.
fn distance(plane: &SymmetryPlane, pose: &Pose, point: &Vector3) -> f64 {
    let point = pose.transform(point);
    (dot(&plane.normal, &point) - dot(&plane.normal, &plane.point)).abs()
}

properties! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn a_box_has_three_planes_wherever_it_is(pose in placed_within(400.0)) {
        let planes = cuboid([-30.0, -14.0, -20.0], [30.0, 14.0, 20.0]).moved(&pose).planes();
        prop_assert_eq!(planes.len(), 3);
        for axis in crate::math::IDENTITY {
            let plane = planes.iter().min_by(|a, b| {
                off_deg(a, &pose, &axis).total_cmp(&off_deg(b, &pose, &axis))
            }).expect("three");
            prop_assert!(off_deg(plane, &pose, &axis) < 0.02);
            prop_assert!(distance(plane, &pose, &[0.0; 3]) < 0.01);
            prop_assert!(plane.deviation_mm < 0.01);
        }
    }

    #[test]
    fn a_cube_has_three_perpendicular_planes(pose in placed_within(400.0)) {
        let planes = cuboid([-20.0; 3], [20.0; 3]).moved(&pose).planes();
        prop_assert_eq!(planes.len(), 3);
        for (k, a) in planes.iter().enumerate() {
            prop_assert!(a.deviation_mm < 0.01, "{:?}", planes);
            prop_assert!(distance(a, &pose, &[0.0; 3]) < 0.01);
            for b in &planes[..k] {
                prop_assert!(dot(&a.normal, &b.normal).abs() < 1e-3, "{:?}", planes);
            }
        }
    }

    #[test]
    fn a_body_of_revolution_has_its_equator_and_two_meridians(pose in placed_within(400.0)) {
        let egg = star(|_, y, _| 30.0 - 12.0 * y * y).moved(&pose);
        let planes = egg.planes();
        prop_assert_eq!(planes.len(), 3);
        let equators = planes.iter().filter(|p| off_deg(p, &pose, &[0.0, 1.0, 0.0]) < 0.5);
        let meridians = planes.iter().filter(|p| off_deg(p, &pose, &[0.0, 1.0, 0.0]) > 89.5);
        prop_assert_eq!((equators.count(), meridians.count()), (1, 2));
        // The body is drawn with flat facets, so not every meridian is exact.
        prop_assert!(planes.iter().all(|p| p.deviation_mm < 0.2), "{:?}", planes);
    }

    /// Wherever it is, and however coarse it is; a ball about any axis, and what has a peg or is only many-sided about none.
    #[test]
    fn a_body_of_revolution_is_round_about_its_axis(pose in placed_within(400.0)) {
        let round = |body: Body| {
            let body = body.moved(&pose);
            revolution(&Mesh::new(&body.vertices, &body.triangles).expect("a valid body"))
        };
        let egg = round(star(|_, y, _| 30.0 - 12.0 * y * y)).expect("round");
        let axis = crate::math::apply(&pose.rotation, &[0.0, 1.0, 0.0]);
        prop_assert!(!egg.is_ball && egg.directions().len() == 1);
        prop_assert!(dot(&egg.directions()[0], &axis).abs() > 0.9999);
        let off = subtract(&egg.point, &pose.translation);
        prop_assert!(norm(&subtract(&off, &scale(&axis, dot(&off, &axis)))) < 0.1);
        prop_assert!(round(star(|_, _, _| 30.0)).is_some_and(|ball| ball.is_ball && ball.directions().len() == 3));
        let flower = |petals: f64| star(move |x, y, z| {
            30.0 - 12.0 * y * y + 2.0 * (1.0 - y * y) * libm::cos(petals * libm::atan2(z, x))
        });
        for petals in [1.0, 2.0, 3.0, 6.0, 9.0] {
            prop_assert_eq!(round(flower(petals)), None, "{}", petals);
        }
        let peg = cuboid([12.0, -30.0, -3.0], [18.0, -8.0, 3.0]);
        prop_assert_eq!(round(star(|_, y, _| 30.0 - 12.0 * y * y).joined(peg)), None);
        for body in [tray(), lopsided(), cuboid([-20.0; 3], [20.0; 3])] {
            prop_assert_eq!(round(body), None);
        }
    }

    #[test]
    fn a_tray_has_its_mediolateral_plane_alone(pose in placed_within(400.0)) {
        let planes = tray().moved(&pose).planes();
        prop_assert_eq!(planes.len(), 1, "{:?}", planes);
        prop_assert!(off_deg(&planes[0], &pose, &[0.0, 0.0, 1.0]) < 0.02);
        prop_assert!(distance(&planes[0], &pose, &[0.0; 3]) < 0.01);
        prop_assert!(planes[0].deviation_mm < 0.01);
    }

    #[test]
    fn a_body_without_symmetry_has_no_plane(pose in placed_within(400.0)) {
        prop_assert_eq!(lopsided().moved(&pose).planes().len(), 0);
    }

    #[test]
    fn planes_of_a_near_symmetry_move_with_the_body(pose in placed_within(400.0)) {
        let uneven = || tray().joined(cuboid([0.0, 2.0, 18.0], [10.0, 6.0, 30.0]));
        let (here, there) = (uneven().planes(), uneven().moved(&pose).planes());
        prop_assert_eq!((here.len(), there.len()), (1, 1));
        prop_assert!(here[0].deviation_mm > 0.3);
        prop_assert!((here[0].deviation_mm - there[0].deviation_mm).abs() < 0.01);
        prop_assert!(off_deg(&there[0], &pose, &here[0].normal) < 0.1);
        prop_assert!(distance(&there[0], &pose, &here[0].point) < 0.02);
    }

    #[test]
    fn what_is_symmetric_by_making_is_found_so(
        even in prop::array::uniform5(-4.0..4.0f64), length in 1.4..1.8f64, pose in placed_within(400.0)
    ) {
        let radius = |x: f64, y: f64, z: f64| {
            let [a, b, c, d, e] = even;
            let bumps = a * x * y + b * x * x * x + c * y * z * z + d * x + e * y * y * y;
            (26.0 + bumps) / (1.0 - 0.4 * y * y + (length - 1.0) * x * x)
        };
        let planes = star(radius).moved(&pose).planes();
        let exact = planes.iter().find(|p| off_deg(p, &pose, &[0.0, 0.0, 1.0]) < 0.1);
        // The facets' diagonals are no mirror images of each other.
        prop_assert!(exact.is_some_and(|p| p.deviation_mm < 0.1), "{:?}", planes);
    }

    #[test]
    fn any_mesh_is_looked_at_without_complaint(
        vertices in prop::collection::vec(prop::array::uniform3(-50.0f32..50.0), 3..20),
        picks in prop::collection::vec(prop::array::uniform3(0usize..1000), 1..30)
    ) {
        let count = vertices.len();
        let triangles: List<_> = picks.iter().map(|t| t.map(|v| (v % count) as u32)).collect();
        let body = Body { vertices, triangles };
        for plane in body.planes() {
            prop_assert!((norm(&plane.normal) - 1.0).abs() < 1e-12);
            prop_assert!(plane.deviation_mm.is_finite() && plane.point.iter().all(|x| x.is_finite()));
        }
    }
}

properties! {
    #![proptest_config(ProptestConfig::with_cases(5))]

    /// From hundredths of a millimetre to metres: to the last bit, because all are powers of two.
    #[test]
    fn units_do_not_matter(pose in placed_within(40.0), bump in 0.0..20.0f64, power in prop_oneof![-12..-3i32, 3..6i32]) {
        let times = libm::exp2(f64::from(power));
        let scaled = |mut body: Body| {
            body.vertices.iter_mut().flatten().for_each(|x| *x *= times as f32);
            body
        };
        for body in [
            tray().joined(cuboid([2.0, 2.0, 14.0], [16.0, 2.0 + bump, 28.0])),
            star(|x, y, z| (26.0 + bump * x * y * z) / (1.0 - 0.4 * y * y + 0.6 * x * x)),
            star(|_, y, _| 30.0 - 12.0 * y * y),
            cuboid([-20.0; 3], [20.0; 3]),
        ] {
            let body = body.moved(&pose);
            let round = |body: &Body| revolution(&Mesh::new(&body.vertices, &body.triangles).expect("a valid body"));
            let (planes, is_round) = (body.planes(), round(&body).is_some());
            let body = scaled(body);
            let expected: Vec<_, PLANES> = planes
                .iter()
                .map(|plane| SymmetryPlane {
                    point: scale(&plane.point, times),
                    deviation_mm: plane.deviation_mm * times,
                    ..*plane
                })
                .collect();
            prop_assert_eq!(body.planes(), expected);
            prop_assert_eq!(round(&body).is_some(), is_round);
        }
    }

    /// By rising deviation, each once, and with its largest component positive.
    #[test]
    fn planes_are_told_in_one_way(pose in placed_within(400.0), sides in prop::array::uniform3(8.0..40.0f64)) {
        for body in [cuboid(sides.map(|x| -x), sides), star(|_, y, _| 30.0 - 12.0 * y * y), tray()] {
            let planes = body.moved(&pose).planes();
            prop_assert!(!planes.is_empty() && planes.is_sorted_by(|a, b| a.deviation_mm <= b.deviation_mm));
            for (k, plane) in planes.iter().enumerate() {
                let most = plane.normal.iter().fold(0.0f64, |most, x| most.max(x.abs()));
                prop_assert!(plane.normal.contains(&most), "{:?}", plane);
                for other in &planes[..k] {
                    prop_assert!(dot(&plane.normal, &other.normal).abs() < cosine(SAME_DEG));
                }
            }
        }
    }
}

#[test]
fn a_bump_that_grows_makes_a_part_less_symmetric_and_then_asymmetric() {
    let mut before = tray().planes()[0].deviation_mm;
    for height in [1.0, 2.0, 4.0, 6.0] {
        let bump = cuboid([2.0, 2.0, 14.0], [16.0, 2.0 + height, 28.0]);
        let planes = tray().joined(bump).planes();
        assert_eq!(planes.len(), 1);
        assert!(planes[0].deviation_mm > before + 0.05, "{planes:?}");
        before = planes[0].deviation_mm;
    }
    // As a scan leaves it that did not reach one end of the plate.
    let half = cuboid([-20.0, -2.0, -32.0], [24.0, 2.0, 14.0])
        .joined(cuboid([-9.0, -38.0, -6.0], [1.0, -2.0, 6.0]))
        .joined(cuboid([-14.0, -18.0, -18.0], [-9.0, -2.0, 18.0]));
    let planes = half.planes();
    let mesh = Mesh::new(&half.vertices, &half.triangles).expect("a valid body");
    let size = Samples::new(&mesh).expect("it has an area").size;
    assert!(
        planes
            .first()
            .is_some_and(|p| p.deviation_mm > NEARLY_SYMMETRIC * size)
    );
    assert!(
        planes.iter().any(|p| p.normal[2] > 0.95),
        "its own is among them: {planes:?}"
    );
}

#[test]
fn density_winding_and_holes_do_not_matter() {
    let mut body = tray();
    for _ in 0..3 {
        body = body.divided(|corner| corner[2] > 0.0);
    }
    for (number, triangle) in body.triangles.iter_mut().enumerate() {
        if number % 3 == 0 {
            triangle.swap(0, 1);
        }
    }
    let mut number = 0;
    body.triangles.retain(|_| {
        number += 1;
        number % 97 != 0
    });
    let planes = body.planes();
    assert_eq!(planes.len(), 1);
    assert!(off_deg(&planes[0], &Pose::IDENTITY, &[0.0, 0.0, 1.0]) < 0.5);
    assert!(planes[0].deviation_mm < 0.3, "{planes:?}");
}

#[test]
fn an_origin_far_away_costs_no_digits_but_those_of_its_vertices() {
    let far = Pose {
        translation: [9000.0, -9000.0, 5000.0],
        ..Pose::IDENTITY
    };
    let planes = tray().moved(&far).planes();
    assert_eq!(planes.len(), 1);
    assert!(off_deg(&planes[0], &far, &[0.0, 0.0, 1.0]) < 0.02);
    assert!(planes[0].deviation_mm < 0.01);
}

#[test]
fn a_mesh_without_area_has_no_plane() {
    let line = Body {
        vertices: [[0.0; 3], [1.0, 0.0, 0.0], [3.0, 0.0, 0.0]].to_vec(),
        triangles: [[0, 1, 2], [0, 0, 1]].to_vec(),
    };
    assert_eq!(line.planes().len(), 0);
}

#[test]
fn a_reflection_undoes_itself_and_keeps_the_plane() {
    let plane = tray().planes()[0];
    let point = [3.0, -4.0, 7.0];
    let image = plane.reflect(&point);
    assert!((image[2] + 7.0).abs() < 1e-3);
    let back = plane.reflect(&image);
    assert!(norm(&subtract(&back, &point)) < 1e-12);
    assert_eq!(plane.reflect(&plane.point), plane.point);
}

/// `spread` in place of its own.
fn samples(spread: [f64; 3]) -> Samples {
    let body = tray();
    let mesh = Mesh::new(&body.vertices, &body.triangles).expect("a valid body");
    let samples = Samples::new(&mesh).expect("it has an area");
    Samples { spread, ..samples }
}

#[test]
fn directions_between_axes_are_tried_where_their_moments_are_nearly_equal() {
    let pairs = [(0, 1), (1, 2), (0, 2)];
    for (spread, expected) in [
        ([10.0, 5.9, 3.5], [false, false, false]),
        ([10.0, 6.1, 3.6], [true, false, false]),
        ([10.0, 5.9, 3.6], [false, true, false]),
        ([10.0, 7.0, 5.0], [true, true, false]),
        ([10.0, 7.0, 6.1], [true, true, true]),
    ] {
        let samples = samples(spread);
        let starts = starts(&samples);
        assert_eq!(starts[..3], samples.axes);
        // By their parts along the axes: between two of them the third is none.
        let parts = |start: &Vector3| samples.axes.map(|axis| dot(&axis, start));
        let others: List<Vector3> = starts[3..].iter().map(parts).collect();
        for ((a, b), expected) in pairs.into_iter().zip(expected) {
            let between = others.iter().filter(|parts| {
                let length = parts[a] * parts[a] + parts[b] * parts[b];
                (length - 1.0).abs() < 1e-9
            });
            let mut angles: List<f64> = between
                .map(|parts| crate::math::degrees(crate::math::atan2(parts[b], parts[a])))
                .collect();
            angles.sort_by(f64::total_cmp);
            assert_eq!(angles.len(), if expected { 6 } else { 0 }, "{spread:?}");
            let eighths = [1.0, 2.0, 3.0, 5.0, 6.0, 7.0].map(|k| 22.5 * k);
            let off = angles.iter().zip(eighths).map(|(a, b)| (a - b).abs());
            assert!(off.into_iter().all(|off| off < 1e-9), "{angles:?}");
        }
        // Diagonals of a body whose three moments are nearly equal, each with its opposite once.
        let third = 1.0 / crate::math::sqrt(3.0);
        let diagonals: List<&Vector3> = others
            .iter()
            .filter(|parts| parts.iter().all(|part| (part.abs() - third).abs() < 1e-9))
            .collect();
        assert_eq!(diagonals.len(), if expected[2] { 4 } else { 0 });
        for (k, a) in diagonals.iter().enumerate() {
            assert!(diagonals[..k].iter().all(|b| dot(a, b).abs() < 0.5));
        }
    }
}

#[test]
fn tangents_are_perpendicular_to_a_normal_and_to_each_other() {
    let ways = [-1.0, -1e-9, 0.0, 1e-9, 0.4, 1.0];
    let normals = ways
        .into_iter()
        .flat_map(|x| ways.map(|y| [x, y]))
        .flat_map(|[x, y]| ways.map(|z| [x, y, z]));
    for normal in normals.filter(|normal| norm(normal) > 0.1) {
        let normal = scale(&normal, 1.0 / norm(&normal));
        let (first, second) = fit::tangents(&normal);
        for (a, b, product) in [
            (&first, &first, 1.0),
            (&second, &second, 1.0),
            (&first, &second, 0.0),
            (&first, &normal, 0.0),
            (&second, &normal, 0.0),
        ] {
            assert!((dot(a, b) - product).abs() < 1e-12, "{normal:?}");
        }
    }
}

#[test]
fn a_part_is_nearly_symmetric_where_one_of_its_planes_deviates_by_less_than_a_hundredth_of_its_radius()
 {
    let body = cuboid([-30.0, -20.0, -60.0], [30.0, 20.0, 60.0]);
    let model = Model::from_triangles(&body.vertices, &body.triangles).expect("a valid body");
    let plane = |deviation_mm: f64| SymmetryPlane {
        point: [0.0; 3],
        normal: [1.0, 0.0, 0.0],
        deviation_mm,
    };
    // Its corners are 70 mm from its middle.
    let (below, above) = (plane(0.6999), plane(0.7001));
    assert!(!is_nearly_symmetric(&model, &[]));
    assert!(!is_nearly_symmetric(&model, &[above, plane(5.0)]));
    assert!(is_nearly_symmetric(&model, &[below]));
    assert!(is_nearly_symmetric(&model, &[above, below]));
}
