//! Real SSH sessions that play on one server, and what they cost.
//!
//! ```text
//! cargo run --release --features serve --example load -- --sessions 100 --seconds 20
//! ```
//!
//! The server is a process of its own on processor 0, and all clients are in this process on
//! processor 1. Each client walks about a room, answers the terminal's queries, counts frames and
//! bytes, and measures the time from a key to the next bytes. `--silent N` adds connections that never
//! read. `--server PATH` is the program, `target/release/cellcaster` otherwise. `--sshd` measures OpenSSH's
//! server with one process of the game for each session in place of `cellcaster serve`.
//!
//! `--soak` lets clients come, walk, talk, resize their windows and leave in several ways, by `--seed`,
//! and prints ten times what the server holds.

mod client;
mod process;
mod report;
mod server;
mod soak;
mod sshd;
mod wanderer;

use std::error::Error;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use tokio::runtime::Builder;
use tokio::task::JoinSet;
use tokio::time::sleep;

use report::{Report, Tally};
use server::ServerProcess;

/// What to do.
struct Plan {
    sessions: usize,
    silent: usize,
    uses_sshd: bool,
    seconds: u64,
    server: String,
    answer_delay: Duration,
}

/// The time between two connections.
const PAUSE: Duration = Duration::from_millis(25);
/// The time that the sessions have for entering their rooms.
const WARM_UP: Duration = Duration::from_secs(8);

fn main() -> Result<(), Box<dyn Error>> {
    if std::env::args().any(|it| it == "--soak") {
        return soak::run();
    }
    let plan = plan()?;
    process::pin(std::process::id(), 1);
    let server = if plan.uses_sshd {
        sshd::start(&plan.server)?
    } else {
        ServerProcess::start(&plan.server, plan.sessions + plan.silent)?
    };
    let runtime = Builder::new_current_thread().enable_all().build()?;
    runtime.block_on(run(&plan, &server))
}

async fn run(plan: &Plan, server: &ServerProcess) -> Result<(), Box<dyn Error>> {
    let counts = Arc::new(AtomicBool::new(false));
    let mut clients = JoinSet::new();
    let empty = server.usage();
    for number in 0..plan.sessions {
        let counts = counts.clone();
        let (address, access, delay) = (server.address, server.access.clone(), plan.answer_delay);
        clients.spawn(async move {
            let played = client::play(address, &access, number as u64, delay, &counts);
            played.await.map_err(|it| it.to_string())
        });
        sleep(PAUSE).await;
    }
    if plan.sessions > 0 {
        sleep(WARM_UP).await;
    }
    let walking = server.usage();
    let mut silent = Vec::new();
    for _ in 0..plan.silent {
        silent.push(client::never_read(server.address, &server.access).await?);
    }
    sleep(Duration::from_secs(2)).await;
    let before = server.usage();
    counts.store(true, Ordering::Release);
    sleep(Duration::from_secs(plan.seconds)).await;
    counts.store(false, Ordering::Release);
    let after = server.usage();
    let tallies = ended(clients).await;
    println!(
        "memory        {} MB empty, {} MB with {} sessions, {} MB at the end",
        empty.megabytes, walking.megabytes, plan.sessions, after.megabytes
    );
    Report::new(&tallies, plan.seconds, after.processor.saturating_sub(before.processor)).print();
    Ok(())
}

/// What the clients have counted.
async fn ended(mut clients: JoinSet<Result<Tally, String>>) -> Vec<Tally> {
    let mut tallies = Vec::new();
    while let Some(client) = clients.join_next().await {
        match client {
            Ok(Ok(tally)) => tallies.push(tally),
            Ok(Err(error)) => eprintln!("a client failed: {error}"),
            Err(error) => eprintln!("a client failed: {error}"),
        }
    }
    tallies
}

fn plan() -> Result<Plan, Box<dyn Error>> {
    let mut plan = Plan {
        sessions: 20,
        silent: 0,
        uses_sshd: false,
        seconds: 10,
        server: "target/release/cellcaster".to_owned(),
        answer_delay: Duration::ZERO,
    };
    let mut arguments = std::env::args().skip(1);
    while let Some(name) = arguments.next() {
        if name == "--sshd" {
            plan.uses_sshd = true;
            continue;
        }
        let value = arguments.next().ok_or_else(|| format!("{name} needs a value"))?;
        match name.as_str() {
            "--sessions" => plan.sessions = value.parse()?,
            "--silent" => plan.silent = value.parse()?,
            "--seconds" => plan.seconds = value.parse()?,
            "--server" => plan.server = value,
            "--answer-delay" => plan.answer_delay = Duration::from_millis(value.parse()?),
            _ => return Err(format!("there is no option {name}").into()),
        }
    }
    Ok(plan)
}
