//! Axes that a study states for a model, beside those that its shape tells.

use fluoropose::math::dot;
use fluoropose::mesh::OwnedModel;
use fluoropose::mesh::anatomy::{AnatomicalAxes, anatomical_axes};
use fluoropose::mesh::symmetry::symmetry_planes;

use super::Role;

/// Cosine of the angle up to which two superiors are alike, 45 degrees: half of the way to the next axis of a file.
const ALIKE: f64 = core::f64::consts::FRAC_1_SQRT_2;

/// What there is to say where stated axes point up otherwise than the shape does, a sentence without its full stop: poses of a part that is
/// upside down look right.
pub(super) fn axes_doubt(model: &OwnedModel, role: Role, words: &str) -> Option<String> {
    let stated = AnatomicalAxes::from_words(words).ok()?;
    let model = model.as_model();
    let planes = symmetry_planes(model.mesh());
    let told = anatomical_axes(model.mesh(), &planes, role.component())?;
    let up = |axes: &AnatomicalAxes| axes.model_from_field.rotation.map(|row| row[1]);
    (dot(&up(&stated), &up(&told)) < ALIKE).then(|| {
        format!(
            "the axes \"{words}\" that the study states have another superior than its shape speaks for ({told}). Where the shape is right, as it is for most components, poses lie upside down and look right"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::owned;
    use fluoropose_phantom::implant::{Parameters, tibia};

    #[test]
    fn a_superior_that_the_shape_speaks_against_is_told() {
        let model = owned(tibia(&Parameters::default()).expect("usual")).expect("valid");
        let doubt = |words| axes_doubt(&model, Role::Tibia, words);
        let told = {
            let model = model.as_model();
            let planes = symmetry_planes(model.mesh());
            let axes = anatomical_axes(model.mesh(), &planes, Role::Tibia.component());
            axes.expect("its shape tells").to_string()
        };
        assert_eq!(doubt(&told), None, "{told}");
        let [anterior, superior, right] = told.split_whitespace().collect::<Vec<_>>()[..] else {
            panic!("{told}");
        };
        let other = |axis: &str| match axis.strip_prefix('-') {
            Some(axis) => axis.to_owned(),
            None => format!("-{axis}"),
        };
        let upside_down = [anterior, &other(superior), &other(right)].join(" ");
        assert!(doubt(&upside_down).is_some_and(|told| told.contains(&upside_down)));
        // Turned about its own axis it stands as before: a shape may misread its front.
        let turned = [&other(anterior), superior, &other(right)].join(" ");
        assert_eq!(doubt(&turned), None);
    }
}
