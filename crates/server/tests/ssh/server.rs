//! An sshd on this machine that runs the game for guests.

use std::fs;
use std::io::Read;
use std::net::{TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// Long enough for a machine under load.
const TIMEOUT: Duration = Duration::from_secs(20);

/// A server and the folder with its keys.
pub(crate) struct Server {
    sshd: Child,
    port: u16,
    folder: PathBuf,
}

impl Server {
    /// Starts a server that runs only one command: the program with the arguments `game`, and then a shell
    /// that prints its input.
    pub(crate) fn start(game: &str) -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let name = format!("ssh-{}", COUNT.fetch_add(1, Ordering::Relaxed));
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        // Left over from an interrupted run.
        _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        // If root starts sshd, it requires this folder.
        _ = fs::create_dir_all("/run/sshd");
        for key in ["host_key", "user_key"] {
            let status = Command::new("ssh-keygen")
                .args(["-q", "-t", "ed25519", "-N", "", "-f"])
                .arg(folder.join(key))
                .status();
            assert!(status.unwrap().success());
        }
        let port = free_port();
        fs::write(folder.join("game.sh"), script(&folder, game)).unwrap();
        fs::write(folder.join("sshd_config"), configuration(&folder, port)).unwrap();
        let log = fs::File::create(folder.join("log")).unwrap();
        let sshd = Command::new("/usr/sbin/sshd")
            .args(["-D", "-e", "-f"])
            .arg(folder.join("sshd_config"))
            .stdin(Stdio::null())
            .stderr(log)
            .spawn()
            .expect("openssh-server is installed");
        let server = Self { sshd, port, folder };
        server.wait_until_it_answers();
        server
    }

    pub(crate) fn port(&self) -> u16 {
        self.port
    }

    /// The arguments with which `ssh` connects to `port`.
    pub(crate) fn client_arguments(&self, port: u16) -> Vec<String> {
        let user = Command::new("id").arg("-un").output().unwrap().stdout;
        let user = String::from_utf8(user).unwrap();
        let key = self.folder.join("user_key").display().to_string();
        let fixed = "-tt -F none -o StrictHostKeyChecking=no -o UserKnownHostsFile=/dev/null \
                     -o LogLevel=ERROR -i";
        let rest = [key, "-p".to_owned(), port.to_string(), format!("{}@127.0.0.1", user.trim())];
        fixed.split_whitespace().map(str::to_owned).chain(rest).collect()
    }

    /// The id of the process that runs the game.
    pub(crate) fn game(&self) -> u32 {
        fs::read_to_string(self.folder.join("game")).unwrap().trim().parse().unwrap()
    }

    /// Returns true while a client is connected.
    pub(crate) fn has_sessions(&self) -> bool {
        let sshd = self.sshd.id();
        let children = fs::read_to_string(format!("/proc/{sshd}/task/{sshd}/children"));
        !children.unwrap().trim().is_empty()
    }

    fn wait_until_it_answers(&self) {
        let deadline = Instant::now() + TIMEOUT;
        let answers = || {
            let mut greeting = [0; 4];
            let stream = TcpStream::connect(("127.0.0.1", self.port));
            stream.and_then(|mut stream| stream.read_exact(&mut greeting)).is_ok()
        };
        while !answers() {
            let log = || fs::read_to_string(self.folder.join("log")).unwrap_or_default();
            assert!(Instant::now() < deadline, "sshd never answered: {}", log());
            thread::sleep(Duration::from_millis(20));
        }
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        // sshd has not exited by itself, so only the folder remains to be cleaned up.
        _ = self.sshd.kill();
        _ = self.sshd.wait();
        _ = fs::remove_dir_all(&self.folder);
    }
}

/// A free port. Most likely, no other process takes it before sshd does.
fn free_port() -> u16 {
    TcpListener::bind(("127.0.0.1", 0)).unwrap().local_addr().unwrap().port()
}

fn configuration(folder: &Path, port: u16) -> String {
    let folder = folder.display();
    format!(
        "ListenAddress 127.0.0.1\nPort {port}\nHostKey {folder}/host_key\n\
         AuthorizedKeysFile {folder}/user_key.pub\nPidFile none\nUsePAM no\nStrictModes no\n\
         PermitRootLogin yes\nCompression yes\n\
         ClientAliveInterval 2\nClientAliveCountMax 3\nForceCommand /bin/sh {folder}/game.sh\n"
    )
}

/// A script that plays the game and then prints the input that a shell would find.
fn script(folder: &Path, game: &str) -> String {
    let (folder, program) = (folder.display(), game_program().display().to_string());
    format!(
        "export HOME={folder}\n\
         sh -c 'echo $$ > {folder}/game; exec {program} {game}'; status=$?\n\
         stty -icanon -echo min 0 time 5\n\
         printf 'the shell has read: \"%s\"\\r\\n' \"$(dd bs=100 count=1 2>/dev/null | od -An -c)\"\n\
         exit $status\n"
    )
}

/// The path of the game's program, which is built next to the server's.
fn game_program() -> PathBuf {
    let server = PathBuf::from(env!("CARGO_BIN_EXE_cellcaster-server"));
    server.with_file_name("cellcaster")
}
