//! The kinds of steps, and the keys of each.

use maulstick_optics::PaintLibrary;
use maulstick_rig::UserError;
use maulstick_types::advice::nearest;
use maulstick_types::command::Command;
use maulstick_types::scene::CANVAS;
use maulstick_types::{Mixture, Region};
use toml::de::DeTable;

use super::Act;
use super::acts::{
    brush, command, dry, fill_with_brush, film_m, ground, light, load, mode, opacity, stroke,
    switched_on, take, tooth, wet,
};
use super::entries::{Entries, Source};
use crate::commands::mode::piles_command;
use crate::duration::ticks_in;
use crate::performance::mixture_of;

/// A kind of step.
#[derive(Debug)]
pub(super) struct Kind {
    /// The key that says what is done.
    pub(super) does: &'static str,
    /// The keys that say how.
    with: &'static [&'static str],
    /// Example of its form.
    pub(super) example: &'static str,
    act: fn(&Step<'_>, &PaintLibrary) -> Result<Act, UserError>,
}

const fn kind(
    does: &'static str,
    with: &'static [&'static str],
    example: &'static str,
    act: fn(&Step<'_>, &PaintLibrary) -> Result<Act, UserError>,
) -> Kind {
    Kind {
        does,
        with,
        example,
        act,
    }
}

/// All kinds of steps.
pub(super) static KINDS: [Kind; 21] = [
    kind(
        "brush",
        &["size_mm", "depth_share"],
        "{ brush = \"filbert\", size_mm = 14, depth_share = 0.5 }",
        brush,
    ),
    kind(
        "load",
        &["beside"],
        "{ load = \"Ultramarine Blue=0.6,Titanium White=0.4\", beside = \"Bone Black\" }",
        load,
    ),
    kind("clean", &[], "{ clean = true }", |step, _| {
        switched_on(step)?;
        Ok(Act::Clean)
    }),
    kind(
        "mode",
        &["flow", "most_um"],
        "{ mode = \"marker\", flow = 4, most_um = 60 }",
        mode,
    ),
    kind(
        "fill_with_brush",
        &["um"],
        "{ fill_with_brush = true, um = 30 }",
        fill_with_brush,
    ),
    kind("stain_um", &[], "{ stain_um = 3 }", |step, _| {
        let um = step.due(step.keys.number("stain_um")?)?;
        let (surface, stain_m) = (CANVAS, um * 1e-6);
        command(Command::Size { surface, stain_m })
    }),
    kind("piles", &[], "{ piles = \"last\" }", |step, _| {
        command(piles_command(step.due(step.keys.text("piles")?)?)?)
    }),
    kind(
        "take",
        &["loads"],
        "{ take = \"sky.mcap\", loads = [\"Burnt Sienna\", \"Bone Black\"] }",
        take,
    ),
    kind(
        "stroke",
        &[
            "lean_deg",
            "toward_deg",
            "turn_deg",
            "twist_deg",
            "speed_mm_s",
        ],
        "{ stroke = [[20, 30, 0.3], [60, 34, 0.5], [90, 30, 0.1]], lean_deg = 25 }",
        stroke,
    ),
    kind(
        "dry",
        &["layer", "region", "over"],
        "{ dry = 0.5, layer = \"sky\", region = \"10,20,60x40\" }, { dry = 1.0, over = \"90s\" }",
        dry,
    ),
    kind("wait", &[], "{ wait = \"20min\" }", |step, _| {
        let time = step.due(step.keys.text("wait")?)?;
        Ok(Act::Wait(ticks_in(time).map_err(UserError::told)?))
    }),
    kind("stop_drying", &[], "{ stop_drying = true }", |step, _| {
        switched_on(step)?;
        command(Command::StopDrying { surface: CANVAS })
    }),
    kind(
        "wet",
        &["region"],
        "{ wet = 1 }, { wet = \"all\", region = \"10,20,60x40\" }",
        wet,
    ),
    kind(
        "opacity",
        &["layer"],
        "{ opacity = 0.7, layer = \"sky\" }",
        opacity,
    ),
    kind(
        "fill",
        &["um"],
        "{ fill = \"Yellow Ochre=0.3,Titanium White=0.7\", um = 40 }",
        |step, library| {
            let mixture = step.mixture("fill", library)?;
            command(Command::Fill {
                surface: CANVAS,
                mixture: step.due(mixture)?,
                thickness_m: film_m(step)?,
            })
        },
    ),
    kind("ground", &[], "{ ground = \"grey\" }", ground),
    kind(
        "tooth",
        &["seed", "width_mm", "depth_um"],
        "{ tooth = \"linen\", seed = 2 }, { tooth = \"weave.png\", width_mm = 60, depth_um = 80 }",
        tooth,
    ),
    kind(
        "light",
        &[],
        "{ light = { illuminant = \"A\", direction = [-0.7, 0.3, 0.5] } }",
        light,
    ),
    kind("undo", &[], "{ undo = 1 }", |step, _| {
        match step.due(step.keys.whole("undo")?)? {
            0 => Err(UserError::usage("an undo of 0 steps does nothing").help("leave it out")),
            times => Ok(Act::Undo(times)),
        }
    }),
    kind("keep", &[], "{ keep = \"before the glaze\" }", |step, _| {
        let name = step.due(step.keys.text("keep")?)?.to_owned();
        command(Command::Keep { name })
    }),
    kind(
        "return",
        &[],
        "{ return = \"before the glaze\" }",
        |step, _| {
            let name = step.due(step.keys.text("return")?)?.to_owned();
            command(Command::Return { name })
        },
    ),
];

