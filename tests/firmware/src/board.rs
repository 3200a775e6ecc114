//! The proof on a board: results to whoever watches, instructions by its clock, stack by painting it.

use core::fmt;
use core::panic::PanicInfo;

use fluoropose_firmware::writing::{Write, whole, words};
use fluoropose_firmware::{DATA, Memory};

#[cfg(target_arch = "arm")]
mod cortex;
#[cfg(target_arch = "riscv32")]
mod riscv;
mod stack;

/// Lines that start with this are not compared with the host's.
const INFORMATION: &str = "info";

/// What the proof tells, before it is shown: its lines, and the instructions of each stage.
struct Told {
    lines: heapless::String<8192>,
    stages: heapless::Vec<(u64, heapless::String<40>), 8>,
}

impl Told {
    const fn new() -> Self {
        Self {
            lines: heapless::String::new(),
            stages: heapless::Vec::new(),
        }
    }
}

/// What each board does in its own way, and where words go.
trait Board: Write {
    /// Instructions since the last call.
    fn instructions(&mut self) -> u64;
}

/// Runs the proof.
fn prove(board: &mut impl Board, memory: &mut Memory, told: &mut Told) -> fmt::Result {
    let Told { lines, stages } = told;
    let mut stage = |name: &str| {
        let instructions = board.instructions();
        if let Ok(name) = heapless::String::try_from(name) {
            // A ninth stage would not be told; there are at most seven.
            let _ = stages.push((instructions, name));
        }
    };
    let proof = fluoropose_firmware::run(memory, lines, &mut stage);
    board.write_str(lines)?;
    for (instructions, name) in stages.iter() {
        tell(board, name, *instructions, " instructions\n")?;
    }
    report_memory(board)?;
    proof.map_err(|failure| {
        let _ = words(board, &[failure.word(), "\n"]);
        fmt::Error
    })
}

/// A line that is not compared with the host's.
fn tell(board: &mut impl Board, name: &str, value: u64, unit: &str) -> fmt::Result {
    words(board, &[INFORMATION, ": ", name, ": "])?;
    whole(board, value)?;
    words(board, &[unit])
}

fn report_memory(board: &mut impl Board) -> fmt::Result {
    let data: usize = DATA.iter().map(|(_, bytes)| bytes).sum();
    let [first, second] = DATA;
    let Some(stack) = stack::most_used() else {
        words(
            board,
            &["the stack came down to all that is watched: what was written below it is lost\n"],
        )?;
        return Err(fmt::Error);
    };
    let bytes = [
        ("working memory", size_of::<Memory>()),
        ("code", stack::code()),
        ("tables and sentences", stack::constants() - data),
        first,
        second,
        ("all statics", stack::statics()),
        ("stack at its highest", stack),
    ];
    for (name, bytes) in bytes {
        tell(board, name, bytes as u64, " bytes\n")?;
    }
    Ok(())
}

/// Where a panic was, in few words: what the language makes of it takes 4 KB.
fn tell_panic(out: &mut impl Write, info: &PanicInfo<'_>) -> fmt::Result {
    let (file, line) = info
        .location()
        .map_or(("?", 0), |at| (at.file(), at.line()));
    words(out, &["panicked at ", file, ":"])?;
    whole(out, line.into())?;
    words(out, &["\n"])
}
