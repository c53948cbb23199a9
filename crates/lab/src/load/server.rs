//! The server as a separate process.

use std::collections::BTreeMap;
use std::error::Error;
use std::fs;
use std::io::{BufRead, BufReader};
use std::net::{SocketAddr, TcpListener};
use std::num::NonZero;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::thread::available_parallelism;
use std::time::Duration;

/// A server that runs until this value is dropped.
pub(crate) struct ServerProcess {
    pub(crate) child: Child,
    pub(crate) folder: PathBuf,
    pub(crate) address: SocketAddr,
    /// The addresses of its metrics and of its page.
    pub(crate) metrics: SocketAddr,
    pub(crate) web: SocketAddr,
}

impl ServerProcess {
    /// Starts `program` with these additional options and lines of its configuration, for this number
    /// of connections. Its `number` among the servers of this run determines its processor.
    pub(crate) fn start(
        program: &str,
        options: &[String],
        (lines, connections): (&str, usize),
        number: usize,
    ) -> Result<Self, Box<dyn Error>> {
        let folder = folder(number)?;
        let config = folder.join("serve.toml");
        let most = connections + 100;
        // Two ports that are free at the moment.
        let ports = [TcpListener::bind("127.0.0.1:0")?, TcpListener::bind("127.0.0.1:0")?];
        let [metrics, web] = [ports[0].local_addr()?, ports[1].local_addr()?];
        drop(ports);
        fs::write(
            &config,
            format!(
                "connections = {most}\nconnections-per-address = {most}\nstartups = {most}\n\
                 stall-seconds = 600\nweb = \"{web}\"\n{lines}\
                 [metrics]\nlisten = \"{metrics}\"\n"
            ),
        )?;
        let mut child = Command::new("taskset")
            .args(["-c", &processor(number).to_string(), program])
            .args(["--listen", "127.0.0.1:0", "--data"])
            .args([&folder])
            .arg("--config")
            .arg(&config)
            .args(options)
            .stdout(Stdio::piped())
            .spawn()?;
        let mut line = String::new();
        BufReader::new(child.stdout.take().ok_or("no output")?).read_line(&mut line)?;
        let address = line.strip_prefix("Listening at ").and_then(|it| it.split(';').next());
        let address = address.ok_or("the server did not start to listen")?.parse()?;
        Ok(Self { child, folder, address, metrics, web })
    }

    /// The id of its process.
    pub(crate) fn id(&self) -> u32 {
        self.child.id()
    }

    /// The resources that the server has used.
    pub(crate) fn usage(&self) -> Usage {
        Usage::of(self.child.id())
    }
}

/// The processor of a server. Servers are assigned to processors in turn.
fn processor(number: usize) -> usize {
    number % available_parallelism().map_or(1, NonZero::get)
}

/// A folder for the files of a server.
pub(crate) fn folder(number: usize) -> Result<PathBuf, Box<dyn Error>> {
    let name = format!("cellcaster-load-{}-{number}", std::process::id());
    let folder = std::env::temp_dir().join(name);
    fs::create_dir_all(&folder)?;
    Ok(folder)
}

impl Drop for ServerProcess {
    fn drop(&mut self) {
        _ = self.child.kill();
        _ = self.child.wait();
        _ = fs::remove_dir_all(&self.folder);
    }
}

// Resources of processes, from `/proc`.

/// The resources that a process and all its descendants have used.
#[derive(Debug)]
pub(crate) struct Usage {
    pub(crate) processor: Duration,
    /// Proportional set size: a page that several processes share counts once in total.
    pub(crate) megabytes: f64,
}

/// The kernel's figures of one process.
struct Stat {
    parent: u32,
    processor: Duration,
}

impl Usage {
    pub(crate) fn of(root: u32) -> Self {
        let stats = stats();
        let mut processes = vec![root];
        let mut next = 0;
        while let Some(&process) = processes.get(next) {
            next += 1;
            processes.extend(stats.iter().filter(|it| it.1.parent == process).map(|it| it.0));
        }
        let processor =
            processes.iter().filter_map(|it| stats.get(it)).map(|it| it.processor).sum();
        let kilobytes: u64 = processes.iter().filter_map(|&it| kilobytes(it)).sum();
        Self { processor, megabytes: (kilobytes as f64 / 102.4).round() / 10.0 }
    }
}

/// The time that each process has used between two measurements of the same processes.
pub(crate) fn between(before: &[Usage], after: &[Usage]) -> Vec<Duration> {
    let pairs = before.iter().zip(after);
    pairs.map(|(before, after)| after.processor.saturating_sub(before.processor)).collect()
}

fn stats() -> BTreeMap<u32, Stat> {
    let Ok(entries) = fs::read_dir("/proc") else { return BTreeMap::new() };
    let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    names.filter_map(|name| name.parse().ok()).filter_map(|it| Some((it, stat(it)?))).collect()
}

fn stat(process: u32) -> Option<Stat> {
    let text = fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    let fields: Vec<&str> = text.rsplit(')').next()?.split_whitespace().collect();
    // User and system time, including children that have ended, in hundredths of a second.
    let ticks: u64 = fields.get(11..15)?.iter().filter_map(|it| it.parse::<u64>().ok()).sum();
    Some(Stat {
        parent: fields.get(1)?.parse().ok()?,
        processor: Duration::from_millis(ticks * 10),
    })
}

fn kilobytes(process: u32) -> Option<u64> {
    let text = fs::read_to_string(format!("/proc/{process}/smaps_rollup")).ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("Pss:"))?;
    line.split_whitespace().next()?.parse().ok()
}

/// Keeps a process on one processor.
pub(crate) fn pin(process: u32, processor: u32) {
    let arguments = ["-apc".to_owned(), processor.to_string(), process.to_string()];
    _ = Command::new("taskset").args(arguments).stdout(Stdio::null()).status();
}
