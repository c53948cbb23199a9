//! A client that connects, enters a room, walks, chats, resizes its window, and leaves in one of several ways.
//!
//! Its actions depend on its seed alone, but the server's timing does not. The server's tests use it, too.

use std::net::{Shutdown, SocketAddr};
use std::sync::Arc;
use std::time::Duration;

use cellcaster::rng::SplitMix64;
use russh::client::{self, Handle, Handler, Msg};
use russh::keys::PublicKeyOrCertificate;
use russh::{Channel, ChannelMsg, Disconnect, Error};
use tokio::net::TcpStream;
use tokio::time::{Instant, sleep_until, timeout_at};

/// The way in which a visit ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Leaving {
    /// With the keys of the game.
    ByKeys,
    /// The SSH client closes its connection.
    Disconnected,
    /// The socket is closed without notice.
    Cut,
    /// The terminal stops replying, and after 25 seconds the connection is dropped.
    Silent,
}

/// Accepts any server key.
pub(crate) struct Anyone;

struct Wanderer {
    /// Kept until the end, because dropping it ends the connection.
    handle: Handle<Anyone>,
    channel: Channel<Msg>,
    chance: SplitMix64,
    /// The last bytes, which may contain the start of a query.
    unread: Vec<u8>,
    /// The time of the next key. Keys on the way to a room are slower than those in it.
    next_key: Instant,
    keys: u32,
    /// A second descriptor of the socket.
    socket: std::net::TcpStream,
}

/// The keys on the way to a room: mostly Enter, sometimes another entry.
const WAY: [&str; 6] = ["\r", "\r", "\r", "\r", "\x1b[B", "\x1b[B\x1b[B"];
/// The keys in a room.
const KEYS: [&str; 8] = ["w", "w", "w", "\x1b[C", "\x1b[D", "s", "1", "\r"];
/// The number of keys on the way to a room.
const WAY_LENGTH: u32 = 6;
const WAY_PAUSE: Duration = Duration::from_millis(150);
const PAUSE: Duration = Duration::from_millis(50);
/// How long a silent terminal stays, and the longest wait for a session to end.
const TIMEOUT: Duration = Duration::from_secs(25);

impl Handler for Anyone {
    type Error = Error;

    async fn check_server_key(&mut self, _: &PublicKeyOrCertificate) -> Result<bool, Error> {
        Ok(true)
    }
}

/// Visits a server for at most `longest`, and leaves it.
pub(crate) async fn visit(
    address: SocketAddr,
    seed: u64,
    longest: Duration,
) -> Result<Leaving, Error> {
    let mut chance = SplitMix64::new(seed);
    let leaving = [Leaving::ByKeys, Leaving::Disconnected, Leaving::Cut, Leaving::Silent];
    // Silent clients stay long, so there are few of them.
    let leaving = leaving[[0, 0, 0, 1, 1, 1, 2, 2, 2, 3][chance.below(10)]];
    let time = Duration::from_secs_f64(chance.between(0.2, longest.as_secs_f64()));
    let mut wanderer = Wanderer::connect(address, chance).await?;
    wanderer.wander(Instant::now() + time).await?;
    wanderer.leave(leaving).await?;
    Ok(leaving)
}

/// Opens a session in a window of this size. Dropping the handle ends the connection. Also returns a second descriptor
/// of the socket.
pub(crate) async fn connect(
    address: SocketAddr,
    user: &str,
    [columns, rows]: [u32; 2],
) -> Result<(Handle<Anyone>, Channel<Msg>, std::net::TcpStream), Error> {
    let socket = TcpStream::connect(address).await?.into_std()?;
    socket.set_nodelay(true)?;
    let stream = TcpStream::from_std(socket.try_clone()?)?;
    let config = Arc::<client::Config>::default();
    let mut handle = client::connect_stream(config, stream, Anyone).await?;
    while !handle.authenticate_none(user).await?.success() {}
    let channel = handle.channel_open_session().await?;
    channel.set_env(false, "COLORTERM", "truecolor").await?;
    channel.request_pty(false, "xterm-256color", columns, rows, 0, 0, &[]).await?;
    channel.request_shell(false).await?;
    Ok((handle, channel, socket))
}

