//! OpenSSH's server, with one process of the game for each session.

use std::error::Error;
use std::fs;
use std::net::{TcpListener, TcpStream};
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use super::server::{Access, ServerProcess};

const PATIENCE: Duration = Duration::from_secs(10);

/// Starts a server whose only command is the game on the level on which visitors of the other server
/// walk.
pub(crate) fn start(program: &str) -> Result<ServerProcess, Box<dyn Error>> {
    let folder = super::server::folder(0)?;
    // Where sshd is started by root, it wants this to exist.
    _ = fs::create_dir_all("/run/sshd");
    for key in ["host_key", "user_key"] {
        let file = folder.join(key);
        Command::new("ssh-keygen")
            .args(["-q", "-t", "ed25519", "-N", "", "-f"])
            .arg(file)
            .status()?;
    }
    let port = TcpListener::bind(("127.0.0.1", 0))?.local_addr()?.port();
    let program = fs::canonicalize(program)?;
    fs::write(folder.join("config"), configuration(&folder, &program, port))?;
    let child = Command::new("taskset")
        .args(["-c", "0", "/usr/sbin/sshd", "-D", "-e", "-f"])
        .arg(folder.join("config"))
        .stdin(Stdio::null())
        .stderr(fs::File::create(folder.join("log"))?)
        .spawn()?;
    let server = ServerProcess {
        child,
        address: ([127, 0, 0, 1], port).into(),
        metrics: None,
        access: Access::Key { user: user()?, file: folder.join("user_key") },
        folder,
    };
    wait_for(port)?;
    Ok(server)
}

fn user() -> Result<String, Box<dyn Error>> {
    Ok(String::from_utf8(Command::new("id").arg("-un").output()?.stdout)?.trim().to_owned())
}

fn wait_for(port: u16) -> Result<(), Box<dyn Error>> {
    let deadline = Instant::now() + PATIENCE;
    while TcpStream::connect(("127.0.0.1", port)).is_err() {
        if Instant::now() > deadline {
            return Err("sshd does not listen".into());
        }
        thread::sleep(Duration::from_millis(20));
    }
    Ok(())
}

fn configuration(folder: &Path, program: &Path, port: u16) -> String {
    let (folder, program) = (folder.display(), program.display());
    format!(
        "ListenAddress 127.0.0.1\nPort {port}\nHostKey {folder}/host_key\n\
         AuthorizedKeysFile {folder}/user_key.pub\nPidFile none\nUsePAM no\nStrictModes no\n\
         PermitRootLogin yes\nMaxStartups 1000\nAcceptEnv COLORTERM\nSetEnv HOME={folder}\n\
         ForceCommand {program} museum\n"
    )
}
