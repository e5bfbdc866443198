//! `maulstick colour match`: the mixtures that come nearest to a colour.

use std::path::PathBuf;

use clap::Args;
use maulstick_optics::colour::srgb_decode;
use maulstick_optics::matching::{Proposal, Proposals, propose};
use maulstick_optics::{Paint, PaintLibrary, Viewing};
use maulstick_rig::UserError;
use serde_json::{Value, json};

use maulstick_painting_setup::viewing::ViewingOptions;
use maulstick_painting_setup::{library_from, refused};

use crate::commands::{print_json, print_text};
use crate::swatch::{Terminal, hex};

/// Options of `maulstick colour match`.
#[derive(Args, Clone, Debug)]
pub struct MatchOptions {
    /// Colour, sRGB: "#8a5a3c"
    #[arg(
        value_name = "HEX",
        required_unless_present = "lab",
        conflicts_with = "lab"
    )]
    hex: Option<String>,
    /// Colour, CIELAB relative to the white of the light: 44.5,17.2,24.1
    #[arg(long, value_name = "L,A,B", allow_hyphen_values = true)]
    lab: Option<String>,
    /// Paint that may be used; can be given several times [default: all]
    #[arg(long, value_name = "NAME")]
    paint: Vec<String>,
    #[command(flatten)]
    viewing: ViewingOptions,
    /// Paint file instead of the measured paints
    #[arg(long, value_name = "FILE")]
    paints: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// Number of mixtures of each kind that are shown.
const SHOWN: usize = 5;
/// Beyond this the eye sees at once that it is another colour, ΔE₀₀.
const ANOTHER: f64 = 2.0;

/// Linear sRGB of `#rrggbb` or `#rgb`.
fn linear_of(text: &str) -> Result<[f64; 3], UserError> {
    let digits: Option<Vec<u32>> = text
        .strip_prefix('#')
        .unwrap_or(text)
        .chars()
        .map(|digit| digit.to_digit(16))
        .collect();
    let bytes = match digits.as_deref() {
        Some(&[r, g, b]) => [17 * r, 17 * g, 17 * b],
        Some(&[r, s, g, h, b, c]) => [16 * r + s, 16 * g + h, 16 * b + c],
        _ => {
            return Err(UserError::usage(format!("'{text}' is no sRGB colour"))
                .help("six hexadecimal digits, \"#8a5a3c\", or --lab L,a,b"));
        }
    };
    Ok(bytes.map(|byte| srgb_decode(f64::from(byte) / 255.0)))
}

fn lab_of(text: &str) -> Result<[f64; 3], UserError> {
    let numbers: Vec<Option<f64>> = text.split(',').map(|n| n.trim().parse().ok()).collect();
    match numbers.as_slice() {
        &[Some(l), Some(a), Some(b)]
            if (0.0..=100.0).contains(&l) && a.abs() <= 200.0 && b.abs() <= 200.0 =>
        {
            Ok([l, a, b])
        }
        _ => Err(UserError::usage(format!("'{text}' is no CIELAB colour"))
            .at("--lab")
            .help("L* from 0 to 100, a* and b* from -200 to 200: --lab 44.5,17.2,24.1")),
    }
}

impl MatchOptions {
    fn target(&self, viewing: &Viewing) -> Result<[f64; 3], UserError> {
        match (&self.lab, &self.hex) {
            (Some(lab), _) => lab_of(lab),
            (None, Some(hex)) => Ok(viewing.display(linear_of(hex)?).lab),
            (None, None) => Err(UserError::usage("no colour is given")),
        }
    }

    fn chosen(&self, library: &PaintLibrary) -> Result<Vec<Paint>, UserError> {
        if self.paint.is_empty() {
            return Ok(library.paints().to_vec());
        }
        let mut paints: Vec<Paint> = Vec::new();
        for name in &self.paint {
            let paint = library
                .find(name)
                .map_err(|error| refused(error).at(format!("--paint {name:?}")))?;
            if paints.iter().all(|other| other.name != paint.name) {
                paints.push(paint.clone());
            }
        }
        match paints.len() {
            1 => Err(UserError::usage("one paint makes no mixture")
                .at("--paint")
                .help(
                    "name two paints or more: --paint \"Cobalt Blue\" --paint \"Titanium White\"",
                )),
            _ => Ok(paints),
        }
    }
}

/// Proposes mixtures.
///
/// # Errors
/// A [`UserError`] for a bad colour, paint, paint file or light.
pub fn run(options: &MatchOptions) -> Result<i32, UserError> {
    let library = library_from(options.paints.as_deref())?;
    let paints = options.chosen(&library)?;
    let viewing = options.viewing.viewing(&library)?;
    let target = options.target(&viewing)?;
    let proposals = propose(&paints, &viewing, target, SHOWN);
    if options.json {
        let all = proposals.pairs.iter().chain(&proposals.triples);
        let rows: Vec<Value> = all.map(row).collect();
        print_json(&json!({ "target_lab": target, "rows": rows }))?;
    } else {
        print_text(&in_lines(options.hex.as_deref(), target, &proposals))?;
    }
    if let Some(off) = proposals.nearest().filter(|off| *off > ANOTHER) {
        eprintln!("these paints do not reach this colour: the nearest is off by ΔE₀₀ {off:.1}");
    }
    Ok(0)
}

fn row(proposal: &Proposal) -> Value {
    json!({
        "mixture": proposal.mixture.to_string(),
        "delta_e": proposal.delta_e,
        "srgb": proposal.seen.srgb(),
    })
}

fn in_lines(asked: Option<&str>, [l, a, b]: [f64; 3], proposals: &Proposals) -> String {
    let terminal = Terminal::of_stdout();
    let asked_bytes = asked.and_then(|hex| linear_of(hex).ok()).map(|linear| {
        linear.map(|channel| (maulstick_optics::colour::srgb_encode(channel) * 255.0).round() as u8)
    });
    let own = asked_bytes.map_or(String::new(), |bytes| {
        format!("{}{}  ", terminal.block(bytes, 6), hex(bytes))
    });
    let mut text = format!("{own}L* {l:.1}  a* {a:.1}  b* {b:.1}\n");
    for (title, list) in [
        ("two paints", &proposals.pairs),
        ("three paints", &proposals.triples),
    ] {
        if !list.is_empty() {
            text += &format!("{title}\n");
        }
        for proposal in list {
            let bytes = proposal.seen.bytes();
            text += &format!(
                "{}{}  ΔE₀₀ {:5.2}  \"{}\"\n",
                terminal.block(bytes, 6),
                hex(bytes),
                proposal.delta_e,
                proposal.mixture
            );
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_read_or_refused() {
        let red = linear_of("#f00").expect("short");
        assert_eq!(red, linear_of("FF0000").expect("long"));
        assert!((red[0] - 1.0).abs() < 1e-12 && red[1] == 0.0);
        for text in ["", "#", "#8a5a3", "#8a5a3g", "brown", "#8a5a3c00", "#ö123"] {
            assert!(linear_of(text).is_err(), "{text}");
        }
        assert_eq!(lab_of("50, -10,20.5"), Ok([50.0, -10.0, 20.5]));
        for text in ["", "50,0", "50,0,x", "101,0,0", "50,NaN,0", "1,2,3,4"] {
            assert!(lab_of(text).is_err(), "{text}");
        }
    }
}
