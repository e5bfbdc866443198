//! Commands of takes: performances made, imported and painted.

mod from;
mod import;
mod painting_record;
pub mod render;
mod render_options;
mod render_session;
pub mod take;
mod take_writer;
