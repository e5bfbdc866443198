//! The desk: surfaces, paints, light. The paint node owns it.

mod fault;
mod light;

use crate::mixture::Mixture;
use crate::nearest::choice;
use crate::pose::Pose;
use crate::values::ValueError;
use crate::wire::define::{message, wire_enum, wire_struct};

pub use light::{
    ENVIRONMENT_BYTES, Environment, Exposure, ILLUMINANT_NAME_MAX, Intensity, Light, LightError,
    RULES, Relief, Softness, Wavelengths,
};

/// The canvas.
pub const CANVAS: u32 = 0;
/// The palette.
pub const PALETTE: u32 = 1;
/// Default flow of a marker: 4 µm along a millimetre.
pub const MARKER_FLOW: f64 = 4e-3;

wire_enum! {
    /// Function of a round region of the palette.
    pub enum WellKind {
        /// Holds a mixture that never runs out.
        Paint {
            /// Its mixture.
            mixture: Mixture,
        },
        /// Takes all paint off the brush.
        Cleaner,
        /// Thins the paint on the brush.
        Medium,
    }
}

wire_struct! {
    /// A round region of a surface.
    pub struct Well {
        /// Middle in the surface's frame, m.
        pub center_m: [f64; 2],
        /// Radius, m.
        pub radius_m: f64,
        /// Its function.
        pub kind: WellKind,
    }
}

wire_struct! {
    /// A canvas or a palette. Its frame: origin at the lower left corner, x right, y up, z out;
    /// cell (i, j) covers [i·h, (i+1)·h) × [j·h, (j+1)·h).
    pub struct Surface {
        /// [`CANVAS`] or [`PALETTE`].
        pub id: u32,
        /// Surface frame to desk frame.
        pub pose: Pose,
        /// Desk lengths per surface length; scales x, y and height alike.
        pub zoom: f64,
        /// Cells across and up.
        pub cells: [u32; 2],
        /// Side h of a cell, m.
        pub cell_m: f64,
        /// Name of the ground.
        pub ground: String,
        /// Name of the tooth.
        pub tooth: String,
        /// Seed of the tooth.
        pub tooth_seed: u64,
        /// Regions of their own behaviour.
        pub wells: Vec<Well>,
        /// Thickness of paint that stays however hard it is brushed, m: little on a canvas that is
        /// heavily sized (Baxter 2004, § 6.4.1).
        pub stain_m: f64,
        /// True if paint that brushes take up from it is not used up (Baxter 2004, § 6.7).
        pub piles_last: bool,
        /// Name of the model of its paint.
        #[serde(default = "default_model")]
        pub model: String,
    }
}

/// The paint model where nothing else is said.
#[must_use]
pub fn default_model() -> String {
    "impasto".to_owned()
}

/// Thickness that stays where nothing else is said, m.
#[must_use]
pub fn default_stain_m() -> f64 {
    3e-6
}

wire_enum! {
    /// Mode of a brush (Baxter 2004, § 6.8).
    pub enum BrushMode {
        /// It pushes paint, leaves some and takes some up.
        Normal,
        /// It leaves and takes up, but pushes nothing.
        NoPush,
        /// It stays as it is, full or empty, whatever it leaves or takes up.
        Sponge,
        /// As a sponge, and it pushes nothing.
        SpongeNoPush,
        /// It leaves as much as its flow says, and takes up nothing.
        Marker,
        /// It takes on the colours that it touches; the surface stays as it is.
        Sampler,
        /// It lifts off what it touches, and is clean.
        Vacuum,
    }
}

wire_struct! {
    /// Use of a brush.
    pub struct BrushHandling {
        /// Name of the brush.
        pub brush: String,
        /// Its mode.
        pub mode: BrushMode,
        /// Flow of the marker: thickness that it leaves along a metre of its way, m/m.
        pub flow: f64,
        /// On the canvas it adds no paint where as much is wet, in hollows twice as much, m; 0 for no such bound.
        pub most_m: f64,
    }
}

impl BrushMode {
    /// All modes by name.
    pub const NAMES: [(&str, Self); 7] = [
        ("normal", Self::Normal),
        ("no-push", Self::NoPush),
        ("sponge", Self::Sponge),
        ("sponge-no-push", Self::SpongeNoPush),
        ("marker", Self::Marker),
        ("sampler", Self::Sampler),
        ("vacuum", Self::Vacuum),
    ];

    /// Its name.
    #[must_use]
    pub fn name(&self) -> &'static str {
        let found = Self::NAMES.iter().find(|(_, mode)| mode == self);
        found.map_or("", |(name, _)| name)
    }
}

impl std::str::FromStr for BrushMode {
    type Err = ValueError;

    fn from_str(name: &str) -> Result<Self, ValueError> {
        let found = Self::NAMES.iter().find(|(known, _)| *known == name);
        found.map(|(_, mode)| mode.clone()).ok_or_else(|| {
            let names = Self::NAMES.map(|(name, _)| name);
            ValueError::Unknown {
                what: "mode",
                name: name.chars().take(40).collect(),
                choice: choice(name, names),
            }
        })
    }
}

