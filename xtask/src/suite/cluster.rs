//! Batches on a Slurm of one node: an array of tasks, one of them killed and put back into the queue, a study broken on purpose.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail, ensure};
use fluoropose_phantom::sequence::{self, Options};

use super::report::{Report, Said};
use crate::setup::{command, programs};
use crate::{laboratory, workspace};

/// Studies, of which the last is broken, and tasks.
const STUDIES: usize = 12;
const TASKS: usize = 4;
const PATIENCE: Duration = Duration::from_secs(600);

/// Runs the suite.
pub(crate) fn run(report: &mut Report) {
    report.step("cluster: an array on Slurm", || {
        let programs = programs::slurm()?;
        let folder = workspace::target_dir().join("cluster");
        let _ = fs::remove_dir_all(&folder);
        let batch = Batch::make(&folder)?;
        let slurm = Slurm::start(&folder, &programs)?;
        batch.on(&slurm)?;
        slurm.end()?;
        Ok(Said::from(format!(
            "{STUDIES} studies, {TASKS} tasks, one killed"
        )))
    });
}

/// Programs that were started, ended in the opposite order whatever happens.
struct Slurm {
    running: Vec<Child>,
    conf: PathBuf,
    /// Steps of other clusters on this machine.
    steps: BTreeSet<u32>,
}

impl Slurm {
    fn start(folder: &Path, munged: &Path) -> Result<Self> {
        let conf = folder.join("slurm.conf");
        let mut slurm = Self {
            running: Vec::new(),
            conf: conf.clone(),
            steps: steps(),
        };
        let (munge, key) = (folder.join("munge.socket"), folder.join("munge.key"));
        fs::write(&key, [7; 128])?;
        private(&key)?;
        slurm.spawn(
            Command::new(munged)
                .args(["--foreground", "--force"])
                .arg(format!("--socket={}", munge.display()))
                .arg(format!("--key-file={}", key.display()))
                .arg(format!(
                    "--pid-file={}",
                    folder.join("munged.pid").display()
                ))
                .arg(format!(
                    "--log-file={}",
                    folder.join("munged.log").display()
                ))
                .arg(format!(
                    "--seed-file={}",
                    folder.join("munged.seed").display()
                )),
            folder,
        )?;
        until("munged", || munge.exists())?;
        let host = command::output(Command::new("hostname").arg("-s"))?;
        fs::write(&conf, configuration(folder, host.trim())?)?;
        for name in ["slurmctld", "slurmd"] {
            slurm.spawn(
                Command::new(program(name)?).arg("-D").arg("-f").arg(&conf),
                folder,
            )?;
        }
        until("the node", || {
            let said = slurm.ask("sinfo", &["--noheader", "--format=%t"]);
            said.is_ok_and(|said| said.trim() == "idle")
        })?;
        Ok(slurm)
    }

    fn spawn(&mut self, command: &mut Command, folder: &Path) -> Result<()> {
        let log = fs::OpenOptions::new()
            .create(true)
            .append(true)
            .open(folder.join("daemons.log"))?;
        command
            .stdin(Stdio::null())
            .stdout(log.try_clone()?)
            .stderr(log);
        self.running.push(
            command
                .spawn()
                .context("a daemon of Slurm does not start")?,
        );
        Ok(())
    }

    fn ask(&self, name: &str, words: &[&str]) -> Result<String> {
        command::output(
            Command::new(program(name)?)
                .args(words)
                .env("SLURM_CONF", &self.conf),
        )
    }

    /// Ends the daemons and what their steps left behind.
    fn end(mut self) -> Result<()> {
        self.stop();
        let left: Vec<u32> = steps().difference(&self.steps).copied().collect();
        ensure!(left.is_empty(), "slurmstepd {left:?} outlives its daemon");
        Ok(())
    }

    fn stop(&mut self) {
        while let Some(mut child) = self.running.pop() {
            // Asked first, so that steps are told; a daemon that is gone already needs no end.
            let _ = command::output(Command::new("kill").arg(child.id().to_string()));
            let asked = Instant::now();
            while matches!(child.try_wait(), Ok(None)) && asked.elapsed() < Duration::from_secs(10)
            {
                thread::sleep(Duration::from_millis(50));
            }
            let _ = child.kill();
            let _ = child.wait();
        }
        for step in steps().difference(&self.steps) {
            let _ = command::output(Command::new("kill").arg("-9").arg(step.to_string()));
        }
        thread::sleep(Duration::from_millis(200));
    }
}

