//! The program `fluoropose`.

fn main() -> std::process::ExitCode {
    fluoropose_laboratory::cli::run(std::env::args_os()).into()
}
