//! Commands to the paint node and their replies.

use crate::define::{message, wire_enum, wire_struct};
use crate::mixture::Mixture;
use crate::pose::Pose;
use crate::region::Region;
use crate::scene::{BrushHandling, FLOWS, Light, STAINS_M, Tuning};
use crate::stylus::FARTHEST_M;
use crate::topics::check_name;

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
    }
}

impl Command {
    /// Checks names, paths and mixtures for their length, so that whoever answers may quote them,
    /// and that no surface is put out of reach.
    ///
    /// # Errors
    /// What is wrong, in few words.
    pub fn check(&self) -> Result<(), String> {
        match self {
            Self::Load { brush, mixture } => brush_name(brush).and_then(|()| short(mixture)),
            Self::Clean { brush } => brush_name(brush),
            Self::LoadBeside { brush, left, right } => {
                brush_name(brush).and_then(|()| [left, right].into_iter().try_for_each(short))
            }
            Self::Define { brush, toml } => {
                brush_name(brush).and_then(|()| match toml.len() > BRUSH_FILE_MAX {
                    true => Err(format!("a brush file of {} bytes is too long", toml.len())),
                    false => Ok(()),
                })
            }
            Self::Tune { tuning } => brush_name(&tuning.brush).and_then(|()| {
                let good =
                    STIFFNESS.contains(&tuning.stiffness) && (0.0..=1.0).contains(&tuning.wetness);
                match good {
                    true => Ok(()),
                    false => Err(format!(
                        "stiffness is {}, wetness {}, but must be 0.05 to 20 and 0 to 1",
                        tuning.stiffness, tuning.wetness
                    )),
                }
            }),
            Self::Take { brush, loads, .. } => {
                brush_name(brush).and_then(|()| loads.iter().try_for_each(short))
            }
            Self::Snapshot { path, ledger } => {
                let paths = std::iter::once(path).chain(ledger);
                match paths.map(String::len).find(|length| *length > PATH_MAX) {
                    Some(length) => Err(format!(
                        "a path of {length} bytes is longer than {PATH_MAX}"
                    )),
                    None => Ok(()),
                }
            }
            Self::Place { pose, .. } => {
                let near = |metres: &f64| metres.abs() <= FARTHEST_M;
                match pose.position_m.iter().all(near) {
                    true => Ok(()),
                    false => Err(format!(
                        "the surface's place is not within {FARTHEST_M} m of the desk's origin"
                    )),
                }
            }
            Self::Relight { light, .. } => light.check(),
            Self::Dry { share, name, .. } => drying_share(*share).and_then(|()| layer_name(name)),
            Self::DryRegion {
                share,
                name,
                region,
                ..
            } => drying_share(*share)
                .and_then(|()| layer_name(name))
                .and_then(|()| region.check()),
            Self::DryOver {
                ticks,
                name,
                region,
                ..
            } => match DRYING_TICKS.contains(ticks) {
                true => layer_name(name).and_then(|()| checked(region.as_ref())),
                false => Err("a drying takes a sixtieth of a second to a year".to_owned()),
            },
            Self::Wet { region, .. } => checked(region.as_ref()),
            Self::Opacity { opacity, .. } => opaque(*opacity),
            Self::LayerOpacity { layer, opacity } => {
                layer_name(layer).and_then(|()| opaque(*opacity))
            }
            Self::GroundSpectrum { spectrum, .. } => match spectrum.len() > SPECTRUM_MAX {
                true => Err(format!(
                    "a spectrum of {} bytes is too long",
                    spectrum.len()
                )),
                false => Ok(()),
            },
            Self::Undo { brush } | Self::Redo { brush } => {
                brush.as_deref().map_or(Ok(()), brush_name)
            }
            Self::Ground { ground: name, .. } | Self::Tooth { tooth: name, .. } => {
                match name.len() > PATH_MAX {
                    true => Err(format!("a name of {} bytes is too long", name.len())),
                    false => Ok(()),
                }
            }
            Self::Fill {
                mixture,
                thickness_m,
                ..
            } => film(*thickness_m).and_then(|()| short(mixture)),
            Self::FillWith {
                brush, thickness_m, ..
            } => film(*thickness_m).and_then(|()| brush_name(brush)),
            Self::Handle { handling } => brush_name(&handling.brush).and_then(|()| {
                if !FLOWS.contains(&handling.flow) {
                    return Err(format!(
                        "a flow of {} µm/mm, but it must be .001 to 100",
                        handling.flow * 1e3
                    ));
                }
                match handling.most_m == 0.0 {
                    true => Ok(()),
                    false => film(handling.most_m),
                }
            }),
            Self::Size { stain_m, .. } => match STAINS_M.contains(stain_m) {
                true => Ok(()),
                false => Err(format!(
                    "a stain of {} µm, but it must be 0 to 1000 µm",
                    stain_m * 1e6
                )),
            },
            Self::Piles { .. } => Ok(()),
            Self::Keep { name } | Self::Return { name } | Self::Forget { name } => {
                version_name(name)
            }
            Self::Branch { from, name } => [from, name]
                .into_iter()
                .try_for_each(|name| version_name(name)),
            Self::Mark | Self::StopDrying { .. } => Ok(()),
        }
    }
}

fn film(thickness_m: f64) -> Result<(), String> {
    match FILM_M.contains(&thickness_m) {
        true => Ok(()),
        false => Err(format!(
            "a film of {} µm, but it must be 1 to 5000 µm",
            thickness_m * 1e6
        )),
    }
}

fn brush_name(name: &str) -> Result<(), String> {
    check_name(name).map_err(|what| {
        if name.len() > 2 * PAINT_NAME_MAX {
            format!("a brush's name of {} bytes is too long", name.len())
        } else {
            format!("the brush's name {what}")
        }
    })
}

fn layer_name(name: &str) -> Result<(), String> {
    match name.len() > LAYER_NAME_MAX {
        true => Err(format!(
            "a layer's name of {} bytes is too long",
            name.len()
        )),
        false => Ok(()),
    }
}

fn drying_share(share: f32) -> Result<(), String> {
    match share > 0.0 && share <= 1.0 {
        true => Ok(()),
        false => Err(format!(
            "the share that dries is {share}, but must be above 0 to 1"
        )),
    }
}

fn opaque(opacity: f32) -> Result<(), String> {
    match (0.0..=1.0).contains(&opacity) {
        true => Ok(()),
        false => Err(format!("the opacity is {opacity}, but must be 0 to 1")),
    }
}

fn checked(region: Option<&Region>) -> Result<(), String> {
    region.map_or(Ok(()), Region::check)
}

fn version_name(name: &str) -> Result<(), String> {
    if name.trim().is_empty() || name.len() > VERSION_NAME_MAX || name.contains(char::is_control) {
        return Err(format!(
            "a version's name has 1 to {VERSION_NAME_MAX} bytes, and no line breaks"
        ));
    }
    Ok(())
}

fn short(mixture: &Mixture) -> Result<(), String> {
    if mixture.parts.len() > PARTS_MAX {
        let parts = mixture.parts.len();
        return Err(format!("a mixture of {parts} paints has over {PARTS_MAX}"));
    }
    let longest = mixture.parts.iter().map(|part| part.paint.len()).max();
    match longest.filter(|length| *length > PAINT_NAME_MAX) {
        Some(length) => Err(format!("a paint's name of {length} bytes is too long")),
        None => Ok(()),
    }
}

message! {
    /// A command with its sender and number; sending it again with the same number is safe.
    pub struct CommandRequest [version 5, at most 1048576 bytes] {
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
