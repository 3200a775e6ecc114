//! The plate of a tray: its plane and its extent, from the mesh.

use crate::joint::kinematics::Side;
use crate::math::eigen::eigen_symmetric;
use crate::math::{
    Matrix3, Vector3, atan2, cross, dot, floor, norm, scale, sin_cos, subtract, wrap,
};
use crate::mesh::Mesh;
use crate::pose::Pose;

/// Faces belong to the plate whose normals lie within this of the superior axis: a file's own axes may be 10 degrees off.
const NEAR_UP: f64 = 0.94;
/// And those of its upper side lie within this of the plate's normal: 2.6 degrees, so that rounded borders do not count.
const FLAT: f64 = 0.999;
/// Levels at which surface is counted.
const LEVELS: usize = 256;
/// The plate's upper side is the uppermost level that has at least this part of the largest one's area: the underside has as
/// much area, and a rim above has less.
const AS_LARGE: f64 = 0.5;
/// The part of the tray's height, from the plate down, whose border is the plate's.
const PLATE_PART: f64 = 0.12;

/// The plate of a tray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plate {
    /// `plate_from_tibia`, from the joint axes of the tibial component
    /// ([`super::kinematics::joint_axes`]): y along the normal, upwards; x and z as in
    /// the joint axes; the origin on the plate's upper side, in the middle of its extent.
    pub from_tibia: Pose,
    /// Anterior-posterior extent, mm.
    pub depth_mm: f64,
    /// Mediolateral extent, mm.
    pub width_mm: f64,
    /// Whose knee it is.
    pub side: Side,
    /// What lies higher than this below the upper side, mm, is the plate.
    thickness_mm: f64,
}

impl Plate {
    /// The plate of a tray in its joint axes (`model_from_joint`). `None` where no part of its surface faces upwards.
    #[must_use]
    pub fn of(mesh: &Mesh<'_>, axes: &Pose, side: Side) -> Option<Self> {
        let axis = |k: usize| axes.rotation.map(|row| row[k]);
        let up = normal(mesh, &axis(1))?;
        let along = subtract(&axis(0), &scale(&up, dot(&axis(0), &up)));
        let along = scale(&along, 1.0 / norm(&along));
        let rows = [along, up, cross(&along, &up)];
        let level = upper_side(mesh, &up)?;
        let (low, high) = reach(mesh, &up, f64::NEG_INFINITY, &up);
        let from = level - PLATE_PART * (high - low);
        let (back, front) = reach(mesh, &rows[0], from, &up);
        let (left, right) = reach(mesh, &rows[2], from, &up);
        let plate_from_model = Pose {
            rotation: rows,
            translation: [-(back + front) / 2.0, -level, -(left + right) / 2.0],
        };
        Some(Self {
            from_tibia: plate_from_model.compose(axes),
            depth_mm: front - back,
            width_mm: right - left,
            side,
            thickness_mm: level - from,
        })
    }

    /// The plate's border as seen from above: points in equal directions from its middle (anterior, then towards medial), each as
    /// anterior and medial place, mm. Of the tray's mesh and axes that [`Self::of`] had. A direction without border has NaN.
    pub fn outline(&self, mesh: &Mesh<'_>, axes: &Pose, outline: &mut [[f64; 2]]) {
        if outline.is_empty() {
            return;
        }
        outline.fill([f64::NAN; 2]);
        let from_model = self.from_tibia.compose(&axes.inverse());
        for face in corners(mesh) {
            let face = face.map(|corner| from_model.transform(&corner));
            for k in 0..3 {
                let edge = [face[k], face[(k + 1) % 3]];
                if edge.iter().all(|end| end[1] >= -self.thickness_mm) {
                    let edge = edge.map(|[x, _, z]| [self.side.forward() * x, z]);
                    widen(outline, edge);
                }
            }
        }
    }

    /// A point in percent of the plate's depth: 0 at its posterior border, 100 at its anterior one.
    #[must_use]
    pub fn percent(&self, anterior_mm: f64) -> f64 {
        50.0 + 100.0 * anterior_mm / self.depth_mm
    }
}

