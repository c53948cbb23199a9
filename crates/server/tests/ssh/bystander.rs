//! Bystanders who type while other visitors send as much as they are allowed to.
//!
//! Eight connections send one kind of traffic to a host, at the permitted rate. The bystanders type a letter
//! and delete it again on the name page, where only their own keys change the screen. A separate thread
//! measures the time from each key to the bytes that show it.
//!
//! On a busy machine, the limit is a multiple of the bystanders' times without traffic.

use std::future::pending;
use std::process::Command;
use std::sync::{Arc, OnceLock, mpsc};
use std::thread;
use std::time::Duration;

use russh::client::{self, AuthResult, Handle, Handler, Msg};
use russh::keys::{PrivateKeyWithHashAlg, PublicKeyOrCertificate, load_secret_key};
use russh::{
    Channel, ChannelMsg, ChannelReadHalf, ChannelWriteHalf, Error, Preferred, compression,
};
use tokio::runtime::{Builder, Runtime};
use tokio::sync::oneshot;
use tokio::task::JoinSet;
use tokio::time::{Instant, interval, sleep, timeout};

use super::alone;
use super::emulator::{Emulator, Speaks};
use super::host::Host;

const SENDERS: usize = 8;
const WINDOW: (u16, u16) = (80, 24);
/// Several bystanders produce enough keys for a percentile, although each types as slowly as a human.
const BYSTANDERS: usize = 6;
/// How long each kind of traffic is sent.
const TIME: Duration = Duration::from_millis(1900);
/// The pause between two keys of a bystander.
const PAUSE: Duration = Duration::from_millis(100);
/// How long nothing changes before the first key.
const REST: Duration = Duration::from_millis(400);
/// The limit for most kinds of traffic. Players notice longer delays.
const LIMIT: Duration = Duration::from_millis(100);
/// The limit while pictures of a large window are drawn.
const LIMIT_BESIDE_A_PICTURE: Duration = Duration::from_millis(20);
/// The limit on a busy machine, as a multiple of the time without traffic.
const FACTOR: u32 = 3;
const TIMEOUT: Duration = Duration::from_secs(20);
/// The bytes that a sender sends per tick. With packet framing, they add up to the 64 KB per second that
/// hosts permit.
const CHUNK: usize = 1000;
const TICK: Duration = Duration::from_millis(16);
/// The number of ticks whose bytes are sent at once at the start. Hosts permit a burst of four seconds.
const BURST: usize = 200;

/// A kind of traffic.
#[derive(Clone, Copy)]
enum Traffic {
    /// Repeats these bytes after following `way`: pairs of a text to wait for and the keys to type then.
    Typed {
        way: &'static [(&'static str, &'static str)],
        bytes: &'static str,
    },
    /// Text that compresses to almost nothing.
    Compressed,
    Resizes,
    /// Channel requests that are refused.
    Channels,
    /// Key exchanges.
    Rekeys,
    /// Offers of keys that are refused, before the login, on one connection after another.
    Offers,
    /// A held key that makes one session turn, in a window of the largest size.
    Turns,
}

impl Traffic {
    /// The texts to wait for and the keys to type before the traffic.
    fn way(self) -> &'static [(&'static str, &'static str)] {
        match self {
            Self::Typed { way, .. } => way,
            Self::Turns => TO_A_ROOM,
            _ => TO_THE_NAME,
        }
    }

    fn senders(self) -> usize {
        if let Self::Turns = self { 1 } else { SENDERS }
    }

    fn limit(self) -> Duration {
        if let Self::Turns = self { LIMIT_BESIDE_A_PICTURE } else { LIMIT }
    }

    fn window(self) -> (u16, u16) {
        if let Self::Turns = self { (500, 200) } else { WINDOW }
    }
}

const TO_THE_NAME: &[(&str, &str)] = &[("Enter saves it", "")];
const TO_THE_LOBBY: &[(&str, &str)] = &[("Enter saves it", "\r"), ("Open a room", "")];
const TO_SETTINGS: &[(&str, &str)] =
    &[("Enter saves it", "\r"), ("Open a room", "7"), ("Mouse turns", "")];
const TO_A_ROOM: &[(&str, &str)] =
    &[("Enter saves it", "\r"), ("Open a room", "\r"), ("Go in", "\r"), ("has joined.", "")];
