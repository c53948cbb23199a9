//! The page in Chromium, which the test drives as a person would.

use std::fmt::Write;
use std::io::{BufRead, BufReader, Read};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};

use cellcaster::game::Script;
use flate2::read::DeflateDecoder;
use futures_util::{SinkExt, StreamExt};
use serde_json::{Value, json};
use tokio::runtime::{Builder, Runtime};
use tokio::time::timeout;
use tokio_websockets::{ClientBuilder, Message, WebSocketStream};

use super::web::{open_socket, watched};
use crate::play::enter_room;
use crate::scores::filled;
use crate::transport::{TIMEOUT, folder, wait_until};

/// A script that wins a level.
const SCRIPT: &str =
    include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../maps/scripts/clock.easy.script"));
/// The size of a picture in pixels, two for each cell.
const PICTURE: [usize; 2] = [96, 60];
/// The middle of each pixel on the page's canvas, as a list of colours; null before the first picture.
const PIXELS: &str = "(() => {
    const canvas = document.querySelector('canvas'), [width, height] = [canvas.width, canvas.height];
    const data = canvas.getContext('2d').getImageData(0, 0, width, height).data, colors = [];
    for (let y = 4; y < height; y += 8) for (let x = 4; x < width; x += 8) {
        const at = 4 * (y * width + x);
        colors.push(data[at], data[at + 1], data[at + 2]);
    }
    return colors;
})()";

/// A browser with one page.
struct Browser {
    process: Child,
    runtime: Runtime,
    socket: WebSocketStream<tokio::net::TcpStream>,
    session: Value,
    calls: u32,
}

impl Browser {
    fn open(page: &str) -> Self {
        let folder = folder();
        let mut process = Command::new("chromium")
            .args(["--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"])
            .args(["--remote-debugging-port=0", page])
            .arg(format!("--user-data-dir={}", folder.join("chromium").display()))
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut lines = BufReader::new(process.stderr.take().unwrap()).lines();
        let address = lines.by_ref().find_map(|line| {
            line.unwrap().strip_prefix("DevTools listening on ").map(str::to_owned)
        });
        let address = address.expect("Chromium ended");
        // Chromium must be able to write on.
        std::thread::spawn(move || lines.for_each(drop));
        let runtime = Builder::new_current_thread().enable_all().build().unwrap();
        let socket = runtime.block_on(async {
            let client = ClientBuilder::new().uri(&address).unwrap();
            let host = address.split('/').nth(2).unwrap();
            let socket = tokio::net::TcpStream::connect(host).await.unwrap();
            client.connect_on(socket).await.unwrap().0
        });
        let mut browser = Self { process, runtime, socket, session: Value::Null, calls: 0 };
        let targets = browser.call("Target.getTargets", &json!({}));
        let targets = targets["targetInfos"].as_array().unwrap();
        let id = &targets.iter().find(|it| it["type"] == "page").unwrap()["targetId"];
        let attached = json!({ "targetId": id, "flatten": true });
        browser.session = browser.call("Target.attachToTarget", &attached)["sessionId"].clone();
        browser
    }

    /// Calls a method; returns its result.
    fn call(&mut self, method: &str, parameters: &Value) -> Value {
        self.calls += 1;
        let mut call = json!({ "id": self.calls, "method": method, "params": parameters });
        if !self.session.is_null() {
            call["sessionId"] = self.session.clone();
        }
        let (socket, calls) = (&mut self.socket, self.calls);
        let answered = async {
            socket.send(Message::text(call.to_string())).await.unwrap();
            loop {
                let message = socket.next().await.unwrap().unwrap();
                let answer: Value = serde_json::from_str(message.as_text().unwrap()).unwrap();
                if answer["id"] == calls {
                    return answer["result"].clone();
                }
            }
        };
        self.runtime.block_on(async { timeout(TIMEOUT, answered).await.unwrap() })
    }

    fn value(&mut self, expression: &str) -> Value {
        let parameters = json!({ "expression": expression, "returnByValue": true });
        self.call("Runtime.evaluate", &parameters)["result"]["value"].clone()
    }

    fn press(&mut self, key: &str, code: u32, text: &str) {
        for kind in ["keyDown", "keyUp"] {
            let key = json!({
                "type": kind, "key": key, "code": key, "windowsVirtualKeyCode": code, "text": text,
            });
            self.call("Input.dispatchKeyEvent", &key);
        }
    }

