//! Pieces of a model's outline.

/// A piece of a model's outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site {
    /// Which closed curve it belongs to.
    pub curve: usize,
    /// Way along that curve, pixels.
    pub along: f64,
    /// Length of the whole curve, pixels.
    pub round: f64,
    /// Length of the piece, pixels.
    pub length: f64,
    /// How fast it moves along its normal: pixels per radian of three turns about the middle of
    /// the model's box, and per mm of three shifts, camera axes.
    pub jacobian: [f64; 6],
}

/// Neighbouring pieces of one curve taken together to pieces of about `length` pixels; never
/// shorter than what is there.
pub(super) fn gathered(sites: &[Site], length: f64) -> Vec<Site> {
    let mut order = sites.to_vec();
    order.sort_by(|a, b| {
        (a.curve, a.along)
            .partial_cmp(&(b.curve, b.along))
            .unwrap_or(std::cmp::Ordering::Equal)
    });
    let bin = |site: &Site| (site.along / length) as i64;
    let mut all: Vec<Site> = Vec::new();
    for group in order.chunk_by(|a, b| a.curve == b.curve && bin(a) == bin(b)) {
        let total: f64 = group.iter().map(|site| site.length).sum();
        let mean = |value: &dyn Fn(&Site) -> f64| {
            let sum: f64 = group.iter().map(|site| site.length * value(site)).sum();
            sum / total
        };
        // A corner pixel may have no length of its own.
        if total > 0.0 {
            all.push(Site {
                along: mean(&|site| site.along),
                length: total,
                jacobian: std::array::from_fn(|k| mean(&|site| site.jacobian[k])),
                ..group[0]
            });
        }
    }
    all
}
