//! Effect of each step.

use std::path::Path;

use maulstick_device::Take;
use maulstick_optics::PaintLibrary;
use maulstick_painting::PaintingSetup;
use maulstick_painting::edits::{self, Form, LightChange};
use maulstick_rig::UserError;
use maulstick_rig::config::{BrushSection, is_path};
use maulstick_types::nearest::choice;
use maulstick_types::wire::topics::check_name;
use serde::Deserialize as _;

use maulstick_painting_setup::lamp::changed;
use maulstick_painting_setup::outputs::UsedFile;
use maulstick_painting_setup::surface::ground::GroundFile;
use maulstick_painting_setup::surface::tooth::ToothPicture;
use maulstick_painting_setup::{brush_file, mixture_of, refused};

use super::Act;
use super::entries::file;
use super::step::Step;
use super::stroke::{Stroke, Turn};

/// Default lean of a stroke's handle, degrees.
const LEAN_DEG: f64 = 25.0;
/// Default speed of a stroke, mm/s.
const SPEED_MM_S: f64 = 120.0;
/// No point of a stroke is farther from the canvas's corner, mm.
const FARTHEST_MM: f64 = 5000.0;
/// No stroke takes longer, s.
const LONGEST_S: f64 = 600.0;

/// Reads an edit. Its paints are spelt as the library does.
pub(super) fn edit<E: Form>(step: &Step<'_>, library: &PaintLibrary) -> Result<Act, UserError> {
    if step.kind.form.switch {
        switched_on(step)?;
    }
    let mut edit = step.keys.read(E::read_step)?;
    edit.check_idle()?;
    edit.check_names().map_err(refused)?;
    for mixture in edit.mixtures_mut() {
        let known = library.check(mixture);
        *mixture = known.map_err(refused)?;
    }
    Ok(Act::Edit(edit.into()))
}

/// Steps taken back.
#[derive(serde::Deserialize)]
struct UndoStep {
    undo: u32,
}

pub(super) fn undo(step: &Step<'_>) -> Result<Option<Act>, UserError> {
    let UndoStep { undo } = step.keys.read(UndoStep::deserialize)?;
    match undo {
        0 => Err(UserError::usage("an undo of 0 steps does nothing").help("leave it out")),
        times => Ok(Some(Act::Undo(times))),
    }
}

/// The files that a step names.
pub(super) fn files_of(step: &Step<'_>) -> Result<Vec<UsedFile>, UserError> {
    let keys = &step.keys;
    let does = step.kind.form.key;
    let what = format!("the {does} at {}", step.place());
    let file = match does {
        "take" => {
            let path = keys.text(does)?.map(|name| keys.source.folder.join(name));
            UsedFile::given(&what, path)
        }
        "brush" | "ground" | "tooth" => {
            let name = keys.text(does)?.map(|name| keys.beside(name));
            name.and_then(|name| UsedFile::named(&what, &name))
        }
        "light" => {
            let light = keys.table(does)?;
            let named = |key| {
                let name = light.as_ref().map(|light| light.text(key)).transpose()?;
                Ok::<_, UserError>(name.flatten().map(|name| keys.beside(name)))
            };
            let spectrum = named("illuminant")?.and_then(|name| UsedFile::light(&name));
            let around = named("environment")?;
            let around = around.and_then(|name| UsedFile::named("the environment", &name));
            return Ok(spectrum.into_iter().chain(around).collect());
        }
        _ => None,
    };
    Ok(file.into_iter().collect())
}

pub(super) fn switched_on(step: &Step<'_>) -> Result<(), UserError> {
    if step.due(step.keys.switch(step.kind.form.key)?)? {
        Ok(())
    } else {
        Err(UserError::usage("a step that is 'false' does nothing").help("leave it out"))
    }
}

