//! The kinds of steps, and the keys of each.

use std::sync::LazyLock;

use maulstick_optics::PaintLibrary;
use maulstick_painting::edits::{self, Form as _, StepForm};
use maulstick_rig::UserError;
use maulstick_types::nearest::nearest;
use maulstick_types::values::ticks_in;
use toml::de::DeTable;

use super::Act;
use super::acts::{brush, edit, ground, light, stroke, take, tooth, undo};
use super::entries::{Entries, Source};
use super::step::{Kind, More, Read, Step};

const fn kind(form: StepForm, act: Read) -> Kind {
    let more = None;
    Kind { form, act, more }
}

macro_rules! edit_kinds {
    ($($edit:ident),*) => {
        /// The steps that are edits.
        fn edit_kinds() -> Vec<Kind> {
            let mut kinds = Vec::new();
            $(
                let forms = edits::$edit::STEPS.iter();
                kinds.extend(forms.map(|form| kind(*form, edit::<edits::$edit>)));
            )*
            kinds
        }
    };
}

maulstick_painting::for_each_edit!(edit_kinds);

/// Keys of the edits for which a script says more than they hold: files, changes and counts.
const MORE: [(&str, More); 4] = [
    ("ground", ground),
    ("tooth", tooth),
    ("light", light),
    ("undo", undo),
];

/// All kinds of steps.
pub(super) static KINDS: LazyLock<Vec<Kind>> = LazyLock::new(|| {
    let mut kinds = vec![
        kind(
            StepForm::new(
                "brush",
                &["size_mm", "depth_share"],
                "{ brush = \"filbert\", size_mm = 14, depth_share = 0.5 }",
            ),
            brush,
        ),
        kind(
            StepForm::new(
                "take",
                &["loads"],
                "{ take = \"sky.mcap\", loads = [\"Burnt Sienna\", \"Bone Black\"] }",
            ),
            take,
        ),
        kind(
            StepForm::new(
                "stroke",
                &[
                    "lean_deg",
                    "toward_deg",
                    "turn_deg",
                    "twist_deg",
                    "speed_mm_s",
                ],
                "{ stroke = [[20, 30, 0.3], [60, 34, 0.5], [90, 30, 0.1]], lean_deg = 25 }",
            ),
            stroke,
        ),
        kind(
            StepForm::new("wait", &[], "{ wait = \"20min\" }"),
            |step, _| {
                let time = step.due(step.keys.text("wait")?)?;
                Ok(Act::Wait(ticks_in(time)?))
            },
        ),
    ];
    kinds.extend(edit_kinds());
    for kind in &mut kinds {
        let more = MORE.iter().find(|(key, _)| *key == kind.form.key);
        kind.more = more.map(|(_, more)| *more);
    }
    kinds
});

/// Names of all kinds.
fn all() -> String {
    let keys: Vec<_> = KINDS.iter().map(|kind| kind.form.key).collect();
    keys.join(", ")
}

/// Keys of all kinds.
fn known() -> impl Iterator<Item = &'static &'static str> {
    let kinds = KINDS.iter();
    kinds.flat_map(|kind| kind.form.with.iter().chain([&kind.form.key]))
}

/// A step that does one thing, and whose other keys are that thing's.
fn step<'a>(
    source: Source<'a>,
    table: &'a DeTable<'a>,
    start: usize,
) -> Result<Step<'a>, UserError> {
    let keys = Entries {
        source,
        table,
        example: "{ load = \"Bone Black\" }",
    };
    let given = keys.keys();
    let kinds: Vec<&Kind> = KINDS
        .iter()
        .filter(|kind| given.contains(&kind.form.key))
        .collect();
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
                let does: Vec<_> = kinds.iter().map(|kind| kind.form.key).collect();
                let what = format!("a step that does several things: {}", does.join(", "));
                keys.fault(kinds[0].form.key, what)
            }
        };
        return Err(fault.help(format!("a step does one of: {}", all())));
    };
    let other = given
        .iter()
        .find(|key| **key != kind.form.key && !kind.form.with.contains(key));
    if let Some(key) = other {
        let what = format!("'{key}' does nothing beside '{}'", kind.form.key);
        return Err(keys.fault(key, what).help(kind.takes()));
    }
    let example = kind.form.example;
    Ok(Step {
        kind,
        keys: Entries { example, ..keys },
    })
}

/// The steps of a script as they are written.
pub(super) fn listed<'a>(
    source: Source<'a>,
    script: &'a DeTable<'a>,
) -> Result<Vec<Step<'a>>, UserError> {
    let tables = source.listed(script)?.into_iter();
    tables
        .map(|(start, table)| step(source, table, start))
        .collect()
}

/// Action of a step. An error has its place, and advice.
pub(super) fn act(step: &Step<'_>, library: &PaintLibrary) -> Result<Act, UserError> {
    let more = step.kind.more.map_or(Ok(None), |more| more(step));
    let act = match more {
        Ok(None) => (step.kind.act)(step, library),
        Ok(Some(act)) => Ok(act),
        Err(fault) => Err(fault),
    };
    act.map_err(|mut fault| {
        fault.place.get_or_insert_with(|| step.place());
        fault.help.get_or_insert_with(|| step.keys.for_example());
        fault
    })
}
