//! Notes of a table: the white, the surface, colour indices, the source.

use std::collections::BTreeMap;

use maulstick_optics::surface::SurfaceCorrection;
use maulstick_tables::MOST_CHARACTERS;
use maulstick_tables::Note;
use maulstick_types::nearest::choice;

use crate::error::MeasureError;
use crate::headings::Headings;
use crate::table::Table;

/// The notes of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Notes {
    /// `# reference white: NAME` with its line.
    pub white: Option<(usize, String)>,
    /// `# surface: K1, K2` or `# surface: none`.
    pub surface: Option<SurfaceCorrection>,
    /// `# specular: excluded` (or `included`).
    pub specular_excluded: Option<bool>,
    /// `# standard reflectance: 0.99`, 1 if absent.
    pub standard: f64,
    /// `# colour index: Cobalt Blue = PB28; Titanium White = PW6`, by the paint's place.
    pub colour_indices: BTreeMap<usize, String>,
    /// `# source: who, when`.
    pub source: String,
}

impl Notes {
    /// Reads the notes of `table`; those of other keys are left alone.
    ///
    /// # Errors
    /// For a note that cannot be read, or that names an unknown paint.
    pub fn of(table: &Table, headings: &Headings) -> Result<Self, MeasureError> {
        let mut found = Self {
            white: None,
            surface: None,
            specular_excluded: None,
            standard: 1.0,
            colour_indices: BTreeMap::new(),
            source: String::new(),
        };
        for note in table.notes() {
            let fault = |what: String, help: &str| MeasureError::new(what, help).line(note.line);
            match note.key.as_str() {
                "reference white" => found.white = Some((note.line, note.value.clone())),
                "surface" => {
                    let surface = parse_surface(&note.value).map_err(|error| {
                        let help = "write `# surface: 0.03, 0.65` or `# surface: none`";
                        fault(error.to_string(), help)
                    })?;
                    found.surface = Some(surface);
                }
                "specular" => {
                    found.specular_excluded = Some(match note.value.to_lowercase().as_str() {
                        "excluded" => true,
                        "included" => false,
                        _ => {
                            let what = format!("'{}' is not `included` or `excluded`", note.value);
                            return Err(fault(
                                what,
                                "write `# specular: excluded` for 45°/0° and 60°",
                            ));
                        }
                    });
                }
                "standard reflectance" => {
                    let value = note.value.parse().ok();
                    found.standard = value.filter(|r| *r > 0.0 && *r <= 1.2).ok_or_else(|| {
                        let what = format!("'{}' is not a reflectance of a standard", note.value);
                        fault(what, "write `# standard reflectance: 0.99`")
                    })?;
                }
                "colour index" | "color index" => {
                    found.read_colour_indices(note, headings)?;
                }
                "source" => found.source = cell(&note.value).map_err(|e| e.line(note.line))?,
                _ => {}
            }
        }
        Ok(found)
    }

    fn read_colour_indices(
        &mut self,
        note: &Note,
        headings: &Headings,
    ) -> Result<(), MeasureError> {
        for pair in note
            .value
            .split([';', ','])
            .filter(|pair| !pair.trim().is_empty())
        {
            let Some((paint, index)) = pair.split_once('=') else {
                let what = format!("'{}' names no colour index", pair.trim());
                let help = "write `# colour index: Cobalt Blue = PB28; Titanium White = PW6`";
                return Err(MeasureError::new(what, help).line(note.line));
            };
            let names: Vec<&str> = headings
                .paints
                .iter()
                .map(|(_, name)| name.as_str())
                .collect();
            let place =
                paint_called(paint.trim(), &names).map_err(|error| error.line(note.line))?;
            let index = cell(index.trim()).map_err(|error| error.line(note.line))?;
            self.colour_indices.insert(place, index);
        }
        Ok(())
    }
}

/// A text as a cell of a paint file, which is written without quotes.
fn cell(text: &str) -> Result<String, MeasureError> {
    let characters = text.chars().count();
    if characters > MOST_CHARACTERS {
        let what = format!("a note of {characters} characters");
        let help = format!("shorten it to {MOST_CHARACTERS} at most");
        return Err(MeasureError::new(what, help));
    }
    Ok(text.replace(',', ";").replace('"', "'"))
}

/// A text that is not a surface correction.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("'{0}' is not a pair K1,K2 with K1 below 0.5 and K2 below 0.95")]
pub struct SurfaceError(pub String);

/// Reads `K1, K2` or `none`.
///
/// # Errors
/// [`SurfaceError`].
pub fn parse_surface(text: &str) -> Result<SurfaceCorrection, SurfaceError> {
    if text.trim().eq_ignore_ascii_case("none") {
        return Ok(SurfaceCorrection { k1: 0.0, k2: 0.0 });
    }
    let numbers: Vec<f64> = text
        .split(',')
        .filter_map(|part| part.trim().parse().ok())
        .collect();
    match numbers.as_slice() {
        [k1, k2] if (0.0..0.5).contains(k1) && (0.0..0.95).contains(k2) => {
            Ok(SurfaceCorrection { k1: *k1, k2: *k2 })
        }
        _ => Err(SurfaceError(text.to_owned())),
    }
}

/// The index of a paint, whatever its case.
///
/// # Errors
/// The nearest name.
pub fn paint_called(name: &str, paints: &[&str]) -> Result<usize, MeasureError> {
    let same = |paint: &&str| paint.eq_ignore_ascii_case(name);
    paints.iter().position(same).ok_or_else(|| {
        MeasureError::new(
            format!("no column is called '{name}'"),
            choice(name, paints.iter().copied()),
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn notes(text: &str) -> Result<Notes, MeasureError> {
        let text = format!("{text}\nTitanium White,Cobalt Blue,400,500,600\n1\n");
        let table = Table::parse(&text).expect("a table");
        Notes::of(&table, &Headings::of(&table).expect("headings"))
    }

    #[test]
    fn notes_are_read_and_others_left_alone() {
        let found = notes(
            "# my notes: none\n# Reference white: Cobalt Blue\n# surface: 0.04, 0.6\n\
             # specular: Excluded\n# standard reflectance: 0.98\n\
             # colour index: cobalt blue = PB28; Titanium White=PW6\n# source: me, 2025",
        )
        .expect("good");
        assert_eq!(found.white, Some((2, "Cobalt Blue".into())));
        assert_eq!(found.surface, Some(SurfaceCorrection { k1: 0.04, k2: 0.6 }));
        assert_eq!(
            (found.specular_excluded, found.standard),
            (Some(true), 0.98)
        );
        assert_eq!(found.colour_indices[&1], "PB28");
        assert_eq!(found.source, "me; 2025");
    }

    #[test]
    fn bad_notes_are_named() {
        let error = |text: &str| notes(text).expect_err("bad");
        let unknown = error("# colour index: Colbat Blue = PB28");
        assert_eq!(
            unknown.to_string(),
            "line 1: no column is called 'Colbat Blue'"
        );
        assert!(unknown.help.contains("'Cobalt Blue'"), "{}", unknown.help);
        assert!(
            error("#\n# surface: 0.7, 0.65")
                .to_string()
                .starts_with("line 2: '0.7, 0.65'")
        );
        assert!(error("# specular: maybe").to_string().contains("'maybe'"));
        assert!(
            error("# standard reflectance: x")
                .to_string()
                .contains("'x'")
        );
        assert!(error("# colour index: PB28").what.contains("'PB28'"));
    }
}
