//! A link between two ports of this machine, as long and as narrow as one wants.

use std::io::{Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::mpsc::{self, Receiver, Sender};
use std::sync::{Arc, Condvar, Mutex};
use std::thread;
use std::time::{Duration, Instant};

/// What a link does to bytes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Link {
    /// From one end to the other.
    pub(crate) delay: Duration,
    /// How much it carries towards the player; `None` for anything.
    pub(crate) bytes_per_second: Option<f64>,
}

/// What takes a connection and makes another one to a server.
pub(crate) struct Proxy {
    port: u16,
    ends: Arc<Mutex<Vec<TcpStream>>>,
    backlog: Arc<Backlog>,
}

/// How much is on its way to the player.
#[derive(Default)]
struct Backlog {
    bytes: Mutex<usize>,
    changed: Condvar,
}

/// Bytes, and when they arrive.
type Packet = (Instant, Vec<u8>);

/// The most that travels in one piece.
const PACKET: usize = 1400;

impl Proxy {
    /// Listens for one connection, and passes it on to `server`.
    pub(crate) fn start(server: u16, link: Link) -> Self {
        let listener = TcpListener::bind(("127.0.0.1", 0)).unwrap();
        let port = listener.local_addr().unwrap().port();
        let ends = Arc::new(Mutex::new(Vec::new()));
        let backlog = Arc::new(Backlog::default());
        thread::spawn({
            let (ends, backlog) = (Arc::clone(&ends), Arc::clone(&backlog));
            move || {
                let player = listener.accept().unwrap().0;
                let server = TcpStream::connect(("127.0.0.1", server)).unwrap();
                for end in [&player, &server] {
                    end.set_nodelay(true).unwrap();
                    ends.lock().unwrap().push(end.try_clone().unwrap());
                }
                let clone = |end: &TcpStream| end.try_clone().unwrap();
                let up = Link { bytes_per_second: None, ..link };
                carry(clone(&player), clone(&server), up, Arc::default());
                carry(server, player, link, backlog);
            }
        });
        Self { port, ends, backlog }
    }

    pub(crate) fn port(&self) -> u16 {
        self.port
    }

    /// Waits until part of a frame is on its way, and ends both connections.
    pub(crate) fn cut_in_mid_frame(&self) {
        let bytes = self.backlog.bytes.lock().unwrap();
        let patience = Duration::from_secs(5);
        let empty = |bytes: &mut usize| *bytes < 2 * PACKET;
        let waited = self.backlog.changed.wait_timeout_while(bytes, patience, empty).unwrap();
        assert!(!waited.1.timed_out(), "nothing was on its way");
        drop(waited);
        for end in &*self.ends.lock().unwrap() {
            // The other side may have ended it already.
            _ = end.shutdown(Shutdown::Both);
        }
    }
}

/// Carries bytes one way, until there are no more.
fn carry(from: TcpStream, to: TcpStream, link: Link, backlog: Arc<Backlog>) {
    let (sender, receiver) = mpsc::channel();
    thread::spawn({
        let backlog = Arc::clone(&backlog);
        move || take(from, link, &sender, &backlog)
    });
    thread::spawn(move || deliver(&receiver, to, &backlog));
}

fn take(mut from: TcpStream, link: Link, sender: &Sender<Packet>, backlog: &Backlog) {
    let mut carried_at = Instant::now();
    let mut buffer = [0; PACKET];
    while let Ok(count @ 1..) = from.read(&mut buffer) {
        let busy = link.bytes_per_second.map_or(0.0, |rate| count as f64 / rate);
        carried_at = carried_at.max(Instant::now()) + Duration::from_secs_f64(busy);
        *backlog.bytes.lock().unwrap() += count;
        backlog.changed.notify_all();
        if sender.send((carried_at + link.delay, buffer[..count].to_vec())).is_err() {
            return;
        }
    }
}

fn deliver(receiver: &Receiver<Packet>, mut to: TcpStream, backlog: &Backlog) {
    while let Ok((arrives_at, bytes)) = receiver.recv() {
        thread::sleep(arrives_at.saturating_duration_since(Instant::now()));
        *backlog.bytes.lock().unwrap() -= bytes.len();
        if to.write_all(&bytes).is_err() {
            break;
        }
    }
    // It may be closed already.
    _ = to.shutdown(Shutdown::Both);
}
