//! The proof on the host, for comparison.

use std::process::ExitCode;

use fluoropose_firmware::{Memory, run};

/// Prints the lines; a failure goes to standard error.
pub(crate) fn main() -> ExitCode {
    let mut memory = Box::new(Memory::new());
    let mut lines = String::new();
    let proof = run(&mut memory, &mut lines, &mut |_| {});
    print!("{lines}");
    match proof {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("{failure:?}");
            ExitCode::FAILURE
        }
    }
}
