//! Where pixels, cameras and poses go.

use anyhow::Result;
use fluoropose::camera::Camera;
use fluoropose::camera::calibration::Calibration;
use fluoropose::math::{
    Matrix3, Vector3, add, apply, multiply, radians, scale, sin_cos, subtract, transpose,
};
use fluoropose::pose::Pose;

use super::plan::View;

/// How far behind the components a detector stands, where the film's calibration does not tell: parts of their distance.
const BEHIND: f64 = 1.15;

/// From a film's camera to that of its disguise.
pub struct Lens {
    from: Camera,
    /// The disguise's camera.
    pub to: Camera,
    /// Of directions, columns right and rows down.
    turn: [[f64; 2]; 2],
}

impl Lens {
    /// For components whose middle, as the film's camera sees them, lies at `middle` on the frame.
    ///
    /// # Errors
    /// For a camera that cannot be.
    pub fn new(view: &View, from: Camera, middle: Option<[f64; 2]>) -> Result<Self> {
        let (sine, cosine) = sin_cos(radians(view.turn_deg));
        let side = if view.mirrored { -1.0 } else { 1.0 };
        let turn = [[side * cosine, -sine], [side * sine, cosine]];
        let [fx, fy] = from.focal();
        // Pixels of another aspect have the same area.
        let (focal, root) = ((fx * fy).sqrt() * view.scale, view.aspect.sqrt());
        let focal = [focal * root, focal / root];
        let [width, height] = match view.size {
            [0, 0] => [from.width(), from.height()],
            size => size,
        };
        let origin = Camera::new(width, height, focal, [0.0; 2])?;
        let without = Self {
            from,
            to: origin,
            turn,
        };
        let own = [from.width(), from.height()].map(|side| side as f64 / 2.0);
        let (place, at) = match (view.middle, middle) {
            (Some(at), Some(middle)) => (middle, at),
            _ => (own, [0.5; 2]),
        };
        let there = without.forwards(place);
        let centre = [
            at[0] * width as f64 - there[0],
            at[1] * height as f64 - there[1],
        ];
        let to = Camera::new(width, height, focal, centre)?;
        Ok(Self { to, ..without })
    }

    /// Where a place of the film comes to lie.
    pub fn forwards(&self, place: [f64; 2]) -> [f64; 2] {
        let (f, p) = (self.from.focal(), self.from.principal_point());
        let way = [(place[0] - p[0]) / f[0], (place[1] - p[1]) / f[1]];
        let (f, p) = (self.to.focal(), self.to.principal_point());
        let along = |k: usize| self.turn[k][0] * way[0] + self.turn[k][1] * way[1];
        [p[0] + f[0] * along(0), p[1] + f[1] * along(1)]
    }

    /// Where a place of the disguise lay.
    pub fn backwards(&self, place: [f64; 2]) -> [f64; 2] {
        let (f, p) = (self.to.focal(), self.to.principal_point());
        let way = [(place[0] - p[0]) / f[0], (place[1] - p[1]) / f[1]];
        let (f, p) = (self.from.focal(), self.from.principal_point());
        // The opposite of a turn or reflection is its transpose.
        let along = |k: usize| self.turn[0][k] * way[0] + self.turn[1][k] * way[1];
        [p[0] + f[0] * along(0), p[1] + f[1] * along(1)]
    }

    /// Pixels of the disguise along one of the film.
    pub fn scale(&self) -> f64 {
        let area = |camera: &Camera| camera.focal()[0] * camera.focal()[1];
        (area(&self.to) / area(&self.from)).sqrt()
    }

    /// The same of directions before the camera, where y points up.
    fn of_camera(&self) -> Matrix3 {
        let [[a, b], [c, d]] = self.turn;
        [[a, -b, 0.0], [-c, d, 0.0], [0.0, 0.0, 1.0]]
    }

    /// The pose of a model in other axes, as the disguise's camera sees it, in the unit of the model's file.
    pub fn pose(&self, pose: &Pose, axes: &Axes) -> Pose {
        let camera = self.of_camera();
        let turned = multiply(&camera, &pose.rotation);
        let rotation = multiply(&turned, &transpose(&axes.turn));
        let place = apply(&camera, &pose.translation);
        let translation = subtract(&place, &apply(&rotation, &axes.origin));
        Pose {
            rotation,
            translation: scale(&translation, 1.0 / axes.unit_mm),
        }
    }

