//! The library of brushes.

use super::{BrushError, BrushFile};

/// The brushes of the library: name and file.
pub const LIBRARY: [(&str, &str); 11] = [
    ("round", include_str!("../../library/round.toml")),
    ("flat", include_str!("../../library/flat.toml")),
    ("bright", include_str!("../../library/bright.toml")),
    ("filbert", include_str!("../../library/filbert.toml")),
    ("badger", include_str!("../../library/badger.toml")),
    ("fan", include_str!("../../library/fan.toml")),
    ("fude", include_str!("../../library/fude.toml")),
    ("liner", include_str!("../../library/liner.toml")),
    ("mop", include_str!("../../library/mop.toml")),
    ("chisel", include_str!("../../library/chisel.toml")),
    ("knife", include_str!("../../library/knife.toml")),
];

impl BrushFile {
    /// The text of the library's brush called `kind`.
    ///
    /// # Errors
    /// [`BrushError::Unknown`] with the nearest name.
    pub fn library_text(kind: &str) -> Result<&'static str, BrushError> {
        if let Some((_, text)) = LIBRARY.iter().find(|(name, _)| *name == kind) {
            return Ok(text);
        }
        let names = LIBRARY.iter().map(|(name, _)| *name);
        Err(BrushError::Unknown {
            name: kind.to_owned(),
            nearest: maulstick_types::nearest(kind, names).map(str::to_owned),
        })
    }

    /// The library's brush called `kind`.
    ///
    /// # Errors
    /// As [`BrushFile::library_text`].
    pub fn library(kind: &str) -> Result<Self, BrushError> {
        Self::parse(Self::library_text(kind)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_library_is_valid_and_scales() {
        for (name, _) in LIBRARY {
            let brush = BrushFile::library(name).expect(name);
            assert_eq!(brush.kind, name);
            assert!(
                brush.sizes_mm.len() > 2 && !brush.about.is_empty(),
                "{name}"
            );
            assert_eq!(
                BrushFile::parse(&brush.to_toml().expect("text")),
                Ok(brush.clone())
            );
            let double = brush.scaled_to(2.0 * brush.head.width_mm).expect("scaled");
            assert!((double.radius_m(0.3) / brush.radius_m(0.3) - 2.0).abs() < 1e-12);
            assert!((double.length_m() / brush.length_m() - 2.0).abs() < 1e-12);
            for size in &brush.sizes_mm {
                brush.scaled_to(*size).expect(name).check().expect(name);
            }
        }
        assert!(
            BrushFile::library("rond")
                .expect_err("misspelt")
                .to_string()
                .contains("'round'")
        );
        assert_eq!(
            BrushFile::library("sable")
                .expect_err("none is near")
                .to_string(),
            "there is no brush called 'sable'"
        );
    }
}
