//! RISC-V, QEMU's virt board: results by its serial port, instructions by the counter of those that were retired.
#![expect(
    unsafe_code,
    reason = "registers of a board are only reachable through addresses, and it begins in assembly"
)]

use core::arch::{asm, global_asm};
use core::fmt;
use core::ptr::write_volatile;

use fluoropose_firmware::Memory;
use fluoropose_firmware::writing::Write;

use super::{Board, Told, prove, stack, tell_panic};

// Memory is made ready, the stack is set, and there is one processor.
global_asm!(
    ".section .start, \"ax\"",
    ".global _start",
    "_start:",
    "la sp, _stack_start",
    "la t0, __load",
    "la t1, __sdata",
    "la t2, __edata",
    "1: bgeu t1, t2, 2f",
    "lw t3, 0(t0)",
    "sw t3, 0(t1)",
    "addi t0, t0, 4",
    "addi t1, t1, 4",
    "j 1b",
    "2: la t1, __sbss",
    "la t2, __ebss",
    "3: bgeu t1, t2, 4f",
    "sw zero, 0(t1)",
    "addi t1, t1, 4",
    "j 3b",
    "4: call begin",
);

/// The serial port's register of what is sent (NS16550).
const SERIAL: *mut u8 = 0x1000_0000 as *mut u8;
/// What ends the emulation (SiFive's test device), and how.
const END: *mut u32 = 0x0010_0000 as *mut u32;
const PASSED: u32 = 0x5555;
const FAILED: u32 = 0x1_3333;

#[unsafe(no_mangle)]
extern "C" fn begin() -> ! {
    static mut MEMORY: Memory = Memory::new();
    static mut TOLD: Told = Told::new();
    stack::paint();
    let (memory, told) = (&raw mut MEMORY, &raw mut TOLD);
    // SAFETY: this runs once, so nothing else leads to them.
    let (memory, told) = unsafe { (&mut *memory, &mut *told) };
    let proof = prove(&mut Virt { last: retired() }, memory, told);
    end(if proof.is_ok() { PASSED } else { FAILED })
}

fn end(how: u32) -> ! {
    // SAFETY: the device is there on this board.
    unsafe { write_volatile(END, how) };
    loop {
        core::hint::spin_loop();
    }
}

struct Virt {
    last: u64,
}

impl Write for Virt {
    fn write_str(&mut self, words: &str) -> fmt::Result {
        for byte in words.bytes() {
            // SAFETY: the port is there on this board, and is ready at once under emulation.
            unsafe { write_volatile(SERIAL, byte) };
        }
        Ok(())
    }
}

impl Board for Virt {
    fn instructions(&mut self) -> u64 {
        let now = retired();
        let count = now - self.last;
        self.last = now;
        count
    }
}

/// Instructions retired since the start.
fn retired() -> u64 {
    loop {
        let (low, high, again): (u32, u32, u32);
        // SAFETY: reading counters has no effect.
        unsafe {
            asm!("csrr {}, minstreth", out(reg) high);
            asm!("csrr {}, minstret", out(reg) low);
            asm!("csrr {}, minstreth", out(reg) again);
        }
        if high == again {
            return u64::from(high) << 32 | u64::from(low);
        }
    }
}

#[panic_handler]
fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
    let _ = tell_panic(&mut Virt { last: 0 }, info);
    end(FAILED)
}
