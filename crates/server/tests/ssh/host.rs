//! `cellcaster-server` on this machine, with one room.

use std::fs::{self, File};
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};

/// A host and its data folder.
pub(crate) struct Host {
    process: Child,
    port: u16,
    folder: PathBuf,
}

/// One room, in the same map that [`PLAY`](super::PLAY) plays behind sshd.
/// Without a budget of bytes, because sshd has none.
const CONFIGURATION: &str =
    "player-bytes-per-second = 0\n[[room]]\nmode = \"roam\"\nlevel = \"walks\"\n";
const MAP: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../maps/citadel.toml"));

impl Host {
    pub(crate) fn start() -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let name = format!("host-{}", COUNT.fetch_add(1, Ordering::Relaxed));
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        // Left over from an interrupted run.
        _ = fs::remove_dir_all(&folder);
        let maps = folder.join("maps");
        fs::create_dir_all(&maps).unwrap();
        fs::write(maps.join("walks.toml"), MAP).unwrap();
        fs::write(folder.join("serve.toml"), CONFIGURATION).unwrap();
        let mut process = Command::new(env!("CARGO_BIN_EXE_cellcaster-server"))
            .args(["--listen", "127.0.0.1:0", "--config"])
            .arg(folder.join("serve.toml"))
            .arg("--maps")
            .arg(maps)
            .env_clear()
            .env("CELLCASTER_DATA", &folder)
            .stdout(Stdio::piped())
            .stderr(File::create(folder.join("log")).unwrap())
            .spawn()
            .unwrap();
        let lines = BufReader::new(process.stdout.take().unwrap()).lines();
        let port = lines.map(Result::unwrap).find_map(|line| {
            let (_, rest) = line.split_once("ssh -p ")?;
            rest.split(' ').next()?.parse().ok()
        });
        let log = || fs::read_to_string(folder.join("log")).unwrap_or_default();
        let port = port.unwrap_or_else(|| panic!("the host does not listen: {}", log()));
        Self { process, port, folder }
    }

    pub(crate) fn port(&self) -> u16 {
        self.port
    }
}

impl Drop for Host {
    fn drop(&mut self) {
        _ = self.process.kill();
        _ = self.process.wait();
        _ = fs::remove_dir_all(&self.folder);
    }
}

/// The arguments with which `ssh` connects to `port`.
pub(crate) fn client_arguments(port: u16) -> Vec<String> {
    let options = "-tt -F none -o StrictHostKeyChecking=no -o UserKnownHostsFile=/dev/null \
                   -o LogLevel=ERROR -o IdentitiesOnly=yes -o IdentityFile=none -p";
    let last = [port.to_string(), "guest@127.0.0.1".to_owned()];
    options.split_whitespace().map(str::to_owned).chain(last).collect()
}
