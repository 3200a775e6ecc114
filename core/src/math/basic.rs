//! Elementary functions and 3 x 3 algebra, the same to the last bit on every target.
//!
//! Everything goes through `libm`, so a pose computed in a page, on a server and on a
//! microcontroller is one pose. [`ranking`] holds the only exception: approximations that the
//! feature `micromath` swaps in where they can change the order of candidates but no number
//! that is reported.

use super::angle::sin_cos;

/// A 3 x 3 matrix, row by row.
pub type Matrix3 = [[f64; 3]; 3];
/// A vector of three components.
pub type Vector3 = [f64; 3];

/// The identity.
pub(crate) const IDENTITY: Matrix3 = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Square root.
#[must_use]
#[cfg_attr(target_os = "none", inline(never))]
pub fn sqrt(x: f64) -> f64 {
    libm::sqrt(x)
}

/// The standard deviation of a variance, which rounding may have brought below 0. What is not known (NaN) stays so.
#[must_use]
pub fn deviation(variance: f64) -> f64 {
    if variance < 0.0 { 0.0 } else { sqrt(variance) }
}

/// Whether the processor divides numbers of 32 bits itself, and has a square root for no safe program.
const DIVIDES: bool = cfg!(all(target_arch = "arm", target_abi = "eabihf"));

/// Square root in 32 bits of a whole number from 1 to 65 535, rounded as that of any number is.
#[must_use]
pub(crate) fn root_of_whole(number: u32) -> f32 {
    match DIVIDES {
        true => root_by_division(number),
        false => libm::sqrtf(number as f32),
    }
}

/// The same by Newton's method, half as long as `libm` takes where there is no instruction for it.
fn root_by_division(number: u32) -> f32 {
    let x = number as f32;
    // Half of the exponent: within a twentieth.
    let rough = f32::from_bits((x.to_bits() >> 1) + 0x1fbd_1df5);
    let closer = 0.5 * (rough + x / rough);
    let close = 0.5 * (closer + x / closer);
    let bits = (0.5 * (close + x / close)).to_bits();
    // What is left of the number in units of its square's last bit, of which the lower 32 bits are enough: the number itself has zeros
    // there, and the root is off by a few units at most.
    let root = bits & 0x007f_ffff | 0x0080_0000;
    let rest = root.wrapping_mul(root).wrapping_neg() as i32;
    let half = root as i32;
    f32::from_bits(bits + u32::from(rest > half) - u32::from(rest <= -half))
}

/// `ln(1 + x)` in 32 bits.
#[must_use]
pub(crate) fn ln_1p_single(x: f32) -> f32 {
    libm::log1pf(x)
}

/// Angle of the vector `(x, y)` in radians, -pi to pi.
#[must_use]
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// Arc sine in radians; the argument is clamped to -1..1, so rounding cannot make a NaN.
#[must_use]
pub(crate) fn asin(x: f64) -> f64 {
    libm::asin(within(x, -1.0, 1.0))
}

/// Largest whole number not above `x`.
#[must_use]
pub fn floor(x: f64) -> f64 {
    libm::floor(x)
}

/// Exponential function.
#[must_use]
pub fn exp(x: f64) -> f64 {
    libm::exp(x)
}

/// Natural logarithm.
#[must_use]
pub fn ln(x: f64) -> f64 {
    libm::log(x)
}

/// Nearest whole number, halves away from zero.
#[must_use]
pub fn round(x: f64) -> f64 {
    libm::round(x)
}

/// The number from `low` to `high` that is nearest; a NaN stays one. The language's own `clamp` can end in a panic that writes numbers.
#[must_use]
pub(crate) fn within(x: f64, low: f64, high: f64) -> f64 {
    if x < low {
        low
    } else if x > high {
        high
    } else {
        x
    }
}

/// Degrees to radians.
#[must_use]
pub fn radians(degrees: f64) -> f64 {
    degrees * (core::f64::consts::PI / 180.0)
}

/// Radians to degrees.
#[must_use]
pub fn degrees(radians: f64) -> f64 {
    radians * (180.0 / core::f64::consts::PI)
}

/// The angle `radians` reduced by whole multiples of `period` to `[-period/2, period/2)`.
#[must_use]
pub fn wrap(radians: f64, period: f64) -> f64 {
    radians - period * floor(radians / period + 0.5)
}

/// Matrix product `a * b`.
#[must_use]
#[cfg_attr(target_os = "none", inline(never))]
pub fn multiply(a: &Matrix3, b: &Matrix3) -> Matrix3 {
    let mut product = [[0.0; 3]; 3];
    for (row, out) in a.iter().zip(&mut product) {
        for (k, value) in out.iter_mut().enumerate() {
            *value = row[0] * b[0][k] + row[1] * b[1][k] + row[2] * b[2][k];
        }
    }
    product
}

/// Matrix times vector.
#[must_use]
#[cfg_attr(target_os = "none", inline(never))]
pub fn apply(m: &Matrix3, v: &Vector3) -> Vector3 {
    [dot(&m[0], v), dot(&m[1], v), dot(&m[2], v)]
}

/// Transpose: of a rotation, its inverse.
#[must_use]
pub fn transpose(m: &Matrix3) -> Matrix3 {
    [
        [m[0][0], m[1][0], m[2][0]],
        [m[0][1], m[1][1], m[2][1]],
        [m[0][2], m[1][2], m[2][2]],
    ]
}

