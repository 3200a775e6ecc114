//! Tells the sources whether the target has an instruction for which the stable compiler has no name.

use std::env;

fn main() {
    println!("cargo::rustc-check-cfg=cfg(usada8)");
    // Cortex-M4 and M7, all of which have it. Of those of `thumbv8m.main` some have not.
    if env::var("TARGET").is_ok_and(|target| target.starts_with("thumbv7em-")) {
        println!("cargo::rustc-cfg=usada8");
    }
}
