//! Commands to the paint node and their replies.

use crate::define::{message, wire_enum, wire_struct};
use crate::mixture::Mixture;
use crate::pose::Pose;
use crate::region::Region;
use crate::scene::{BrushHandling, CANVAS, Light, Tuning, Well};

mod check;

/// A path of a command has at most this many bytes; Linux takes no longer ones.
pub const PATH_MAX: usize = 4096;
/// A mixture of a command has at most this many parts.
pub const PARTS_MAX: usize = 64;
/// The name of a paint has at most this many bytes.
pub const PAINT_NAME_MAX: usize = 128;
/// The name of a layer has at most this many bytes.
pub const LAYER_NAME_MAX: usize = 128;
/// The name of a version has at most this many bytes.
pub const VERSION_NAME_MAX: usize = 128;
/// How thick a film of paint can be laid, m.
pub const FILM_M: std::ops::RangeInclusive<f64> = 1e-6..=5e-3;
/// A brush file has at most this many bytes.
pub const BRUSH_FILE_MAX: usize = 1_000_000;
/// A spectrum of a command has at most this many bytes.
pub const SPECTRUM_MAX: usize = 1 << 18;
/// How long a drying may take, in sixtieths of a second: up to a year.
pub const DRYING_TICKS: std::ops::RangeInclusive<u32> = 1..=60 * 60 * 60 * 24 * 365;
/// Sides of a cell, m.
pub const CELLS_M: std::ops::RangeInclusive<f64> = 1e-5..=1e-2;
/// Cells of a canvas either way: half of one is rounded up.
pub const CELLS: std::ops::RangeInclusive<f64> = 0.5..=65_536.0;
/// Cells of a new canvas in all, at most: twice what can be shown in comfort on a large machine.
pub const CELLS_IN_ALL: f64 = 1_073_741_824.0;
/// A surface has at most this many wells.
pub const WELLS_MAX: usize = 64;
/// Factors on the stiffness of a brush.
pub const STIFFNESS: std::ops::RangeInclusive<f64> = 0.05..=20.0;

wire_struct! {
    /// A place in a brush's stream: a command with it enters the journal right after that state.
    pub struct After {
        /// The brush: the source of its states.
        pub brush: u32,
        /// Its epoch.
        pub epoch: u32,
        /// The state.
        pub sequence: u64,
    }
}

wire_struct! {
    /// What a new painting is painted on.
    pub struct NewCanvas {
        /// Width, m.
        pub width_m: f64,
        /// Height, m.
        pub height_m: f64,
        /// Side of a cell, m.
        pub cell_m: f64,
        /// Name of the ground, or the whole path of a CSV file of nm,reflectance or of a picture.
        pub ground: String,
        /// Name of the tooth.
        pub tooth: String,
        /// Seed of the tooth.
        pub tooth_seed: u64,
        /// Thickness of paint that stays however hard it is brushed, m.
        pub stain_m: f64,
    }
}

wire_struct! {
    /// A painting for other programs.
    pub struct ExportOrder {
        /// The whole path of the file.
        pub path: String,
        /// `png`, `exr`, `ora`, `height` or `stl`; as the path ends if empty.
        pub format: String,
        /// The surface.
        pub surface: u32,
        /// Bits a channel of a PNG: 8 or 16.
        pub bits: u32,
        /// Thickness of a solid under its lowest place, m.
        pub base_m: f64,
        /// Factor on the heights of a solid.
        pub exaggeration: f64,
        /// Cells from one point of a solid to the next; 0 so that it has 4 million triangles at most.
        pub step: u32,
        /// Profile of a PNG: `srgb`, `display-p3`; that of the rig if empty.
        pub profile: String,
        /// How colours of a PNG come into its gamut: `soft`, `clamp`; as in the rig if empty.
        pub gamut: String,
    }
}

impl ExportOrder {
    /// The canvas, in the format that the path says, with what is usual for all else.
    #[must_use]
    pub fn to(path: &str) -> Self {
        Self {
            path: path.to_owned(),
            format: String::new(),
            surface: CANVAS,
            bits: 8,
            base_m: 2e-3,
            exaggeration: 1.0,
            step: 0,
            profile: String::new(),
            gamut: String::new(),
        }
    }
}