pub(super) fn brush(step: &Step<'_>, _: &PaintLibrary) -> Result<Act, UserError> {
    let keys = &step.keys;
    let depth_share = keys.number("depth_share")?.unwrap_or(0.5);
    if !(0.0..=0.9).contains(&depth_share) {
        return Err(keys
            .fault("depth_share", format!("a depth_share of {depth_share}"))
            .help("choose 0 to 0.9"));
    }
    let kind = keys.beside(step.due(keys.text("brush")?)?);
    let stem = Path::new(&kind).file_stem().unwrap_or_default();
    let section = BrushSection {
        name: stem.to_string_lossy().into_owned(),
        size_mm: keys.number("size_mm")?,
        depth_share,
        kind,
    };
    let head = keys.named("brush", file(&section.kind), brush_file(&section))?;
    check_name(&section.name).map_err(|what| {
        UserError::usage(format!(
            "the brush would be called after its file, but {what}"
        ))
        .help("give the file another name")
    })?;
    Ok(Act::Brush(section.name, Box::new(head), depth_share))
}

pub(super) fn take(step: &Step<'_>, library: &PaintLibrary) -> Result<Act, UserError> {
    let keys = &step.keys;
    let path = keys.source.folder.join(step.due(keys.text("take")?)?);
    let name = path.display().to_string();
    let loads = keys.texts("loads")?;
    if loads.as_ref().is_some_and(Vec::is_empty) {
        return Err(keys
            .fault("loads", "a list of no loads does nothing")
            .help("leave it out: the brush continues with its own paint"));
    }
    let mixture = |text: &str| keys.named("loads", None, mixture_of(text, library));
    let loads = loads.unwrap_or_default().into_iter().map(mixture);
    let loads = loads.collect::<Result<_, _>>()?;
    let take = keys.named("take", Some(&name), Take::read(&path))?;
    Ok(Act::Take(take, loads))
}

/// Range of a key's number; other values are rejected.
fn within(
    step: &Step<'_>,
    key: &str,
    range: std::ops::RangeInclusive<f64>,
) -> Result<Option<f64>, UserError> {
    let number = step.keys.number(key)?;
    match number {
        Some(number) if !range.contains(&number) => {
            let fault = step.keys.fault(key, format!("a {key} of {number}"));
            Err(fault.help(format!("choose {} to {}", range.start(), range.end())))
        }
        _ => Ok(number),
    }
}

/// The points of a stroke: x and y, mm, and pressure.
fn points(step: &Step<'_>) -> Result<Vec<[f64; 3]>, UserError> {
    let keys = &step.keys;
    let wrong = |what: String, help: &str| Err(keys.fault("stroke", what).help(help));
    let mut points = Vec::new();
    for (place, row) in step.due(keys.rows("stroke")?)?.iter().enumerate() {
        let number = place + 1;
        let [x, y, pressure] = row[..] else {
            return wrong(
                format!("point {number} has {} numbers", row.len()),
                "a point is [x_mm, y_mm, pressure], from the canvas's lower left corner",
            );
        };
        if !(0.0..=1.0).contains(&pressure) {
            return wrong(
                format!("a pressure of {pressure} at point {number}"),
                "choose 0 to 1",
            );
        }
        let near = -FARTHEST_MM..=FARTHEST_MM;
        if !(near.contains(&x) && near.contains(&y)) {
            return wrong(
                format!("point {number} is at {x}, {y} mm"),
                "choose places on the canvas or near it, at most 5000 mm away",
            );
        }
        points.push([x, y, pressure]);
    }
    if points.is_empty() {
        return wrong(
            "a stroke of no points does nothing".to_owned(),
            "a point is [x_mm, y_mm, pressure]; one alone is a dab",
        );
    }
    Ok(points)
}

