//! Long work beside the interpreter: other Python threads go on, and Ctrl-C ends the wait for it.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use anyhow::Result;
use fluoropose_laboratory::progress::{Stop, without_bars};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::failure::python_error;

/// So often signals are looked at, and what the work tells is heard, while it goes on.
const PAUSE: Duration = Duration::from_millis(50);

/// Does `work` on a thread of its own without the interpreter's lock. After Ctrl-C this returns at once; the work itself ends with the
/// step that is in hand, and keeps what it was given until then.
pub(crate) fn beside<T: Send + 'static>(
    py: Python<'_>,
    stop: &Stop,
    work: impl FnOnce() -> Result<T> + Send + 'static,
) -> PyResult<T> {
    beside_telling(py, stop, |_| Ok(()), work)
}

/// The same, and calls `hear` now and then and once at the end; an exception from it ends the work like Ctrl-C.
pub(crate) fn beside_telling<T: Send + 'static>(
    py: Python<'_>,
    stop: &Stop,
    mut hear: impl FnMut(Python<'_>) -> PyResult<()>,
    work: impl FnOnce() -> Result<T> + Send + 'static,
) -> PyResult<T> {
    without_bars();
    let pool = threads()?;
    let (sender, receiver) = channel();
    thread::Builder::new()
        .name("fluoropose".to_owned())
        .spawn(move || {
            let work = || pool.install(work);
            // Nobody listens after Ctrl-C.
            let _ = sender.send(catch_unwind(AssertUnwindSafe(work)));
        })?;
    // A receiver is no one else's, but only a reference to it crosses.
    let receiver = Mutex::new(receiver);
    loop {
        let wait = || match receiver.lock() {
            Ok(receiver) => receiver.recv_timeout(PAUSE),
            Err(_) => Err(RecvTimeoutError::Disconnected),
        };
        match py.detach(wait) {
            Ok(Ok(done)) => {
                hear(py)?;
                return done.map_err(python_error);
            }
            Ok(Err(_)) | Err(RecvTimeoutError::Disconnected) => {
                return Err(PyRuntimeError::new_err(
                    "fluoropose broke off; its words are on standard error",
                ));
            }
            Err(RecvTimeoutError::Timeout) => {
                let goes_on = py.check_signals().and_then(|()| hear(py));
                goes_on.inspect_err(|_| stop.ask())?;
            }
        }
    }
}

/// The threads of this process. One that was forked, as by `multiprocessing`, has none of its parent's, and makes its own.
fn threads() -> PyResult<&'static ThreadPool> {
    static THREADS: Mutex<Option<(u32, &'static ThreadPool)>> = Mutex::new(None);
    let mut threads = THREADS.lock().unwrap_or_else(PoisonError::into_inner);
    let process = std::process::id();
    match *threads {
        Some((owner, pool)) if owner == process => Ok(pool),
        _ => {
            let made = ThreadPoolBuilder::new().build();
            let pool: &ThreadPool = Box::leak(Box::new(made.map_err(python_error)?));
            *threads = Some((process, pool));
            Ok(pool)
        }
    }
}