const TO_THE_CHAT: &[(&str, &str)] = &[
    ("Enter saves it", "\r"),
    ("Open a room", "\r"),
    ("Go in", "\r"),
    ("has joined.", "\r"),
    ("say", ""),
];
const TO_A_ROOM_WITH_A_MOUSE: &[(&str, &str)] = &[
    ("Enter saves it", "\r"),
    ("Open a room", "7"),
    ("Mouse turns", "\x1b[B"),
    ("Mouse turns", "\x1b[B"),
    ("Mouse turns", "\r"),
    ("Mouse turns", "\x7f"),
    ("Open a room", "1"),
    ("Go in", "\r"),
    ("has joined.", ""),
];

/// Accepts any server key.
struct Anyone;

impl Handler for Anyone {
    type Error = Error;

    async fn check_server_key(&mut self, _: &PublicKeyOrCertificate) -> Result<bool, Error> {
        Ok(true)
    }
}

/// A client with a terminal.
struct Client {
    handle: Handle<Anyone>,
    channel: Channel<Msg>,
    emulator: Emulator,
}

impl Client {
    async fn connect(port: u16, compresses: bool, (columns, rows): (u16, u16)) -> Self {
        let mut handle = open(port, compresses).await.unwrap();
        while !handle.authenticate_none("guest").await.unwrap().success() {}
        let channel = handle.channel_open_session().await.unwrap();
        channel.set_env(false, "COLORTERM", "truecolor").await.unwrap();
        let [width, height] = [columns, rows].map(u32::from);
        channel.request_pty(false, "xterm-256color", width, height, 0, 0, &[]).await.unwrap();
        channel.request_shell(false).await.unwrap();
        Self { handle, channel, emulator: Emulator::new(columns, rows, Speaks::Kitty) }
    }

    async fn press(&mut self, keys: &str) {
        self.channel.data(keys.as_bytes()).await.unwrap();
    }

    /// Reads until the screen satisfies `is_so`.
    async fn wait_until(&mut self, what: &str, is_so: impl Fn(&str) -> bool) {
        let wait = async {
            while !is_so(&self.emulator.text()) {
                self.read().await;
            }
        };
        let has_come = timeout(TIMEOUT, wait).await.is_ok();
        assert!(has_come, "{what} does not come:\n{}", self.emulator.text());
    }

    /// Reads the next message and sends the terminal's replies to it.
    async fn read(&mut self) {
        let Some(message) = self.channel.wait().await else { panic!("the connection has ended") };
        if let ChannelMsg::Data { data } = message {
            let answers = self.emulator.process(&data);
            if !answers.is_empty() {
                self.channel.data(&answers[..]).await.unwrap();
            }
        }
    }

    async fn rest(&mut self, time: Duration) {
        _ = timeout(time, async {
            loop {
                self.read().await;
            }
        })
        .await;
    }
}

async fn open(port: u16, compresses: bool) -> Result<Handle<Anyone>, Error> {
    let mut config = client::Config { nodelay: true, ..client::Config::default() };
    if compresses {
        let compression = std::borrow::Cow::Borrowed(&[compression::ZLIB_LEGACY] as &[_]);
        config.preferred = Preferred { compression, ..Preferred::DEFAULT };
    }
    client::connect(Arc::new(config), ("127.0.0.1", port), Anyone).await
}

/// Sends traffic until the connection ends, which is an error.
async fn send(client: Client, traffic: Traffic) {
    let Client { handle, channel, .. } = client;
    let (mut input, output) = channel.split();
    let answers = answer_all(&mut input, &output);
    let sending = async {
        match traffic {
            Traffic::Typed { bytes, .. } => type_all(&output, bytes).await,
            Traffic::Compressed => flood(&output).await,
            Traffic::Resizes => resize(&output).await,
            Traffic::Channels => while handle.channel_open_session().await.is_err() {},
            Traffic::Rekeys => exchange_keys(&handle).await,
            Traffic::Turns => {
                _ = output.data(&b"\x1b[1;1:1C"[..]).await;
                pending::<()>().await;
            }
            Traffic::Offers => unreachable!("it needs no session"),
        }
    };
    tokio::select! {
        () = answers => {}
        () = sending => {}
    }
}

/// Replies to the queries at the ends of frames.
async fn answer_all(input: &mut ChannelReadHalf, output: &ChannelWriteHalf<Msg>) {
    let mut last = Vec::new();
    while let Some(message) = input.wait().await {
        let ChannelMsg::Data { data } = message else { continue };
        last.extend_from_slice(&data);
        let count = last.windows(4).filter(|it| it.starts_with(b"\x1b[c") || *it == b"\x1b[5n");
        let answers: Vec<u8> = count
            .flat_map(|query| if query[2] == b'c' { &b"\x1b[?62;22c"[..] } else { b"\x1b[0n" })
            .copied()
            .collect();
        last.drain(..last.len().saturating_sub(3));
        if !answers.is_empty() && output.data(&answers[..]).await.is_err() {
            return;
        }
    }
}

