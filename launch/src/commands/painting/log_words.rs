//! What a log says: who it was, and what was done, in words.

use std::collections::BTreeMap;

use maulstick_painting::edits::{FillPaint, GroundSource};
use maulstick_rig::config::DeviceSection;
use maulstick_types::Edit;
use maulstick_types::command::{Command, TakeCommand};
use maulstick_types::scene::{CANVAS, PALETTE};
use maulstick_types::values::{BrushName, Share, TICKS_A_SECOND, Ticks};
use maulstick_types::{Mixture, Region, name_hash};

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

    /// The device of a hash; one that is not known gets a number.
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

/// A surface by its number.
pub(super) fn surface(id: u32) -> String {
    match id {
        CANVAS => "canvas".to_owned(),
        PALETTE => "palette".to_owned(),
        other => format!("surface {other}"),
    }
}

/// What a command does.
pub(super) fn words(command: &Command, names: &mut Names) -> String {
    match command {
        Command::Edit(edit) => edit_words(edit),
        Command::Take(TakeCommand::Begin {
            brush,
            device,
            loads,
            again,
            ..
        }) => {
            let begins = if *again { "begin again" } else { "begin" };
            let loads: Vec<String> = loads.iter().map(mixture).collect();
            let loaded = match loads.is_empty() {
                true => String::new(),
                false => format!(", loaded with {}", loads.join("; ")),
            };
            let device = names.device(*device);
            format!("{begins} a take of {device} with {brush}{loaded}")
        }
        Command::Take(TakeCommand::Mark) => "mark a place".to_owned(),
        Command::Take(TakeCommand::Snapshot { path, .. }) => format!("write a picture: {path}"),
        // These change no paint and take no place in a record.
        Command::File(_) => "work on files".to_owned(),
        Command::Brush(_) => "change a brush".to_owned(),
        Command::Rig(_) => "change the rig".to_owned(),
        Command::Session(_) => "paint a session again".to_owned(),
    }
}

fn edit_words(edit: &Edit) -> String {
    match edit {
        Edit::Load(load) => {
            let beside = load.beside.as_ref();
            let beside =
                beside.map_or_else(String::new, |own| format!(", beside it {}", mixture(own)));
            format!(
                "load {} with {}{beside}",
                load.brush,
                mixture(&load.mixture)
            )
        }
        Edit::LoadFrom(load) => {
            let [x, y] = [load.x, load.y].map(|distance| mm(distance.get()));
            let thinner = match load.thinner.get() {
                0.0 => String::new(),
                share => format!(", with {} of thinner", percent(share)),
            };
            let from = surface(load.surface);
            format!(
                "load {} from the {from} at {x}, {y} mm{thinner}",
                load.brush
            )
        }
        Edit::Clean(clean) => format!("clean {}", clean.brush),
        Edit::Tune(tune) => format!(
            "make {} {} times as stiff, {} wet",
            tune.brush,
            number(tune.stiffness.get()),
            percent(tune.wetness.get())
        ),
        Edit::Handle(handle) => {
            let flow = handle.flow.map(|flow| flow.get() * 1e3);
            let flow = flow.map_or_else(String::new, |flow| format!(", {} µm/mm", number(flow)));
            let most = handle.most.map(|film| um(film.get()));
            let most = most.map_or_else(String::new, |most| format!(", at most {most} µm"));
            format!("use {} as {}{flow}{most}", handle.brush, handle.mode.name())
        }
        Edit::Dry(dry) => {
            let share = match dry.share {
                Share::WHOLE => String::new(),
                share => format!("{} of ", percent(share.get().into())),
            };
            let over = dry
                .over
                .map_or_else(String::new, |over| format!(" over {}", time(over)));
            let layer = dry.layer.as_ref();
            let layer = layer.map_or_else(String::new, |name| format!(" to the layer '{name}'"));
            let place = place(dry.surface, dry.region.as_ref());
            format!("dry {share}the {place}{over}{layer}")
        }
        Edit::StopDrying(stop) => format!("stop drying the {}", surface(stop.surface)),
        Edit::Wet(wet) => {
            let layers = match wet.layers {
                None => "all layers".to_owned(),
                Some(1) => "the newest layer".to_owned(),
                Some(count) => format!("the newest {count} layers"),
            };
            format!(
                "wet {layers} of the {}",
                place(wet.surface, wet.region.as_ref())
            )
        }
        Edit::Opacity(edit) => {
            let opacity = percent(edit.opacity.get().into());
            format!("make the layer {} {opacity} opaque", edit.layer)
        }
        Edit::NameLayer(edit) => format!("call the layer {} '{}'", edit.layer, edit.name),
        Edit::Place(edit) => {
            let zoom = number(edit.zoom.get());
            format!("move the {}, magnified {zoom} times", surface(edit.surface))
        }
        Edit::Relight(_) => "change the light".to_owned(),
        Edit::Ground(edit) => {
            let ground = match &edit.ground {
                GroundSource::Named { name } => name.to_string(),
                GroundSource::Spectrum { .. } => "a measured one".to_owned(),
            };
            format!(
                "give the {} another ground: {ground}",
                surface(edit.surface)
            )
        }
        Edit::Tooth(edit) => {
            let of = surface(edit.surface);
            format!(
                "give the {of} another tooth: {}, seed {}",
                edit.tooth, edit.seed
            )
        }
        Edit::Size(edit) => {
            let stain = um(edit.stain.get());
            format!("size the {}: {stain} µm stain", surface(edit.surface))
        }
        Edit::Piles(edit) => {
            let does = if edit.last { "last" } else { "deplete" };
            format!("let piles on the {} {does}", surface(edit.surface))
        }
        Edit::Fill(fill) => {
            let with = match &fill.paint {
                FillPaint::Mixture { mixture: own } => mixture(own),
                FillPaint::Carried { brush } => format!("what {brush} carries"),
            };
            let film = um(fill.thickness.get());
            format!("fill the {} with {with}, {film} µm", surface(fill.surface))
        }
        Edit::Scrape(edit) => format!("scrape the {}", place(edit.surface, edit.region.as_ref())),
        Edit::Wells(edit) => format!("change the wells of the {}", surface(edit.surface)),
        Edit::Undo(undo) => format!("undo{}", of_brush(undo.brush.as_ref())),
        Edit::Redo(redo) => format!("redo{}", of_brush(redo.brush.as_ref())),
        Edit::Keep(edit) => format!("keep the version '{}'", edit.name),
        Edit::ReturnTo(edit) => format!("return to the version '{}'", edit.name),
        Edit::Branch(edit) => format!("branch '{}' off the version '{}'", edit.name, edit.from),
        Edit::Forget(edit) => format!("forget the version '{}'", edit.name),
        Edit::GoTo(edit) => format!("go to step {}", edit.step),
        Edit::Convert(edit) => format!("convert the {} to {}", surface(edit.surface), edit.model),
    }
}

