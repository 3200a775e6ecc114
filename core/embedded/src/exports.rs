//! The functions that C calls: pointers become borrows, or an error.
//!
//! What a caller promises is in `include/fluoropose.h`: that a pointer leads to as much memory as is said with it, that nothing
//! else uses that memory meanwhile, and that an implant and the memory of a session stay where they are while it is used.
//! What can be checked is: null, alignment, that bytes are a session at all. No panic crosses the border: the core has none
//! on any input, and a function that is `extern "C"` ends the program before it would unwind.
#![expect(
    unsafe_code,
    reason = "C has pointers; what it must promise of them is said beside each function in the header"
)]

use core::ffi::c_char;
use core::fmt::{self, Write};
use core::mem::MaybeUninit;
use core::slice;
use core::task::Poll;

use fluoropose::camera::CameraError;
use fluoropose::implant::ImplantFile;
use fluoropose::{Camera, Point};

use crate::block::{Block, Unit, units_for};
use crate::failure::{Failure, Status};
use crate::layouts::{CalibrationNumbers, CameraNumbers, CandidateNumbers, FoundNumbers, Room};
use crate::session::{Session, units_needed};

/// `fluoropose`: what begins a session's memory.
#[repr(C)]
pub struct Opened {
    /// That these bytes are a session: the first of them, which may be read before anything is known of the others.
    mark: u32,
    session: Session<'static>,
    /// Why the last call failed.
    failure: Option<Failure>,
}

/// "FLPO".
const MARK: u32 = 0x4f50_4c46;

/// The values at a pointer; `None` where it is null or not aligned. No values are at any place.
///
/// # Safety
/// What is not null leads to `count` values that nobody changes while 'a lasts.
unsafe fn list<'a, T>(first: *const T, count: usize) -> Option<&'a [T]> {
    if count == 0 {
        return Some(&[]);
    }
    let is_possible = !first.is_null() && first.is_aligned();
    let bytes = count.checked_mul(size_of::<T>())?;
    // SAFETY: it is not null, aligned, no longer than memory can be, and the rest is the caller's promise.
    (is_possible && bytes <= isize::MAX as usize)
        .then(|| unsafe { slice::from_raw_parts(first, count) })
}

/// Writes a value; not where the pointer is null or not aligned.
///
/// # Safety
/// What is not null leads to room for a value.
unsafe fn put<T>(place: *mut T, value: T) -> Result<(), Failure> {
    if place.is_null() || !place.is_aligned() {
        return Err(Failure::Pointer);
    }
    // SAFETY: it is not null and aligned, and there is room by the caller's promise.
    unsafe { place.write(value) };
    Ok(())
}

/// The session at a pointer; `None` where it is null, not aligned or none.
///
/// # Safety
/// What is not null leads to what [`fluoropose_open`] made, and nothing else uses it while 'a lasts.
unsafe fn opened<'a>(finder: *mut Opened) -> Option<&'a mut Opened> {
    if finder.is_null() || !finder.is_aligned() {
        return None;
    }
    // SAFETY: it is not null and aligned; what does not begin with the mark need not be longer than that, and is not borrowed.
    let mark = unsafe { (&raw const (*finder).mark).read() };
    // SAFETY: only `fluoropose_open` writes the mark, before a session, and takes it away before it writes anything else there.
    (mark == MARK).then(|| unsafe { &mut *finder })
}

impl Opened {
    /// Looks with another camera, where it is one.
    fn look_with(&mut self, camera: Result<Camera, CameraError>) -> Status {
        let set = camera.map(|camera| self.session.set_camera(camera));
        self.keep(set.map_err(Failure::from))
    }

    fn keep(&mut self, result: Result<(), Failure>) -> Status {
        self.failure = result.err();
        self.failure.map_or(Status::Ok, |failure| failure.status())
    }
}

/// Opens an implant file, checked or trusted.
///
/// # Safety
/// As [`list`], for as long as the answer is used.
unsafe fn implant<'a>(
    bytes: *const u8,
    length: usize,
    trusted: i32,
) -> Result<ImplantFile<'a>, Failure> {
    // SAFETY: the caller's promise.
    let bytes = unsafe { list(bytes, length) }.ok_or(Failure::Pointer)?;
    Ok(match trusted {
        0 => ImplantFile::open(bytes)?,
        _ => ImplantFile::trusted(bytes)?,
    })
}

