//! TIFF files by hand, with lists in their fields and any number of strips.

/// A field: its tag, type (1 for bytes, 3 for words, 4 for long words, 7 for bytes of any meaning) and values.
pub(crate) type Field = (u16, u16, Vec<u32>);

/// A little endian file of one page: these fields besides the strips' own, and these strips.
pub(crate) fn of_strips(fields: &[Field], strips: &[&[u8]]) -> Vec<u8> {
    let mut file = b"II*\0\0\0\0\0".to_vec();
    let mut offsets = Vec::new();
    for strip in strips {
        offsets.push(file.len() as u32);
        file.extend(*strip);
    }
    let mut fields = fields.to_vec();
    fields.push((273, 4, offsets));
    fields.push((
        279,
        4,
        strips.iter().map(|strip| strip.len() as u32).collect(),
    ));
    fields.sort_unstable();
    let mut directory = (fields.len() as u16).to_le_bytes().to_vec();
    for (tag, kind, values) in &fields {
        let width = if *kind == 3 {
            2
        } else if *kind == 4 {
            4
        } else {
            1
        };
        let bytes = values
            .iter()
            .flat_map(|value| value.to_le_bytes()[..width].to_vec());
        let mut bytes: Vec<u8> = bytes.collect();
        directory.extend(tag.to_le_bytes());
        directory.extend(kind.to_le_bytes());
        directory.extend((values.len() as u32).to_le_bytes());
        if bytes.len() > 4 {
            directory.extend((file.len() as u32).to_le_bytes());
            file.extend(bytes);
        } else {
            bytes.resize(4, 0);
            directory.extend(bytes);
        }
    }
    directory.extend(0u32.to_le_bytes());
    let at = file.len() as u32;
    file[4..8].copy_from_slice(&at.to_le_bytes());
    file.extend(directory);
    file
}

/// The fields of a page in one strip, or in one for each plane.
pub(crate) fn fields(width: u32, height: u32, bits: &[u32], photometric: u32) -> Vec<Field> {
    vec![
        (256, 3, vec![width]),
        (257, 3, vec![height]),
        (258, 3, bits.to_vec()),
        (259, 3, vec![1]),
        (262, 3, vec![photometric]),
        (277, 3, vec![bits.len() as u32]),
        (278, 3, vec![height]),
    ]
}
