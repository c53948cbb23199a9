//! The server program: its start, its errors and its exit.

use std::fs;
use std::io::{BufRead, BufReader};
use std::net::TcpListener;
use std::path::Path;
use std::process::{Child, Command, Stdio};

use rustix::process::{Pid, Signal, kill_process};

use super::house::folder;

fn serve(data: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_cellcaster-server"));
    command.args(arguments).env_clear().env("CELLCASTER_DATA", data);
    command
}

/// Asserts exit status 2 and returns the error message.
fn complaint(data: &Path, arguments: &[&str]) -> String {
    let output = serve(data, arguments).output().unwrap();
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{error}");
    assert!(output.stdout.is_empty());
    error
}

/// The first four lines that a server prints.
fn lines(server: &mut Child) -> Vec<String> {
    let output = BufReader::new(server.stdout.take().unwrap());
    output.lines().take(4).map(Result::unwrap).collect()
}

#[test]
fn it_prints_the_ssh_command_and_ends_at_a_signal() {
    for signal in [Signal::TERM, Signal::INT] {
        let data = folder();
        let mut server =
            serve(&data, &["--listen", "127.0.0.1:0"]).stdout(Stdio::piped()).spawn().unwrap();
        let lines = lines(&mut server);
        let (_, port) = lines[1].split_once("ssh -p ").unwrap();
        let (port, host) = port.split_once(' ').unwrap();
        assert_eq!(host, "127.0.0.1");
        let output = Command::new("ssh")
            .args(
                "-T -F none -o StrictHostKeyChecking=no -o UserKnownHostsFile=/dev/null -p"
                    .split(' '),
            )
            .args([port, "-o", "LogLevel=ERROR", "-o", "IdentityFile=none", "guest@127.0.0.1"])
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(2));
        assert!(data.join("host_key").exists());
        kill_process(Pid::from_child(&server), signal).unwrap();
        assert_eq!(server.wait().unwrap().code(), Some(0));
    }
}

#[test]
fn a_taken_port_prints_one_sentence() {
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = taken.local_addr().unwrap().to_string();
    let error = complaint(&folder(), &["--listen", &address]);
    assert!(
        error.starts_with(&format!("cellcaster: the server can't listen on {address}: ")),
        "{error}"
    );
    assert_eq!(error.lines().count(), 1);
}

#[test]
fn an_invalid_folder_prints_one_sentence() {
    let file = folder().join("file");
    fs::write(&file, "").unwrap();
    let error = complaint(&file, &[]);
    assert!(error.contains("host_key can't be"), "{error}");
    assert_eq!(error.lines().count(), 1);
}

#[test]
fn configuration_faults_have_line_numbers() {
    let folder = folder();
    let config = folder.join("serve.toml");
    fs::write(&config, "connections = 1\nconections-per-key = 1\n").unwrap();
    let error = complaint(&folder, &["--config", config.to_str().unwrap()]);
    for part in ["serve.toml:2:", "nearest setting", "connections-per-key"] {
        assert!(error.contains(part), "no {part} in {error}");
    }
    let missing = complaint(&folder, &["--config", "/nowhere/serve.toml"]);
    assert!(missing.contains("/nowhere/serve.toml can't be read"), "{missing}");
}

#[test]
fn an_address_without_a_port_prints_one_sentence() {
    let error = complaint(&folder(), &["--listen", "localhost"]);
    assert!(error.contains("--listen takes an address and a port"), "{error}");
}
