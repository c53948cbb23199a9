//! Tests of the examples in docs/hosting.md and docs/hosting/.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use cellcaster_server::config::Config;

use crate::support::server;
use crate::transport::folder;

fn document(name: &str) -> String {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
    fs::read_to_string(docs.join(name)).unwrap()
}

/// The code blocks in a language.
fn blocks(text: &str, language: &str) -> Vec<String> {
    let fence = format!("```{language}\n");
    let blocks = text.split(fence.as_str()).skip(1).filter_map(|rest| rest.split_once("```"));
    blocks.map(|(block, _)| block.to_owned()).collect()
}

#[test]
fn configurations_in_the_documents_are_valid() {
    let blocks = blocks(&document("hosting.md"), "toml");
    assert!(!blocks.is_empty());
    for block in blocks {
        if let Err(faults) = Config::parse(&block, "docs/hosting.md") {
            panic!("{faults}");
        }
    }
}

/// Every line of a shell block that runs the program must use existing commands and options. A command about
/// a host fails with a sentence if the folder contains none.
#[test]
fn commands_in_the_documents_are_valid() {
    let text = document("hosting.md");
    let data = folder();
    let commands: Vec<String> = blocks(&text, "sh")
        .iter()
        .flat_map(|block| block.lines())
        .filter_map(|line| line.strip_prefix("cellcaster-server").map(str::to_owned))
        .collect();
    assert!(commands.iter().any(|line| line.trim().starts_with("admin")), "{commands:?}");
    assert!(commands.iter().any(|line| line.trim().starts_with("--listen")), "{commands:?}");
    for line in commands {
        let line = line.split(" #").next().unwrap().trim();
        let words: Vec<String> = words(line);
        // `--help` keeps a server from running on. Its options are still parsed first.
        let help = if words.first().is_none_or(|word| word.starts_with("--")) {
            &["--help"][..]
        } else {
            &[]
        };
        let output = server(&words.iter().map(String::as_str).collect::<Vec<_>>())
            .args(help)
            .env("CELLCASTER_DATA", &data)
            .output()
            .unwrap();
        let error = String::from_utf8(output.stderr).unwrap();
        let is_about_a_host =
            error.contains("no server runs") || error.contains("no store of a host");
        assert!(output.status.success() || is_about_a_host, "{line}: {error}");
    }
}

/// The words of a command line. Double quotes may enclose words with blanks.
fn words(line: &str) -> Vec<String> {
    let parts = line.split('"').enumerate();
    parts
        .flat_map(|(index, part)| match index % 2 {
            0 => part.split_whitespace().map(str::to_owned).collect::<Vec<_>>(),
            _ => vec![part.to_owned()],
        })
        .collect()
}

/// The systemd unit with the paths of this machine and with its drop-in.
fn unit() -> Option<PathBuf> {
    let has_systemd = Command::new("systemd-analyze").arg("--version").output().is_ok();
    has_systemd.then(|| {
        let program = env!("CARGO_BIN_EXE_cellcaster-server");
        let text = document("hosting/cellcaster.service");
        assert!(text.contains("/usr/local/bin/cellcaster-server"));
        let folder = folder();
        let file = folder.join("cellcaster.service");
        fs::write(&file, text.replace("/usr/local/bin/cellcaster-server", program)).unwrap();
        // The drop-in that makes the host part of a cluster.
        let additions = folder.join("cellcaster.service.d");
        fs::create_dir(&additions).unwrap();
        fs::write(additions.join("cluster.conf"), document("hosting/cluster.conf")).unwrap();
        file
    })
}

#[test]
fn the_systemd_unit_is_valid() {
    let Some(unit) = unit() else { return };
    let output =
        Command::new("systemd-analyze").args(["verify", "--man=no"]).arg(&unit).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    let about_it: Vec<&str> = said.lines().filter(|line| line.contains("cellcaster")).collect();
    assert!(about_it.is_empty() && output.status.success(), "{said}");
}

/// The unit must start the program with existing options.
#[test]
fn the_systemd_unit_uses_existing_options() {
    let text = document("hosting/cellcaster.service");
    let starts = text
        .lines()
        .filter_map(|line| line.strip_prefix("ExecStart=/usr/local/bin/cellcaster-server "));
    let starts: Vec<&str> = starts.collect();
    assert_eq!(starts.len(), 1);
    let output = server(&words(starts[0]).iter().map(String::as_str).collect::<Vec<_>>())
        .arg("--help")
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[cfg(feature = "system-tests")]
#[test]
fn the_nats_configuration_is_valid() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
    let output = Command::new("nats-server")
        // The package installs the program in a directory that only root's path contains.
        .env("PATH", format!("{}:/usr/sbin", std::env::var("PATH").unwrap_or_default()))
        .args(["-t", "-c"])
        .arg(docs.join("hosting/nats-server.conf"))
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}
