//! The service over real sockets, with rooms in this process.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::Read;
use std::net::SocketAddr;

use flate2::read::DeflateDecoder;
use futures_util::{SinkExt, StreamExt};
use http::{HeaderName, HeaderValue};
use serde_json::Value;
use tokio::io::{AsyncRead, AsyncWrite, duplex};
use tokio::runtime::Builder;
use tokio::sync::oneshot;
use tokio::task::JoinHandle;
use tokio_websockets::{ClientBuilder, Message, WebSocketStream};

use super::picture::{COLUMNS, Cell, ROWS, draw};
use super::*;
use crate::accounts::{AccountId, AddressPrefix, LevelBoard, LevelScore, Name, UnixTime};
use crate::config::Config;
use crate::metrics::Metrics;
use crate::rooms::directory::{Place, Recordings, RoomLimits, Seeds};
use crate::rooms::replayed::{RoomRecord, replayed};
use crate::rooms::room::{CHAT_COLUMNS, Catalog, Command, Mode, NAME_COLUMNS};
use crate::rooms::summary::RoomRequest;
use crate::service::http::listen;
use cellcaster::app::parts::{MarkKind, Record};
use cellcaster::game::{Intent, Intents, Rank, Script, Tally};
use cellcaster::world::Difficulty;

/// Long enough for a machine under load.
const PATIENCE: Duration = Duration::from_secs(20);

/// A host with the service, whose first room is a standing one.
struct House {
    address: SocketAddr,
    rooms: Rooms,
    metrics: Arc<Metrics>,
    service: JoinHandle<()>,
}

fn wish(mode: Mode) -> RoomRequest {
    RoomRequest { level: "museum".to_owned(), mode, difficulty: Difficulty::default() }
}

fn name(text: &str) -> Line {
    Line::of(text, NAME_COLUMNS).unwrap()
}

impl House {
    fn open(change: impl FnOnce(&mut Config)) -> Self {
        let mut config = Config::default();
        change(&mut config);
        let metrics = Arc::<Metrics>::default();
        let load = Arc::new(Load::new(Arc::clone(&metrics)));
        let limits = RoomLimits {
            most: 8,
            most_watchers: 4,
            closes_after: Duration::ZERO,
            standing: vec![wish(Mode::Roam)],
        };
        let (catalog, seeds) = (Arc::new(Catalog::builtin()), Seeds { rooms: 7, codes: 8 });
        let recordings =
            Recordings::in_folder(config.recordings.clone(), config.recording_bounds());
        let rooms = Rooms::new(limits, catalog, recordings, Arc::clone(&load), seeds);
        let listener = listen("127.0.0.1:0".parse().unwrap()).unwrap();
        let address = listener.local_addr().unwrap();
        let boards = Box::new(|| {
            let (sender, answer) = oneshot::channel();
            sender.send(Some(made_up_boards())).unwrap();
            Some(answer)
        });
        let web = Web::new(LiveConfig::new(config), rooms.clone(), load, boards);
        let service = tokio::spawn(web.serve(listener));
        Self { address, rooms, metrics, service }
    }

    /// The answer to a request, up to the end of the connection.
    async fn answer(&self, request: &str) -> String {
        let mut socket = TcpStream::connect(self.address).await.unwrap();
        // The server may close the connection before it has read everything.
        _ = socket.write_all(request.as_bytes()).await;
        let mut answer = String::new();
        _ = timeout(PATIENCE, socket.read_to_string(&mut answer)).await.expect("an answer");
        answer
    }

    async fn get(&self, path: &str) -> String {
        self.answer(&format!("GET {path} HTTP/1.1\r\nHost: localhost\r\n\r\n")).await
    }

    /// The body of an answer, as JSON.
    async fn list(&self, path: &str) -> Value {
        let answer = self.get(path).await;
        serde_json::from_str(answer.split_once("\r\n\r\n").unwrap().1).unwrap()
    }

