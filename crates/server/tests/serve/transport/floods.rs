//! Clients that send without end, and clients that read nothing.

use std::io::Read;
use std::net::TcpStream;
use std::time::{Duration, Instant};

use super::house::{House, TIMEOUT, wait_until};

#[test]
fn a_paste_bomb_arrives_gradually() {
    let house = House::open_with(|config| config.bytes_per_second = 16 << 10);
    house.beside_another(|| {
        let bomber = house.visitor(&[]);
        let begun = Instant::now();
        bomber.send("w".repeat(100_000));
        house.assert_answers();
        bomber.wait_for("[100000]");
        // The bytes of the first four seconds arrive at once.
        assert!(begun.elapsed() >= Duration::from_secs(2));
    });
    house.assert_answers();
}

#[test]
fn invalid_utf8_reaches_the_session_unchanged() {
    let house = House::open();
    house.beside_another(|| {
        let player = house.visitor(&[]);
        player.send(b"\xff\xfe\xc3\x28\xed\xa0\x80\x1b]0;title\x07");
        player.wait_for("[17]");
        assert_eq!(player.look(|emulator| emulator.title().to_owned()), "");
    });
    house.assert_answers();
}

/// A client that does not read takes the memory of one frame, no matter how long it stays.
#[test]
fn clients_that_never_read_use_one_frame_of_memory_each() {
    const CLIENTS: usize = 5;
    const MAX: i64 = CLIENTS as i64 * 2 * 80 * 24 * 40;
    let house = House::open();
    let players = [(); CLIENTS].map(|()| house.visitor(&[]));
    let held = || house.metrics.held.get();
    for player in &players {
        player.set_reading(false);
        player.send("F");
    }
    wait_until("they read on", || held() > 0);
    house.beside_another(|| std::thread::sleep(Duration::from_secs(2)));
    for _ in 0..3 {
        house.assert_answers();
        // A frame of noise has 80×24 cells of at most 40 bytes, in a buffer that grew by doubling.
        assert!(held() <= MAX, "{} bytes", held());
    }
    players[0].set_reading(true);
    players[0].send("awakef");
    players[0].wait_for("awakef]");
}

#[test]
fn a_client_that_reads_nothing_is_disconnected() {
    let house = House::open_with(|config| config.stall = Duration::from_secs(3));
    house.beside_another(|| {
        let player = house.visitor(&[]);
        player.set_reading(false);
        player.send("F");
        wait_until("it is served on", || house.sessions() == 1);
        player.set_reading(true);
    });
    house.assert_answers();
}

/// In a flood of refused connections, few clients are told the reason, and all are closed.
#[test]
fn few_clients_in_a_refused_flood_are_told_the_reason() {
    let house = House::open_with(|config| config.connections_per_address = 1);
    let player = house.visitor(&[]);
    let told = (0..200).filter(|_| {
        let mut stream = TcpStream::connect(house.address).unwrap();
        stream.set_read_timeout(Some(TIMEOUT)).unwrap();
        let mut answer = Vec::new();
        // A connection that is closed silently may be reset.
        _ = stream.read_to_end(&mut answer);
        assert!(answer.is_empty() || answer.starts_with(b"SSH-2.0-cellcaster\r\n"), "{answer:?}");
        String::from_utf8_lossy(&answer).contains("at most 1 connection from one address")
    });
    let (begun, told) = (Instant::now(), told.count());
    let most = 8 * (1 + begun.elapsed().as_secs() as usize / 2);
    assert!((1..=most).contains(&told), "{told} of 200, and at most {most}");
    assert_eq!(house.metrics.connections.get(), 1);
    player.send("still here");
    player.wait_for("[typed still here]");
}
