//! The server as a process of its own.

use std::error::Error;
use std::fs;
use std::io::{BufRead, BufReader};
use std::net::SocketAddr;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// A server that runs until this is dropped.
pub(crate) struct ServerProcess {
    child: Child,
    folder: PathBuf,
    pub(crate) address: SocketAddr,
}

/// What a process has used.
pub(crate) struct Usage {
    pub(crate) processor: Duration,
    pub(crate) megabytes: f64,
}

impl ServerProcess {
    pub(crate) fn start(program: &str, connections: usize) -> Result<Self, Box<dyn Error>> {
        let folder = std::env::temp_dir().join(format!("cellcaster-load-{}", std::process::id()));
        fs::create_dir_all(&folder)?;
        let config = folder.join("serve.toml");
        let most = connections + 100;
        fs::write(
            &config,
            format!(
                "connections = {most}\nconnections-per-address = {most}\nstartups-begin = {most}\n\
                 startups-full = {most}\nstartups-per-network = {most}\nstall-seconds = 600\n"
            ),
        )?;
        let mut child = Command::new("taskset")
            .args(["-c", "0", program, "serve", "--listen", "127.0.0.1:0", "--data"])
            .args([&folder])
            .arg("--config")
            .arg(&config)
            .stdout(Stdio::piped())
            .spawn()?;
        let mut line = String::new();
        BufReader::new(child.stdout.take().ok_or("no output")?).read_line(&mut line)?;
        let address = line.strip_prefix("Listening at ").and_then(|it| it.split(';').next());
        let address = address.ok_or("the server does not listen")?.parse()?;
        Ok(Self { child, folder, address })
    }

    /// What the server has used so far, from `/proc`.
    pub(crate) fn usage(&self) -> Result<Usage, Box<dyn Error>> {
        let folder = PathBuf::from(format!("/proc/{}", self.child.id()));
        let stat = fs::read_to_string(folder.join("stat"))?;
        let fields = stat.rsplit(')').next().unwrap_or_default().split_whitespace();
        // User and system time, in hundredths of a second.
        let ticks: u64 = fields.skip(11).take(2).filter_map(|it| it.parse::<u64>().ok()).sum();
        let status = fs::read_to_string(folder.join("status"))?;
        let resident = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
        let kilobytes = resident.and_then(|it| it.split_whitespace().next());
        let kilobytes: f64 = kilobytes.ok_or("no size")?.parse()?;
        Ok(Usage {
            processor: Duration::from_millis(ticks * 10),
            megabytes: (kilobytes / 102.4).round() / 10.0,
        })
    }
}

impl Drop for ServerProcess {
    fn drop(&mut self) {
        _ = self.child.kill();
        _ = self.child.wait();
        _ = fs::remove_dir_all(&self.folder);
    }
}

/// Keeps a process on one processor.
pub(crate) fn pin(process: u32, processor: u32) {
    let arguments = ["-apc".to_owned(), processor.to_string(), process.to_string()];
    _ = Command::new("taskset").args(arguments).stdout(Stdio::null()).status();
}
