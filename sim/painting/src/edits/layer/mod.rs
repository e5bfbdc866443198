//! Edits of dry layers: drying, rewetting, varnish, opacity and names.

mod dry;
mod name_layer;
mod opacity;
mod stop_drying;
mod varnish;
mod wet;

pub use dry::Dry;
pub use name_layer::NameLayer;
pub use opacity::{LayerRef, Opacity};
pub use stop_drying::StopDrying;
pub use varnish::{Finish, Varnish};
pub use wet::Wet;
