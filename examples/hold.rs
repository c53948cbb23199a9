//! The cost of a game's process, at 20 frames a second.
//!
//! ```text
//! cargo build --release
//! cargo run --release --example hold -- right 80x24 citadel
//! ```
//!
//! Plays a level in a pseudo-terminal that answers like a terminal with the kitty keyboard
//! protocol. The first argument is the held key: `right`, `left`, `up`, `down`, or `none`. Prints
//! frames and bytes, processor time, and the number of times that the process has waited, from
//! `/proc`.

#[cfg(unix)]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    unix::main()
}

#[cfg(not(unix))]
fn main() {
    eprintln!("There are no pseudo-terminals here.");
}

#[cfg(unix)]
mod unix {
    use std::env;
    use std::error::Error;
    use std::fs;
    use std::io::{Read, Write};
    use std::sync::Arc;
    use std::sync::atomic::{AtomicU64, Ordering};
    use std::thread;
    use std::time::{Duration, Instant};

    use pty_process::Size;
    use pty_process::blocking::{Command, Pty};

    const PROGRAM: &str = "target/release/cellcaster";
    const FRAMES_PER_SECOND: &str = "20";
    /// The time before a key is pressed, the time from then until the measurement begins, and the
    /// duration of the measurement.
    const START: Duration = Duration::from_secs(1);
    const WARM_UP: Duration = Duration::from_secs(1);
    const MEASURED: Duration = Duration::from_secs(20);

    /// Queries, and the terminal's answers.
    const ANSWERS: [(&[u8], &[u8]); 3] =
        [(b"\x1b[5n", b"\x1b[0n"), (b"\x1b[c", b"\x1b[?62c"), (b"\x1b[?u", b"\x1b[?0u")];
    const END_OF_FRAME: &[u8] = b"\x1b[?2026l";

    /// Counts of the frames and bytes that the program has sent.
    #[derive(Debug, Default)]
    struct Received {
        frames: AtomicU64,
        bytes: AtomicU64,
    }

    /// The resources that a process has used.
    struct Usage {
        processor: Duration,
        waits: u64,
    }

    pub(crate) fn main() -> Result<(), Box<dyn Error>> {
        let arguments: Vec<String> = env::args().skip(1).collect();
        let [key, size, map] = &arguments[..] else { return Err("KEY COLSxROWS MAP".into()) };
        let press = match &**key {
            "up" => "\x1b[1;1:1A",
            "down" => "\x1b[1;1:1B",
            "right" => "\x1b[1;1:1C",
            "left" => "\x1b[1;1:1D",
            "none" => "",
            _ => return Err(format!("there is no key {key}").into()),
        };
        let (columns, rows) = size.split_once('x').ok_or("a size is COLSxROWS")?;
        let (pty, terminal) = pty_process::blocking::open()?;
        pty.resize(Size::new(rows.parse()?, columns.parse()?))?;
        let mut child = Command::new(PROGRAM)
            .args(["play", map, "--fps", FRAMES_PER_SECOND])
            .env_clear()
            .envs([("TERM", "xterm-256color"), ("COLORTERM", "truecolor"), ("LANG", "C.UTF-8")])
            .spawn(terminal)?;
        let pty = Arc::new(pty);
        let received = Arc::new(Received::default());
        thread::spawn({
            let (pty, received) = (Arc::clone(&pty), Arc::clone(&received));
            move || receive(&pty, &received)
        });
        thread::sleep(START);
        (&*pty).write_all(press.as_bytes())?;
        thread::sleep(WARM_UP);
        let counts = || [&received.frames, &received.bytes].map(|it| it.load(Ordering::Relaxed));
        let (begun, before, used) = (Instant::now(), counts(), Usage::of(child.id())?);
        thread::sleep(MEASURED);
        let (seconds, now, usage) = (begun.elapsed(), counts(), Usage::of(child.id())?);
        child.kill()?;
        child.wait()?;
        let [frames, bytes] = [0, 1].map(|index| (now[index] - before[index]) as f64);
        let processor = usage.processor.saturating_sub(used.processor).as_secs_f64();
        let per_second = |count: f64| count / seconds.as_secs_f64();
        println!(
            "frames     {:.1} a second, of {:.0} bytes",
            per_second(frames),
            bytes / frames.max(1.0)
        );
        println!("waits      {:.1} a second", per_second((usage.waits - used.waits) as f64));
        println!(
            "processor  {:.2} ms a second, {:.0} µs a frame",
            per_second(processor * 1e3),
            processor * 1e6 / frames.max(1.0)
        );
        Ok(())
    }

    /// Counts frames, and answers queries. Misses a query that is split between two reads, which
    /// the program tolerates.
    fn receive(pty: &Pty, received: &Received) {
        let mut buffer = vec![0; 1 << 16];
        while let Ok(count @ 1..) = (&*pty).read(&mut buffer) {
            let bytes = &buffer[..count];
            let ends = bytes.windows(END_OF_FRAME.len()).filter(|it| *it == END_OF_FRAME);
            received.frames.fetch_add(ends.count() as u64, Ordering::Relaxed);
            received.bytes.fetch_add(count as u64, Ordering::Relaxed);
            let mut answers = Vec::new();
            for start in 0..count {
                let query = ANSWERS.iter().find(|it| bytes[start..].starts_with(it.0));
                answers.extend_from_slice(query.map_or(b"", |it| it.1));
            }
            if (&*pty).write_all(&answers).is_err() {
                return;
            }
        }
    }

    impl Usage {
        /// The usage of all threads of a process.
        fn of(process: u32) -> Result<Self, Box<dyn Error>> {
            let (mut nanoseconds, mut waits) = (0, 0);
            for task in fs::read_dir(format!("/proc/{process}/task"))? {
                let folder = task?.path();
                let times = fs::read_to_string(folder.join("schedstat"))?;
                nanoseconds += times.split(' ').next().ok_or("no time")?.parse::<u64>()?;
                let status = fs::read_to_string(folder.join("status"))?;
                let count = status
                    .lines()
                    .find_map(|line| line.strip_prefix("voluntary_ctxt_switches:"))
                    .ok_or("no count of waits")?;
                waits += count.trim().parse::<u64>()?;
            }
            Ok(Self { processor: Duration::from_nanos(nanoseconds), waits })
        }
    }
}
