//! Poses that the page's film does not go through.

use fluoropose::finder::Doubt;
use fluoropose::finder::choice::detours;
use wasm_bindgen::prelude::*;

use fluoropose_page::pose_numbers::all_poses;

/// What is told of each pose of a film that does not go through it, a sentence without its full stop; nothing where nothing is.
/// `poses`: the good ones of a component, six numbers a frame, NaN where there is none.
///
/// # Errors
/// When there are not six numbers for each.
#[wasm_bindgen(js_name = offTheWay)]
pub fn off_the_way(poses: &[f64]) -> Result<Vec<JsValue>, JsError> {
    let good = all_poses(poses)?;
    let mut told = vec![None; good.len()];
    let [turns, sorted] = &mut [vec![0.0; good.len()], vec![0.0; good.len()]];
    detours(&good, turns, sorted, &mut told);
    let sentence = |told: Option<_>| Some(Doubt::OffTheWay(told?).to_string());
    Ok(told.into_iter().map(|told| sentence(told).into()).collect())
}
