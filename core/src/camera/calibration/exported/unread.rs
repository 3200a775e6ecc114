//! Why a camera matrix of others is not read, in words that say what to do.

use crate::camera::calibration::error::Unread;

/// A MayaCam 1.0 file.
pub(super) const MAYACAM_1: Unread = Unread::new(
    "the calibration is five lines of three numbers, as a MayaCam 1.0 file has them: it is not read; export the camera as MayaCam 2.0, which begins with the line 'image size'",
);

/// Nine numbers and nothing else.
pub(super) const NINE_NUMBERS: Unread = Unread::new(
    "the calibration is the nine numbers of a camera matrix alone, and nothing says of frames of which size: write above them the line 'image size', a line with width,height in pixels of the frames that were calibrated, and the line 'camera matrix'; the nine numbers by rows, fx,0,cx first, and cx and cy counted from 0 at the first pixel's centre",
);

/// A camera matrix without the size of its frames.
pub(super) const NO_SIZE: Unread = Unread::new(
    "the calibration has a camera matrix but not the size of the frames that it is of: write image_width and image_height into it, in pixels, as it has its other values",
);

/// The size of the frames is stated, but no whole number of pixels, or several times.
pub(super) const SIZE: Unread = Unread::new(
    "the calibration's width and height of frames are not one whole number of pixels each: leave those of the frames that were calibrated",
);

/// More than one camera matrix.
pub(super) const SEVERAL: Unread = Unread::new(
    "the calibration has several camera matrices that differ: give each camera a file of its own, with its matrix alone",
);

/// A MATLAB `IntrinsicMatrix` that is not by columns.
pub(super) const BY_ROWS: Unread = Unread::new(
    "the calibration's IntrinsicMatrix is by rows, and MATLAB's, whose pixels count from 1, is by columns: nothing says from where its pixels count; if from 0 name it camera_matrix, if from 1 name it so and take 1 from cx and cy",
);

/// A camera matrix of another form.
pub(super) fn count(numbers: usize) -> Unread {
    Unread::with(
        "the calibration's camera matrix has ",
        numbers as f64,
        " numbers, and nine are due: three rows of three",
    )
}

/// The lens, or the image intensifier, bends the picture: by the largest coefficient.
pub(super) fn distorted(coefficient: f64) -> Unread {
    Unread::with(
        "the calibration states a distortion (",
        coefficient,
        " among its coefficients), which is not taken into account: undistort the frames with it (OpenCV's undistort with the same camera matrix, MATLAB's undistortImage), and then write 0 in place of each coefficient",
    )
}

/// The camera matrix is of frames that were binned or cut by the camera.
pub(super) fn region(pixels: f64) -> Unread {
    Unread::with(
        "the calibration states a region or a binning of the frames (",
        pixels,
        " pixels): a camera matrix of frames as they are is needed, without either",
    )
}