    /// The calibration's file for components so far away, mm.
    pub fn calibration(&self, view: &View, known: Option<f64>, away: f64) -> Calibration {
        let (size, focal) = ((self.to.width(), self.to.height()), self.to.focal());
        let centre = self.to.principal_point();
        if view.principal_distance && view.aspect == 1.0 {
            let distance = known.unwrap_or(BEHIND * away);
            let pitch = distance / focal[0];
            let [x, y] = [
                centre[0] - size.0 as f64 / 2.0,
                size.1 as f64 / 2.0 - centre[1],
            ];
            return Calibration::PrincipalDistance {
                distance,
                offset: [x * pitch, y * pitch],
                pitch,
            };
        }
        Calibration::CameraMatrix {
            size,
            focal,
            centre: centre.map(|at| at - 0.5),
            laboratory: None,
        }
    }
}

/// Axes of a model's file: a turn or reflection, an origin, and a unit.
pub struct Axes {
    /// From the old axes to them.
    pub turn: Matrix3,
    /// Where the old origin lies in them, mm.
    pub origin: Vector3,
    /// Millimetres of their unit.
    pub unit_mm: f64,
}

impl Axes {
    /// A vertex in these axes.
    pub fn vertex(&self, vertex: [f32; 3]) -> [f32; 3] {
        let place = add(&apply(&self.turn, &vertex.map(f64::from)), &self.origin);
        place.map(|value| (value / self.unit_mm) as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::super::plan::Plan;
    use super::*;

    #[test]
    fn what_is_turned_is_seen_where_its_pixel_went() {
        let from = Camera::new(640, 480, [2000.0, 2010.0], [300.5, 250.0]).unwrap();
        for seed in 0..200 {
            let mut view = Plan::drawn(seed, 10, (640, 480)).view;
            let lens = Lens::new(&view, from, Some([280.0, 260.0])).unwrap();
            let turn = fluoropose::math::rotation_by(&[0.1 * seed as f64, 1.0, -0.4]);
            let side = if view.mirrored { -1.0 } else { 1.0 };
            let axes = Axes {
                turn: turn.map(|[a, b, c]| [side * a, b, c]),
                origin: [30.0, -20.0, 110.0],
                unit_mm: if seed % 3 == 0 { 25.4 } else { 1.0 },
            };
            let rotation = fluoropose::math::rotation_by(&[0.3, -0.2 * seed as f64, 0.9]);
            let pose = Pose {
                rotation,
                translation: [15.0, -8.0, -1000.0],
            };
            let other = lens.pose(&pose, &axes);
            assert!(other.is_rigid(1e-9), "{seed}");
            for vertex in [[0.0, 0.0, 0.0], [30.0, 4.0, -9.0], [-8.0, 21.0, 35.0f32]] {
                let seen = from
                    .project(&pose.transform(&vertex.map(f64::from)))
                    .unwrap();
                let place = lens.forwards([seen.column, seen.row]);
                let back = lens.backwards(place);
                assert!((back[0] - seen.column).hypot(back[1] - seen.row) < 1e-9);
                let there = other.transform(&axes.vertex(vertex).map(f64::from));
                let there = lens.to.project(&there).unwrap();
                assert!(
                    (there.column - place[0]).hypot(there.row - place[1]) < 1e-3,
                    "{seed}"
                );
            }
            view.principal_distance = true;
            for view in [&view, &View::default()] {
                let lens = Lens::new(view, from, None).unwrap();
                let text = lens.calibration(view, None, 1000.0).to_string();
                let read = Calibration::parse(&text).unwrap();
                let camera = read.camera(lens.to.width(), lens.to.height()).unwrap();
                let near = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]) < 1e-6;
                assert!(near(camera.focal(), lens.to.focal()), "{text}");
                assert!(
                    near(camera.principal_point(), lens.to.principal_point()),
                    "{text}"
                );
            }
        }
    }
}
