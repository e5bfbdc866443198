//! The brush file (TOML) and the library of brushes that come with the crate.
//!
//! ```toml
//! kind = "round"
//! [head]
//! width_mm = 10.0          # widest
//! length_mm = 25.0         # out of the ferrule
//! profile = [[0.0, 0.8], [0.3, 1.0], [1.0, 0.1]]  # place along the head, share of half the width
//! [spines]                 # that bend: one in the middle and a ring around it, or a row
//! count = 6
//! share = 0.7              # of the head's radius, where the ring stands
//! joints = 3
//! bending_stiffness_n_mm2 = 150.0   # of the whole head at the ferrule
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
//! [force]                  # that the hand feels: depth along the normal, N, N a head's length
//! hermite = [[0.0, 0.0, 6.0], [0.06, 0.2, 0.8], [0.5, 0.45, 0.5], [1.0, 0.8, 1.2], [1.2, 1.5, 6.0]]
//! ```
//!
//! All keys are in `docs/brushes.md`.

pub mod check;
pub mod library;
pub mod quantities;
pub mod sections;

use maulstick_types::limits::BRUSH_FILE_MAX;
use serde::{Deserialize, Serialize};

use self::check::within;
use self::sections::{Contact, Force, Head, Load, Spines, Strips, Surface};

/// Thickness of a ferrule, in widths of a strip, below which it is a line.
const LINE_THICKNESS_STRIPS: f64 = 1.5;
/// Width of a strip, cells, below which strips merge on the canvas.
const MOST_CELLS_WIDE: f64 = 2.0;
/// The fewest strips of a thinned head.
const FEWEST_STRIPS: usize = 24;
/// Relative tolerance of a width's upper bound.
const ROUNDING: f64 = 1e-6;

/// Errors of reading, checking and scaling a brush file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BrushError {
    /// No such brush; the nearest name is proposed.
    #[error("there is no brush called '{name}'{}", meant(.nearest.as_deref()))]
    Unknown {
        /// Requested name.
        name: String,
        /// The nearest name, if one is near.
        nearest: Option<String>,
    },
    /// The text is not a brush file.
    #[error("{0}")]
    File(String),
    /// The file exceeds the size limit of a brush file.
    #[error(
        "written out it has {bytes} bytes, and may have {BRUSH_FILE_MAX}: make its skin of fewer faces and weights"
    )]
    TooLong {
        /// Its bytes.
        bytes: usize,
    },
    /// A number is out of its range.
    #[error("{field} is {value}, but must be {range}")]
    Range {
        /// The field.
        field: String,
        /// Its value.
        value: f64,
        /// Allowed range.
        range: String,
    },
}

fn meant(nearest: Option<&str>) -> String {
    nearest.map_or(String::new(), |name| format!("; did you mean '{name}'?"))
}

