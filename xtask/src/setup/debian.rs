//! Packages through `apt-get`, where it exists and may be used.

use std::process::Command;
use std::sync::OnceLock;

use anyhow::Result;

use super::command;
use super::missing::Missing;
use crate::output::announce;

/// How packages can be installed on this machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Access {
    /// `apt-get` is here and we are root.
    Root,
    /// `apt-get` is here, but installing wants root.
    NotRoot,
    /// Another kind of system.
    NoApt,
}

/// What this machine allows.
pub(crate) fn access() -> Access {
    if command::find(&["apt-get"]).is_none() {
        return Access::NoApt;
    }
    let user = command::output(Command::new("id").arg("-u")).unwrap_or_default();
    if user.trim() == "0" {
        Access::Root
    } else {
        Access::NotRoot
    }
}

/// Installs packages that together provide `what`, or says why that cannot be.
pub(crate) fn install(what: &str, packages: &[&str]) -> Result<(), Missing> {
    if let Some(missing) = refusal(access(), what, packages) {
        return Err(missing);
    }
    let _turn = super::turns::APT.turn();
    announce(&format!(
        "installing {what} (apt-get install {})",
        packages.join(" ")
    ));
    update();
    let mut apt = apt_get();
    apt.args(["install", "--yes", "--no-install-recommends"])
        .args(packages);
    command::output(&mut apt)
        .map(drop)
        .map_err(|error| Missing {
            what: what.to_string(),
            why: format!("{error:#}"),
            remedy: format!("install {} by hand", packages.join(" ")),
            tried: true,
        })
}

/// Why nothing can be installed here, if so.
fn refusal(access: Access, what: &str, packages: &[&str]) -> Option<Missing> {
    let packages = packages.join(" ");
    let (why, remedy) = match access {
        Access::Root => return None,
        Access::NotRoot => (
            "installing it wants root".to_string(),
            format!("run `sudo apt-get install {packages}`"),
        ),
        Access::NoApt => (
            "this machine has no apt-get".to_string(),
            format!("install it with your package manager (Debian calls it {packages})"),
        ),
    };
    Some(Missing {
        what: what.to_string(),
        why,
        remedy,
        tried: false,
    })
}

/// Refreshes the package lists once a run. Its failure is not told: an install that then fails tells more.
fn update() {
    static DONE: OnceLock<()> = OnceLock::new();
    DONE.get_or_init(|| {
        let _ = command::output(apt_get().arg("update"));
    });
}

fn apt_get() -> Command {
    let mut command = Command::new("apt-get");
    command.env("DEBIAN_FRONTEND", "noninteractive");
    command
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn root_on_debian_is_not_refused() {
        assert_eq!(refusal(Access::Root, "Chromium", &["chromium"]), None);
    }

    #[test]
    fn a_refusal_is_one_line_with_a_remedy() {
        let line = refusal(Access::NotRoot, "Chromium", &["chromium"])
            .unwrap()
            .to_string();
        assert_eq!(
            line,
            "no Chromium: installing it wants root; run `sudo apt-get install chromium`"
        );
        let line = refusal(Access::NoApt, "QEMU", &["qemu-system-arm"])
            .unwrap()
            .to_string();
        assert!(
            line.contains("no apt-get") && line.contains("qemu-system-arm"),
            "{line}"
        );
    }
}