async fn type_all(output: &ChannelWriteHalf<Msg>, bytes: &str) {
    // The chunk contains only whole keys, so that each chunk begins with one.
    let chunk = bytes.repeat(CHUNK / bytes.len());
    let mut ticks = interval(TICK);
    for tick in 0.. {
        if tick > BURST {
            ticks.tick().await;
        }
        if output.data(chunk.as_bytes()).await.is_err() {
            return;
        }
    }
}

async fn flood(output: &ChannelWriteHalf<Msg>) {
    let text = vec![b'w'; 30_000];
    while output.data(&text[..]).await.is_ok() {}
}

async fn resize(output: &ChannelWriteHalf<Msg>) {
    /// A request is a packet of 68 bytes.
    const IN_A_TICK: u32 = 15;
    let mut ticks = interval(TICK);
    for tick in 0.. {
        ticks.tick().await;
        for change in 0..IN_A_TICK {
            let size = (tick * IN_A_TICK + change) % 40;
            if output.window_change(60 + size, 20 + size / 2, 0, 0).await.is_err() {
                return;
            }
        }
    }
}

async fn exchange_keys(handle: &Handle<Anyone>) {
    /// An exchange takes about two kilobytes from a client.
    const EXCHANGE: Duration = Duration::from_millis(30);
    while handle.rekey_soon().await.is_ok() {
        sleep(EXCHANGE).await;
    }
}

/// Offers a key that is refused, as often as the host allows per connection, on one connection after another.
async fn offer_keys(port: u16, key: PrivateKeyWithHashAlg) {
    loop {
        if let Ok(mut handle) = open(port, false).await {
            while let Ok(AuthResult::Failure { .. }) =
                handle.authenticate_publickey("ann", key.clone()).await
            {}
        }
        sleep(TICK).await;
    }
}

fn rsa_key() -> PrivateKeyWithHashAlg {
    let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("bystander-rsa");
    _ = std::fs::remove_file(&path);
    let arguments = ["-q", "-t", "rsa", "-b", "2048", "-N", "", "-f"];
    let status = Command::new("ssh-keygen").args(arguments).arg(&path).status();
    assert!(status.unwrap().success());
    PrivateKeyWithHashAlg::new(Arc::new(load_secret_key(path, None).unwrap()), None)
}

/// Prepares the senders and reports that they are ready. They send from the bystanders' first keys until `stop`.
async fn send_all(
    port: u16,
    traffic: Traffic,
    ready: mpsc::Sender<()>,
    stop: oneshot::Receiver<()>,
) {
    let mut senders = JoinSet::new();
    if let Traffic::Offers = traffic {
        let key = rsa_key();
        (0..SENDERS).for_each(|_| _ = senders.spawn(offer_keys(port, key.clone())));
        ready.send(()).unwrap();
    } else {
        let mut clients = Vec::new();
        for _ in 0..traffic.senders() {
            let compresses = matches!(traffic, Traffic::Compressed);
            let mut client = Client::connect(port, compresses, traffic.window()).await;
            for (text, keys) in traffic.way() {
                client.wait_until(text, |screen| screen.contains(text)).await;
                client.press(keys).await;
            }
            clients.push(client);
        }
        ready.send(()).unwrap();
        let begins = Instant::now() + 2 * REST;
        for mut client in clients {
            client.rest(begins - Instant::now()).await;
            senders.spawn(send(client, traffic));
        }
    }
    tokio::select! {
        ended = senders.join_next() => panic!("a sender was sent away: {ended:?}"),
        _ = stop => {}
    }
}

/// Types keys; returns the time from each key to the bytes that show it.
async fn type_beside(port: u16, begins: Instant) -> Vec<Duration> {
    let mut client = Client::connect(port, false, WINDOW).await;
    client.wait_until("the page", |screen| screen.contains("Enter saves it")).await;
    client.rest(begins - Instant::now()).await;
    let end = Instant::now() + TIME;
    let mut times = Vec::new();
    for (key, shown) in [("x", true), ("\x7f", false)].into_iter().cycle() {
        let pressed = Instant::now();
        client.press(key).await;
        client.wait_until("the letter", |screen| screen.contains("x_") == shown).await;
        times.push(pressed.elapsed());
        client.rest(PAUSE).await;
        if Instant::now() > end {
            break;
        }
    }
    times
}

