//! NumPy arrays, put together by hand.

/// An array of version 1.0 with its numbers' bytes; `order`: `True` where the first axis goes fastest.
pub(crate) fn npy(descr: &str, order: &str, shape: &str, numbers: &[u8]) -> Vec<u8> {
    let header = format!("{{'descr': '{descr}', 'fortran_order': {order}, 'shape': {shape}, }}");
    with_header(&[1, 0], &header, numbers)
}

/// Of a version of the form, with the header as it is.
pub(crate) fn with_header(version: &[u8; 2], header: &str, numbers: &[u8]) -> Vec<u8> {
    let length = header.len() as u32 + 1;
    let length = length.to_le_bytes();
    let digits = if version[0] == 1 { 2 } else { 4 };
    let mut file = b"\x93NUMPY".to_vec();
    file.extend(version);
    file.extend(&length[..digits]);
    file.extend(header.as_bytes());
    file.push(b'\n');
    file.extend(numbers);
    file
}
