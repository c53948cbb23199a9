//! Sockets that do not speak SSH, or only its beginning.

use std::collections::VecDeque;
use std::io::{ErrorKind, Read, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpStream};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use cellcaster::rng::SplitMix64;
use cellcaster_server::admission::Refusal;
use tokio::net::TcpSocket;
use tokio::runtime::Runtime;

use super::house::{House, TIMEOUT};

const VERSION: &[u8] = b"SSH-2.0-test\r\n";

fn connect(house: &House) -> TcpStream {
    let stream = TcpStream::connect(house.address).unwrap();
    stream.set_read_timeout(Some(TIMEOUT)).unwrap();
    stream.set_write_timeout(Some(TIMEOUT)).unwrap();
    stream
}

/// Reads until the server closes the connection.
fn read_to_end(stream: &mut TcpStream) -> Vec<u8> {
    let mut answer = Vec::new();
    let mut buffer = [0; 4096];
    loop {
        match stream.read(&mut buffer) {
            Ok(0) => return answer,
            Ok(count) => answer.extend(&buffer[..count]),
            Err(error) if error.kind() == ErrorKind::ConnectionReset => return answer,
            Err(error) => panic!("it is not closed: {error}"),
        }
    }
}

/// An unencrypted packet.
fn packet(kind: u8, length: usize) -> Vec<u8> {
    let mut packet = (length as u32).to_be_bytes().to_vec();
    packet.extend([4, kind]);
    packet.resize(4 + length, 0);
    packet
}

#[test]
fn a_silent_connection_is_closed() {
    let house = House::open_with(|config| config.handshake = Duration::from_secs(1));
    house.beside_another(|| {
        let mut silent = connect(&house);
        let mut versed = connect(&house);
        versed.write_all(VERSION).unwrap();
        assert!(read_to_end(&mut silent).starts_with(b"SSH-2.0-cellcaster\r\n"));
        read_to_end(&mut versed);
    });
    house.assert_answers();
}

/// A client sends its version at once, even if its key exchange takes long.
#[test]
fn the_version_timeout_is_shorter_than_the_key_exchange_timeout() {
    let house = House::open_with(|config| config.handshake = TIMEOUT);
    let mut versed = connect(&house);
    versed.write_all(VERSION).unwrap();
    let mut silent = connect(&house);
    read_to_end(&mut silent);
    versed.set_read_timeout(Some(Duration::from_secs(1))).unwrap();
    let mut answer = [0; 4096];
    let waits = loop {
        match versed.read(&mut answer) {
            Ok(0) => panic!("it is closed as soon as the silent one"),
            Ok(_) => {}
            Err(error) => break error.kind(),
        }
    };
    assert!(matches!(waits, ErrorKind::WouldBlock | ErrorKind::TimedOut), "{waits}");
}

#[test]
fn a_slowly_dripping_connection_is_closed() {
    let house = House::open_with(|config| config.handshake = Duration::from_secs(1));
    house.beside_another(|| {
        let mut slow = connect(&house);
        let bytes = [VERSION, &packet(20, 1000)].concat();
        let begun = Instant::now();
        let dripped = bytes.iter().take_while(|byte| {
            thread::sleep(Duration::from_millis(20));
            assert!(begun.elapsed() < TIMEOUT, "it is not closed");
            slow.write_all(&[**byte]).is_ok()
        });
        assert!(dripped.count() < bytes.len());
    });
    house.assert_answers();
}

#[test]
fn garbage_is_refused() {
    let house = House::open_with(|config| {
        config.handshake = Duration::from_secs(2);
        // Otherwise, after four failures, an address is refused at random.
        config.failures = 1000;
    });
    let mut random = SplitMix64::new(1);
    house.beside_another(|| {
        for beginning in
            [b"GET / HTTP/1.1\r\n\r\n" as &[u8], b"\0\0\0\0", VERSION, b"SSH-1.5-x\r\n"]
        {
            let mut stream = connect(&house);
            let garbage: Vec<u8> = (0..4096).map(|_| random.bits() as u8).collect();
            _ = stream.write_all(&[beginning, &garbage].concat());
            read_to_end(&mut stream);
        }
    });
    house.assert_answers();
}

#[test]
fn an_oversized_packet_is_refused() {
    let house = House::open_with(|config| config.failures = 1000);
    house.beside_another(|| {
        for length in [u32::MAX, 1 << 30, 300_000, 40_000, 0, 1] {
            let mut stream = connect(&house);
            stream.write_all(VERSION).unwrap();
            _ = stream.write_all(&[&length.to_be_bytes()[..], &[4, 20, 0, 0]].concat());
            if length > 1 {
                read_to_end(&mut stream);
            }
        }
    });
    house.assert_answers();
}

/// Packets to be ignored may precede the key exchange, but only up to a limit.
#[test]
fn bytes_before_authentication_are_limited() {
    let house = House::open();
    house.beside_another(|| {
        let mut stream = connect(&house);
        stream.write_all(VERSION).unwrap();
        let ignored = packet(2, 1004);
        let written = (0..100_000).take_while(|_| stream.write_all(&ignored).is_ok()).count();
        // The rest was in flight when the connection was closed.
        assert!(written * ignored.len() < 16 << 20, "{written}");
        read_to_end(&mut stream);
    });
    house.assert_answers();
}

/// Silent connections arrive all the time from eight networks. Clients from all other networks still get in.
#[test]
fn half_open_connections_leave_room_for_others() {
    let house = House::open();
    let is_over = AtomicBool::new(false);
    thread::scope(|scope| {
        scope.spawn(|| flood(house.address, &is_over));
        let displaced = || house.metrics.refused(Refusal::Startups).get();
        super::house::wait_until("none is displaced", || displaced() > 10);
        for _ in 0..5 {
            let before = displaced();
            let (_, error, _) = house.run(&[], &["-T", "ann@127.0.0.1"]);
            assert!(error.contains("This is a game"), "{error}");
            super::house::wait_until("the flood has ended", || displaced() > before);
        }
        is_over.store(true, Ordering::Relaxed);
    });
    house.assert_answers();
}

/// Opens connections from eight /16 networks, and keeps the last 400 of them open.
fn flood(server: SocketAddr, is_over: &AtomicBool) {
    Runtime::new().unwrap().block_on(async {
        let mut streams = VecDeque::new();
        for number in 0_u32.. {
            if is_over.load(Ordering::Relaxed) {
                break;
            }
            let socket = TcpSocket::new_v4().unwrap();
            let from = Ipv4Addr::new(127, 9 + (number % 8) as u8, (number / 8) as u8, 9);
            socket.bind(SocketAddr::from((from, 0))).unwrap();
            streams.push_back(socket.connect(server).await.unwrap());
            if streams.len() > 400 {
                streams.pop_front();
            }
        }
    });
}
