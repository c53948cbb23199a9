//! A server that runs in a separate process.

use std::fs::{self, File};
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use cellcaster_server::accounts::HostStore;
use rustix::process::{Pid, Signal, kill_process};

use crate::emulator::Speaks;
use crate::player::Player;
use crate::support::server;
use crate::transport::{TIMEOUT, folder, wait_until};

pub(crate) struct Running {
    pub(crate) folder: PathBuf,
    process: Child,
    port: String,
    options: Vec<String>,
    /// The network namespace; `None` for the namespace of the tests.
    namespace: Option<String>,
}

impl Running {
    /// A server with this configuration that logs in `format`.
    pub(crate) fn start(config: &str, format: &str) -> Self {
        Self::start_with(config, format, &[])
    }

    /// Like [`Running::start`], with more options.
    pub(crate) fn start_with(config: &str, format: &str, options: &[&str]) -> Self {
        Self::start_in(None, config, format, options)
    }

    /// A server with the data that `fill` puts into its store.
    pub(crate) fn start_filled(fill: impl FnOnce(&mut HostStore)) -> Self {
        Self::begin(fill, None, "drain-seconds = 4\n", "text", &[])
    }

    /// Like [`Running::start_with`], in a network namespace.
    pub(crate) fn start_in(
        namespace: Option<&str>,
        config: &str,
        format: &str,
        options: &[&str],
    ) -> Self {
        Self::begin(|_| (), namespace, config, format, options)
    }

    fn begin(
        fill: impl FnOnce(&mut HostStore),
        namespace: Option<&str>,
        config: &str,
        format: &str,
        options: &[&str],
    ) -> Self {
        let folder = folder();
        // The host has run before.
        fill(&mut HostStore::open(&folder).unwrap());
        fs::write(folder.join("serve.toml"), config).unwrap();
        let options: Vec<String> = options.iter().map(|&option| option.to_owned()).collect();
        let namespace = namespace.map(str::to_owned);
        let (process, port) = spawn(&folder, format, &options, namespace.as_deref());
        Self { folder, process, port, options, namespace }
    }

    /// Adds an option for the next start.
    #[cfg(feature = "system-tests")]
    pub(crate) fn add_option(&mut self, option: &str) {
        self.options.push(option.to_owned());
    }

    /// Restarts the server in the same folder with the same options.
    pub(crate) fn restart(&mut self) {
        (self.process, self.port) =
            spawn(&self.folder, "text", &self.options, self.namespace.as_deref());
    }

    pub(crate) fn address(&self) -> String {
        format!("127.0.0.1:{}", self.port)
    }

    pub(crate) fn log(&self) -> String {
        fs::read_to_string(self.folder.join("log")).unwrap()
    }

    pub(crate) fn wait_for_log(&self, text: &str) {
        wait_until(&format!("{text} in the log"), || self.log().contains(text));
    }

    /// An OpenSSH client in a terminal.
    pub(crate) fn visitor(&self) -> Player {
        self.player(None)
    }

    /// An OpenSSH client with a key, or without one as a guest.
    pub(crate) fn player(&self, key: Option<&Path>) -> Player {
        self.player_at(&self.port, key)
    }

    /// The same through another port.
    pub(crate) fn player_at(&self, port: &str, key: Option<&Path>) -> Player {
        let key = key.map_or_else(|| "none".to_owned(), |key| key.display().to_string());
        let identity = format!("IdentityFile={key}");
        let options = "-F none -o StrictHostKeyChecking=no -o UserKnownHostsFile=/dev/null \
                       -o LogLevel=ERROR -o IdentitiesOnly=yes -tt -p";
        let user = if key == "none" { "guest@127.0.0.1" } else { "ann@127.0.0.1" };
        let last = [port, "-o", &identity, user];
        let words = ["ssh"].into_iter().chain(options.split_whitespace()).chain(last);
        let words: Vec<&str> = within(self.namespace.as_deref()).into_iter().chain(words).collect();
        Player::start((80, 24), Speaks::Kitty, words[0], &words[1..], &[])
    }

