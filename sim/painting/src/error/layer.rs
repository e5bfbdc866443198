//! Errors of dry layers and dryings.

use maulstick_types::Region;
use maulstick_types::command::advice::Advice;

/// A layer or a drying that is rejected.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LayerError {
    /// Nothing to dry.
    #[error("nothing is wet{}", within(.0.as_ref()))]
    NothingWet(Option<Region>),
    /// Nothing to make wet again.
    #[error("nothing has dried{}", within(.0.as_ref()))]
    NothingDry(Option<Region>),
    /// No place for varnish.
    #[error("all paint{} is wet, and varnish goes on dry paint", within(.0.as_ref()))]
    AllWet(Option<Region>),
    /// No varnish to take off.
    #[error("no varnish lies uppermost{}", within(.0.as_ref()))]
    NoVarnish(Option<Region>),
    /// No room for paint that is to be wet again.
    #[error("no cell{} has room for more wet paint", within(.0.as_ref()))]
    NoRoom(Option<Region>),
    /// A layer whose opacity wet paint cannot have.
    #[error("layer {number} ({name}) has an opacity other than 1, which wet paint cannot have")]
    Veiled {
        /// Number of the layer.
        number: u32,
        /// Its name.
        name: String,
    },
    /// A drying of this surface is in progress.
    #[error("this surface is drying already")]
    Drying,
    /// No drying of this surface is in progress.
    #[error("this surface is not drying")]
    NotDrying,
    /// An unknown dry layer.
    #[error("there is no dry layer {which}")]
    Unknown {
        /// How it was called.
        which: String,
        /// Numbers and names of those that there are.
        known: Vec<(u32, String)>,
    },
}

fn within(region: Option<&Region>) -> String {
    region.map_or(String::new(), |region| format!(" in {region}"))
}

impl LayerError {
    /// What to do about it.
    #[must_use]
    pub fn advice(&self) -> Advice {
        match self {
            Self::NothingWet(_) => Advice::say("paint something first"),
            Self::NothingDry(_) | Self::AllWet(_) => Advice::DryFirst,
            Self::NoVarnish(_) => Advice::say("varnish it first, or take back what lies on it"),
            Self::NoRoom(_) => Advice::say("remove some wet paint first, or dry it"),
            Self::Veiled { number, .. } => Advice::FullOpacity { layer: *number },
            Self::Drying => Advice::StopDrying,
            Self::NotDrying => Advice::BeginDrying,
            Self::Unknown { known, .. } if known.is_empty() => Advice::DryFirst,
            Self::Unknown { known, .. } => {
                let known = known.iter();
                let known = known.map(|(number, name)| format!("{number} ({name})"));
                let known = known.collect::<Vec<_>>().join(", ");
                Advice::say(format!("choose one of: {known}"))
            }
        }
    }
}