/// The replies to the terminal queries in `data`. `unread` holds the last bytes before it, which may contain the start
/// of a query.
pub(crate) fn replies(unread: &mut Vec<u8>, data: &[u8]) -> Vec<u8> {
    unread.extend_from_slice(data);
    let mut replies = Vec::new();
    for query in unread.windows(4).filter(|it| it.starts_with(b"\x1b[")) {
        match query {
            [_, _, b'5', b'n'] => replies.extend_from_slice(b"\x1b[0n"),
            [_, _, b'6', b'n'] => replies.extend_from_slice(b"\x1b[1;1R"),
            [_, _, b'c', _] => replies.extend_from_slice(b"\x1b[?62;22c"),
            _ => {}
        }
    }
    // A query of three bytes at the very end is answered with the next data. Each frame ends with a query
    // of four bytes.
    let kept = unread.len().saturating_sub(3);
    unread.drain(..kept);
    replies
}

impl Wanderer {
    async fn connect(address: SocketAddr, mut chance: SplitMix64) -> Result<Self, Error> {
        let user = format!("soak{}", chance.below(100_000));
        let (handle, channel, socket) = connect(address, &user, window(&mut chance)).await?;
        let next_key = Instant::now() + WAY_PAUSE;
        Ok(Self { handle, channel, chance, unread: Vec::new(), next_key, keys: 0, socket })
    }

    /// Plays until `end`, or until the server ends the session.
    async fn wander(&mut self, end: Instant) -> Result<(), Error> {
        loop {
            tokio::select! {
                message = self.channel.wait() => match message {
                    Some(ChannelMsg::Data { data }) => self.answer(&data).await?,
                    Some(_) => {}
                    None => return Ok(()),
                },
                () = sleep_until(self.next_key) => self.press().await?,
                () = sleep_until(end) => return Ok(()),
            }
        }
    }

    async fn leave(mut self, leaving: Leaving) -> Result<(), Error> {
        let patience = Instant::now() + TIMEOUT;
        match leaving {
            Leaving::ByKeys => {
                self.channel.data(&b"\x03\x03"[..]).await?;
                // The client replies to queries, so that the session ends at once.
                _ = timeout_at(patience, self.answer_all()).await;
                Ok(())
            }
            Leaving::Disconnected => {
                self.handle.disconnect(Disconnect::ByApplication, "", "").await
            }
            Leaving::Cut => Ok(self.socket.shutdown(Shutdown::Both)?),
            Leaving::Silent => {
                sleep_until(patience).await;
                Ok(())
            }
        }
    }

    async fn answer_all(&mut self) -> Result<(), Error> {
        while let Some(message) = self.channel.wait().await {
            if let ChannelMsg::Data { data } = message {
                self.answer(&data).await?;
            }
        }
        Ok(())
    }

    async fn press(&mut self) -> Result<(), Error> {
        self.keys += 1;
        let is_inside = self.keys > WAY_LENGTH;
        self.next_key = Instant::now() + if is_inside { PAUSE } else { WAY_PAUSE };
        if self.chance.below(100) == 0 {
            let [columns, rows] = window(&mut self.chance);
            return self.channel.window_change(columns, rows, 0, 0).await;
        }
        let keys = if is_inside {
            KEYS[self.chance.below(KEYS.len())]
        } else {
            WAY[self.chance.below(WAY.len())]
        };
        self.channel.data(keys.as_bytes()).await
    }

    /// Replies to the terminal queries in `data`.
    async fn answer(&mut self, data: &[u8]) -> Result<(), Error> {
        let replies = replies(&mut self.unread, data);
        if replies.is_empty() { Ok(()) } else { self.channel.data(&replies[..]).await }
    }
}

/// A random window size.
fn window(chance: &mut SplitMix64) -> [u32; 2] {
    [20 + chance.below(140) as u32, 6 + chance.below(50) as u32]
}
