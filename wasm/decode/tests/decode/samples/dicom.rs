//! DICOM files by hand, after PS3.5 and PS3.10.

pub(crate) const IMPLICIT: &str = "1.2.840.10008.1.2";
pub(crate) const EXPLICIT: &str = "1.2.840.10008.1.2.1";
pub(crate) const DEFLATED: &str = "1.2.840.10008.1.2.1.99";
pub(crate) const BIG_ENDIAN: &str = "1.2.840.10008.1.2.2";
pub(crate) const RLE: &str = "1.2.840.10008.1.2.5";
pub(crate) const JPEG_BASELINE: &str = "1.2.840.10008.1.2.4.50";
pub(crate) const JPEG_EXTENDED: &str = "1.2.840.10008.1.2.4.51";
pub(crate) const JPEG_LS: &str = "1.2.840.10008.1.2.4.80";
pub(crate) const JPEG_LOSSLESS: &str = "1.2.840.10008.1.2.4.70";
pub(crate) const JPEG_2000: &str = "1.2.840.10008.1.2.4.90";

/// A file in the making: elements are added in the order of their tags.
pub(crate) struct Builder {
    syntax: String,
    data_set: Vec<u8>,
}

impl Builder {
    pub(crate) fn new(syntax: &str) -> Self {
        Self {
            syntax: syntax.to_owned(),
            data_set: Vec::new(),
        }
    }

    /// The attributes of a grey image with as many bits stored as allocated.
    pub(crate) fn image(syntax: &str, columns: u16, rows: u16, bits: u16, frames: usize) -> Self {
        Self::image_with(
            syntax,
            columns,
            rows,
            frames,
            "MONOCHROME2",
            [bits, bits, bits - 1, 0],
        )
    }

    /// The attributes of an image; the last are bits allocated, bits stored, high bit, signed.
    pub(crate) fn image_with(
        syntax: &str,
        columns: u16,
        rows: u16,
        frames: usize,
        photometric: &str,
        [allocated, stored, high, signed]: [u16; 4],
    ) -> Self {
        let samples = match photometric {
            "MONOCHROME1" | "MONOCHROME2" | "PALETTE COLOR" => 1,
            _ => 3,
        };
        let mut file = Self::new(syntax);
        file.short(0x0028_0002, samples);
        file.text(0x0028_0004, b"CS", photometric);
        if samples == 3 {
            file.short(0x0028_0006, 0);
        }
        file.text(0x0028_0008, b"IS", &frames.to_string());
        file.short(0x0028_0010, rows);
        file.short(0x0028_0011, columns);
        file.short(0x0028_0100, allocated);
        file.short(0x0028_0101, stored);
        file.short(0x0028_0102, high);
        file.short(0x0028_0103, signed);
        file
    }

    pub(crate) fn is_big_endian(&self) -> bool {
        self.syntax == BIG_ENDIAN
    }

    pub(crate) fn u16(&self, value: u16) -> [u8; 2] {
        match self.is_big_endian() {
            true => value.to_be_bytes(),
            false => value.to_le_bytes(),
        }
    }

    fn u32(&self, value: u32) -> [u8; 4] {
        match self.is_big_endian() {
            true => value.to_be_bytes(),
            false => value.to_le_bytes(),
        }
    }

    fn tag(&mut self, tag: u32) {
        let halves = [self.u16((tag >> 16) as u16), self.u16(tag as u16)];
        self.data_set.extend(halves.as_flattened());
    }

    /// A tag, representation and length as the syntax writes them.
    pub(crate) fn header(&mut self, tag: u32, representation: &[u8; 2], length: u32) {
        self.tag(tag);
        if self.syntax == IMPLICIT {
            self.data_set.extend(self.u32(length));
            return;
        }
        self.data_set.extend(representation);
        if matches!(representation, b"OB" | b"OW" | b"SQ" | b"UN") {
            self.data_set.extend([0, 0]);
            self.data_set.extend(self.u32(length));
        } else {
            self.data_set.extend(self.u16(length as u16));
        }
    }

    pub(crate) fn bytes(&mut self, tag: u32, representation: &[u8; 2], value: &[u8]) {
        self.header(tag, representation, value.len() as u32);
        self.data_set.extend(value);
    }

    pub(crate) fn short(&mut self, tag: u32, value: u16) {
        let value = self.u16(value);
        self.bytes(tag, b"US", &value);
    }

    pub(crate) fn text(&mut self, tag: u32, representation: &[u8; 2], value: &str) {
        let mut value = value.as_bytes().to_vec();
        if value.len() % 2 == 1 {
            value.push(b' ');
        }
        self.bytes(tag, representation, &value);
    }

