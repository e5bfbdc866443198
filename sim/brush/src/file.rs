//! The brush file (TOML) and the library of brushes that come with the crate.
//!
//! ```toml
//! kind = "round"
//! [head]
//! width_mm = 10.0          # widest
//! length_mm = 25.0         # out of the ferrule
//! profile = [[0.0, 0.8], [0.3, 1.0], [1.0, 0.1]]  # place along the head, share of half the width
//! [spines]                 # that bend: one in the middle and a ring around it
//! ring = 6
//! ring_share = 0.7         # of the head's radius, where the ring stands
//! joints = 3
//! bending_stiffness_n_mm2 = 150.0   # of the whole head
//! damping = 0.01           # torque of inner friction by that of a joint bent by 1 rad
//! [strips]                 # that paint: bristles that follow the spines
//! count = 384
//! seed = 1                 # where they stand and how unruly each is
//! width_mm = 0.25
//! thickness_mm = 0.1
//! lift_mm = 0.2            # the most unruly one keeps off the surface when hardly pressed
//! sink_mm = 0.1            # deeper into the tooth when fully pressed
//! open = 0.5               # width of the pressed point by that of the head
//! unevenness = 0.6         # by which share of the mean the strips differ in how much they carry
//! [contact]
//! friction = 0.25
//! [load]
//! film_um = 200.0          # on the strips of a freshly loaded head
//! inside_um = 200.0        # within them, as if spread over them
//! ```

use serde::{Deserialize, Serialize};

use crate::tuft::Tuft;

/// The brushes of the library: name and file.
pub const LIBRARY: [(&str, &str); 1] = [("round", include_str!("../library/round.toml"))];

/// Why a brush cannot be had.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BrushError {
    /// No such brush; the nearest name is proposed.
    #[error("there is no brush called '{name}'; did you mean '{nearest}'?")]
    Unknown {
        /// What was asked for.
        name: String,
        /// The nearest name.
        nearest: String,
    },
    /// The file is no brush file.
    #[error("{0}")]
    File(String),
    /// A number is out of its range.
    #[error("{field} is {value}, but must be {range}")]
    Range {
        /// The field.
        field: &'static str,
        /// Its value.
        value: f64,
        /// What it may be.
        range: &'static str,
    },
}

/// The head's shape.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Head {
    /// Widest, mm.
    pub width_mm: f64,
    /// Length out of the ferrule, mm.
    pub length_mm: f64,
    /// Place along the head from 0 to 1, and radius there as a share of half the width.
    pub profile: Vec<[f64; 2]>,
}

/// The spines, which bend.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpinesSection {
    /// Number of spines around the middle one.
    pub ring: usize,
    /// Where they stand, as a share of the head's radius.
    pub ring_share: f64,
    /// Number of joints of each.
    pub joints: usize,
    /// Bending stiffness EI of the whole head, N·mm².
    pub bending_stiffness_n_mm2: f64,
    /// Torque of a joint's inner friction by its spring's torque at 1 rad.
    pub damping: f64,
}

impl SpinesSection {
    /// Number of spines.
    #[must_use]
    pub fn number(&self) -> usize {
        self.ring + 1
    }
}

/// The bristle strips, which paint.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StripsSection {
    /// How many.
    pub count: usize,
    /// Seed of their places and of how unruly each is.
    pub seed: u64,
    /// Width, mm.
    pub width_mm: f64,
    /// Thickness, mm.
    pub thickness_mm: f64,
    /// How far the most unruly one keeps off the surface while the head is hardly pressed, mm.
    pub lift_mm: f64,
    /// How much deeper the fully pressed head reaches into the tooth, mm.
    pub sink_mm: f64,
    /// Width of the fully pressed point by that of the head.
    pub open: f64,
    /// By which share of the mean the strips differ in how much they carry.
    pub unevenness: f64,
}

/// Contact with the surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ContactSection {
    /// Coefficient of friction.
    pub friction: f64,
}

/// What the head carries.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LoadSection {
    /// Film on the strips of a freshly loaded head, µm.
    pub film_um: f64,
    /// Paint inside them, as thick as if it were spread over them, µm.
    pub inside_um: f64,
}

