//! One client: a terminal that answers queries, and a player who walks.

use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use cellcaster::rng::SplitMix64;
use russh::client::{self, Handle, Handler, Msg};
use russh::keys::PublicKeyOrCertificate;
use russh::{Channel, ChannelMsg, Error};
use tokio::time::{Instant, sleep_until};

use super::lamp::Lamp;
use super::report::Tally;

/// Accepts every server key.
pub(crate) struct Anyone;

impl Handler for Anyone {
    type Error = Error;

    async fn check_server_key(&mut self, _: &PublicKeyOrCertificate) -> Result<bool, Error> {
        Ok(true)
    }
}

/// Queries, and the answers of a terminal with true colours.
const ANSWERS: [(&[u8], &[u8]); 5] = [
    (FRAME_END, b""),
    (b"\x1b[5n", b"\x1b[0n"),
    (b"\x1b[c", b"\x1b[?62;22c"),
    (b"\x1b[6n", b"\x1b[1;1R"),
    (b"\x1b[?u", b""),
];
/// The end of each frame.
const FRAME_END: &[u8] = b"\x1b[?2026l";
/// The interval at which the keyboard repeats a held key.
const REPEAT: Duration = Duration::from_millis(33);
/// The key that lights the lamp, or puts it out.
const LAMP: &[u8] = b"l";
/// The pause between two keys that are timed, in seconds.
const TIMED_PAUSE: (f64, f64) = (0.5, 1.5);
/// The time between two presses of Enter on the way to a room.
const ENTER: Duration = Duration::from_millis(900);
/// The title of the map panel, which only a room shows.
const IN_ROOM: &[u8] = b"map";

/// Plays until the measurement has ended.
pub(crate) async fn play(
    address: SocketAddr,
    number: u64,
    delay: Duration,
    counts: &AtomicBool,
) -> Result<Tally, Error> {
    let (_handle, channel) = connect(address, number).await?;
    let mut client = Client {
        channel,
        chance: SplitMix64::new(number),
        tally: Tally::default(),
        unread: Vec::new(),
        lamp: Lamp::default(),
        next_timed: Instant::now(),
        key: b"w",
        key_until: Instant::now(),
        next_key: Instant::now() + ENTER,
        delay,
        answers: Vec::new(),
        answer_at: Instant::now(),
    };
    client.play(counts).await?;
    Ok(client.tally)
}

/// Connects as the guest with this number.
pub(crate) async fn connect(
    address: SocketAddr,
    number: u64,
) -> Result<(Handle<Anyone>, Channel<Msg>), Error> {
    let config = client::Config { nodelay: true, ..client::Config::default() };
    let mut handle = client::connect(Arc::new(config), address, Anyone).await?;
    let user = format!("load{number}");
    while !handle.authenticate_none(&user).await?.success() {}
    let channel = handle.channel_open_session().await?;
    channel.set_env(false, "COLORTERM", "truecolor").await?;
    channel.request_pty(false, "xterm-256color", 80, 24, 0, 0, &[]).await?;
    channel.request_shell(false).await?;
    Ok((handle, channel))
}

struct Client {
    channel: Channel<Msg>,
    chance: SplitMix64,
    tally: Tally,
    /// Bytes in which a query may begin.
    unread: Vec<u8>,
    lamp: Lamp,
    next_timed: Instant,
    key: &'static [u8],
    key_until: Instant,
    next_key: Instant,
    delay: Duration,
    answers: Vec<u8>,
    answer_at: Instant,
}

impl Client {
    async fn play(&mut self, counts: &AtomicBool) -> Result<(), Error> {
        let mut has_counted = false;
        loop {
            let is_counting = counts.load(Ordering::Acquire);
            if has_counted && !is_counting {
                return Ok(());
            }
            has_counted |= is_counting;
            tokio::select! {
                message = self.channel.wait() => match message {
                    Some(ChannelMsg::Data { data }) => self.read(&data, is_counting),
                    Some(_) => {}
                    None => return Err(Error::Disconnect),
                },
                () = sleep_until(self.next_key) => self.press().await?,
                () = sleep_until(self.answer_at), if !self.answers.is_empty() => {
                    let answers = std::mem::take(&mut self.answers);
                    self.channel.data(&answers[..]).await?;
                }
            }
        }
    }

    /// Answers the queries in `data`, and counts the data.
    fn read(&mut self, data: &[u8], is_counting: bool) {
        let now = Instant::now();
        let answered = self.lamp.read(data, now.into_std());
        if is_counting {
            self.tally.delays.extend(answered);
            self.tally.bytes += data.len() as u64;
        }
        self.tally.is_walking |= find(data, IN_ROOM).is_some();
        self.unread.extend_from_slice(data);
        let mut read = 0;
        while let Some(start) = find(&self.unread[read..], b"\x1b") {
            read += start;
            let rest = &self.unread[read..];
            let Some((query, answer)) = ANSWERS.iter().find(|it| rest.starts_with(it.0)) else {
                if rest.len() < FRAME_END.len() {
                    break;
                }
                read += 1;
                continue;
            };
            if self.answers.is_empty() {
                self.answer_at = now + self.delay;
            }
            self.answers.extend_from_slice(answer);
            self.tally.frames += u64::from(is_counting && *query == FRAME_END);
            read += query.len();
        }
        let kept =
            if find(&self.unread[read..], b"\x1b").is_some() { read } else { self.unread.len() };
        self.unread.drain(..kept);
    }

    async fn press(&mut self) -> Result<(), Error> {
        let now = Instant::now();
        if !self.tally.is_walking {
            self.next_key = now + ENTER;
            return self.channel.data(&b"\r"[..]).await;
        }
        if now >= self.key_until {
            let keys: [&[u8]; 4] = [b"w", b"w", b"\x1b[C", b"\x1b[D"];
            self.key = keys[(self.chance.bits() % 4) as usize];
            let time = self.chance.between(0.3, 2.0);
            self.key_until = now + Duration::from_secs_f64(time);
        }
        self.next_key = now + REPEAT;
        if self.lamp.gives_up(now.into_std()) {
            self.tally.unanswered += 1;
        }
        let is_time = now >= self.next_timed && !self.lamp.is_awaited();
        if is_time || self.lamp.is_lit() {
            let (least, most) = TIMED_PAUSE;
            self.next_timed = now + Duration::from_secs_f64(self.chance.between(least, most));
            self.lamp.press(now.into_std());
            self.channel.data(LAMP).await?;
        }
        self.channel.data(self.key).await
    }
}

fn find(bytes: &[u8], part: &[u8]) -> Option<usize> {
    bytes.windows(part.len()).position(|window| window == part)
}
