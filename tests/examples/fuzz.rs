//! Gives changed bytes to every target by turns, until the time is over or one of them ends the program (`cargo xtask fuzz`).
//!
//! `fuzz SECONDS SEED FOLDER`, with the paths of more files for the readers of frames on the standard input, a line each. What
//! panics, or takes longer than [`PATIENCE`], is kept in the folder, and so is how often each target ran since its last crash.

use std::io::{self, BufRead};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::process::exit;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};
use std::{env, fs, thread};

use fluoropose_tests::fuzz::{Random, Seed, Target, changed};

/// Larger files are left out: a second is to be for many.
const LARGEST: usize = 100_000;

/// Longest that bytes of that number may take.
const PATIENCE: Duration = Duration::from_secs(20);

/// How long a target goes on before the next has its turn.
const TURN: Duration = Duration::from_millis(200);

fn main() -> io::Result<()> {
    let words: Vec<String> = env::args().skip(1).collect();
    let [seconds, seed, folder] = words.as_slice() else {
        return Err(io::ErrorKind::InvalidInput.into());
    };
    let wrong = |_| io::Error::from(io::ErrorKind::InvalidInput);
    let end = Instant::now() + Duration::from_secs(seconds.parse().map_err(wrong)?);
    let mut random = Random::new(seed.parse().map_err(wrong)?);
    let folder = PathBuf::from(folder);
    fs::create_dir_all(&folder)?;
    let mut corpora = Vec::new();
    for target in Target::ALL {
        corpora.push((target, target.corpus()?, Count::read(&folder, target)));
    }
    let frames = &mut corpora[0].1;
    for path in io::stdin().lock().lines() {
        frames.push(Seed::read(path?.into())?);
    }
    frames.retain(|seed| seed.bytes.len() <= LARGEST);
    let now = Arc::new(Mutex::new(Now::nothing()));
    watch(Arc::clone(&now), folder.clone());
    while Instant::now() < end {
        for (target, seeds, count) in &mut corpora {
            let turn = Instant::now() + TURN;
            while Instant::now() < turn {
                one(*target, seeds, &mut random, (&now, &folder));
                count.runs += 1;
            }
            count.write(&folder)?;
        }
    }
    print(corpora.iter().map(|(.., count)| count));
    Ok(())
}

fn one(target: Target, seeds: &[Seed], random: &mut Random, (now, folder): (&Mutex<Now>, &Path)) {
    let seed = &seeds[random.below(seeds.len())];
    let seed = Seed {
        name: seed.name.clone(),
        bytes: changed(&seed.bytes, seeds, random),
    };
    *now.lock().unwrap_or_else(PoisonError::into_inner) = Now {
        since: Instant::now(),
        target,
        seed: Seed {
            name: seed.name.clone(),
            bytes: seed.bytes.clone(),
        },
    };
    if catch_unwind(AssertUnwindSafe(|| target.run(&seed))).is_err() {
        keep(folder, "panic", target, &seed);
    }
}

/// What is being read, and since when.
struct Now {
    since: Instant,
    target: Target,
    seed: Seed,
}

impl Now {
    fn nothing() -> Self {
        let seed = Seed {
            name: String::new(),
            bytes: Vec::new(),
        };
        Self {
            since: Instant::now(),
            target: Target::Frames,
            seed,
        }
    }
}

/// Ends the program where bytes take too long.
fn watch(now: Arc<Mutex<Now>>, folder: PathBuf) {
    thread::spawn(move || {
        loop {
            thread::sleep(Duration::from_secs(1));
            let now = now.lock().unwrap_or_else(PoisonError::into_inner);
            if now.since.elapsed() > PATIENCE {
                keep(&folder, "slow", now.target, &now.seed);
            }
        }
    });
}

/// Keeps bytes, says where, counts from nothing again, and ends the program.
fn keep(folder: &Path, what: &str, target: Target, seed: &Seed) -> ! {
    let path = folder.join(format!("{what}-{}-{}", target.name(), seed.name));
    let again = Count { target, runs: 0 }.write(folder);
    match fs::write(&path, &seed.bytes).and(again) {
        Ok(()) => eprintln!(
            "{what}: kept in {}; once mended it belongs to tests/corpus/{}",
            path.display(),
            target.name()
        ),
        Err(error) => eprintln!("{what}: {} could not be kept ({error})", seed.name),
    }
    exit(1)
}

/// How often a target ran since its last crash.
struct Count {
    target: Target,
    runs: u64,
}

impl Count {
    fn path(folder: &Path, target: Target) -> PathBuf {
        folder.join(format!("{}.count", target.name()))
    }

    /// As it was left, from nothing where it never ran.
    fn read(folder: &Path, target: Target) -> Self {
        let text = fs::read_to_string(Self::path(folder, target)).unwrap_or_default();
        Self {
            target,
            runs: text.trim().parse().unwrap_or(0),
        }
    }

    fn write(&self, folder: &Path) -> io::Result<()> {
        fs::write(Self::path(folder, self.target), self.runs.to_string())
    }
}

fn print<'a>(counts: impl Iterator<Item = &'a Count>) {
    println!("{:<14}{:>14}", "target", "since a crash");
    let mut all = 0;
    for Count { target, runs } in counts {
        println!("{:<14}{runs:>14}", target.name());
        all += runs;
    }
    println!("{:<14}{all:>14}", "all");
}
