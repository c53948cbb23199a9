//! The bus over NATS and its log, `JetStream`.
//!
//! | what | where |
//! |---|---|
//! | logs | stream `CELLCASTER_LOG`, subject `cellcaster.log.ROOM` |
//! | broadcasts to rooms | subject `cellcaster.peers.ROOM`, not stored |
//! | requests to all hosts | subject `cellcaster.operator.1`, not stored; replies to an inbox |
//! | records, checkpoints, places | bucket `cellcaster`, keys `room.ROOM`, `checkpoint.ROOM`, `standing.HASH`, `place.KEY` |
//! | numbers of rooms | stream `CELLCASTER_NUMBERS`: the number of its newest message |
//!
//! The streams and the bucket are created if they are missing. To have copies on several servers, create them
//! beforehand.
//!
//! A call ends after [`TIMEOUT`]. Without a connection it fails at once, so that no message waits in memory until it
//! is out of date.

use std::collections::BTreeMap;
use std::sync::Mutex;
use std::time::Duration;

use async_nats::connection::State;
use async_nats::jetstream::context::PublishErrorKind;
use async_nats::jetstream::kv::{CreateErrorKind, Operation, Store, UpdateErrorKind};
use async_nats::jetstream::message::PublishMessage;
use async_nats::jetstream::stream::{self, DiscardPolicy, RawMessageErrorKind, Stream};
use async_nats::jetstream::{self, Context};
use async_nats::{Client, ConnectOptions, Message, ServerAddr, Subscriber};
use futures_util::StreamExt;
use tokio::sync::{mpsc, oneshot};
use tokio::time::timeout;

use super::bus::{Bus, BusAnswer, BusFault, HostRequest, Key};
use crate::lock::locked;
use crate::rooms::summary::RoomId;

/// The time limit for a call.
const TIMEOUT: Duration = Duration::from_secs(1);
/// The time limit for the first connection.
const CONNECT_TIMEOUT: Duration = Duration::from_secs(5);
/// The time between two pings of the server.
const PING_INTERVAL: Duration = Duration::from_secs(2);
/// The most messages in a room's log: some minutes without a checkpoint.
const MAX_MESSAGES: i64 = 20_000;
/// The most broadcasts of a room, or changes in the list of rooms, that wait. Further ones are lost.
const MAX_QUEUED: usize = 1_024;

const BUCKET: &str = "cellcaster";
const NUMBERS: &str = "cellcaster.number";
/// Contains the version of the format of requests.
const OPERATOR: &str = "cellcaster.operator.1";
const ROOMS: &str = "room.";

/// A connection to NATS.
pub(crate) struct NatsBus {
    client: Client,
    context: Context,
    log: Stream,
    store: Store,
    /// The revisions of the values that this host saw last, by their keys.
    revisions: Mutex<BTreeMap<String, u64>>,
}

impl NatsBus {
    /// Connects to an address such as `nats://host:4222`, or to several with commas between them.
    ///
    /// # Errors
    /// A sentence, which contains no password.
    pub(crate) async fn connect(address: &str) -> Result<Self, String> {
        let servers: Result<Vec<ServerAddr>, _> = address.split(',').map(str::parse).collect();
        let servers = servers
            .map_err(|_| "the NATS address is invalid: write nats://HOST:PORT".to_owned())?;
        let names: Vec<String> =
            servers.iter().map(|it| format!("{}:{}", it.host(), it.port())).collect();
        let names = names.join(", ");
        let options = ConnectOptions::new()
            .connection_timeout(CONNECT_TIMEOUT)
            .request_timeout(Some(TIMEOUT))
            .ping_interval(PING_INTERVAL)
            .subscription_capacity(MAX_QUEUED);
        let client = options.connect(servers).await;
        let client = client.map_err(|error| format!("NATS at {names}: {error}"))?;
        let mut context = jetstream::new(client.clone());
        context.set_timeout(CONNECT_TIMEOUT);
        let made = Self::make(&context).await;
        let (log, store) = made.map_err(|error| format!("JetStream at {names}: {error}"))?;
        context.set_timeout(TIMEOUT);
        Ok(Self { client, context, log, store, revisions: Mutex::default() })
    }

    async fn make(context: &Context) -> Result<(Stream, Store), async_nats::Error> {
        let log = stream::Config {
            name: "CELLCASTER_LOG".to_owned(),
            subjects: vec!["cellcaster.log.*".to_owned()],
            max_messages_per_subject: MAX_MESSAGES,
            allow_direct: true,
            ..stream::Config::default()
        };
        let numbers = stream::Config {
            name: "CELLCASTER_NUMBERS".to_owned(),
            subjects: vec![NUMBERS.to_owned()],
            max_messages: 1,
            ..stream::Config::default()
        };
        let log = context.get_or_create_stream(log).await?;
        context.get_or_create_stream(numbers).await?;
        // `create_key_value` requires information about the account that server 2.9 does not send.
        let bucket = stream::Config {
            name: format!("KV_{BUCKET}"),
            subjects: vec![format!("$KV.{BUCKET}.>")],
            max_messages_per_subject: 1,
            allow_rollup: true,
            deny_delete: true,
            allow_direct: true,
            discard: DiscardPolicy::New,
            num_replicas: 1,
            ..stream::Config::default()
        };
        context.get_or_create_stream(bucket).await?;
        Ok((log, context.get_key_value(BUCKET).await?))
    }

