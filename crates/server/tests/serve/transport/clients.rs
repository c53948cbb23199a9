//! OpenSSH's client with commonly used options.

use std::io::Read;
use std::net::{TcpListener, TcpStream};
use std::process::Command;

use cellcaster_server::admission::Refusal;
use rustix::process::Signal;

use super::house::{House, wait_until};

#[test]
fn a_client_without_a_key_is_a_guest() {
    let house = House::open();
    let player = house.visitor(&[]);
    for text in ["[ann]", "[guest]", "[xterm-256color]", "[80x24]", "[compressed false]"] {
        player.wait_for(text);
    }
    house.assert_answers();
}

#[test]
fn the_comment_of_a_key_does_not_matter() {
    let house = House::open();
    let path = house.user_key("key", "ann@home");
    let identity = format!("IdentityFile={path}");
    let first = house.visitor(&["-o", &identity]);
    first.wait_for("[SHA256:");
    let fingerprint = first.text();
    let comment =
        Command::new("ssh-keygen").args(["-q", "-c", "-C", "another", "-f", &path]).output();
    assert!(comment.unwrap().status.success());
    let second = house.visitor(&["-o", &identity]);
    assert_eq!(second.text(), fingerprint);
    let guest = house.player(&["-o", &identity, "-l", "guest"]);
    guest.wait_for("[guest]\n[guest]");
    house.assert_answers();
}

#[test]
fn one_key_is_limited_to_three_sessions() {
    let house = House::open();
    house.beside_another(|| {
        let identity = format!("IdentityFile={}", house.user_key("key", ""));
        let _players = [(); 3].map(|()| house.visitor(&["-o", &identity]));
        let mut fourth = house.player(&["-o", &identity]);
        fourth.wait_for("This host accepts at most 3 connections with one key");
        assert_eq!(fourth.wait_for_end().status.code(), Some(2));
    });
    house.assert_answers();
}

#[test]
fn a_visitor_with_an_rsa_key_is_a_guest_and_is_told_why() {
    const NOTICE: &str = "RSA keys have no account here";
    let house = House::open();
    let rsa = format!("IdentityFile={}", house.user_key_of("rsa", "rsa", ""));
    let guest = house.visitor(&["-o", &rsa]);
    guest.wait_for(NOTICE);
    guest.wait_for("[guest]");
    let other = format!("IdentityFile={}", house.user_key("key", ""));
    let account = house.visitor(&["-o", &rsa, "-o", &other]);
    account.wait_for("[SHA256:");
    assert!(!account.text().contains(NOTICE));
    house.assert_answers();
}

/// OpenSSH's client of version 9.5 or newer sends a stream of false keys to servers that offer this extension. Each
/// would count against the limits, and real keys would wait for the next one.
#[test]
fn the_server_does_not_offer_pings_with_which_clients_hide_keys() {
    let house = House::open();
    let (_, error, _) = house.run(&["-vvv"], &["-T", "ann@127.0.0.1"]);
    assert!(error.contains("server-sig-algs"), "{error}");
    assert!(!error.contains("ping@openssh.com"), "{error}");
    house.assert_answers();
}

#[test]
fn passwords_are_refused() {
    let house = House::open();
    house.beside_another(|| {
        let (_, error, status) =
            house.run(&["-o", "PreferredAuthentications=password"], &["-tt", "ann@127.0.0.1"]);
        assert!(error.contains("Permission denied"), "{error}");
        assert_eq!(status, Some(255));
    });
    house.assert_answers();
}

#[test]
fn a_client_without_a_terminal_gets_one_sentence() {
    let house = House::open();
    house.beside_another(|| {
        let (output, error, status) = house.run(&[], &["-T", "ann@127.0.0.1"]);
        assert_eq!(output, "");
        assert_eq!(error, "This is a game for a terminal: connect with ssh -t.\r\n");
        assert_eq!(status, Some(2));
    });
    house.assert_answers();
}

