//! A script: a day at the easel, a step after the other.
//!
//! ```toml
//! step = [
//!     { brush = "filbert", size_mm = 12 },
//!     { load = "Ultramarine Blue=0.6,Titanium White=0.4" },
//!     { take = "sky.mcap" },
//!     { dry = 1.0, layer = "sky" },
//! ]
//! ```
//!
//! A step has one key that says what is done, and perhaps others that say how. Paths count from the
//! script's folder. All of it is read before anything is painted.

use std::path::Path;

use maulstick_brush::BrushFile;
use maulstick_device::{Take, brush_file};
use maulstick_optics::PaintLibrary;
use maulstick_rig::Fault;
use maulstick_rig::config::{BrushSection, is_path, toml_fault};
use maulstick_types::command::Command;
use maulstick_types::scene::{BrushMode, CANVAS};
use maulstick_types::{Mixture, Region};
use serde::Deserialize;
use toml::Spanned;

use crate::commands::mode::{handling, piles_command};
use crate::duration::{ticks_in, time_ns};
use crate::ground::GroundFile;
use crate::lamp::LightChange;
use crate::performance::mixture_of;

/// Thickness of a film for which nothing is said, µm.
const FILM_UM: f64 = 50.0;
/// The keys that say what is done, and those that say how.
const STEPS: [(&str, &[&str]); 20] = [
    ("brush", &["size_mm", "depth_share"]),
    ("load", &["beside"]),
    ("clean", &[]),
    ("mode", &["flow", "most_um"]),
    ("fill_with_brush", &["um"]),
    ("stain_um", &[]),
    ("piles", &[]),
    ("take", &["loads"]),
    ("dry", &["layer", "region", "over"]),
    ("wait", &[]),
    ("stop_drying", &[]),
    ("wet", &["region"]),
    ("opacity", &["layer"]),
    ("fill", &["um"]),
    ("ground", &[]),
    ("tooth", &["seed"]),
    ("light", &[]),
    ("undo", &[]),
    ("keep", &[]),
    ("return", &[]),
];

/// What is done in a step.
#[derive(Clone, Debug)]
pub enum Act {
    /// Takes up a brush: its name, its file, the share of its head that full pressure presses in.
    Brush(String, Box<BrushFile>, f64),
    /// Loads the brush; with two mixtures a half of its width with each.
    Load(Mixture, Option<Mixture>),
    /// Takes all paint off the brush.
    Clean,
    /// Uses the brush in another way: mode, flow of the marker, most paint, m.
    Handle(BrushMode, f64, f64),
    /// Lays a film of what the brush carries over the canvas, m.
    FillWith(f64),
    /// Follows a take; its strokes load these mixtures in turn.
    Take(Take, Vec<Mixture>),
    /// Gives the canvas another ground.
    Ground(GroundFile),
    /// Lets time go by, in sixtieths of a second.
    Wait(u32),
    /// Changes the light.
    Light(LightChange),
    /// Takes so many steps back.
    Undo(u32),
    /// Anything else.
    Command(Command),
}

/// The steps of a script, each with its place, file and line.
#[derive(Clone, Debug)]
pub struct Script(pub Vec<(String, Act)>);

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    step: Vec<Spanned<Raw>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Raw {
    brush: Option<String>,
    size_mm: Option<f64>,
    depth_share: Option<f64>,
    load: Option<String>,
    beside: Option<String>,
    clean: Option<bool>,
    mode: Option<String>,
    flow: Option<f64>,
    most_um: Option<f64>,
    fill_with_brush: Option<bool>,
    stain_um: Option<f64>,
    piles: Option<String>,
    take: Option<String>,
    loads: Option<Vec<String>>,
    dry: Option<f32>,
    layer: Option<Word>,
    region: Option<String>,
    over: Option<String>,
    wait: Option<String>,
    stop_drying: Option<bool>,
    wet: Option<Word>,
    opacity: Option<f32>,
    fill: Option<String>,
    um: Option<f64>,
    ground: Option<String>,
    tooth: Option<String>,
    seed: Option<u64>,
    light: Option<LightChange>,
    undo: Option<u32>,
    keep: Option<String>,
    #[serde(rename = "return")]
    back: Option<String>,
}

/// A name, or a number.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
enum Word {
    Number(u32),
    Name(String),
}

