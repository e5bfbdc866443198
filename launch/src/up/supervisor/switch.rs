//! Another painting in a running rig, as a state machine: the request is checked, the paint node saves the painting and
//! ends, and starts with the other one. If that fails, the previous one is opened again. It takes events and returns
//! actions; it signals no process and writes no file itself.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use maulstick_rig::{RigConfig, UserError};
use maulstick_types::Mixture;
use maulstick_types::command::Outcome;

use super::orders::{refusal, starts_again};
use crate::up::plan::Role;
use crate::up::processes::Ended;

/// The paint node closes its document within this time.
pub(super) const CLOSE_TIME: Duration = Duration::from_secs(60);

/// Client and number of a request.
pub(super) type Asker = (u64, u64);

/// A rig with another painting.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Plan {
    pub(super) config: RigConfig,
    /// Load of the brushes, if the painting is new.
    pub(super) load: Option<Mixture>,
}

impl Plan {
    /// Name of the painting.
    fn name(&self) -> String {
        match &self.config.paint.document {
            Some(path) => path.display().to_string(),
            None => "a new painting, which is not kept".to_owned(),
        }
    }
}

/// An event for a switch.
#[derive(Debug)]
pub(super) enum SwitchEvent {
    /// The other painting was checked.
    Checked(Result<Box<Plan>, UserError>),
    /// The painting was put in another file, or not.
    Saved(Result<(), UserError>),
    /// Work beside the supervisor panicked.
    Fallen,
    /// The paint node runs, with its painting.
    PaintRuns,
    /// The paint node that was to leave does not run.
    PaintAway,
    /// The paint node ended, on request or while it opened the other painting.
    PaintLeft(Ended),
    /// The paint node ended unexpectedly, or is about to be replaced.
    PaintGone,
    /// The settings could not be written.
    NotWritten(UserError),
    /// Time passes; the paint node opens its painting within this time.
    Time(Duration),
}

/// Action of a switch.
#[derive(Debug, PartialEq)]
pub(super) enum SwitchAction {
    /// Ask the paint node to end, to be started afresh.
    RenewPaint,
    /// Kill the paint node.
    KillPaint,
    /// Use settings with the other painting.
    Use(Box<RigConfig>),
    /// Use those before again.
    PutBack(Box<RigConfig>),
    /// Start the paint node; a painting in memory is lost, and its brushes are loaded again.
    StartPaint,
    /// The painting of a file is left.
    Leave(PathBuf),
    /// Load the brushes of a new painting.
    Load(Mixture),
    /// Start the devices afresh: they are fitted to the canvas.
    RenewDevices,
    /// The painting is in this file.
    SavedAs(PathBuf),
    Reply(Asker, Outcome),
}

/// A switch to another painting, or another file.
#[derive(Debug, Default)]
pub(super) struct Switch {
    asker: Asker,
    stage: Stage,
}

#[derive(Debug, Default)]
enum Stage {
    #[default]
    Idle,
    /// The painting is checked. The flag allows the painting in memory to be discarded.
    Checking { forget: bool },
    /// The paint node saves the painting, and ends.
    Closing { plan: Box<Plan>, since: Instant },
    /// It starts with the other painting.
    Opening(Opening),
    /// It starts with the previous painting, for this reason.
    Returning(Outcome),
    /// The paint node saves the painting there; the request is given up once the node has ended.
    Saving { to: PathBuf, gone: Arc<AtomicBool> },
}

/// A painting that is being opened.
#[derive(Debug)]
struct Opening {
    plan: Box<Plan>,
    before: Box<RigConfig>,
    since: Instant,
}

impl Switch {
    /// A request is checked.
    pub(super) fn check(&mut self, asker: Asker, forget: bool) {
        (self.asker, self.stage) = (asker, Stage::Checking { forget });
    }

    /// The painting is put in another file; returned is the flag that says that the paint node has ended.
    pub(super) fn save(&mut self, asker: Asker, to: &Path) -> Arc<AtomicBool> {
        let gone = Arc::default();
        let stage = Stage::Saving {
            to: to.to_owned(),
            gone: Arc::clone(&gone),
        };
        (self.asker, self.stage) = (asker, stage);
        gone
    }

