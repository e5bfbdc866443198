//! Serves messages to viewers that speak the Foxglove protocol.

use std::net::SocketAddr;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use foxglove::ws_protocol::server::ServerInfo;
use maulstick_bus::typed::random_u64;
use maulstick_recorder::Listener;
use maulstick_rig::UserError;
use tokio::net::TcpListener;
use tokio::sync::mpsc::{Receiver, channel};
use tokio::task::JoinSet;
use tokio::time::{MissedTickBehavior, interval};

use crate::admission::{Admission, Refusal, Refusals};
use crate::feed::Feed;
use crate::lobby::Lobby;
use crate::viewer::Wish;

/// Wishes and refusals that wait; viewers wait with more.
const ROOM: usize = 64;
/// Time between two looks whether the rig runs.
const LOOK: Duration = Duration::from_secs(1);

/// How a rig is served.
#[derive(Clone, Debug)]
pub struct BridgeSettings {
    /// Name of the server, which viewers show.
    pub name: String,
    /// Address of the server, of port 0 for any.
    pub address: SocketAddr,
    /// Most messages a second of each topic.
    pub hz: u32,
    /// What admits a viewer.
    pub admission: Admission,
}

/// A server of a rig's messages. It takes nothing from its viewers. Dropped, it ends their connections.
pub struct Bridge {
    address: SocketAddr,
    listener: Listener,
    feed: Feed,
    wishes: Receiver<Wish>,
    refusals: Receiver<Refusal>,
    accepting: JoinSet<()>,
}

impl Bridge {
    /// Begins to serve what a listener receives.
    ///
    /// # Errors
    /// A [`UserError`] where the port is taken, or the address is not this machine's.
    pub async fn open(listener: Listener, settings: BridgeSettings) -> Result<Self, UserError> {
        let wrong = |error| cannot_serve(settings.address, &error);
        let socket = TcpListener::bind(settings.address).await.map_err(wrong)?;
        let address = socket.local_addr().map_err(wrong)?;
        let (to_wishes, wishes) = channel(ROOM);
        let (to_refusals, refusals) = channel(ROOM);
        let lobby = Arc::new(Lobby {
            info: ServerInfo::new(&settings.name).with_session_id(random_u64().to_string()),
            admission: settings.admission,
            people: Mutex::default(),
            wishes: to_wishes,
            refusals: to_refusals,
        });
        let mut accepting = JoinSet::new();
        accepting.spawn(Arc::clone(&lobby).accept(socket));
        Ok(Self {
            address,
            listener,
            feed: Feed::new(lobby, settings.hz),
            wishes,
            refusals,
            accepting,
        })
    }

    /// The address at which it serves.
    #[must_use]
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// Serves until the listener is told to end, or the rig ends; `refused` has the lines about those who may not watch.
    ///
    /// # Errors
    /// That of `refused`.
    pub async fn serve(
        mut self,
        mut refused: impl FnMut(&str) -> Result<(), UserError>,
    ) -> Result<(), UserError> {
        let mut refusals = Refusals::default();
        let mut look = interval(LOOK);
        look.set_missed_tick_behavior(MissedTickBehavior::Delay);
        loop {
            tokio::select! {
                received = self.listener.arrival() => match received {
                    Some(received) => self.feed.send(received),
                    None => break,
                },
                Some(wish) = self.wishes.recv() => self.feed.fulfil(wish),
                Some(refusal) = self.refusals.recv() => {
                    if let Some(line) = refusals.line(&refusal, Instant::now()) {
                        refused(&line)?;
                    }
                }
                _ = look.tick() => if !self.listener.has_rig() {
                    break;
                },
            }
        }
        self.accepting.shutdown().await;
        Ok(())
    }
}

/// Why a server does not start.
fn cannot_serve(at: SocketAddr, error: &std::io::Error) -> UserError {
    let at = format!("{}, port {}", at.ip(), at.port());
    match error.kind() {
        std::io::ErrorKind::AddrInUse => UserError::failure("the port is taken by another program")
            .at(at)
            .help("choose another with --port, or --port 0 for any"),
        std::io::ErrorKind::AddrNotAvailable => UserError::usage(
            "this machine does not have this address",
        )
        .at(at)
        .help(
            "choose another with --address: 127.0.0.1 for this machine, 0.0.0.0 for all networks",
        ),
        _ => UserError::failure(format!("cannot serve: {error}")).at(at),
    }
}
