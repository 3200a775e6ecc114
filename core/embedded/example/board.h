/* The board under the example. */
#ifndef BOARD_H
#define BOARD_H

#include <stdint.h>

/* Words of stack that are watched, where there are so many above the statics. */
#define BOARD_STACK_WORDS (32u * 1024u)

/* The program, which start.c calls: gives 0 where it succeeded. */
int application(void);

/* Words for whoever watches. */
void board_write(const char *words);
/* Ends the program. */
void board_exit(int failed) __attribute__((noreturn));
/* Ticks of the clock. Under QEMU with `-icount shift=6` an instruction takes 1.6 of them. */
uint64_t board_ticks(void);
void board_start_clock(void);
/* To be called where the clock has come round. */
void board_tick(void);
/* Bytes of stack that were used at its highest. Where it came down to the statics nothing that follows holds: the program ends with a word. */
void board_paint_stack(void);
uint32_t board_stack_used(void);

#endif
