//! Connections from a proxy, which begin with a header that names the visitor.

use std::io::{Read, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpStream};
use std::sync::Arc;
use std::thread;
use std::time::Duration;

use cellcaster_server::accounts::AddressPrefix;
use cellcaster_server::admission::Refusal;
use cellcaster_server::config::Config;
use russh::client::{self, Handle};
use tokio::io::AsyncWriteExt;
use tokio::net::TcpSocket;
use tokio::runtime::Runtime;

use super::house::{House, TIMEOUT};
use crate::soak::wanderer::Anyone;

const PROXY: [u8; 4] = [127, 0, 0, 9];
const LOCAL: &[u8] = b"\r\n\r\n\0\r\nQUIT\n\x20\0\0\0";

fn behind_a_proxy(change: impl FnOnce(&mut Config)) -> House {
    House::open_with(|config| {
        config.proxies = vec![AddressPrefix::parse("127.0.0.9").unwrap()];
        change(config);
    })
}

fn text(visitor: &str) -> Vec<u8> {
    format!("PROXY TCP4 {visitor} 127.0.0.9 49152 22\r\n").into_bytes()
}

fn binary(visitor: [u8; 4]) -> Vec<u8> {
    let start = b"\r\n\r\n\0\r\nQUIT\n\x21\x11\0\x0c";
    [start as &[u8], &visitor, &PROXY, &[192, 0, 0, 22]].concat()
}

async fn socket(house: &House, from: [u8; 4]) -> tokio::net::TcpStream {
    let socket = TcpSocket::new_v4().unwrap();
    socket.bind(SocketAddr::from((Ipv4Addr::from(from), 0))).unwrap();
    socket.connect(house.address).await.unwrap()
}

/// A guest whose connection comes from `from` and begins with `header`.
async fn guest(house: &House, from: [u8; 4], header: &[u8]) -> Option<Handle<Anyone>> {
    let mut socket = socket(house, from).await;
    socket.write_all(header).await.unwrap();
    let mut client = client::connect_stream(Arc::default(), socket, Anyone).await.ok()?;
    client.authenticate_none("guest").await.is_ok_and(|it| it.success()).then_some(client)
}

/// The server's answer to `bytes`, up to the end of the connection.
fn answer(house: &House, from: [u8; 4], bytes: &[u8]) -> String {
    let runtime = Runtime::new().unwrap();
    let socket = runtime.block_on(async { socket(house, from).await.into_std().unwrap() });
    let mut socket: TcpStream = socket;
    socket.set_nonblocking(false).unwrap();
    socket.set_read_timeout(Some(TIMEOUT)).unwrap();
    socket.write_all(bytes).unwrap();
    let mut answer = Vec::new();
    // A connection that is closed silently may be reset.
    _ = socket.read_to_end(&mut answer);
    String::from_utf8_lossy(&answer).into_owned()
}

/// The answer to a connection from the proxy, on a thread without a runtime.
fn answer_beside(house: &House, bytes: &[u8]) -> String {
    thread::scope(|scope| scope.spawn(|| answer(house, PROXY, bytes)).join().unwrap())
}

#[test]
fn visitors_behind_a_proxy_count_by_their_own_addresses() {
    const REFUSED: &str = "at most 1 connection from one address";
    let house = behind_a_proxy(|config| config.connections_per_address = 1);
    Runtime::new().unwrap().block_on(async {
        let first = guest(&house, PROXY, &text("192.0.2.7")).await;
        let second = guest(&house, PROXY, &binary([192, 0, 2, 8])).await;
        assert!(first.is_some() && second.is_some());
        for header in [text("192.0.2.7"), binary([192, 0, 2, 8])] {
            let told = answer_beside(&house, &header);
            assert!(told.contains(REFUSED), "{told}");
        }
    });
    house.assert_answers();
}

#[test]
fn only_a_proxy_can_name_an_address() {
    let house = behind_a_proxy(|config| config.connections_per_address = 1);
    let _player = house.visitor(&[]);
    let told = answer(&house, [127, 0, 0, 1], &text("192.0.2.7"));
    assert!(told.contains("at most 1 connection from one address"), "{told}");
}

#[test]
fn missing_headers_and_health_checks_do_not_lock_out_a_proxy() {
    let house = behind_a_proxy(|config| {
        config.failures = 2;
        config.forget = Duration::from_hours(1);
    });
    let told = answer(&house, PROXY, b"SSH-2.0-test\r\n");
    assert!(told.contains("expects a PROXY header from your address"), "{told}");
    for bytes in [b"GET / HTTP/1.1\r\n\r\n" as &[u8], &[LOCAL, b"GET / HTTP/1.1\r\n\r\n"].concat()]
    {
        for _ in 0..20 {
            answer(&house, PROXY, bytes);
        }
    }
    Runtime::new().unwrap().block_on(async {
        for header in [&text("192.0.2.7"), LOCAL] {
            assert!(guest(&house, PROXY, header).await.is_some());
        }
    });
    assert_eq!(house.metrics.refused(Refusal::Penalty).get(), 0);
    house.assert_answers();
}

#[test]
fn connections_whose_headers_do_not_arrive_are_limited_and_closed() {
    let house = behind_a_proxy(|config| {
        config.startups = 2;
        config.handshake = Duration::from_secs(2);
    });
    let slow = answer(&house, PROXY, b"PROXY TCP4 192.0.2.7");
    assert_eq!(slow, "");
    Runtime::new().unwrap().block_on(async {
        let _silent = [socket(&house, PROXY).await, socket(&house, PROXY).await];
        let third = answer_beside(&house, &text("192.0.2.7"));
        assert!(third.contains("Too many visitors are logging in"), "{third}");
    });
    house.assert_answers();
}
