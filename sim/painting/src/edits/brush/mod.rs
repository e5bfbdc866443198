//! Edits of brushes: their loads and their handling.

mod clean;
mod handle;
mod load;
mod load_from;
mod reshape;
mod tune;

pub use clean::Clean;
pub use handle::Handle;
pub use load::Load;
pub use load_from::LoadFrom;
pub use reshape::Reshape;
pub use tune::Tune;
