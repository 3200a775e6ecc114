//! How long it has taken so far, and how long each piece of work takes.

use std::sync::OnceLock;
use std::time::{Duration, Instant};

use crate::output::announce;

/// Clock ticks in a second, as the kernel tells them to programs.
#[cfg(target_os = "linux")]
const TICKS: f64 = 100.0;

/// Since the command was entered. Cargo becomes this program once it has compiled it, so where the kernel tells when
/// this process began, compiling is in it; elsewhere the clock starts with the first call.
pub(crate) fn since_the_command() -> Duration {
    static FIRST: OnceLock<Instant> = OnceLock::new();
    let first = FIRST.get_or_init(Instant::now);
    age_of_the_process().unwrap_or_else(|| first.elapsed())
}

#[cfg(target_os = "linux")]
fn age_of_the_process() -> Option<Duration> {
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    // The program's name may hold blanks; numbers follow it, of which the 20th is when it began.
    let (_, numbers) = stat.rsplit_once(')')?;
    let began: f64 = numbers.split_whitespace().nth(19)?.parse().ok()?;
    let uptime = std::fs::read_to_string("/proc/uptime").ok()?;
    let now: f64 = uptime.split_whitespace().next()?.parse().ok()?;
    Duration::try_from_secs_f64(now - began / TICKS).ok()
}

#[cfg(not(target_os = "linux"))]
fn age_of_the_process() -> Option<Duration> {
    None
}

/// Does a piece of work, and says what it is and how long it took.
pub(crate) fn timed<T>(what: &str, work: impl FnOnce() -> T) -> T {
    announce(what);
    let begin = Instant::now();
    let done = work();
    announce(&format!("{what}: {:.1} s", begin.elapsed().as_secs_f64()));
    done
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_began_before_now_and_time_goes_on() {
        let before = since_the_command();
        std::thread::sleep(Duration::from_millis(30));
        let after = since_the_command();
        assert!(after > before && after < Duration::from_secs(24 * 3600));
    }
}