/// Moves those points of an outline outwards that lie within an edge.
fn widen(outline: &mut [[f64; 2]], [a, b]: [[f64; 2]; 2]) {
    let step = core::f64::consts::TAU / outline.len() as f64;
    let turn = |point: [f64; 2]| atan2(point[1], point[0]);
    let half = core::f64::consts::PI;
    let range = wrap(turn(b) - turn(a), 2.0 * half);
    let (first, range) = match range < 0.0 {
        true => (turn(b), -range),
        false => (turn(a), range),
    };
    let from = -floor(-first / step) as i64;
    let to = floor((first + range) / step) as i64;
    for k in from..=to {
        let (sin, cos) = sin_cos(k as f64 * step);
        // a + t (b - a) along (cos, sin).
        let across = |point: [f64; 2]| point[1] * cos - point[0] * sin;
        let t = across(a) / (across(a) - across(b));
        let along = |point: [f64; 2]| point[0] * cos + point[1] * sin;
        let far = along(a) + t * (along(b) - along(a));
        let at = &mut outline[k.rem_euclid(outline.len() as i64) as usize];
        let known = at[0] * cos + at[1] * sin;
        if far.is_finite() && (known.is_nan() || known < far) {
            *at = [far * cos, far * sin];
        }
    }
}

fn corners(mesh: &Mesh<'_>) -> impl Iterator<Item = [Vector3; 3]> {
    let vertices = mesh.vertices();
    let corner = |vertex: u32| vertices[vertex as usize].map(f64::from);
    mesh.triangles()
        .iter()
        .map(move |triangle| triangle.map(corner))
}

fn doubled_normal([a, b, c]: &[Vector3; 3]) -> Vector3 {
    cross(&subtract(b, a), &subtract(c, a))
}

/// The direction that most of the surface near `up` faces.
fn normal(mesh: &Mesh<'_>, up: &Vector3) -> Option<Vector3> {
    let mut tensor: Matrix3 = [[0.0; 3]; 3];
    for face in corners(mesh) {
        let doubled = doubled_normal(&face);
        let area = norm(&doubled);
        if area > 0.0 && dot(&doubled, up).abs() > NEAR_UP * area {
            for (row, &x) in tensor.iter_mut().zip(&doubled) {
                for (sum, &y) in row.iter_mut().zip(&doubled) {
                    *sum += x * y / area;
                }
            }
        }
    }
    let ([largest, ..], [axis, ..]) = eigen_symmetric(&tensor);
    let sign = if dot(&axis, up) < 0.0 { -1.0 } else { 1.0 };
    (largest > 0.0).then(|| scale(&axis, sign))
}

/// How high the plate's upper side lies along its normal: the mean of the faces of its level, by area.
fn upper_side(mesh: &Mesh<'_>, up: &Vector3) -> Option<f64> {
    let (low, high) = reach(mesh, up, f64::NEG_INFINITY, up);
    let step = (high - low) / LEVELS as f64;
    let (mut areas, mut moments) = ([0.0; LEVELS], [0.0; LEVELS]);
    for face in corners(mesh) {
        let doubled = doubled_normal(&face);
        let area = norm(&doubled);
        if dot(&doubled, up).abs() > FLAT * area {
            let height = face.iter().map(|corner| dot(corner, up)).sum::<f64>() / 3.0;
            let level = (floor((height - low) / step) as usize).min(LEVELS - 1);
            areas[level] += area;
            moments[level] += area * height;
        }
    }
    // A level's faces may fall to either side of a border between two.
    let pair = |level: usize| areas[level] + areas.get(level + 1).unwrap_or(&0.0);
    let largest = (0..LEVELS).map(pair).fold(0.0, f64::max);
    let level = (0..LEVELS)
        .rev()
        .find(|&level| areas[level] > 0.0 && pair(level) >= AS_LARGE * largest)?;
    let moment = moments[level] + moments.get(level + 1).unwrap_or(&0.0);
    Some(moment / pair(level))
}

/// How far the vertices that lie above `from` along `up` reach along an axis.
fn reach(mesh: &Mesh<'_>, axis: &Vector3, from: f64, up: &Vector3) -> (f64, f64) {
    let vertices = mesh.vertices().iter().map(|vertex| vertex.map(f64::from));
    let high = vertices.filter(|vertex| dot(vertex, up) >= from);
    high.fold(
        (f64::INFINITY, f64::NEG_INFINITY),
        |(least, most), vertex| {
            let along = dot(&vertex, axis);
            (least.min(along), most.max(along))
        },
    )
}

#[cfg(test)]
mod tests;