wire_enum! {
    /// What a painter, a script or a player can ask for.
    pub enum Command {
        /// Loads a brush afresh: what it carried goes to the cleaner.
        Load {
            /// Name of the brush.
            brush: String,
            /// What it takes up.
            mixture: Mixture,
        },
        /// Takes all paint off a brush.
        Clean {
            /// Name of the brush.
            brush: String,
        },
        /// Announces a take: only announced takes paint. Each new stroke takes the next load in
        /// turn; without loads the brush keeps what it has.
        Take {
            /// Name of the brush that will follow it.
            brush: String,
            /// Source of the player's samples.
            device: u32,
            /// Epoch of this playing.
            device_epoch: u32,
            /// The loads.
            loads: Vec<Mixture>,
            /// Whether it begins again, after a crash: what was painted of it is undone first.
            again: bool,
        },
        /// Takes the newest step back.
        Undo {
            /// Whose newest step, if not that of all; refused where a later step touches its tiles.
            brush: Option<String>,
        },
        /// Takes the newest undo back.
        Redo {
            /// Of whose steps, if not of all.
            brush: Option<String>,
        },
        /// Writes a picture of the canvas and, if asked, the ledger.
        Snapshot {
            /// A PNG; written beside and renamed.
            path: String,
            /// A JSON file with the ledger.
            ledger: Option<String>,
        },
        /// Moves, turns or zooms a surface.
        Place {
            /// The surface.
            surface: u32,
            /// Surface frame to desk frame.
            pose: Pose,
            /// Desk lengths per surface length.
            zoom: f64,
        },
        /// Ends nothing and changes nothing: its reply says that the place it names is reached.
        Mark,
        /// Loads a brush afresh with a mixture on either half of its width.
        LoadBeside {
            /// Name of the brush.
            brush: String,
            /// What the half toward −x of the brush takes up.
            left: Mixture,
            /// What the other half takes up.
            right: Mixture,
        },
        /// Gives a brush another file; it is the brush's own node that does it.
        Define {
            /// Name of the brush.
            brush: String,
            /// The file, TOML.
            toml: String,
        },
        /// Makes a brush stiffer or softer than its file says.
        Tune {
            /// How it is from now on.
            tuning: Tuning,
        },
        /// Changes the light, or how its light becomes colour.
        Relight {
            /// How it is from now on.
            light: Light,
            /// Whether the exposure is chosen anew, so that the bare canvas does not clip.
            expose: bool,
        },
        /// Dries wet paint of a surface into a new layer.
        Dry {
            /// The surface.
            surface: u32,
            /// The lower share of the wet film that dries, above 0 to 1.
            share: f32,
            /// Name of the layer.
            name: String,
        },
        /// Makes a dry layer more or less opaque.
        Opacity {
            /// Number of the layer.
            layer: u32,
            /// Factor on its optical thickness, 0 to 1.
            opacity: f32,
        },
        /// Gives a surface another ground.
        Ground {
            /// The surface.
            surface: u32,
            /// Name of the ground.
            ground: String,
        },
        /// Gives a surface another tooth.
        Tooth {
            /// The surface.
            surface: u32,
            /// Name of the tooth.
            tooth: String,
            /// Seed of the tooth.
            seed: u64,
        },
        /// Lays an even film of wet paint over a whole surface.
        Fill {
            /// The surface.
            surface: u32,
            /// The paint.
            mixture: Mixture,
            /// Thickness of the film, m.
            thickness_m: f64,
        },
        /// Keeps the painting as it is as a version.
        Keep {
            /// Name of the version.
            name: String,
        },
        /// Makes the painting as it was in a version.
        Return {
            /// Name of the version.
            name: String,
        },
        /// Begins a version from another one: the painting becomes as it was there.
        Branch {
            /// Name of the other version.
            from: String,
            /// Name of the new version.
            name: String,
        },
        /// Forgets a version.
        Forget {
            /// Name of the version.
            name: String,
        },
        /// Dries wet paint of a part of a surface into a new layer.
        DryRegion {
            /// The surface.
            surface: u32,
            /// The lower share of the wet film that dries, above 0 to 1.
            share: f32,
            /// Name of the layer.
            name: String,
            /// The part.
            region: Region,
        },
        /// Has the wet paint of a surface, or of a part, dry evenly into one new layer while time goes by.
        DryOver {
            /// The surface.
            surface: u32,
            /// How long, in sixtieths of a second.
            ticks: u32,
            /// Name of the layer.
            name: String,
            /// The part; all of it if absent.
            region: Option<Region>,
        },
        /// Ends the drying that goes on: what is wet still stays wet.
        StopDrying {
            /// The surface.
            surface: u32,
        },
        /// Makes the newest dry layers of a surface, or of a part, wet paint again where they lie.
        Wet {
            /// The surface.
            surface: u32,
            /// How many; 0 for all.
            layers: u32,
            /// The part; all of it if absent.
            region: Option<Region>,
        },
        /// Makes a dry layer, called by its name, more or less opaque.
        LayerOpacity {
            /// Its name, or its number in digits; of several of that name the newest.
            layer: String,
            /// Factor on its optical thickness, 0 to 1.
            opacity: f32,
        },
        /// Gives a surface a ground of a measured reflectance.
        GroundSpectrum {
            /// The surface.
            surface: u32,
            /// Reflectances, a CSV file of nm,reflectance.
            spectrum: String,
        },
        /// Says how a brush is used.
        Handle {
            /// How, from now on.
            handling: BrushHandling,
        },
        /// Lays an even film of the colour that a brush carries on the whole over a surface.
        FillWith {
            /// The surface.
            surface: u32,
            /// The brush.
            brush: String,
            /// Thickness of the film, m.
            thickness_m: f64,
        },
        /// Sizes a surface, heavily or hardly.
        Size {
            /// The surface.
            surface: u32,
            /// Thickness of paint that stays however hard it is brushed, m.
            stain_m: f64,
        },
        /// Says whether paint on a surface lasts, however much of it brushes take up.
        Piles {
            /// The surface.
            surface: u32,
            /// Whether it lasts.
            last: bool,
        },
        /// Goes on in another painting; it is the launcher that does it, as `rig`.
        Open {
            /// The whole path of a painting that there is.
            path: String,
            /// Whether what was painted in memory alone may go.
            forget: bool,
        },
        /// Begins another painting and goes on in it; it is the launcher that does it, as `rig`.
        New {
            /// The whole path of its file, which is not there yet; in memory alone if absent.
            path: Option<String>,
            /// What it is painted on.
            canvas: NewCanvas,
            /// Whether what was painted in memory alone may go.
            forget: bool,
        },
        /// Puts the painting with its history into another file and goes on in that one. To the launcher,
        /// as `rig`, so that it starts with it again; to the paint node it is the same till then.
        SaveAs {
            /// The whole path of the file.
            path: String,
            /// Whether a painting that is there already may go.
            replace: bool,
        },
        /// Writes the painting for other programs, beside what else is done.
        Export {
            /// How.
            order: ExportOrder,
        },
        /// Ends the export that goes on: its file is not written.
        StopExport,
        /// Gives a dry layer another name.
        NameLayer {
            /// Number of the layer.
            layer: u32,
            /// Its name from now on; not blank.
            name: String,
        },
        /// Gives a surface other wells. What brushes have stirred in those that go stays there, wet.
        Wells {
            /// The surface.
            surface: u32,
            /// Its wells from now on.
            wells: Vec<Well>,
        },
    }
}