    /// True during a request.
    pub(super) fn is_busy(&self) -> bool {
        !matches!(self.stage, Stage::Idle)
    }

    /// Client of the request.
    pub(super) fn asker(&self) -> Asker {
        self.asker
    }

    /// True if the painting in memory may be discarded by the request that is checked; none where none is.
    pub(super) fn forgets(&self) -> Option<bool> {
        match self.stage {
            Stage::Checking { forget } => Some(forget),
            _ => None,
        }
    }

    /// Role whose node starts with another painting.
    pub(super) fn opened(&self) -> Option<Role> {
        matches!(self.stage, Stage::Opening(_)).then_some(Role::Paint)
    }

    /// True while the painting is put in another file.
    pub(super) fn is_saving(&self) -> bool {
        matches!(self.stage, Stage::Saving { .. })
    }

    /// Extends the deadline of the paint node.
    pub(super) fn postpone(&mut self, by: Duration) {
        if let Stage::Closing { since, .. } | Stage::Opening(Opening { since, .. }) =
            &mut self.stage
        {
            *since += by;
        }
    }

    /// Handles an event, in a rig with these settings; returns actions.
    pub(super) fn on(
        &mut self,
        event: SwitchEvent,
        config: &RigConfig,
        now: Instant,
    ) -> Vec<SwitchAction> {
        let asker = self.asker;
        let (stage, actions) = match std::mem::take(&mut self.stage) {
            Stage::Idle => (Stage::Idle, Vec::new()),
            Stage::Checking { forget } => checking(forget, event, asker, now),
            Stage::Closing { plan, since } => closing((plan, since), event, (asker, config), now),
            Stage::Opening(opening) => self::opening(opening, event, (asker, config), now),
            Stage::Returning(why) => returning(why, event, asker),
            Stage::Saving { to, gone } => saving(to, gone, event, asker),
        };
        self.stage = stage;
        actions
    }
}

/// The next stage, and what is to be done.
type Step = (Stage, Vec<SwitchAction>);

/// The end of a switch.
fn end(asker: Asker, outcome: Outcome) -> Step {
    (Stage::Idle, vec![SwitchAction::Reply(asker, outcome)])
}

fn checking(forget: bool, event: SwitchEvent, asker: Asker, now: Instant) -> Step {
    match event {
        SwitchEvent::Checked(Ok(plan)) => {
            let closing = Stage::Closing { plan, since: now };
            (closing, vec![SwitchAction::RenewPaint])
        }
        SwitchEvent::Checked(Err(fault)) => end(asker, refusal(fault)),
        SwitchEvent::Fallen => end(asker, fallen()),
        _ => (Stage::Checking { forget }, Vec::new()),
    }
}

fn closing(
    (plan, since): (Box<Plan>, Instant),
    event: SwitchEvent,
    (asker, config): (Asker, &RigConfig),
    now: Instant,
) -> Step {
    match event {
        SwitchEvent::PaintAway => end(asker, starts_again()),
        SwitchEvent::PaintLeft(ended) => close(plan, ended, config, now),
        SwitchEvent::Time(_) => {
            let is_late = now.saturating_duration_since(since) > CLOSE_TIME;
            let kill = is_late.then_some(SwitchAction::KillPaint);
            (Stage::Closing { plan, since }, Vec::from_iter(kill))
        }
        _ => (Stage::Closing { plan, since }, Vec::new()),
    }
}

fn opening(
    opening: Opening,
    event: SwitchEvent,
    (asker, config): (Asker, &RigConfig),
    now: Instant,
) -> Step {
    match event {
        SwitchEvent::PaintRuns => {
            let actions = opened(*opening.plan, &opening.before, config, asker);
            (Stage::Idle, actions)
        }
        SwitchEvent::PaintLeft(_) => go_back(&opening.plan, opening.before),
        SwitchEvent::NotWritten(fault) => {
            let returning = Stage::Returning(refusal(fault));
            (returning, vec![SwitchAction::StartPaint])
        }
        SwitchEvent::Time(limit) => {
            let is_late = now.saturating_duration_since(opening.since) > limit;
            let kill = is_late.then_some(SwitchAction::KillPaint);
            (Stage::Opening(opening), Vec::from_iter(kill))
        }
        _ => (Stage::Opening(opening), Vec::new()),
    }
}