fn of_brush(brush: Option<&BrushName>) -> String {
    brush.map_or_else(String::new, |brush| format!(" the newest step of {brush}"))
}

/// A surface, or a part of it.
fn place(id: u32, region: Option<&Region>) -> String {
    let of = surface(id);
    region.map_or_else(|| of.clone(), |region| format!("{of} within {region}"))
}

/// A mixture by the shares of its paints.
fn mixture(mixture: &Mixture) -> String {
    let all: f64 = mixture.parts.iter().map(|part| part.share).sum();
    match &mixture.parts[..] {
        [only] => only.paint.clone(),
        parts => {
            let part = parts.iter().map(|part| {
                let share = percent(part.share / all);
                format!("{share} {}", part.paint)
            });
            part.collect::<Vec<_>>().join(", ")
        }
    }
}

fn time(ticks: Ticks) -> String {
    format!(
        "{} s",
        number(f64::from(ticks.get()) / f64::from(TICKS_A_SECOND))
    )
}

fn percent(share: f64) -> String {
    format!("{} %", (share * 1e3).round() / 10.0)
}

fn um(metres: f64) -> f64 {
    number(metres * 1e6)
}

fn mm(metres: f64) -> f64 {
    number(metres * 1e3)
}

/// A number to a hundredth, without the noise of its last digits.
fn number(value: f64) -> f64 {
    (value * 100.0).round() / 100.0
}

#[cfg(test)]
mod tests {
    use maulstick_painting::edits::{GoTo, Undo, examples};

    use super::*;

    #[test]
    fn each_edit_is_said_in_words() {
        let mut names = Names::default();
        for edit in examples().expect("in range") {
            let said = words(&Command::Edit(edit.clone()), &mut names);
            println!("{said}");
            let first = said.chars().next();
            assert!(first.is_some_and(char::is_lowercase), "{said}");
            for code in ['{', '}', '"', '_', '['] {
                assert!(!said.contains(code), "{said} for {edit:?}");
            }
            assert!(!said.contains("null") && !said.contains("0000"), "{said}");
        }
        assert_eq!(words(&Undo { brush: None }.into(), &mut names), "undo");
        assert_eq!(words(&GoTo { step: 7 }.into(), &mut names), "go to step 7");
        let two: Mixture = "Cobalt Blue=0.6,Titanium White=0.2"
            .parse()
            .expect("a mixture");
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
