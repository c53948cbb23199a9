//! The commit and the compiler of a build, for `--version` and reports.
//!
//! Only release builds name a commit: in development, each commit would compile everything again.

use std::env;
use std::process::Command;

fn main() {
    println!("cargo::rerun-if-env-changed=CELLCASTER_COMMIT");
    println!("cargo::rerun-if-changed=build.rs");
    let is_release = env::var("PROFILE").is_ok_and(|it| it == "release");
    let log = output("git", &["rev-parse", "--git-path", "logs/HEAD"]).filter(|_| is_release);
    let of_git = log.and_then(|log| {
        println!("cargo::rerun-if-changed={log}");
        println!("cargo::rerun-if-changed=src");
        output(
            "git",
            &["describe", "--always", "--exclude=*", "--abbrev=12", "--dirty= and changes"],
        )
    });
    let variable = |name: &str| env::var(name).unwrap_or_default();
    let commit = env::var("CELLCASTER_COMMIT").ok().or(of_git);
    let commit = commit.map_or_else(String::new, |commit| format!(" ({commit})"));
    println!("cargo::rustc-env=CELLCASTER_VERSION={}{commit}", variable("CARGO_PKG_VERSION"));

    let compiler = output(&variable("RUSTC"), &["--version"]).unwrap_or_default();
    let flags = variable("CARGO_ENCODED_RUSTFLAGS").replace('\u{1f}', " ");
    let flags = if flags.is_empty() { "no flags" } else { &flags };
    let (level, target) = (variable("OPT_LEVEL"), variable("TARGET"));
    println!("cargo::rustc-env=CELLCASTER_BUILD={compiler}, level {level}, {flags}, {target}");
}

/// The first line that a program prints; `None` if it fails.
fn output(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok().filter(|_| output.status.success())?;
    text.lines().next().map(str::to_owned)
}
