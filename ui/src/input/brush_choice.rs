//! The brush in the hand and its width, changed by rack, keys, panel and presets.

mod presets;

use std::ops::RangeInclusive;
use std::path::Path;

use maulstick_brush::{BrushError, BrushFile};
use maulstick_painting::edits::common;
use maulstick_rig::UserError;
use maulstick_rig::files::ending;
use maulstick_types::Mixture;
use maulstick_types::command::{BrushCommand, Command};
use maulstick_types::scene::{BrushHandling, Tuning};
use maulstick_types::values::{BrushName, BrushToml};

use maulstick_brush::file::quantities::HeadWidth;
use maulstick_client::dispatcher::Outcome;
use maulstick_client::request::Request;
use maulstick_types::values::Quantity;

use crate::rig::state::{BrushContact, RigBrush};
use crate::settings::brush_library::{called, is_of_library, library, of_library};
use crate::settings::brush_load::{BrushLoad, written};
use crate::widgets::context::PanelContext;

/// A painter's step from one width to the next: this factor, but at least half a millimetre.
const STEP: f64 = 0.15;
/// Widths are whole numbers of these, mm.
const GRAIN_MM: f64 = 0.5;

/// A brush at another width, mm; a library brush is scaled from its own numbers, so that they do not drift.
///
/// # Errors
/// As [`BrushFile::scaled_to`].
pub(crate) fn resized(file: &BrushFile, width_mm: f64) -> Result<BrushFile, BrushError> {
    match of_library(&file.kind).filter(|_| is_of_library(file)) {
        Some(own) => own.scaled_to(width_mm),
        None => file.scaled_to(width_mm),
    }
}

/// Possible widths of a brush, mm: from its file's smallest to its largest size, where all scaled values stay in range.
#[must_use]
pub(crate) fn widths_mm(file: &BrushFile) -> RangeInclusive<f64> {
    let now = file.head.width_mm;
    let can = |width_mm: f64| file.scaled_to(width_mm).is_ok();
    // As far as possible toward an end, to a hundredth of the distance.
    let farthest = |end: f64| {
        if can(end) {
            return end;
        }
        let (mut good, mut bad) = (now, end);
        for _ in 0..7 {
            let middle = (good * bad).sqrt();
            if can(middle) {
                good = middle
            } else {
                bad = middle
            }
        }
        good
    };
    let sizes = file.sizes_mm.iter().copied();
    let [least, most] = if file.sizes_mm.is_empty() {
        [*HeadWidth::USUAL.start(), *HeadWidth::USUAL.end()]
    } else {
        [sizes.clone().fold(now, f64::min), sizes.fold(now, f64::max)]
    };
    farthest(least.min(now))..=farthest(most.max(now))
}

/// The next width up or down, mm.
#[must_use]
pub(crate) fn next_width_mm(now_mm: f64, up: bool) -> f64 {
    let factor = if up { 1.0 + STEP } else { 1.0 - STEP };
    let wanted = (now_mm * factor / GRAIN_MM).round() * GRAIN_MM;
    if up {
        wanted.max(((now_mm + 1e-9) / GRAIN_MM).floor() * GRAIN_MM + GRAIN_MM)
    } else {
        wanted
            .min(((now_mm - 1e-9) / GRAIN_MM).ceil() * GRAIN_MM - GRAIN_MM)
            .max(GRAIN_MM)
    }
}

/// Reads a brush file of the painter's own: TOML, or a model of it, .glb or .gltf.
///
/// # Errors
/// A [`UserError`] where it cannot be read or is no brush.
pub(crate) fn read(path: &Path) -> Result<BrushFile, UserError> {
    let bytes = std::fs::read(path).map_err(|error| UserError::reading(path, &error))?;
    let read = if matches!(&*ending(path), "glb" | "gltf") {
        maulstick_brush::gltf::read(&bytes).map_err(|error| error.to_string())
    } else {
        std::str::from_utf8(&bytes)
            .map_err(|_| tr!("this is no text").to_owned())
            .and_then(|text| BrushFile::parse(text).map_err(|error| error.to_string()))
    };
    read.map_err(|what| {
        UserError::failure(what)
            .at(path.display().to_string())
            .help(tr!("docs/brushes.md says what a brush file holds"))
    })
}

