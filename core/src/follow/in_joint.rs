//! Where a component is to be expected beside the other one of its joint.
//!
//! A knee bends about one axis, and its components touch but for the insert between them. So one of them known leaves of the other's six
//! numbers one that is really open, how far the knee is bent, and five that are known to some degrees and millimetres.

use heapless::Vec;

use crate::math::{
    Matrix3, Vector3, add, apply, dot, multiply, radians, scale, sin_cos, subtract, transpose,
};
use crate::mesh::Mesh;
use crate::mesh::anatomy::{AnatomicalAxes, KneeComponent};
use crate::pose::Pose;

/// Bends that are expected, in steps of so many degrees from straight on.
pub const BENDS: usize = 8;
const BEND_DEG: f64 = 18.0;
/// Thickness of an insert, mm: 6 to 20, most of them near the lower end.
const INSERT_MM: f64 = 10.0;
/// What lies no deeper than this under the point that reaches farthest has a part in where components touch, mm.
const TOUCHING_MM: f64 = 1.0;

/// Where one component leaves the other one of its joint, for some bends of the knee.
#[derive(Clone, Debug)]
pub struct InJoint {
    places: Vec<Place, BENDS>,
}

/// Where the component that is sought is for one bend.
#[derive(Clone, Copy, Debug)]
struct Place {
    /// `camera_from_field`.
    rotation: Matrix3,
    /// Where it touches the insert, mm in the camera's frame, and the direction from it to there.
    touching: Vector3,
    towards: Vector3,
}

/// A component of a joint, as its shape tells it.
#[derive(Clone, Copy, Debug)]
pub struct Limb<'m> {
    /// Its surface.
    pub mesh: Mesh<'m>,
    /// Which one it is.
    pub component: KneeComponent,
    /// Its anatomical axes.
    pub axes: AnatomicalAxes,
}

impl InJoint {
    /// Where a component whose pose is known (`camera_from_model`) leaves the other one.
    #[must_use]
    pub fn beside(known: &Limb<'_>, pose: &Pose) -> Self {
        let field = pose.compose(&known.axes.model_from_field).rotation;
        // Of the other one against this one.
        let sign = towards(known.component);
        let place = |bend: usize| {
            let (sin, cos) = sin_cos(radians(sign * BEND_DEG * bend as f64));
            let turn = [[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]];
            let rotation = multiply(&field, &turn);
            let tibia = match known.component {
                KneeComponent::Femur => rotation,
                KneeComponent::Tibia => field,
            };
            let towards = scale(&transpose(&tibia)[1], sign);
            let touching = known.touching(&apply(&transpose(&pose.rotation), &towards));
            let touching = pose.transform(&touching);
            Place {
                rotation,
                touching: add(&touching, &scale(&towards, INSERT_MM)),
                towards: scale(&towards, -1.0),
            }
        };
        Self {
            places: (0..BENDS).map(place).collect(),
        }
    }

    /// Poses of the other component, straight to bent: two of each bend where its shape does not tell front from back.
    pub fn poses<'p>(&'p self, sought: &'p Limb<'_>) -> impl Iterator<Item = Pose> + 'p {
        let turns = match sought.axes.front_is_known {
            true => 1,
            false => 2,
        };
        self.places.iter().flat_map(move |place| {
            (0..turns).map(move |turn| {
                let sign = 1.0 - 2.0 * f64::from(turn);
                let turned = place.rotation.map(|[x, y, z]| [sign * x, y, sign * z]);
                sought.at(&Place {
                    rotation: turned,
                    ..*place
                })
            })
        })
    }
}

/// Towards its joint along the tibia: downwards from a femur.
fn towards(component: KneeComponent) -> f64 {
    match component {
        KneeComponent::Femur => -1.0,
        KneeComponent::Tibia => 1.0,
    }
}

impl Limb<'_> {
    /// The middle of what reaches farthest in a direction of length one, model coordinates: between both condyles where one alone
    /// does.
    fn touching(&self, direction: &Vector3) -> Vector3 {
        let vertices = || {
            self.mesh
                .vertices()
                .iter()
                .map(|vertex| vertex.map(f64::from))
        };
        let reach = vertices().map(|vertex| dot(&vertex, direction));
        let far = reach.fold(f64::NEG_INFINITY, f64::max);
        let near = vertices().filter(|vertex| dot(vertex, direction) >= far - TOUCHING_MM);
        let (sum, count) = near.fold(([0.0; 3], 0.0), |(sum, count), vertex| {
            (add(&sum, &vertex), count + 1.0)
        });
        let touching = scale(&sum, 1.0 / f64::max(count, 1.0));
        let across = transpose(&self.axes.model_from_field.rotation)[2];
        let off = dot(&subtract(&self.mesh.bounds().centre, &touching), &across);
        add(&touching, &scale(&across, off))
    }

    /// The pose at a place.
    fn at(&self, place: &Place) -> Pose {
        let rotation = multiply(
            &place.rotation,
            &transpose(&self.axes.model_from_field.rotation),
        );
        let touching = self.touching(&apply(&transpose(&rotation), &place.towards));
        Pose {
            rotation,
            translation: subtract(&place.touching, &apply(&rotation, &touching)),
        }
    }
}
