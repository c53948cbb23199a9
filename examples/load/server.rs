//! The server as a process of its own.

use std::error::Error;
use std::fs;
use std::io::{BufRead, BufReader};
use std::net::{SocketAddr, TcpListener};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};

use crate::process::Usage;

/// A server that runs until this is dropped.
pub(crate) struct ServerProcess {
    pub(super) child: Child,
    pub(super) folder: PathBuf,
    pub(crate) address: SocketAddr,
    /// Where its metrics are; `None` if it has none.
    pub(crate) metrics: Option<SocketAddr>,
    pub(crate) access: Access,
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
    pub(crate) fn start(program: &str, connections: usize) -> Result<Self, Box<dyn Error>> {
        let folder = folder()?;
        let config = folder.join("serve.toml");
        let most = connections + 100;
        // A port that is free now.
        let metrics = TcpListener::bind("127.0.0.1:0")?.local_addr()?;
        fs::write(
            &config,
            format!(
                "connections = {most}\nconnections-per-address = {most}\nstartups-begin = {most}\n\
                 startups-full = {most}\nstartups-per-network = {most}\nstall-seconds = 600\n\
                 [metrics]\nlisten = \"{metrics}\"\n"
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

/// A folder for the files of a server.
pub(crate) fn folder() -> Result<PathBuf, Box<dyn Error>> {
    let folder = std::env::temp_dir().join(format!("cellcaster-load-{}", std::process::id()));
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
