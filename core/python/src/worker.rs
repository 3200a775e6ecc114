//! Long work beside the interpreter: other Python threads go on, and Ctrl-C ends the wait for it.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use anyhow::Result;
use fluoropose_laboratory::progress::Stop;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use crate::failure::python_error;

/// So often signals are looked at while the work goes on.
const PAUSE: Duration = Duration::from_millis(50);

/// Does `work` on a thread of its own without the interpreter's lock. After Ctrl-C this returns at once; the work itself ends with the
/// step that is in hand, and keeps what it was given until then.
pub(crate) fn beside<T: Send + 'static>(
    py: Python<'_>,
    stop: &Stop,
    work: impl FnOnce() -> Result<T> + Send + 'static,
) -> PyResult<T> {
    let (sender, receiver) = channel();
    thread::Builder::new()
        .name("fluoropose".to_owned())
        .spawn(move || {
            // Nobody listens after Ctrl-C.
            let _ = sender.send(catch_unwind(AssertUnwindSafe(work)));
        })?;
    // A receiver is no one else's, but only a reference to it crosses.
    let receiver = std::sync::Mutex::new(receiver);
    loop {
        let wait = || match receiver.lock() {
            Ok(receiver) => receiver.recv_timeout(PAUSE),
            Err(_) => Err(RecvTimeoutError::Disconnected),
        };
        match py.detach(wait) {
            Ok(Ok(done)) => return done.map_err(python_error),
            Ok(Err(_)) | Err(RecvTimeoutError::Disconnected) => {
                return Err(PyRuntimeError::new_err(
                    "fluoropose broke off; its words are on standard error",
                ));
            }
            Err(RecvTimeoutError::Timeout) => py.check_signals().inspect_err(|_| stop.ask())?,
        }
    }
}
