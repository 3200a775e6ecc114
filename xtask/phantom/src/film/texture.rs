//! A smooth random pattern that stays with the bone it is drawn on.

/// Noise of several octaves about 0, mostly within -1..1; `grain` is the size of the coarsest spots in mm.
pub(super) fn pattern([x, y]: [f64; 2], grain: f64, seed: u64) -> f64 {
    let mut sum = 0.0;
    let mut weight = 0.6;
    let mut step = grain;
    for octave in 0..3 {
        sum += weight * spots(x / step, y / step, seed.wrapping_add(octave));
        weight *= 0.6;
        step *= 0.47;
    }
    sum
}

fn spots(x: f64, y: f64, seed: u64) -> f64 {
    let (left, below) = (x.floor(), y.floor());
    let ease = |t: f64| t * t * (3.0 - 2.0 * t);
    let (u, v) = (ease(x - left), ease(y - below));
    let corner = |i: i64, j: i64| hashed(left as i64 + i, below as i64 + j, seed);
    let low = corner(0, 0) * (1.0 - u) + corner(1, 0) * u;
    let high = corner(0, 1) * (1.0 - u) + corner(1, 1) * u;
    low * (1.0 - v) + high * v
}

/// A value in -1..1 that belongs to a place of the lattice (the finaliser of SplitMix64).
fn hashed(i: i64, j: i64, seed: u64) -> f64 {
    let place = (i as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ (j as u64).rotate_left(32);
    let mut bits = place.wrapping_add(seed.wrapping_mul(0xd134_2543_de82_ef95));
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^= bits >> 31;
    (bits >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}
