//! Femoral components for both condyles, of many designs, in the field's axes: x anterior, y superior, z to the patient's right.

use crate::math::{radians, sin_cos};
use crate::mesh::edges::fake::{add_box, add_prism, ellipse};
use proptest::prelude::*;
use std::vec::Vec;

type Point = [f64; 2];

/// Sizes, mm. Seen from the side its condyles are arcs of three radii, and inside it has five cuts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Design {
    pub(super) radii: [f64; 3],
    pub(super) condyle: f64,
    pub(super) gap: f64,
    /// How high the flange reaches above the lowest point, and how much higher on the right than on the left.
    pub(super) flange: f64,
    pub(super) slant: f64,
    pub(super) has_box: bool,
    pub(super) has_pegs: bool,
    pub(super) stem: f64,
}

/// Without a stem.
pub(super) fn designs() -> impl Strategy<Value = Design> {
    let radii = (19.0..25.0f64, 34.0..50.0f64, 26.0..33.0f64).prop_map(<[f64; 3]>::from);
    let widths = (24.0..29.0f64, 17.0..22.0f64);
    let flange = (44.0..54.0f64, -9.0..9.0f64);
    (radii, widths, flange, any::<[bool; 2]>()).prop_map(
        |(radii, (condyle, gap), (flange, slant), [has_box, has_pegs])| Design {
            radii,
            condyle,
            gap,
            flange,
            slant,
            has_box,
            has_pegs,
            stem: 0.0,
        },
    )
}

#[derive(Default)]
pub(super) struct Parts {
    pub(super) vertices: Vec<[f32; 3]>,
    pub(super) triangles: Vec<[u32; 3]>,
}

impl Design {
    pub(super) fn parts(&self) -> Parts {
        let mut parts = Parts::default();
        for side in [-1.0, 1.0] {
            self.add_condyle(side, &mut parts);
        }
        self.add_flange(&mut parts);
        let Parts {
            vertices,
            triangles,
        } = &mut parts;
        let half = self.gap as f32 / 2.0;
        if self.has_box {
            for z in [-half, half] {
                let (low, high) = ([-23.0, 7.0, z - 1.0], [11.0, 27.0, z + 1.0]);
                add_box(low, high, vertices, triangles);
            }
            add_box(
                [-17.0, 25.0, -half],
                [11.0, 27.5, half],
                vertices,
                triangles,
            );
            add_box(
                [-26.0, 16.0, -half],
                [-18.0, 24.0, half],
                vertices,
                triangles,
            );
        }
        if self.has_pegs {
            for side in [-1.0, 1.0] {
                let z = side * (half + self.condyle as f32 * 0.45);
                add_prism(
                    &ellipse([-3.0, z], [3.5; 2]),
                    [8.0, 23.0],
                    vertices,
                    triangles,
                );
            }
        }
        if self.stem > 0.0 {
            let heights = [24.0, 24.0 + self.stem as f32];
            add_prism(
                &ellipse([-4.0, 0.0], [7.0; 2]),
                heights,
                vertices,
                triangles,
            );
        }
        parts
    }

    /// Where the arc in front begins, from below, and the middle of that arc.
    fn front(&self) -> (Point, Point) {
        let [_, distal, anterior] = self.radii;
        let begins = on([BACK, distal], distal, JOIN_DEG);
        (begins, on(begins, -anterior, JOIN_DEG))
    }

    /// From the tip of the condyles to the flange.
    fn profile(&self) -> Vec<Point> {
        let [posterior, distal, anterior] = self.radii;
        let (_, middle) = self.front();
        let arcs = [
            ([BACK, posterior], posterior, [150.0, 268.0], 22),
            ([BACK, distal], distal, [270.0, 360.0 + JOIN_DEG], 10),
            (middle, anterior, [360.0 + JOIN_DEG + 5.0, 364.0], 10),
        ];
        let points = arcs
            .into_iter()
            .flat_map(|(middle, radius, [from, to], count)| {
                (0..=count).map(move |k| {
                    on(
                        middle,
                        radius,
                        from + (to - from) * f64::from(k) / f64::from(count),
                    )
                })
            });
        points.collect()
    }

