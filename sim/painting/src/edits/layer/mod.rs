//! Edits of dry layers: drying, rewetting, opacity and names.

mod dry;
mod name_layer;
mod opacity;
mod stop_drying;
mod wet;

pub use dry::Dry;
pub use name_layer::NameLayer;
pub use opacity::{LayerRef, Opacity};
pub use stop_drying::StopDrying;
pub use wet::Wet;
