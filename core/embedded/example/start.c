/* How a device begins: vectors, memory made ready, the floating point unit switched on, the program. */
#include "board.h"

extern uint32_t data_load[], data_begin[], data_end[], bss_begin[], bss_end[], stack_top[];

#define CPACR (*(volatile uint32_t *)0xe000ed88u)

/* The program: gives 0 where it succeeded. */
int application(void);
void reset(void);
void failed(void);

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
    board_start_clock();
    board_paint_stack();
    board_exit(application());
}

typedef void (*vector)(void);

__attribute__((section(".vectors"), used)) static const struct {
    uint32_t *stack;
    vector handlers[15];
} VECTORS = {
    stack_top,
    {reset, failed, failed, failed, failed, failed, 0, 0, 0, 0, failed, failed, 0, failed, board_tick},
};