    /// Watches a room, with more headers; fails if the server does not switch protocols.
    async fn watch_with(
        &self,
        room: u32,
        headers: &[(&'static str, &str)],
    ) -> Option<WebSocketStream<TcpStream>> {
        self.open_socket(&format!("rooms/{room}/live"), headers).await
    }

    async fn open_socket(
        &self,
        path: &str,
        headers: &[(&'static str, &str)],
    ) -> Option<WebSocketStream<TcpStream>> {
        let socket = TcpStream::connect(self.address).await.unwrap();
        let uri = format!("ws://{}/{path}", self.address);
        let mut client = ClientBuilder::new().uri(&uri).unwrap();
        for (name, value) in headers {
            let value = HeaderValue::from_str(value).unwrap();
            client = client.add_header(HeaderName::from_static(name), value).unwrap();
        }
        timeout(PATIENCE, client.connect_on(socket)).await.unwrap().ok().map(|(it, _)| it)
    }

    async fn watch(&self, room: u32) -> Option<WebSocketStream<TcpStream>> {
        self.open_of_page(&format!("rooms/{room}/live")).await
    }

    /// Opens a WebSocket as the page does.
    async fn open_of_page(&self, path: &str) -> Option<WebSocketStream<TcpStream>> {
        self.open_socket(path, &[("origin", &format!("http://{}", self.address))]).await
    }

    /// Waits until this many browsers watch.
    async fn watchers(&self, count: i64) {
        let counted = async {
            while self.metrics.web_watchers.get() != count {
                sleep(Duration::from_millis(10)).await;
            }
        };
        timeout(PATIENCE, counted).await.expect("the number of watchers");
    }
}

fn made_up_boards() -> Vec<(LevelBoard, Vec<LevelScore>)> {
    let board = |level| LevelBoard::new(level, Difficulty::Normal).unwrap();
    let score = LevelScore {
        account: AccountId(1),
        name: Name::new("Mara").unwrap(),
        tally: Tally { steps: 61 * 60, ..Tally::default() },
        rank: Rank::ALL[0],
        verified_at: UnixTime::new(1),
    };
    // The host does not have the second level.
    vec![(board("cellar"), vec![score]), (board("moss-0123456789abcdef"), Vec::new())]
}

impl Drop for House {
    fn drop(&mut self) {
        self.service.abort();
    }
}

fn run(act: impl AsyncFnOnce()) {
    Builder::new_current_thread().enable_all().build().unwrap().block_on(act());
}

/// The contents of a browser's page.
#[derive(Default)]
struct Screen {
    step: u32,
    cells: Vec<Cell>,
    words: Value,
    /// The length and the marks of a record.
    facts: Value,
    /// The number of whole pictures, and of changes.
    pictures: [usize; 2],
}

impl Screen {
    /// Waits for the next message with pictures. Returns the steps and the cells of all pictures in it.
    async fn next<S: AsyncRead + AsyncWrite + Unpin>(
        &mut self,
        socket: &mut WebSocketStream<S>,
    ) -> Vec<(u32, Vec<Cell>)> {
        self.next_or_end(socket).await.expect("a picture")
    }

    /// Like [`next`](Self::next).
    ///
    /// # Errors
    /// The reason, if the server closes the connection.
    async fn next_or_end<S: AsyncRead + AsyncWrite + Unpin>(
        &mut self,
        socket: &mut WebSocketStream<S>,
    ) -> Result<Vec<(u32, Vec<Cell>)>, String> {
        loop {
            let message = timeout(PATIENCE, socket.next()).await.expect("a message");
            let message = message.unwrap().unwrap();
            if let Some((_, reason)) = message.as_close() {
                return Err(reason.to_owned());
            } else if let Some(text) = message.as_text() {
                let value: Value = serde_json::from_str(text).unwrap();
                let is_facts = value.get("seconds").is_some();
                *(if is_facts { &mut self.facts } else { &mut self.words }) = value;
            } else if message.is_binary() {
                return Ok(self.show(message.as_payload()));
            }
        }
    }

    fn show(&mut self, message: &[u8]) -> Vec<(u32, Vec<Cell>)> {
        let mut bytes = Vec::new();
        DeflateDecoder::new(message).read_to_end(&mut bytes).unwrap();
        let mut rest = &bytes[..];
        let mut shown = Vec::new();
        while !rest.is_empty() {
            let kind = rest[0];
            self.pictures[usize::from(kind)] += 1;
            self.step = u32::from_be_bytes(rest[1..5].try_into().unwrap());
            rest = &rest[5..];
            if kind == 0 {
                assert_eq!(rest[..2], [COLUMNS as u8, ROWS as u8]);
                rest = &rest[2..];
                let cells = COLUMNS * ROWS;
                self.cells = (0..cells).map(|_| take_cell(&mut rest)).collect();
            } else {
                for _ in 0..take_number(&mut rest) {
                    let (first, count) = (take_number(&mut rest), take_number(&mut rest));
                    for cell in &mut self.cells[first..first + count] {
                        *cell = take_cell(&mut rest);
                    }
                }
            }
            shown.push((self.step, self.cells.clone()));
        }
        shown
    }

    /// The text cells of the last row.
    fn caption(&self) -> String {
        let last = &self.cells[usize::from(COLUMNS * (ROWS - 1))..];
        let text = last.iter().filter_map(|cell| match cell {
            Cell::Text(character, _) => Some(*character),
            Cell::Halves(_) => None,
        });
        text.collect()
    }
}

fn take_number(bytes: &mut &[u8]) -> usize {
    let (number, rest) = bytes.split_first_chunk().unwrap();
    *bytes = rest;
    u16::from_be_bytes(*number).into()
}

fn take_cell(bytes: &mut &[u8]) -> Cell {
    let (head, rest) = bytes.split_at(1 + usize::from(bytes[0]));
    let (colors, rest) = rest.split_at(6);
    *bytes = rest;
    let colors = [[colors[0], colors[1], colors[2]], [colors[3], colors[4], colors[5]]];
    let character = str::from_utf8(&head[1..]).unwrap().chars().next();
    character.map_or(Cell::Halves(colors), |character| Cell::Text(character, colors))
}

/// Lets a member turn until told otherwise.
fn turn(place: &Place, turns: bool) {
    let mut intents = Intents::new();
    if turns {
        intents.insert(Intent::TurnLeft);
    }
    place.act(Command::Intents { seen: 0, intents });
}

#[test]
fn the_page_and_the_list_are_served_and_everything_else_is_rejected() {
    run(async || {
        let house = House::open(|config| config.name = "Mara's cellar".to_owned());
        let page = house.get("/").await;
        let (head, body) = page.split_once("\r\n\r\n").unwrap();
        assert!(head.starts_with("HTTP/1.1 200 OK\r\n"), "{head}");
        let (_, policy) = head.split_once("Content-Security-Policy: default-src 'none';").unwrap();
        let (_, nonce) = policy.split_once("script-src 'nonce-").unwrap();
        assert!(body.contains(&format!("<script nonce=\"{}\">", &nonce[..16])), "{head}");
        assert!(!body.contains("://") && !body.contains(NONCE), "the page needs another host");
        let _ada = house.rooms.enter(RoomId(1), &name("Ada")).unwrap();
        let _ben = house.rooms.open(&wish(Mode::Tag), true, &name("Ben")).unwrap();
        let listed = async {
            loop {
                let list = house.list("/rooms").await;
                if list["rooms"][0]["players"][0] == "Ada" {
                    return list;
                }
            }
        };
        let list = timeout(PATIENCE, listed).await.unwrap();
        assert_eq!(list["name"], "Mara's cellar");
        assert_eq!(
            list["rooms"].as_array().unwrap().len(),
            1,
            "the private room is listed: {list}"
        );
        assert_eq!(list["rooms"][0]["mode"], "Roam");
        for (request, status) in [
            ("GET /other HTTP/1.1\r\n\r\n", "404"),
            ("GET /records/../room-1.cast HTTP/1.1\r\n\r\n", "404"),
            ("GET /records/room-1/play?from=-1 HTTP/1.1\r\n\r\n", "404"),
            ("GET /records/room-1/play?quarters=0 HTTP/1.1\r\n\r\n", "404"),
            ("GET /records/room-1/play?from=2&quarters=65 HTTP/1.1\r\n\r\n", "404"),
            ("GET /rooms/1/live HTTP/1.1\r\nHost: a\r\n\r\n", "426"),
            ("GET /rooms/x/live HTTP/1.1\r\nHost: a\r\n\r\n", "404"),
            ("POST / HTTP/1.1\r\nContent-Length: 3\r\n\r\nabc", "405"),
            ("\x16\x03\x01\r\n\r\n", "400"),
            (&format!("GET / HTTP/1.1\r\nX: {}", "x".repeat(9000)), "400"),
        ] {
            let answer = house.answer(request).await;
            assert!(answer.starts_with(&format!("HTTP/1.1 {status} ")), "{request}: {answer}");
        }
    });
}

#[test]
fn a_live_picture_equals_the_snapshot_of_its_step() {
    run(async || {
        let house = House::open(|_| ());
        let mut ada = house.rooms.enter(RoomId(1), &name("Ada")).unwrap();
        turn(&ada, true);
        let mut views = BTreeMap::new();
        let mut socket = house.watch(1).await.unwrap();
        let mut screen = Screen::default();
        let mut compared = 0;
        let compare = async {
            while compared < 8 {
                tokio::select! {
                    () = ada.changed(Instant::now()) => {
                        let view = ada.view().unwrap();
                        views.insert(view.step as u32, view);
                    }
                    pictures = screen.next(&mut socket) => for (step, cells) in pictures {
                        let Some(view) = views.get(&step) else { continue };
                        let drawn = draw(view, house.rooms.catalog());
                        assert!(cells == drawn, "step {step} differs");
                        compared += 1;
                    }
                }
            }
        };
        timeout(PATIENCE, compare).await.unwrap();
        assert_eq!(screen.pictures[0], 1, "a browser that reads gets changes only");
        assert_eq!(screen.words["seen"], "Ada");
        assert_eq!(screen.words["mode"], "Roam");
        assert_eq!(screen.words["players"][0]["name"], "Ada");
    });
}

#[test]
fn lobbies_know_how_many_browsers_watch() {
    run(async || {
        let house = House::open(|_| ());
        let mut summaries = house.rooms.summaries();
        let mut sockets = Vec::new();
        for path in ["rooms/1/live", "rooms/1/live", "rooms/1/stream"] {
            sockets.push(house.open_of_page(path).await.unwrap());
        }
        for count in [3, 0] {
            let counted = summaries.wait_for(|rooms| rooms[0].browsers == count);
            timeout(PATIENCE, counted).await.unwrap().unwrap();
            sockets.clear();
        }
    });
}

#[test]
fn a_room_is_drawn_once_for_all_watchers_and_not_at_all_for_none() {
    run(async || {
        let house = House::open(|_| ());
        let ada = house.rooms.enter(RoomId(1), &name("Ada")).unwrap();
        turn(&ada, true);
        let mut bytes = Vec::new();
        for count in [1, 8] {
            let mut sockets = Vec::new();
            for _ in 0..count {
                sockets.push(house.watch(1).await.unwrap());
            }
            house.watchers(count).await;
            let reads = sockets.iter_mut().map(|socket| async {
                let mut screen = Screen::default();
                let end = Instant::now() + Duration::from_secs(2);
                while Instant::now() < end {
                    screen.next(socket).await;
                }
                screen.cells
            });
            let begun = Instant::now();
            let before = [house.metrics.web_pictures.get(), house.metrics.web_bytes.get()];
            let shown = futures_util::future::join_all(reads).await;
            let after = [house.metrics.web_pictures.get(), house.metrics.web_bytes.get()];
            assert_eq!(shown.len() as i64, count);
            let (pictures, most) =
                (after[0] - before[0], begun.elapsed().as_secs_f64() * 10.0 + 2.0);
            assert!(pictures as f64 <= most, "{pictures} pictures for {count} watchers");
            bytes.push(after[1] - before[1]);
            drop(sockets);
            house.watchers(0).await;
        }
        assert!(bytes[1] > 4 * bytes[0], "each of eight watchers gets the pictures: {bytes:?}");
        // The task of the room ends within a picture's time.
        sleep(Duration::from_millis(700)).await;
        let drawn = house.metrics.web_pictures.get();
        sleep(Duration::from_millis(500)).await;
        assert_eq!(house.metrics.web_pictures.get(), drawn);
    });
}

#[test]
fn a_browser_that_sends_data_is_disconnected() {
    run(async || {
        let house = House::open(|_| ());
        let _ada = house.rooms.enter(RoomId(1), &name("Ada")).unwrap();
        for data in [Message::text("w"), Message::binary(vec![1]), Message::binary(vec![1; 5000])] {
            let mut socket = house.watch(1).await.unwrap();
            house.watchers(1).await;
            socket.send(data).await.unwrap();
            house.watchers(0).await;
        }
        let mut socket = house.watch(1).await.unwrap();
        // A few pings are answered, but not many.
        socket.send(Message::ping("a")).await.unwrap();
        let answered = async { while !socket.next().await.unwrap().unwrap().is_pong() {} };
        timeout(PATIENCE, answered).await.unwrap();
        for _ in 0..50 {
            _ = socket.send(Message::ping("a")).await;
        }
        house.watchers(0).await;
    });
}

#[test]
fn a_browser_that_does_not_read_costs_one_picture() {
    run(async || {
        let house = House::open(|_| ());
        let ada = house.rooms.enter(RoomId(1), &name("Ada")).unwrap();
        turn(&ada, true);
        let live = Arc::new(LiveRooms::new(house.rooms.clone(), load(&house)));
        let mut pictures = live.watch(RoomId(1), Form::Cells).unwrap();
        // The link holds a few bytes, so everything else waits in the service.
        let (near, far) = duplex(64);
        let metrics = Arc::clone(&house.metrics);
        let watched = tokio::spawn(async move {
            watch(ServerBuilder::new().serve(near), &mut pictures, &metrics).await;
        });
        let drawn = async {
            while house.metrics.web_pictures.get() < 12 {
                sleep(Duration::from_millis(20)).await;
            }
        };
        timeout(PATIENCE, drawn).await.unwrap();
        turn(&ada, false);
        sleep(Duration::from_millis(500)).await;
        // The browser reads again. It gets the message that was on its way, and then the newest picture.
        let mut socket = ClientBuilder::new().take_over(far);
        let mut screen = Screen::default();
        let newest = async {
            loop {
                screen.next(&mut socket).await;
                let view = house.rooms.view(RoomId(1)).unwrap();
                if screen.cells == draw(&view, house.rooms.catalog()) {
                    return;
                }
            }
        };
        timeout(PATIENCE, newest).await.unwrap();
        assert_eq!(screen.pictures[0], 2, "{:?}", screen.pictures);
        assert!(screen.pictures[1] <= 5, "{:?}", screen.pictures);
        watched.abort();
    });
}

fn load(house: &House) -> Arc<Load> {
    Arc::new(Load::new(Arc::clone(&house.metrics)))
}

#[test]
fn other_origins_and_private_rooms_are_rejected() {
    run(async || {
        let house = House::open(|_| ());
        let _ben = house.rooms.open(&wish(Mode::Tag), true, &name("Ben")).unwrap();
        let _cid = house.rooms.open(&wish(Mode::Alone), false, &name("Cid")).unwrap();
        assert!(house.watch(1).await.is_some());
        for room in [2, 3, 99] {
            assert!(house.watch(room).await.is_none(), "room {room}");
        }
        assert!(house.watch_with(1, &[("origin", "https://evil.example.org")]).await.is_none());
        assert!(house.watch_with(1, &[]).await.is_none());
    });
}

#[test]
fn watchers_are_limited_in_total_and_by_address() {
    run(async || {
        let house = House::open(|config| {
            config.web_watchers = 5;
            config.web_watchers_per_address = 2;
            config.web_proxies = vec![AddressPrefix::parse("127.0.0.0/8").unwrap()];
        });
        let origin = format!("http://{}", house.address);
        let watch = |from: &'static str| {
            let headers = [("origin", origin.as_str()), ("x-forwarded-for", from)];
            let house = &house;
            async move { house.watch_with(1, &headers).await }
        };
        let first = watch("192.0.2.7").await;
        // Only the last address that is not a proxy's counts; the client may have invented those before it.
        let second = watch("198.51.100.1, 192.0.2.7, 127.0.0.3").await;
        assert!(first.is_some() && second.is_some());
        assert!(watch("192.0.2.7").await.is_none());
        let others = [watch("2001:db8::1").await, watch("2001:db8::2").await];
        assert!(others.iter().all(Option::is_some));
        assert!(watch("2001:db8::3").await.is_none(), "a /64 counts as one address");
        let fifth = watch("192.0.2.9").await;
        assert!(fifth.is_some());
        assert!(watch("192.0.2.10").await.is_none(), "the total");
        drop(first);
        house.watchers(4).await;
        assert!(watch("192.0.2.7").await.is_some());
    });
}

#[test]
fn nobody_but_a_proxy_names_an_address() {
    run(async || {
        let house = House::open(|config| {
            config.web_watchers_per_address = 1;
            // The proxies of SSH are not those of browsers.
            config.proxies = vec![AddressPrefix::parse("127.0.0.0/8").unwrap()];
        });
        let origin = format!("http://{}", house.address);
        let headers = |from| -> [(&'static str, &str); 2] {
            [("origin", &origin), ("x-forwarded-for", from)]
        };
        let first = house.watch_with(1, &headers("192.0.2.7")).await;
        assert!(first.is_some());
        assert!(house.watch_with(1, &headers("192.0.2.8")).await.is_none());
    });
}

#[test]
fn silent_connections_do_not_lock_others_out() {
    run(async || {
        let house = House::open(|_| ());
        let mut silent = Vec::new();
        for _ in 0..2 * MAX_REQUESTS {
            silent.push(TcpStream::connect(house.address).await.unwrap());
        }
        assert!(house.get("/rooms").await.contains("\"mode\":\"Roam\""));
        let mut first = silent.remove(0);
        let closed = timeout(PATIENCE, first.read_u8()).await.unwrap();
        assert!(closed.is_err(), "the oldest connection made room");
    });
}

#[test]
fn a_room_without_players_is_shown_with_a_caption_and_a_closed_room_says_so() {
    run(async || {
        let house = House::open(|_| ());
        let mut socket = house.watch(1).await.unwrap();
        let mut screen = Screen::default();
        screen.next(&mut socket).await;
        assert_eq!(screen.caption(), "nobodyiswalking");
        assert_eq!(screen.words["seen"], Value::Null);
        house.rooms.close(RoomId(1), "The room is closed.");
        let closed = async {
            loop {
                let message = socket.next().await.unwrap().unwrap();
                if let Some((_, reason)) = message.as_close() {
                    return reason.to_owned();
                }
            }
        };
        assert_eq!(timeout(PATIENCE, closed).await.unwrap(), "The room has closed.");
    });
}

/// A folder that is removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let name = format!("cellcaster-web-{}-{name}", std::process::id());
        Self(std::env::temp_dir().join(name))
    }

    /// A host that records its rooms into this folder.
    fn house(&self, change: impl FnOnce(&mut Config)) -> House {
        House::open(|config| {
            config.recordings = Some(self.0.clone());
            change(config);
        })
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        _ = fs::remove_dir_all(&self.0);
    }
}

/// Lets Ada talk, turn around for a while, and leave.
async fn play(house: &House) {
    let ada = house.rooms.enter(RoomId(1), &name("Ada")).unwrap();
    ada.act(Command::Say(Line::of("a secret", CHAT_COLUMNS).unwrap()));
    turn(&ada, true);
    sleep(Duration::from_millis(2600)).await;
    drop(ada);
    let left = async {
        while house.rooms.view(RoomId(1)).is_none_or(|room| !room.members.is_empty()) {
            sleep(Duration::from_millis(10)).await;
        }
        // The recording is flushed after the last step.
        sleep(Duration::from_millis(100)).await;
    };
    timeout(PATIENCE, left).await.unwrap();
}

#[test]
fn a_record_is_shown_from_any_second_exactly_as_it_was() {
    run(async || {
        let folder = Folder::new("record");
        let house = folder.house(|_| ());
        play(&house).await;
        let list = house.list("/records").await;
        assert_eq!((&list[0]["name"], &list[0]["mode"]), (&json!("room-1"), &json!("Roam")));
        let log = fs::read_to_string(folder.0.join("room-1.log")).unwrap();
        let catalog = house.rooms.catalog();
        let mut drawn = Vec::new();
        let look = &mut |room: &crate::rooms::room::Room| {
            drawn.push(draw(&room.view(), catalog));
            Ok(())
        };
        replayed(&log, catalog, look).unwrap();
        assert!(drawn.len() > 120, "{} steps", drawn.len());
        // The first browser draws the record; the second one shares its pieces.
        let mut counts = Vec::new();
        for from in [1, 0, 0, 9999] {
            let path = format!("records/room-1/play?from={from}");
            let mut socket = house.open_of_page(&path).await.unwrap();
            let mut screen = Screen::default();
            let mut steps = Vec::new();
            let reason = loop {
                match screen.next_or_end(&mut socket).await {
                    Ok(pictures) => {
                        for (step, cells) in pictures {
                            let is_same = drawn.get(step as usize).is_none_or(|it| *it == cells);
                            assert!(is_same, "step {step} differs");
                            steps.push(step);
                        }
                    }
                    Err(reason) => break reason,
                }
            };
            assert_eq!(reason, "The record has ended.");
            let last = (drawn.len() as u32).div_ceil(60) - 1;
            assert_eq!(steps[0], from.min(last) * 60);
            assert!(steps.last().unwrap() + 6 > last * 60, "{steps:?}");
            assert_eq!(screen.words["players"][0]["name"], "Ada");
            counts.push(house.metrics.web_pictures.get());
        }
        assert!(counts[1] > counts[0] && counts[1] == counts[2], "{counts:?}");
    });
}

#[test]
fn the_marks_of_a_record_are_the_events_that_happened() {
    run(async || {
        let folder = Folder::new("marks");
        let house = folder.house(|_| ());
        let catalog = house.rooms.catalog();
        let script = include_str!(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../maps/scripts/clock.easy.script"
        ));
        let script = Script::parse(script, "the script").unwrap();
        let record = RoomRecord::of_script(&script, name("Ada"), catalog).unwrap();
        let log = record.log().replace("mode alone", "mode together");
        fs::write(folder.0.join("room-1.log"), &log).unwrap();
        let (mut steps, mut before) = (0, None);
        let mut expected = BTreeSet::new();
        replayed(&log, catalog, &mut |room| {
            let events = record.events(room);
            let happened =
                MarkKind::ALL.into_iter().zip(before.unwrap_or(events).into_iter().zip(events));
            let happened = happened.filter(|(_, (before, now))| now > before);
            expected.extend(happened.map(|(kind, _)| ((steps - 1) / 60, kind.name().0.to_owned())));
            (steps, before) = (steps + 1, Some(events));
            Ok(())
        })
        .unwrap();
        // Nothing looks at the room after the last step, which wins the level.
        expected.insert(((steps - 1) / 60, MarkKind::End.name().0.to_owned()));
        assert!(expected.len() > 1, "{expected:?}");
        let mut socket = house.open_of_page("records/room-1/play?quarters=64").await.unwrap();
        let mut screen = Screen::default();
        screen.next(&mut socket).await;
        let marks = screen.facts["marks"].as_array().unwrap().iter();
        let marks = marks.map(|it| (it[0].as_u64().unwrap(), it[2].as_str().unwrap().to_owned()));
        // A mark that follows another one of its kind within a second is left out.
        let marks: BTreeSet<_> = marks.collect();
        assert!(marks.is_subset(&expected), "{marks:?}, {expected:?}");
        let is_near = |(second, kind): &(u64, String)| {
            [*second, second.saturating_sub(1)]
                .iter()
                .any(|it| marks.contains(&(*it, kind.clone())))
        };
        assert!(expected.iter().all(is_near), "{marks:?}, {expected:?}");
    });
}

#[test]
fn private_records_and_other_sites_are_rejected() {
    run(async || {
        let folder = Folder::new("private");
        let house = folder.house(|_| ());
        let ben = house.rooms.open(&wish(Mode::Tag), true, &name("Ben")).unwrap();
        let cid = house.rooms.open(&wish(Mode::Alone), false, &name("Cid")).unwrap();
        sleep(Duration::from_millis(1500)).await;
        drop((ben, cid));
        play(&house).await;
        assert_eq!(house.list("/records").await.as_array().unwrap().len(), 1);
        let names = fs::read_dir(&folder.0).unwrap().map(|it| it.unwrap().file_name());
        let names: BTreeSet<_> = names.map(|it| it.into_string().unwrap()).collect();
        assert!(names.contains("private-2.log") && names.contains("private-3.log"), "{names:?}");
        for name in ["private-2", "private-3", "room-2", "room-9"] {
            let play = house.open_of_page(&format!("records/{name}/play")).await;
            assert!(play.is_none(), "{name}");
            let cast = house.get(&format!("/records/{name}.cast")).await;
            assert!(cast.starts_with("HTTP/1.1 404 "), "{name}: {cast}");
        }
        let headers = [("origin", "https://evil.example.org")];
        for path in ["records/room-1/play", "rooms/1/stream"] {
            assert!(house.open_socket(path, &headers).await.is_none(), "{path}");
            assert!(house.open_of_page(path).await.is_some(), "{path}");
        }
    });
}

#[test]
fn a_cast_is_loaded_without_chat_and_counts_as_a_watcher() {
    run(async || {
        let folder = Folder::new("cast");
        let house = folder.house(|config| config.web_watchers_per_address = 1);
        play(&house).await;
        let cast = house.get("/records/room-1.cast").await;
        let (head, cast) = cast.split_once("\r\n\r\n").unwrap();
        assert!(head.contains("application/x-asciicast"), "{head}");
        assert_eq!(cast, fs::read_to_string(folder.0.join("room-1.cast")).unwrap());
        assert!(cast.contains("Ada") && !cast.contains("secret"), "{cast}");
        assert!(cast.lines().nth(1).unwrap().contains("\\u001b[?25l"), "the cursor is shown");
        let _watcher = house.watch(1).await.unwrap();
        let refusal = house.get("/records/room-1.cast").await;
        assert!(refusal.starts_with("HTTP/1.1 503 "), "{refusal}");
    });
}

#[test]
fn few_records_are_open_at_a_time() {
    run(async || {
        let folder = Folder::new("open");
        let house = folder.house(|_| ());
        play(&house).await;
        for copy in 2..=5 {
            fs::copy(folder.0.join("room-1.log"), folder.0.join(format!("room-{copy}.log")))
                .unwrap();
        }
        let mut sockets = Vec::new();
        for record in 1..=4 {
            let path = format!("records/room-{record}/play");
            sockets.push(house.open_of_page(&path).await.unwrap());
        }
        assert!(house.open_of_page("records/room-5/play").await.is_none());
        assert!(house.open_of_page("records/room-1/play").await.is_some());
        sockets.remove(0);
        let opened = async {
            while house.open_of_page("records/room-5/play").await.is_none() {
                sleep(Duration::from_millis(20)).await;
            }
        };
        timeout(PATIENCE, opened).await.unwrap();
    });
}

#[test]
fn boards_are_shown_as_json_and_as_text() {
    run(async || {
        let house = House::open(|_| ());
        let boards = house.list("/boards").await;
        assert_eq!(boards.as_array().unwrap().len(), 1);
        let (level, entry) = (&boards[0]["level"], &boards[0]["entries"][0]);
        assert_eq!((level, &entry["name"]), (&json!("Cellar"), &json!("Mara")));
        let text = house.get("/boards.txt").await;
        for part in ["Cellar, normal", "1  Mara", entry["time"].as_str().unwrap()] {
            assert!(text.contains(part), "{text}");
        }
    });
}

/// The screen of asciinema's player, by its own emulator.
struct Player {
    terminal: Option<avt::Terminal>,
    messages: usize,
}

impl Player {
    async fn next(&mut self, socket: &mut WebSocketStream<TcpStream>) {
        let message = timeout(PATIENCE, socket.next()).await.unwrap().unwrap().unwrap();
        let mut bytes = message.as_payload().to_vec();
        self.messages += 1;
        if self.messages == 1 {
            assert_eq!(bytes, b"ALiS\x01");
            return;
        }
        let kind = bytes.remove(0);
        let mut rest = &bytes[..];
        let mut number = || {
            let end = rest.iter().position(|byte| *byte < 128).unwrap();
            let (bytes, others) = rest.split_at(end + 1);
            rest = others;
            bytes.iter().rev().fold(0, |sum, byte| sum << 7 | usize::from(byte & 127))
        };
        let (_, _) = (number(), number());
        if kind == 1 {
            let size = [number(), number()];
            assert_eq!((size, number()), ([80, 24], 0));
            self.terminal = Some(avt::Terminal::new(80, 24).unwrap());
        } else {
            assert_eq!(kind, b'o');
        }
        let length = number();
        assert_eq!(length, rest.len());
        self.terminal.as_mut().unwrap().feed(str::from_utf8(rest).unwrap());
    }