pub(super) fn stroke(step: &Step<'_>, _: &PaintLibrary) -> Result<Act, UserError> {
    let keys = &step.keys;
    let points = points(step)?;
    let turn = match (
        within(step, "turn_deg", -360.0..=360.0)?,
        within(step, "twist_deg", -360.0..=360.0)?,
    ) {
        (Some(_), Some(_)) => {
            return Err(keys
                .fault("turn_deg", "'turn_deg' and 'twist_deg' both turn the brush")
                .help("turn_deg counts from the way, twist_deg from the canvas: leave one out"));
        }
        (_, Some(twist)) => Turn::Canvas(twist),
        (turn, None) => Turn::Way(turn.unwrap_or(0.0)),
    };
    let stroke = Stroke {
        points,
        lean_deg: within(step, "lean_deg", 0.0..=80.0)?.unwrap_or(LEAN_DEG),
        toward_deg: within(step, "toward_deg", -360.0..=360.0)?,
        turn,
        speed_mm_s: within(step, "speed_mm_s", 1.0..=2000.0)?.unwrap_or(SPEED_MM_S),
    };
    if stroke.seconds() > LONGEST_S {
        let what = format!("a stroke of {:.0} s", stroke.seconds());
        let help = "make it two, or faster: a stroke takes up to 600 s";
        return Err(keys.fault("stroke", what).help(help));
    }
    Ok(Act::Stroke(stroke))
}

pub(super) fn ground(step: &Step<'_>) -> Result<Option<Act>, UserError> {
    let name = step.keys.beside(step.due(step.keys.text("ground")?)?);
    let ground = GroundFile::read(&name);
    let ground = step.keys.named("ground", file(&name), ground)?;
    Ok(Some(match ground.edit()? {
        Some(edit) => {
            let known = edits::read(&edit)?;
            known.check_names().map_err(refused)?;
            Act::Edit(edit)
        }
        None => Act::Ground(ground),
    }))
}

/// A tooth of a picture; another one is the edit alone.
pub(super) fn tooth(step: &Step<'_>) -> Result<Option<Act>, UserError> {
    let keys = &step.keys;
    let tooth = keys.beside(step.due(keys.text("tooth")?)?);
    let seed = keys.is_given("seed");
    let sizes = [keys.number("width_mm")?, keys.number("depth_um")?];
    if is_path(&tooth) {
        if seed {
            return Err(keys
                .fault("seed", "'seed' does nothing beside a picture")
                .help("a picture's tooth is the picture: leave it out"));
        }
        let picture = ToothPicture::read(&tooth, sizes[0], sizes[1]);
        let picture = keys.named("tooth", file(&tooth), picture)?;
        return Ok(Some(Act::Tooth(picture)));
    }
    for (key, size) in [("width_mm", sizes[0]), ("depth_um", sizes[1])] {
        if size.is_some() {
            return Err(keys
                .fault(
                    key,
                    format!("'{key}' does nothing beside the tooth '{tooth}'"),
                )
                .help("it is for a picture's, such as { tooth = \"weave.png\", width_mm = 60 }"));
        }
    }
    Ok(None)
}

pub(super) fn light(step: &Step<'_>) -> Result<Option<Act>, UserError> {
    let keys = step.due(step.keys.table("light")?)?;
    if keys.keys().is_empty() {
        return Err(UserError::usage(
            "a step of the light without a setting changes nothing",
        ));
    }
    let given = keys.keys();
    if let Some(key) = given.iter().find(|key| !LightChange::KEYS.contains(key)) {
        let fault = keys.fault(key, format!("a light has no key '{key}'"));
        return Err(fault.help(choice(key, LightChange::KEYS)));
    }
    let mut change: LightChange = keys.read(LightChange::deserialize)?;
    for name in [&mut change.illuminant, &mut change.environment] {
        *name = name.take().map(|name| keys.beside(&name));
    }
    change.check_idle()?;
    let named = [&change.illuminant, &change.environment];
    let missing = |name: &&String| is_path(name) && !Path::new(name).exists();
    let missing = named.into_iter().flatten().find(missing).cloned();
    let on_default = changed(&change, &PaintingSetup::default().light);
    step.keys.named("light", missing.as_deref(), on_default)?;
    Ok(Some(Act::Light(change)))
}
