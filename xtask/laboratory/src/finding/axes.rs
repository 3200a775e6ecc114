//! Anatomical axes of models, from their shape or as a person states them.

use anyhow::{Context, Result};
use fluoropose::mesh::Model;
use fluoropose::mesh::anatomy::{AnatomicalAxes, anatomical_axes};
use fluoropose::mesh::symmetry::symmetry_planes;

use crate::files::Role;

/// The axes that `stated` names, else those that the shape of the model tells; none where it does not.
///
/// # Errors
/// For words that name no axes.
pub fn axes_of(
    model: &Model<'_>,
    role: Role,
    stated: Option<&str>,
) -> Result<Option<AnatomicalAxes>> {
    if let Some(words) = stated {
        let axes = AnatomicalAxes::from_words(words);
        return Ok(Some(axes.with_context(|| format!("the axes '{words}'"))?));
    }
    let planes = symmetry_planes(model.mesh());
    Ok(anatomical_axes(model.mesh(), &planes, role.component()))
}

/// Says which axes of a component's file are taken.
pub fn say_axes(name: &str, axes: &AnatomicalAxes) {
    println!("{name} anterior, superior, right: {axes}");
    if !axes.are_files_own {
        eprintln!(
            "the {name} file's axes are more than 10 degrees off those of its shape, or across the knee more than 5, so that those of its shape are taken"
        );
    }
    if !axes.front_is_known {
        eprintln!(
            "the shape of the {name} component does not tell front from back: if flexion has the wrong sign, state its axes"
        );
    }
}
