//! The server as a process of its own.

use std::error::Error;
use std::fs;
use std::io::{BufRead, BufReader};
use std::net::{SocketAddr, TcpListener};
use std::num::NonZero;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::thread::available_parallelism;

use super::process::Usage;

/// A server that runs until this is dropped.
pub(crate) struct ServerProcess {
    pub(crate) child: Child,
    pub(crate) folder: PathBuf,
    pub(crate) address: SocketAddr,
    /// Where its metrics are; `None` if it has none.
    pub(crate) metrics: Option<SocketAddr>,
    pub(crate) access: Access,
}

/// How a server is started.
pub(crate) struct Setup<'a> {
    pub(crate) program: &'a str,
    /// The connections that it is for.
    pub(crate) connections: usize,
    /// Its number among the servers of this run, which is also that of its processor.
    pub(crate) number: usize,
    /// Further options of `cellcaster-server`.
    pub(crate) options: &'a [String],
}

/// How a client is let in.
#[derive(Clone, Debug)]
pub(crate) enum Access {
    /// As a guest.
    Guest,
    /// With the private key in a file.
    Key { user: String, file: PathBuf },
}

impl ServerProcess {
    pub(crate) fn start(setup: &Setup) -> Result<Self, Box<dyn Error>> {
        let folder = folder(setup.number)?;
        let config = folder.join("serve.toml");
        let most = setup.connections + 100;
        // A port that is free now.
        let metrics = TcpListener::bind("127.0.0.1:0")?.local_addr()?;
        fs::write(
            &config,
            format!(
                "connections = {most}\nconnections-per-address = {most}\nstartups = {most}\n\
                 stall-seconds = 600\n\
                 [metrics]\nlisten = \"{metrics}\"\n"
            ),
        )?;
        let mut child = Command::new("taskset")
            .args(["-c", &processor(setup.number).to_string(), setup.program])
            .args(["serve", "--listen", "127.0.0.1:0", "--data"])
            .args([&folder])
            .arg("--config")
            .arg(&config)
            .args(setup.options)
            .stdout(Stdio::piped())
            .spawn()?;
        let mut line = String::new();
        BufReader::new(child.stdout.take().ok_or("no output")?).read_line(&mut line)?;
        let address = line.strip_prefix("Listening at ").and_then(|it| it.split(';').next());
        let address = address.ok_or("the server does not listen")?.parse()?;
        Ok(Self { child, folder, address, metrics: Some(metrics), access: Access::Guest })
    }

    /// The number of its process.
    pub(crate) fn id(&self) -> u32 {
        self.child.id()
    }

    /// What the server has used so far.
    pub(crate) fn usage(&self) -> Usage {
        Usage::of(self.child.id())
    }
}

/// The processor of a server: they take turns.
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
