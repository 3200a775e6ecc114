//! A part to try things on: three boxes that lie together like a tibial tray, its stem and a wedge under one side.
#![allow(dead_code, reason = "each example takes what it needs")]

/// Number of vertices and triangles.
pub(crate) const VERTICES: usize = 3 * 8;
pub(crate) const TRIANGLES: usize = 3 * 12;

/// Lowest and highest corner of each box, mm.
const BOXES: [[[f32; 3]; 2]; 3] = [
    [[-22.0, 0.0, -36.0], [24.0, 4.0, 36.0]],
    [[-9.0, -38.0, -5.0], [4.0, 0.0, 5.0]],
    [[-20.0, -11.0, 12.0], [6.0, 0.0, 33.0]],
];

/// The corners of all boxes, mm. Bit `k` of a corner's number says on which end of axis `k` it lies.
pub(crate) fn vertices() -> [[f32; 3]; VERTICES] {
    core::array::from_fn(|number| {
        let (ends, corner) = (BOXES[number / 8], number % 8);
        core::array::from_fn(|axis| ends[corner >> axis & 1][axis])
    })
}

/// Two triangles for each side of a box, counter-clockwise as seen from outside.
pub(crate) fn triangles() -> [[u32; 3]; TRIANGLES] {
    const SIDES: [[u32; 4]; 6] = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    core::array::from_fn(|number| {
        let [a, b, c, d] = SIDES[number % 12 / 2].map(|corner| 8 * (number as u32 / 12) + corner);
        if number % 2 == 0 {
            [a, b, c]
        } else {
            [a, c, d]
        }
    })
}
