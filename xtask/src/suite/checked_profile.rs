//! How tests are compiled.

/// Tests use the `release` profile, whose dependencies `cargo xtask` itself has just built, but the core's
/// arithmetic and assertions are checked in them.
pub(crate) const CHECKED: [&str; 5] = [
    "--release",
    "--config",
    "profile.release.package.fluoropose.overflow-checks=true",
    "--config",
    "profile.release.package.fluoropose.debug-assertions=true",
];