/// A brush file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BrushFile {
    /// What kind of brush it is.
    pub kind: String,
    /// The head's shape.
    pub head: Head,
    /// The spines, which bend.
    pub spines: SpinesSection,
    /// The bristle strips, which paint.
    pub strips: StripsSection,
    /// Contact with the surface.
    pub contact: ContactSection,
    /// What the head carries.
    pub load: LoadSection,
}

fn within(
    field: &'static str,
    value: f64,
    range: std::ops::RangeInclusive<f64>,
    text: &'static str,
) -> Result<(), BrushError> {
    if range.contains(&value) {
        Ok(())
    } else {
        Err(BrushError::Range {
            field,
            value,
            range: text,
        })
    }
}

impl BrushFile {
    /// Reads a brush file.
    ///
    /// # Errors
    /// [`BrushError::File`] with the line, or [`BrushError::Range`].
    pub fn parse(text: &str) -> Result<Self, BrushError> {
        let file: Self = toml::from_str(text)
            .map_err(|error| BrushError::File(error.to_string().trim_end().to_owned()))?;
        file.check()?;
        Ok(file)
    }

    /// The text of the library's brush called `kind`.
    ///
    /// # Errors
    /// [`BrushError::Unknown`] with the nearest name.
    pub fn library_text(kind: &str) -> Result<&'static str, BrushError> {
        if let Some((_, text)) = LIBRARY.iter().find(|(name, _)| *name == kind) {
            return Ok(text);
        }
        let names = LIBRARY.iter().map(|(name, _)| *name);
        let nearest = maulstick_types::nearest(kind, names).unwrap_or_default();
        Err(BrushError::Unknown {
            name: kind.to_owned(),
            nearest: nearest.to_owned(),
        })
    }

    /// The library's brush called `kind`.
    ///
    /// # Errors
    /// As [`BrushFile::library_text`].
    pub fn library(kind: &str) -> Result<Self, BrushError> {
        Self::parse(Self::library_text(kind)?)
    }

    /// As a file, which [`parse`](Self::parse) reads back to the same brush.
    ///
    /// # Errors
    /// [`BrushError::File`] where a value cannot be written as TOML.
    pub fn to_toml(&self) -> Result<String, BrushError> {
        toml::to_string(self).map_err(|error| BrushError::File(error.to_string()))
    }

    fn check(&self) -> Result<(), BrushError> {
        let (head, spines, strips) = (&self.head, &self.spines, &self.strips);
        within("head.width_mm", head.width_mm, 0.1..=300.0, "0.1 to 300")?;
        within("head.length_mm", head.length_mm, 0.5..=500.0, "0.5 to 500")?;
        within("spines.ring", spines.ring as f64, 3.0..=24.0, "3 to 24")?;
        within(
            "spines.ring_share",
            spines.ring_share,
            0.05..=1.0,
            "0.05 to 1",
        )?;
        within("spines.joints", spines.joints as f64, 1.0..=16.0, "1 to 16")?;
        within(
            "spines.bending_stiffness_n_mm2",
            spines.bending_stiffness_n_mm2,
            1e-6..=1e9,
            "1e-6 to 1e9",
        )?;
        within("spines.damping", spines.damping, 0.0..=1.0, "0 to 1")?;
        within(
            "strips.count",
            strips.count as f64,
            1.0..=4096.0,
            "1 to 4096",
        )?;
        within(
            "strips.width_mm",
            strips.width_mm,
            0.01..=50.0,
            "0.01 to 50",
        )?;
        within(
            "strips.thickness_mm",
            strips.thickness_mm,
            0.0..=10.0,
            "0 to 10",
        )?;
        within("strips.lift_mm", strips.lift_mm, 0.0..=10.0, "0 to 10")?;
        within("strips.sink_mm", strips.sink_mm, 0.0..=10.0, "0 to 10")?;
        within("strips.open", strips.open, 0.0..=2.0, "0 to 2")?;
        within("strips.unevenness", strips.unevenness, 0.0..=1.0, "0 to 1")?;
        within(
            "contact.friction",
            self.contact.friction,
            0.0..=2.0,
            "0 to 2",
        )?;
        within("load.film_um", self.load.film_um, 0.0..=2000.0, "0 to 2000")?;
        within(
            "load.inside_um",
            self.load.inside_um,
            0.0..=2000.0,
            "0 to 2000",
        )?;
        let mut last = -1.0;
        for [place, radius] in &self.head.profile {
            within("head.profile (radius)", *radius, 0.0..=1.0, "0 to 1")?;
            within("head.profile (place)", *place, 0.0..=1.0, "0 to 1")?;
            if *place <= last {
                let range = "in rising order";
                return Err(BrushError::Range {
                    field: "head.profile (place)",
                    value: *place,
                    range,
                });
            }
            last = *place;
        }
        if self.head.profile.len() < 2 {
            let value = self.head.profile.len() as f64;
            let range = "at least two points";
            return Err(BrushError::Range {
                field: "head.profile (length)",
                value,
                range,
            });
        }
        Ok(())
    }

    /// The brush at another width: lengths scale with it, stiffness with its square.
    ///
    /// # Errors
    /// [`BrushError::Range`] where the width is out of range.
    pub fn scaled_to(&self, width_mm: f64) -> Result<Self, BrushError> {
        within("size_mm", width_mm, 0.1..=300.0, "0.1 to 300")?;
        let scale = width_mm / self.head.width_mm;
        let mut brush = self.clone();
        brush.head.width_mm = width_mm;
        brush.head.length_mm *= scale;
        brush.spines.bending_stiffness_n_mm2 *= scale * scale;
        // Finer strips have fewer bristles each: a head has as many strips at any size.
        brush.strips.width_mm *= scale;
        Ok(brush)
    }

    /// Length of the head, m.
    #[must_use]
    pub fn length_m(&self) -> f64 {
        self.head.length_mm * 1e-3
    }

    /// Radius of the head at the place `s` in 0..1 along it, m.
    #[must_use]
    pub fn radius_m(&self, s: f64) -> f64 {
        let profile = &self.head.profile;
        let half = 0.5e-3 * self.head.width_mm;
        let after = profile
            .iter()
            .position(|[place, _]| *place >= s)
            .unwrap_or(profile.len() - 1);
        let [p1, r1] = profile[after];
        let [p0, r0] = profile[after.saturating_sub(1)];
        let t = if p1 > p0 {
            ((s - p0) / (p1 - p0)).clamp(0.0, 1.0)
        } else {
            1.0
        };
        half * (r0 + t * (r1 - r0))
    }

    /// The spines in their seats.
    #[must_use]
    pub fn tuft(&self) -> Tuft {
        Tuft::of(self)
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
            assert_eq!(
                BrushFile::parse(&brush.to_toml().expect("text")),
                Ok(brush.clone())
            );
            let double = brush.scaled_to(2.0 * brush.head.width_mm).expect("scaled");
            assert!((double.radius_m(0.3) / brush.radius_m(0.3) - 2.0).abs() < 1e-12);
            assert!((double.length_m() / brush.length_m() - 2.0).abs() < 1e-12);
        }
        assert!(
            BrushFile::library("rond")
                .expect_err("misspelt")
                .to_string()
                .contains("'round'")
        );
    }

    #[test]
    fn bad_files_name_their_field() {
        let text = BrushFile::library_text("round").expect("text");
        let error = |from: &str, to: &str| {
            BrushFile::parse(&text.replace(from, to))
                .expect_err(to)
                .to_string()
        };
        assert!(error("friction = 0.25", "frictoin = 0.25").contains("frictoin"));
        assert!(error("joints = 3", "joints = 0").contains("spines.joints is 0"));
        assert!(error("count = 384", "count = 5000").contains("strips.count is 5000"));
        assert!(error("length_mm = 25.0", "length_mm = -1.0").contains("head.length_mm is -1"));
        assert!(error("friction = 0.25", "friction = nan").contains("contact.friction is NaN"));
        assert!(error("[0.25, 1.0]", "[0.95, 1.0]").contains("rising order"));
    }
}
