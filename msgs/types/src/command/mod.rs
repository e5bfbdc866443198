//! Commands to the nodes of a rig, by who carries them out, and their replies.

pub mod advice;
mod detail;
pub mod reply_cache;
pub mod session;
pub mod slow_canvas;

use serde::de::Error as _;

use crate::command::advice::Advice;
pub use crate::command::detail::Detail;
pub use crate::command::session::SessionCommand;
use crate::edit::{Edit, EditFields};
use crate::limits::{CELLS, CELLS_IN_ALL};
use crate::mixture::Mixture;
use crate::scene::CANVAS;
use crate::values::{
    BrushName, BrushToml, CellSide, DeviceName, DeviceToml, MaterialName, StainThickness,
    ValueError, WholePath,
};
use crate::wire::define::{message, wire_enum, wire_struct};

/// The node that has the painting.
pub const PAINT_NODE: &str = "paint";
/// Name of the launcher, which carries out commands to the rig as a whole.
pub const RIG_NODE: &str = "rig";

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
    /// Canvas of a new painting.
    #[serde(try_from = "CanvasFields")]
    pub struct NewCanvas {
        /// Width, m.
        pub width_m: f64,
        /// Height, m.
        pub height_m: f64,
        /// Side of a cell, m.
        pub cell_m: f64,
        /// Name of the ground, or the whole path of a CSV file of nm,reflectance or of a picture.
        pub ground: MaterialName,
        /// Name of the tooth.
        pub tooth: MaterialName,
        /// Seed of the tooth.
        pub tooth_seed: u64,
        /// Thickness of paint that stays however hard it is brushed, m.
        pub stain_m: f64,
    }
}

/// A canvas as it is decoded.
#[derive(serde::Deserialize)]
struct CanvasFields {
    width_m: f64,
    height_m: f64,
    cell_m: f64,
    ground: MaterialName,
    tooth: MaterialName,
    tooth_seed: u64,
    stain_m: f64,
}

impl TryFrom<CanvasFields> for NewCanvas {
    type Error = ValueError;

    fn try_from(fields: CanvasFields) -> Result<Self, ValueError> {
        let canvas = Self {
            width_m: fields.width_m,
            height_m: fields.height_m,
            cell_m: fields.cell_m,
            ground: fields.ground,
            tooth: fields.tooth,
            tooth_seed: fields.tooth_seed,
            stain_m: fields.stain_m,
        };
        canvas.check()?;
        Ok(canvas)
    }
}

impl NewCanvas {
    /// Checks that it can be made: whether there are such a ground and tooth is seen later.
    ///
    /// # Errors
    /// [`ValueError`].
    pub fn check(&self) -> Result<(), ValueError> {
        CellSide::new(self.cell_m)?;
        let size_m = [self.width_m, self.height_m];
        let [width, height] = size_m.map(|side| side / self.cell_m);
        if !(CELLS.contains(&width) && CELLS.contains(&height)) {
            let cell_m = self.cell_m;
            return Err(ValueError::Canvas { size_m, cell_m });
        }
        if width * height > CELLS_IN_ALL {
            return Err(ValueError::Cells(width * height));
        }
        StainThickness::new(self.stain_m).map(drop)
    }
}

wire_struct! {
    /// A painting for other programs.
    pub struct ExportOrder {
        /// The whole path of the file.
        pub path: WholePath,
        /// `png`, `exr`, `ora`, `height`, `stl` or `glb`; as the path ends if empty.
        pub format: String,
        /// The surface.
        pub surface: u32,
        /// Bits a channel of a PNG: 8 or 16.
        #[serde(deserialize_with = "bits")]
        pub bits: u32,
        /// Thickness of a solid under its lowest place, m.
        pub base_m: f64,
        /// Factor on the heights of a solid.
        pub exaggeration: f64,
        /// Cells from one point of a solid to the next; 0 so that it has 4 million triangles at most.
        pub step: u32,
        /// Profile of a PNG: `srgb`, `display-p3`; that of the rig if empty.
        pub profile: String,
        /// Mapping of a PNG's colours into its gamut: `soft`, `clamp`; as in the rig if empty.
        pub gamut: String,
    }
}

/// Bits per channel that a PNG may have.
///
/// # Errors
/// [`ValueError::Bits`].
pub fn png_bits(bits: u32) -> Result<u32, ValueError> {
    if [8, 16].contains(&bits) {
        Ok(bits)
    } else {
        Err(ValueError::Bits(bits))
    }
}

