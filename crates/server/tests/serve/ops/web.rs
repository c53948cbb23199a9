//! Rooms in a browser.

use std::io::{Read, Write};
use std::net::TcpStream;

use super::metrics::{free_port, scrape};
use crate::play::enter_room;
use crate::play::private::open_private;
use crate::running::Running;
use crate::transport::{TIMEOUT, wait_until};

/// A server with the service, and its ports for browsers and for metrics.
pub(crate) fn watched(option: &[&str]) -> (Running, [u16; 2]) {
    let [web, metrics] = [free_port(), free_port()];
    let address = format!("127.0.0.1:{web}");
    let (config, options) = match option {
        [] => (format!("web = \"{address}\"\n"), vec![]),
        _ => (String::new(), [option, &[&address]].concat()),
    };
    let config = format!("{config}[metrics]\nlisten = \"127.0.0.1:{metrics}\"\n");
    (Running::start_with(&config, "text", &options), [web, metrics])
}

/// The answer to a request, up to the end of the connection.
fn get(port: u16, path: &str) -> String {
    let mut stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
    stream.set_read_timeout(Some(TIMEOUT)).unwrap();
    write!(stream, "GET {path} HTTP/1.1\r\nHost: localhost\r\n\r\n").unwrap();
    let mut answer = String::new();
    stream.read_to_string(&mut answer).unwrap();
    answer
}

/// Asks for the pictures of a room; returns the socket after the server's answer.
pub(crate) fn watch(port: u16, room: u32) -> (TcpStream, String) {
    open_socket(port, &format!("/rooms/{room}/live"))
}

/// Asks for a WebSocket as the page does; returns the socket after the server's answer.
pub(crate) fn open_socket(port: u16, path: &str) -> (TcpStream, String) {
    let mut stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
    stream.set_read_timeout(Some(TIMEOUT)).unwrap();
    write!(
        stream,
        "GET {path} HTTP/1.1\r\nHost: localhost\r\nOrigin: http://localhost\r\n\
         Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n\
         Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
    )
    .unwrap();
    let mut head = Vec::new();
    let mut byte = [0];
    while !head.ends_with(b"\r\n\r\n") && stream.read(&mut byte).unwrap() > 0 {
        head.push(byte[0]);
    }
    (stream, String::from_utf8(head).unwrap())
}

#[test]
fn a_browser_watches_a_public_room_until_it_sends_data() {
    let (running, [web, metrics]) = watched(&[]);
    running.wait_for_log("web listening");
    let [mara, jon] = [running.visitor(), running.visitor()];
    enter_room(&mara, "Mara");
    let code = open_private(&jon, "Jon");
    assert_eq!(code.len(), 6);
    wait_until("the list shows Mara", || get(web, "/rooms").contains("\"players\":[\"Mara\"]"));
    let list = get(web, "/rooms");
    assert!(!list.contains("Jon"), "{list}");
    let room = running.admin_says(&["rooms", "--format", "json"]);
    let rooms: serde_json::Value = serde_json::from_str(&room).unwrap();
    let number = |is_private: bool| {
        let mut rooms = rooms.as_array().unwrap().iter();
        let room = rooms.find(|room| {
            room["is_private"] == is_private && !room["members"].as_array().unwrap().is_empty()
        });
        room.unwrap()["room"].as_u64().unwrap() as u32
    };
    let (_, refusal) = watch(web, number(true));
    assert!(refusal.starts_with("HTTP/1.1 404"), "{refusal}");
    let (mut socket, answer) = watch(web, number(false));
    assert!(answer.starts_with("HTTP/1.1 101"), "{answer}");
    // A message in words, and the first picture.
    let mut start = [0; 400];
    socket.read_exact(&mut start).unwrap();
    assert!(String::from_utf8_lossy(&start).contains("\"seen\":\"Mara\""), "{start:?}");
    let figure = |name: &str| scrape(metrics)[&format!("cellcaster_web_{name}")];
    assert_eq!(figure("watchers"), 1.0);
    wait_until("pictures are counted", || figure("pictures_total") > 0.0);
    // A masked text frame.
    socket.write_all(b"\x81\x81\0\0\0\0w").unwrap();
    wait_until("the browser is disconnected", || figure("watchers") == 0.0);
}

#[test]
fn browsers_have_a_page_only_where_an_operator_wants_it() {
    let (running, [web, _]) = watched(&["--web"]);
    running.wait_for_log("web listening");
    let page = get(web, "/");
    assert!(page.starts_with("HTTP/1.1 200 OK\r\n") && page.contains("<canvas"), "{page}");
    let running = Running::start("", "text");
    running.wait_for_log("listening");
    assert!(!running.log().contains("web listening"), "{}", running.log());
}
