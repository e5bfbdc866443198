//! What lies on the desk: surfaces, paints, light. The paint node owns it.

use crate::define::{message, wire_enum, wire_struct};
use crate::mixture::Mixture;
use crate::pose::Pose;

/// The canvas.
pub const CANVAS: u32 = 0;
/// The palette.
pub const PALETTE: u32 = 1;

wire_enum! {
    /// What a round region of the palette does.
    pub enum WellKind {
        /// Holds a mixture that never runs out.
        Paint {
            /// What it holds.
            mixture: Mixture,
        },
        /// Takes all paint off the brush.
        Cleaner,
    }
}

wire_struct! {
    /// A round region of a surface.
    pub struct Well {
        /// Middle in the surface's frame, m.
        pub center_m: [f64; 2],
        /// Radius, m.
        pub radius_m: f64,
        /// What it does.
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
    /// The lamp.
    pub struct Light {
        /// Unit vector toward the lamp, canvas frame.
        pub direction: [f64; 3],
        /// Factor on the light's strength.
        pub intensity: f64,
        /// Name of the spectrum.
        pub illuminant: String,
    }
}

wire_struct! {
    /// How a brush was changed while painting.
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

message! {
    /// The desk; cached for late joiners.
    pub struct Scene [version 2, at most 262144 bytes] {
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
}
