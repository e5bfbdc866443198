//! `maulstick topic bridge`: the streams of a running rig for Foxglove.

use std::net::{IpAddr, Ipv4Addr, SocketAddr};

use clap::Args;
use maulstick_bridge::admission::{Admission, FOXGLOVE, origin};
use maulstick_bridge::{Bridge, BridgeSettings, token};
use maulstick_recorder::Listener;
use maulstick_rig::UserError;
use maulstick_rig::log::print_beside;

use crate::commands::client::Target;
use crate::commands::{print_line, say};
use crate::runtime::block_on;

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

/// Serves until Ctrl-C, or the end of the rig.
///
/// # Errors
/// A [`UserError`] where no rig runs, or the port is taken.
pub(super) fn run(options: &BridgeOptions) -> Result<i32, UserError> {
    print_beside();
    let listener = Listener::open(options.target.rig(), &options.topic)?;
    let token = if options.no_token {
        None
    } else {
        Some(token::own()?)
    };
    let known = FOXGLOVE.iter().map(|origin| (*origin).to_owned());
    let secret = token.as_ref().map(|token| format!("/?token={token}"));
    let settings = BridgeSettings {
        name: format!("maulstick {}", options.target.rig()),
        address: SocketAddr::new(options.address, options.port),
        hz: options.hz,
        admission: Admission {
            token,
            origins: known.chain(options.origin.iter().cloned()).collect(),
        },
    };
    block_on(async {
        let bridge = Bridge::open(listener, settings).await?;
        let (served, secret) = (bridge.address(), secret.unwrap_or_default());
        say!("Foxglove opens ws://{served}{secret}; Ctrl-C ends it");
        bridge.serve(print_line).await.map(|()| 0)
    })
}
