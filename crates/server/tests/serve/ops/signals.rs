//! Signals: SIGHUP reloads the configuration, SIGTERM shuts the server down.

use std::fs;
use std::io::Write;
use std::net::TcpStream;
use std::time::Instant;

use rustix::process::Signal;
use serde_json::Value;

use crate::running::Running;
use crate::transport::wait_until;

#[test]
fn a_hangup_signal_reloads_the_configuration() {
    let running = Running::start("log = \"info\"\n", "text");
    running.wait_for_log("host: listening");
    let config = running.folder.join("serve.toml");

    fs::write(&config, "connections = 0\n").unwrap();
    running.signal(Signal::HUP);
    running.wait_for_log("a whole number from 1 to 100000");
    let log = running.log();
    let fault = log.lines().find(|line| line.contains("a whole number")).unwrap();
    assert!(fault.contains("ERROR host: configuration not reloaded"), "{fault}");
    // The previous configuration stays in force.
    let visitor = running.visitor();
    running.wait_for_visitors(1);
    drop(visitor);
    running.wait_for_visitors(0);

    fs::write(
        &config,
        "listen = \"127.0.0.1:1\"\nlog = \"info,connections=off\"\n\
                        [metrics]\nlisten = \"127.0.0.1:2\"\n",
    )
    .unwrap();
    running.signal(Signal::HUP);
    running.wait_for_log("configuration reloaded");
    // The address on the command line takes precedence over the one in the file.
    running.wait_for_log("needs_restart=\"metrics.listen\"");
    let before = running.log().matches(" connections: ").count();
    let visitor = running.visitor();
    running.wait_for_visitors(1);
    drop(visitor);
    running.wait_for_visitors(0);
    assert_eq!(running.log().matches(" connections: ").count(), before);
    assert!(before >= 3, "{}", running.log());
}

#[test]
fn new_limits_apply_to_new_connections() {
    let running = Running::start("connections = 1\n", "text");
    let first = running.visitor();
    running.wait_for_visitors(1);
    let mut second = running.visitor();
    second.wait_for("This host accepts at most 1 connection at a time: try again later.");
    second.wait_for_end();
    running.wait_for_log("reason=\"full\"");
    fs::write(running.folder.join("serve.toml"), "connections = 2\n").unwrap();
    running.signal(Signal::HUP);
    running.wait_for_log("configuration reloaded");
    let second = running.visitor();
    running.wait_for_visitors(2);
    drop((first, second));
}

#[test]
fn a_signal_ends_the_server_and_the_log_says_so() {
    let mut running = Running::start("drain-seconds = 5\n", "json");
    let mut visitor = running.visitor();
    running.wait_for_visitors(1);
    running.signal(Signal::TERM);
    assert_eq!(running.wait_for_end(), Some(0));
    visitor.wait_for_end();
    let log = running.log();
    let events: Vec<Value> = log.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let messages: Vec<&str> = events.iter().filter_map(|event| event["message"].as_str()).collect();
    let of_a_visit =
        ["listening", "accepted", "authenticated", "draining", "disconnected", "ended"];
    let expected: Vec<&str> =
        messages.iter().copied().filter(|message| of_a_visit.contains(message)).collect();
    assert_eq!(expected, of_a_visit, "{log}");
    let draining = events.iter().find(|event| event["message"] == "draining").unwrap();
    assert_eq!((&draining["seconds"], &draining["target"]), (&5.into(), &"host".into()));
    assert!(!log.contains("127.0.0.1\""), "an address is logged whole: {log}");
}

#[test]
fn a_connection_flood_logs_a_few_lines_a_second() {
    const FLOOD: u64 = 1000;
    let running = Running::start("", "json");
    let begun = Instant::now();
    for _ in 0..FLOOD {
        // The server may already have closed the connection.
        _ = TcpStream::connect(running.address()).unwrap().write_all(b"SSH-2.0-flood\r\n");
    }
    let connections = || -> Vec<Value> {
        let log = running.log();
        let events = log.lines().filter_map(|line| serde_json::from_str::<Value>(line).ok());
        events.filter(|event| event["target"] == "connections").collect()
    };
    wait_until("all are in the log", || {
        let events = connections();
        let came = events.iter().filter(|event| event["message"] != "disconnected");
        came.filter_map(|event| event["count"].as_u64()).sum::<u64>() == FLOOD
    });
    let (lines, seconds) = (connections().len() as u64, begun.elapsed().as_secs() + 1);
    assert!(lines <= 12 * seconds, "{lines} lines in {seconds} s");
}

#[test]
fn an_operator_can_end_the_server_like_a_signal() {
    let mut running = Running::start("drain-seconds = 1\n", "text");
    let mut visitor = running.visitor();
    running.wait_for_visitors(1);
    assert_eq!(
        running.admin_says(&["drain"]),
        "the server is shutting down; it waits for 1 visitor\n"
    );
    assert_eq!(running.wait_for_end(), Some(0));
    visitor.wait_for_end();
    assert!(running.log().contains("host: draining seconds=1"), "{}", running.log());
}
