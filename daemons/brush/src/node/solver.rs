//! Samples that wait, solved into states of the brush.

mod haste;
mod pace;

use std::collections::BTreeSet;

use glam::DVec3;
use maulstick_brush::desk::aim;
use maulstick_brush::{BrushFile, BrushModel};
use maulstick_bus::typed::Received;
use maulstick_types::Origin;
use maulstick_types::brush::{BrushState, Solve};
use maulstick_types::scene::Scene;
use maulstick_types::stylus::{StylusPose, StylusSample};

use haste::Haste;
use pace::Pace;

use super::settings::BrushSettings;
use crate::path_simplifier::{PathSimplifier, Place, Start, Waiting};

/// Solves of a turn at most, but for those of its last sample: the node reads what arrives meanwhile.
const SOLVES_A_TURN: usize = 256;

/// A state, and the devices whose samples are in it.
pub(super) struct Solved {
    pub(super) devices: BTreeSet<Origin>,
    pub(super) state: BrushState,
}

/// The head of the brush, and the samples that it has not followed yet.
pub(super) struct Solver {
    brush: String,
    model: BrushModel,
    backlog: PathSimplifier,
    /// Solves left in this turn.
    solves_left: usize,
    pace: Pace,
    haste: Haste,
    /// True while the brush touches at its newest solve.
    is_touching: bool,
    /// True while a stroke waits for what was asked for before it.
    is_holding: bool,
}

impl Solver {
    /// A solver for a brush at the start of its node.
    pub(super) fn new(settings: &BrushSettings) -> Self {
        Self {
            brush: settings.name.clone(),
            model: BrushModel::new(settings.file.clone(), settings.depth_share),
            backlog: PathSimplifier::new(settings.file.length_m()),
            solves_left: SOLVES_A_TURN,
            pace: Pace::default(),
            haste: Haste::default(),
            is_touching: false,
            is_holding: false,
        }
    }

    /// Begins a turn with its full number of solves.
    pub(super) fn begin_turn(&mut self) {
        self.solves_left = SOLVES_A_TURN;
    }

    /// True once this turn has no solve left.
    pub(super) fn is_exhausted(&self) -> bool {
        self.solves_left == 0
    }

    /// The head.
    pub(super) fn model(&self) -> &BrushModel {
        &self.model
    }

    /// The head, for a force law that presses it.
    pub(super) fn model_mut(&mut self) -> &mut BrushModel {
        &mut self.model
    }

    /// Samples that wait.
    pub(super) fn backlog(&self) -> &PathSimplifier {
        &self.backlog
    }

    /// Time of the sample that waits for longest, ns.
    pub(super) fn oldest_ns(&self) -> Option<u64> {
        self.backlog.first().map(|first| first.event_ns)
    }

    /// True while the brush touches at its newest solve.
    pub(super) fn is_touching(&self) -> bool {
        self.is_touching
    }

    /// True while the hand has the brush on a surface: its newest sample says so.
    pub(super) fn is_down(&self) -> bool {
        match self.backlog.last() {
            Some(newest) if newest.place == Place::Air => false,
            _ => self.is_touching,
        }
    }

    /// Lifts the brush of a device that is gone.
    pub(super) fn lift(&mut self) {
        self.is_touching = false;
    }

    /// Follows another scene: its desk, and how stiff and wet the brush is.
    pub(super) fn set_scene(&mut self, scene: &Scene) {
        self.model.set_scene(scene);
        self.model.tune(scene.tuning(&self.brush));
        self.model.soak(scene.wetness(&self.brush));
        self.model.take_set(scene.set(&self.brush));
    }

    /// Changes to another brush; what waits stays.
    pub(super) fn adopt(&mut self, file: BrushFile) {
        self.backlog.set_head_length(file.length_m());
        self.model.take_up(file);
    }

    /// Samples that were faster than a hand.
    pub(super) fn too_fast(&self) -> u64 {
        self.model.too_fast() + self.backlog.superseded()
    }

    /// Queues a live sample.
    pub(super) fn queue(
        &mut self,
        (origin, seq): (Origin, u64),
        event_ns: u64,
        sample: StylusSample,
        now_ns: u64,
    ) {
        let place = self.place(&sample);
        self.pace.note(now_ns, place);
        let waiting = Waiting {
            origin,
            seq,
            event_ns,
            sample,
            place,
        };
        if !self.backlog.push(waiting) {
            self.warn_of_haste();
        }
    }