/// Determinant.
#[must_use]
#[cfg_attr(target_os = "none", inline(never))]
pub(crate) fn determinant(m: &Matrix3) -> f64 {
    dot(&m[0], &cross(&m[1], &m[2]))
}

/// Scalar product.
#[must_use]
#[cfg_attr(target_os = "none", inline(never))]
pub fn dot(a: &Vector3, b: &Vector3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Vector product.
#[must_use]
#[cfg_attr(target_os = "none", inline(never))]
pub fn cross(a: &Vector3, b: &Vector3) -> Vector3 {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Sum of two vectors.
#[must_use]
#[cfg_attr(target_os = "none", inline(never))]
pub fn add(a: &Vector3, b: &Vector3) -> Vector3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// Difference of two vectors.
#[must_use]
#[cfg_attr(target_os = "none", inline(never))]
pub fn subtract(a: &Vector3, b: &Vector3) -> Vector3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Vector times number.
#[must_use]
#[cfg_attr(target_os = "none", inline(never))]
pub fn scale(v: &Vector3, factor: f64) -> Vector3 {
    [v[0] * factor, v[1] * factor, v[2] * factor]
}

/// Euclidean length.
#[must_use]
#[cfg_attr(target_os = "none", inline(never))]
pub fn norm(v: &Vector3) -> f64 {
    sqrt(dot(v, v))
}

/// The rotation by the length (radians) and about the direction of a vector (Rodrigues).
#[must_use]
#[cfg_attr(target_os = "none", inline(never))]
pub fn rotation_by(turn: &Vector3) -> Matrix3 {
    let angle = norm(turn);
    if angle == 0.0 {
        return IDENTITY;
    }
    let (sin, cos) = sin_cos(angle);
    let [x, y, z] = scale(turn, 1.0 / angle);
    let k = 1.0 - cos;
    [
        [cos + x * x * k, x * y * k - z * sin, x * z * k + y * sin],
        [y * x * k + z * sin, cos + y * y * k, y * z * k - x * sin],
        [z * x * k - y * sin, z * y * k + x * sin, cos + z * z * k],
    ]
}

/// The vector of a rotation, [`rotation_by`]'s inverse: its length is the angle in radians, up to
/// pi, where its sign is arbitrary.
#[must_use]
#[cfg_attr(target_os = "none", inline(never))]
pub(crate) fn rotation_vector(rotation: &Matrix3) -> Vector3 {
    let twice = [
        rotation[2][1] - rotation[1][2],
        rotation[0][2] - rotation[2][0],
        rotation[1][0] - rotation[0][1],
    ];
    let trace = rotation[0][0] + rotation[1][1] + rotation[2][2];
    let sine = norm(&twice) / 2.0;
    let angle = atan2(sine, (trace - 1.0) / 2.0);
    if sine > 1e-9 {
        return scale(&twice, angle / (2.0 * sine));
    }
    if trace > 0.0 {
        // A small angle is its own sine.
        return scale(&twice, 0.5);
    }
    // Half a turn: R = 2 a a' - I; the largest column of a a' is the axis, up to its length.
    let column = |k: usize| -> Vector3 {
        core::array::from_fn(|row| rotation[row][k] + if row == k { 1.0 } else { 0.0 })
    };
    let longest = (1..3).fold(column(0), |best, k| {
        if norm(&column(k)) > norm(&best) {
            column(k)
        } else {
            best
        }
    });
    scale(&longest, angle / norm(&longest))
}

/// Product `a * b` of square matrices of any size.
#[must_use]
#[cfg_attr(target_os = "none", inline(never))]
pub(crate) fn multiply_square<const N: usize>(
    a: &[[f64; N]; N],
    b: &[[f64; N]; N],
) -> [[f64; N]; N] {
    core::array::from_fn(|row| {
        core::array::from_fn(|column| (0..N).map(|k| a[row][k] * b[k][column]).sum())
    })
}

/// Transpose of a square matrix of any size.
#[must_use]
pub(crate) fn transpose_square<const N: usize>(a: &[[f64; N]; N]) -> [[f64; N]; N] {
    core::array::from_fn(|row| core::array::from_fn(|column| a[column][row]))
}

/// Functions whose error may change the order of candidates, never a reported number.
pub(crate) mod ranking {
    /// Sine and cosine of an angle in radians. With the feature `micromath` the error is up to
    /// about 0.002.
    #[must_use]
    pub(crate) fn sin_cos(radians: f64) -> (f64, f64) {
        #[cfg(feature = "micromath")]
        {
            use micromath::F32Ext;
            // The name alone would find the inherent methods where `std` is linked.
            let angle = radians as f32;
            (f64::from(F32Ext::sin(angle)), f64::from(F32Ext::cos(angle)))
        }
        #[cfg(not(feature = "micromath"))]
        super::sin_cos(radians)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_by_division_are_those_of_libm() {
        for number in 1..=u32::from(u16::MAX) {
            assert_eq!(
                root_by_division(number),
                libm::sqrtf(number as f32),
                "{number}"
            );
        }
    }

    #[test]
    fn wrapping_keeps_the_angle_modulo_its_period() {
        for k in -40..40 {
            let angle = f64::from(k) * 0.37;
            let wrapped = wrap(angle, core::f64::consts::PI);
            assert!(wrapped.abs() <= core::f64::consts::FRAC_PI_2 + 1e-12);
            let turns = (angle - wrapped) / core::f64::consts::PI;
            assert!((turns - round(turns)).abs() < 1e-12);
        }
    }
}
