//! A PostgreSQL server for a single test, which ends with the test.
//!
//! The programs come from Debian's package `postgresql`, or from the path. PostgreSQL refuses to run as root,
//! so under root it runs as the user `postgres`.
#![allow(dead_code, reason = "every test program uses its own share of this")]

use std::fs;
use std::net::{Ipv4Addr, TcpListener};
use std::os::unix::fs::chown;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU32, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// Long enough for a machine under load.
const TIMEOUT: Duration = Duration::from_mins(1);
const USER: &str = "postgres";

/// A server, its folder, and a watcher process that kills the server and removes the folder when this process ends.
pub(crate) struct PostgresServer {
    folder: PathBuf,
    port: u16,
    /// The watcher exits when its input closes, so it must be kept.
    _watcher: Child,
}

impl PostgresServer {
    /// A server shared by the tests of this process that do not disturb it. It does not sync to disk.
    pub(crate) fn shared() -> &'static Self {
        static SHARED: OnceLock<PostgresServer> = OnceLock::new();
        SHARED.get_or_init(|| Self::with("fsync = off", "", |_| {}))
    }

    /// A server for a single test.
    pub(crate) fn start() -> Self {
        Self::with("", "", |_| {})
    }

    /// A server for a single test, at an address of this machine.
    pub(crate) fn start_at(address: Ipv4Addr) -> Self {
        let access = "host all all 10.0.0.0/8 trust\n";
        Self::with(&format!("listen_addresses = '{address}'"), access, |_| {})
    }

    /// A server for a single test that accepts only encrypted connections, with its own
    /// [certificate](Self::certificate) for 127.0.0.1.
    pub(crate) fn start_encrypted() -> Self {
        let access = "hostnossl all all 127.0.0.1/32 reject\n";
        Self::with("ssl = on", access, |data| {
            let mut openssl = command("openssl", data);
            openssl.args(["req", "-x509", "-newkey", "ec", "-pkeyopt"]);
            openssl.args(["ec_paramgen_curve:prime256v1", "-nodes", "-days", "2"]);
            openssl.args(["-subj", "/CN=cellcaster", "-addext", "subjectAltName=IP:127.0.0.1"]);
            openssl.args(["-addext", "basicConstraints=critical,CA:FALSE"]);
            run(openssl.args(["-keyout", "server.key", "-out", "server.crt"]));
        })
    }

    /// A server with additional settings and access rules. `prepare` runs on its data folder before the start.
    fn with(settings: &str, rules: &str, prepare: impl FnOnce(&Path)) -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let folder = std::env::temp_dir()
            .join(format!("cellcaster-postgres-{}-{number}", std::process::id()));
        fs::create_dir(&folder).unwrap();
        if let Some((user, group)) = owner() {
            chown(&folder, Some(user), Some(group)).unwrap();
        }
        let path = folder.display();
        let script = format!(
            "trap '' INT TERM HUP; read _; kill -9 $(head -n 1 {path}/data/postmaster.pid); sleep 1; \
             rm -rf {path}"
        );
        let mut watching = command("sh", &folder);
        watching.arg("-c").arg(script).stdin(Stdio::piped()).stdout(Stdio::null());
        let watcher = watching.stderr(Stdio::null()).spawn().unwrap();
        let data = folder.join("data");
        let mut initdb = command("initdb", &folder);
        run(initdb
            .args(["-U", USER, "-A", "trust", "-E", "UTF8", "--locale=C", "--no-sync", "-D"])
            .arg(&data));
        let port = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
        let configuration = format!(
            "listen_addresses = '127.0.0.1'\nport = {port}\nunix_socket_directories = '{path}'\n\
             max_connections = 60\n{settings}\n"
        );
        fs::write(data.join("postgresql.auto.conf"), configuration).unwrap();
        let access = data.join("pg_hba.conf");
        let trusting = fs::read_to_string(&access).unwrap();
        fs::write(
            &access,
            format!("{rules}host all guarded 127.0.0.1/32 scram-sha-256\n{trusting}"),
        )
        .unwrap();
        prepare(&data);
        let server = Self { folder, port, _watcher: watcher };
        server.restart();
        server
    }

    /// The port on 127.0.0.1. There, the role `guarded` needs its password.
    pub(crate) fn port(&self) -> u16 {
        self.port
    }

    /// The address of a new empty schema in the server, over its Unix socket.
    pub(crate) fn address(&self) -> String {
        let socket = self.folder.display().to_string().replace('/', "%2F");
        let Self { port, .. } = self;
        format!("postgres://{USER}@{socket}:{port}/postgres?{}", self.new_place())
    }

    /// The address of a new empty schema, over TCP.
    pub(crate) fn address_over_tcp(&self) -> String {
        self.address_at(Ipv4Addr::LOCALHOST)
    }

    /// The address of a new empty schema, over TCP at the address on which the server was started.
    pub(crate) fn address_at(&self, address: Ipv4Addr) -> String {
        let Self { port, .. } = self;
        format!("postgres://{USER}@{address}:{port}/postgres?{}", self.new_place())
    }

    /// Creates a schema; returns it as an option for an address.
    fn new_place(&self) -> String {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let name = format!("place_{}", COUNT.fetch_add(1, Ordering::Relaxed));
        self.sql(&format!("CREATE SCHEMA {name}"));
        format!("options=-c%20search_path%3D{name}")
    }

    /// The certificate of an encrypted server.
    pub(crate) fn certificate(&self) -> PathBuf {
        self.folder.join("data/server.crt")
    }

    /// Runs statements with `psql`; returns its output.
    pub(crate) fn sql(&self, sql: &str) -> String {
        let mut psql = command("psql", &self.folder);
        psql.args(["-X", "-q", "-A", "-t", "-v", "ON_ERROR_STOP=1", "-U", USER, "-d", "postgres"]);
        psql.arg("-h").arg(&self.folder).arg("-p").arg(self.port.to_string());
        run(psql.arg("-c").arg(sql))
    }

    /// Kills all processes of the server, as in a crash.
    pub(crate) fn crash(&self) {
        self.signal("-KILL");
        let postmaster = self.postmaster();
        let start = Instant::now();
        while Path::new("/proc").join(&postmaster).exists() {
            assert!(start.elapsed() < TIMEOUT, "the server does not end");
            thread::sleep(Duration::from_millis(10));
        }
    }

    /// Starts the server, and waits until it answers.
    pub(crate) fn restart(&self) {
        let mut start = command("pg_ctl", &self.folder);
        start.arg("start").arg("-w").args(["-t", &TIMEOUT.as_secs().to_string()]);
        start.arg("-D").arg(self.folder.join("data")).arg("-l").arg(self.folder.join("log"));
        // The server inherits the output and does not exit, so the output cannot be captured.
        let status = start.stdout(Stdio::null()).stderr(Stdio::null()).status();
        assert!(status.unwrap().success(), "the server does not start");
    }

    /// Freezes the server until [`resume`](Self::resume): it neither answers nor closes its connections.
    pub(crate) fn pause(&self) {
        self.signal("-STOP");
    }

    /// Ends a pause.
    pub(crate) fn resume(&self) {
        self.signal("-CONT");
    }

    /// Sends a signal to all processes of the server.
    fn signal(&self, signal: &str) {
        let postmaster = self.postmaster();
        let children = format!("/proc/{postmaster}/task/{postmaster}/children");
        let children = fs::read_to_string(children).unwrap_or_default();
        let processes = [postmaster.as_str()].into_iter().chain(children.split_whitespace());
        // One of the processes may have exited meanwhile.
        _ = Command::new("kill").arg(signal).args(processes).stderr(Stdio::null()).status();
    }

    fn postmaster(&self) -> String {
        let file = fs::read_to_string(self.folder.join("data/postmaster.pid")).unwrap();
        file.lines().next().unwrap().to_owned()
    }
}

