//! `cellcaster-lab load`: real SSH sessions that play on one or more servers, and their cost.
//!
//! ```text
//! cargo build --release --workspace
//! target/release/cellcaster-lab load --sessions 100 --seconds 20
//! ```
//!
//! The server is a separate process on processor 0, and all clients are in this process on
//! processor 1. Each client walks about in a room, and answers the terminal's queries. The figures are
//! the server's own metrics. `--silent N` adds connections that never read. `--server PATH` names the
//! program; the default is `cellcaster-server` beside this one.
//!
//! `--browsers N` also measures before that, for as long, while N browsers watch the room with the most players. It
//! prints the share of the processor that they add.
//!
//! `--table` measures one server with more and more players, at 20 and at 10 frames a second, and
//! prints a table. `--update PAGE` writes the table to a page.
//!
//! `--hosts N --cluster NATS --store POSTGRES` starts several hosts of a cluster. They are assigned
//! to the processors in turn, while the clients run on all processors. Clients are spread over the
//! hosts in turn, so each room has members on all hosts, which is the most expensive case.
//! `--beside PID` measures another process, such as the NATS server, and may be repeated.
//!
//! `--bus ROOMS --cluster NATS` writes the logs of rooms without hosts and players, and measures
//! how long the bus takes for a message.
//!
//! `--soak` makes clients come, walk, talk, resize their windows and leave in several ways, chosen
//! by `--seed`. It reports the server's resources ten times.

mod browser;
mod bus;
mod client;
mod plan;
mod report;
mod server;
mod soak;
mod table;
#[path = "../../server/tests/support/wanderer.rs"]
mod wanderer;

use std::time::Duration;

use tokio::runtime::Builder;
use tokio::task::JoinSet;
use tokio::time::sleep;

use browser::Browsers;
use cellcaster::cli::Error;
pub(crate) use plan::Load;
use report::{Figures, Samples};
use server::{ServerProcess, Usage, between, pin};

/// The time between two connections.
const PAUSE: Duration = Duration::from_millis(25);
/// The time for the sessions to enter their rooms.
const WARM_UP: Duration = Duration::from_secs(8);

/// Makes the measurement that `plan` requests.
///
/// # Errors
/// If a server cannot be started, or a client cannot connect.
pub(crate) fn run(plan: &Load) -> Result<(), Error> {
    measure(plan).map_err(|error| Error::machine(error.to_string()))
}

fn measure(plan: &Load) -> Result<(), Box<dyn std::error::Error>> {
    if plan.soak {
        return soak::run(plan);
    }
    if plan.table {
        return table::run(plan);
    }
    if let Some(rooms) = plan.rooms {
        return bus::run(rooms, plan);
    }
    if plan.hosts > 1 && (plan.cluster.is_none() || plan.store.is_none()) {
        return Err("--hosts above 1 needs --cluster and --store".into());
    }
    let measured = play_all(plan)?;
    println!(
        "memory        {:.1} MB empty, {:.1} MB with {} sessions, {:.1} MB at the end",
        measured.megabytes[0], measured.megabytes[1], plan.sessions, measured.megabytes[2]
    );
    measured.figures.print();
    plan.print_others(&measured.others);
    if let Some(browsers) = &measured.browsers {
        browsers.print(&measured.figures);
    }
    Ok(())
}

/// The result of a measurement.
struct Measured {
    figures: Figures,
    /// The memory of the servers: empty, with the sessions that play, and at the end.
    megabytes: [f64; 3],
    /// The time that the other processes have used.
    others: Vec<Duration>,
    browsers: Option<Browsers>,
}

/// Starts the servers, and plays on them.
fn play_all(plan: &Load) -> Result<Measured, Box<dyn std::error::Error>> {
    let servers = start(plan)?;
    if servers.len() == 1 {
        pin(std::process::id(), 1);
    }
    let runtime = Builder::new_current_thread().enable_all().build()?;
    runtime.block_on(play(plan, &servers))
}

fn start(plan: &Load) -> Result<Vec<ServerProcess>, Box<dyn std::error::Error>> {
    let (program, options) = (plan.program(), plan.server_options());
    let (lines, connections) = (plan.configuration(), plan.sessions + plan.silent);
    let start = |number| ServerProcess::start(&program, &options, (&lines, connections), number);
    (0..plan.hosts).map(start).collect()
}

async fn play(
    plan: &Load,
    servers: &[ServerProcess],
) -> Result<Measured, Box<dyn std::error::Error>> {
    let mut clients = JoinSet::new();
    let empty = usage(servers);
    for (number, server) in (0..plan.sessions).zip(servers.iter().cycle()) {
        let played = client::play(server.address, number as u64, plan.answer_delay());
        clients.spawn(async {
            if let Err(error) = played.await {
                eprintln!("a client failed: {error}");
            }
        });
        sleep(PAUSE).await;
    }
    if plan.sessions > 0 {
        sleep(WARM_UP).await;
    }
    let walking = usage(servers);
    let mut silent = Vec::new();
    for _ in 0..plan.silent {
        silent.push(wanderer::connect(servers[0].address, "load", client::WINDOW).await?);
    }
    let browsers = match plan.browsers {
        0 => None,
        count => Some(browser::watch((count, plan.seconds), &servers[0]).await?),
    };
    sleep(Duration::from_secs(2)).await;
    let samples = || servers.iter().map(soak::figures).collect::<Result<Samples, _>>();
    let (before, others_before, first) = (usage(servers), plan.others(), samples()?);
    sleep(Duration::from_secs(plan.seconds)).await;
    let (after, others_after, last) = (usage(servers), plan.others(), samples()?);
    let processor = between(&before, &after);
    Ok(Measured {
        figures: Figures::of(plan.sessions, plan.seconds, [&first, &last], &processor),
        megabytes: [&empty, &walking, &after].map(|usage| megabytes(usage)),
        others: between(&others_before, &others_after),
        browsers,
    })
}

/// The resources that each server has used.
fn usage(servers: &[ServerProcess]) -> Vec<Usage> {
    servers.iter().map(ServerProcess::usage).collect()
}

fn megabytes(usage: &[Usage]) -> f64 {
    usage.iter().map(|it| it.megabytes).sum()
}
