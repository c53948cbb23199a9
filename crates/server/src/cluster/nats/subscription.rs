//! Subscriptions to subjects, and what becomes of their messages.

use async_nats::{Client, Message, Subscriber};
use futures_util::StreamExt;
use tokio::sync::{mpsc, oneshot};

use super::{MOST_QUEUED, NatsBus, unknown};
use crate::cluster::bus::{BusFault, HostRequest};

impl NatsBus {
    /// What is said on a subject from now on.
    pub(crate) async fn subscription(&self, subject: String) -> Result<Subscriber, BusFault> {
        let subscription = self.client.subscribe(subject).await.map_err(unknown)?;
        // From now on, nothing is missed.
        self.client.flush().await.map_err(unknown)?;
        Ok(subscription)
    }
}

/// What is made of the messages, as long as somebody receives it.
pub(crate) fn forward<T: Send + 'static>(
    mut subscription: Subscriber,
    client: &Client,
    make: fn(&Client, Message) -> T,
) -> mpsc::Receiver<T> {
    let (messages, receiver) = mpsc::channel(MOST_QUEUED);
    let client = client.clone();
    tokio::spawn(async move {
        loop {
            tokio::select! {
                () = messages.closed() => return,
                message = subscription.next() => match message {
                    // One with a status is of the server, such as that nobody was asked.
                    Some(message) if message.status.is_some() => {}
                    Some(message) => _ = messages.try_send(make(&client, message)),
                    None => return,
                }
            }
        }
    });
    receiver
}

/// A request, whose answer is sent to who has asked.
pub(crate) fn host_request(client: &Client, message: Message) -> HostRequest {
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
