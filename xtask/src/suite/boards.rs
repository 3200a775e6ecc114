//! What `test --firmware` has beyond the Cortex-M4F's own lines: the fast approximations there, other processors under QEMU, the example in C, the core's tests on 32 bits.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::Result;

use super::board_rows::{self, Row};
use super::calls;
use super::firmware::{
    self, ALL_ROUND, FINDER, LIBRARY, OUTLINES, Program, REFINE, SMALL_FINDER, TIBIA,
};
use super::native;
use super::report::{Report, Said};
use crate::output::say;
use crate::setup::rust_target::{self, Toolchain};
use crate::setup::{Missing, command, components, programs};
use crate::workspace;

/// Runs the suite, after the firmware's own.
pub(crate) fn run(report: &mut Report) {
    firmware::run_with_micromath(report);
    let mut rows = Vec::new();
    let pairs = [&CORTEX_M0, &RISCV32].map(|board| [(board, &LIBRARY), (board, &FINDER)]);
    let pairs = pairs.iter().flatten();
    let others = [
        (&CORTEX_M4F, &OUTLINES),
        (&CORTEX_M4F, &REFINE),
        (&CORTEX_M4F, &TIBIA),
        (&CORTEX_M4F, &ALL_ROUND),
        (&NETDUINO, &SMALL_FINDER),
    ];
    for (board, program) in pairs.chain(&others) {
        let name = format!("firmware: the {} on a {}", program.name, board.name);
        report.step(&name, || compare(board, program, &mut rows));
    }
    report.step("firmware: the example in C", || example_in_c(&mut rows));
    report.step("firmware: linted with defmt", with_defmt);
    report.step("firmware: figures of other boards", || {
        board_rows::add_json(&rows, &firmware::figures()).map(Said::from)
    });
    report.step("firmware: the core's tests on 32 bits", on_32_bits);
}

/// A board that the same program is built for.
struct Board {
    name: &'static str,
    target: &'static str,
    emulate: fn(&Path) -> Result<String>,
}

/// The board of the firmware's own lines.
const CORTEX_M4F: Board = Board {
    name: "Cortex-M4F",
    target: rust_target::CORTEX_M4F,
    emulate: |image| firmware::on_board(&programs::qemu_arm()?, firmware::M4F, image),
};

/// Its instructions are a part of those of a Cortex-M3, which QEMU has with enough memory.
const CORTEX_M0: Board = Board {
    name: "Cortex-M0+",
    target: rust_target::CORTEX_M0,
    emulate: |image| firmware::on_board(&programs::qemu_arm()?, "mps2-an385", image),
};

/// A Cortex-M4F with 1 MiB of flash and 128 KiB of memory.
const NETDUINO: Board = Board {
    name: "Netduino Plus 2",
    target: rust_target::CORTEX_M4F,
    emulate: |image| firmware::on_board(&programs::qemu_arm()?, "netduinoplus2", image),
};

/// Its counter of instructions is nanoseconds under QEMU: one for each.
const RISCV32: Board = Board {
    name: "RISC-V rv32imac",
    target: rust_target::RISCV32,
    emulate: |image| {
        let mut board = Command::new(programs::qemu_riscv()?);
        board.args(["-M", "virt", "-bios", "none", "-icount", "shift=0"]);
        firmware::emulated(&mut board, image)
    },
};

/// Runs the same program here and on a board; both must write the same lines. Adds its figures.
fn compare(board: &Board, program: &Program, rows: &mut Vec<Row>) -> Result<Said> {
    let toolchain = rust_target::ensure(board.target)?;
    let image = firmware::build(&toolchain, program.features)?;
    let lines = (board.emulate)(&image)?;
    // Rows of the firmware's own board have its name apart alone.
    let name = match board.name {
        "Cortex-M4F" => program.name.to_string(),
        other => format!("{other} {}", program.name),
    };
    agree(board.name, &name, program, &lines, &toolchain, rows)
}

/// Compares what a board wrote with what the program writes here, and its figures with those that were committed.
fn agree(
    board: &'static str,
    name: &str,
    program: &Program,
    lines: &str,
    toolchain: &Toolchain,
    rows: &mut Vec<Row>,
) -> Result<Said> {
    let host = firmware::on_host(program.features)?;
    let count = firmware::ensure_alike(&host, lines)?;
    firmware::check_pose(&host, program)?;
    let information = lines.lines().filter(|line| firmware::is_information(line));
    let found: Vec<Row> = information
        .inspect(|line| say(line))
        .filter_map(|line| board_rows::read(board, name, line))
        .collect();
    if let Toolchain::Own { .. } = toolchain {
        board_rows::compare(name, &found)?;
    }
    rows.extend(found);
    Ok(format!("{count} lines alike").into())
}

