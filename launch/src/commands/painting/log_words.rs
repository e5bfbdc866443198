//! Texts of a log: names of senders and actions.

use std::collections::BTreeMap;

use maulstick_painting::edits::{self, words::mixture};
use maulstick_rig::config::DeviceSection;
use maulstick_types::command::{Command, TakeCommand};
use maulstick_types::name_hash;

use crate::processes::{MOUSE, PEN, PLAYER};

/// The device that puts motions down (`maulstick recording replay --as`).
const MOTION: &str = "motion";

/// Names of devices, of which a painting has the hashes alone, and of senders of commands.
#[derive(Debug, Default)]
pub(super) struct Names {
    devices: BTreeMap<u32, String>,
    unknown: Vec<u32>,
    senders: Vec<u64>,
}

impl Names {
    /// Names of these devices, and of those that each rig may have.
    pub(super) fn of(devices: &[DeviceSection]) -> Self {
        let known = devices.iter().map(|device| device.name.as_str());
        let known = known.chain([MOUSE, PEN, PLAYER, MOTION]);
        Self {
            devices: known
                .map(|name| (name_hash(name), name.to_owned()))
                .collect(),
            ..Self::default()
        }
    }

    /// The device with a hash; an unknown one gets a number.
    pub(super) fn device(&mut self, hash: u32) -> String {
        match self.devices.get(&hash) {
            Some(name) => name.clone(),
            None => format!("unknown device {}", numbered(&mut self.unknown, hash)),
        }
    }

    /// The sender of a command; 0 is the program that has the painting.
    pub(super) fn sender(&mut self, client: u64) -> String {
        match client {
            0 => "maulstick".to_owned(),
            client => format!("window or command {}", numbered(&mut self.senders, client)),
        }
    }
}

/// The number of one among those that came, from 1.
fn numbered<T: PartialEq>(all: &mut Vec<T>, one: T) -> usize {
    let place = all.iter().position(|known| *known == one);
    place.unwrap_or_else(|| {
        all.push(one);
        all.len() - 1
    }) + 1
}

/// Text of a command.
pub(super) fn words(command: &Command, names: &mut Names) -> String {
    match command {
        Command::Edit(edit) => match edits::read(edit) {
            Ok(edit) => edit.log_words(),
            Err(fault) => fault.to_string(),
        },
        Command::Take(TakeCommand::Begin {
            brush,
            device,
            loads,
            again,
            ..
        }) => {
            let begins = if *again { "begin again" } else { "begin" };
            let loads: Vec<String> = loads.iter().map(mixture).collect();
            let loaded = if loads.is_empty() {
                String::new()
            } else {
                format!(", loaded with {}", loads.join("; "))
            };
            let device = names.device(*device);
            format!("{begins} a take of {device} with {brush}{loaded}")
        }
        Command::Take(TakeCommand::Mark) => "mark a place".to_owned(),
        Command::Take(TakeCommand::Snapshot { path, .. }) => format!("write a picture: {path}"),
        // These change no paint and are not in a record.
        Command::File(_) => "work on files".to_owned(),
        Command::Brush(_) => "change a brush".to_owned(),
        Command::Rig(_) => "change the rig".to_owned(),
        Command::Session(_) => "paint a session again".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use maulstick_painting::edits::{GoTo, Undo};

    use super::*;

    #[test]
    fn edits_are_said_in_words() {
        let mut names = Names::default();
        assert_eq!(words(&Undo { brush: None }.into(), &mut names), "undo");
        assert_eq!(words(&GoTo { step: 7 }.into(), &mut names), "go to step 7");
        let two = "Cobalt Blue=0.6,Titanium White=0.2".parse().expect("one");
        assert_eq!(mixture(&two), "75 % Cobalt Blue, 25 % Titanium White");
    }

    #[test]
    fn devices_and_senders_have_names_or_numbers() {
        let arm = DeviceSection::new("arm", "simulated", "main");
        let mut names = Names::of(&[arm]);
        assert_eq!(names.device(name_hash("arm")), "arm");
        assert_eq!(names.device(name_hash("mouse")), "mouse");
        let numbers = [7, 9, 7].map(|hash| names.device(hash));
        assert_eq!(
            numbers,
            ["unknown device 1", "unknown device 2", "unknown device 1"]
        );
        let senders = [0, 77, 5, 77].map(|client| names.sender(client));
        let expected = ["maulstick", "window or command 1", "window or command 2"];
        assert_eq!(senders[..3], expected);
        assert_eq!(senders[3], expected[1]);
    }
}