/// A step as it is written.
#[derive(Debug)]
pub(super) struct Step<'a> {
    pub(super) kind: &'static Kind,
    pub(super) keys: Entries<'a>,
}

impl<'a> Step<'a> {
    /// A step that does one thing, and whose other keys are that thing's.
    fn of(source: Source<'a>, table: &'a DeTable<'a>, start: usize) -> Result<Self, UserError> {
        let all = || KINDS.each_ref().map(|kind| kind.does).join(", ");
        let keys = Entries {
            source,
            table,
            example: "{ load = \"Bone Black\" }",
        };
        let given = keys.keys();
        let kinds: Vec<&Kind> = KINDS
            .iter()
            .filter(|kind| given.contains(&kind.does))
            .collect();
        let known = || {
            KINDS
                .iter()
                .flat_map(|kind| kind.with.iter().chain([&kind.does]))
        };
        if let Some(key) = given.iter().find(|key| !known().any(|known| known == *key)) {
            let meant = nearest(key, known().copied());
            let help = match (meant, &kinds[..]) {
                (Some(name), [kind]) => format!("did you mean '{name}'? {}", kind.takes()),
                (Some(name), _) => format!("did you mean '{name}'? Steps do one of: {}", all()),
                (None, [kind]) => kind.takes(),
                (None, _) => format!("steps do one of: {}", all()),
            };
            return Err(keys.fault(key, format!("unknown key '{key}'")).help(help));
        }
        let [kind] = kinds[..] else {
            let fault = match given.first() {
                None => UserError::usage("a step that does nothing").at(source.place(start)),
                Some(key) if kinds.is_empty() => {
                    keys.fault(key, format!("'{key}' alone is a step that does nothing"))
                }
                Some(_) => {
                    let does: Vec<_> = kinds.iter().map(|kind| kind.does).collect();
                    let what = format!("a step that does several things: {}", does.join(", "));
                    keys.fault(kinds[0].does, what)
                }
            };
            return Err(fault.help(format!("a step does one of: {}", all())));
        };
        let other = given
            .iter()
            .find(|key| **key != kind.does && !kind.with.contains(key));
        if let Some(key) = other {
            let what = format!("'{key}' does nothing beside '{}'", kind.does);
            return Err(keys.fault(key, what).help(kind.takes()));
        }
        let example = kind.example;
        Ok(Self {
            kind,
            keys: Entries { example, ..keys },
        })
    }

    /// File and line.
    pub(super) fn place(&self) -> String {
        self.keys.place(self.kind.does)
    }

    /// Value of a required key: it makes the step one of its kind, or is reported as missing.
    pub(super) fn due<T>(&self, value: Option<T>) -> Result<T, UserError> {
        value.ok_or_else(|| UserError::usage(format!("'{}' lacks a key", self.kind.does)))
    }

    pub(super) fn mixture(
        &self,
        key: &str,
        library: &PaintLibrary,
    ) -> Result<Option<Mixture>, UserError> {
        let Some(text) = self.keys.text(key)? else {
            return Ok(None);
        };
        self.keys
            .named(key, None, mixture_of(text, library))
            .map(Some)
    }

    pub(super) fn region(&self) -> Result<Option<Region>, UserError> {
        let text = self.keys.text("region")?;
        text.map(|text| text.parse().map_err(UserError::told))
            .transpose()
    }
}

impl Kind {
    fn takes(&self) -> String {
        match self.with.is_empty() {
            true => format!("'{}' takes no other key", self.does),
            false => format!("'{}' takes: {}", self.does, self.with.join(", ")),
        }
    }
}

/// The steps of a script as they are written.
pub(super) fn listed<'a>(
    source: Source<'a>,
    script: &'a DeTable<'a>,
) -> Result<Vec<Step<'a>>, UserError> {
    let tables = source.listed(script)?.into_iter();
    tables
        .map(|(start, table)| Step::of(source, table, start))
        .collect()
}

/// Action of a step. An error has its place, and advice.
pub(super) fn act(step: &Step<'_>, library: &PaintLibrary) -> Result<Act, UserError> {
    (step.kind.act)(step, library).map_err(|mut fault| {
        fault.place.get_or_insert_with(|| step.place());
        fault.help.get_or_insert_with(|| step.keys.for_example());
        fault
    })
}