impl BrushHandling {
    /// A brush that is used as brushes are.
    #[must_use]
    pub fn normal(brush: &str) -> Self {
        Self {
            brush: brush.to_owned(),
            mode: BrushMode::Normal,
            flow: MARKER_FLOW,
            most_m: 0.0,
        }
    }
}

wire_struct! {
    /// A paint that the painting uses.
    pub struct PaintSlot {
        /// Name as in the paint file.
        pub name: String,
        /// Colour of an opaque layer, linear sRGB.
        pub masstone: [f32; 3],
        /// Colour of one part in ten of titanium white, linear sRGB.
        pub tint: [f32; 3],
        /// Hash of the paint file.
        pub file_hash: u32,
    }
}

wire_struct! {
    /// Paint that dried at one time.
    pub struct Layer {
        /// Its number, from 1; a layer lies over all of lower numbers.
        pub number: u32,
        /// Its name.
        pub name: String,
        /// Factor on its optical thickness, 0 to 1; its height stays.
        pub opacity: f32,
    }
}

impl Layer {
    /// Name of a layer that was given none.
    #[must_use]
    pub fn default_name(number: u32) -> String {
        format!("layer {number}")
    }

    /// True if it was given no name.
    #[must_use]
    pub fn is_unnamed(&self) -> bool {
        self.name == Self::default_name(self.number)
    }
}

wire_struct! {
    /// A version of the painting that was kept.
    pub struct NamedVersion {
        /// Its name.
        pub name: String,
        /// The version that it was painted from; empty where that was none.
        pub parent: String,
        /// True if the painter continues from here.
        pub here: bool,
    }
}

wire_struct! {
    /// Changes of a brush while painting.
    pub struct Tuning {
        /// Name of the brush.
        pub brush: String,
        /// Factor on the stiffness of its file.
        pub stiffness: f64,
        /// From 0, as in its file, to 1, soaked: a soaked head is half as stiff.
        pub wetness: f64,
    }
}

impl Tuning {
    /// Factor on the stiffness of a head.
    #[must_use]
    pub fn factor(&self) -> f64 {
        self.stiffness * (1.0 - 0.5 * self.wetness)
    }
}

wire_struct! {
    /// Permanent set of a brush when it was last in the air.
    pub struct BrushSet {
        /// Name of the brush.
        pub brush: String,
        /// Grows each time that the painting gives it one: the brush takes that on.
        pub given: u32,
        /// The angles of its solve in the air; empty for an unbent head.
        pub angles_rad: Vec<[f32; 2]>,
    }
}

message! {
    /// The desk; cached for late joiners.
    pub struct Scene [version 7, at most 16777216 bytes] {
        /// Grows with every change.
        pub version: u64,
        /// The canvas first.
        pub surfaces: Vec<Surface>,
        /// At most 16.
        pub paints: Vec<PaintSlot>,
        /// The lamp.
        pub light: Light,
        /// Brushes that are not as in their files.
        pub tunings: Vec<Tuning>,
        /// Dry layers, the oldest first.
        pub layers: Vec<Layer>,
        /// The versions that were kept, by name.
        pub versions: Vec<NamedVersion>,
        /// Brushes that are used in a way of their own.
        pub handlings: Vec<BrushHandling>,
        /// Bends that stay in brushes.
        #[serde(default)]
        pub sets: Vec<BrushSet>,
    }
}

impl Scene {
    /// Factor on the stiffness of the brush called `brush`.
    #[must_use]
    pub fn tuning(&self, brush: &str) -> f64 {
        let mut tunings = self.tunings.iter();
        tunings
            .find(|tuning| tuning.brush == brush)
            .map_or(1.0, Tuning::factor)
    }

    /// Permanent set of the brush called `brush`; absent if it never had one.
    #[must_use]
    pub fn set(&self, brush: &str) -> Option<&BrushSet> {
        self.sets.iter().find(|set| set.brush == brush)
    }

    /// Notes the permanent set of the brush called `brush`, as the brush says.
    pub fn note_set(&mut self, brush: &str, angles_rad: &[[f32; 2]]) {
        match self.sets.iter_mut().find(|set| set.brush == brush) {
            Some(set) => set.angles_rad = angles_rad.to_vec(),
            None => self.sets.push(BrushSet {
                brush: brush.to_owned(),
                given: 0,
                angles_rad: angles_rad.to_vec(),
            }),
        }
    }

    /// Gives the brush called `brush` a permanent set.
    pub fn give_set(&mut self, brush: &str, angles_rad: &[[f32; 2]]) {
        self.note_set(brush, angles_rad);
        let set = self.sets.iter_mut().find(|set| set.brush == brush);
        set.into_iter()
            .for_each(|set| set.given = set.given.wrapping_add(1));
        self.version += 1;
    }

    /// Wetness of the brush called `brush`, 0 to 1.
    #[must_use]
    pub fn wetness(&self, brush: &str) -> f64 {
        let mut tunings = self.tunings.iter();
        tunings
            .find(|tuning| tuning.brush == brush)
            .map_or(0.0, |tuning| tuning.wetness)
    }
}
