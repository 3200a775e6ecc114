#include "writing.h"
#include "board.h"

void write_words(const char *words) { board_write(words); }

/* At least so many digits, in a base up to 16. */
static void write_digits(uint64_t number, unsigned base, unsigned least) {
    char digits[24];
    char *first = digits + sizeof digits - 1;
    *first = 0;
    for (unsigned count = 0; number > 0 || count < least; count++) {
        *--first = "0123456789abcdef"[number % base];
        number /= base;
    }
    board_write(first);
}

void write_number(uint64_t number) { write_digits(number, 10, 1); }

void write_double(const char *name, double value) {
    const union {
        double value;
        uint64_t bits;
    } same = {.value = value};
    const double size = value < 0 ? -value : value;
    uint64_t whole = (uint64_t)size;
    /* The fraction is exact; its millionths are rounded once more, which only a tie would show. */
    uint64_t millionths = (uint64_t)((size - (double)whole) * 1e6 + 0.5);
    if (millionths == 1000000u) {
        whole++;
        millionths = 0;
    }
    write_words("  ");
    write_words(name);
    write_words(same.bits >> 63 ? ": -" : ": ");
    write_number(whole);
    write_words(".");
    write_digits(millionths, 10, 6);
    write_words(" (");
    write_digits(same.bits, 16, 16);
    write_words(")\n");
}
