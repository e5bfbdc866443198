//! The viewers, from their connection to its end, and the channels that they know of.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use foxglove::ws_protocol::server::{Advertise, Channel, ServerInfo};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::Semaphore;
use tokio::sync::mpsc::Sender;
use tokio::task::JoinSet;
use tokio::time::sleep;

use crate::admission::{Admission, Refusal};
use crate::connection::{GREETING, greet, turn_away};
use crate::viewer::{Viewer, Wish};

/// Most connections at a time, with those that are not yet admitted.
const MOST: usize = 32;
/// Pause after a connection that the system could not accept.
const PAUSE: Duration = Duration::from_millis(100);

/// What a server shares with the tasks of its viewers.
pub(crate) struct Lobby {
    /// What each viewer is told first.
    pub(crate) info: ServerInfo,
    pub(crate) admission: Admission,
    pub(crate) people: Mutex<People>,
    pub(crate) wishes: Sender<Wish>,
    pub(crate) refusals: Sender<Refusal>,
}

/// The viewers, and the channels that they know of, by number.
#[derive(Default)]
pub(crate) struct People {
    viewers: Vec<Arc<Viewer>>,
    channels: Vec<Channel<'static>>,
}

impl Lobby {
    fn lock(&self) -> MutexGuard<'_, People> {
        self.people.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Accepts connections until it is dropped, which ends them, too.
    pub(crate) async fn accept(self: Arc<Self>, listener: TcpListener) {
        let (mut viewers, places) = (JoinSet::new(), Arc::new(Semaphore::new(MOST)));
        loop {
            let accepted = tokio::select! {
                accepted = listener.accept() => accepted,
                Some(_) = viewers.join_next() => continue,
            };
            let Ok((stream, _)) = accepted else {
                // As where too many files are open: one may be closed soon.
                sleep(PAUSE).await;
                continue;
            };
            let Ok(place) = Arc::clone(&places).try_acquire_owned() else {
                turn_away(stream, &Refusal::Full);
                self.refuse(Refusal::Full).await;
                continue;
            };
            let lobby = Arc::clone(&self);
            viewers.spawn(async move {
                lobby.serve(stream).await;
                drop(place);
            });
        }
    }

    async fn refuse(&self, why: Refusal) {
        // Without a receiver the server ends.
        self.refusals.send(why).await.ok();
    }

    async fn serve(&self, stream: TcpStream) {
        let connection = match greet(stream, &self.admission, GREETING).await {
            Ok(connection) => connection,
            Err(Some(why)) => return self.refuse(why).await,
            Err(None) => return,
        };
        let viewer = self.admit();
        let channels = || self.lock().channels.len() as u64;
        viewer.serve(connection, channels, &self.wishes).await;
        self.lock()
            .viewers
            .retain(|other| !Arc::ptr_eq(other, &viewer));
    }

    /// Another viewer, which is told of the server and of its channels.
    fn admit(&self) -> Arc<Viewer> {
        let viewer = Arc::new(Viewer::default());
        let mut people = self.lock();
        viewer.say(&self.info);
        if !people.channels.is_empty() {
            viewer.say(&Advertise::new(people.channels.iter().cloned()));
        }
        people.viewers.push(Arc::clone(&viewer));
        viewer
    }

    /// Makes a channel, and tells all viewers of it; its number.
    pub(crate) fn advertise(
        &self,
        channel: impl FnOnce(u64) -> Option<Channel<'static>>,
    ) -> Option<u64> {
        let mut people = self.lock();
        let number = people.channels.len() as u64;
        let channel = channel(number)?;
        for viewer in &people.viewers {
            viewer.say(&Advertise::new([channel.clone()]));
        }
        people.channels.push(channel);
        Some(number)
    }

    /// Those who watch a channel.
    pub(crate) fn watchers(&self, channel: u64) -> Vec<Arc<Viewer>> {
        let mut viewers = self.lock().viewers.clone();
        viewers.retain(|viewer| viewer.watches(channel));
        viewers
    }

    /// Topic of a channel.
    pub(crate) fn topic(&self, channel: u64) -> Option<String> {
        let people = self.lock();
        let channel = people.channels.get(channel as usize);
        channel.map(|channel| channel.topic.clone().into_owned())
    }
}
