//! Commands of takes: performances made, imported and painted.

pub(crate) mod from;
mod import;
mod painting_record;
pub mod render;
mod render_session;
pub(crate) mod session_file;
pub mod take;
mod take_writer;