    /// The elements so far.
    pub(crate) fn into_data_set(self) -> Vec<u8> {
        self.data_set
    }

    /// Bytes that are written as they are.
    pub(crate) fn verbatim(&mut self, bytes: &[u8]) {
        self.data_set.extend(bytes);
    }

    /// A delimiter or item: a tag and a length without representation.
    pub(crate) fn item(&mut self, tag: u32, length: u32) {
        self.tag(tag);
        self.data_set.extend(self.u32(length));
    }

    /// 16-bit pixels.
    pub(crate) fn words(mut self, pixels: &[u16]) -> Vec<u8> {
        let stored: Vec<u8> = pixels.iter().flat_map(|&p| self.u16(p)).collect();
        self.bytes(0x7FE0_0010, b"OW", &stored);
        self.finish()
    }

    /// 32-bit pixels.
    pub(crate) fn long_words(mut self, pixels: &[u32]) -> Vec<u8> {
        let stored: Vec<u8> = pixels.iter().flat_map(|&p| self.u32(p)).collect();
        self.bytes(0x7FE0_0010, b"OW", &stored);
        self.finish()
    }

    /// 8-bit pixels.
    pub(crate) fn octets(mut self, pixels: &[u8]) -> Vec<u8> {
        self.bytes(0x7FE0_0010, b"OB", pixels);
        self.finish()
    }

    /// Compressed pixels with a basic offset table.
    pub(crate) fn fragments(mut self, offsets: &[u32], fragments: &[&[u8]]) -> Vec<u8> {
        self.push_fragments(offsets, fragments);
        self.finish()
    }

    /// The element of compressed pixels.
    pub(crate) fn push_fragments(&mut self, offsets: &[u32], fragments: &[&[u8]]) {
        self.header(0x7FE0_0010, b"OB", u32::MAX);
        let table: Vec<u8> = offsets.iter().flat_map(|o| o.to_le_bytes()).collect();
        for fragment in [table.as_slice()].iter().chain(fragments) {
            let padding = fragment.len() % 2;
            self.item(0xFFFE_E000, (fragment.len() + padding) as u32);
            self.data_set.extend(*fragment);
            self.data_set.extend(&[0u8][..padding]);
        }
        self.item(0xFFFE_E0DD, 0);
    }

    /// The whole file.
    pub(crate) fn finish(self) -> Vec<u8> {
        let mut meta = Self::new(EXPLICIT);
        meta.bytes(0x0002_0001, b"OB", &[0, 1]);
        meta.text(0x0002_0010, b"UI", &self.syntax.replace(' ', "\0"));
        self.finish_after(meta)
    }

    /// The whole file with another group of elements before the data set than the one that names the syntax.
    pub(crate) fn finish_after(self, meta: Self) -> Vec<u8> {
        let mut file = vec![0; 128];
        file.extend(b"DICM");
        let mut group = Self::new(EXPLICIT);
        group.bytes(
            0x0002_0000,
            b"UL",
            &(meta.data_set.len() as u32).to_le_bytes(),
        );
        file.extend(group.data_set);
        file.extend(meta.data_set);
        match self.syntax == DEFLATED {
            true => {
                let mut deflater =
                    flate2::write::DeflateEncoder::new(&mut file, flate2::Compression::fast());
                std::io::Write::write_all(&mut deflater, &self.data_set).unwrap();
                deflater.finish().unwrap();
            }
            false => file.extend(self.data_set),
        }
        file
    }
}

/// One frame in run lengths: planes of bytes, high bytes first, each as literal runs and one repeat.
pub(crate) fn run_lengths(planes: &[Vec<u8>]) -> Vec<u8> {
    let mut segments = Vec::new();
    let mut header = vec![planes.len() as u32];
    for plane in planes {
        header.push(64 + segments.len() as u32);
        segments.extend(pack_bits(plane));
    }
    header.resize(16, 0);
    let mut frame: Vec<u8> = header.iter().flat_map(|h| h.to_le_bytes()).collect();
    frame.extend(segments);
    frame
}

/// Runs of three and more equal bytes as repeats, the rest as literals, and a byte that means nothing.
fn pack_bits(mut plane: &[u8]) -> Vec<u8> {
    let mut packed = vec![0x80];
    while let Some(&first) = plane.first() {
        let repeats = plane.iter().take(128).take_while(|&&b| b == first).count();
        let length = match repeats {
            3.. => {
                packed.extend([(1 - repeats as i32) as u8, first]);
                repeats
            }
            _ => {
                let literal = plane.len().min(2);
                packed.push(literal as u8 - 1);
                packed.extend(&plane[..literal]);
                literal
            }
        };
        plane = &plane[length..];
    }
    packed
}
