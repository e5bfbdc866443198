//! Effect of each step.

use std::path::Path;

use maulstick_appearance::ground::check_ground;
use maulstick_canvas::assets::{Assets, IMAGE, SPECTRUM};
use maulstick_device::Take;
use maulstick_optics::PaintLibrary;
use maulstick_painting::PaintingSetup;
use maulstick_painting::setup::relief_called;
use maulstick_rig::UserError;
use maulstick_rig::config::{BrushSection, is_path};
use maulstick_types::advice::choice;
use maulstick_types::command::Command;
use maulstick_types::scene::CANVAS;
use maulstick_types::topics::check_name;

use super::Act;
use super::entries::file;
use super::steps::Step;
use super::stroke::{Stroke, Turn};
use crate::commands::mode::handling;
use crate::duration::ticks_in;
use crate::ground::GroundFile;
use crate::lamp::LightChange;
use crate::outputs::UsedFile;
use crate::performance::{brush_file, mixture_of, refused};
use crate::tooth::ToothPicture;

/// Thickness of a film for which nothing is said, µm.
const FILM_UM: f64 = 50.0;
/// Lean of a stroke's handle for which nothing is said, degrees.
const LEAN_DEG: f64 = 25.0;
/// Speed of a stroke for which nothing is said, mm/s.
const SPEED_MM_S: f64 = 120.0;
/// No point of a stroke is farther from the canvas's corner, mm.
const FARTHEST_MM: f64 = 5000.0;
/// No stroke takes longer, s.
const LONGEST_S: f64 = 600.0;
/// The keys of a light.
const LIGHT: [&str; 10] = [
    "illuminant",
    "direction",
    "intensity",
    "exposure",
    "relief",
    "softness",
    "observer",
    "rule",
    "samples",
    "adapted",
];

pub(super) fn command(command: Command) -> Result<Act, UserError> {
    command.check().map_err(UserError::told)?;
    Ok(Act::Command(command))
}

/// The file that a step names, if it names one.
pub(super) fn file_of(step: &Step<'_>) -> Result<Option<UsedFile>, UserError> {
    let keys = &step.keys;
    let does = step.kind.does;
    let what = format!("the {does} at {}", step.place());
    Ok(match does {
        "take" => {
            let path = keys.text(does)?.map(|name| keys.source.folder.join(name));
            UsedFile::given(&what, path)
        }
        "brush" | "ground" | "tooth" => {
            let name = keys.text(does)?.map(|name| keys.beside(name));
            name.and_then(|name| UsedFile::named(&what, &name))
        }
        "light" => {
            let light = keys.table(does)?.map(|light| light.text("illuminant"));
            let name = light.transpose()?.flatten().map(|name| keys.beside(name));
            name.and_then(|name| UsedFile::light(&name))
        }
        _ => None,
    })
}

