//! The finder behind a C interface: `include/fluoropose.h` says what each function takes and gives.
//!
//! ```sh
//! cargo rustc -p fluoropose-embedded --profile embedded --target thumbv7em-none-eabihf --crate-type staticlib
//! ```
//!
//! makes `libfluoropose_embedded.a`. [`Session`] is all of it in safe Rust; [`exports`] turns pointers into borrows and back,
//! and nothing else.
#![cfg_attr(target_os = "none", no_std)]

mod block;
pub mod exports;
mod failure;
mod layouts;
mod session;

pub use failure::{Failure, Status};
pub use layouts::{
    CalibrationNumbers, CameraNumbers, CandidateNumbers, FoundNumbers, PointNumbers, Room,
};
pub use session::Session;

/// Nothing in the core panics; should it, the watchdog of the device is what ends it. It is not entered by a way back to C.
#[cfg(target_os = "none")]
#[panic_handler]
fn panicked(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {
        core::hint::spin_loop();
    }
}
