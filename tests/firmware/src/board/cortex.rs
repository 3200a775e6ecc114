//! Cortex-M: results through semihosting, instructions by SysTick.

use core::fmt;
use core::sync::atomic::{AtomicU32, Ordering};

use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m_rt::{entry, exception};
use cortex_m_semihosting::hio::HostStream;
use cortex_m_semihosting::{debug, hio};
use fluoropose_firmware::Memory;
use fluoropose_firmware::writing::{Write, divided};

use super::{Board, Told, prove, stack, tell_panic};

#[entry]
fn main() -> ! {
    // Made by the linker: a value that is moved into a static may pass over the stack, all of it.
    static mut MEMORY: Memory = Memory::new();
    static mut TOLD: Told = Told::new();
    stack::paint();
    let proof = CortexM::start().and_then(|mut board| prove(&mut board, MEMORY, TOLD));
    debug::exit(match proof {
        Ok(()) => debug::EXIT_SUCCESS,
        Err(_) => debug::EXIT_FAILURE,
    });
    loop {
        cortex_m::asm::wfi();
    }
}

/// Instructions for so many ticks of the core's clock: under QEMU with `-icount shift=6` an instruction takes 64 ns, 1.6 ticks of
/// 25 MHz and 10.752 of the 168 MHz of a Netduino Plus 2.
const RATE: (u64, u32) = if cfg!(feature = "netduinoplus2") {
    (125, 1344)
} else {
    (5, 8)
};

/// A console, and ticks of the core's clock.
struct CortexM {
    console: HostStream,
    last: u64,
}

impl Write for CortexM {
    fn write_str(&mut self, words: &str) -> fmt::Result {
        let written = self.console.write_all(words.as_bytes());
        written.map_err(|()| fmt::Error)
    }
}

impl Board for CortexM {
    fn instructions(&mut self) -> u64 {
        let now = now();
        let ticks = now - self.last;
        self.last = now;
        divided(ticks * RATE.0, RATE.1).0
    }
}

/// Times the 24-bit timer ran out.
static WRAPS: AtomicU32 = AtomicU32::new(0);
/// The timer counts down from here, and once more to come round.
const RELOAD: u32 = 0x00ff_ffff;

#[exception]
fn SysTick() {
    // Nobody else writes it; a Cortex-M0 has no instruction that adds to memory.
    WRAPS.store(WRAPS.load(Ordering::Relaxed) + 1, Ordering::Relaxed);
}

impl CortexM {
    fn start() -> Result<Self, fmt::Error> {
        let console = hio::hstdout().map_err(|()| fmt::Error)?;
        let mut timer = cortex_m::Peripherals::take().ok_or(fmt::Error)?.SYST;
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(RELOAD);
        timer.clear_current();
        timer.enable_interrupt();
        timer.enable_counter();
        Ok(Self { console, last: 0 })
    }
}

fn now() -> u64 {
    loop {
        let wraps = WRAPS.load(Ordering::Relaxed);
        let elapsed = RELOAD - SYST::get_current();
        // A wrap between the two readings would mix the old count with the new time.
        if wraps == WRAPS.load(Ordering::Relaxed) {
            return u64::from(wraps) * (u64::from(RELOAD) + 1) + u64::from(elapsed);
        }
    }
}

#[panic_handler]
fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
    if let Ok(console) = hio::hstderr() {
        let _ = tell_panic(&mut CortexM { console, last: 0 }, info);
    }
    loop {
        debug::exit(debug::EXIT_FAILURE);
    }
}
