//! Long work in slices: the processor is given up after so much of it, and taken again later.
//!
//! Work that is long (`find_paced`, `refine_paced`) is a future that pauses between slices, the longest of which is one
//! drawing of the model with its readings. It needs no executor and no allocation: [`go_on`] goes on with it for a number of
//! slices, as often as the caller likes, and what comes of it is to the last bit what comes of it at once.
//!
//! ```
//! use core::pin::pin;
//! use core::task::Poll;
//! use fluoropose::pace::{Pace, go_on, in_slices};
//!
//! let (pace, mut left) = (Pace::new(), 5);
//! let mut work = pin!(in_slices(&pace, move || {
//!     left -= 1;
//!     if left > 0 { Poll::Pending } else { Poll::Ready(()) }
//! }));
//! assert!(go_on(work.as_mut(), &pace, 3).is_pending()); // three slices; then the watchdog, or other work
//! assert_eq!(go_on(work.as_mut(), &pace, 3), Poll::Ready(()));
//! ```
//!
//! Under an executor `poll_fn(|context| { pace.allow(1); work.as_mut().poll(context) }).await` gives way to other tasks after
//! each slice.

use core::cell::Cell;
use core::future::{Future, poll_fn};
use core::pin::Pin;
use core::task::{Context, Poll, Waker, ready};

/// How many slices of some work are left before it pauses.
#[derive(Clone, Debug, Default)]
pub struct Pace {
    slices: Cell<u32>,
}

impl Pace {
    /// None: work begins with [`go_on`].
    #[must_use]
    pub const fn new() -> Self {
        Self {
            slices: Cell::new(0),
        }
    }

    /// Goes on with the work for so many slices more.
    pub fn allow(&self, slices: u32) {
        self.slices.set(slices);
    }

    /// A slice, where one is left.
    fn take(&self, context: &mut Context<'_>) -> Poll<()> {
        match self.slices.get().checked_sub(1) {
            Some(left) => {
                self.slices.set(left);
                Poll::Ready(())
            }
            None => {
                context.waker().wake_by_ref();
                Poll::Pending
            }
        }
    }
}

/// Goes on with work that keeps to a pace for so many slices: [`Poll::Pending`] where more are left. Work that is
/// finished must not be gone on with.
pub fn go_on<F: Future + ?Sized>(work: Pin<&mut F>, pace: &Pace, slices: u32) -> Poll<F::Output> {
    pace.allow(slices);
    work.poll(&mut Context::from_waker(Waker::noop()))
}

/// Work of which `slice` does one slice, as a future that keeps to a pace; [`Poll::Ready`] is the last.
pub fn in_slices<T>(pace: &Pace, mut slice: impl FnMut() -> Poll<T>) -> impl Future<Output = T> {
    poll_fn(move |context| {
        loop {
            ready!(pace.take(context));
            if let Poll::Ready(done) = slice() {
                return Poll::Ready(done);
            }
        }
    })
}

/// Does all of such work at once.
pub(crate) fn to_the_end<T>(mut slice: impl FnMut() -> Poll<T>) -> T {
    loop {
        if let Poll::Ready(done) = slice() {
            return done;
        }
    }
}

#[cfg(test)]
mod tests {
    use core::pin::pin;

    use super::*;

    #[test]
    fn work_goes_on_slice_by_slice() {
        let (pace, done) = (Pace::new(), Cell::new(0));
        let slice = || {
            done.set(done.get() + 1);
            match done.get() {
                5 => Poll::Ready("done"),
                _ => Poll::Pending,
            }
        };
        let mut pinned = pin!(in_slices(&pace, slice));
        assert!(go_on(pinned.as_mut(), &pace, 0).is_pending());
        assert_eq!(done.get(), 0);
        assert!(go_on(pinned.as_mut(), &pace, 3).is_pending());
        assert_eq!(done.get(), 3);
        // What was left is not saved up.
        assert!(go_on(pinned.as_mut(), &pace, 1).is_pending());
        assert_eq!(done.get(), 4);
        assert_eq!(go_on(pinned.as_mut(), &pace, 9), Poll::Ready("done"));
        done.set(0);
        assert_eq!((to_the_end(slice), done.get()), ("done", 5));
    }

    #[test]
    fn an_executor_is_asked_to_come_back() {
        use std::sync::Arc;
        use std::sync::atomic::{AtomicUsize, Ordering};
        use std::task::Wake;

        #[derive(Default)]
        struct Woken(AtomicUsize);

        impl Wake for Woken {
            fn wake(self: Arc<Self>) {
                self.0.fetch_add(1, Ordering::Relaxed);
            }
        }

        let (pace, woken) = (Pace::new(), Arc::new(Woken::default()));
        let waker = Waker::from(Arc::clone(&woken));
        let mut context = Context::from_waker(&waker);
        let mut left = 3;
        let mut work = pin!(in_slices(&pace, || {
            left -= 1;
            match left {
                0 => Poll::Ready(()),
                _ => Poll::Pending,
            }
        }));
        let mut polls = 0;
        loop {
            pace.allow(1);
            polls += 1;
            if work.as_mut().poll(&mut context).is_ready() {
                break;
            }
        }
        assert_eq!((polls, woken.0.load(Ordering::Relaxed)), (3, 2));
    }
}