#[test]
fn commands_and_subsystems_are_refused() {
    let house = House::open();
    house.beside_another(|| {
        for rest in [
            &["ann@127.0.0.1", "id"] as &[&str],
            &["-tt", "ann@127.0.0.1", "id"],
            &["-s", "ann@127.0.0.1", "sftp"],
        ] {
            let (output, error, status) = house.run(&[], rest);
            assert_eq!(output, "", "{rest:?}");
            assert!(error.contains("request failed on channel 0"), "{rest:?}: {error}");
            assert_eq!(status, Some(255), "{rest:?}");
        }
    });
    house.assert_answers();
}

#[test]
fn a_visitor_over_the_address_limit_sees_the_limit() {
    let house = House::open_with(|config| config.connections_per_address = 2);
    let players = [(); 2].map(|()| house.visitor(&[]));
    for _ in 0..5 {
        let (_, error, status) = house.run(&[], &["-tt", "ann@127.0.0.1"]);
        let sentence = "This host accepts at most 2 connections from one address (/64 of IPv6): end another \
                        game first.";
        assert!(error.contains(sentence), "{error}");
        assert_eq!(status, Some(255));
    }
    drop(players);
    wait_until("their sessions live on", || house.sessions() == 0);
    house.assert_answers();
}

/// The visitor's `ssh` waits for a passphrase meanwhile.
#[test]
fn a_displaced_visitor_is_told_why() {
    let house = House::open_with(|config| config.startups = 1);
    let key = house.user_key("locked", "");
    let mut keygen = Command::new("ssh-keygen");
    let locked = keygen.args(["-q", "-p", "-P", "", "-N", "secret", "-f", &key]).output();
    assert!(locked.unwrap().status.success());
    let mut player = house.player(&["-o", &format!("IdentityFile={key}")]);
    player.wait_for("Enter passphrase");
    let _newcomer = TcpStream::connect(house.address).unwrap();
    let displaced = || house.metrics.refused(Refusal::Startups).get();
    wait_until("nobody is displaced", || displaced() == 1);
    player.send("secret\r");
    player.wait_for("Too many visitors");
    assert_eq!(player.wait_for_end().status.code(), Some(255));
}

#[test]
fn nothing_is_forwarded() {
    let house = House::open();
    let inside = TcpListener::bind("127.0.0.1:0").unwrap();
    let free = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let forward = format!("{free}:127.0.0.1:{}", inside.local_addr().unwrap().port());
    let player = house.visitor(&["-A", "-X", "-L", &forward]);
    let mut outside = TcpStream::connect(("127.0.0.1", free)).unwrap();
    assert_eq!(outside.read(&mut [0; 1]).unwrap_or(0), 0);
    inside.set_nonblocking(true).unwrap();
    assert!(inside.accept().is_err());
    player.send("still here");
    player.wait_for("[typed still here]");
    let back = format!("0:127.0.0.1:{}", inside.local_addr().unwrap().port());
    let refused = ["-o", "ExitOnForwardFailure=yes", "-R", &back];
    let (_, error, status) = house.run(&refused, &["-tt", "ann@127.0.0.1"]);
    assert!(error.contains("remote port forwarding failed"), "{error}");
    assert_eq!(status, Some(255));
    house.assert_answers();
}

/// Megabytes of frames pass during repeated key exchanges, and each key reaches the session.
fn frames_outlive_key_exchanges(options: &[&str]) {
    let house = House::open();
    let limit = ["-o", "RekeyLimit=64K"];
    let player = house.visitor(&[options, &limit].concat());
    player.send("F");
    // Between two frames, the screen is complete for hardly a moment.
    wait_until("frames stop", || player.look(|emulator| emulator.bytes().len()) > 1_000_000);
    // The next frame states how many bytes were sent before it.
    player.send("over");
    player.send("f");
    player.wait_for("overf]");
    let (received, shown) = player.look(|emulator| {
        const BEGIN: &[u8] = b"\x1b[?2026h";
        let bytes = emulator.bytes();
        let begins = bytes.windows(BEGIN.len()).rposition(|window| window == BEGIN);
        (begins.unwrap(), emulator.text())
    });
    assert!(shown.contains(&format!("[sent {received}]")), "{received} bytes:\n{shown}");
    house.assert_answers();
}

