/* What a device has of its own: a clock, words to a host, a stack that is watched. */
#include "board.h"

extern uint32_t bss_end[], stack_top[];

static volatile uint32_t wraps;

/* Counts down from here, and once more to come round (Armv7-M ARM, B3.3). */
#define RELOAD 0x00ffffffu
#define SYST_CSR (*(volatile uint32_t *)0xe000e010u)
#define SYST_RVR (*(volatile uint32_t *)0xe000e014u)
#define SYST_CVR (*(volatile uint32_t *)0xe000e018u)

static uint32_t host(uint32_t operation, const void *argument) {
    register uint32_t r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

/* To the host's standard output: SYS_OPEN of ":tt" to write, once, then SYS_WRITE. */
void board_write(const char *words) {
    static uintptr_t console;
    static const char NAME[] = ":tt";
    uintptr_t length = 0;
    if (console == 0) {
        const uintptr_t open[3] = {(uintptr_t)NAME, 4, sizeof NAME - 1};
        console = host(0x01, open);
    }
    while (words[length]) {
        length++;
    }
    const uintptr_t write[3] = {console, (uintptr_t)words, length};
    host(0x05, write);
}

void board_exit(int failed) {
    /* ADP_Stopped_ApplicationExit or ADP_Stopped_RunTimeErrorUnknown. */
    host(0x18, (const void *)(failed ? 0x20023u : 0x20026u));
    for (;;) {
    }
}

void board_tick(void) { wraps++; }

void board_start_clock(void) {
    SYST_RVR = RELOAD;
    SYST_CVR = 0;
    SYST_CSR = 7;
}

uint64_t board_ticks(void) {
    for (;;) {
        uint32_t before = wraps, elapsed = RELOAD - SYST_CVR;
        if (before == wraps) {
            return (uint64_t)before * (RELOAD + 1u) + elapsed;
        }
    }
}

#define PAINT 0x5afe57acu

/* The lowest word that is watched: none of the statics. */
static uint32_t *stack_bottom(void) {
    const uintptr_t lowest = (uintptr_t)stack_top - 4u * BOARD_STACK_WORDS, statics = (uintptr_t)bss_end;
    return (uint32_t *)(lowest < statics ? statics : lowest);
}

void board_paint_stack(void) {
    uint32_t *here = (uint32_t *)__builtin_frame_address(0) - 64;
    for (uint32_t *word = stack_bottom(); word < here; word++) {
        *(volatile uint32_t *)word = PAINT;
    }
}

uint32_t board_stack_used(void) {
    const uint32_t *word = stack_bottom();
    if (*(const volatile uint32_t *)word != PAINT) {
        board_write("the stack came down to all that is watched: what was written below it is lost\n");
        board_exit(1);
    }
    while (word < stack_top && *(const volatile uint32_t *)word == PAINT) {
        word++;
    }
    return (uint32_t)(stack_top - word) * 4u;
}
