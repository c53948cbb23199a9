//! System calls that fail one after the other: `strace` counts the calls that touch certain files,
//! and makes one of them fail.
//!
//! A call that fails is not executed. Two calls are therefore excluded. On Linux, `close` closes a
//! file even if it reports a failure. Only debug builds of the standard library call `fcntl` with
//! `F_GETFD`.
#![allow(dead_code, reason = "every test file uses its own share of this")]

use std::collections::BTreeMap;
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, kill_process};

/// The longest wait for the end of the log.
const TIMEOUT: Duration = Duration::from_secs(20);

/// The `number`th call with this name in each thread, counted from 1, and its error.
#[derive(Clone, Debug)]
pub(crate) struct Failure {
    pub(crate) call: String,
    pub(crate) error: &'static str,
    pub(crate) number: u32,
}

/// The calls of a program that touch certain files.
pub(crate) struct Traced {
    log: PathBuf,
    options: Vec<String>,
}

/// A program that is watched from a certain moment until it ends or until this value is dropped.
pub(crate) struct Attached(Child);

impl Traced {
    /// Watches the calls that touch `paths`, one of which may fail. The log is a new file beside
    /// `folder`.
    pub(crate) fn new(folder: &Path, paths: &[PathBuf], failure: Option<&Failure>) -> Self {
        let log = folder.with_extension("calls");
        _ = fs::remove_file(&log);
        let mut options = vec!["-f".to_owned(), "-o".to_owned(), text(&log)];
        options.extend(paths.iter().flat_map(|path| ["-P".to_owned(), text(path)]));
        if let Some(Failure { call, error, number }) = failure {
            options.push("-e".to_owned());
            options.push(format!("inject={call}:error={error}:when={number}"));
        }
        Self { log, options }
    }

    /// The words to put in front of the program's words, so that the program is watched.
    pub(crate) fn words(&self) -> Vec<&str> {
        // With `-D`, the process id belongs to the program.
        let first = ["strace", "-D", "-q"].into_iter();
        first.chain(self.options.iter().map(String::as_str)).collect()
    }

    /// Watches a program that is already running.
    pub(crate) fn attach(&self, process: u32) -> Attached {
        let mut command = Command::new("strace");
        command.args(&self.options).args(["-p", &process.to_string()]);
        let mut strace = command.stderr(Stdio::piped()).spawn().unwrap();
        let mut lines = BufReader::new(strace.stderr.take().unwrap()).lines();
        let said = lines.next().expect("strace attaches").unwrap();
        assert!(said.contains(" attached"), "{said}");
        // Threads that start later are announced, too.
        thread::spawn(move || lines.for_each(drop));
        Attached(strace)
    }

    /// The log, once `process` has ended.
    fn text(&self, process: u32) -> String {
        let deadline = Instant::now() + TIMEOUT;
        loop {
            let text = fs::read_to_string(&self.log).unwrap_or_default();
            let ends = |line: &str| {
                let (number, rest) = line.split_once(' ').unwrap_or_default();
                number == process.to_string() && rest.trim_start().starts_with("+++")
            };
            if text.lines().any(ends) {
                return text;
            }
            assert!(Instant::now() < deadline, "no end of {process} in the log:\n{text}");
            thread::sleep(Duration::from_millis(5));
        }
    }

    /// The number of times that each call that may fail was made, in the thread that made it most
    /// often.
    pub(crate) fn counts(&self, process: u32) -> BTreeMap<String, u32> {
        let mut counts = BTreeMap::<(&str, &str), u32>::new();
        let text = self.text(process);
        for line in text.lines() {
            let Some((thread, call)) = line.split_once(' ') else { continue };
            let Some((name, arguments)) = call.trim_start().split_once('(') else { continue };
            let is_name = name.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_');
            if is_name && name != "close" && !arguments.contains("F_GETFD") {
                *counts.entry((thread, name)).or_default() += 1;
            }
        }
        let mut most = BTreeMap::new();
        for ((_, name), count) in counts {
            let known: &mut u32 = most.entry(name.to_owned()).or_default();
            *known = count.max(*known);
        }
        most
    }

    /// Returns whether an injected failure has happened.
    pub(crate) fn has_failed(&self, process: u32) -> bool {
        self.text(process).contains("(INJECTED)")
    }
}

/// The failures of `counts`: each call that was made, with each of its possible errors in turn.
pub(crate) fn failures(counts: &BTreeMap<String, u32>) -> Vec<Failure> {
    let of_call = |(call, &count): (&String, &u32)| {
        let (call, errors) = (call.clone(), errors_of(call));
        (1..=count).map(move |number| {
            let error = errors[number as usize % errors.len()];
            Failure { call: call.clone(), error, number }
        })
    };
    counts.iter().flat_map(of_call).collect()
}

impl Drop for Attached {
    fn drop(&mut self) {
        // On this signal, strace detaches and the program continues.
        let id = Pid::from_child(&self.0);
        _ = kill_process(id, Signal::TERM);
        _ = self.0.wait();
    }
}

fn errors_of(call: &str) -> &'static [&'static str] {
    match call {
        "openat" => &["EMFILE", "EIO", "EINTR"],
        "read" | "pread64" => &["EIO", "EINTR"],
        "write" | "pwrite64" => &["ENOSPC", "EIO", "EINTR"],
        "ftruncate" | "fallocate" | "mkdir" | "rename" | "link" => &["ENOSPC", "EIO"],
        "flock" | "fcntl" => &["ENOLCK", "EINTR"],
        "fchmod" | "chmod" | "fchown" => &["EPERM"],
        "mmap" => &["ENOMEM"],
        _ => &["EIO"],
    }
}

fn text(path: &Path) -> String {
    path.to_str().unwrap().to_owned()
}
