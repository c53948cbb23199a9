//! Rooms without hosts: the load that the bus of a cluster can carry.
//!
//! Each room appends a message to the log thirty times a second, as its sequencer does. The message
//! contains the number of the message before it. The room waits for the answer, and tells one other
//! host. Every five seconds it stores a checkpoint, and drops the messages before it.

use std::error::Error;
use std::time::Duration;

use async_nats::jetstream::context::Context;
use async_nats::jetstream::message::PublishMessage;
use async_nats::jetstream::{self, stream};
use async_nats::{Client, connect};
use futures_util::StreamExt;
use tokio::runtime::Builder;
use tokio::task::JoinSet;
use tokio::time::{Instant, MissedTickBehavior, interval};

use super::plan::Load;
use super::report::percentile;
use super::server::between;

const STREAM: &str = "CELLCASTER_LOAD";
const CHECKPOINTS: &str = "CELLCASTER_LOAD_CHECKPOINTS";
/// The time from one message of a room to the next.
const INTERVAL: Duration = Duration::from_micros(33_333);
/// The size of a message without entries, in bytes.
const MESSAGE: usize = 25;
/// The size of a checkpoint of a room with eight members, in bytes.
const CHECKPOINT: usize = 15_000;
/// The number of messages from one checkpoint to the next.
const KEPT: usize = 150;
const WARM_UP: Duration = Duration::from_secs(2);

/// Runs this number of rooms.
pub(crate) fn run(rooms: usize, plan: &Load) -> Result<(), Box<dyn Error>> {
    Builder::new_current_thread().enable_all().build()?.block_on(load(rooms, plan))
}

async fn load(rooms: usize, plan: &Load) -> Result<(), Box<dyn Error>> {
    let address = plan.cluster.as_deref().ok_or("--bus needs --cluster")?;
    let (client, listener) = (connect(address).await?, connect(address).await?);
    let context = jetstream::new(client.clone());
    for (name, subject, most) in
        [(STREAM, "cellcaster.load.log.*", 0), (CHECKPOINTS, "cellcaster.load.checkpoint.*", 1)]
    {
        let config = stream::Config {
            name: name.to_owned(),
            subjects: vec![subject.to_owned()],
            max_messages_per_subject: most,
            ..stream::Config::default()
        };
        context.create_stream(config).await?;
    }
    let mut heard = listener.subscribe("cellcaster.load.peers.*").await?;
    tokio::spawn(async move { while heard.next().await.is_some() {} });
    let (begin, seconds) = (Instant::now() + WARM_UP, Duration::from_secs(plan.seconds));
    let mut writers = JoinSet::new();
    for room in 0..rooms {
        let (client, context) = (client.clone(), context.clone());
        writers.spawn(async move {
            let written = write(&client, &context, room, begin, begin + seconds);
            written.await.map_err(|error| error.to_string())
        });
    }
    tokio::time::sleep_until(begin).await;
    let before = plan.others();
    tokio::time::sleep_until(begin + seconds).await;
    let after = plan.others();
    let mut times = Vec::new();
    while let Some(written) = writers.join_next().await {
        times.extend(written??);
    }
    context.delete_stream(STREAM).await?;
    context.delete_stream(CHECKPOINTS).await?;
    report(rooms, plan.seconds, times);
    plan.print_others(&between(&before, &after));
    Ok(())
}

/// Appends the messages of a room, and returns the time of each message within the measured period.
async fn write(
    client: &Client,
    context: &Context,
    room: usize,
    begin: Instant,
    end: Instant,
) -> Result<Vec<Duration>, Box<dyn Error + Send + Sync>> {
    let (log, peers) =
        (format!("cellcaster.load.log.{room}"), format!("cellcaster.load.peers.{room}"));
    let checkpoint = format!("cellcaster.load.checkpoint.{room}");
    let stream = context.get_stream_no_info(STREAM).await?;
    let (mut last, mut times) = (0, Vec::new());
    // Rooms keep their checkpoints at different times.
    let mut count = room;
    let mut ticks = interval(INTERVAL);
    ticks.set_missed_tick_behavior(MissedTickBehavior::Delay);
    loop {
        let due = ticks.tick().await;
        if due >= end {
            return Ok(times);
        }
        let message = PublishMessage::build()
            .payload(vec![0; MESSAGE].into())
            .expected_last_subject_sequence(last);
        last = context.send_publish(log.clone(), message).await?.await?.sequence;
        if due >= begin {
            times.push(due.elapsed());
        }
        client.publish(peers.clone(), vec![0; MESSAGE].into()).await?;
        count += 1;
        if count.is_multiple_of(KEPT) {
            context.publish(checkpoint.clone(), vec![0; CHECKPOINT].into()).await?.await?;
            stream.purge().sequence(last).filter(log.clone()).await?;
        }
    }
}

fn report(rooms: usize, seconds: u64, mut times: Vec<Duration>) {
    times.sort();
    let rate = times.len() as f64 / seconds as f64;
    println!(
        "rooms         {rooms}, {:.1} messages a second for each room",
        rate / rooms.max(1) as f64
    );
    println!(
        "append        p50 {:.1} ms, p99 {:.1} ms",
        percentile(&times, 50),
        percentile(&times, 99)
    );
}