    fn wait_for(&mut self, what: &str, is_right: impl Fn(&mut Self) -> bool) {
        let browser = std::cell::RefCell::new(self);
        wait_until(what, || is_right(&mut browser.borrow_mut()));
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        _ = self.process.kill();
        _ = self.process.wait();
    }
}

/// The next message of the server, whose frames are not masked.
fn message(socket: &mut TcpStream) -> (u8, Vec<u8>) {
    let mut head = [0; 2];
    socket.read_exact(&mut head).unwrap();
    let mut length = u64::from(head[1]);
    if length == 126 {
        let mut bytes = [0; 2];
        socket.read_exact(&mut bytes).unwrap();
        length = u64::from(u16::from_be_bytes(bytes));
    }
    let mut bytes = vec![0; length as usize];
    socket.read_exact(&mut bytes).unwrap();
    (head[0] & 15, bytes)
}

/// The pixels of a room's picture, as a list of colours.
fn picture(port: u16, room: u32) -> Vec<u8> {
    first_picture(port, &format!("/rooms/{room}/live"))
}

/// The pixels of a record's picture at a second.
fn recorded_picture(port: u16, second: u32) -> Vec<u8> {
    first_picture(port, &format!("/records/room-1/play?from={second}"))
}

fn first_picture(port: u16, path: &str) -> Vec<u8> {
    let (mut socket, answer) = open_socket(port, path);
    assert!(answer.starts_with("HTTP/1.1 101"), "{answer}");
    let binary = 2;
    let message = std::iter::repeat_with(|| message(&mut socket)).find(|it| it.0 == binary);
    let mut bytes = Vec::new();
    DeflateDecoder::new(&*message.unwrap().1).read_to_end(&mut bytes).unwrap();
    assert_eq!(bytes[0], 0, "the first picture is a whole one");
    let [columns, rows] = PICTURE;
    let mut pixels = vec![0; 3 * columns * rows];
    // Two pixels make a cell, and other pictures may follow.
    let cells = &bytes[7..][..7 * columns * rows / 2];
    for (at, cell) in cells.chunks_exact(7).enumerate() {
        assert_eq!(cell[0], 0, "a cell with text");
        for (half, color) in cell[1..].chunks_exact(3).enumerate() {
            let pixel = (2 * (at / columns) + half) * columns + at % columns;
            pixels[3 * pixel..3 * pixel + 3].copy_from_slice(color);
        }
    }
    pixels
}

/// The log of a room in which a player plays `script`.
fn log_of(script: &str) -> String {
    let script = Script::parse(script, "the script").unwrap();
    let header = json!({
        "level": "clock", "mode": "Together", "difficulty": "Easy", "seed": [0, 0, 0, 0, 0, 0, 0, 0], "round": 1, "next_member": 2,
        "members": [{ "id": 1, "color": "Red", "points": 0, "name": "Mara", "kept": null }],
    });
    let mut log = format!("cellcaster-room 3 {header}\n");
    for (step, (_, intents)) in script.iter().enumerate() {
        _ = writeln!(log, "{step} want 1 {step} {}", intents.words());
    }
    log
}

#[test]
fn a_room_is_chosen_by_keyboard_and_shown_exactly() {
    let (running, [web, _]) = watched(&[]);
    let mara = running.visitor();
    enter_room(&mara, "Mara");
    let mut browser = Browser::open(&format!("http://127.0.0.1:{web}/"));
    browser.wait_for("the list shows Mara", |page| {
        let text = page.value("document.getElementById('rooms').innerText");
        text.as_str().is_some_and(|text| text.contains("1 of 16 players: Mara"))
    });
    // The style sheet is in force, so the policy allows it.
    let style = browser.value("getComputedStyle(document.body).backgroundColor");
    assert_eq!(style, "rgb(20, 22, 26)");
    browser.press("Tab", 9, "");
    browser.press("Enter", 13, "\r");
    browser.wait_for("the words name the player", |page| {
        let text = page.value("document.getElementById('words').innerText");
        text.as_str().is_some_and(|text| {
            text.contains("Roam in The Museum of Walls") && text.contains("what Mara sees")
        })
    });
    browser.wait_for("the canvas shows the picture", |page| {
        page.value(PIXELS) == json!(picture(web, 1))
    });
    let before = picture(web, 1);
    mara.send("b");
    wait_until("Mara has turned", || picture(web, 1) != before);
    browser.wait_for("the canvas shows the changes", |page| {
        page.value(PIXELS) == json!(picture(web, 1))
    });
    browser.press("Escape", 27, "");
    browser.wait_for("the picture is gone", |page| {
        page.value("document.getElementById('room').hidden && location.hash === ''") == json!(true)
    });
}

