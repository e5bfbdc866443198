//! Edits of the history: steps undone and redone, versions kept and restored.

mod branch;
mod forget;
mod go_to;
mod keep;
mod redo;
mod return_to;
mod undo;

pub use branch::Branch;
pub use forget::Forget;
pub use go_to::GoTo;
pub use keep::Keep;
pub use redo::Redo;
pub use return_to::ReturnTo;
pub use undo::Undo;
