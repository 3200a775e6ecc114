//! Tags of the elements that attributes are read from (DICOM PS3.6): group, then element, 16 bits each.

pub(super) const SAMPLES_PER_PIXEL: u32 = 0x0028_0002;
pub(super) const PHOTOMETRIC: u32 = 0x0028_0004;
pub(super) const PLANAR: u32 = 0x0028_0006;
pub(super) const FRAMES: u32 = 0x0028_0008;
pub(super) const ROWS: u32 = 0x0028_0010;
pub(super) const COLUMNS: u32 = 0x0028_0011;
pub(super) const PIXEL_ASPECT: u32 = 0x0028_0034;
pub(super) const BITS_ALLOCATED: u32 = 0x0028_0100;
pub(super) const BITS_STORED: u32 = 0x0028_0101;
pub(super) const HIGH_BIT: u32 = 0x0028_0102;
pub(super) const SIGNED: u32 = 0x0028_0103;
pub(super) const WINDOW_CENTRE: u32 = 0x0028_1050;
pub(super) const WINDOW_WIDTH: u32 = 0x0028_1051;
pub(super) const INTERCEPT: u32 = 0x0028_1052;
pub(super) const SLOPE: u32 = 0x0028_1053;
pub(super) const WINDOW_FUNCTION: u32 = 0x0028_1056;
pub(super) const CINE_RATE: u32 = 0x0018_0040;
pub(super) const FRAME_TIME: u32 = 0x0018_1063;
pub(super) const FRAME_TIMES: u32 = 0x0018_1065;
pub(super) const SOURCE_TO_DETECTOR: u32 = 0x0018_1110;
pub(super) const SOURCE_TO_PATIENT: u32 = 0x0018_1111;
pub(super) const MAGNIFICATION: u32 = 0x0018_1114;
pub(super) const DETECTOR_SPACING: u32 = 0x0018_1164;
pub(super) const SCANNED_SPACING: u32 = 0x0018_2010;
pub(super) const SOURCE_TO_ISOCENTRE: u32 = 0x0018_9402;
pub(super) const PIXEL_SPACING: u32 = 0x0028_0030;
pub(super) const SPACING_CALIBRATION: u32 = 0x0028_0A02;

const WANTED: [u32; 27] = [
    SAMPLES_PER_PIXEL,
    PHOTOMETRIC,
    PLANAR,
    FRAMES,
    ROWS,
    COLUMNS,
    PIXEL_ASPECT,
    BITS_ALLOCATED,
    BITS_STORED,
    HIGH_BIT,
    SIGNED,
    WINDOW_CENTRE,
    WINDOW_WIDTH,
    INTERCEPT,
    SLOPE,
    WINDOW_FUNCTION,
    CINE_RATE,
    FRAME_TIME,
    FRAME_TIMES,
    SOURCE_TO_DETECTOR,
    SOURCE_TO_PATIENT,
    MAGNIFICATION,
    DETECTOR_SPACING,
    SCANNED_SPACING,
    SOURCE_TO_ISOCENTRE,
    PIXEL_SPACING,
    SPACING_CALIBRATION,
];

/// Whether an element is one that attributes are read from.
pub(super) fn is_wanted(tag: u32) -> bool {
    WANTED.contains(&tag)
}
