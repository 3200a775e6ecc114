//! What this crate makes of files, for a program that holds it against other readers (`cargo xtask conformance`).
//!
//! Reads paths from the standard input, a line each. Of each it prints a line of JSON, and appends the pixels of all its
//! frames, 16 bits little endian, to the file that the only argument names.

use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{self, BufRead, BufWriter, Write};

use fluoropose_decode::{FrameFile, GreyFrame};

fn main() -> io::Result<()> {
    let out = std::env::args_os()
        .nth(1)
        .ok_or(io::ErrorKind::InvalidInput)?;
    let mut pixels = BufWriter::new(File::create(out)?);
    for path in io::stdin().lock().lines() {
        let path = path?;
        let name = path.rsplit(['/', '\\']).next().unwrap_or_default();
        let line = match frames_of(fs::read(&path)?, name) {
            Ok((line, frames)) => {
                for frame in &frames {
                    for index in 0..frame.pixels.len() {
                        let value = frame.pixels.get(index).unwrap_or_default();
                        pixels.write_all(&value.to_le_bytes())?;
                    }
                }
                line
            }
            Err(refusal) => format!("{{\"refused\": {}}}", quoted(&refusal)),
        };
        println!("{line}");
    }
    pixels.flush()
}

/// The sizes of a file's frames as JSON, and the frames; or why it is refused.
fn frames_of(bytes: Vec<u8>, name: &str) -> Result<(String, Vec<GreyFrame>), String> {
    let file = FrameFile::open(bytes, name).map_err(|error| error.to_string())?;
    let frames: Result<Vec<_>, _> = (0..file.count()).map(|index| file.frame(index)).collect();
    let frames = frames.map_err(|error| error.to_string())?;
    let mut sizes = String::new();
    for frame in &frames {
        let comma = if sizes.is_empty() { "" } else { ", " };
        let (width, height, bits) = (frame.width, frame.height, frame.bits);
        // Writing to a string does not fail.
        let _ = write!(sizes, "{comma}[{width}, {height}, {bits}]");
    }
    let rate = file
        .frames_per_s()
        .map_or("null".to_owned(), |rate| rate.to_string());
    let line = format!(
        "{{\"kind\": \"{}\", \"rate\": {rate}, \"frames\": [{sizes}]}}",
        file.kind().word()
    );
    Ok((line, frames))
}

/// A string of JSON. Refusals are single lines.
fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}