/// The user and the group under which root runs the server; `None` if this user is not root.
fn owner() -> Option<(u32, u32)> {
    let id = |arguments: &[&str]| -> u32 {
        run(Command::new("id").args(arguments)).trim().parse().unwrap()
    };
    (id(&["-u"]) == 0).then(|| (id(&["-u", USER]), id(&["-g", USER])))
}

/// A command that runs a program of PostgreSQL or of the system, as the server's user.
fn command(program: &str, folder: &Path) -> Command {
    let installed = fs::read_dir("/usr/lib/postgresql").into_iter().flatten().flatten();
    let mut installed = installed.map(|version| version.path().join("bin").join(program));
    let path = installed.find(|path| path.exists()).unwrap_or(program.into());
    let mut command = if owner().is_some() {
        let mut command = Command::new("setpriv");
        command.args(["--reuid", USER, "--regid", USER, "--clear-groups"]).arg(path);
        command
    } else {
        Command::new(path)
    };
    command.current_dir(folder).stdin(Stdio::null());
    command
}

/// Runs a program, asserts success, and returns its output.
fn run(command: &mut Command) -> String {
    let output = command.stderr(Stdio::piped()).output().expect("PostgreSQL is installed");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?} failed: {said}");
    String::from_utf8(output.stdout).unwrap()
}
