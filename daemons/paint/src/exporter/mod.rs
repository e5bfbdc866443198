//! An export in the background: on a thread of its own, of the painting as it was when it was requested.

use std::fs::File;
use std::io::{BufWriter, Error, ErrorKind, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering::SeqCst};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::thread::JoinHandle;

use maulstick_appearance::picture::{Depth, Export};
use maulstick_exchange::{ExchangeError, Format, Order};
use maulstick_files::{Kind, write_whole};
use maulstick_optics::colour::RgbSpace;
use maulstick_optics::gamut::GamutMapping;
use maulstick_optics::icc::Profile;
use maulstick_painting::Painting;
use maulstick_types::command::advice::Advice;
use maulstick_types::command::{ExportOrder, Outcome};
use maulstick_types::paint::ExportStatus;

use crate::refusal::Refusal;

/// The client that requested it, and the number of its command.
pub type Asker = (u64, u64);

/// Exports, one at a time.
#[derive(Debug, Default)]
pub struct Exporter(Option<Running>);

#[derive(Debug)]
struct Running {
    asker: Asker,
    path: String,
    began_ns: u64,
    share: Arc<AtomicU32>,
    stop: Arc<AtomicBool>,
    outcome: Receiver<Outcome>,
    thread: Option<JoinHandle<()>>,
}

impl Exporter {
    /// Begins an export of a painting that is not changed any more; `usual` holds the defaults for everything that the
    /// request leaves open.
    ///
    /// # Errors
    /// [`Refusal`] for an unknown format, profile or gamut, and while another export runs.
    pub fn begin(
        &mut self,
        asker: Asker,
        asked: &ExportOrder,
        mut painting: Painting,
        usual: &Export,
        now_ns: u64,
    ) -> Result<(), Refusal> {
        if let Some(running) = &self.0 {
            return Err(Refusal::new(
                format!("{} is being exported", running.path),
                Advice::StopExport,
            ));
        }
        let order = order(asked, usual)?;
        let path = PathBuf::from(asked.path.as_str());
        let (share, stop) = <(Arc<AtomicU32>, Arc<AtomicBool>)>::default();
        let (to_node, outcome) = channel();
        let (shown, stopped) = (Arc::clone(&share), Arc::clone(&stop));
        let thread = std::thread::Builder::new()
            .name("export".into())
            .spawn(move || {
                let done = write(&order, &mut painting, &path, &shown, &stopped);
                to_node.send(done).ok();
            })
            .map_err(|error| {
                Refusal::say(format!("nothing can be exported: {error}"), "try again")
            })?;
        self.0 = Some(Running {
            asker,
            path: asked.path.to_string(),
            began_ns: now_ns,
            share,
            stop,
            outcome,
            thread: Some(thread),
        });
        Ok(())
    }

    /// Has the export that goes on end without a file.
    ///
    /// # Errors
    /// [`Refusal`] where none goes on.
    pub fn stop(&mut self) -> Result<(), Refusal> {
        match &self.0 {
            Some(running) => {
                running.stop.store(true, SeqCst);
                Ok(())
            }
            None => Err(Refusal::new(
                "nothing is being exported",
                Advice::BeginExport,
            )),
        }
    }

    /// The export that has ended since the last call, and what became of it.
    pub fn ended(&mut self) -> Option<(Asker, Outcome)> {
        let running = self.0.as_ref()?;
        let outcome = match running.outcome.try_recv() {
            Ok(outcome) => outcome,
            Err(TryRecvError::Empty) => return None,
            Err(TryRecvError::Disconnected) => Outcome::refused(
                format!("internal error: the export of {} panicked", running.path),
                "see the messages of the rig, and report the fault",
            ),
        };
        let asker = running.asker;
        self.0 = None;
        Some((asker, outcome))
    }

    /// Progress of the export.
    #[must_use]
    pub fn status(&self, now_ns: u64) -> Option<ExportStatus> {
        self.0.as_ref().map(|running| ExportStatus {
            path: running.path.clone(),
            share: f32::from_bits(running.share.load(SeqCst)),
            since_ns: now_ns.saturating_sub(running.began_ns),
        })
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        self.stop.store(true, SeqCst);
        // A file that has not got its name yet goes with its thread.
        if let Some(thread) = self.thread.take() {
            thread.join().ok();
        }
    }
}

/// The kind of file that a format is.
#[must_use]
pub fn kind_of(format: Format) -> Kind {
    match format {
        Format::Png | Format::Height | Format::Gloss => Kind::Png,
        Format::Exr => Kind::Exr,
        Format::Ora => Kind::Ora,
        Format::Stl => Kind::Stl,
        Format::Glb => Kind::Glb,
    }
}

