//! Reports of a player: a line of a terminal that is written again and again, or lines of JSON.

use std::path::PathBuf;

use maulstick_recorder::{Guiding, Position, ReplayReport};
use maulstick_rig::UserError;
use serde_json::json;

use crate::commands::{print_json_line, say};

/// Shows the reports of a player.
#[derive(Debug)]
pub(super) struct Reports {
    in_json: bool,
    /// The painting in which a session is painted again.
    painting: Option<PathBuf>,
    /// True while the line of the position waits for its end.
    is_open: bool,
}

impl Reports {
    pub(super) fn new(in_json: bool) -> Self {
        Self {
            in_json,
            painting: None,
            is_open: false,
        }
    }

    /// Shows a report: positions as JSON, or where keys are orders.
    pub(super) fn show(&mut self, report: &ReplayReport, are_keys: bool) -> Result<(), UserError> {
        if let ReplayReport::Painting { painting } = report {
            self.painting = Some(painting.clone());
        }
        if self.in_json {
            return print_json_line(&match report {
                ReplayReport::Position(own) => json!({
                    "position_s": own.position_s,
                    "length_s": own.length_s,
                    "rate": own.rate.to_string(),
                    "paused": own.paused,
                }),
                ReplayReport::Guiding(own) => json!({
                    "position_s": own.position_s,
                    "strokes": own.strokes,
                    "traced": own.traced,
                    "strength": own.strength,
                    "paused": own.paused,
                }),
                ReplayReport::Opening { painting } => json!({ "opens": painting }),
                ReplayReport::Painting { painting } => json!({ "painting": painting }),
            });
        }
        if !are_keys {
            return Ok(());
        }
        let paused = |paused: bool| if paused { "  paused" } else { "        " };
        match *report {
            ReplayReport::Position(Position {
                position_s,
                rate,
                paused: stands,
                ..
            }) => eprint!("\r{position_s:8.1} s  × {rate}{}  ", paused(stands)),
            ReplayReport::Guiding(Guiding {
                strokes,
                traced,
                strength,
                paused: stands,
                ..
            }) => {
                let percent = (100.0 * strength).round();
                eprint!(
                    "\r{traced} of {strokes} strokes  strength {percent} %{}  ",
                    paused(stands)
                );
            }
            ReplayReport::Opening { .. } | ReplayReport::Painting { .. } => return Ok(()),
        }
        self.is_open = true;
        Ok(())
    }

    /// Ends the line of the position, and says where a session was painted.
    pub(super) fn end(&self, is_well: bool) -> Result<(), UserError> {
        if self.is_open {
            eprintln!();
        }
        if let Some(painting) = self.painting.as_ref().filter(|_| is_well && !self.in_json) {
            say!("painted in {}", painting.display());
        }
        Ok(())
    }
}
