//! `maulstick device force off`, `on`, `strength` and `rearm`: requests to the devices of a running rig.

use std::time::{Duration, Instant};

use clap::{Args, Subcommand};
use maulstick_bus::Qos;
use maulstick_rig::config::DeviceSection;
use maulstick_rig::{UserError, asker};
use maulstick_types::haptics::{ForceOrder, ForceReply, ForceRequest};
use maulstick_types::stylus::{StylusInfo, axes};
use maulstick_types::values::{ForceShare, Quantity};

use crate::commands::client::{Client, Target};
use crate::commands::option_error::OptionError;
use crate::commands::{client, print_text};

/// A command to the force of a device.
#[derive(Clone, Debug, Subcommand)]
pub enum Order {
    /// Switch the force off at once
    Off(Whose),
    /// Switch the force on again; it rises from zero
    On(Whose),
    /// Give a share of the force
    Strength {
        /// Share of the force: 60% or 0.6
        #[arg(value_parser = share)]
        share: f64,
        /// Of which devices
        #[command(flatten)]
        whose: Whose,
    },
    /// Give a share of the guides' force
    Guidance {
        /// Share of the guides' force: 60% or 0.6
        #[arg(value_parser = share)]
        share: f64,
        /// Of which devices
        #[command(flatten)]
        whose: Whose,
    },
    /// Re-arm the force after a fault
    Rearm(Whose),
}

impl Order {
    /// The devices that it is for, and the request to them.
    fn parts(&self) -> (&Whose, ForceOrder) {
        match self {
            Self::Off(whose) => (whose, ForceOrder::Off),
            Self::On(whose) => (whose, ForceOrder::On),
            Self::Strength { share, whose } => (whose, ForceOrder::Strength { share: *share }),
            Self::Guidance { share, whose } => (whose, ForceOrder::Guidance { share: *share }),
            Self::Rearm(whose) => (whose, ForceOrder::Rearm),
        }
    }
}

/// The devices that a command is for.
#[derive(Args, Clone, Debug)]
pub struct Whose {
    /// Device of rig.toml [default: the one that gives force; `off` is for all]
    #[arg(long, value_name = "DEVICE")]
    device: Option<String>,
    /// All devices that give force
    #[arg(long, conflicts_with = "device")]
    all: bool,
    #[command(flatten)]
    target: Target,
}

/// Longest wait for the devices of a rig to show themselves.
const PATIENCE: Duration = Duration::from_secs(3);
/// Longest wait for the answer of a device's daemon.
const ANSWER: Duration = Duration::from_secs(3);
/// After the first, others come this soon.
const TOGETHER: Duration = Duration::from_millis(300);

fn share(text: &str) -> Result<f64, OptionError> {
    let (number, unit) = match text.trim().strip_suffix('%') {
        Some(number) => (number.trim(), 0.01),
        None => (text.trim(), 1.0),
    };
    let share = number.parse().ok().map(|value: f64| value * unit);
    let good = share.filter(|share| ForceShare::RANGE.contains(share));
    let expected = "a share from 0 to 100 %, such as 60% or 0.6";
    good.ok_or_else(|| OptionError::unexpected(text, expected))
}

/// Sends a request to devices and prints their resulting state.
///
/// # Errors
/// A [`UserError`] if no rig runs, or no device of it gives force or answers.
pub fn give(order: &Order) -> Result<i32, UserError> {
    let (whose, order) = order.parts();
    let client = Client::open(&whose.target)?;
    let known = client.config()?.device;
    let devices = match &whose.device {
        Some(device) => vec![chosen(&known, device, &client)?],
        None => meant(all(&known, &client)?, whose, &order)?,
    };
    let request = ForceRequest::by(&asker("`maulstick device force`"), order);
    let (mut text, mut silent) = (String::new(), Vec::new());
    for device in devices {
        let topic = client.topics().force(&device);
        match client.ask_within::<_, ForceReply>(&topic, &request, ANSWER) {
            Ok(reply) => text += &told(&device, &reply),
            Err(_) => silent.push(device),
        }
    }
    print_text(&text)?;
    if silent.is_empty() {
        Ok(0)
    } else {
        Err(UserError::failure(format!(
            "{}: its daemon does not answer, so nothing is changed",
            silent.join(", ")
        ))
        .at(client.topics().force("*"))
        .help("`maulstick up` shows its nodes; ended by Ctrl-C they leave no force"))
    }
}

/// All of the devices where the command says so, or there is one: a hand at another one would get force unawares. Force is
/// taken off all.
fn meant(
    devices: Vec<String>,
    whose: &Whose,
    order: &ForceOrder,
) -> Result<Vec<String>, UserError> {
    if whose.all || *order == ForceOrder::Off || devices.len() < 2 {
        return Ok(devices);
    }
    let names = devices.join(", ");
    Err(
        UserError::usage(format!("several devices give force: {names}"))
            .help("name the one that is meant by --device DEVICE, or say --all"),
    )
}

