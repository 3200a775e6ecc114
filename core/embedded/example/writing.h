/* Words and numbers, without a C library. */
#ifndef WRITING_H
#define WRITING_H

#include <stdint.h>

void write_words(const char *words);
void write_number(uint64_t number);
/* A line: a number with six decimals, and every bit of it. */
void write_double(const char *name, double value);

#endif
