//! The proof on the host, for comparison.

use std::fmt;
use std::process::ExitCode;

use fluoropose_firmware::writing::Write;
use fluoropose_firmware::{Memory, run};

/// Prints the lines; a failure goes to standard error.
pub(crate) fn main() -> ExitCode {
    let mut memory = Box::new(Memory::new());
    let mut lines = Lines(String::new());
    let proof = run(&mut memory, &mut lines, &mut |_| {});
    print!("{}", lines.0);
    match proof {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("{failure:?}");
            ExitCode::FAILURE
        }
    }
}

struct Lines(String);

impl Write for Lines {
    fn write_str(&mut self, words: &str) -> fmt::Result {
        self.0.push_str(words);
        Ok(())
    }
}
