//! The proof on a Cortex-M4F: results through semihosting, instructions by SysTick, stack by painting it.

use core::fmt::{self, Write};
use core::sync::atomic::{AtomicU32, Ordering};

use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m_rt::{entry, exception};
use cortex_m_semihosting::hio::HostStream;
use cortex_m_semihosting::{debug, hio};
use fluoropose_firmware::{DATA, Memory};

mod stack;

/// Lines that start with this are not compared with the host's.
const INFORMATION: &str = "info";

/// What the proof writes, before it is shown.
type Lines = heapless::String<8192>;

#[entry]
fn main() -> ! {
    // Made by the linker: a value that is moved into a static may pass over the stack, all of it.
    static mut MEMORY: Memory = Memory::new();
    static mut LINES: Lines = Lines::new();
    stack::paint();
    let outcome = run(MEMORY, LINES);
    debug::exit(match outcome {
        Ok(()) => debug::EXIT_SUCCESS,
        Err(_) => debug::EXIT_FAILURE,
    });
    loop {
        cortex_m::asm::wfi();
    }
}

fn run(memory: &mut Memory, lines: &mut Lines) -> fmt::Result {
    let mut console = hio::hstdout().map_err(|()| fmt::Error)?;
    let mut clock = Clock::start(cortex_m::Peripherals::take().ok_or(fmt::Error)?.SYST);
    let mut stages: heapless::Vec<(u64, heapless::String<40>), 8> = heapless::Vec::new();
    let mut stage = |name: &str| {
        let ticks = clock.lap();
        if let Ok(name) = heapless::String::try_from(name) {
            // A ninth stage would not be told; there are at most six.
            let _ = stages.push((ticks, name));
        }
    };
    let proof = fluoropose_firmware::run(memory, lines, &mut stage);
    console
        .write_all(lines.as_bytes())
        .map_err(|()| fmt::Error)?;
    for (ticks, name) in &stages {
        let instructions = ticks * 5 / 8;
        writeln!(
            console,
            "{INFORMATION}: {name}: {instructions} instructions"
        )?;
    }
    report_memory(&mut console)?;
    proof.map_err(|failure| {
        let _ = writeln!(console, "{failure}");
        fmt::Error
    })
}

fn report_memory(console: &mut HostStream) -> fmt::Result {
    let data: usize = DATA.iter().map(|(_, bytes)| bytes).sum();
    let [first, second] = DATA;
    let bytes = [
        ("working memory", size_of::<Memory>()),
        ("code and constants in flash", stack::code() - data),
        first,
        second,
        ("all statics", stack::statics()),
        ("stack at its highest", stack::most_used()),
    ];
    for (name, bytes) in bytes {
        writeln!(console, "{INFORMATION}: {name}: {bytes} bytes")?;
    }
    Ok(())
}

/// Times the 24-bit timer ran out.
static WRAPS: AtomicU32 = AtomicU32::new(0);
/// The timer counts down from here, and once more to come round.
const RELOAD: u32 = 0x00ff_ffff;

#[exception]
fn SysTick() {
    WRAPS.fetch_add(1, Ordering::Relaxed);
}

/// Ticks of the core's clock. Under QEMU with `-icount shift=6` an instruction takes 64 ns, 1.6 ticks of 25 MHz.
struct Clock {
    last: u64,
}

impl Clock {
    fn start(mut timer: SYST) -> Self {
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(RELOAD);
        timer.clear_current();
        timer.enable_interrupt();
        timer.enable_counter();
        Self { last: 0 }
    }

    /// Ticks since the last call.
    fn lap(&mut self) -> u64 {
        let now = Self::now();
        let ticks = now - self.last;
        self.last = now;
        ticks
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
}

#[panic_handler]
fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
    if let Ok(mut console) = hio::hstderr() {
        let _ = writeln!(console, "{info}");
    }
    loop {
        debug::exit(debug::EXIT_FAILURE);
    }
}