/// A brush file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BrushFile {
    /// Kind of brush.
    pub kind: String,
    /// Purpose, in a sentence.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub about: String,
    /// The widths that it is made in, mm.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sizes_mm: Vec<f64>,
    /// The head's shape.
    pub head: Head,
    /// The spines, which bend.
    pub spines: Spines,
    /// The bristle strips, which paint.
    pub strips: Strips,
    /// The skin around them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub surface: Option<Surface>,
    /// Friction with the canvas or palette.
    pub contact: Contact,
    /// Load of the head.
    pub load: Load,
    /// Force on the hand; by the head's stiffness if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force: Option<Force>,
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

    /// Checks all numbers and the length of the file as written anew, in which numbers may take more room than in the
    /// text that was read.
    ///
    /// # Errors
    /// [`BrushError::Range`], [`BrushError::TooLong`].
    pub fn check(&self) -> Result<(), BrushError> {
        check::check(self)?;
        match self.to_toml()?.len() {
            0..=BRUSH_FILE_MAX => Ok(()),
            bytes => Err(BrushError::TooLong { bytes }),
        }
    }

    /// The brush file as TOML; [`parse`](Self::parse) reads it back to the same brush.
    ///
    /// # Errors
    /// [`BrushError::File`] where a value cannot be written as TOML.
    pub fn to_toml(&self) -> Result<String, BrushError> {
        toml::to_string(self).map_err(|error| BrushError::File(error.to_string()))
    }

    /// The brush at another width: lengths scale with it, stiffness with its square.
    ///
    /// # Errors
    /// [`BrushError::Range`] where the width, or something that scales with it, is out of range.
    pub fn scaled_to(&self, width_mm: f64) -> Result<Self, BrushError> {
        within("size_mm", width_mm, 0.1..=300.0)?;
        let scale = width_mm / self.head.width_mm;
        let mut brush = self.clone();
        brush.head.width_mm = width_mm;
        brush.head.length_mm *= scale;
        if let Some(thickness) = &mut brush.head.thickness_mm {
            *thickness *= scale;
        }
        brush.spines.bending_stiffness_n_mm2 *= scale * scale;
        for chain in &mut brush.spines.chains {
            let places = std::iter::once(&mut chain.root_mm).chain(&mut chain.segments_mm);
            places.flatten().for_each(|mm| *mm *= scale);
            // K = EI/l scales as the square of the size divided by the size.
            let torques = chain
                .stiffness_n_mm
                .iter_mut()
                .chain(&mut chain.damping_n_mm);
            torques.for_each(|torque| *torque *= scale);
        }
        // A head has the same number of strips at any size, so finer strips have fewer bristles each.
        let strips = &mut brush.strips;
        let lengths = [
            &mut strips.width_mm,
            &mut strips.thickness_mm,
            &mut strips.lift_mm,
            &mut strips.sink_mm,
        ];
        lengths.into_iter().for_each(|mm| *mm *= scale);
        if let Some(surface) = &mut brush.surface {
            let places = surface.vertices_mm.iter_mut().flatten();
            places.for_each(|mm| *mm *= scale);
            surface.recede_mm *= scale;
        }
        brush.check()?;
        Ok(brush)
    }

    /// True if the strips stand in a line: the ferrule is hardly thicker than a strip is wide.
    #[must_use]
    pub fn is_line(&self) -> bool {
        2e3 * self.half_thickness_m(0.0) < LINE_THICKNESS_STRIPS * self.strips.width_mm
    }

    /// The brush with half its strips, each twice as wide: the first half, which are spread as evenly as all. `None`
    /// where the strips stand in a line or are already few.
    fn halved(&self) -> Option<Self> {
        let mut brush = self.clone();
        let strips = &mut brush.strips;
        strips.count /= 2;
        let times = self.strips.count as f64 / strips.count.max(1) as f64;
        strips.width_mm *= times;
        strips.stands_for *= times;
        (strips.count >= FEWEST_STRIPS && !brush.is_line()).then_some(brush)
    }

    /// The brush with only the strips that cells of `cell_m` can resolve: halved while they stay narrower than
    /// `MOST_CELLS_WIDE` cells.
    #[must_use]
    pub fn thinned(&self, cell_m: f64) -> Self {
        let most = MOST_CELLS_WIDE * cell_m * (1.0 + ROUNDING);
        self.halved_while(|brush| brush.strips.width_mm * 1e-3 <= most)
    }

    /// The brush with its strips halved until `strips` of them are left.
    #[must_use]
    pub fn thinned_to(&self, strips: usize) -> Self {
        self.halved_while(|brush| brush.strips.count >= strips)
    }

    fn halved_while(&self, goes_on: impl Fn(&Self) -> bool) -> Self {
        let mut brush = self.clone();
        while let Some(halved) = brush.halved().filter(&goes_on) {
            brush = halved;
        }
        brush
    }

    /// The brush wiped on a rag: it keeps this share of its load.
    #[must_use]
    pub fn wiped(mut self, share: f64) -> Self {
        self.load.film_um *= share;
        self.load.inside_um *= share;
        self
    }

    /// Length of the head, m.
    #[must_use]
    pub fn length_m(&self) -> f64 {
        self.head.length_mm * 1e-3
    }

    /// Half the width of the head at the place `s` in 0..1 along it, m.
    #[must_use]
    pub fn radius_m(&self, s: f64) -> f64 {
        0.5e-3 * self.head.width_mm * share_at(&self.head.profile, s)
    }

    /// Half the thickness of the head at the place `s` in 0..1 along it, m.
    #[must_use]
    pub fn half_thickness_m(&self, s: f64) -> f64 {
        let head = &self.head;
        let profile = if head.thickness_profile.is_empty() {
            &head.profile
        } else {
            &head.thickness_profile
        };
        0.5e-3 * head.thickness_mm.unwrap_or(head.width_mm) * share_at(profile, s)
    }

    /// Length of a bristle as a share of the longest, at a place of the ferrule in shares of half its width and
    /// thickness.
    #[must_use]
    pub fn length_share(&self, place: [f64; 2]) -> f64 {
        let across = match self.head.outline {
            sections::Outline::Flat => place[0],
            sections::Outline::Round => (place[0] * place[0] + place[1] * place[1]).sqrt(),
        };
        if self.head.tip.is_empty() {
            1.0
        } else {
            share_at(&self.head.tip, across)
        }
    }

    /// Stiffness at a place along the head as a share of that at the ferrule.
    #[must_use]
    pub fn stiffness_share(&self, s: f64) -> f64 {
        if self.spines.stiffness_profile.is_empty() {
            1.0
        } else {
            share_at(&self.spines.stiffness_profile, s)
        }
    }
}