message! {
    /// A command with its sender and number; sending it again with the same number is safe.
    pub struct CommandRequest [version 6, at most 1048576 bytes] {
        /// A number that the client drew at random.
        pub client: u64,
        /// Counts the client's commands.
        pub number: u64,
        /// Where it takes its place in the journal; at once if absent.
        pub after: Option<After>,
        /// What it does.
        pub command: Command,
    }
}

wire_enum! {
    /// What became of a command.
    pub enum Outcome {
        /// It is done.
        Done {
            /// Its index in the journal.
            journal: u64,
            /// What it wrote or found, in words; may be empty.
            detail: String,
        },
        /// It is accepted and waits for its place; ask again with the same number.
        Waiting,
        /// It was not done.
        Refused {
            /// What is wrong.
            what: String,
            /// What to do about it.
            help: String,
        },
    }
}

message! {
    /// The reply to a command.
    pub struct CommandReply [version 1, at most 65536 bytes] {
        /// The command's number.
        pub number: u64,
        /// What became of it.
        pub outcome: Outcome,
    }
}

message! {
    /// Asks a sender for messages that were lost on the way.
    pub struct GapRequest [version 1, at most 64 bytes] {
        /// The sender's epoch.
        pub epoch: u32,
        /// First number.
        pub from: u64,
        /// Last number.
        pub to: u64,
    }
}

#[cfg(test)]
mod tests;