/// Builds the static library and the example around it with a C compiler; it must write what the same program in Rust writes.
fn example_in_c(rows: &mut Vec<Row>) -> Result<Said> {
    let toolchain = rust_target::ensure(rust_target::CORTEX_M4F)?;
    let (gcc, qemu) = (programs::arm_gcc()?, programs::qemu_arm()?);
    let library = static_library(&toolchain)?;
    let image = linked(&gcc, &library)?;
    let mut lines = firmware::on_board(&qemu, firmware::M4F, &image)?;
    let code = calls::code_bytes(&std::fs::read(&image)?)?;
    lines.push_str(&format!("info: code: {code} bytes\n"));
    agree("Cortex-M4F", "C", &FINDER, &lines, &toolchain, rows)
}

/// Results and errors as `defmt` writes them compile for a board; a program of its own would need a logger.
fn with_defmt() -> Result<Said> {
    let toolchain = rust_target::ensure(rust_target::CORTEX_M4F)?;
    let mut cargo = toolchain.cargo("build", &firmware::folder());
    cargo.args(["-p", "fluoropose-embedded", "--features", "defmt"]);
    if let Toolchain::Own { .. } = toolchain {
        components::lint(&mut cargo)?;
    }
    command::run(cargo.args(["--profile", "embedded"])).map(Said::from)
}

fn static_library(toolchain: &Toolchain) -> Result<PathBuf> {
    let mut cargo = toolchain.cargo("rustc", &firmware::folder());
    cargo.args(["-p", "fluoropose-embedded", "--profile", "embedded"]);
    command::run(cargo.args(["--crate-type", "staticlib"]))?;
    let built = toolchain.output_dir("embedded", &firmware::folder());
    Ok(built.join("libfluoropose_embedded.a"))
}

/// As a Cortex-M4F wants it, strictly, without a C library.
const FLAGS: [&str; 16] = [
    "-std=c11",
    "-O2",
    "-Wall",
    "-Wextra",
    "-Werror",
    "-pedantic",
    "-mcpu=cortex-m4",
    "-mthumb",
    "-mfloat-abi=hard",
    "-mfpu=fpv4-sp-d16",
    "-ffreestanding",
    "-nostdlib",
    "-Wl,--gc-sections",
    "-Wl,--nmagic",
    "-z",
    "noexecstack",
];

/// The image of the example.
fn linked(gcc: &Path, library: &Path) -> Result<PathBuf> {
    let crate_folder = workspace::root().join("core/embedded");
    let example = crate_folder.join("example");
    let image = firmware::folder().join("example.elf");
    let mut compiler = command::of_lane(gcc);
    compiler.args(FLAGS);
    for (name, file) in [
        ("IMPLANT_FILE", "femur.implant"),
        ("OUTLINE_FILE", "femur.outline"),
    ] {
        let file = firmware::inputs_folder().join(file);
        compiler.arg(format!("-D{name}=\"{}\"", file.display()));
    }
    compiler.arg("-I").arg(crate_folder.join("include"));
    compiler.args(["main.c", "writing.c", "board.c", "start.c"].map(|file| example.join(file)));
    compiler.arg(library).arg("-lgcc");
    compiler.arg("-T").arg(example.join("board.ld"));
    command::run(compiler.arg("-o").arg(&image))?;
    Ok(image)
}

/// The core's tests with words of 32 bits, on this machine; overflow is an error in them.
fn on_32_bits() -> Result<Said> {
    let target = rust_target::I686;
    if !cfg!(all(target_arch = "x86_64", target_os = "linux")) {
        return Err(missing(target, "its programs run on Linux on x86-64").into());
    }
    programs::linker_for_32_bits()?;
    let toolchain @ Toolchain::Own { .. } = rust_target::ensure(target)? else {
        return Err(missing(target, "Debian's compiler has no standard library for it").into());
    };
    let mut cargo = toolchain.cargo("test", &firmware::folder());
    cargo.args(["--package", "fluoropose", "--lib", "--features", "alloc"]);
    native::tests(&mut cargo, "boards")
}

fn missing(target: &str, why: &str) -> Missing {
    Missing {
        what: format!("way to run {target}"),
        why: why.into(),
        remedy: "run it on such a machine".into(),
        tried: false,
    }
}