impl Word {
    fn text(self) -> String {
        match self {
            Self::Number(number) => number.to_string(),
            Self::Name(name) => name,
        }
    }

    /// How many layers; 0 for all.
    fn count(&self) -> Result<u32, Fault> {
        match self {
            Self::Number(number) if *number > 0 => Ok(*number),
            Self::Name(name) if name == "all" => Ok(0),
            _ => Err(
                Fault::usage("'wet' takes how many of the newest layers, or \"all\"")
                    .help("{ wet = 1 }, { wet = \"all\" }"),
            ),
        }
    }
}

fn region(text: &str) -> Result<Region, Fault> {
    text.parse().map_err(Fault::usage)
}

/// A drying at once, or over a time.
fn drying(
    share: f32,
    name: String,
    region: Option<Region>,
    over: Option<&str>,
) -> Result<Command, Fault> {
    let surface = CANVAS;
    let Some(time) = over else {
        return Ok(match region {
            None => Command::Dry {
                surface,
                share,
                name,
            },
            Some(region) => Command::DryRegion {
                surface,
                share,
                name,
                region,
            },
        });
    };
    if share != 1.0 {
        return Err(Fault::usage("over a time all that is wet dries")
            .help("{ dry = 1.0, over = \"90s\" }; a `stop_drying` leaves the rest wet"));
    }
    Ok(Command::DryOver {
        surface,
        ticks: ticks_in(time).map_err(Fault::usage)?,
        name,
        region,
    })
}

impl Script {
    /// Reads a script, its takes and brushes.
    ///
    /// # Errors
    /// A [`Fault`] with file and line.
    pub fn read(path: &Path, library: &PaintLibrary) -> Result<Self, Fault> {
        let text = std::fs::read_to_string(path).map_err(|error| Fault::reading(path, &error))?;
        let name = path.display().to_string();
        let file: File = toml::from_str(&text).map_err(|error| {
            let fault = toml_fault(&text, &name, &error);
            match error.message().starts_with("unknown field") {
                true => fault,
                false => fault.help("a script is `step = [ { load = \"Bone Black\" }, … ]`"),
            }
        })?;
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        let steps = file.step.into_iter().map(|step| {
            let line = text[..step.span().start].matches('\n').count() + 1;
            let place = format!("{name}:{line}");
            let act = step.into_inner().act(&folder, library);
            let placed = |fault: Fault| match fault.place {
                // What is wrong with another file is said with its place.
                Some(_) => fault,
                None => fault.at(place.clone()),
            };
            Ok((place.clone(), act.map_err(placed)?))
        });
        steps.collect::<Result<_, _>>().map(Self)
    }

    /// Length of all takes and waits, ns.
    #[must_use]
    pub fn length_ns(&self) -> u64 {
        let lengths = self.0.iter().map(|(_, act)| match act {
            Act::Take(take, _) => take.length_ns(),
            Act::Wait(ticks) => time_ns(*ticks),
            _ => 0,
        });
        lengths.sum()
    }
}