/// The 99th percentile and the median of the times of all bystanders.
async fn measure(port: u16) -> [Duration; 2] {
    let mut bystanders = JoinSet::new();
    let begins = Instant::now() + REST;
    for number in 0..BYSTANDERS {
        let own_begin = begins + PAUSE * number as u32 / BYSTANDERS as u32;
        bystanders.spawn(type_beside(port, own_begin));
    }
    let mut times: Vec<Duration> = bystanders.join_all().await.concat();
    times.sort();
    assert!(times.len() > 50, "{} keys", times.len());
    [times.len() * 99 / 100, times.len() / 2].map(|index| times[index.min(times.len() - 1)])
}

fn runtime() -> Runtime {
    Builder::new_current_thread().enable_all().build().unwrap()
}

/// The 99th percentile without traffic.
fn quiet() -> Duration {
    static QUIET: OnceLock<Duration> = OnceLock::new();
    *QUIET.get_or_init(|| {
        let host = Host::start();
        let [p99, median] = runtime().block_on(measure(host.port()));
        eprintln!("without traffic: p99 {p99:?}, median {median:?}");
        p99
    })
}

#[track_caller]
fn delays_nobody(name: &str, traffic: Traffic) {
    let _alone = alone();
    let limit = traffic.limit().max(FACTOR * quiet());
    let host = Host::start();
    let port = host.port();
    let (ready, is_ready) = mpsc::channel();
    let (stop, stopped) = oneshot::channel();
    let senders =
        thread::spawn(move || runtime().block_on(send_all(port, traffic, ready, stopped)));
    // This fails only if the thread has panicked.
    let measured = is_ready.recv().map(|()| runtime().block_on(measure(port)));
    drop(stop);
    senders.join().unwrap();
    let [p99, median] = measured.unwrap();
    eprintln!("{name}: p99 {p99:?}, median {median:?}, limit {limit:?}");
    assert!(p99 <= limit, "{p99:?}, and the limit is {limit:?}");
}

#[test]
fn typed_names_delay_nobody() {
    let bytes = "ab\x7f\x7fe\u{301}\u{302}\u{303}\x7f";
    delays_nobody("name", Traffic::Typed { way: TO_THE_NAME, bytes });
}

#[test]
fn typed_chat_delays_nobody() {
    let bytes = "ab\x7f\x7fe\u{301}\u{302}\u{303}\x7f";
    delays_nobody("chat", Traffic::Typed { way: TO_THE_CHAT, bytes });
}

#[test]
fn keys_in_the_lobby_delay_nobody() {
    delays_nobody("lobby", Traffic::Typed { way: TO_THE_LOBBY, bytes: "\x1b[B\x1b[A6\x7f" });
}

#[test]
fn keys_in_settings_delay_nobody() {
    delays_nobody("settings", Traffic::Typed { way: TO_SETTINGS, bytes: "\x1b[C" });
}

#[test]
fn keys_in_a_room_delay_nobody() {
    delays_nobody("room", Traffic::Typed { way: TO_A_ROOM, bytes: "wsad\x1b[C\x1b[Dmp" });
}

#[test]
fn keys_with_releases_delay_nobody() {
    let bytes = "\x1b[119;1:1u\x1b[119;1:2u\x1b[119;1:3u";
    delays_nobody("releases", Traffic::Typed { way: TO_A_ROOM, bytes });
}

#[test]
fn mouse_input_delays_nobody() {
    let bytes = "\x1b[<35;10;10M\x1b[<35;60;20M\x1b[<0;1;1M\x1b[<0;1;1m";
    delays_nobody("mouse", Traffic::Typed { way: TO_A_ROOM_WITH_A_MOUSE, bytes });
}

#[test]
fn compressed_input_delays_nobody() {
    delays_nobody("compressed", Traffic::Compressed);
}

#[test]
fn resizes_delay_nobody() {
    delays_nobody("resizes", Traffic::Resizes);
}

#[test]
fn channel_requests_delay_nobody() {
    delays_nobody("channels", Traffic::Channels);
}

#[test]
fn key_exchanges_delay_nobody() {
    delays_nobody("rekeys", Traffic::Rekeys);
}

#[test]
fn key_offers_before_login_delay_nobody() {
    delays_nobody("offers", Traffic::Offers);
}

#[test]
fn full_size_pictures_delay_nobody() {
    delays_nobody("pictures", Traffic::Turns);
}
