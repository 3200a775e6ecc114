/* fluoropose: the pose of a known implant from one X-ray silhouette, in memory that the caller lends.
 *
 * One session at a time is used by one thread at a time. Nothing is allocated, nothing is kept but in the memory that was lent,
 * and no function ends the program. A null pointer, or one to an address that does not suit its type, is FLUOROPOSE_POINTER;
 * that a pointer leads to as much memory as is said with it is the caller's to promise. Lengths are pixels of the frame or
 * millimetres; column and row of a point are continuous: a pixel's middle is its number + 0.5, rows run down.
 *
 * Checked against the library by `cargo xtask test` (names, layouts) and compiled by `cargo xtask test --firmware`. */
#ifndef FLUOROPOSE_H
#define FLUOROPOSE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What a function gives back. */
typedef int32_t fluoropose_status;
#define FLUOROPOSE_OK 0
#define FLUOROPOSE_POINTER 1    /* a pointer is null, does not suit its type, or leads to no session */
#define FLUOROPOSE_MEMORY 2     /* the memory is too short for the room, or the room is that of no frame */
#define FLUOROPOSE_IMPLANT 3    /* the bytes are no implant file, damaged, or not at a multiple of 4 */
#define FLUOROPOSE_CAMERA 4     /* the numbers are those of no camera */
#define FLUOROPOSE_OUTLINE 5    /* the points are no outline: too few, outside the frame, crossing */
#define FLUOROPOSE_ROWS 6       /* rows do not rise, are not as wide as the frame, or have more runs than there is room for */
#define FLUOROPOSE_SILHOUETTE 7 /* the silhouette is empty, or there is too little room: the sentence says of what */
#define FLUOROPOSE_NO_POSE 8    /* no pose explains the silhouette */
#define FLUOROPOSE_ORDER 9      /* a call came before the one that it goes on from, or there is no such candidate */
#define FLUOROPOSE_MORE 10      /* slices are left: call fluoropose_go_on again */
#define FLUOROPOSE_NEAR 11      /* what a search was to begin near is no pose */

/* A session; it lies at the beginning of the memory that was lent. */
typedef struct fluoropose fluoropose;

/* How much there is to be memory for. */
typedef struct {
    uint32_t columns; /* of the largest part of a frame: a silhouette and 24 pixels around it */
    uint32_t rows;    /* of the same */
    uint32_t border;  /* pixels of the longest outline, of silhouette and model as drawn */
    uint32_t runs;    /* runs of pixels of silhouettes that come row by row; 0 where they come as outlines */
} fluoropose_room;

/* A pinhole camera at the X-ray focus, looking along -z with y up; pixels. */
typedef struct {
    uint32_t width;
    uint32_t height;
    double fx;
    double fy;
    double cx;
    double cy;
} fluoropose_camera;

/* A camera by the field's quantities. */
typedef struct {
    uint32_t width;
    uint32_t height;
    double distance_mm; /* from the focus to the detector */
    double pitch_mm;    /* between pixels, at the detector */
    double right_mm;    /* the principal point, to the right of the frame's middle, at the detector */
    double up_mm;       /* the same, up */
} fluoropose_calibration;

/* A point of an outline. */
typedef struct {
    double column;
    double row;
} fluoropose_point;

/* 0 is no verdict: memory of zeros, which nothing was written to, says nothing good. */
#define FLUOROPOSE_GOOD 1
#define FLUOROPOSE_DOUBTFUL 2
#define FLUOROPOSE_NONE 3

/* What was found, and how far it is to be trusted. */
typedef struct {
    uint32_t verdict;    /* FLUOROPOSE_GOOD, FLUOROPOSE_DOUBTFUL or FLUOROPOSE_NONE */
    uint32_t candidates; /* poses that explain the silhouette */
    uint32_t chosen;     /* which of them was chosen, from 0 */
    uint32_t part[4];    /* left column, upper row, columns and rows of what was looked at */
} fluoropose_found;

/* A pose, how sure it is and how well it fits. */
typedef struct {
    double rotation[3][3];    /* camera_from_model, row by row: Rz(z_rot) * Rx(x_rot) * Ry(y_rot) */
    double translation_mm[3]; /* of the model's origin: right, up, backwards: z is negative in front of the focus */
    double rotations_deg[3];  /* z_rot, x_rot, y_rot */
    double covariance[6][6];  /* of a small turn about the model's middle (radians, camera axes), then of a shift of it (mm) */
    double misfit_px;         /* root of twice the robust loss: poses are compared by it */
    double met;               /* part of the model's outline that the silhouette's meets */
    uint32_t drawings;        /* times the model was drawn from the pose's start to its end */
    uint32_t has_covariance;  /* 0 where the outline does not determine the pose: covariance is zeros then */
} fluoropose_candidate;

