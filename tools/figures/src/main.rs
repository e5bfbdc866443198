//! Figures of brush, paint, colour and fluid, as pictures and tables.
//!
//! | module | holds |
//! | --- | --- |
//! | [`sheet`] | the sheet of brushes and their marks, the sheet of effects |
//! | [`chart`] | the mixing chart, and one mixture by four ways of mixing |
//! | [`fluid_force`] | the force of a fluid on a square |
//! | [`commands`] | the commands that write them |

mod chart;
mod commands;
mod fluid_force;
mod sheet;

fn main() {
    maulstick::beside::tool(commands::run);
}