    /// Placement of the brush by a sample: a pen without pressure hovers, a head that is higher than it is long does
    /// not reach.
    fn place(&self, sample: &StylusSample) -> Place {
        let is_clear = match &sample.pose {
            _ if !sample.in_range => true,
            StylusPose::Contact { pressure, .. } => *pressure == 0.0,
            StylusPose::Ferrule { pose } => {
                let length_m = self.model.file().length_m();
                let desk = self.model.desk();
                let plane = desk.and_then(|desk| desk.under(aim(sample, length_m)));
                plane.is_some_and(|plane| {
                    let above =
                        DVec3::from_array(pose.position_m) - plane.to_desk.point(DVec3::ZERO);
                    above.dot(plane.normal()) > 1.5 * length_m
                })
            }
        };
        if is_clear { Place::Air } else { Place::Surface }
    }

    /// Solves what waits, as one state, as far as this turn allows, but for a stroke that begins after `since_ns`:
    /// something that was asked for then is not done yet.
    pub(super) fn solve(&mut self, now_ns: u64, since_ns: Option<u64>) -> Option<Solved> {
        let (mut solves, mut newest) = (Vec::new(), None);
        let mut devices = BTreeSet::new();
        while self.solves_left > 0
            && let Some(next) = self.backlog.first()
        {
            let begins = next.place == Place::Surface && !self.is_touching;
            if begins && since_ns.is_some_and(|since_ns| next.event_ns > since_ns) {
                self.is_holding = true;
                break;
            }
            if std::mem::take(&mut self.is_holding) {
                // It was not the paint that was late.
                self.pace.forget_wait();
            }
            let Some((start, waiting)) = self.backlog.pop() else {
                break;
            };
            devices.insert(waiting.origin);
            newest = Some((waiting.origin, waiting.seq));
            solves.extend(self.follow(start, &waiting));
        }
        let (origin, device_seq) = newest?;
        self.pace.flag(now_ns, &mut solves);
        if self.backlog.is_empty() {
            self.pace.forget_wait();
        }
        self.warn_of_haste();
        if solves.is_empty() {
            return None;
        }
        let state = BrushState {
            device: origin.source,
            device_epoch: origin.epoch,
            device_seq,
            solves,
        };
        Some(Solved { devices, state })
    }

    /// Solves the way to a sample.
    fn follow(&mut self, start: Start, waiting: &Waiting) -> Vec<Solve> {
        let mut solves = match start {
            Start::AfterLoss => self.model.begin_anew(),
            _ => Vec::new(),
        };
        let (origin, event_ns) = (waiting.origin, waiting.event_ns);
        solves.extend(self.model.follow(origin, event_ns, &waiting.sample));
        self.solves_left = self.solves_left.saturating_sub(solves.len().max(1));
        self.note_contact(&solves);
        solves
    }

    /// Drops what a hand left behind, for a take begins. Its mark would be a stroke of the take.
    pub(super) fn begin_take(&mut self) {
        self.backlog.clear();
        drop(self.model.finish());
        self.model.straighten();
        (self.pace, self.is_holding) = (Pace::default(), false);
    }

    /// Follows a sample of a take.
    pub(super) fn replay(&mut self, received: &Received<StylusSample>) -> Option<BrushState> {
        let header = &received.header;
        let (origin, sample) = (header.origin(), &received.message);
        let (seq, event_ns) = (header.seq, header.event_ns);
        let state = self
            .model
            .state_in_take(origin, seq, event_ns, sample, header.flags);
        self.warn_of_haste();
        if let Some(state) = &state {
            self.note_contact(&state.solves);
        }
        state
    }

    fn note_contact(&mut self, solves: &[Solve]) {
        if let Some(newest) = solves.last() {
            self.is_touching = !newest.contacts.is_empty();
        }
    }

    fn warn_of_haste(&mut self) {
        let (too_fast, dropped) = (self.too_fast(), self.backlog.dropped());
        self.haste.warn(&self.brush, too_fast, dropped);
    }
}