fn returning(why: Outcome, event: SwitchEvent, asker: Asker) -> Step {
    match event {
        SwitchEvent::PaintRuns => end(asker, why),
        SwitchEvent::NotWritten(_) => (Stage::Returning(unwritten(why)), Vec::new()),
        _ => (Stage::Returning(why), Vec::new()),
    }
}

fn saving(to: PathBuf, gone: Arc<AtomicBool>, event: SwitchEvent, asker: Asker) -> Step {
    match event {
        SwitchEvent::Saved(Ok(())) => (Stage::Idle, saved_as(to, asker)),
        SwitchEvent::Saved(Err(fault)) => {
            let fault = UserError {
                place: None,
                ..fault
            };
            end(asker, refusal(fault))
        }
        SwitchEvent::Fallen => end(asker, fallen()),
        SwitchEvent::PaintGone => {
            gone.store(true, Ordering::SeqCst);
            end(asker, ended_as_it_saved(&to))
        }
        _ => (Stage::Saving { to, gone }, Vec::new()),
    }
}

/// The paint node has ended, on request or badly: opens the other painting, or the previous one.
fn close(plan: Box<Plan>, ended: Ended, config: &RigConfig, now: Instant) -> Step {
    if ended == Ended::Well {
        let actions = vec![SwitchAction::Use(Box::new(plan.config.clone()))];
        let before = Box::new(config.clone());
        let opening = Opening {
            plan,
            before,
            since: now,
        };
        return (Stage::Opening(opening), actions);
    }
    let help = if config.paint.document.is_some() {
        "it is open again with all that its file has"
    } else {
        "it was in memory alone, and another is begun"
    };
    let why = Outcome::refused(
        "the painting could not be closed as it should be",
        format!("{help}; the messages of the rig say what was wrong"),
    );
    (Stage::Returning(why), vec![SwitchAction::StartPaint])
}

fn go_back(plan: &Plan, before: Box<RigConfig>) -> Step {
    let why = Outcome::refused(
        format!("{} could not be opened", plan.name()),
        "the painting before is open again; the messages of the rig say what was wrong",
    );
    let actions = vec![SwitchAction::PutBack(before), SwitchAction::StartPaint];
    (Stage::Returning(why), actions)
}

/// The reason of a return after which the settings could not be written either.
fn unwritten(why: Outcome) -> Outcome {
    match why {
        Outcome::Refused { what, .. } => Outcome::refused(
            what,
            "the settings of the rig could not be written either: free some space, end it and start it \
             again with the painting before",
        ),
        other => other,
    }
}

/// The other painting is open.
fn opened(plan: Plan, before: &RigConfig, config: &RigConfig, asker: Asker) -> Vec<SwitchAction> {
    let name = plan.name();
    tracing::info!("painting in {name}");
    let mut actions = Vec::new();
    let former = before.paint.document.clone();
    actions.extend(former.map(SwitchAction::Leave));
    actions.extend(plan.load.map(SwitchAction::Load));
    let size = |config: &RigConfig| [config.canvas.width_mm, config.canvas.height_mm];
    if size(before) != size(config) {
        actions.push(SwitchAction::RenewDevices);
    }
    actions.push(SwitchAction::Reply(asker, Outcome::done(name)));
    actions
}

fn saved_as(to: PathBuf, asker: Asker) -> Vec<SwitchAction> {
    let name = to.display().to_string();
    tracing::info!("painting in {name}");
    let reply = SwitchAction::Reply(asker, Outcome::done(name));
    vec![SwitchAction::SavedAs(to), reply]
}

fn ended_as_it_saved(to: &Path) -> Outcome {
    Outcome::refused(
        format!(
            "the paint node ended before it said that the painting is in {}",
            to.display()
        ),
        "check whether that file has it, and open it there; the messages of the rig give the reason",
    )
}

