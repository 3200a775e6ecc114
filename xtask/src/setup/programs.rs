//! Programs that tests drive: Chromium, Firefox, QEMU and Slurm.

use std::path::{Path, PathBuf};
use std::process::Command;

use super::missing::Missing;
use super::{command, debian};

/// A program a suite needs, under the names it goes by.
struct Program {
    what: &'static str,
    names: &'static [&'static str],
    /// Any one of these packages provides it; the first that can be had is taken.
    packages: &'static [&'static str],
    /// Environment variable that names the program, for those kept off the PATH.
    variable: &'static str,
}

const CHROMIUM: Program = Program {
    what: "Chromium",
    names: &[
        // The same engine without windows: a sixth less work.
        "chromium-headless-shell",
        "chromium",
        "chromium-browser",
        "google-chrome",
        "google-chrome-stable",
    ],
    packages: &["chromium-headless-shell", "chromium"],
    variable: "FLUOROPOSE_CHROMIUM",
};

const FIREFOX: Program = Program {
    what: "Firefox",
    names: &["firefox-esr", "firefox"],
    packages: &["firefox-esr"],
    variable: "FLUOROPOSE_FIREFOX",
};

const QEMU_ARM: Program = Program {
    what: "QEMU for Arm (qemu-system-arm)",
    names: &["qemu-system-arm"],
    packages: &["qemu-system-arm"],
    variable: "FLUOROPOSE_QEMU_ARM",
};

const QEMU_RISCV: Program = Program {
    what: "QEMU for RISC-V (qemu-system-riscv32)",
    names: &["qemu-system-riscv32"],
    packages: &["qemu-system-riscv", "qemu-system-misc"],
    variable: "FLUOROPOSE_QEMU_RISCV",
};

const ARM_GCC: Program = Program {
    what: "GCC for Arm (arm-none-eabi-gcc)",
    names: &["arm-none-eabi-gcc"],
    packages: &["gcc-arm-none-eabi"],
    variable: "FLUOROPOSE_ARM_GCC",
};

const SLURM: Program = Program {
    what: "Slurm",
    names: &["slurmctld"],
    packages: &["slurm-wlm"],
    variable: "FLUOROPOSE_SLURMCTLD",
};

const MUNGE: Program = Program {
    what: "munge",
    names: &["munged"],
    packages: &["munge"],
    variable: "FLUOROPOSE_MUNGED",
};

/// Slurm with what it knows its users by, installed if need be; the path of `munged`.
pub(crate) fn slurm() -> Result<PathBuf, Missing> {
    SLURM.ensure()?;
    MUNGE.ensure()
}

/// A Chromium, installed if need be. `FLUOROPOSE_CHROMIUM` names another one.
pub(crate) fn chromium() -> Result<PathBuf, Missing> {
    CHROMIUM.ensure()
}

/// A Firefox, installed if need be. `FLUOROPOSE_FIREFOX` names another one.
pub(crate) fn firefox() -> Result<PathBuf, Missing> {
    FIREFOX.ensure()
}

/// QEMU's Arm machine emulator, installed if need be. `FLUOROPOSE_QEMU_ARM` names another one.
pub(crate) fn qemu_arm() -> Result<PathBuf, Missing> {
    QEMU_ARM.ensure()
}

/// QEMU's RISC-V machine emulator, installed if need be. `FLUOROPOSE_QEMU_RISCV` names another one.
pub(crate) fn qemu_riscv() -> Result<PathBuf, Missing> {
    QEMU_RISCV.ensure()
}

/// A C compiler for Arm without an operating system, installed if need be. `FLUOROPOSE_ARM_GCC` names another one.
pub(crate) fn arm_gcc() -> Result<PathBuf, Missing> {
    ARM_GCC.ensure()
}

/// What programs of 32 bits are linked with on a machine of 64, installed if need be.
pub(crate) fn linker_for_32_bits() -> Result<(), Missing> {
    let is_there = || {
        // A name without a folder where there is none.
        let first = command::output(Command::new("cc").args(["-m32", "-print-file-name=crt1.o"]));
        first.is_ok_and(|file| Path::new(file.trim()).is_file())
    };
    let what = "linker for 32 bits";
    if is_there() {
        return Ok(());
    }
    debian::install(what, &["gcc-multilib"])?;
    is_there().then_some(()).ok_or_else(|| Missing {
        what: what.into(),
        why: "its package is installed but `cc -m32` finds nothing".into(),
        remedy: "install what your distribution calls gcc-multilib".into(),
        tried: true,
    })
}

impl Program {
    fn ensure(&self) -> Result<PathBuf, Missing> {
        if let Some(named) = std::env::var_os(self.variable) {
            return self.check_named(PathBuf::from(named));
        }
        if let Some(found) = command::find(self.names) {
            return Ok(found);
        }
        self.install()?;
        command::find(self.names).ok_or_else(|| Missing {
            what: self.what.into(),
            why: "its package is installed but the program is not on the PATH".into(),
            remedy: format!("name the program in {}", self.variable),
            tried: true,
        })
    }

    fn install(&self) -> Result<(), Missing> {
        let tried = self.packages.iter();
        let mut tried = tried.map(|package| debian::install(self.what, &[package]));
        let first = tried.next().unwrap_or(Ok(()));
        first.or_else(|missing| tried.find(Result::is_ok).unwrap_or(Err(missing)))
    }

    fn check_named(&self, named: PathBuf) -> Result<PathBuf, Missing> {
        if named.is_file() {
            return Ok(named);
        }
        Err(Missing {
            what: self.what.into(),
            why: format!(
                "{} names {}, which is no file",
                self.variable,
                named.display()
            ),
            remedy: format!("correct or unset {}", self.variable),
            tried: false,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wrongly_named_program_is_told() {
        let said = CHROMIUM
            .check_named("no/such/browser".into())
            .unwrap_err()
            .to_string();
        assert!(
            said.contains("FLUOROPOSE_CHROMIUM names no/such/browser"),
            "{said}"
        );
    }
}
