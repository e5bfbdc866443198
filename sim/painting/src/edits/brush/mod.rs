//! Edits of brushes: their loads and their handling.

mod clean;
mod handle;
mod load;
mod load_from;
mod tune;

pub use clean::Clean;
pub use handle::Handle;
pub use load::Load;
pub use load_from::LoadFrom;
pub use tune::Tune;
