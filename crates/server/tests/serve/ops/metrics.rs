//! Metrics over HTTP.

use std::collections::BTreeMap;
use std::io::{Read, Write};
use std::net::{Ipv4Addr, Shutdown, TcpListener, TcpStream, ToSocketAddrs};
use std::thread;
use std::time::Duration;

use crate::running::Running;
use crate::transport::TIMEOUT;

/// A port that was free a moment ago.
pub(crate) fn free_port() -> u16 {
    TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port()
}

fn measured() -> (Running, u16) {
    let port = free_port();
    let running = Running::start(&format!("[metrics]\nlisten = \"127.0.0.1:{port}\"\n"), "text");
    (running, port)
}

/// Sends a request and returns everything that the server sends until it closes the connection.
fn answer(address: impl ToSocketAddrs, request: &[u8]) -> String {
    let mut stream = TcpStream::connect(address).unwrap();
    stream.set_read_timeout(Some(TIMEOUT)).unwrap();
    // The server may close the connection before it has read everything.
    _ = stream.write_all(request);
    _ = stream.shutdown(Shutdown::Write);
    let mut answer = String::new();
    _ = stream.read_to_string(&mut answer);
    answer
}

pub(crate) fn scrape(port: u16) -> BTreeMap<String, f64> {
    scrape_at((Ipv4Addr::LOCALHOST, port))
}

/// The metrics of a host that serves them at `address`.
pub(crate) fn scrape_at(address: impl ToSocketAddrs) -> BTreeMap<String, f64> {
    let answer = answer(address, b"GET /metrics HTTP/1.1\r\nHost: localhost\r\n\r\n");
    let (head, body) = answer.split_once("\r\n\r\n").unwrap();
    assert!(head.starts_with("HTTP/1.1 200 OK\r\n"), "{head}");
    assert!(head.contains("Content-Type: text/plain; version=0.0.4"), "{head}");
    assert!(head.contains(&format!("Content-Length: {}", body.len())), "{head}");
    let samples = body.lines().filter(|line| !line.starts_with('#'));
    samples
        .map(|line| {
            let (name, value) = line.rsplit_once(' ').unwrap();
            (name.to_owned(), value.parse().unwrap())
        })
        .collect()
}

#[test]
fn visitors_are_counted() {
    let (running, port) = measured();
    let before = scrape(port);
    assert_eq!((before["cellcaster_sessions"], before["cellcaster_frames_total"]), (0.0, 0.0));
    let visitor = running.visitor();
    running.wait_for_visitors(1);
    let during = scrape(port);
    assert_eq!(during["cellcaster_connections"], 1.0);
    assert_eq!(during["cellcaster_sessions"], 1.0);
    assert_eq!(during["cellcaster_connections_accepted_total"], 1.0);
    assert_eq!(during["cellcaster_connections_refused_total{reason=\"full\"}"], 0.0);
    drop(visitor);
    running.wait_for_visitors(0);
    let after = scrape(port);
    assert!(after["cellcaster_frames_total"] >= 1.0);
    assert!(after["cellcaster_frame_bytes_total"] > after["cellcaster_frames_total"]);
    if cfg!(target_os = "linux") {
        assert!(after["process_cpu_seconds_total"] >= before["process_cpu_seconds_total"]);
        assert!(after["process_resident_memory_bytes"] > 1e6);
    }
}

#[test]
fn invalid_requests_do_not_block_others() {
    let (_running, port) = measured();
    let long = [b"GET /metrics HTTP/1.1\r\nX: ".as_slice(), &[b'x'; 10_000]].concat();
    for (request, status) in [
        (b"GET / HTTP/1.1\r\n\r\n".as_slice(), "404"),
        (b"POST /metrics HTTP/1.1\r\nContent-Length: 3\r\n\r\nabc", "405"),
        (b"\x16\x03\x01\x00\xff", "400"),
        (&long, "400"),
    ] {
        let answer = answer(("127.0.0.1", port), request);
        assert!(answer.is_empty() || answer.contains(status), "{answer}");
    }
    // These clients send nothing, and occupy all slots for two seconds.
    let silent: Vec<TcpStream> =
        (0..20).map(|_| TcpStream::connect(("127.0.0.1", port)).unwrap()).collect();
    thread::sleep(Duration::from_millis(50));
    scrape(port);
    drop(silent);
}

#[test]
fn metrics_are_off_by_default_and_a_taken_port_is_reported() {
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port();
    let folder = crate::transport::folder();
    let config = folder.join("serve.toml");
    std::fs::write(&config, format!("[metrics]\nlisten = \"127.0.0.1:{port}\"\n")).unwrap();
    let output = crate::support::server(&["--listen", "127.0.0.1:0", "--config"])
        .arg(&config)
        .env("CELLCASTER_DATA", &folder)
        .output()
        .unwrap();
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(
        error.starts_with(&format!("cellcaster: the server can't listen on 127.0.0.1:{port}: ")),
        "{error}"
    );
    let running = Running::start("", "text");
    running.wait_for_log("listening");
    assert!(!running.log().contains("metrics"), "{}", running.log());
}