#[test]
fn frames_survive_key_exchanges_without_compression() {
    frames_outlive_key_exchanges(&[]);
}

/// Compression begins after authentication, and restarts with each key exchange.
#[test]
fn frames_survive_key_exchanges_with_compression() {
    frames_outlive_key_exchanges(&["-C"]);
}

#[test]
fn a_client_can_request_compression() {
    let house = House::open();
    let player = house.visitor(&["-C"]);
    player.wait_for("[compressed true]");
    house.assert_answers();
}

#[test]
fn only_terminal_variables_are_accepted() {
    let house = House::open();
    let set =
        "SetEnv=LANG=de_DE.UTF-8 PATH=/x COLORTERM=truecolor LC_CTYPE=C NO_COLOR=1 LD_DEBUG=all";
    let player = house.visitor(&["-o", set]);
    player.wait_for("[COLORTERM=truecolor LANG=de_DE.UTF-8 LC_CTYPE=C NO_COLOR=1]");
    house.assert_answers();
}

#[test]
fn the_size_is_right_after_many_resizes() {
    let house = House::open();
    house.beside_another(|| {
        let player = house.visitor(&[]);
        for round in 0..500 {
            player.resize(20 + round % 300, 10 + round % 90);
        }
        player.resize(90, 30);
        player.wait_for("[90x30]");
        player.resize(1000, 900);
        player.wait_for("[500x200]");
    });
    house.assert_answers();
}

#[test]
fn ssh_exits_with_the_status_of_the_session() {
    let house = House::open();
    let mut player = house.visitor(&[]);
    player.send("q");
    assert_eq!(player.wait_for_end().status.code(), Some(7));
    house.assert_answers();
}

/// A stopped client answers nothing, like one behind a cut link.
#[test]
fn a_silent_client_is_disconnected() {
    let house = House::open_with(|config| config.silence = std::time::Duration::from_secs(3));
    let silent = house.visitor(&[]);
    let alive = house.visitor(&[]);
    silent.signal(Signal::STOP);
    wait_until("the silent client is served on", || house.sessions() == 1);
    alive.send("here");
    alive.wait_for("[typed here]");
    silent.signal(Signal::CONT);
    house.assert_answers();
}

/// Keep-alive questions arrive between the client's keys; neither may disturb the other.
#[test]
fn keep_alive_requests_do_not_disturb_keys() {
    let house = House::open_with(|config| config.silence = std::time::Duration::from_secs(2));
    let player = house.visitor(&[]);
    for (count, key) in (1..).zip(["a", "b", "\x1b", "[A", "c", "d"]) {
        std::thread::sleep(std::time::Duration::from_millis(900));
        player.send(key);
        let bytes = if count < 4 { count } else { count + 1 };
        player.wait_for(&format!("[{bytes}]"));
    }
    player.send("~.~B~?");
    player.wait_for("[13]");
    house.assert_answers();
}

#[test]
fn the_end_of_a_client_ends_its_session() {
    let house = House::open();
    let mut player = house.visitor(&[]);
    player.signal(Signal::KILL);
    player.wait_for_end();
    wait_until("its session lives on", || house.sessions() == 0);
    house.assert_answers();
}

#[test]
fn sessions_are_told_when_the_server_ends() {
    let mut house = House::open();
    let mut players = [(); 3].map(|()| house.visitor(&[]));
    house.stop();
    for player in &mut players {
        player.wait_for("[drains]");
        assert_eq!(player.wait_for_end().status.code(), Some(0));
    }
    house.wait_for_end();
    // A process that another test is just starting holds the listener for a moment.
    wait_until("the port still accepts", || TcpStream::connect(house.address).is_err());
}
