//! What is usual of some numbers.

/// The median of at least two numbers that are finite; the others do not count. `sorted` is working memory of as many numbers: those that are beyond it
/// do not count either.
pub(crate) fn median(values: &[f64], sorted: &mut [f64]) -> Option<f64> {
    let mut count = 0;
    let known = values.iter().filter(|value| value.is_finite());
    for (place, &value) in sorted.iter_mut().zip(known) {
        *place = value;
        count += 1;
    }
    let sorted = sorted.get_mut(..count).filter(|_| count > 1)?;
    sorted.sort_unstable_by(f64::total_cmp);
    let [below, above] = [(count - 1) / 2, count / 2].map(|at| sorted.get(at).copied());
    Some((below? + above?) / 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_middle_one_of_those_that_are_known() {
        let of = |values: &[f64]| median(values, &mut [0.0; 8]);
        assert_eq!(of(&[]), None);
        assert_eq!(of(&[3.0, f64::NAN]), None);
        assert_eq!(of(&[3.0, f64::NAN, 1.0]), Some(2.0));
        assert_eq!(of(&[9.0, f64::INFINITY, 1.0, 4.0]), Some(4.0));
        assert_eq!(of(&[9.0, 2.0, 1.0, 4.0]), Some(3.0));
        assert_eq!(median(&[1.0, 3.0, 80.0], &mut [0.0; 2]), Some(2.0));
    }
}