/// Bytes of memory that a session takes; 0 where the implant is none or no frame has such a room.
///
/// # Safety
/// `implant` leads to `implant_bytes` bytes, `room` to a room, or they are null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fluoropose_bytes_needed(
    implant_file: *const u8,
    implant_bytes: usize,
    room: *const Room,
) -> usize {
    // SAFETY: the caller's promise.
    let (file, room) = unsafe { (implant(implant_file, implant_bytes, 1), list(room, 1)) };
    let units = file.ok().zip(room.and_then(<[Room]>::first));
    let units = units.and_then(|(file, room)| units_needed(&file, room));
    let own = units_for::<Opened>(1).unwrap_or_default();
    let units = units.and_then(|units| units.checked_add(own));
    units
        .and_then(|units| units.checked_mul(size_of::<Unit>()))
        .unwrap_or(0)
}

/// Makes a session in borrowed memory; `*finder` is null where it cannot be.
///
/// # Safety
/// The pointers lead to as much memory as is said with them, or are null; implant and memory stay where they are and are used
/// by nothing else for as long as the session is used.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fluoropose_open(
    finder: *mut *mut Opened,
    implant_file: *const u8,
    implant_bytes: usize,
    trusted: i32,
    room: *const Room,
    memory: *mut u8,
    bytes: usize,
) -> Status {
    // SAFETY: the caller's promise.
    if let Err(failure) = unsafe { put(finder, core::ptr::null_mut()) } {
        return failure.status();
    }
    // SAFETY: the caller's promise.
    let Some([room]) = (unsafe { list(room, 1) }) else {
        return Status::Pointer;
    };
    let memory = memory.cast::<MaybeUninit<Unit>>();
    if memory.is_null() || !memory.is_aligned() || bytes > isize::MAX as usize {
        return Status::Pointer;
    }
    // SAFETY: the caller's promise.
    let file = match unsafe { implant(implant_file, implant_bytes, trusted) } {
        Ok(file) => file,
        Err(failure) => return failure.status(),
    };
    // SAFETY: it is not null, aligned, no longer than memory can be, need not hold anything, and nothing else uses it by the
    // caller's promise.
    let units = unsafe { slice::from_raw_parts_mut(memory, bytes / size_of::<Unit>()) };
    let own = units_for::<Opened>(1).unwrap_or(usize::MAX);
    let Some((own, rest)) = units.split_at_mut_checked(own) else {
        return Status::Memory;
    };
    // Of a session that lay here nothing is left from now on, whatever becomes of the new one.
    own.fill(MaybeUninit::new(0));
    let session = match Session::new(file, room, Block::new(rest)) {
        Ok(session) => session,
        Err(failure) => return failure.status(),
    };
    let place = own.as_mut_ptr().cast::<Opened>();
    const { assert!(align_of::<Opened>() <= align_of::<Unit>()) };
    // SAFETY: `own` has room for it by `units_for`, at a place that suits it by the assertion above, and `rest`, which the
    // session borrows, is apart from it.
    unsafe {
        place.write(Opened {
            mark: MARK,
            session,
            failure: None,
        });
        put(finder, place).map_or_else(|failure| failure.status(), |()| Status::Ok)
    }
}

/// Gives the camera that frames are looked at with: at first, that of the implant's library.
///
/// # Safety
/// `finder` is an open session that nothing else uses, `camera` leads to room for one, or they are null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fluoropose_camera_of(
    finder: *mut Opened,
    camera: *mut CameraNumbers,
) -> Status {
    // SAFETY: the caller's promise.
    let Some(opened) = (unsafe { opened(finder) }) else {
        return Status::Pointer;
    };
    // SAFETY: the caller's promise.
    let told = unsafe { put(camera, opened.session.camera().into()) };
    opened.keep(told)
}

