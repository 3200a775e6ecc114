/* What a device has of its own: vectors, memory made ready, the floating point unit switched on, a clock, words to a host. */
#include "board.h"

extern uint32_t data_load[], data_begin[], data_end[], bss_begin[], bss_end[], stack_top[];

static volatile uint32_t wraps;

/* Counts down from here, and once more to come round (Armv7-M ARM, B3.3). */
#define RELOAD 0x00ffffffu
#define SYST_CSR (*(volatile uint32_t *)0xe000e010u)
#define SYST_RVR (*(volatile uint32_t *)0xe000e014u)
#define SYST_CVR (*(volatile uint32_t *)0xe000e018u)
#define CPACR (*(volatile uint32_t *)0xe000ed88u)

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

void reset(void);
void failed(void);
void tick(void);

void tick(void) { wraps++; }

void failed(void) {
    board_write("a fault of the processor\n");
    board_exit(1);
}

void reset(void) {
    CPACR |= 0xfu << 20;
    __asm__ volatile("dsb\n isb" ::: "memory");
    const uint32_t *from = data_load;
    for (uint32_t *to = data_begin; to < data_end; to++) {
        *(volatile uint32_t *)to = *from++;
    }
    for (uint32_t *to = bss_begin; to < bss_end; to++) {
        *(volatile uint32_t *)to = 0;
    }
    SYST_RVR = RELOAD;
    SYST_CVR = 0;
    SYST_CSR = 7;
    board_paint_stack();
    board_exit(application());
}

typedef void (*vector)(void);

__attribute__((section(".vectors"), used)) static const struct {
    uint32_t *stack;
    vector handlers[15];
} VECTORS = {
    stack_top,
    {reset, failed, failed, failed, failed, failed, 0, 0, 0, 0, failed, failed, 0, failed, tick},
};