#[test]
fn a_record_is_played_by_keyboard_and_shown_exactly() {
    let (recordings, store) = (folder(), folder());
    drop(filled(&store));
    std::fs::create_dir_all(&recordings).unwrap();
    std::fs::write(recordings.join("room-900.log"), log_of(SCRIPT)).unwrap();
    let [recordings, store] = [recordings, store].map(|it| it.display().to_string());
    let (running, [web, _]) = watched(&["--record-room", &recordings, "--store", &store, "--web"]);
    let mara = running.visitor();
    enter_room(&mara, "Mara");
    mara.send("b");
    // The record is flushed each second.
    std::thread::sleep(std::time::Duration::from_secs(6));
    drop(mara);
    running.wait_for_visitors(0);
    let mut browser = Browser::open(&format!("http://127.0.0.1:{web}/"));
    let shows = |browser: &mut Browser, id: &str, text: &str| {
        browser.wait_for(text, |page| {
            let shown = page.value(&format!("document.getElementById('{id}').innerText"));
            shown.as_str().is_some_and(|shown| shown.contains(text))
        });
    };
    shows(&mut browser, "records", "Roam in The Museum of Walls");
    shows(&mut browser, "boards", "Cellar, normal");
    shows(&mut browser, "boards", "漢字");
    let is_chosen = "document.activeElement.hash === '#record-room-1'";
    while browser.value(is_chosen) != json!(true) {
        browser.press("Tab", 9, "");
    }
    browser.press("Enter", 13, "\r");
    shows(&mut browser, "words", "what Mara sees");
    shows(&mut browser, "play", "Pause");
    browser.press(" ", 32, " ");
    shows(&mut browser, "play", "Play");
    // Seeking works while the record is paused.
    let seeks = [("Home", 36, 0), ("ArrowRight", 39, 5), ("ArrowLeft", 37, 0)];
    for (key, code, second) in seeks {
        browser.press(key, code, "");
        shows(&mut browser, "clock", &format!("0:0{second} of"));
        let expected = json!(recorded_picture(web, second));
        browser.wait_for(&format!("second {second}"), |page| page.value(PIXELS) == expected);
    }
    let [first, later] = [0, 5].map(|second| recorded_picture(web, second));
    assert!(first != later, "Mara has turned");
    // The time line has the keys of a slider.
    browser.value("document.getElementById('place').focus()");
    browser.press("ArrowRight", 39, "");
    shows(&mut browser, "clock", "0:01 of");
    let spoken = browser.value("document.getElementById('place').getAttribute('aria-valuetext')");
    assert!(spoken.as_str().is_some_and(|it| it.starts_with("0:01 of 0:")), "{spoken}");
    browser.value("document.getElementById('stop').focus()");
    browser.press("End", 35, "");
    browser.value("document.getElementById('play').click()");
    shows(&mut browser, "play", "Pause");
    shows(&mut browser, "about", "The record has ended.");
    browser.press("Escape", 27, "");
    browser.wait_for("the picture is gone", |page| {
        page.value("document.getElementById('room').hidden && location.hash === ''") == json!(true)
    });
    assert_eq!(browser.value(is_chosen), json!(true), "the focus has left the list");
    // The marks of a record are seconds on its time line, and it plays faster.
    browser.value("location.hash = 'record-room-900'");
    let texts =
        "[...document.querySelectorAll('#marks span')].map((it) => it.textContent).join('')";
    browser.wait_for("marks", |page| page.value(texts).as_str().is_some_and(|it| !it.is_empty()));
    assert_eq!(
        browser.value("length > 1 && new Set(marks.map((it) => it[1])).size > 1"),
        json!(true)
    );
    browser.value("if (plays) setPlaying(false)");
    browser.press("Home", 36, "");
    browser.press("n", 78, "n");
    let next = "marks.find((it) => it[0] > 0)";
    browser.wait_for("the first mark", |page| {
        page.value(&format!("second === {next}[0]")) == json!(true)
    });
    let spoken = browser.value("document.getElementById('place').getAttribute('aria-valuetext')");
    let name = browser.value(&format!("{next}[2]"));
    assert!(spoken.as_str().unwrap().ends_with(name.as_str().unwrap()), "{spoken}, {name}");
    (0..4).for_each(|_| browser.press(">", 190, ">"));
    assert_eq!(browser.value("document.getElementById('speed').value"), json!("64"));
    browser.value("setPlaying(true)");
    shows(&mut browser, "about", "The record has ended.");
}
