//! A server with the game, in this process.

use std::fs;
use std::net::SocketAddr;
use std::path::PathBuf;
use std::process::Command;
use std::thread::{self, JoinHandle};
use std::time::Duration;

use cellcaster_server::accounts::HostStore;
use cellcaster_server::config::Config;
use cellcaster_server::sessions::driver::{GameHost, HostParts};
use cellcaster_server::ssh::Server;
use cellcaster_server::ssh::host_key::HostKey;
use cellcaster_server::visitors::Visitors;
use tokio::runtime::Builder;
use tokio::sync::oneshot;

use crate::emulator::Speaks;
use crate::player::Player;
use crate::transport::folder;

pub(crate) struct GameServer {
    folder: PathBuf,
    running: Option<Running>,
}

struct Running {
    address: SocketAddr,
    stop: Option<oneshot::Sender<()>>,
    thread: JoinHandle<()>,
}

impl GameServer {
    pub(crate) fn open() -> Self {
        Self::open_with(|_| ())
    }

    /// A server with the data that `fill` puts into its store.
    pub(crate) fn open_with(fill: impl FnOnce(&mut HostStore)) -> Self {
        let folder = folder();
        let mut store = HostStore::open(&folder).unwrap();
        fill(&mut store);
        drop(store);
        let running = Some(Running::start(&folder));
        Self { folder, running }
    }

    /// Stops the server and starts another one with the same data.
    pub(crate) fn restart(&mut self) {
        self.end();
        self.running = Some(Running::start(&self.folder));
    }

    /// Tells the server to shut down.
    pub(crate) fn stop(&mut self) {
        let stop = self.running.as_mut().and_then(|running| running.stop.take());
        stop.map(|stop| stop.send(()));
    }

    pub(crate) fn address(&self) -> SocketAddr {
        self.running.as_ref().unwrap().address
    }

    /// An OpenSSH client in a terminal.
    pub(crate) fn player(&self, options: &[&str]) -> Player {
        player_at(self.address().port(), options)
    }

    /// Creates a new key; returns its path.
    pub(crate) fn user_key(&self) -> String {
        let path = self.folder.join("user");
        let status = Command::new("ssh-keygen")
            .args(["-q", "-t", "ed25519", "-N", "", "-f"])
            .arg(&path)
            .status();
        assert!(status.unwrap().success());
        path.display().to_string()
    }

    fn end(&mut self) {
        self.stop();
        if let Some(running) = self.running.take() {
            running.thread.join().unwrap();
        }
    }
}

impl Drop for GameServer {
    fn drop(&mut self) {
        if !thread::panicking() {
            self.end();
        }
        _ = fs::remove_dir_all(&self.folder);
    }
}

impl Running {
    fn start(folder: &std::path::Path) -> Self {
        let mut config = Config { listen: ([127, 0, 0, 1], 0).into(), ..Config::default() };
        config.connections_per_address = 1000;
        config.drain = Duration::from_secs(4);
        let key = HostKey::open(folder).unwrap();
        let store = HostStore::open(folder).unwrap();
        let runtime = Builder::new_multi_thread().worker_threads(2).enable_all().build().unwrap();
        let server = runtime.block_on(Server::bind(config, key)).unwrap();
        let address = server.address().unwrap();
        let (stop, stopped) = oneshot::channel();
        let thread = thread::spawn(move || {
            runtime.block_on(async {
                let metrics = server.metrics();
                let visitors = Visitors::default();
                let host = HostParts::new(server.config(), metrics, visitors, store);
                server.run(GameHost::start(host.unwrap()), async { _ = stopped.await }).await;
            });
        });
        Self { address, stop: Some(stop), thread }
    }
}

/// An OpenSSH client in a terminal that connects to `port`.
pub(crate) fn player_at(port: u16, options: &[&str]) -> Player {
    let fixed = "-F none -o StrictHostKeyChecking=no -o UserKnownHostsFile=/dev/null \
                 -o LogLevel=ERROR -o IdentitiesOnly=yes -tt -p";
    let port = port.to_string();
    let words = fixed.split_whitespace().chain([port.as_str()]);
    let identity: &[&str] = if options.is_empty() { &["-o", "IdentityFile=none"] } else { &[] };
    let arguments: Vec<&str> =
        words.chain(identity.iter().copied()).chain(options.iter().copied()).collect();
    let arguments = arguments.into_iter().chain(["ann@127.0.0.1"]);
    Player::start((80, 24), Speaks::Kitty, "ssh", arguments, &[])
}
