//! One viewer of the bridge: a task that obeys it, and what waits to be sent to it.

use std::collections::{BTreeMap, VecDeque};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use foxglove::ws_protocol::client::ClientMessage;
use foxglove::ws_protocol::server::MessageData;
use foxglove::ws_protocol::{BinaryMessage as _, JsonMessage};
use futures_util::{SinkExt as _, StreamExt as _};
use tokio::sync::Notify;
use tokio::sync::mpsc::Sender;
use tokio_tungstenite::tungstenite::{Error, Message};

use crate::connection::Connection;

/// Messages that wait for a slow viewer; older ones are dropped.
const BACKLOG: usize = 1024;

/// What waits for a viewer, and what it watches.
#[derive(Debug, Default)]
pub(crate) struct Viewer {
    waiting: Mutex<Waiting>,
    /// Signalled when something waits.
    news: Notify,
}

#[derive(Debug, Default)]
struct Waiting {
    /// All of these are sent.
    words: VecDeque<Message>,
    data: VecDeque<Message>,
    /// Its subscriptions, by channel.
    subscriptions: BTreeMap<u64, u32>,
}

/// A viewer's wish for a channel.
pub(crate) struct Wish {
    /// Who wishes it.
    pub(crate) viewer: Arc<Viewer>,
    /// The channel.
    pub(crate) channel: u64,
}

impl Viewer {
    fn lock(&self) -> MutexGuard<'_, Waiting> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Has something said about the server.
    pub(crate) fn say(&self, words: &impl JsonMessage) {
        let words = JsonMessage::to_string(words);
        self.lock().words.push_back(Message::text(words));
        self.news.notify_one();
    }

    /// True if it watches a channel.
    pub(crate) fn watches(&self, channel: u64) -> bool {
        self.lock().subscriptions.contains_key(&channel)
    }

    /// Has a message of a channel sent, if it watches that.
    pub(crate) fn send(&self, channel: u64, time_ns: u64, json: &[u8]) {
        let mut waiting = self.lock();
        let Some(subscription) = waiting.subscriptions.get(&channel) else {
            return;
        };
        let data = MessageData::new(*subscription, time_ns, json).to_bytes();
        waiting.data.push_back(Message::binary(data));
        while waiting.data.len() > BACKLOG {
            waiting.data.pop_front();
        }
        self.news.notify_one();
    }

    /// Carries out what it asks for; of channels there are `channels`.
    async fn obey(self: &Arc<Self>, message: &Message, channels: u64, wishes: &Sender<Wish>) {
        let Message::Text(text) = message else {
            return;
        };
        match ClientMessage::parse_json(text) {
            Ok(ClientMessage::Subscribe(asked)) => {
                let asked = asked.subscriptions.iter();
                for own in asked.filter(|own| own.channel_id < channels) {
                    self.lock().subscriptions.insert(own.channel_id, own.id);
                    let (viewer, channel) = (Arc::clone(self), own.channel_id);
                    // Without a receiver the server ends.
                    wishes.send(Wish { viewer, channel }).await.ok();
                }
            }
            Ok(ClientMessage::Unsubscribe(asked)) => {
                let is_kept = |_: &u64, own: &mut u32| !asked.subscription_ids.contains(own);
                self.lock().subscriptions.retain(is_kept);
            }
            // The bridge takes nothing else from its viewers.
            Ok(_) | Err(_) => {}
        }
    }

    /// Serves its connection to the end of it; `channels` says how many channels there are.
    pub(crate) async fn serve(
        self: &Arc<Self>,
        mut connection: Connection,
        channels: impl Fn() -> u64,
        wishes: &Sender<Wish>,
    ) {
        loop {
            tokio::select! {
                message = connection.next() => match message {
                    Some(Ok(message)) => self.obey(&message, channels(), wishes).await,
                    Some(Err(_)) | None => return,
                },
                () = self.news.notified() => {}
            }
            if self.send_waiting(&mut connection).await.is_err() {
                return;
            }
        }
    }

    /// Takes what waits, in the order in which it is sent.
    fn take_waiting(&self) -> impl Iterator<Item = Message> + use<> {
        let mut waiting = self.lock();
        let words = std::mem::take(&mut waiting.words);
        words.into_iter().chain(std::mem::take(&mut waiting.data))
    }

    async fn send_waiting(&self, connection: &mut Connection) -> Result<(), Error> {
        for message in self.take_waiting() {
            connection.feed(message).await?;
        }
        connection.flush().await
    }
}