    /// Runs `act` in bounded time, and only with a connection.
    fn call<'a, T: Send + 'a>(
        &'a self,
        act: impl Future<Output = Result<T, BusFault>> + Send + 'a,
    ) -> BusAnswer<'a, T> {
        Box::pin(async move {
            if self.client.connection_state() != State::Connected {
                return Err(BusFault::Unknown);
            }
            timeout(TIMEOUT, act).await.unwrap_or(Err(BusFault::Unknown))
        })
    }

    fn revision(&self, key: &str) -> u64 {
        locked(&self.revisions, |revisions| revisions.get(key).copied().unwrap_or_default())
    }

    fn note(&self, key: &str, revision: u64) {
        locked(&self.revisions, |revisions| _ = revisions.insert(key.to_owned(), revision));
    }

    /// Reads the value of a key, and notes its revision.
    async fn entry(&self, key: &str) -> Result<Option<Vec<u8>>, BusFault> {
        let entry = self.store.entry(key).await.map_err(unknown)?;
        self.note(key, entry.as_ref().map_or(0, |entry| entry.revision));
        let entry = entry.filter(|entry| entry.operation == Operation::Put);
        Ok(entry.map(|entry| entry.value.to_vec()))
    }

    /// Subscribes to the messages on a subject from now on.
    async fn subscription(&self, subject: String) -> Result<Subscriber, BusFault> {
        let subscription = self.client.subscribe(subject).await.map_err(unknown)?;
        // After the flush, no message is missed.
        self.client.flush().await.map_err(unknown)?;
        Ok(subscription)
    }
}

