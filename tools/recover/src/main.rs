//! `maulstick painting recover`: the intact part of a damaged painting, as a new one.

use std::path::PathBuf;

use maulstick_document::DocumentError;
use maulstick_painting::history::TilePlace;
use maulstick_rig::UserError;
use maulstick_rig::files::{Kind, Unfinished, check_writable};
use maulstick_salvage::{SalvageError, SalvageReport, recover, temporary_path};
use maulstick_tool_options::recover::{RecoverCommand, RecoverGroup, RecoverOptions};
use maulstick_types::scene::{CANVAS, PALETTE};
use serde_json::json;

use maulstick::commands::{print_json, progress, progress_bar};
use maulstick::say;
use maulstick_painting_setup::document::wrong;

/// Greatest number of printed names of a kind.
const NAMES: usize = 20;

fn main() {
    maulstick::beside::tool(|RecoverGroup::Painting(RecoverCommand::Recover(options))| {
        run(options)
    });
}

/// Recovers a painting.
///
/// # Errors
/// A [`UserError`] where nothing can be recovered, or the new painting cannot be written.
fn run(options: &RecoverOptions) -> Result<i32, UserError> {
    let (path, output) = (&options.file, &options.output);
    if output.exists() {
        return Err(wrong(output, &DocumentError::Taken));
    }
    std::fs::File::open(path).map_err(|error| UserError::reading(path, &error))?;
    check_writable(output, Kind::Own).map_err(|error| UserError::writing(output, &error))?;
    let part = temporary_path(output);
    let beside = |suffix: &str| PathBuf::from(format!("{}{suffix}", part.display()));
    let _unfinished = Unfinished::new(["", "-wal", "-journal"].map(beside).into());
    let bar = progress_bar(0).with_message("recovering");
    let recovered = recover(path, output, &mut progress(&bar));
    bar.finish_and_clear();
    let salvage = recovered.map_err(|error| match error {
        SalvageError::Document(
            error @ (DocumentError::Taken
            | DocumentError::Disk(_)
            | DocumentError::ReadOnly(_)
            | DocumentError::Full
            | DocumentError::Unwritten(_)),
        ) => wrong(output, &error),
        SalvageError::Document(error) => wrong(path, &error),
        error @ SalvageError::Lost(_) => UserError::usage(error.to_string())
            .at(path.display().to_string())
            .advise(error.advice()),
    })?;
    if options.json {
        print_json(&as_json(&salvage))?;
        return Ok(0);
    }
    show(&salvage)?;
    say!("written   {}", output.display());
    Ok(0)
}

fn as_json(salvage: &SalvageReport) -> serde_json::Value {
    let places = |places: &[TilePlace]| -> Vec<_> {
        let each = places.iter();
        each.map(|(surface, id)| json!({"surface": surface, "column": id.x, "row": id.y}))
            .collect()
    };
    json!({
        "whole": salvage.is_whole(),
        "tiles": salvage.tiles,
        "older_tiles": places(&salvage.older),
        "thinned_tiles": places(&salvage.thinned),
        "missing_tiles": places(&salvage.missing),
        "lost_layers": salvage.layers,
        "steps": salvage.steps,
        "lost_steps": salvage.lost_steps,
        "versions": salvage.versions,
        "lost_versions": salvage.lost_versions,
        "cleaned_brushes": salvage.brushes,
        "replaced_files": salvage.files,
        "records": salvage.records,
        "lost_records": salvage.lost_records,
        "damaged_rows": salvage.rows,
        "lost_pages": salvage.pages,
        "older_state": salvage.is_old,
        "unknown_format": salvage.format,
    })
}

fn show(salvage: &SalvageReport) -> Result<(), UserError> {
    say!("tiles     {} are whole", salvage.tiles);
    let tiles = [
        (&salvage.older, "are as they were earlier"),
        (&salvage.thinned, "lost wet paint or a dry layer"),
        (&salvage.missing, "are missing"),
    ];
    for (places, what) in tiles {
        if !places.is_empty() {
            let names: Vec<String> = places.iter().map(name).collect();
            say!("          {} {what}: {}", places.len(), list(&names));
        }
    }
    say!(
        "history   {} steps{}",
        salvage.steps,
        without(salvage.lost_steps)
    );
    let gone = salvage.lost_versions.len() as u64;
    say!("versions  {}{}", salvage.versions, without(gone));
    if gone > 0 {
        say!("          missing: {}", list(&salvage.lost_versions));
    }
    if salvage.records + salvage.lost_records > 0 {
        let lost = without(salvage.lost_records);
        say!("journal   {} things done again{lost}", salvage.records);
    }
    if !salvage.brushes.is_empty() {
        say!("brushes   clean now: {}", list(&salvage.brushes));
    }
    if !salvage.files.is_empty() {
        say!("files     replaced by others: {}", list(&salvage.files));
    }
    if salvage.is_old {
        say!("state     an older one: layers, light and books may be of before");
    }
    if let Some(format) = salvage.format {
        say!(
            "format    {format}, unknown to this program: what a newer one keeps besides is not here"
        );
    }
    match (salvage.is_whole(), salvage.rows + salvage.pages) {
        (true, _) => say!("          nothing is missing"),
        (false, 0) => {}
        (false, _) => say!(
            "damage    {} rows, {} pages of the file",
            salvage.rows,
            salvage.pages
        ),
    }
    Ok(())
}

fn without(lost: u64) -> String {
    match lost {
        0 => String::new(),
        lost => format!(", {lost} are gone"),
    }
}

fn name((surface, id): &TilePlace) -> String {
    match *surface {
        CANVAS => format!("canvas {}/{}", id.x, id.y),
        PALETTE => format!("palette {}/{}", id.x, id.y),
        other => format!("surface {other} {}/{}", id.x, id.y),
    }
}

fn list(names: &[String]) -> String {
    let shown = names
        .iter()
        .take(NAMES)
        .cloned()
        .collect::<Vec<_>>()
        .join(", ");
    match names.len().saturating_sub(NAMES) {
        0 => shown,
        more => format!("{shown} and {more} more"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_list_is_cut_and_counted() {
        let names: Vec<String> = (0..23).map(|number| number.to_string()).collect();
        let text = list(&names);
        let numbers = text.split(|letter: char| !letter.is_ascii_digit());
        let numbers = numbers.filter_map(|number| number.parse::<usize>().ok());
        assert!(numbers.eq((0..NAMES).chain([3])), "{text}");
        assert_eq!(list(&names[..2]), "0, 1");
    }
}
