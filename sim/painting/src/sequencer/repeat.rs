//! A recorded session accepted again, record by record, in a continued painting.

use maulstick_types::Flags;
use maulstick_types::command::{Command, TakeCommand};
use maulstick_types::paint::{Decision, Entry};

use crate::error::EditError;

use super::{Accepted, Record, Sequencer};

impl Sequencer {
    /// Until [`end_repeating`](Self::end_repeating) live hands paint nothing, other commands are refused, and only the
    /// ticks of a session pass.
    pub fn begin_repeating(&mut self) {
        self.repeats = true;
    }

    /// True while a session is accepted again.
    #[must_use]
    pub fn is_repeating(&self) -> bool {
        self.repeats
    }

    /// Accepts a record of a session as if it had come now: it takes the next place in the journal.
    ///
    /// # Errors
    /// [`EditError`] where the painting refuses it.
    pub fn repeat(&mut self, record: Record) -> Result<(), EditError> {
        match record.what {
            Accepted::State { header, state } => {
                let brush = self.painting.brush_of(header.source).map(str::to_owned);
                let Some(brush) = brush.filter(|_| state.fault().is_none()) else {
                    return Ok(());
                };
                let index = self.enter_states(&brush, header.epoch, header.seq);
                self.note(index, || Accepted::State {
                    header,
                    state: state.clone(),
                });
                if header.flags.has(Flags::REPLAY.with(Flags::LAST))
                    && let Some(take) = self.announced.get_mut(&brush)
                {
                    take.ended = true;
                }
                // A state that was refused then is refused now.
                self.paint(&brush, &header, &state).ok();
                Ok(())
            }
            Accepted::Entry(Entry::Command {
                client,
                number,
                command,
            }) => {
                match &command {
                    Command::Edit(edit) => drop(self.painting.apply(edit.clone())?),
                    Command::Take(TakeCommand::Begin {
                        brush,
                        device,
                        device_epoch,
                        loads,
                        again,
                    }) => self.begin_take(brush, [*device, *device_epoch], loads, *again)?,
                    _ => return Ok(()),
                }
                self.enter_command(client, number, command);
                Ok(())
            }
            Accepted::Entry(Entry::Tick { .. }) => {
                self.enter_tick();
                Ok(())
            }
            Accepted::Entry(Entry::Brush { brush, toml }) => {
                if let Ok(file) = maulstick_brush::BrushFile::parse(&toml) {
                    self.define_brush(&brush, file)?;
                }
                Ok(())
            }
            Accepted::Entry(Entry::Decision { what }) => {
                if what == Decision::Resumed {
                    self.resume();
                }
                Ok(())
            }
            // The states that it names are not among the records.
            Accepted::Entry(Entry::Cut { .. } | Entry::States { .. }) => Ok(()),
        }
    }

    /// Live hands paint again; their brushes restart.
    pub fn end_repeating(&mut self) {
        if std::mem::take(&mut self.repeats) {
            self.resume();
        }
    }
}