impl Drop for Slurm {
    fn drop(&mut self) {
        self.stop();
    }
}

/// Processes of steps on this machine.
fn steps() -> BTreeSet<u32> {
    let entries = fs::read_dir("/proc").into_iter().flatten().flatten();
    let step = |entry: fs::DirEntry| {
        let name = fs::read_to_string(entry.path().join("comm")).ok()?;
        let number = entry.file_name().to_str()?.parse().ok()?;
        (name.trim() == "slurmstepd").then_some(number)
    };
    entries.filter_map(step).collect()
}

fn program(name: &str) -> Result<PathBuf> {
    let usual = ["/usr/sbin", "/usr/bin"].map(|folder| Path::new(folder).join(name));
    let found = command::find(&[name]).or_else(|| usual.into_iter().find(|path| path.is_file()));
    found.with_context(|| format!("no {name}"))
}

#[cfg(unix)]
fn private(file: &Path) -> Result<()> {
    use std::os::unix::fs::PermissionsExt;
    Ok(fs::set_permissions(
        file,
        fs::Permissions::from_mode(0o600),
    )?)
}

#[cfg(not(unix))]
fn private(_: &Path) -> Result<()> {
    bail!("Slurm runs on Unix alone")
}

/// What works as root without systemd.
fn configuration(folder: &Path, host: &str) -> Result<String> {
    let [control, node] = [0, 0].map(|port| {
        std::net::TcpListener::bind(("127.0.0.1", port)).and_then(|socket| socket.local_addr())
    });
    let (control, node) = (control?.port(), node?.port());
    let processors = thread::available_parallelism()?;
    let place = |name: &str| -> Result<String> {
        let place = folder.join(name);
        fs::create_dir_all(&place)?;
        Ok(place.display().to_string())
    };
    let (state, spool) = (place("state")?, place("spool")?);
    let folder = folder.display();
    Ok(format!(
        "ClusterName=fluoropose\nSlurmctldHost={host}(127.0.0.1)\nSlurmctldPort={control}\nSlurmdPort={node}\n\
         AuthType=auth/munge\nAuthInfo=socket={folder}/munge.socket\nSlurmUser=root\nSlurmdUser=root\n\
         StateSaveLocation={state}\nSlurmdSpoolDir={spool}\n\
         SlurmctldPidFile={folder}/slurmctld.pid\nSlurmdPidFile={folder}/slurmd.pid\n\
         SlurmctldLogFile={folder}/slurmctld.log\nSlurmdLogFile={folder}/slurmd.log\n\
         ProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\nSelectType=select/cons_tres\nSelectTypeParameters=CR_Core\n\
         JobAcctGatherType=jobacct_gather/none\nAccountingStorageType=accounting_storage/none\n\
         JobCompType=jobcomp/filetxt\nJobCompLoc={folder}/jobs.txt\nMpiDefault=none\nReturnToService=2\nMinJobAge=3600\n\
         NodeName={host} NodeAddr=127.0.0.1 CPUs={processors} State=UNKNOWN\n\
         PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP\n"
    ))
}

fn until(what: &str, is_so: impl Fn() -> bool) -> Result<()> {
    let begun = Instant::now();
    while !is_so() {
        ensure!(
            begun.elapsed() < PATIENCE,
            "{what}: nothing after {} s",
            PATIENCE.as_secs()
        );
        thread::sleep(Duration::from_millis(50));
    }
    Ok(())
}

/// A list of studies, and the program.
struct Batch {
    folder: PathBuf,
    program: PathBuf,
}

impl Batch {
    fn make(folder: &Path) -> Result<Self> {
        let program = laboratory::program()?;
        let mut list = String::from("study,name,fixed\n");
        for study in 0..3 {
            let options = Options {
                frames: 2,
                seed: 1 + study,
                ..Options::default()
            };
            sequence::write(&options, &folder.join(study.to_string()))?;
        }
        for number in 0..STUDIES - 1 {
            let study = number % 3;
            list.push_str(&format!(
                "{study},study-{number},femur={study}/femur.jts;tibia={study}/tibia.jts\n"
            ));
        }
        list.push_str("nowhere/study.toml,broken,\n");
        fs::write(folder.join("studies.csv"), list)?;
        Ok(Self {
            folder: folder.to_owned(),
            program,
        })
    }

