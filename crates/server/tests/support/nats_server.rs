//! A NATS server for a single test, which ends with the test. Uses the program from Debian's package `nats-server`.

use std::fs;
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::thread;
use std::time::{Duration, Instant};

const TIMEOUT: Duration = Duration::from_secs(20);

/// A server with a log on disk, and a watcher process that kills the server when this process ends.
pub(crate) struct NatsServer {
    folder: PathBuf,
    address: Ipv4Addr,
    port: u16,
    /// The watcher exits when its input closes, and kills the server.
    watcher: Option<Child>,
}

impl NatsServer {
    /// Starts a server and waits until it answers.
    pub(crate) fn start() -> Self {
        Self::start_at(Ipv4Addr::LOCALHOST)
    }

    /// Starts a server at an address of this machine.
    pub(crate) fn start_at(address: Ipv4Addr) -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let folder =
            std::env::temp_dir().join(format!("cellcaster-nats-{}-{number}", std::process::id()));
        fs::create_dir(&folder).unwrap();
        let port = TcpListener::bind((address, 0)).unwrap().local_addr().unwrap().port();
        let mut server = Self { folder, address, port, watcher: None };
        server.restart();
        server
    }

    /// The server's address.
    pub(crate) fn address(&self) -> String {
        format!("nats://{}:{}", self.address, self.port)
    }

    pub(crate) fn kill(&mut self) {
        let Some(mut watcher) = self.watcher.take() else { return };
        drop(watcher.stdin.take());
        watcher.wait().unwrap();
    }

    /// Starts the server with its existing data, and waits until it answers.
    pub(crate) fn restart(&mut self) {
        let folder = self.folder.display();
        let script = format!(
            "nats-server -a {} -p {} -js -sd {folder} >{folder}/log 2>&1 & \
             read _; kill -9 $!; wait",
            self.address, self.port
        );
        // The package installs the program in a directory that only root's path contains.
        let path = format!("{}:/usr/sbin", std::env::var("PATH").unwrap_or_default());
        let mut command = Command::new("sh");
        command.arg("-c").arg(script).env("PATH", path).stdin(Stdio::piped());
        let watcher = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        self.watcher = Some(watcher);
        let start = Instant::now();
        while TcpStream::connect((self.address, self.port)).is_err() {
            assert!(start.elapsed() < TIMEOUT, "nats-server is installed, and starts");
            thread::sleep(Duration::from_millis(20));
        }
    }
}

impl Drop for NatsServer {
    fn drop(&mut self) {
        self.kill();
        _ = fs::remove_dir_all(&self.folder);
    }
}