/// The device of that name, if it is one that gives force.
fn chosen(known: &[DeviceSection], name: &str, client: &Client) -> Result<String, UserError> {
    match known.iter().find(|device| device.name == name) {
        Some(device) if device.is_hid() => {
            Err(UserError::usage(format!("'{name}' gives no force"))
                .help(format!("its driver is {}", device.driver)))
        }
        Some(_) => Ok(name.to_owned()),
        None => {
            let others = told_of(client, Instant::now() + TOGETHER)?;
            if others.iter().any(|other| other == name) {
                Ok(name.to_owned())
            } else {
                let names = known.iter().map(|device| device.name.as_str());
                let what = format!("there is no device '{name}' in the rig");
                Err(UserError::unknown(what, name, names))
            }
        }
    }
}

/// All devices with force: those of rig.toml, connected or not, and others that report force.
fn all(known: &[DeviceSection], client: &Client) -> Result<Vec<String>, UserError> {
    let own = known.iter().filter(|device| !device.is_hid());
    let mut found: Vec<String> = own.map(|device| device.name.clone()).collect();
    let wait = if found.is_empty() { PATIENCE } else { TOGETHER };
    for other in told_of(client, Instant::now() + wait)? {
        if !found.contains(&other) {
            found.push(other);
        }
    }
    if found.is_empty() {
        Err(UserError::failure("no device of the rig gives force")
            .at(client.topics().stylus_info("*"))
            .help("see `[[device]]` of rig.toml"))
    } else {
        Ok(found)
    }
}

fn told(device: &str, reply: &ForceReply) -> String {
    let percent = (reply.strength * 100.0).round();
    let weaker = if reply.strength < 1.0 {
        format!(", {percent} % when it is on")
    } else {
        String::new()
    };
    let guidance = if reply.guidance < 1.0 {
        format!(", guidance {} %", (reply.guidance * 100.0).round())
    } else {
        String::new()
    };
    let fault = match reply.fault.as_str() {
        "" => String::new(),
        fault => format!("; {fault}"),
    };
    if reply.is_on {
        format!("{device}: force on, {percent} %{guidance}{fault}\n")
    } else {
        format!("{device}: force off{weaker}{guidance}{fault}\n")
    }
}

/// The devices that report that they give force.
fn told_of(client: &Client, mut until: Instant) -> Result<Vec<String>, UserError> {
    let mut infos: client::Feed<StylusInfo> =
        client.follow(&client.topics().stylus_info("*"), Qos::Cached)?;
    let mut found = Vec::new();
    while let Some(info) = infos.next_before(until) {
        if info.drives & axes::FORCE != 0 && !found.contains(&info.device) {
            until = until.min(Instant::now() + TOGETHER);
            found.push(info.device);
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_read_in_percent_and_as_numbers() {
        assert_eq!(share("60%"), Ok(0.6));
        assert_eq!(share(" 100 %"), Ok(1.0));
        assert_eq!(share("0.25"), Ok(0.25));
        for wrong in ["", "%", "-1", "101%", "60", "NaN", "inf", "six"] {
            assert!(share(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn force_comes_to_several_hands_only_where_all_are_meant() {
        #[derive(clap::Parser)]
        struct Line {
            #[command(subcommand)]
            order: Order,
        }
        let meant_by = |words: &str, devices: &[&str]| {
            let words = std::iter::once("force").chain(words.split(' '));
            let line = <Line as clap::Parser>::try_parse_from(words).expect("read");
            let (whose, order) = line.order.parts();
            let devices = devices.iter().map(|name| (*name).to_owned()).collect();
            meant(devices, whose, &order).map(|devices| devices.len())
        };
        for order in ["on", "rearm", "strength 60%", "guidance 60%"] {
            assert_eq!(meant_by(order, &["arm"]), Ok(1));
            let refused = meant_by(order, &["left", "right"]).expect_err(order);
            let names = ["left", "right"];
            assert!(
                names.iter().all(|name| refused.what.contains(name)),
                "{refused}"
            );
            assert_eq!(refused.code, maulstick_rig::user_error::EXIT_USAGE);
            assert_eq!(
                meant_by(&format!("{order} --all"), &["left", "right"]),
                Ok(2)
            );
        }
        assert_eq!(meant_by("off", &["left", "right"]), Ok(2));
    }

    #[test]
    fn a_fault_is_told_beside_the_state() {
        let mut reply = ForceReply {
            is_on: true,
            strength: 0.6,
            fault: String::new(),
            guidance: 1.0,
        };
        assert_eq!(told("arm", &reply), "arm: force on, 60 %\n");
        reply.fault = "it shakes".into();
        reply.is_on = false;
        reply.guidance = 0.4;
        assert_eq!(
            told("arm", &reply),
            "arm: force off, 60 % when it is on, guidance 40 %; it shakes\n"
        );
    }
}
