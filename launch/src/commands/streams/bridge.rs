//! `maulstick bridge`: the streams of a running rig for Foxglove, by a process of its own that no node waits for.

use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::time::{Duration, Instant};

use clap::Args;
use maulstick_rig::UserError;

use super::foxglove_server::FoxgloveServer;
use super::listener::Listener;
use crate::commands::client::Target;
use crate::commands::say;

/// Options of `maulstick bridge`.
#[derive(Args, Clone, Debug)]
pub struct BridgeOptions {
    /// Topics to show, such as stylus/**: * stands for one part, ** for any number
    #[arg(long, value_name = "TOPIC", default_value = "**")]
    topic: String,
    /// Most messages a second of each topic
    #[arg(long, value_name = "HZ", default_value_t = 60, value_parser = clap::value_parser!(u32).range(1..=1000))]
    hz: u32,
    /// Port of the server, 0 for any
    #[arg(long, default_value_t = 8765)]
    port: u16,
    /// Address of the server; who can reach it can watch the rig
    #[arg(long, default_value_t = IpAddr::V4(Ipv4Addr::LOCALHOST))]
    address: IpAddr,
    #[command(flatten)]
    target: Target,
}

/// A viewer that begins to watch a topic waits no longer for the message that is kept.
const SOON: Duration = Duration::from_millis(100);
/// Time between two looks whether the rig runs.
const LOOK: Duration = Duration::from_secs(1);

/// Serves until Ctrl-C, or the end of the rig.
///
/// # Errors
/// A [`UserError`] where no rig runs, or the port is taken.
pub fn run(options: &BridgeOptions) -> Result<i32, UserError> {
    let BridgeOptions { address, port, .. } = *options;
    let mut listener = Listener::open(&options.target, &options.topic)?;
    let name = format!("maulstick {}", options.target.rig());
    let mut server = FoxgloveServer::start(&name, address, port, options.hz)?;
    let served = SocketAddr::new(address, server.port());
    say!("Foxglove opens ws://{served}; Ctrl-C ends it");
    let mut look_at = Instant::now() + LOOK;
    while !listener.is_over() {
        if let Some(received) = listener.next(Instant::now() + SOON) {
            server.send(received);
        }
        server.greet();
        if Instant::now() >= look_at {
            look_at = Instant::now() + LOOK;
            if !listener.has_rig() {
                break;
            }
        }
    }
    Ok(0)
}
