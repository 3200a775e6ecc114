//! What ends the program from outside: a pipe that nobody reads, Ctrl-C, and an engine of batches.

/// From now on the program ends without a word when whoever reads its output has gone, as behind `| head`: as programs do on Unix.
pub fn end_with_the_reader() {
    #[cfg(unix)]
    unix::end_with_the_reader();
}

/// Where Ctrl-C or an engine ends the program from now on, these words are said on standard error first: what is kept, and how to go on.
pub fn say_when_ended(words: String) {
    #[cfg(unix)]
    unix::say_when_ended(words);
    #[cfg(not(unix))]
    drop(words);
}

#[cfg(unix)]
mod unix {
    use std::io::Write as _;
    use std::sync::atomic::AtomicBool;
    use std::sync::{Arc, Mutex, Once, PoisonError};
    use std::thread;

    use signal_hook::consts::{SIGINT, SIGPIPE, SIGTERM};
    use signal_hook::flag::register_conditional_default;
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;

    static WORDS: Mutex<String> = Mutex::new(String::new());
    static LISTENING: Once = Once::new();

    pub(super) fn end_with_the_reader() {
        // Without it a write fails, and the macros that print break off over that.
        let _ = register_conditional_default(SIGPIPE, Arc::new(AtomicBool::new(true)));
    }

    pub(super) fn say_when_ended(words: String) {
        *WORDS.lock().unwrap_or_else(PoisonError::into_inner) = words;
        LISTENING.call_once(listen);
    }

    fn listen() {
        let ours = [SIGINT, SIGTERM]
            .into_iter()
            .filter(|signal| !is_ignored(*signal));
        // A system that hands no signals out ends the program without a word.
        if let Ok(mut signals) = Signals::new(ours) {
            thread::spawn(move || {
                for signal in signals.forever() {
                    let words = WORDS.lock().unwrap_or_else(PoisonError::into_inner).clone();
                    // Nobody may be there to read it.
                    let _ = writeln!(std::io::stderr(), "\nstopped: {words}");
                    let _ = emulate_default_handler(signal);
                }
            });
        }
    }

    /// Whether whoever started this program wants the signal ignored, as a shell does for what runs in the background of a script. Only
    /// Linux tells it.
    fn is_ignored(signal: i32) -> bool {
        let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        let mask = status
            .lines()
            .find_map(|line| line.strip_prefix("SigIgn:"))
            .and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
        mask.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
    }
}