fn bits<'de, D: serde::Deserializer<'de>>(from: D) -> Result<u32, D::Error> {
    let bits = serde::Deserialize::deserialize(from)?;
    png_bits(bits).map_err(D::Error::custom)
}

impl ExportOrder {
    /// The canvas, in the format that the path says, with what is usual for all else.
    #[must_use]
    pub fn to(path: WholePath) -> Self {
        Self {
            path,
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

wire_struct! {
    /// The painting, with its history, in another file, in which it continues.
    pub struct SaveAs {
        /// The whole path of the file.
        pub path: WholePath,
        /// True if a painting at that path may be replaced.
        pub replace: bool,
    }
}

wire_enum! {
    /// A command, by who carries it out.
    #[allow(clippy::large_enum_variant, reason = "commands are few and short-lived")]
    pub enum Command {
        /// The painting: it changes by an edit.
        Edit(Edit),
        /// The sequencer: something takes its place in the journal and changes no paint.
        Take(TakeCommand),
        /// The paint node, beside the journal: files are written.
        File(FileCommand),
        /// The node of a brush.
        Brush(BrushCommand),
        /// The launcher: the rig continues in another painting.
        Rig(RigCommand),
        /// The paint node: a recorded session is painted again.
        Session(SessionCommand),
    }
}

wire_enum! {
    /// Commands that have a place in the journal besides edits.
    pub enum TakeCommand {
        /// Announces a take: only announced takes paint. Each new stroke takes the next load in
        /// turn; without loads the brush keeps what it has.
        Begin {
            /// Name of the brush that will follow it.
            brush: BrushName,
            /// Source of the player's samples.
            device: u32,
            /// Epoch of this playing.
            device_epoch: u32,
            /// The loads.
            loads: Vec<Mixture>,
            /// True if it begins again after a crash: its strokes so far are undone first.
            again: bool,
        },
        /// Ends nothing and changes nothing: its reply says that the place it names is reached.
        Mark,
        /// Writes a picture of the canvas as it is there and, if asked, the ledger.
        Snapshot {
            /// A PNG; written beside and renamed.
            path: WholePath,
            /// A JSON file with the ledger.
            ledger: Option<WholePath>,
        },
    }
}

wire_enum! {
    /// Commands about files, which the paint node carries out beside the painting.
    pub enum FileCommand {
        /// Writes the painting for other programs.
        Export(ExportOrder),
        /// Cancels the running export: its file is not written.
        StopExport,
        /// Puts the painting into another file.
        SaveAs(SaveAs),
        /// Writes a copy of the painting, with its history; painting continues where it was.
        Copy {
            /// The whole path of the copy, which is not there yet.
            path: WholePath,
        },
    }
}

wire_enum! {
    /// Commands to a brush node.
    pub enum BrushCommand {
        /// Gives a brush another file.
        Define {
            /// Name of the brush.
            brush: BrushName,
            /// The file, TOML.
            toml: BrushToml,
        },
    }
}

wire_enum! {
    /// Commands to the launcher.
    pub enum RigCommand {
        /// Goes on in another painting.
        Open {
            /// The whole path of a painting that there is.
            path: WholePath,
            /// True if a painting that is in memory alone may be discarded.
            forget: bool,
        },
        /// Begins another painting and continues in it.
        New {
            /// The whole path of its file, which is not there yet; in memory alone if absent.
            path: Option<WholePath>,
            /// Its canvas.
            canvas: NewCanvas,
            /// True if a painting that is in memory alone may be discarded.
            forget: bool,
        },
        /// As [`FileCommand::SaveAs`], so that the rig starts with that file again.
        SaveAs(SaveAs),
        /// Starts a device, in the place of the one with its name if there is one.
        PutDevice {
            /// Its section of `rig.toml`, without the head.
            toml: DeviceToml,
        },
        /// Ends a device.
        RemoveDevice {
            /// Its name.
            name: DeviceName,
        },
    }
}

macro_rules! from {
    ($($inner:ident => $variant:ident),*) => {
        $(
            impl From<$inner> for Command {
                fn from(command: $inner) -> Self {
                    Self::$variant(command)
                }
            }
        )*
    };
}

from!(Edit => Edit, TakeCommand => Take, FileCommand => File, BrushCommand => Brush, RigCommand => Rig,
    SessionCommand => Session);

impl Command {
    /// Name of the node that carries it out.
    #[must_use]
    pub fn node(&self) -> &str {
        match self {
            Self::Edit(_) | Self::Take(_) | Self::File(_) | Self::Session(_) => PAINT_NODE,
            Self::Brush(BrushCommand::Define { brush, .. }) => brush,
            Self::Rig(_) => RIG_NODE,
        }
    }

    /// Its refusal by a node that it is not for.
    #[must_use]
    pub fn misaddressed(&self) -> Outcome {
        Outcome::Refused {
            what: "this node does not carry out this command".to_owned(),
            advice: Advice::say(format!("it is for the node '{}'", self.node())),
        }
    }
}

message! {
    /// A command with its sender and number; sending it again with the same number is safe.
    pub struct CommandRequest [version 12, at most 1048576 bytes] {
        /// A number that the client drew at random.
        pub client: u64,
        /// Counts the client's commands.
        pub number: u64,
        /// Where it takes its place in the journal; at once if absent.
        pub after: Option<After>,
        /// The command.
        pub command: Command,
    }
}

impl CommandRequest {
    /// The number of a request, read before its command: one whose command is out of range is answered, too.
    #[must_use]
    pub fn number_in(bytes: &[u8]) -> Option<u64> {
        let (_, body) = crate::wire::codec::body_of::<Self>(bytes).ok()?;
        let number = body.get(8..16)?.try_into().ok()?;
        Some(u64::from_le_bytes(number))
    }
}

wire_enum! {
    /// Outcome of a command.
    pub enum Outcome {
        /// It is done.
        Done {
            /// Its index in the journal.
            journal: u64,
            /// Its result.
            #[serde(deserialize_with = "crate::wire::worded::read")]
            detail: Detail,
        },
        /// It is accepted and waits for its place; ask again with the same number.
        Waiting,
        /// It was not done.
        Refused {
            /// The reason.
            what: String,
            /// Advice; each front end has its own words for it.
            advice: Advice,
        },
    }
}

impl Outcome {
    /// It is done, beside the journal, and says so much about it.
    #[must_use]
    pub fn done(words: impl Into<String>) -> Self {
        Self::Done {
            journal: 0,
            detail: Detail::say(words),
        }
    }

    /// It was not done, with advice in words.
    #[must_use]
    pub fn refused(what: impl Into<String>, help: impl Into<String>) -> Self {
        Self::Refused {
            what: what.into(),
            advice: Advice::say(help),
        }
    }
}

message! {
    /// The reply to a command.
    pub struct CommandReply [version 3, at most 65536 bytes] {
        /// The command's number.
        pub number: u64,
        /// Its outcome.
        pub outcome: Outcome,
    }
}

message! {
    /// Asks a sender for messages that were lost on the way.
    pub struct GapRequest [contract of hash 0x8a08_7b74, version 1, at most 64 bytes] {
        /// The sender's epoch.
        pub epoch: u32,
        /// First number.
        pub from: u64,
        /// Last number.
        pub to: u64,
    }
}

impl<T: EditFields> From<T> for Command {
    fn from(edit: T) -> Self {
        Self::Edit(edit.into())
    }
}

impl Command {
    /// The fields of its edit, if it is one of this kind and they are in range.
    #[must_use]
    pub fn edit<T: EditFields>(&self) -> Option<T> {
        match self {
            Self::Edit(edit) => edit.get(),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn canvases_are_sound_or_rejected_with_what_to_do() {
        let new = |width_m: f64, cell_m: f64| NewCanvas {
            width_m,
            height_m: 0.2,
            cell_m,
            ground: MaterialName::new("gesso").expect("a name"),
            tooth: MaterialName::new("linen").expect("a name"),
            tooth_seed: 1,
            stain_m: 3e-6,
        };
        assert_eq!(new(0.3, 2.5e-4).check(), Ok(()));
        for (width_m, cell_m, word) in [
            (0.0, 2.5e-4, "0×20 cm"),
            (1e4, 2.5e-4, "1638 cm"),
            (f64::NAN, 2.5e-4, "NaN"),
            (0.3, 0.0, "0 mm"),
            (0.3, f64::INFINITY, "inf mm"),
            (0.6, 1e-5, "million cells"),
        ] {
            let what = new(width_m, cell_m)
                .check()
                .expect_err("rejected")
                .to_string();
            assert!(what.contains(word) && what.contains("choose"), "{what}");
        }
        assert!(png_bits(16).is_ok() && png_bits(12).is_err());
    }
}
