//! The form of messages on the wire.
//!
//! | module | holds |
//! | --- | --- |
//! | [`header`] | the header, flags, and the errors of reading a message |
//! | [`schema`] | field tables and their hash |
//! | [`field_table`], [`value`] | bodies of messages, decoded by a table that need not be this program's |
//! | `translate` | values of other versions as bodies of this one |
//! | [`topics`] | the key expressions of a rig |
//! | [`worded`] | values that earlier versions had in words |
//! | `define` | the macro that makes struct, codec and field table of one definition |
//! | `codec` | bincode, always with a limit |
//! | `plain` | text of others made safe for a line |
//! | `catalogue` | all messages |

pub(crate) mod catalogue;
pub(crate) mod codec;
pub(crate) mod define;
pub mod field_table;
pub mod header;
pub(crate) mod plain;
pub mod schema;
pub mod topics;
mod translate;
pub mod value;
pub mod worded;