/// Value of a curve at a place; the curve continues level beyond its ends.
fn share_at(curve: &[[f64; 2]], place: f64) -> f64 {
    let after = curve
        .iter()
        .position(|[at, _]| *at >= place)
        .unwrap_or(curve.len() - 1);
    let [p1, r1] = curve[after];
    let [p0, r0] = curve[after.saturating_sub(1)];
    let t = if p1 > p0 {
        ((place - p0) / (p1 - p0)).clamp(0.0, 1.0)
    } else {
        1.0
    };
    r0 + t * (r1 - r0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The error of the round brush with a part of its file replaced.
    fn error(from: &str, to: &str) -> BrushError {
        let text = BrushFile::library_text("round").expect("text");
        assert!(text.contains(from), "{from}");
        BrushFile::parse(&text.replace(from, to)).expect_err(to)
    }

    /// Field and value of an error.
    fn range(error: BrushError) -> (String, f64) {
        match error {
            BrushError::Range { field, value, .. } => (field, value),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn refuses_unknown_field() {
        let error = error("friction = 0.25", "frictoin = 0.25");
        assert!(matches!(error, BrushError::File(text) if text.contains("frictoin")));
    }

    #[test]
    fn refuses_out_of_range() {
        for (from, to, field, value) in [
            ("joints = 3", "joints = 0", "spines.joints", 0.0),
            ("joints = 3", "joints = 65", "spines.joints", 65.0),
            ("count = 384", "count = 5000", "strips.count", 5000.0),
            (
                "length_mm = 25.0",
                "length_mm = -1.0",
                "head.length_mm",
                -1.0,
            ),
            ("[0.25, 1.0]", "[0.95, 1.0]", "head.profile (place)", 0.5),
            (
                "[[0.0, 0.82]",
                "[[0.0, 0.0]",
                "head.profile (share at the ferrule)",
                0.0,
            ),
            (
                "friction_static = 0.32",
                "friction_static = 0.1",
                "contact.friction_static",
                0.1,
            ),
            ("[1.0, 0.8, ", "[1.0, 0.5, ", "force.hermite (force)", 0.5),
            ("[1.0, 0.8, ", "[0.9, 0.8, ", "force.hermite (depth)", 0.9),
            (
                "[0.06, 0.5, ",
                "[0.06, 0.5, 9",
                "force.hermite (slope)",
                90.34,
            ),
            (", [1.2, 1.5, 6.0]]", "]", "force.hermite", 4.0),
            ("focus = 2.0", "focus = 1.0", "contact.focus", 1.0),
            (
                "clumping = [0.0,",
                "clumping = [2.0,",
                "strips.clumping",
                2.0,
            ),
            ("[strips]", CHAIN, "spines.chain", 1.0),
        ] {
            assert_eq!(range(error(from, to)), (field.to_owned(), value), "{to}");
        }
        let (field, value) = range(error("friction = 0.25", "friction = nan"));
        assert!(field == "contact.friction" && value.is_nan());
    }

    const CHAIN: &str = "[[spines.chain]]\nroot_mm = [0, 0, 0]\nsegments_mm = []\n\
                         stiffness_n_mm = []\ndamping_n_mm = []\n[strips]";

    #[test]
    fn refuses_bad_chains() {
        let text = BrushFile::library_text("round").expect("text");
        let text = text.replace("[spines]", "[spines]\nlayout = \"chains\"");
        let unequal = CHAIN.replace("segments_mm = []", "segments_mm = [[0, 0, -9]]");
        for (chain, field) in [
            ("[strips]", "spines.chain"),
            (CHAIN, "spines.chain.segments_mm"),
            (&unequal, "spines.chain.stiffness_n_mm"),
        ] {
            let error = BrushFile::parse(&text.replace("[strips]", chain)).expect_err(chain);
            assert_eq!(range(error), (field.to_owned(), 0.0), "{chain}");
        }
    }

    #[test]
    fn refuses_bad_skins() {
        let one = "levels = 1\nrecede_mm = 0.1\nvertices_mm = [[0, 0, 0]]\n";
        for (skin, field, value) in [
            ("levels = 0\nrecede_mm = 0.1", "surface.levels", 0.0),
            (
                &format!("{one}weights = [[[0, 0.5]]]\nfaces = [[0, 0, 0]]"),
                "surface.weights (sum)",
                0.5,
            ),
            (
                &format!("{one}weights = [[[0, 1]]]\nfaces = [[0, 0, 3]]"),
                "surface.faces",
                3.0,
            ),
            (
                &format!("{one}weights = [[[99, 1]]]\nfaces = [[0, 0, 0]]"),
                "surface.weights (joint)",
                99.0,
            ),
        ] {
            let error = error("[contact]", &format!("[surface]\n{skin}\n[contact]"));
            assert_eq!(range(error), (field.to_owned(), value), "{skin}");
        }
    }

    #[test]
    fn a_file_that_grows_beyond_its_limit_when_it_is_written_is_refused() {
        let text = BrushFile::library_text("round").expect("text");
        let sizes = |count: usize| {
            let sizes = vec!["1"; count].join(",");
            format!("sizes_mm=[{sizes}]\n{}", without_sizes(text))
        };
        assert!(BrushFile::parse(&sizes(1000)).is_ok());
        // Each "1," is written as "1.0, ".
        let long = sizes(250_000);
        assert!(long.len() < BRUSH_FILE_MAX);
        let error = BrushFile::parse(&long).expect_err("too long");
        assert!(matches!(error, BrushError::TooLong { bytes } if bytes > BRUSH_FILE_MAX));
    }

    /// A brush file without the widths that it is made in.
    fn without_sizes(text: &str) -> String {
        let lines = text.lines().filter(|line| !line.starts_with("sizes_mm"));
        lines.collect::<Vec<_>>().join("\n")
    }

    #[test]
    fn odd_brushes_that_are_right_have_heads() {
        let text = BrushFile::library_text("flat").expect("text");
        let alter = |pairs: &[(&str, &str)]| {
            let mut text = text.to_owned();
            for (from, to) in pairs {
                assert!(text.contains(from), "{from}");
                text = text.replace(from, to);
            }
            crate::Head::of(&BrushFile::parse(&text).expect("right"))
        };
        assert_eq!(alter(&[("count = 5", "count = 1")]).strips(), 448);
        assert_eq!(alter(&[("count = 448", "count = 1")]).strips(), 1);
        assert!(alter(&[("joints = 3", "joints = 64")]).fits(5 * 64));
        assert_eq!(
            alter(&[("thickness_mm = 5.0", "thickness_mm = 0.05")]).strips(),
            448
        );
        let too_fine = BrushFile::library("knife").and_then(|file| file.scaled_to(1.0));
        let (field, _) = range(too_fine.expect_err("too thin"));
        assert_eq!(field, "head.thickness_mm");
    }
}