impl RigBrush {
    /// Its brush file, or the requested one.
    #[must_use]
    pub(crate) fn wanted(&self) -> Option<&BrushFile> {
        let known = self.file.as_ref().map(|(file, _)| file);
        self.asked.as_ref().or(known)
    }
}

impl PanelContext<'_> {
    /// Brush file of the brush in the hand, or the one it is about to get; `None` until its node has sent it.
    #[must_use]
    pub(crate) fn in_hand(&self) -> Option<&BrushFile> {
        self.rig.brush()?.wanted()
    }

    /// True if the brush may be changed now. While it is on a surface it may not, which is notified once.
    pub(crate) fn may_change_brush(&mut self) -> bool {
        let is_lifted = self.rig.contact == BrushContact::Lifted;
        if !is_lifted {
            self.tell_refusal();
        }
        is_lifted
    }

    /// True if a request is refused, with one notification: it would change the brush while it is on a surface.
    pub(crate) fn refuses(&mut self, request: &Request) -> bool {
        if self.rig.contact == BrushContact::Lifted || !request.changes_brush() {
            return false;
        }
        let result = Err(UserError::failure(self.tell_refusal()).into());
        let request = request.clone();
        self.brush_answered(&Outcome { request, result });
        true
    }

    /// Notifies that the brush is not changed while it paints, replacing the last such sentence; returns the sentence.
    fn tell_refusal(&mut self) -> &'static str {
        let words = tr!("The brush is painting: lift it, and ask again.");
        self.notifications.value("painting", words);
        words
    }

    /// Requests another brush for the hand; the present one is not requested again.
    pub(crate) fn take_up(&mut self, file: BrushFile) {
        if self.in_hand() == Some(&file) || !self.may_change_brush() {
            return;
        }
        let toml = match file.check().and_then(|()| file.to_toml()) {
            Ok(toml) => toml,
            Err(error) => {
                let help = tr!("choose another width, or another brush");
                return self.notifications.fault(error.to_string(), help);
            }
        };
        let brush = BrushName::new(self.rig.brush_name());
        let define = brush.and_then(|brush| {
            let toml = BrushToml::new(toml)?;
            Ok(BrushCommand::Define { brush, toml })
        });
        let define = match define {
            Ok(define) => define,
            Err(error) => {
                let help = tr!("make its skin of fewer faces");
                return self.notifications.fault(error.to_string(), help);
            }
        };
        let width_mm = file.head.width_mm;
        self.preferences
            .brushes
            .widths_mm
            .insert(file.kind.clone(), width_mm);
        let in_hand = self.rig.in_hand;
        if let Some(own) = self.rig.brushes.get_mut(in_hand) {
            own.asked = Some(file);
        }
        self.requests.send(define);
    }

    /// Writes what the brush in the hand was loaded with into the field of its paint, wherever that was asked for.
    fn loaded(
        &mut self,
        command: &Command,
        brush: &str,
        (mixture, beside): (&Mixture, Option<&Mixture>),
    ) {
        let name = self.rig.brush_name();
        let loading = &mut self.preferences.brushes.loading;
        let known = loading.command(name, &self.rig.library);
        if brush == name && known.ok().as_ref() != Some(command) {
            *loading = BrushLoad {
                paint: written(mixture),
                beside: beside.map(written),
                thinner: 0.0,
            };
        }
    }

    /// Handles the outcome of a request: a brush that refused keeps its file; one with the requested file runs the
    /// command that waited for it.
    pub(crate) fn brush_answered(&mut self, outcome: &Outcome) {
        if let Request::Command { command, .. } = &outcome.request
            && let Command::Edit(edit) = command
            && outcome.result.is_ok()
            && let Some((brush, mixture, beside)) = common::loaded(edit)
        {
            return self.loaded(command, &brush, (&mixture, beside.as_ref()));
        }
        let Request::Command {
            command: Command::Brush(BrushCommand::Define { brush, toml }),
            ..
        } = &outcome.request
        else {
            return;
        };
        let mut brushes = self.rig.brushes.iter_mut();
        let Some(own) = brushes.find(|own| *brush == *own.name) else {
            return;
        };
        let newest = own.asked.as_ref().map(BrushFile::to_toml);
        if newest.is_some_and(|newest| newest.ok().as_deref() != Some(toml.as_str())) {
            return;
        }
        match (&outcome.result, own.then.take()) {
            (Ok(_), Some((command, asked_ns))) => self.requests.follow_up(command, asked_ns),
            (Ok(_), None) => {}
            (Err(_), _) => own.asked = None,
        }
    }

    /// Resets the limit of a brush's film, the thinner of its next load, and a preset's pressure and tuning.
    fn lay_full_paint(&mut self) {
        let handling = self.rig.handling();
        let is_limited = handling.most_m > 0.0;
        let brush = self.rig.brush_name().to_owned();
        let before = self
            .preferences
            .brushes
            .before_preset
            .take_if(|before| before.brush == brush);
        if !is_limited && self.preferences.brushes.loading.thinner == 0.0 && before.is_none() {
            return;
        }
        self.preferences.brushes.loading.thinner = 0.0;
        let words = match before {
            Some(_) => {
                tr!(
                    "This brush lays full paint: no limit, no thinner, pressed as before the preset."
                )
            }
            None => tr!("This brush lays full paint: no limit, no thinner."),
        };
        if let Some(before) = before {
            self.preferences.brushes.mouse.pressure = before.pressure;
            self.preferences.brushes.mouse = self.preferences.brushes.mouse.sane();
            let tuning = Tuning {
                brush,
                stiffness: before.stiffness,
                wetness: before.wetness,
            };
            if let Ok(tune) = common::tune(&tuning) {
                self.requests.send(tune);
            }
        }
        let unlimited = BrushHandling {
            most_m: 0.0,
            ..handling
        };
        if let (true, Ok(handle)) = (is_limited, common::handle(&unlimited)) {
            self.requests.send(handle);
        }
        self.notifications.note(words);
    }

    /// Sends a command to the paint node once the brush in the hand has its requested file.
    pub(crate) fn then(&mut self, command: Command) {
        if !self.may_change_brush() {
            return;
        }
        let (in_hand, now_ns) = (self.rig.in_hand, self.rig.live.now_ns);
        match self.rig.brushes.get_mut(in_hand) {
            Some(own) if own.asked.is_some() => own.then = Some((command, now_ns)),
            _ => self.requests.send(command),
        }
    }

    /// Takes a brush at its last width, or at its own. Settings of a preset end with its brush: another brush deposits
    /// full paint.
    pub(crate) fn choose(&mut self, file: &BrushFile) {
        if !self.may_change_brush() {
            return;
        }
        self.lay_full_paint();
        let width_mm = self.preferences.brushes.widths_mm.get(&file.kind);
        let scaled = width_mm.and_then(|width_mm| file.scaled_to(*width_mm).ok());
        self.take_up(scaled.unwrap_or_else(|| file.clone()));
    }

    /// Sets the width of the brush in hand, mm, within its range.
    pub(crate) fn widen(&mut self, width_mm: f64) {
        let Some(file) = self.in_hand() else {
            return;
        };
        let range = widths_mm(file);
        let within = width_mm.clamp(*range.start(), *range.end());
        if let Ok(file) = resized(file, within) {
            self.take_up(file);
        }
    }

    /// The next wider brush of its kind, or the next narrower one.
    pub(crate) fn step_width(&mut self, up: bool) {
        if !self.may_change_brush() {
            return;
        }
        let Some(file) = self.in_hand() else {
            return;
        };
        let (now_mm, range) = (file.head.width_mm, widths_mm(file));
        let units = self.preferences.window.units;
        let next_mm = next_width_mm(now_mm, up);
        let file = if range.contains(&next_mm) {
            resized(file, next_mm).ok()
        } else {
            None
        };
        match file {
            Some(file) => {
                let words = format!("{} {}", called(&file.kind), units.width(next_mm));
                self.notifications.value("width", words);
                self.take_up(file);
            }
            None => {
                let kind = called(&file_kind(self));
                let width = units.width(now_mm);
                let words = if up {
                    tr!("{kind} {width} is the widest", kind, width)
                } else {
                    tr!("{kind} {width} is the narrowest", kind, width)
                };
                self.notifications.value("width", words);
            }
        }
    }

    /// The brush after the one in the hand, of the library.
    pub(crate) fn next_brush(&mut self) {
        let now = file_kind(self);
        let place = library().iter().position(|file| file.kind == now);
        let next = place.map_or(0, |place| (place + 1) % library().len());
        if let Some(file) = library().get(next) {
            self.choose(file);
        }
    }
}

fn file_kind(work: &PanelContext<'_>) -> String {
    work.in_hand()
        .map_or(String::new(), |file| file.kind.clone())
}

#[cfg(test)]
mod tests;