    fn results(&self, out: &str, name: &str) -> PathBuf {
        self.folder.join(out).join(name)
    }

    /// Runs the array and compares with one task that nobody disturbs.
    fn on(&self, slurm: &Slurm) -> Result<()> {
        let job = self.submit(slurm)?;
        let killed = self.kill_one(slurm, &job)?;
        until("the array", || {
            slurm
                .ask("squeue", &["--noheader"])
                .is_ok_and(|said| said.trim().is_empty())
        })?;
        self.exit_codes(slurm, &job, killed)?;
        let mut whole = Command::new(&self.program);
        whole
            .arg("batch")
            .arg("studies.csv")
            .args(["--out", "whole"])
            .current_dir(&self.folder);
        let code = whole.stdout(Stdio::null()).status()?.code();
        ensure!(code == Some(4), "one task ends with {code:?}");
        for number in 0..STUDIES - 1 {
            let name = format!("study-{number}");
            let pair = ["whole", "array"].map(|out| self.results(out, &name));
            command::output(Command::new("diff").arg("--recursive").args(pair))?;
        }
        ensure!(
            !self.results("array", "broken").exists(),
            "the broken study has results"
        );
        ensure!(
            self.folder.join("array/.failed/broken.json").is_file(),
            "the broken study's failure is not noted"
        );
        Ok(())
    }

    fn submit(&self, slurm: &Slurm) -> Result<String> {
        let script = workspace::root().join("xtask/cluster/run.sbatch");
        let mut sbatch = Command::new(program("sbatch")?);
        sbatch
            .args(["--parsable", "--cpus-per-task=1", "--mem=0"])
            .arg(format!("--array=0-{}", TASKS - 1))
            .arg(script)
            .args(["studies.csv", "array"])
            .current_dir(&self.folder)
            .env("SLURM_CONF", &slurm.conf)
            .env("FLUOROPOSE", &self.program);
        Ok(command::output(&mut sbatch)?.trim().to_owned())
    }

    /// Kills the process of a task with signal 9 while it works on a study, and puts the task back into the queue.
    fn kill_one(&self, slurm: &Slurm, job: &str) -> Result<usize> {
        let claims = self.folder.join("array/.claims");
        let claimed = || -> Option<(u32, usize)> {
            let file = fs::read_dir(&claims).ok()?.flatten().next()?.path();
            let claim: serde_json::Value =
                serde_json::from_str(&fs::read_to_string(file).ok()?).ok()?;
            let task = claim["task"]
                .as_str()?
                .split('_')
                .nth(1)?
                .split('.')
                .next()?
                .parse()
                .ok()?;
            Some((claim["process"].as_u64()? as u32, task))
        };
        until("a claim", || claimed().is_some())?;
        let (process, task) = claimed().context("the claim is gone")?;
        command::output(Command::new("kill").args(["-9", &process.to_string()]))?;
        let name = format!("{job}_{task}");
        until("the killed task", || {
            let said = slurm
                .ask("scontrol", &["show", "job", &name])
                .unwrap_or_default();
            said.contains("JobState=FAILED")
        })?;
        slurm.ask("scontrol", &["requeue", &name])?;
        Ok(task)
    }

    /// The task with the broken study says so; the others, the killed one among them, are done.
    fn exit_codes(&self, slurm: &Slurm, job: &str, killed: usize) -> Result<()> {
        for task in 0..TASKS {
            let said = slurm.ask("scontrol", &["show", "job", &format!("{job}_{task}")])?;
            let expected = if (STUDIES - 1) % TASKS == task { 4 } else { 0 };
            if !said.contains(&format!("ExitCode={expected}:0")) {
                bail!("task {task} was to end with {expected}: {said}");
            }
            ensure!(
                task != killed || said.contains("Restarts=1"),
                "task {task} was not started again: {said}"
            );
        }
        Ok(())
    }
}
