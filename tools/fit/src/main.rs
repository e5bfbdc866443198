//! `maulstick colour fit`: the painter's own paints from measured reflectances.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;

use maulstick_measure::{Fit, MeasureError, paint_file, parse_surface};
use maulstick_optics::surface::SurfaceCorrection;
use maulstick_rig::UserError;
use maulstick_rig::files::{Kind, write_whole};
use maulstick_rig::table_file::{MOST_BYTES, read_table};
use maulstick_tool_options::fit::{FitCommand, FitGroup, FitOptions};
use serde_json::json;

use maulstick::commands::table::table;
use maulstick::commands::{print_json, print_text};
use maulstick_painting_setup::outputs::{UsedFile, check_outputs};

fn main() {
    maulstick::beside::tool(|FitGroup::Colour(FitCommand::Fit(options))| run(options));
}

/// Fits the paints and writes their file.
///
/// # Errors
/// A [`UserError`] with line and column of the table, or where the file cannot be written.
fn run(options: &FitOptions) -> Result<i32, UserError> {
    let path = &options.measurements;
    let text = read_table(path, MOST_BYTES)?;
    let output = &options.output;
    let writing = |error: std::io::Error| UserError::writing(output, &error);
    check_outputs(
        &[UsedFile::new("the paints", output).of(Kind::Paints)],
        &[UsedFile::new("the measurements", path)],
    )?;
    let surface = if options.no_surface {
        Some(SurfaceCorrection { k1: 0.0, k2: 0.0 })
    } else {
        let given = options.surface.as_deref().map(parse_surface).transpose();
        given.map_err(|error| UserError::usage(error.to_string()).at("--surface"))?
    };
    let chosen = maulstick_measure::FitOptions {
        white: options.white.clone(),
        surface,
        specular_excluded: options.specular_excluded.then_some(true),
    };
    let fit = maulstick_measure::fit(&text, &chosen).map_err(|error| refused(path, &error))?;
    write_whole(output, Kind::Paints, |file| {
        file.write_all(paint_file(&fit).as_bytes())
    })
    .map_err(writing)?;
    for warning in &fit.warnings {
        eprintln!("warning: {warning}");
    }
    if options.json {
        print_json(&as_json(&fit, output))?;
    } else {
        print_text(&as_table(&fit, output))?;
    }
    Ok(0)
}

fn refused(path: &Path, error: &MeasureError) -> UserError {
    let mut place = path.display().to_string();
    if let Some(line) = error.place.line {
        place.push_str(&format!(":{line}"));
    }
    if error.place.column.is_some() {
        let column = maulstick_measure::Place {
            line: None,
            ..error.place.clone()
        };
        place.push_str(&format!(", {column}"));
    }
    UserError::usage(&error.what).at(place).help(&error.help)
}

fn as_json(fit: &Fit, output: &Path) -> serde_json::Value {
    let row = |one: &maulstick_measure::Residual| {
        json!({
            "sample": one.name,
            "line": one.line,
            "delta_e": one.delta_e,
            "rms": one.rms,
        })
    };
    json!({
        "output": output,
        "paints": fit.paints.iter().map(|paint| &paint.name).collect::<Vec<_>>(),
        "white": fit.white,
        "white_s_per_m": fit.white_s_per_m,
        "rows": fit.residuals.iter().map(row).collect::<Vec<_>>(),
        "mean_delta_e": fit.mean(),
        "worst_delta_e": fit.worst(),
        "noise": fit.noise,
        "warnings": fit.warnings.iter().map(ToString::to_string).collect::<Vec<_>>(),
    })
}

fn as_table(fit: &Fit, output: &Path) -> String {
    let row = |name: &str, delta_e: f64| [name.to_owned(), format!("{delta_e:.2}")];
    let mut rows: Vec<[String; 2]> = fit
        .residuals
        .iter()
        .map(|one| row(&one.name, one.delta_e))
        .collect();
    rows.extend([row("mean", fit.mean()), row("worst", fit.worst())]);
    let mut text = table(["sample", "ΔE₀₀"], &rows);
    // Writing to a String cannot fail.
    if let Some(s) = fit.white_s_per_m {
        writeln!(
            text,
            "'{}' scatters {s:.0} per metre, by the drawdowns",
            fit.white
        )
        .ok();
    }
    let (paints, samples) = (fit.paints.len(), fit.residuals.len());
    writeln!(
        text,
        "{}: {paints} paints from {samples} samples",
        output.display()
    )
    .ok();
    text
}
