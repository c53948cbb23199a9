//! A server in this process, with clients.

use std::cell::Cell;
use std::fs;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use cellcaster_server::config::Config;
use cellcaster_server::metrics::Metrics;
use cellcaster_server::ssh::Server;
use cellcaster_server::ssh::host_key::HostKey;
use tokio::runtime::{Builder, Runtime};
use tokio::sync::oneshot;

use super::echo::Echo;
use crate::emulator::Speaks;
use crate::player::Player;

/// Long enough for a machine under load.
pub(crate) const TIMEOUT: Duration = Duration::from_secs(30);
const WINDOW: (u16, u16) = (80, 24);

pub(crate) struct House {
    pub(crate) address: SocketAddr,
    pub(crate) metrics: Arc<Metrics>,
    pub(crate) folder: PathBuf,
    stop: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl House {
    pub(crate) fn open() -> Self {
        Self::open_with(|_| {})
    }

    /// A server on a free port that accepts any number of clients from this machine.
    pub(crate) fn open_with(change: impl FnOnce(&mut Config)) -> Self {
        let folder = folder();
        let mut config = Config { listen: ([127, 0, 0, 1], 0).into(), ..Config::default() };
        config.connections_per_address = 1000;
        change(&mut config);
        let key = HostKey::open(&folder).unwrap();
        let runtime = Builder::new_multi_thread().worker_threads(2).enable_all().build().unwrap();
        let server = runtime.block_on(Server::bind(config, key)).unwrap();
        let (address, metrics) = (server.address().unwrap(), server.metrics());
        let (stop, stopped) = oneshot::channel();
        let stopped = async { _ = stopped.await };
        let thread = thread::spawn(move || serve(&runtime, server, stopped));
        Self { address, metrics, folder, stop: Some(stop), thread: Some(thread) }
    }

    /// The arguments with which `ssh` connects.
    pub(crate) fn arguments(&self, options: &[&str]) -> Vec<String> {
        let fixed = "-F none -o StrictHostKeyChecking=no -o UserKnownHostsFile=/dev/null \
                     -o LogLevel=ERROR -o IdentitiesOnly=yes -p";
        let port = self.address.port().to_string();
        let has_identity = options.iter().any(|option| option.starts_with("IdentityFile"));
        let none = ["-o", "IdentityFile=none"];
        let identity = none.into_iter().filter(|_| !has_identity);
        let words = fixed.split_whitespace().chain([port.as_str()]).chain(identity);
        words.chain(options.iter().copied()).map(str::to_owned).collect()
    }

    /// An OpenSSH client in a terminal.
    pub(crate) fn player(&self, options: &[&str]) -> Player {
        let mut arguments = self.arguments(options);
        arguments.extend(["-tt", "ann@127.0.0.1"].map(str::to_owned));
        Player::start(WINDOW, Speaks::Kitty, "ssh", arguments, &[])
    }

    /// A client whose session is running.
    pub(crate) fn visitor(&self, options: &[&str]) -> Player {
        let player = self.player(options);
        player.wait_for("[typed");
        player
    }

    /// Runs `ssh` without a terminal; returns its output, its errors and its exit status.
    pub(crate) fn run(&self, options: &[&str], rest: &[&str]) -> (String, String, Option<i32>) {
        let output = Command::new("ssh").args(self.arguments(options)).args(rest).output().unwrap();
        (
            String::from_utf8(output.stdout).unwrap(),
            String::from_utf8(output.stderr).unwrap(),
            output.status.code(),
        )
    }

    /// Creates a new user key; returns its path.
    pub(crate) fn user_key(&self, name: &str, comment: &str) -> String {
        self.user_key_of("ed25519", name, comment)
    }

    pub(crate) fn user_key_of(&self, kind: &str, name: &str, comment: &str) -> String {
        let path = self.folder.join(name);
        let status = Command::new("ssh-keygen")
            .args(["-q", "-t", kind, "-N", "", "-C", comment, "-f"])
            .arg(&path)
            .status();
        assert!(status.unwrap().success());
        path.display().to_string()
    }

    /// Asserts that a new visitor gets an answer.
    pub(crate) fn assert_answers(&self) {
        let mut player = self.visitor(&[]);
        player.send("x");
        player.wait_for("[typed x]");
        player.send("q");
        assert_eq!(player.wait_for_end().status.code(), Some(7));
    }

    /// Runs `act` next to a visitor whose session is due a frame every tenth of a second, and asserts that no
    /// frame is lost. Up to one frame in ten may be late, because the machine may be under load.
    pub(crate) fn beside_another<T>(&self, act: impl FnOnce() -> T) -> T {
        let bystander = self.visitor(&[]);
        bystander.send("T");
        bystander.wait_for("[due 1 ");
        let [before, _] = due(&bystander);
        let result = act();
        let [sent, _] = due(&bystander);
        // Frames still arrive.
        bystander.wait_until("got a frame", |emulator| due_of(&emulator.text())[0] > sent);
        let [sent, missed] = due(&bystander);
        assert!(missed * 10 <= sent + 10, "{missed} frames were lost, and {} sent", sent - before);
        bystander.send("q");
        result
    }

    pub(crate) fn sessions(&self) -> i64 {
        self.metrics.sessions.get()
    }

    /// Tells the server to shut down.
    pub(crate) fn stop(&mut self) {
        self.stop.take().map(|stop| stop.send(()));
    }

    pub(crate) fn wait_for_end(&mut self) {
        self.stop();
        self.thread.take().map(JoinHandle::join).transpose().unwrap();
    }
}

impl Drop for House {
    fn drop(&mut self) {
        if !thread::panicking() {
            self.wait_for_end();
            assert_eq!(self.metrics.connections.get(), 0);
            assert_eq!(self.metrics.held.get(), 0);
        }
        _ = fs::remove_dir_all(&self.folder);
    }
}

/// The number of frames that a visitor was sent in time, and of those that were late.
fn due(visitor: &Player) -> [u32; 2] {
    let due = Cell::new([0; 2]);
    visitor.wait_until("showed a whole frame", |emulator| {
        due.set(due_of(&emulator.text()));
        true
    });
    due.get()
}

fn due_of(text: &str) -> [u32; 2] {
    let numbers = text.split_once("[due ").and_then(|(_, rest)| rest.split_once(']'));
    let mut numbers = numbers.map_or("0 0", |(numbers, _)| numbers).split(' ');
    [(); 2].map(|()| numbers.next().and_then(|number| number.parse().ok()).unwrap_or(0))
}

fn serve(runtime: &Runtime, server: Server, stopped: impl Future<Output = ()> + Send) {
    runtime.block_on(server.run(Echo, stopped));
    let end = Instant::now() + TIMEOUT;
    while runtime.metrics().num_alive_tasks() > 0 {
        assert!(Instant::now() < end, "tasks are left over");
        thread::sleep(Duration::from_millis(10));
    }
}

/// A new empty folder.
pub(crate) fn folder() -> PathBuf {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let name = format!("serve-{}", COUNT.fetch_add(1, Ordering::Relaxed));
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// Waits until `condition` holds.
pub(crate) fn wait_until(what: &str, condition: impl Fn() -> bool) {
    let end = Instant::now() + TIMEOUT;
    while !condition() {
        assert!(Instant::now() < end, "{what}");
        thread::sleep(Duration::from_millis(20));
    }
}