/// Looks at frames of another camera from now on.
///
/// # Safety
/// As [`fluoropose_camera_of`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fluoropose_set_camera(
    finder: *mut Opened,
    camera: *const CameraNumbers,
) -> Status {
    // SAFETY: the caller's promise.
    let (Some(opened), camera) = (unsafe { (opened(finder), list(camera, 1)) }) else {
        return Status::Pointer;
    };
    let Some([camera]) = camera else {
        return opened.keep(Err(Failure::Pointer));
    };
    opened.look_with(camera.camera())
}

/// The same of a camera whose detector's place is known: poses behind it are doubtful.
///
/// # Safety
/// As [`fluoropose_camera_of`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fluoropose_set_calibration(
    finder: *mut Opened,
    calibration: *const CalibrationNumbers,
) -> Status {
    // SAFETY: the caller's promise.
    let (Some(opened), calibration) = (unsafe { (opened(finder), list(calibration, 1)) }) else {
        return Status::Pointer;
    };
    let Some([calibration]) = calibration else {
        return opened.keep(Err(Failure::Pointer));
    };
    opened.look_with(calibration.camera())
}

/// Takes the outline of the next frame.
///
/// # Safety
/// `finder` is an open session that nothing else uses, `points` leads to `count` of them, or they are null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fluoropose_outline(
    finder: *mut Opened,
    points: *const Point,
    count: usize,
) -> Status {
    // SAFETY: the caller's promise.
    let (Some(opened), points) = (unsafe { (opened(finder), list(points, count)) }) else {
        return Status::Pointer;
    };
    let points = points.ok_or(Failure::Pointer);
    let taken = points.and_then(|points| opened.session.outline(points));
    opened.keep(taken)
}

/// Rows of the next frame's silhouette come.
///
/// # Safety
/// `finder` is an open session that nothing else uses, or null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fluoropose_begin_rows(finder: *mut Opened) -> Status {
    // SAFETY: the caller's promise.
    let Some(opened) = (unsafe { opened(finder) }) else {
        return Status::Pointer;
    };
    let begun = opened.session.begin_rows();
    opened.keep(begun)
}

/// Adds a row, a byte a pixel; what is not 0 is the silhouette.
///
/// # Safety
/// `finder` is an open session that nothing else uses, `pixels` leads to `width` bytes, or they are null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fluoropose_row(
    finder: *mut Opened,
    row: u32,
    pixels: *const u8,
    width: usize,
) -> Status {
    // SAFETY: the caller's promise.
    let (Some(opened), pixels) = (unsafe { (opened(finder), list(pixels, width)) }) else {
        return Status::Pointer;
    };
    let Some(pixels) = pixels else {
        return opened.keep(Err(Failure::Pointer));
    };
    let added = opened.session.row(row as usize, pixels);
    opened.keep(added)
}

/// Begins the search near a pose of the frame before.
///
/// # Safety
/// `finder` is an open session that nothing else uses, `before` leads to a candidate, or they are null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fluoropose_near(
    finder: *mut Opened,
    before: *const CandidateNumbers,
) -> Status {
    // SAFETY: the caller's promise.
    let (Some(opened), before) = (unsafe { (opened(finder), list(before, 1)) }) else {
        return Status::Pointer;
    };
    let Some([before]) = before else {
        return opened.keep(Err(Failure::Pointer));
    };
    let set = opened.session.near(&before.pose(), before.misfit_px);
    opened.keep(set)
}

/// Finds the poses that explain the silhouette.
///
/// # Safety
/// `finder` is an open session that nothing else uses, or null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fluoropose_find(finder: *mut Opened) -> Status {
    loop {
        // SAFETY: the caller's promise.
        match unsafe { fluoropose_go_on(finder, u32::MAX) } {
            Status::More => {}
            status => return status,
        }
    }
}

/// The same in slices: so many of them.
///
/// # Safety
/// As [`fluoropose_find`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fluoropose_go_on(finder: *mut Opened, slices: u32) -> Status {
    // SAFETY: the caller's promise.
    let Some(opened) = (unsafe { opened(finder) }) else {
        return Status::Pointer;
    };
    match opened.session.go_on(slices) {
        Poll::Ready(found) => opened.keep(found),
        Poll::Pending => Status::More,
    }
}

