//! The work of a session between two calls: a future in borrowed memory.
#![expect(
    unsafe_code,
    reason = "a future whose type has no name is kept in memory of its size"
)]

use core::future::Future;
use core::mem::MaybeUninit;
use core::pin::Pin;
use core::task::Poll;

use fluoropose::pace::{Pace, go_on};

use crate::block::{Block, Unit, units_for};
use crate::failure::Failure;
use crate::layouts::Room;
use crate::session::{Session, units_needed};
use fluoropose::implant::ImplantFile;

type Work = dyn Future<Output = Result<(), Failure>>;

/// A session and its work, of which only one is used at a time.
pub(crate) struct Task {
    /// What the session was made in; nothing else leads there, and while there is work only the work uses it.
    session: *mut Session<'static>,
    pace: &'static Pace,
    room: &'static mut [MaybeUninit<Unit>],
    /// In `room`.
    work: Option<Pin<&'static mut Work>>,
}

/// Units of memory that a task of an implant takes; `None` for a room that no frame has.
pub(crate) fn task_units(implant: &ImplantFile<'_>, room: &Room) -> Option<usize> {
    let own = units_for::<Session<'static>>(1)? + units_for::<Pace>(1)? + work_units();
    units_needed(implant, room)?.checked_add(own)
}

/// Units that the work takes.
fn work_units() -> usize {
    fn size<F>(_: impl FnOnce(&'static mut Session<'static>, &'static Pace) -> F) -> usize {
        size_of::<F>()
    }
    size(Session::find).div_ceil(size_of::<Unit>())
}

impl Task {
    /// A session without work.
    ///
    /// # Errors
    /// [`Failure::Memory`] where there is too little.
    pub(crate) fn new(
        implant: ImplantFile<'static>,
        room: &Room,
        memory: &'static mut [MaybeUninit<Unit>],
    ) -> Result<Self, Failure> {
        let mut block = Block::new(memory);
        let pace = block.put(Pace::new()).ok_or(Failure::Memory)?;
        let work = block.units(work_units()).ok_or(Failure::Memory)?;
        let place = block.units(units_for::<Session<'static>>(1).unwrap_or(usize::MAX));
        let mut place = Block::new(place.ok_or(Failure::Memory)?);
        let session = place.put(Session::new(implant, room, block)?);
        Ok(Self {
            session: session.ok_or(Failure::Memory)?,
            pace,
            room: work,
            work: None,
        })
    }

    /// The session; its work is given up.
    pub(crate) fn session(&mut self) -> &mut Session<'static> {
        self.give_up();
        // SAFETY: it was made in `new`, nothing else leads to it, and the work, which used it, is gone.
        unsafe { &mut *self.session }
    }

    /// The session as it is; `None` while it works.
    pub(crate) fn idle(&self) -> Option<&Session<'static>> {
        // SAFETY: it was made in `new`, and nobody uses it but the work, which there is none of.
        self.work.is_none().then(|| unsafe { &*self.session })
    }

    fn give_up(&mut self) {
        if let Some(work) = self.work.take() {
            // SAFETY: it was written where it is, is used no more, and nothing is dropped twice: it was taken.
            unsafe { core::ptr::drop_in_place(Pin::get_unchecked_mut(work)) };
        }
    }

    /// Goes on with the search for so many slices; begins it where it was not begun.
    pub(crate) fn go_on(&mut self, slices: u32) -> Poll<Result<(), Failure>> {
        if self.work.is_none() {
            // SAFETY: as in `session`; until the work is given up only the work uses it.
            let session: &'static mut Session<'static> = unsafe { &mut *self.session };
            self.work = kept(self.room, session.find(self.pace));
        }
        let Some(work) = &mut self.work else {
            return Poll::Ready(Err(Failure::Memory));
        };
        let done = go_on(work.as_mut(), self.pace, slices);
        if done.is_ready() {
            self.give_up();
        }
        done
    }
}

/// Work moved to where it stays; `None` where there is too little room, which [`work_units`] makes.
fn kept<F: Future<Output = Result<(), Failure>> + 'static>(
    room: &mut [MaybeUninit<Unit>],
    work: F,
) -> Option<Pin<&'static mut Work>> {
    const { assert!(align_of::<F>() <= align_of::<Unit>()) };
    if size_of::<F>() > size_of_val(room) {
        return None;
    }
    let place = room.as_mut_ptr().cast::<F>();
    // SAFETY: there is room for it at a place that suits it, by both checks; `room` is the task's own for ever, holds nothing
    // else, and what is in it is not moved until it is dropped.
    unsafe {
        place.write(work);
        Some(Pin::new_unchecked(&mut *place))
    }
}
