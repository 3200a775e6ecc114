//! Long work in slices: the processor is given up after so much of it, and taken again later.
//!
//! Work that is long (`find_paced`, `refine_paced`) is a future that pauses between slices, the longest of which is one
//! drawing of the model with its readings. It needs no executor and no allocation: [`go_on`] goes on with it for a number of
//! slices, as often as the caller likes, and what comes of it is to the last bit what comes of it at once.
//!
//! ```
//! use core::pin::pin;
//! use core::task::Poll;
//! use fluoropose::pace::{Pace, go_on};
//!
//! let pace = Pace::new();
//! let mut work = pin!(async { for _ in 0..5 { pace.pause().await } });
//! assert!(go_on(work.as_mut(), &pace, 3).is_pending()); // three slices; then the watchdog, or other work
//! assert_eq!(go_on(work.as_mut(), &pace, 3), Poll::Ready(()));
//! ```
//!
//! Under an executor `poll_fn(|context| { pace.allow(1); work.as_mut().poll(context) }).await` gives way to other tasks after
//! each slice.

use core::cell::Cell;
use core::future::{Future, poll_fn};
use core::pin::{Pin, pin};
use core::task::{Context, Poll, Waker};

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

    /// Takes a slice, or pauses until one is left. An executor is asked to come back: the work waits for nothing else.
    pub fn pause(&self) -> impl Future<Output = ()> {
        poll_fn(|context| self.take(context))
    }

    /// A slice, where one is left.
    pub(crate) fn take(&self, context: &mut Context<'_>) -> Poll<()> {
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

/// Does all of some work, whatever its pace.
pub(crate) fn at_once<F: Future>(pace: &Pace, work: F) -> F::Output {
    let mut work = pin!(work);
    loop {
        if let Poll::Ready(done) = go_on(work.as_mut(), pace, u32::MAX) {
            return done;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_goes_on_slice_by_slice() {
        let (pace, done) = (Pace::new(), Cell::new(0));
        let work = async {
            for number in 1..=5 {
                pace.pause().await;
                done.set(number);
            }
            "done"
        };
        let mut pinned = pin!(work);
        assert!(go_on(pinned.as_mut(), &pace, 0).is_pending());
        assert_eq!(done.get(), 0);
        assert!(go_on(pinned.as_mut(), &pace, 3).is_pending());
        assert_eq!(done.get(), 3);
        // What was left is not saved up.
        assert!(go_on(pinned.as_mut(), &pace, 1).is_pending());
        assert_eq!(done.get(), 4);
        assert_eq!(go_on(pinned.as_mut(), &pace, 9), Poll::Ready("done"));
        at_once(&pace, async { pace.pause().await });
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
        let mut work = pin!(async {
            for _ in 0..3 {
                pace.pause().await;
            }
        });
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