    /// The rows of characters with their colours.
    fn screen(&self) -> Vec<String> {
        let terminal = self.terminal.as_ref().unwrap();
        assert_eq!(terminal.cursor().position(), None, "the cursor is shown");
        terminal.screen().visible_lines().map(|line| format!("{:?}", line.cells())).collect()
    }
}

#[test]
fn a_player_who_comes_late_sees_the_same_stream() {
    run(async || {
        let house = House::open(|_| ());
        let ada = house.rooms.enter(RoomId(1), &name("Ada")).unwrap();
        ada.act(Command::Say(Line::of("a secret", CHAT_COLUMNS).unwrap()));
        turn(&ada, true);
        let offers = "v1.alis, v2.asciicast, raw";
        let origin = format!("http://{}", house.address);
        let headers = [("origin", origin.as_str()), ("sec-websocket-protocol", offers)];
        let mut players = Vec::new();
        let screens = async {
            for _ in 0..3 {
                let socket = house.open_socket("rooms/1/stream", &headers).await.unwrap();
                players.push((Player { terminal: None, messages: 0 }, socket));
                for (player, socket) in &mut players {
                    for _ in 0..4 {
                        player.next(socket).await;
                    }
                }
            }
            let mut intents = Intents::new();
            intents.insert(Intent::Forward);
            ada.act(Command::Intents { seen: 0, intents });
            sleep(Duration::from_millis(600)).await;
            // A room without members takes no steps.
            drop(ada);
            loop {
                for (player, socket) in &mut players {
                    while timeout(Duration::from_millis(300), player.next(socket)).await.is_ok() {}
                }
                let screens: BTreeSet<_> = players.iter().map(|it| it.0.screen()).collect();
                if screens.len() == 1 {
                    let terminal = players[0].0.terminal.as_ref().unwrap();
                    return terminal.screen().text().join("\n");
                }
            }
        };
        let text = timeout(PATIENCE, screens).await.expect("the same screens");
        assert!(text.contains("Roam in") && !text.contains("secret"), "{text}");
    });
}
