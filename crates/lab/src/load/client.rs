//! One client: a terminal that answers queries, and a player who holds keys.

use std::net::SocketAddr;
use std::time::Duration;

use cellcaster::rng::SplitMix64;
use russh::client::Msg;
use russh::{Channel, ChannelMsg, Error};
use tokio::time::{Instant, sleep_until};

use super::wanderer::{connect, replies};

/// The size of the window.
pub(crate) const WINDOW: [u32; 2] = [80, 24];
/// The interval at which the keyboard repeats a held key.
const REPEAT: Duration = Duration::from_millis(33);
/// The time between two presses of Enter on the way to a room.
const ENTER: Duration = Duration::from_millis(900);
/// The title of the map panel, which only a room shows.
const IN_ROOM: &[u8] = b"map";

struct Client {
    channel: Channel<Msg>,
    chance: SplitMix64,
    is_in_room: bool,
    /// Bytes in which a query may begin.
    unread: Vec<u8>,
    key: &'static [u8],
    key_until: Instant,
    next_key: Instant,
    delay: Duration,
    answers: Vec<u8>,
    answer_at: Instant,
}

/// Plays as the guest with this number until the connection ends. Queries are answered after `delay`.
pub(crate) async fn play(address: SocketAddr, number: u64, delay: Duration) -> Result<(), Error> {
    let (_handle, channel, _) = connect(address, &format!("load{number}"), WINDOW).await?;
    let now = Instant::now();
    let mut client = Client {
        channel,
        chance: SplitMix64::new(number),
        is_in_room: false,
        unread: Vec::new(),
        key: b"w",
        key_until: now,
        next_key: now + ENTER,
        delay,
        answers: Vec::new(),
        answer_at: now,
    };
    loop {
        tokio::select! {
            message = client.channel.wait() => match message {
                Some(ChannelMsg::Data { data }) => client.read(&data),
                Some(_) => {}
                None => return Err(Error::Disconnect),
            },
            () = sleep_until(client.next_key) => client.press().await?,
            () = sleep_until(client.answer_at), if !client.answers.is_empty() => {
                let answers = std::mem::take(&mut client.answers);
                client.channel.data(&answers[..]).await?;
            }
        }
    }
}

impl Client {
    fn read(&mut self, data: &[u8]) {
        self.is_in_room |= data.windows(IN_ROOM.len()).any(|part| part == IN_ROOM);
        if self.answers.is_empty() {
            self.answer_at = Instant::now() + self.delay;
        }
        self.answers.extend(replies(&mut self.unread, data));
    }

    async fn press(&mut self) -> Result<(), Error> {
        let now = Instant::now();
        if !self.is_in_room {
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
        self.channel.data(self.key).await
    }
}
