//! Text of an edit's result, for the notification of one whose effect may be out of view.

use maulstick_painting::edits::{Dry, GoTo, LoadFrom, Redo, Scrape, Undo};
use maulstick_types::EditFields as _;
use maulstick_types::command::{Command, Detail};
use maulstick_ui_kit::language::{layer_name, step, translated};

use maulstick_client::request::Request;

use crate::settings::brush_load;

/// Edits whose effect may be out of view, by their names.
const PAST_TENSES: [(&str, &str); 6] = [
    (Undo::NAME, tr_noop!("Undone")),
    (Redo::NAME, tr_noop!("Redone")),
    (GoTo::NAME, tr_noop!("Now")),
    (Dry::NAME, tr_noop!("Dried")),
    (LoadFrom::NAME, tr_noop!("Loaded")),
    (Scrape::NAME, tr_noop!("Scraped")),
];

/// Title of a completed request, and its subject; `None` for one with a visible effect.
#[must_use]
pub(crate) fn done(request: &Request, detail: &Detail) -> Option<String> {
    let done = past_tense(request)?;
    Some(match told(detail) {
        Some(told) => format!("{done}: {told}"),
        None => done.to_owned(),
    })
}

fn told(detail: &Detail) -> Option<String> {
    match detail {
        Detail::Nothing => None,
        Detail::Step { name } => Some(step(name)),
        Detail::Dried { layer } => Some(layer_name(layer)),
        Detail::Loaded { mixture } => Some(brush_load::words(&mixture.without_traces())),
        Detail::Words { words } => Some(words.clone()),
    }
}

fn past_tense(request: &Request) -> Option<&'static str> {
    let Request::Command {
        command: Command::Edit(edit),
        ..
    } = request
    else {
        return None;
    };
    let (_, words) = PAST_TENSES.iter().find(|(name, _)| *name == edit.name)?;
    Some(translated(words))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mixtures_are_told_in_per_cent_also_those_of_one_paint() {
        for (parts, words) in [
            ("Burnt Sienna=1", "Burnt Sienna"),
            (
                "Burnt Sienna=0.12,Thinner=0.88",
                "Burnt Sienna 12 %, Thinner 88 %",
            ),
        ] {
            let mixture = parts.parse().expect("a mixture");
            let told = told(&Detail::Loaded { mixture });
            assert_eq!(told.as_deref(), Some(words));
        }
    }
}