pub(crate) fn unwritable(path: &Path, error: &Error) -> Refusal {
    let help = match error.kind() {
        ErrorKind::AlreadyExists | ErrorKind::InvalidInput | ErrorKind::ResourceBusy => {
            "give another name"
        }
        _ => "check that the folder exists and can be written to",
    };
    Refusal::say(format!("cannot write {}: {error}", path.display()), help)
}

/// The requested export, with defaults for everything left open.
fn order(asked: &ExportOrder, usual: &Export) -> Result<Order, Refusal> {
    let path = Path::new(asked.path.as_str());
    let format = match asked.format.as_str() {
        "" => Format::of(path),
        name => Format::named(name),
    };
    let format = format.ok_or_else(|| {
        let name = match asked.format.as_str() {
            "" => path.extension().unwrap_or_default().to_string_lossy(),
            name => name.into(),
        };
        Refusal::say(
            format!("nothing is exported as '{name}'"),
            "end the name in .png, .exr, .ora, .stl or .glb, or say which format: png, exr, ora, height, gloss, stl, glb",
        )
    })?;
    let profile = match asked.profile.as_str() {
        "" => Arc::clone(&usual.profile),
        "srgb" => Arc::new(Profile::of(RgbSpace::Srgb)),
        "display-p3" => Arc::new(Profile::of(RgbSpace::DisplayP3)),
        name => {
            return Err(Refusal::say(
                format!("there is no profile called '{name}' here"),
                "choose srgb or display-p3, or leave it to [view] of rig.toml",
            ));
        }
    };
    let gamut = match asked.gamut.as_str() {
        "" => usual.gamut,
        "soft" => GamutMapping::Soft,
        "clamp" => GamutMapping::Clamp,
        name => {
            return Err(Refusal::say(
                format!("colours come into no gamut by '{name}'"),
                "choose soft or clamp",
            ));
        }
    };
    Ok(Order {
        format,
        surface: asked.surface,
        depth: match asked.bits {
            16 => Depth::Sixteen,
            _ => Depth::Eight,
        },
        export: Export { profile, gamut },
        base_mm: asked.base_m * 1e3,
        exaggeration: asked.exaggeration,
        step: (asked.step > 0).then_some(asked.step),
    })
}

/// A file until it is time to stop.
struct Stoppable<'a> {
    file: &'a mut BufWriter<File>,
    stop: &'a AtomicBool,
}

impl Stoppable<'_> {
    fn check(&self) -> Result<(), Error> {
        match self.stop.load(SeqCst) {
            // `Interrupted` would have it tried again.
            true => Err(Error::other("stopped")),
            false => Ok(()),
        }
    }
}

impl Write for Stoppable<'_> {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, Error> {
        self.check()?;
        self.file.write(bytes)
    }

    fn flush(&mut self) -> Result<(), Error> {
        self.check()?;
        self.file.flush()
    }
}

impl Seek for Stoppable<'_> {
    fn seek(&mut self, to: SeekFrom) -> Result<u64, Error> {
        self.check()?;
        self.file.seek(to)
    }
}

/// Writes the file, whole or not at all, and says what became of it.
fn write(
    order: &Order,
    painting: &mut Painting,
    path: &Path,
    share: &AtomicU32,
    stop: &AtomicBool,
) -> Outcome {
    let mut tell = |done: u64, all: u64| {
        let shown = done as f32 / all.max(1) as f32;
        share.store(shown.to_bits(), SeqCst);
    };
    let mut made = Ok(String::new());
    let written = write_whole(path, kind_of(order.format), |file| {
        made = order.write(painting, &mut Stoppable { file, stop }, &mut tell);
        match &made {
            Ok(_) if !stop.load(SeqCst) => Ok(()),
            _ => Err(Error::other("not written")),
        }
    });
    let name = path.display();
    match (written, made) {
        (Ok(()), Ok(said)) => Outcome::done(if said.is_empty() {
            name.to_string()
        } else {
            format!("{name}: {said}")
        }),
        _ if stop.load(SeqCst) => Outcome::refused(
            format!("the export of {name} was stopped"),
            "nothing was written; export again when you like",
        ),
        (_, Err(ExchangeError::Write(error))) | (Err(error), Ok(_)) => {
            unwritable(path, &error).into()
        }
        (_, Err(error)) => Refusal::new(
            format!("{name} cannot be made: {error}"),
            Advice::ListFormats,
        )
        .into(),
    }
}

#[cfg(test)]
mod tests;