impl Bus for NatsBus {
    fn append(&self, room: RoomId, last: u64, message: Vec<u8>) -> BusAnswer<'_, u64> {
        self.call(async move {
            let message = PublishMessage::build()
                .payload(message.into())
                .expected_last_subject_sequence(last);
            let sent = self.context.send_publish(log_subject(room), message).await;
            let acknowledged = sent.map_err(unknown)?.await;
            acknowledged.map(|it| it.sequence).map_err(|error| match error.kind() {
                PublishErrorKind::WrongLastSequence => BusFault::Refused,
                _ => BusFault::Unknown,
            })
        })
    }

    fn read(&self, room: RoomId, after: u64) -> BusAnswer<'_, Option<(u64, Vec<u8>)>> {
        self.call(async move {
            let next = self.log.raw_message_builder().sequence(after + 1);
            match next.next_by_subject(log_subject(room)).send().await {
                Ok(message) => Ok(Some((message.sequence, message.payload.to_vec()))),
                Err(error) if error.kind() == RawMessageErrorKind::NoMessageFound => Ok(None),
                Err(_) => Err(BusFault::Unknown),
            }
        })
    }

    fn drop_before(&self, room: RoomId, first: u64) -> BusAnswer<'_, ()> {
        self.call(async move {
            // The server reads 1 as no number, and would drop all messages.
            if first <= 1 {
                return Ok(());
            }
            let purge = self.log.purge().sequence(first).filter(log_subject(room));
            purge.await.map(drop).map_err(unknown)
        })
    }

    fn drop_log(&self, room: RoomId) -> BusAnswer<'_, ()> {
        self.call(async move {
            self.log.purge().filter(log_subject(room)).await.map(drop).map_err(unknown)
        })
    }

    fn broadcast(&self, room: RoomId, message: Vec<u8>) -> BusAnswer<'_, ()> {
        self.call(async move {
            self.client.publish(peers_subject(room), message.into()).await.map_err(unknown)
        })
    }

    fn subscribe(&self, room: RoomId) -> BusAnswer<'_, mpsc::Receiver<Vec<u8>>> {
        self.call(async move {
            let subscription = self.subscription(peers_subject(room)).await?;
            Ok(forward(subscription, &self.client, |_, message| message.payload.to_vec()))
        })
    }

    fn ask_hosts(&self, request: Vec<u8>) -> BusAnswer<'_, mpsc::Receiver<Vec<u8>>> {
        self.call(async move {
            let inbox = self.client.new_inbox();
            let subscription = self.subscription(inbox.clone()).await?;
            let asked = self.client.publish_with_reply(OPERATOR, inbox, request.into()).await;
            asked.map_err(unknown)?;
            Ok(forward(subscription, &self.client, |_, message| message.payload.to_vec()))
        })
    }

    fn host_requests(&self) -> BusAnswer<'_, mpsc::Receiver<HostRequest>> {
        self.call(async move {
            let subscription = self.subscription(OPERATOR.to_owned()).await?;
            Ok(forward(subscription, &self.client, host_request))
        })
    }

    fn next_number(&self) -> BusAnswer<'_, u32> {
        self.call(async move {
            let sent = self.context.publish(NUMBERS, Vec::new().into()).await.map_err(unknown)?;
            let number = sent.await.map_err(unknown)?.sequence;
            u32::try_from(number).map_err(unknown)
        })
    }

    fn put(&self, key: Key, value: Vec<u8>) -> BusAnswer<'_, ()> {
        self.call(async move {
            let key = key_name(&key);
            match self.store.update(&key, value.into(), self.revision(&key)).await {
                Ok(revision) => {
                    self.note(&key, revision);
                    Ok(())
                }
                Err(error) if error.kind() == UpdateErrorKind::WrongLastRevision => {
                    self.entry(&key).await?;
                    Err(BusFault::Refused)
                }
                Err(_) => Err(BusFault::Unknown),
            }
        })
    }

    fn create(&self, key: Key, value: Vec<u8>) -> BusAnswer<'_, ()> {
        self.call(async move {
            let key = key_name(&key);
            let revision = self.store.create(&key, value.into()).await;
            let revision = revision.map_err(|error| match error.kind() {
                CreateErrorKind::AlreadyExists => BusFault::Refused,
                _ => BusFault::Unknown,
            })?;
            self.note(&key, revision);
            Ok(())
        })
    }

    fn get(&self, key: Key) -> BusAnswer<'_, Option<Vec<u8>>> {
        self.call(async move { self.entry(&key_name(&key)).await })
    }

    fn remove(&self, key: Key) -> BusAnswer<'_, ()> {
        self.call(async move {
            let key = key_name(&key);
            locked(&self.revisions, |revisions| _ = revisions.remove(&key));
            self.store.purge(&key).await.map_err(unknown)
        })
    }

    fn watch(&self) -> BusAnswer<'_, mpsc::Receiver<(RoomId, Option<Vec<u8>>)>> {
        self.call(async move {
            let keys = format!("{ROOMS}*");
            let mut watch = self.store.watch_with_history(keys).await.map_err(unknown)?;
            let (changes, receiver) = mpsc::channel(MAX_QUEUED);
            tokio::spawn(async move {
                while let Some(Ok(entry)) = watch.next().await {
                    let number = entry.key.strip_prefix(ROOMS).and_then(|it| it.parse().ok());
                    let Some(id) = number.map(RoomId) else { continue };
                    let value = (entry.operation == Operation::Put).then(|| entry.value.to_vec());
                    if changes.send((id, value)).await.is_err() {
                        return;
                    }
                }
            });
            Ok(receiver)
        })
    }
}

fn unknown<E>(_: E) -> BusFault {
    BusFault::Unknown
}

/// Forwards the messages, converted by `make`, until the receiver is dropped.
fn forward<T: Send + 'static>(
    mut subscription: Subscriber,
    client: &Client,
    make: fn(&Client, Message) -> T,
) -> mpsc::Receiver<T> {
    let (messages, receiver) = mpsc::channel(MAX_QUEUED);
    let client = client.clone();
    tokio::spawn(async move {
        loop {
            tokio::select! {
                () = messages.closed() => return,
                message = subscription.next() => match message {
                    // A status comes from the server itself, for example because nobody received the request.
                    Some(message) if message.status.is_some() => {}
                    Some(message) => _ = messages.try_send(make(&client, message)),
                    None => return,
                }
            }
        }
    });
    receiver
}

/// Converts a message to a request, and sends the answer back.
fn host_request(client: &Client, message: Message) -> HostRequest {
    let (reply, answer) = oneshot::channel::<Vec<u8>>();
    if let Some(inbox) = message.reply {
        let client = client.clone();
        tokio::spawn(async move {
            if let Ok(answer) = answer.await {
                _ = client.publish(inbox, answer.into()).await;
            }
        });
    }
    HostRequest { bytes: message.payload.to_vec(), reply }
}

fn log_subject(room: RoomId) -> String {
    format!("cellcaster.log.{room}")
}

fn peers_subject(room: RoomId) -> String {
    format!("cellcaster.peers.{room}")
}

fn key_name(key: &Key) -> String {
    match key {
        Key::Room(room) => format!("{ROOMS}{room}"),
        Key::Checkpoint(room) => format!("checkpoint.{room}"),
        Key::Standing(hash) => format!("standing.{hash}"),
        Key::Place(key) => {
            let digits = key.bytes().map(|byte| format!("{byte:02x}"));
            format!("place.{}", digits.concat())
        }
    }
}