fn fallen() -> Outcome {
    Outcome::refused(
        "internal error: the file worker panicked",
        "see the messages of the rig, and report the fault",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    const ASKER: Asker = (7, 1);

    fn painting(name: &str) -> RigConfig {
        let mut config = RigConfig::default();
        config.paint.document = Some(name.into());
        config
    }

    /// A switch from one painting to another whose check went well, with the settings and the time.
    fn closing() -> (Switch, RigConfig, Instant) {
        let (mut switch, here, now) = (Switch::default(), painting("sea.maul"), Instant::now());
        switch.check(ASKER, false);
        let plan = Box::new(Plan {
            config: painting("hill.maul"),
            load: None,
        });
        let actions = switch.on(SwitchEvent::Checked(Ok(plan)), &here, now);
        assert_eq!(actions, [SwitchAction::RenewPaint]);
        (switch, here, now)
    }

    #[test]
    fn another_painting_is_opened_once_the_first_is_closed() {
        let (mut switch, here, now) = closing();
        assert_eq!(switch.on(SwitchEvent::PaintRuns, &here, now), []);
        let there = painting("hill.maul");
        let closed = switch.on(SwitchEvent::PaintLeft(Ended::Well), &here, now);
        assert_eq!(closed, [SwitchAction::Use(Box::new(there.clone()))]);
        assert_eq!(switch.opened(), Some(Role::Paint));
        let reply = SwitchAction::Reply(ASKER, Outcome::done("hill.maul"));
        let opened = switch.on(SwitchEvent::PaintRuns, &there, now);
        assert_eq!(opened, [SwitchAction::Leave("sea.maul".into()), reply]);
        assert!(!switch.is_busy());
    }

    #[test]
    fn a_painting_that_does_not_come_up_is_killed_and_the_one_before_opened_again() {
        let (mut switch, here, now) = closing();
        switch.on(SwitchEvent::PaintLeft(Ended::Well), &here, now);
        let limit = Duration::from_secs(30);
        let late = now + limit + Duration::from_secs(1);
        let there = painting("hill.maul");
        assert_eq!(switch.on(SwitchEvent::Time(limit), &there, now), []);
        let killed = switch.on(SwitchEvent::Time(limit), &there, late);
        assert_eq!(killed, [SwitchAction::KillPaint]);
        let left = switch.on(SwitchEvent::PaintLeft(Ended::Badly), &there, late);
        let back = [
            SwitchAction::PutBack(Box::new(here.clone())),
            SwitchAction::StartPaint,
        ];
        assert_eq!(left, back);
        let replies = switch.on(SwitchEvent::PaintRuns, &here, late);
        let [SwitchAction::Reply(ASKER, Outcome::Refused { .. })] = replies.as_slice() else {
            panic!("{replies:?}");
        };
    }

    #[test]
    fn a_painting_that_is_not_closed_in_time_is_killed_and_opened_again() {
        let (mut switch, here, now) = closing();
        let late = now + CLOSE_TIME + Duration::from_secs(1);
        let time = || SwitchEvent::Time(Duration::ZERO);
        assert_eq!(switch.on(time(), &here, now), []);
        assert_eq!(switch.on(time(), &here, late), [SwitchAction::KillPaint]);
        let left = switch.on(SwitchEvent::PaintLeft(Ended::Badly), &here, late);
        assert_eq!(left, [SwitchAction::StartPaint]);
    }

    #[test]
    fn who_saves_is_answered_when_the_paint_node_ends_before_it_is_done() {
        let (mut switch, here, now) = (Switch::default(), painting("sea.maul"), Instant::now());
        let gone = switch.save(ASKER, Path::new("copy.maul"));
        let replies = switch.on(SwitchEvent::PaintGone, &here, now);
        assert!(gone.load(Ordering::SeqCst) && !switch.is_busy());
        assert!(matches!(
            replies.as_slice(),
            [SwitchAction::Reply(ASKER, Outcome::Refused { .. })]
        ));
        // Another one is saved, and ends well.
        switch.save(ASKER, Path::new("copy.maul"));
        let saved = switch.on(SwitchEvent::Saved(Ok(())), &here, now);
        assert_eq!(saved[0], SwitchAction::SavedAs("copy.maul".into()));
    }
}
