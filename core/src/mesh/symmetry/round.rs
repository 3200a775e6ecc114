//! Whether a surface is one of revolution, told by turning it.

use super::nearest::{Foot, feet, feet_on_tangents};
use super::sample::{SAMPLES, Samples};
use crate::math::{Vector3, add, cross, dot, scale, sin_cos};
use crate::mesh::revolution::Revolution;
use crate::mesh::surface::Mesh;

/// Turns by which a body of revolution falls on itself, degrees: multiples of the golden angle, of which a part that repeats itself a few times around
/// does so at none.
const TURNS_DEG: [f64; 4] = [137.508, 275.016, 52.524, 190.032];
/// No point of a turned body of revolution lies farther from its surface than this part of its size: a circle of 16 chords is 0.019 of its radius
/// from one of 16 others at most, and what is as small is seen in no outline. A head with its taper, a cup and a glenosphere have
/// 0.001 as their files cut them; a patella with three pegs has 0.2, femoral components and trays have more.
const ROUND: f64 = 0.02;
/// The same by the tangent planes of the sample alone, root mean square: more is hopeless. They exceed the surface's by 0.055 at most.
const HOPELESS: f64 = 0.1;

/// The axis about which a surface is one of revolution, if it is.
///
/// It is a principal axis. The same for a part of any position and direction; some ms for 12 000 triangles where it is, next to nothing where it
/// is not, and about 40 kB of stack.
#[must_use]
pub fn revolution(mesh: &Mesh<'_>) -> Option<Revolution> {
    let samples = Samples::new(mesh)?;
    let is_round = |axis: &Vector3| is_round(mesh, &samples, axis);
    let [a, b, c] = samples.axes;
    let mut round = [[a, b, c], [b, c, a], [c, a, b]]
        .into_iter()
        .filter(|[axis, ..]| is_round(axis));
    let directions = round.next()?;
    Some(Revolution::new(
        samples.origin,
        directions,
        round.next().is_some(),
    ))
}

fn is_round(mesh: &Mesh<'_>, samples: &Samples, axis: &Vector3) -> bool {
    let mut found = [Foot::NONE; SAMPLES];
    let hopeless = HOPELESS * samples.size;
    let most = ROUND * samples.size;
    TURNS_DEG.into_iter().all(|deg| {
        let images = samples.points.map(|point| turned(&point, axis, deg));
        feet_on_tangents(samples, &images, &mut found);
        let squared = found.iter().map(|foot| foot.squared).sum::<f64>() / SAMPLES as f64;
        if squared > hopeless * hopeless {
            return false;
        }
        feet(mesh, samples, &images, &mut found);
        found.iter().all(|foot| foot.squared <= most * most)
    })
}

/// A point turned about an axis through the origin.
fn turned(point: &Vector3, axis: &Vector3, deg: f64) -> Vector3 {
    let (sine, cosine) = sin_cos(crate::math::radians(deg));
    let along = scale(axis, dot(point, axis) * (1.0 - cosine));
    let across = scale(&cross(axis, point), sine);
    add(&along, &add(&across, &scale(point, cosine)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{apply, norm, radians, rotation_by, subtract};
    use proptest::prelude::*;

    properties! {
        #[test]
        fn a_turn_is_the_rotation_by_it(
            axis in proptest::array::uniform3(-1.0..1.0f64), point in proptest::array::uniform3(-40.0..40.0f64), deg in -170.0..170.0f64,
        ) {
            prop_assume!(norm(&axis) > 0.1);
            let axis = scale(&axis, 1.0 / norm(&axis));
            let rotation = rotation_by(&scale(&axis, radians(deg)));
            prop_assert!(norm(&subtract(&turned(&point, &axis, deg), &apply(&rotation, &point))) < 1e-9);
        }
    }
}