    /// The cut that lies behind a point of the profile.
    fn cut(&self, point: Point) -> Point {
        let (_, [x, y]) = self.front();
        let front = x + self.radii[2];
        let back = BACK - self.radii[0];
        let cuts = [
            ([back + 9.0, 0.0], 180.0),
            ([back + 14.0, 16.0], 225.0),
            ([0.0, 9.0], 270.0),
            ([front - 12.0, 13.0], 315.0),
            ([front - 7.0, y], 4.0),
        ];
        let way = [point[0] - INSIDE[0], point[1] - INSIDE[1]];
        let part = cuts.iter().fold(1.0f64, |part, &(at, normal_deg)| {
            let [nx, ny] = on([0.0; 2], 1.0, normal_deg);
            let speed = way[0] * nx + way[1] * ny;
            let off = (at[0] - INSIDE[0]) * nx + (at[1] - INSIDE[1]) * ny;
            if speed > 1e-9 {
                part.min(off / speed)
            } else {
                part
            }
        });
        core::array::from_fn(|k| INSIDE[k] + part * way[k])
    }

    fn add_condyle(&self, side: f64, parts: &mut Parts) {
        let half = self.condyle / 2.0 * if side < 0.0 { 1.0 } else { 0.95 };
        let middle = side * (self.gap / 2.0 + half);
        let rows = self.profile().into_iter().map(|point| {
            let cut = self.cut(point);
            let thick = [cut[0] - point[0], cut[1] - point[1]];
            let length = libm::hypot(thick[0], thick[1]);
            let row = ACROSS.map(|v| {
                let round = (4.5 * v * v / length).min(0.75);
                let [x, y] = core::array::from_fn(|k| point[k] + round * thick[k]);
                let z = middle + v * half;
                [[x, y, z], [cut[0], cut[1], z]]
            });
            row.to_vec()
        });
        parts.add_slab(&rows.collect::<Vec<_>>());
    }

    fn add_flange(&self, parts: &mut Parts) {
        let (_, [x, y]) = self.front();
        let radius = self.radii[2];
        let low = on([x, y], radius, -35.0)[1];
        let half = self.gap / 2.0 + self.condyle * 0.97;
        let rows = (0..=12).map(|step| {
            let t = f64::from(step) / 12.0;
            let row = ACROSS.map(|v| {
                let top = self.flange + self.slant * 0.5 * v - 7.0 * (v * v * v).abs();
                let height = low + (top - low) * t;
                let off = height - y;
                let outer = if off < 0.0 {
                    x + (radius * radius - off * off).sqrt()
                } else {
                    x + radius - 0.06 * off
                };
                let inner =
                    x + radius - 7.0 - 0.07 * off.max(0.0) - if off < 0.0 { 3.0 } else { 0.0 };
                let groove = 2.9 * (1.0 - (v / 0.4) * (v / 0.4)).max(0.0);
                let z = v * half * (1.0 - 0.22 * t);
                [
                    [(outer - groove).max(inner + 1.5), height, z],
                    [inner, height, z],
                ]
            });
            row.to_vec()
        });
        parts.add_slab(&rows.collect::<Vec<_>>());
    }
}

/// Where the middles of the two arcs behind lie, a point inside all cuts, and the direction in which the arc in front begins.
const BACK: f64 = -10.0;
const INSIDE: Point = [-4.0, 26.0];
const JOIN_DEG: f64 = -53.0;
/// Columns of a slab.
const ACROSS: [f64; 9] = [-1.0, -0.75, -0.5, -0.25, 0.0, 0.25, 0.5, 0.75, 1.0];

fn on([x, y]: Point, radius: f64, angle_deg: f64) -> Point {
    let (sin, cos) = sin_cos(radians(angle_deg));
    [x + radius * cos, y + radius * sin]
}

impl Parts {
    /// What lies between two grids, of whose nodes each has a point outside and one inside.
    fn add_slab(&mut self, rows: &[Vec<[[f64; 3]; 2]>]) {
        let first = self.vertices.len();
        let (rows_count, columns) = (rows.len(), rows[0].len());
        let points = rows.iter().flatten().flatten();
        self.vertices
            .extend(points.map(|point| point.map(|x| x as f32)));
        let node = |row: usize, column: usize, inside: usize| {
            (first + 2 * (row * columns + column) + inside) as u32
        };
        let mut quad = |[a, b, c, d]: [u32; 4]| self.triangles.extend([[a, b, c], [a, c, d]]);
        for row in 1..rows_count {
            for column in 1..columns {
                for inside in [0, 1] {
                    let at = |r: usize, c: usize| node(row - r, column - c, inside);
                    quad([at(1, 1), at(1, 0), at(0, 0), at(0, 1)]);
                }
            }
            for column in [0, columns - 1] {
                let at = |r: usize, inside: usize| node(row - r, column, inside);
                quad([at(1, 0), at(0, 0), at(0, 1), at(1, 1)]);
            }
        }
        for column in 1..columns {
            for row in [0, rows_count - 1] {
                let at = |c: usize, inside: usize| node(row, column - c, inside);
                quad([at(1, 0), at(0, 0), at(0, 1), at(1, 1)]);
            }
        }
    }
}
