/* From an outline anywhere in the frame to a chosen and judged pose: the program to copy from.
 *
 * It writes the lines that the same program in Rust writes (tests/firmware/src/finding.rs); `cargo xtask test --firmware` builds
 * both, runs them under QEMU and compares. IMPLANT_FILE and OUTLINE_FILE name what goes into flash. */
#include "board.h"
#include "fluoropose.h"
#include "writing.h"

/* Bytes in flash, at a multiple of 8. */
#define IN_FLASH(name, file)                                                                                                  \
    __asm__(".section .rodata." #name "\n.balign 8\n.global " #name "\n" #name ":\n.incbin \"" file "\"\n.global " #name       \
            "_end\n" #name "_end:\n.text\n");                                                                                 \
    extern const uint8_t name[], name##_end[]

IN_FLASH(implant, IMPLANT_FILE);
IN_FLASH(outline, OUTLINE_FILE);

/* The largest silhouette with its margin, and the longest outline. */
static const fluoropose_room ROOM = {.columns = 224, .rows = 288, .border = 900, .runs = 0};

/* The device's camera. That of the implant's library sees the same, but does not know where its detector is, behind which nothing
 * lies: an outline of some pixels could be that of an implant far behind it. */
static const fluoropose_calibration CALIBRATION = {.width = 512, .height = 512, .distance_mm = 1000, .pitch_mm = 0.4};

/* All that the library works in. fluoropose_bytes_needed tells how much it has to be. */
static uint64_t memory[192 * 1024 / 8];

static int fail(fluoropose *finder, const char *what, fluoropose_status status) {
    char sentence[200] = "";
    fluoropose_sentence(finder, sentence, sizeof sentence);
    write_words(what);
    write_words(": status ");
    write_number((uint64_t)status);
    write_words(" ");
    write_words(sentence);
    write_words("\n");
    return 1;
}

static void report(const fluoropose_found *found, const fluoropose_candidate *best) {
    static const char *const VERDICTS[] = {"no verdict", "good", "doubtful", "none"};
    static const char *const NUMBERS[] = {"x mm", "y mm", "z mm", "z_rot deg", "x_rot deg", "y_rot deg"};
    write_number(found->part[2]);
    write_words(" x ");
    write_number(found->part[3]);
    write_words(" pixels, ");
    write_number(found->candidates);
    write_words(" candidates, ");
    write_number(found->chosen);
    write_words(" chosen\n");
    write_words(VERDICTS[found->verdict]);
    write_words("\n");
    for (int k = 0; k < 6; k++) {
        write_double(NUMBERS[k], k < 3 ? best->translation_mm[k] : best->rotations_deg[k - 3]);
    }
    write_number(best->drawings);
    write_words(" drawings led to it\n");
}

static void tell(const char *what, uint64_t value, const char *unit) {
    write_words("info: ");
    write_words(what);
    write_words(": ");
    write_number(value);
    write_words(unit);
}

int application(void) {
    fluoropose *finder = NULL;
    const size_t bytes = (size_t)(implant_end - implant);
    /* Not trusted: every byte is checked. A boot loader that has done so passes 1. */
    fluoropose_status status = fluoropose_open(&finder, implant, bytes, 0, &ROOM, (uint8_t *)memory, sizeof memory);
    const size_t needed = fluoropose_bytes_needed(implant, bytes, &ROOM);
    if (status != FLUOROPOSE_OK) {
        char sentence[200];
        fluoropose_implant_sentence(implant, bytes, 0, sentence, sizeof sentence);
        write_words(sentence);
        write_words("\n");
        tell("memory that would be needed", needed, " bytes\n");
        return fail(finder, "the implant cannot be opened", status);
    }
    status = fluoropose_set_calibration(finder, &CALIBRATION);
    if (status != FLUOROPOSE_OK) {
        return fail(finder, "the camera is none", status);
    }
    status = fluoropose_outline(finder, (const fluoropose_point *)(const void *)outline,
                                (size_t)(outline_end - outline) / sizeof(fluoropose_point));
    if (status != FLUOROPOSE_OK) {
        return fail(finder, "the outline is none", status);
    }
    /* One slice at a time: between two of them there is time for a watchdog, or for other work. */
    uint64_t longest = 0, slices = 0, begun = board_ticks();
    do {
        const uint64_t before = board_ticks();
        status = fluoropose_go_on(finder, 1);
        const uint64_t took = board_ticks() - before;
        longest = took > longest ? took : longest;
        slices++;
    } while (status == FLUOROPOSE_MORE);
    const uint64_t all = board_ticks() - begun;
    fluoropose_found found;
    fluoropose_candidate best;
    if (status == FLUOROPOSE_OK) {
        status = fluoropose_found_of(finder, &found);
    }
    if (status == FLUOROPOSE_OK) {
        status = fluoropose_candidate_of(finder, found.chosen, &best);
    }
    if (status != FLUOROPOSE_OK) {
        return fail(finder, "no pose was found", status);
    }
    report(&found, &best);
    tell("candidates, mirror images, verdict, in slices", all * 5 / 8, " instructions\n");
    tell("longest slice", longest * 5 / 8, " instructions\n");
    tell("slices", slices, " slices\n");
    tell("working memory", needed, " bytes\n");
    tell("stack at its highest", board_stack_used(), " bytes\n");
    return 0;
}
