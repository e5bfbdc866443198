//! The brush's file: announced to the rig, and replaced by a requested one between two strokes.

use maulstick_brush::BrushFile;
use maulstick_bus::{Announcer, Bus, BusError, Wake};
use maulstick_types::brush::BrushDef;
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Origin, name_hash};

/// Time between two announcements of a file that the painting has not confirmed, ns.
const REPEAT_NS: u64 = 100_000_000;
/// Time after which a file that is not confirmed holds up no stroke, ns.
const GIVE_UP_NS: u64 = 500_000_000;

/// Client and number of a command.
type Asker = (u64, u64);

/// A brush that a command asked for.
#[derive(Debug)]
struct Requested {
    asker: Asker,
    file: BrushFile,
    /// Rig clock, ns: strokes that begin later are painted with it.
    since_ns: u64,
}

/// A file that is announced and not yet confirmed; the painting paints what comes before it with the one before.
#[derive(Debug)]
struct Unconfirmed {
    /// Its FNV-1a.
    hash: u32,
    file: BrushFile,
    /// As [`Requested::since_ns`].
    since_ns: u64,
    first_ns: u64,
    last_ns: u64,
}

impl Unconfirmed {
    fn is_given_up(&self, now_ns: u64) -> bool {
        now_ns >= self.first_ns.saturating_add(GIVE_UP_NS)
    }
}

/// Definition of the brush, and the change to another one.
pub(super) struct Definition {
    brush: String,
    announcer: Announcer<BrushDef>,
    requested: Option<Requested>,
    unconfirmed: Option<Unconfirmed>,
}

impl Definition {
    /// Announces the brush of this name with its first file.
    ///
    /// # Errors
    /// [`BusError`].
    pub(super) fn new(
        bus: &dyn Bus,
        topics: &Topics,
        me: Origin,
        wake: &Wake,
        (brush, file): (&str, &BrushFile),
    ) -> Result<Self, BusError> {
        let mut definition = Self {
            brush: brush.to_owned(),
            announcer: Announcer::new(bus, &topics.brush_def(brush), me, wake)?,
            requested: None,
            unconfirmed: None,
        };
        definition.announce(bus.now_ns(), file)?;
        Ok(definition)
    }

    /// Name of the brush.
    pub(super) fn brush(&self) -> &str {
        &self.brush
    }

    /// Announces a file; returns its FNV-1a.
    fn announce(&mut self, now_ns: u64, file: &BrushFile) -> Result<u32, BusError> {
        let toml = file.to_toml().map_err(|error| BusError::Topic {
            topic: self.brush.clone(),
            reason: error.to_string(),
        })?;
        let hash = name_hash(&toml);
        let message = BrushDef {
            brush: self.brush.clone(),
            toml,
            hash,
            head_length_m: file.length_m(),
        };
        self.announcer.send(now_ns, &message)?;
        Ok(hash)
    }

    /// Repeats the announcement for late subscribers.
    pub(super) fn serve(&mut self, now_ns: u64) -> Result<(), BusError> {
        self.announcer.poll(now_ns)
    }

    /// True while the brush of this very command waits to be adopted.
    pub(super) fn is_waiting(&self, asker: Asker) -> bool {
        let requested = self.requested.as_ref();
        requested.is_some_and(|requested| requested.asker == asker)
    }

    /// Requests another file. Of two between the same strokes the later one is adopted: returns who asked for the
    /// earlier.
    pub(super) fn request(
        &mut self,
        asker: Asker,
        file: BrushFile,
        since_ns: u64,
    ) -> Option<Asker> {
        let requested = Requested {
            asker,
            file,
            since_ns,
        };
        let earlier = self.requested.replace(requested);
        earlier.map(|earlier| earlier.asker)
    }

    /// Counts a stroke that is held since `held_ns` as one after the request, whenever that came.
    pub(super) fn hold_from(&mut self, held_ns: Option<u64>) {
        if let (Some(requested), Some(held_ns)) = (&mut self.requested, held_ns) {
            requested.since_ns = requested.since_ns.min(held_ns);
        }
    }

    /// Takes the requested file and announces it, unless the oldest waiting sample comes before the request.
    pub(super) fn adopt(
        &mut self,
        oldest_ns: Option<u64>,
        now_ns: u64,
    ) -> Result<Option<(Asker, BrushFile)>, BusError> {
        let is_due = |requested: &mut Requested| oldest_ns.is_none_or(|ns| ns > requested.since_ns);
        let Some(requested) = self.requested.take_if(is_due) else {
            return Ok(None);
        };
        let hash = self.announce(now_ns, &requested.file)?;
        self.unconfirmed = Some(Unconfirmed {
            hash,
            file: requested.file.clone(),
            since_ns: requested.since_ns,
            first_ns: now_ns,
            last_ns: now_ns,
        });
        Ok(Some((requested.asker, requested.file)))
    }

    /// The painting has the file with this FNV-1a.
    pub(super) fn on_confirmed(&mut self, hash: u32) {
        self.unconfirmed.take_if(|file| file.hash == hash);
    }

    /// Announces a file again that the painting may have missed, and gives up one that nobody confirms.
    pub(super) fn repeat(&mut self, now_ns: u64) -> Result<(), BusError> {
        self.unconfirmed.take_if(|file| file.is_given_up(now_ns));
        if let Some(mut unconfirmed) = self.unconfirmed.take() {
            if now_ns >= unconfirmed.last_ns.saturating_add(REPEAT_NS) {
                unconfirmed.last_ns = now_ns;
                self.announce(now_ns, &unconfirmed.file)?;
            }
            self.unconfirmed = Some(unconfirmed);
        }
        Ok(())
    }

    /// Time after which no stroke begins until the requested brush is in use, ns; absent if none is.
    pub(super) fn since_ns(&self, now_ns: u64) -> Option<u64> {
        let requested = self.requested.as_ref();
        let requested = requested.map(|requested| requested.since_ns);
        let unconfirmed = self.unconfirmed.as_ref();
        let unconfirmed = unconfirmed.filter(|file| !file.is_given_up(now_ns));
        requested
            .into_iter()
            .chain(unconfirmed.map(|file| file.since_ns))
            .min()
    }
}
