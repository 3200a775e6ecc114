//! Tags of the elements that attributes are read from (DICOM PS3.6): group, then element, 16 bits each.

pub(super) const RECOMMENDED_RATE: u32 = 0x0008_2144;
pub(super) const CINE_RATE: u32 = 0x0018_0040;
pub(super) const FRAME_TIME: u32 = 0x0018_1063;
pub(super) const FRAME_TIMES: u32 = 0x0018_1065;
pub(super) const SOURCE_TO_DETECTOR: u32 = 0x0018_1110;
pub(super) const SOURCE_TO_PATIENT: u32 = 0x0018_1111;
pub(super) const MAGNIFICATION: u32 = 0x0018_1114;
pub(super) const DETECTOR_SPACING: u32 = 0x0018_1164;
/// Shapes of a shutter, then the columns and rows of its edges, the middle (row, column) and radius of its circle, and its corners
/// (row, column).
pub(super) const SHUTTER: u32 = 0x0018_1600;
pub(super) const SHUTTER_LEFT: u32 = 0x0018_1602;
pub(super) const SHUTTER_RIGHT: u32 = 0x0018_1604;
pub(super) const SHUTTER_TOP: u32 = 0x0018_1606;
pub(super) const SHUTTER_BOTTOM: u32 = 0x0018_1608;
pub(super) const SHUTTER_CENTRE: u32 = 0x0018_1610;
pub(super) const SHUTTER_RADIUS: u32 = 0x0018_1612;
pub(super) const SHUTTER_CORNERS: u32 = 0x0018_1620;
pub(super) const SCANNED_SPACING: u32 = 0x0018_2010;
pub(super) const FRAME_BEGUN: u32 = 0x0018_9074;
pub(super) const SOURCE_TO_ISOCENTRE: u32 = 0x0018_9402;
/// The place of a picture in its series, from 1.
pub(super) const INSTANCE_NUMBER: u32 = 0x0020_0013;
pub(super) const SAMPLES_PER_PIXEL: u32 = 0x0028_0002;
pub(super) const PHOTOMETRIC: u32 = 0x0028_0004;
pub(super) const PLANAR: u32 = 0x0028_0006;
pub(super) const FRAMES: u32 = 0x0028_0008;
pub(super) const ROWS: u32 = 0x0028_0010;
pub(super) const COLUMNS: u32 = 0x0028_0011;
pub(super) const PIXEL_SPACING: u32 = 0x0028_0030;
pub(super) const PIXEL_ASPECT: u32 = 0x0028_0034;
pub(super) const BITS_ALLOCATED: u32 = 0x0028_0100;
pub(super) const BITS_STORED: u32 = 0x0028_0101;
pub(super) const HIGH_BIT: u32 = 0x0028_0102;
pub(super) const SIGNED: u32 = 0x0028_0103;
pub(super) const SPACING_CALIBRATION: u32 = 0x0028_0A02;
pub(super) const WINDOW_CENTRE: u32 = 0x0028_1050;
pub(super) const WINDOW_WIDTH: u32 = 0x0028_1051;
pub(super) const INTERCEPT: u32 = 0x0028_1052;
pub(super) const SLOPE: u32 = 0x0028_1053;
pub(super) const WINDOW_FUNCTION: u32 = 0x0028_1056;
/// Number of entries, first value that is mapped, and bits of an entry, of red, green and blue.
pub(super) const PALETTE_SHAPES: [u32; 3] = [0x0028_1101, 0x0028_1102, 0x0028_1103];
pub(super) const PALETTE_ENTRIES: [u32; 3] = [0x0028_1201, 0x0028_1202, 0x0028_1203];
/// The table that turns stored values into meaningful ones, where no slope does.
pub(super) const MODALITY_TABLE: u32 = 0x0028_3000;
pub(super) const TABLE_ENTRIES: u32 = 0x0028_3006;

/// How a value is written where the file does not say it: files without representations, and elements called unknown.
const WANTED: [(u32, [u8; 2]); 46] = [
    (RECOMMENDED_RATE, *b"IS"),
    (CINE_RATE, *b"IS"),
    (FRAME_TIME, *b"DS"),
    (FRAME_TIMES, *b"DS"),
    (SOURCE_TO_DETECTOR, *b"DS"),
    (SOURCE_TO_PATIENT, *b"DS"),
    (MAGNIFICATION, *b"DS"),
    (DETECTOR_SPACING, *b"DS"),
    (SHUTTER, *b"CS"),
    (SHUTTER_LEFT, *b"IS"),
    (SHUTTER_RIGHT, *b"IS"),
    (SHUTTER_TOP, *b"IS"),
    (SHUTTER_BOTTOM, *b"IS"),
    (SHUTTER_CENTRE, *b"IS"),
    (SHUTTER_RADIUS, *b"IS"),
    (SHUTTER_CORNERS, *b"IS"),
    (SCANNED_SPACING, *b"DS"),
    (FRAME_BEGUN, *b"DT"),
    (SOURCE_TO_ISOCENTRE, *b"FL"),
    (INSTANCE_NUMBER, *b"IS"),
    (SAMPLES_PER_PIXEL, *b"US"),
    (PHOTOMETRIC, *b"CS"),
    (PLANAR, *b"US"),
    (FRAMES, *b"IS"),
    (ROWS, *b"US"),
    (COLUMNS, *b"US"),
    (PIXEL_SPACING, *b"DS"),
    (PIXEL_ASPECT, *b"IS"),
    (BITS_ALLOCATED, *b"US"),
    (BITS_STORED, *b"US"),
    (HIGH_BIT, *b"US"),
    (SIGNED, *b"US"),
    (SPACING_CALIBRATION, *b"CS"),
    (WINDOW_CENTRE, *b"DS"),
    (WINDOW_WIDTH, *b"DS"),
    (INTERCEPT, *b"DS"),
    (SLOPE, *b"DS"),
    (WINDOW_FUNCTION, *b"CS"),
    (PALETTE_SHAPES[0], *b"US"),
    (PALETTE_SHAPES[1], *b"US"),
    (PALETTE_SHAPES[2], *b"US"),
    (PALETTE_ENTRIES[0], *b"OW"),
    (PALETTE_ENTRIES[1], *b"OW"),
    (PALETTE_ENTRIES[2], *b"OW"),
    (MODALITY_TABLE, *b"SQ"),
    (TABLE_ENTRIES, *b"OW"),
];

/// How the value of an element that attributes are read from is written; none for other elements.
pub(super) fn representation(tag: u32) -> Option<[u8; 2]> {
    WANTED
        .iter()
        .find(|(wanted, _)| *wanted == tag)
        .map(|(_, representation)| *representation)
}
