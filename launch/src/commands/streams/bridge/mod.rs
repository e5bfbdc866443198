//! `maulstick topic bridge`: the streams of a running rig for Foxglove, by a separate process that no node waits for.
//!
//! | module | holds |
//! | --- | --- |
//! | [`admission`] | admission of viewers |
//! | [`token`] | the secret in the address |
//! | [`viewer`] | a viewer |
//! | [`foxglove_server`] | messages to viewers |

mod admission;
mod foxglove_server;
mod token;
mod viewer;

use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::time::{Duration, Instant};

use clap::Args;
use maulstick_recorder::Listener;
use maulstick_rig::UserError;
use maulstick_rig::log::print_beside;

use self::admission::{Admission, FOXGLOVE, Refusals, origin};
use self::foxglove_server::FoxgloveServer;
use crate::commands::client::Target;
use crate::commands::say;

/// Options of `maulstick topic bridge`.
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
    /// Address of the server
    #[arg(long, default_value_t = IpAddr::V4(Ipv4Addr::LOCALHOST))]
    address: IpAddr,
    /// Let pages of this origin watch, too, such as http://localhost:8080; may be given several times [default: Foxglove's
    /// alone]
    #[arg(long, value_name = "ORIGIN", value_parser = origin)]
    origin: Vec<String>,
    /// Let every program that reaches the address watch, without the token
    #[arg(long)]
    no_token: bool,
    #[command(flatten)]
    target: Target,
}

/// Longest wait of a new viewer of a topic for the cached message.
const SOON: Duration = Duration::from_millis(100);
/// Time between two looks whether the rig runs.
const LOOK: Duration = Duration::from_secs(1);

/// Serves until Ctrl-C, or the end of the rig.
///
/// # Errors
/// A [`UserError`] where no rig runs, or the port is taken.
pub(super) fn run(options: &BridgeOptions) -> Result<i32, UserError> {
    let BridgeOptions { address, port, .. } = *options;
    print_beside();
    let mut listener = Listener::open(options.target.rig(), &options.topic)?;
    let name = format!("maulstick {}", options.target.rig());
    let token = if options.no_token {
        None
    } else {
        Some(token::own()?)
    };
    let known = FOXGLOVE.iter().map(|origin| (*origin).to_owned());
    let admission = Admission {
        token: token.clone(),
        origins: known.chain(options.origin.iter().cloned()).collect(),
    };
    let at = SocketAddr::new(address, port);
    let mut server = FoxgloveServer::start(&name, at, options.hz, admission)?;
    let served = SocketAddr::new(address, server.port());
    let secret = token.map_or_else(String::new, |token| format!("/?token={token}"));
    say!("Foxglove opens ws://{served}{secret}; Ctrl-C ends it");
    let mut look_at = Instant::now() + LOOK;
    let mut refusals = Refusals::default();
    while !listener.is_over() {
        if let Some(received) = listener.next(Instant::now() + SOON) {
            server.send(received);
        }
        server.greet();
        for refusal in server.refusals() {
            if let Some(line) = refusals.line(&refusal, Instant::now()) {
                say!("{line}");
            }
        }
        if Instant::now() >= look_at {
            look_at = Instant::now() + LOOK;
            if !listener.has_rig() {
                break;
            }
        }
    }
    Ok(0)
}