impl Raw {
    /// The keys that are given.
    fn keys(&self) -> Vec<&'static str> {
        let keys = [
            ("brush", self.brush.is_some()),
            ("size_mm", self.size_mm.is_some()),
            ("depth_share", self.depth_share.is_some()),
            ("load", self.load.is_some()),
            ("beside", self.beside.is_some()),
            ("clean", self.clean.is_some()),
            ("mode", self.mode.is_some()),
            ("flow", self.flow.is_some()),
            ("most_um", self.most_um.is_some()),
            ("fill_with_brush", self.fill_with_brush.is_some()),
            ("stain_um", self.stain_um.is_some()),
            ("piles", self.piles.is_some()),
            ("take", self.take.is_some()),
            ("loads", self.loads.is_some()),
            ("dry", self.dry.is_some()),
            ("layer", self.layer.is_some()),
            ("region", self.region.is_some()),
            ("over", self.over.is_some()),
            ("wait", self.wait.is_some()),
            ("stop_drying", self.stop_drying.is_some()),
            ("wet", self.wet.is_some()),
            ("opacity", self.opacity.is_some()),
            ("fill", self.fill.is_some()),
            ("um", self.um.is_some()),
            ("ground", self.ground.is_some()),
            ("tooth", self.tooth.is_some()),
            ("seed", self.seed.is_some()),
            ("light", self.light.is_some()),
            ("undo", self.undo.is_some()),
            ("keep", self.keep.is_some()),
            ("return", self.back.is_some()),
        ];
        let given = keys.into_iter().filter(|(_, given)| *given);
        given.map(|(key, _)| key).collect()
    }

    /// Sees that the step does one thing, and that the other keys are that thing's.
    fn check(&self) -> Result<(), Fault> {
        let keys = self.keys();
        if [self.clean, self.fill_with_brush, self.stop_drying].contains(&Some(false)) {
            let fault = Fault::usage("a step that is 'false' does nothing");
            return Err(fault.help("leave it out"));
        }
        let what: Vec<_> = STEPS
            .iter()
            .filter(|(step, _)| keys.contains(step))
            .collect();
        let names = STEPS.map(|(step, _)| step).join(", ");
        let [(step, options)] = what[..] else {
            let what = match what.len() {
                0 => "a step that does nothing",
                _ => "a step that does several things",
            };
            return Err(Fault::usage(what).help(format!("a step has one of: {names}")));
        };
        match keys
            .iter()
            .find(|key| *key != step && !options.contains(key))
        {
            None => Ok(()),
            Some(key) => Err(Fault::usage(format!("'{key}' says nothing of '{step}'"))
                .help(format!("'{step}' takes: {}", options.join(", ")))),
        }
    }

    fn act(self, folder: &Path, library: &PaintLibrary) -> Result<Act, Fault> {
        self.check()?;
        let mixture = |text: &String| mixture_of(text, library);
        let beside = |name: &str| folder.join(name);
        let command = |command: Command| {
            command.check().map_err(Fault::usage)?;
            Ok(Act::Command(command))
        };
        if let Some(share) = self
            .depth_share
            .filter(|share| !(0.0..=0.9).contains(share))
        {
            return Err(Fault::usage(format!("depth_share = {share}")).help("choose 0 to 0.9"));
        }
        if let Some(kind) = self.brush {
            let stem = Path::new(&kind).file_stem();
            let section = BrushSection {
                name: stem.unwrap_or_default().to_string_lossy().into_owned(),
                kind: match is_path(&kind) {
                    true => beside(&kind).display().to_string(),
                    false => kind,
                },
                size_mm: self.size_mm,
                depth_share: self.depth_share.unwrap_or(0.5),
            };
            let file = brush_file(&section)?;
            return Ok(Act::Brush(
                section.name,
                Box::new(file),
                section.depth_share,
            ));
        }
        if let Some(mode) = &self.mode {
            let handling = handling("brush", mode, self.flow, self.most_um)?;
            return Ok(Act::Handle(handling.mode, handling.flow, handling.most_m));
        }
        let thickness_m = self.um.unwrap_or(FILM_UM) * 1e-6;
        if self.fill_with_brush.is_some() {
            let brush = "brush".to_owned();
            let fill = Command::FillWith {
                surface: CANVAS,
                brush,
                thickness_m,
            };
            fill.check().map_err(Fault::usage)?;
            return Ok(Act::FillWith(thickness_m));
        }
        if let Some(um) = self.stain_um {
            let (surface, stain_m) = (CANVAS, um * 1e-6);
            return command(Command::Size { surface, stain_m });
        }
        if let Some(piles) = &self.piles {
            return command(piles_command(piles)?);
        }
        if let Some(load) = &self.load {
            let other = self.beside.as_ref().map(mixture).transpose()?;
            return Ok(Act::Load(mixture(load)?, other));
        }
        if let Some(take) = &self.take {
            let loads = self.loads.iter().flatten().map(mixture);
            return Ok(Act::Take(
                Take::read(&beside(take))?,
                loads.collect::<Result<_, _>>()?,
            ));
        }
        if let Some(opacity) = self.opacity {
            let layer = self.layer.ok_or_else(|| {
                Fault::usage("no layer is named").help("{ opacity = 0.5, layer = \"sky\" }")
            })?;
            let layer = layer.text();
            return command(Command::LayerOpacity { layer, opacity });
        }
        if let Some(mut light) = self.light {
            let file = light.illuminant.iter_mut().filter(|name| is_path(name));
            file.for_each(|name| *name = beside(name).display().to_string());
            // What is wrong in itself is said before anything is painted.
            light.on(&maulstick_paint::PaintingSetup::default().light)?;
            return Ok(Act::Light(light));
        }
        if let Some(times) = self.undo {
            return Ok(Act::Undo(times));
        }
        let region = self.region.as_deref().map(region).transpose()?;
        if let Some(share) = self.dry {
            let name = self.layer.map_or(String::new(), Word::text);
            return command(drying(share, name, region, self.over.as_deref())?);
        }
        if let Some(layers) = self.wet {
            return command(Command::Wet {
                surface: CANVAS,
                layers: layers.count()?,
                region,
            });
        }
        if let Some(time) = &self.wait {
            return Ok(Act::Wait(ticks_in(time).map_err(Fault::usage)?));
        }
        if self.stop_drying.is_some() {
            return command(Command::StopDrying { surface: CANVAS });
        }
        if let Some(paint) = &self.fill {
            return command(Command::Fill {
                surface: CANVAS,
                mixture: mixture(paint)?,
                thickness_m,
            });
        }
        if let Some(ground) = self.ground {
            let file = beside(&ground);
            let ground = match is_path(&ground) {
                true => file.display().to_string(),
                false => ground,
            };
            return Ok(Act::Ground(GroundFile::read(&ground)?));
        }
        if let Some(tooth) = self.tooth {
            return command(Command::Tooth {
                surface: CANVAS,
                tooth,
                seed: self.seed.unwrap_or(1),
            });
        }
        match (self.keep, self.back) {
            (Some(name), _) => command(Command::Keep { name }),
            (_, Some(name)) => command(Command::Return { name }),
            _ => Ok(Act::Clean),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(steps: &str) -> Result<Script, Fault> {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("day.toml");
        std::fs::write(&path, format!("# a day\nstep = [\n{steps}\n]\n")).expect("written");
        Script::read(&path, &PaintLibrary::measured().expect("whole"))
    }

    #[test]
    fn steps_are_read_in_their_order() {
        let steps = "{ brush = \"flat\", size_mm = 20 },\n{ load = \"Bone Black\" },\n{ clean = true },\n\
            { fill = \"Titanium White\", um = 30 },\n{ dry = 0.5, layer = \"sky\" },\n\
            { opacity = 0.3, layer = \"sky\" },\n{ light = { intensity = 2 } },\n{ undo = 2 }";
        let script = read(steps).expect("a script");
        assert_eq!(script.0.len(), 8);
        assert!(
            matches!(&script.0[0].1, Act::Brush(name, file, _) if name == "flat" && file.head.width_mm == 20.0)
        );
        assert!(matches!(script.0[7].1, Act::Undo(2)));
        assert!(script.0[4].0.ends_with("day.toml:7"));
    }

    #[test]
    fn what_is_wrong_has_its_line_and_the_nearest_name() {
        let says = |steps: &str, words: &[&str]| {
            let fault = read(steps).expect_err(steps).to_string();
            for word in words {
                assert!(fault.contains(word), "{steps}: {fault}");
            }
        };
        says(
            "{ load = \"Bone Black\" },\n{ drie = 1.0 },",
            &["day.toml:4", "'drie'", "'dry'"],
        );
        says("{ load = \"Bone Balck\" }", &["day.toml:3", "Bone Black"]);
        says("{ size_mm = 3 }", &["day.toml:3", "does nothing"]);
        says("{ dry = 1.0, undo = 1 }", &["several", "brush, load"]);
        says(
            "{ fill = \"Bone Black\", layer = \"x\" }",
            &["'layer'", "um"],
        );
        says("{ take = \"none.mcap\" }", &["none.mcap"]);
        says("{ brush = \"flta\" }", &["day.toml:3", "'flat'"]);
        says("{ opacity = 3, layer = \"x\" }", &["day.toml:3", "0 to 1"]);
        says("{ light = { intensity = -1 } }", &["day.toml:3"]);
        says("{ dry = \"all\" }", &["day.toml:3", "step = ["]);
        says("{ mode = \"spunge\" }", &["day.toml:3", "'sponge'"]);
        says("{ mode = \"marker\", flow = -1 }", &["day.toml:3", "µm/mm"]);
        says("{ stain_um = -2 }", &["day.toml:3", "0 to 1000"]);
        says("{ piles = \"stay\" }", &["day.toml:3", "deplete"]);
        says("{ clean = false }", &["day.toml:3", "does nothing"]);
        says("{ brush = \"flat\", depth_share = 5.0 }", &["day.toml:3"]);
    }
}
