//! Edits of brushes: what they carry and how they are used.

mod clean;
mod handle;
mod load;
mod pick;
mod tune;

pub use clean::Clean;
pub use handle::Handle;
pub use load::Load;
pub use pick::Pick;
pub use tune::Tune;