pub(super) fn switched_on(step: &Step<'_>) -> Result<(), UserError> {
    match step.due(step.keys.switch(step.kind.does)?)? {
        true => Ok(()),
        false => Err(UserError::usage("a step that is 'false' does nothing").help("leave it out")),
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

pub(super) fn load(step: &Step<'_>, library: &PaintLibrary) -> Result<Act, UserError> {
    let mixture = step.due(step.mixture("load", library)?)?;
    Ok(Act::Load(mixture, step.mixture("beside", library)?))
}

pub(super) fn mode(step: &Step<'_>, _: &PaintLibrary) -> Result<Act, UserError> {
    let keys = &step.keys;
    let (flow, most_um) = (keys.number("flow")?, keys.number("most_um")?);
    let handling = handling("brush", step.due(keys.text("mode")?)?, flow, most_um)?;
    Ok(Act::Handle(handling.mode, handling.flow, handling.most_m))
}

pub(super) fn film_m(step: &Step<'_>) -> Result<f64, UserError> {
    Ok(step.keys.number("um")?.unwrap_or(FILM_UM) * 1e-6)
}

pub(super) fn fill_with_brush(step: &Step<'_>, _: &PaintLibrary) -> Result<Act, UserError> {
    switched_on(step)?;
    let thickness_m = film_m(step)?;
    // The brush in hand is known only when the step comes.
    command(Command::FillWith {
        surface: CANVAS,
        brush: "brush".to_owned(),
        thickness_m,
    })?;
    Ok(Act::FillWith(thickness_m))
}

pub(super) fn take(step: &Step<'_>, library: &PaintLibrary) -> Result<Act, UserError> {
    let keys = &step.keys;
    let path = keys.source.folder.join(step.due(keys.text("take")?)?);
    let name = path.display().to_string();
    let loads = keys.texts("loads")?;
    if loads.as_ref().is_some_and(Vec::is_empty) {
        return Err(keys
            .fault("loads", "a list of no loads does nothing")
            .help("leave it out: the brush paints on with what it has"));
    }
    let mixture = |text: &str| keys.named("loads", None, mixture_of(text, library));
    let loads = loads.unwrap_or_default().into_iter().map(mixture);
    let loads = loads.collect::<Result<_, _>>()?;
    let take = keys.named("take", Some(&name), Take::read(&path))?;
    Ok(Act::Take(take, loads))
}

/// Range of a key's number; what else is given is refused.
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

pub(super) fn stroke(step: &Step<'_>, _: &PaintLibrary) -> Result<Act, UserError> {
    let keys = &step.keys;
    let rows = step.due(keys.rows("stroke")?)?;
    let wrong = |what: String, help: &str| Err(keys.fault("stroke", what).help(help));
    if rows.is_empty() {
        return wrong(
            "a stroke of no points does nothing".to_owned(),
            "a point is [x_mm, y_mm, pressure]; one alone is a dab",
        );
    }
    let mut points = Vec::with_capacity(rows.len());
    for (place, row) in rows.iter().enumerate() {
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
        return wrong(
            format!("a stroke of {:.0} s", stroke.seconds()),
            "make it two, or faster: a stroke takes up to 600 s",
        );
    }
    Ok(Act::Stroke(stroke))
}

/// A drying at once, or over a time.
pub(super) fn dry(step: &Step<'_>, _: &PaintLibrary) -> Result<Act, UserError> {
    let (keys, surface) = (&step.keys, CANVAS);
    let share = step.due(keys.number("dry")?)? as f32;
    let name = keys.word("layer")?.unwrap_or_default();
    let region = step.region()?;
    let Some(time) = keys.text("over")? else {
        return command(match region {
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
        return Err(UserError::usage("over a time all that is wet dries")
            .help("{ dry = 1.0, over = \"90s\" }; a `stop_drying` leaves the rest wet"));
    }
    command(Command::DryOver {
        surface,
        ticks: ticks_in(time).map_err(UserError::told)?,
        name,
        region,
    })
}

pub(super) fn wet(step: &Step<'_>, _: &PaintLibrary) -> Result<Act, UserError> {
    let layers = step.due(step.keys.word("wet")?)?;
    let layers = match layers.parse() {
        Ok(count) if count > 0 => count,
        // As commands have it.
        _ if layers == "all" => 0,
        _ => {
            let what =
                format!("'wet' takes how many of the newest layers, or \"all\", not {layers}");
            return Err(UserError::usage(what));
        }
    };
    command(Command::Wet {
        surface: CANVAS,
        layers,
        region: step.region()?,
    })
}

pub(super) fn opacity(step: &Step<'_>, _: &PaintLibrary) -> Result<Act, UserError> {
    let opacity = step.due(step.keys.number("opacity")?)? as f32;
    let Some(layer) = step.keys.word("layer")? else {
        return Err(UserError::usage("no layer is named"));
    };
    command(Command::LayerOpacity { layer, opacity })
}

/// True if a name refers to something stored in a painting: only the painting can tell.
fn is_held(name: &str) -> bool {
    name.starts_with(IMAGE) || name.starts_with(SPECTRUM)
}

pub(super) fn ground(step: &Step<'_>, _: &PaintLibrary) -> Result<Act, UserError> {
    let name = step.keys.beside(step.due(step.keys.text("ground")?)?);
    let ground = GroundFile::read(&name);
    let ground = step.keys.named("ground", file(&name), ground)?;
    match &ground {
        GroundFile::Named(name) if !is_held(name) => {
            check_ground(name, &Assets::default()).map_err(refused)?;
        }
        _ => {}
    }
    Ok(Act::Ground(ground))
}

pub(super) fn tooth(step: &Step<'_>, _: &PaintLibrary) -> Result<Act, UserError> {
    let keys = &step.keys;
    let tooth = keys.beside(step.due(keys.text("tooth")?)?);
    let seed: Option<u64> = keys.whole("seed")?;
    let sizes = [keys.number("width_mm")?, keys.number("depth_um")?];
    if is_path(&tooth) {
        if seed.is_some() {
            return Err(keys
                .fault("seed", "'seed' does nothing beside a picture")
                .help("a picture's tooth is the picture: leave it out"));
        }
        let picture = ToothPicture::read(&tooth, sizes[0], sizes[1]);
        return Ok(Act::Tooth(keys.named("tooth", file(&tooth), picture)?));
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
    let seed = seed.unwrap_or(1);
    if !is_held(&tooth) {
        let cell_m = PaintingSetup::default().cell_m;
        relief_called(&tooth, seed, cell_m, &Assets::default()).map_err(refused)?;
    }
    command(Command::Tooth {
        surface: CANVAS,
        tooth,
        seed,
    })
}

pub(super) fn light(step: &Step<'_>, _: &PaintLibrary) -> Result<Act, UserError> {
    let keys = step.due(step.keys.table("light")?)?;
    let given = keys.keys();
    if let Some(key) = given.iter().find(|key| !LIGHT.contains(key)) {
        let fault = keys.fault(key, format!("a light has no key '{key}'"));
        return Err(fault.help(choice(key, LIGHT)));
    }
    if given.is_empty() {
        return Err(UserError::usage(
            "a light of which nothing is said changes nothing",
        ));
    }
    let illuminant = keys.text("illuminant")?.map(|name| keys.beside(name));
    let rule = keys.text("rule")?.map(str::to_owned);
    let change = LightChange {
        illuminant,
        direction: keys.three("direction")?,
        intensity: keys.number("intensity")?,
        exposure: keys.number("exposure")?,
        relief: keys.number("relief")?,
        softness: keys.number("softness")?,
        observer: keys.whole("observer")?,
        samples: keys.whole("samples")?,
        adapted: keys.switch("adapted")?,
        rule,
    };
    if change.rule.as_deref() == Some("reference") && change.samples.is_some() {
        return Err(keys
            .fault(
                "samples",
                "'samples' does nothing beside the rule 'reference'",
            )
            .help("it has all 101: leave it out"));
    }
    let name = change.illuminant.as_deref().unwrap_or_default();
    let on_default = change.on(&PaintingSetup::default().light);
    step.keys.named("light", file(name), on_default)?;
    Ok(Act::Light(change))
}
