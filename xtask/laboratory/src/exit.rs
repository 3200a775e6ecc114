//! What the command exits with: one list for all verbs, which every `--help` ends with.

/// Done, and something is doubtful: [`CODES`] says what, verb by verb.
pub const DOUBTFUL: u8 = 3;
/// A study's input is bad.
pub const BAD_INPUT: u8 = 4;
/// A study broke the program off.
pub const CRASHED: u8 = 5;
/// A study is not done.
pub const NOT_DONE: u8 = 6;
/// No frame has a pose, or a joint.
pub const NOTHING_FOUND: u8 = 7;

/// The list as a person reads it.
pub const CODES: &str = "Exit codes: 0 done (which poses are doubtful, tables and verdicts tell); 1 not done, the message says why; 2 the command line \
cannot be understood; 3 done, but numbers are such as no knee has (kinematics, report, track), no pose is good (pose; track: of a component), a pose is doubtful or missing (biplane), a mask fits no implant (identify), the calibration is doubtful (calibrate), the file for a microcontroller misses poses (library), or frames are doubtful (batch); 4, 5 and 6 bad input, crash, not done \
(batch, collect); 7 no frame has a pose (pose, track) or a joint (report, kinematics). Where the system ends the program: 130 Ctrl-C (SIGINT), 137 killed (SIGKILL, as where memory runs \
out), 141 nobody reads its output any more (SIGPIPE, as behind `| head`), 143 asked to end (SIGTERM, as by a cluster at the end of a task's time).";
