//! A soak: clients that come and go for a long time, and the resources that the server uses
//! meanwhile.

use std::collections::BTreeMap;
use std::error::Error;
use std::fs;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::sync::{Arc, Mutex};
use std::time::Duration;

use tokio::runtime::Builder;
use tokio::task::JoinSet;
use tokio::time::{Instant, sleep, sleep_until, timeout};

use super::plan::Load;
use super::server::ServerProcess;
use super::wanderer::{self, Leaving};

/// The numbers of visits by the way in which they ended; `None` for visits with a fault.
type Ends = Arc<Mutex<BTreeMap<Option<Leaving>, u64>>>;

/// The number of parts of the time. The server is measured after each part.
const PARTS: u32 = 10;
/// The longest duration of a visit, without its end.
const MAX_DURATION: Duration = Duration::from_secs(20);
/// The time in which the server closes the last connections and rooms.
const AFTERWARDS: Duration = Duration::from_secs(90);

/// Lets clients come and go.
pub(crate) fn run(plan: &Load) -> Result<(), Box<dyn Error>> {
    let server =
        ServerProcess::start(&plan.program(), &[], (&plan.configuration(), 2 * plan.sessions), 0)?;
    Builder::new_current_thread().enable_all().build()?.block_on(soak(plan, &server))
}

async fn soak(plan: &Load, server: &ServerProcess) -> Result<(), Box<dyn Error>> {
    let begun = Instant::now();
    let time = Duration::from_secs(plan.seconds);
    let ends = Ends::default();
    let mut clients = JoinSet::new();
    println!("  time  memory MB  tasks  sessions  rooms  members  files    visits");
    report(server, begun, &ends)?;
    for client in 0..plan.sessions as u64 {
        let (address, ends) = (server.address, Arc::clone(&ends));
        let seed = plan.seed << 48 | client << 32;
        clients.spawn(async move {
            for visit in 0.. {
                let visited = wanderer::visit(address, seed | visit, MAX_DURATION);
                let left = timeout(3 * MAX_DURATION, visited).await;
                let left = left.ok().and_then(Result::ok);
                *ends.lock().expect("no panic").entry(left).or_default() += 1;
                if left.is_none() {
                    sleep(Duration::from_millis(200)).await;
                }
            }
        });
    }
    for part in 1..=PARTS {
        sleep_until(begun + time * part / PARTS).await;
        report(server, begun, &ends)?;
    }
    clients.shutdown().await;
    sleep(AFTERWARDS).await;
    report(server, begun, &ends)?;
    let ends = ends.lock().expect("no panic");
    println!("visits by outcome: {ends:?}");
    let figures = figures(server)?;
    let is_left = |name: &&str| figures.get(*name) != Some(&0.0);
    if let Some(name) = ["cellcaster_sessions", "cellcaster_members"].into_iter().find(is_left) {
        return Err(format!("{name} is not 0 after the last visit").into());
    }
    match ends.get(&None) {
        Some(faults) => Err(format!("{faults} visits failed").into()),
        None => Ok(()),
    }
}

/// Prints a line about the server's resources.
fn report(server: &ServerProcess, begun: Instant, ends: &Ends) -> Result<(), Box<dyn Error>> {
    let figures = figures(server)?;
    let figure = |name: &str| figures.get(name).copied().unwrap_or(f64::NAN);
    let files = fs::read_dir(format!("/proc/{}/fd", server.id()))?.count();
    let visits: u64 = ends.lock().expect("no panic").values().sum();
    println!(
        "{:>5} s {:>10.1} {:>6} {:>9} {:>6} {:>8} {files:>6} {visits:>9}",
        begun.elapsed().as_secs(),
        figure("process_resident_memory_bytes") / f64::from(1 << 20),
        figure("cellcaster_tasks"),
        figure("cellcaster_sessions"),
        figure("cellcaster_rooms"),
        figure("cellcaster_members"),
    );
    Ok(())
}

/// The server's metrics.
pub(crate) fn figures(server: &ServerProcess) -> Result<BTreeMap<String, f64>, Box<dyn Error>> {
    let mut stream = TcpStream::connect(server.metrics)?;
    stream.write_all(b"GET /metrics HTTP/1.1\r\n\r\n")?;
    let mut text = String::new();
    stream.read_to_string(&mut text)?;
    let samples = text.lines().filter_map(|line| line.rsplit_once(' '));
    Ok(samples.filter_map(|(name, value)| Some((name.to_owned(), value.parse().ok()?))).collect())
}