/* Bytes of memory that a session takes; 0 where the implant is none or the room is that of no frame. */
size_t fluoropose_bytes_needed(const uint8_t *implant_file, size_t implant_bytes, const fluoropose_room *room);

/* Makes a session in `bytes` bytes of `memory`, at a multiple of 8. `trusted` is not 0 where a boot loader has checked the
 * implant's bytes: only its header is read then, and of damaged bytes poses mean nothing. Implant and memory stay where they
 * are, and are used by nothing else, for as long as the session is. There is nothing to close. `*finder` is null where it
 * fails; a session that lay in that memory may be gone then too. */
fluoropose_status fluoropose_open(fluoropose **finder, const uint8_t *implant_file, size_t implant_bytes, int32_t trusted,
                                  const fluoropose_room *room, uint8_t *memory, size_t bytes);

/* The camera that frames are looked at with: at first, that of the implant's library. */
fluoropose_status fluoropose_camera_of(fluoropose *finder, fluoropose_camera *camera);

/* Looks at frames of another camera from now on; a search that was begun is given up, a silhouette forgotten. */
fluoropose_status fluoropose_set_camera(fluoropose *finder, const fluoropose_camera *camera);

/* The same of a camera whose detector's place is known, which no other tells: poses behind it are doubtful. Its pixels are square; those of
 * another pitch along rows than along columns are fluoropose_set_camera's, with fx and fy apart. */
fluoropose_status fluoropose_set_calibration(fluoropose *finder, const fluoropose_calibration *calibration);

/* Takes the outline of the next frame, whose last point is joined to the first. The points are needed no more afterwards. */
fluoropose_status fluoropose_outline(fluoropose *finder, const fluoropose_point *points, size_t count);

/* The rows of the next frame's silhouette come, as a detector reads them out. */
fluoropose_status fluoropose_begin_rows(fluoropose *finder);

/* Adds a row below those before it, a byte a pixel: what is not 0 is the silhouette. `width` is the camera's: a part of a row would be
 * looked for in another place. Rows without any may be left out. */
fluoropose_status fluoropose_row(fluoropose *finder, uint32_t row, const uint8_t *pixels, size_t width);

/* Finds the poses that explain the silhouette, and their mirror images; chooses among them and judges the choice. */
fluoropose_status fluoropose_find(fluoropose *finder);

/* The same in slices, with the same answer to the last bit: FLUOROPOSE_MORE as long as some are left. A slice is the search
 * of the library, or one drawing of the model with its readings. */
fluoropose_status fluoropose_go_on(fluoropose *finder, uint32_t slices);

/* After the silhouette, before the search: it begins near a pose of the frame before, of which rotation, translation and misfit are read.
 * Where that leads to a good one which leaves at most twice as much (0.2 pixels where that is less), the library is not searched and no pose far away is among the
 * candidates; where it does not, the search is as if this had not been called. Of a film, misfit_px is best that of a frame that was
 * searched as a whole. */
fluoropose_status fluoropose_near(fluoropose *finder, const fluoropose_candidate *before);

/* What was found; `found->verdict` is 0 where nothing was. */
fluoropose_status fluoropose_found_of(fluoropose *finder, fluoropose_found *found);

/* One of the poses; the best is number 0. */
fluoropose_status fluoropose_candidate_of(fluoropose *finder, uint32_t number, fluoropose_candidate *candidate);

/* Writes the verdict, or why the last call failed, as a sentence without its full stop, cut off where it does not fit into
 * `room` bytes and ended by a zero. Gives the bytes of the whole sentence without that zero. */
size_t fluoropose_sentence(fluoropose *finder, char *text, size_t room);

/* The same of why bytes cannot be opened, checked or trusted: fluoropose_open leaves no session that could be asked. Nothing (0) where they can. */
size_t fluoropose_implant_sentence(const uint8_t *implant_file, size_t implant_bytes, int32_t trusted, char *text, size_t room);

#ifdef __cplusplus
}
#endif

#endif
