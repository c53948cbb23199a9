//! A link between two ports of this machine, with adjustable delay, jitter and rate.

use std::io::{Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, Sender};
use std::sync::{Arc, Condvar, Mutex};
use std::thread;
use std::time::{Duration, Instant};

/// The properties of a link.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Link {
    /// The delay from one end to the other.
    pub(crate) delay: Duration,
    /// The maximum extra delay of a packet, each way.
    pub(crate) jitter: Duration,
    /// The rate towards the player, in bytes per second; `None` for no limit.
    pub(crate) bytes_per_second: Option<f64>,
}

/// A proxy that accepts one connection and passes it on to a server.
pub(crate) struct Proxy {
    port: u16,
    ends: Arc<Mutex<Vec<TcpStream>>>,
    is_dead: Arc<AtomicBool>,
    backlog: Arc<Backlog>,
}

/// The number of bytes in flight to the player.
#[derive(Default)]
struct Backlog {
    bytes: Mutex<usize>,
    changed: Condvar,
}

/// The time of arrival and the bytes.
type Packet = (Instant, Vec<u8>);

/// The maximum size of a packet, in bytes.
const PACKET: usize = 1400;

impl Proxy {
    /// Listens for one connection, and passes it on to `server`.
    pub(crate) fn start(server: u16, link: Link) -> Self {
        let listener = TcpListener::bind(("127.0.0.1", 0)).unwrap();
        let port = listener.local_addr().unwrap().port();
        let ends = Arc::new(Mutex::new(Vec::new()));
        let is_dead = Arc::new(AtomicBool::new(false));
        let backlog = Arc::new(Backlog::default());
        thread::spawn({
            let (ends, backlog) = (Arc::clone(&ends), Arc::clone(&backlog));
            let is_dead = Arc::clone(&is_dead);
            move || {
                let player = listener.accept().unwrap().0;
                let server = TcpStream::connect(("127.0.0.1", server)).unwrap();
                for end in [&player, &server] {
                    end.set_nodelay(true).unwrap();
                    ends.lock().unwrap().push(end.try_clone().unwrap());
                }
                let clone = |end: &TcpStream| end.try_clone().unwrap();
                let up = Link { bytes_per_second: None, ..link };
                carry(clone(&player), clone(&server), up, Arc::default(), Arc::clone(&is_dead));
                carry(server, player, link, backlog, is_dead);
            }
        });
        Self { port, ends, is_dead, backlog }
    }

    pub(crate) fn port(&self) -> u16 {
        self.port
    }

    /// Stops passing bytes on in both directions, without closing the connections.
    pub(crate) fn die(&self) {
        self.is_dead.store(true, Ordering::SeqCst);
    }

    /// Waits until part of a frame is in flight, then closes both connections.
    pub(crate) fn cut_in_mid_frame(&self) {
        let bytes = self.backlog.bytes.lock().unwrap();
        let patience = Duration::from_secs(5);
        let empty = |bytes: &mut usize| *bytes < 2 * PACKET;
        let waited = self.backlog.changed.wait_timeout_while(bytes, patience, empty).unwrap();
        assert!(!waited.1.timed_out(), "nothing was on its way");
        drop(waited);
        for end in &*self.ends.lock().unwrap() {
            // The other side may already have closed it.
            _ = end.shutdown(Shutdown::Both);
        }
    }
}

/// Carries bytes in one direction until the connection ends.
fn carry(
    from: TcpStream,
    to: TcpStream,
    link: Link,
    backlog: Arc<Backlog>,
    is_dead: Arc<AtomicBool>,
) {
    let (sender, receiver) = mpsc::channel();
    thread::spawn({
        let (backlog, is_dead) = (Arc::clone(&backlog), Arc::clone(&is_dead));
        move || take(from, link, &sender, &backlog, &is_dead)
    });
    thread::spawn(move || deliver(&receiver, to, &backlog, &is_dead));
}

fn take(
    mut from: TcpStream,
    link: Link,
    sender: &Sender<Packet>,
    backlog: &Backlog,
    is_dead: &AtomicBool,
) {
    let mut carried_at = Instant::now();
    let mut arrives_at = carried_at;
    let mut chance: u32 = 7;
    let mut buffer = [0; PACKET];
    while let Ok(count @ 1..) = from.read(&mut buffer) {
        let busy = link.bytes_per_second.map_or(0.0, |rate| count as f64 / rate);
        carried_at = carried_at.max(Instant::now()) + Duration::from_secs_f64(busy);
        *backlog.bytes.lock().unwrap() += count;
        backlog.changed.notify_all();
        // The generator of Numerical Recipes; its high bits are good enough here.
        chance = chance.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let jitter = link.jitter.mul_f64(f64::from(chance >> 8) / f64::from(1 << 24));
        arrives_at = arrives_at.max(carried_at + link.delay + jitter);
        while is_dead.load(Ordering::SeqCst) {
            thread::sleep(Duration::from_millis(50));
        }
        if sender.send((arrives_at, buffer[..count].to_vec())).is_err() {
            return;
        }
    }
}

fn deliver(
    receiver: &Receiver<Packet>,
    mut to: TcpStream,
    backlog: &Backlog,
    is_dead: &AtomicBool,
) {
    while let Ok((arrives_at, bytes)) = receiver.recv() {
        thread::sleep(arrives_at.saturating_duration_since(Instant::now()));
        while is_dead.load(Ordering::SeqCst) {
            thread::sleep(Duration::from_millis(50));
        }
        *backlog.bytes.lock().unwrap() -= bytes.len();
        if to.write_all(&bytes).is_err() {
            break;
        }
    }
    // The connection may already be closed.
    _ = to.shutdown(Shutdown::Both);
}