/// Tells what was found.
///
/// # Safety
/// `finder` is an open session that nothing else uses, `found` leads to room for it, or they are null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fluoropose_found_of(
    finder: *mut Opened,
    found: *mut FoundNumbers,
) -> Status {
    // SAFETY: the caller's promise.
    let Some(opened) = (unsafe { opened(finder) }) else {
        return Status::Pointer;
    };
    let decision = opened.session.decision();
    let numbers = decision.map(|(numbers, _)| numbers);
    // SAFETY: the caller's promise.
    let told = unsafe { put(found, numbers.unwrap_or_default()) };
    // Why nothing was found stays what there is to say.
    match (told, numbers) {
        (Ok(()), Err(failure)) => {
            opened.failure.get_or_insert(failure);
            failure.status()
        }
        (told, _) => opened.keep(told),
    }
}

/// Tells one of the poses, the best is number 0.
///
/// # Safety
/// `finder` is an open session that nothing else uses, `candidate` leads to room for it, or they are null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fluoropose_candidate_of(
    finder: *mut Opened,
    number: u32,
    candidate: *mut CandidateNumbers,
) -> Status {
    // SAFETY: the caller's promise.
    let Some(opened) = (unsafe { opened(finder) }) else {
        return Status::Pointer;
    };
    let numbers = opened.session.candidate(number as usize);
    // SAFETY: the caller's promise.
    let told = numbers.and_then(|numbers| unsafe { put(candidate, numbers) });
    opened.keep(told)
}

/// Writes the verdict, or why the last call failed, as a sentence without its full stop, cut off where there is no room and
/// ended by a zero. Gives the bytes of the whole sentence.
///
/// # Safety
/// `finder` is an open session that nothing else uses, `text` leads to `room` bytes, or they are null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fluoropose_sentence(
    finder: *mut Opened,
    text: *mut c_char,
    room: usize,
) -> usize {
    // SAFETY: the caller's promise.
    let Some(opened) = (unsafe { opened(finder) }) else {
        return 0;
    };
    let mut out = Text::new(text, room);
    // Writing into it does not fail.
    let _ = match (&opened.failure, opened.session.decision()) {
        (Some(failure), _) => write!(out, "{failure}"),
        (None, Ok((_, decision))) => write!(out, "{}", decision.verdict),
        (None, Err(failure)) => write!(out, "{failure}"),
    };
    out.end();
    out.needed
}

/// The same of why bytes cannot be opened; nothing where they can.
///
/// # Safety
/// `implant_file` leads to `implant_bytes` bytes, `text` to `room` bytes, or they are null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fluoropose_implant_sentence(
    implant_file: *const u8,
    implant_bytes: usize,
    trusted: i32,
    text: *mut c_char,
    room: usize,
) -> usize {
    let mut out = Text::new(text, room);
    // SAFETY: the caller's promise.
    if let Err(failure) = unsafe { implant(implant_file, implant_bytes, trusted) } {
        // Writing into it does not fail.
        let _ = write!(out, "{failure}");
    }
    out.end();
    out.needed
}

/// Bytes that C borrowed us for words.
struct Text {
    to: *mut c_char,
    room: usize,
    written: usize,
    needed: usize,
}

impl Text {
    /// At a null pointer there is no room.
    fn new(text: *mut c_char, room: usize) -> Self {
        Self {
            to: text,
            room: if text.is_null() { 0 } else { room },
            written: 0,
            needed: 0,
        }
    }

    fn byte(&mut self, byte: u8) {
        if self.written < self.room {
            // SAFETY: there are `room` bytes by the promise of who called.
            unsafe { self.to.add(self.written).write(byte as c_char) };
            self.written += 1;
        }
    }

    /// The zero at the end, in the place of the last byte where there is no room.
    fn end(&mut self) {
        self.written = self.written.min(self.room.saturating_sub(1));
        self.byte(0);
    }
}

impl Write for Text {
    fn write_str(&mut self, words: &str) -> fmt::Result {
        self.needed += words.len();
        words.bytes().for_each(|byte| self.byte(byte));
        Ok(())
    }
}