    /// Waits until the operator's list shows `count` visitors.
    pub(crate) fn wait_for_visitors(&self, count: usize) {
        wait_until("visitors", || {
            let lines = self.admin_says(&["who"]).lines().count();
            lines == if count == 0 { 1 } else { count + 1 }
        });
    }

    pub(crate) fn admin(&self, arguments: &[&str]) -> Output {
        let words = [&["admin"], arguments].concat();
        server(&words).env("CELLCASTER_DATA", &self.folder).output().unwrap()
    }

    /// Runs `admin`, asserts success, and returns its output.
    pub(crate) fn admin_says(&self, arguments: &[&str]) -> String {
        let output = self.admin(arguments);
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!((output.status.code(), error.as_str()), (Some(0), ""), "{arguments:?}");
        String::from_utf8(output.stdout).unwrap()
    }

    /// The process id.
    #[cfg(all(target_os = "linux", feature = "system-tests"))]
    pub(crate) fn process(&self) -> u32 {
        self.process.id()
    }

    pub(crate) fn signal(&self, signal: Signal) {
        kill_process(Pid::from_child(&self.process), signal).unwrap();
    }

    /// Waits for the process to exit; returns its exit status.
    pub(crate) fn wait_for_end(&mut self) -> Option<i32> {
        let end = Instant::now() + TIMEOUT;
        loop {
            if let Some(status) = self.process.try_wait().unwrap() {
                return status.code();
            }
            assert!(Instant::now() < end, "the server goes on; its log:\n{}", self.log());
            thread::sleep(Duration::from_millis(20));
        }
    }
}

/// The command prefix that runs a command in a network namespace.
fn within(namespace: Option<&str>) -> Vec<&str> {
    namespace.map_or_else(Vec::new, |name| vec!["ip", "netns", "exec", name])
}

/// Starts the process; returns it with its port.
fn spawn(
    folder: &Path,
    format: &str,
    options: &[String],
    namespace: Option<&str>,
) -> (Child, String) {
    let log = File::create(folder.join("log")).unwrap();
    let mut words = within(namespace);
    words.push(env!("CARGO_BIN_EXE_cellcaster-server"));
    let mut process = Command::new(words[0])
        .args(&words[1..])
        .args(["--listen", "127.0.0.1:0", "--log", format, "--config"])
        .arg(folder.join("serve.toml"))
        .args(options)
        .env_clear()
        .env("PATH", "/usr/sbin:/usr/bin:/sbin:/bin")
        .env("CELLCASTER_DATA", folder)
        .stdout(Stdio::piped())
        .stderr(log)
        .spawn()
        .unwrap();
    let mut lines = BufReader::new(process.stdout.take().unwrap()).lines();
    let line = lines.find(|line| line.as_ref().unwrap().contains("ssh -p "));
    let line = line.unwrap_or_else(|| {
        panic!("the server ended; its log:\n{}", fs::read_to_string(folder.join("log")).unwrap())
    });
    let line = line.unwrap();
    let (_, rest) = line.split_once("ssh -p ").unwrap();
    let port = rest.split(' ').next().unwrap().to_owned();
    (process, port)
}

/// Creates a new user key.
pub(crate) fn user_key(folder: &Path) -> PathBuf {
    let path = folder.join("user");
    let mut keygen = Command::new("ssh-keygen");
    let made = keygen.args(["-q", "-t", "ed25519", "-N", "", "-f"]).arg(&path);
    assert!(made.status().unwrap().success());
    path
}

impl Drop for Running {
    fn drop(&mut self) {
        _ = self.process.kill();
        _ = self.process.wait();
        if !thread::panicking() {
            _ = fs::remove_dir_all(&self.folder);
        }
    }
}
