//! The nodes of a rig as a state machine: its inputs are events of processes and tokens, its outputs actions. It starts
//! and signals nothing itself, and reads no clock.

use std::time::{Duration, Instant};

use maulstick_rig::{RigConfig, UserError};

use super::node::{Failures, Node, State};
use crate::up::plan::{Hands, NodeSpec, Role};
use crate::up::processes::Ended;

/// Pause before a node is started again.
const RESTART_PAUSE: Duration = Duration::from_millis(200);
/// Time without a token after which a node counts as frozen.
const FROZEN: Duration = Duration::from_secs(5);

/// Action on the process of a node, by its name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Action {
    Start(String),
    /// Ask it to end.
    Terminate(String),
    /// Kill it; its end comes as that of one that crashed.
    Kill(String),
}

/// Consequence of a node's end.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Exit {
    /// The rig continues without it.
    Rests,
    Restarts,
    /// The rig ends with this code.
    EndsRig(i32),
    /// The rig cannot do without it.
    Fails(UserError),
}

/// The nodes.
#[derive(Debug, Default)]
pub(in crate::up) struct Crew {
    pub(in crate::up) nodes: Vec<Node>,
    failures: Failures,
}

impl Crew {
    /// Nodes of which none is started.
    pub(super) fn new(specs: Vec<NodeSpec>) -> Self {
        Self {
            nodes: specs.into_iter().map(Node::new).collect(),
            failures: Failures::default(),
        }
    }

    pub(super) fn find(&mut self, name: &str) -> Option<&mut Node> {
        self.nodes.iter_mut().find(|node| node.spec.name == name)
    }

    /// The first node of a role.
    pub(super) fn of_role(&self, role: Role) -> Option<&Node> {
        self.nodes.iter().find(|node| node.spec.role == role)
    }

    /// True if the paint node has its painting.
    pub(super) fn paint_runs(&self) -> bool {
        self.of_role(Role::Paint)
            .is_some_and(|paint| paint.state == State::Running)
    }

    /// True if no node is still starting; a device that failed for good delays nothing.
    pub(super) fn is_ready(&self) -> bool {
        let mut nodes = self.nodes.iter();
        nodes.all(|node| !matches!(node.state, State::Starting | State::Restarting))
    }

    /// Adds a node, replacing one of its name.
    pub(super) fn put(&mut self, spec: NodeSpec) {
        match self.find(&spec.name) {
            Some(node) => node.spec = spec,
            None => self.nodes.push(Node::new(spec)),
        }
    }

    /// The token of a node came or went.
    pub(super) fn token(&mut self, name: &str, is_present: bool, now: Instant) {
        if let Some(node) = self.find(name) {
            node.missed = (!is_present).then_some(now);
            if node.state == State::Starting && is_present {
                node.state = State::Running;
            }
        }
    }

    /// Asks a node to end, to be restarted; `None` where it does not run.
    pub(super) fn renew(&mut self, name: &str, now: Instant) -> Option<Action> {
        let node = self.find(name).filter(|node| node.pid.is_some())?;
        (node.leaving_since, node.due) = (Some(now), None);
        node.state = State::Restarting;
        Some(Action::Terminate(name.to_owned()))
    }

    /// Asks all nodes of a role to end, to be restarted.
    pub(super) fn renew_all(&mut self, role: Role, now: Instant) -> Vec<Action> {
        let of_role = self.nodes.iter().filter(|node| node.spec.role == role);
        let names: Vec<String> = of_role.map(|node| node.spec.name.clone()).collect();
        let renewed = names.iter().filter_map(|name| self.renew(name, now));
        renewed.collect()
    }

    /// Handles an unrequested end of a node; `hands` tells whether a player replaces the devices.
    pub(super) fn ended(&mut self, name: &str, ended: Ended, hands: Hands, now: Instant) -> Exit {
        let Self { nodes, failures } = self;
        let Some(node) = nodes.iter_mut().find(|node| node.spec.name == name) else {
            return Exit::Rests;
        };
        let role = node.spec.role;
        match ended {
            Ended::Well if may_end(role, hands) => {
                node.state = State::Ended;
                return match role {
                    Role::Window => Exit::EndsRig(0),
                    _ => Exit::Rests,
                };
            }
            Ended::Refused(code) if role == Role::Player => return Exit::EndsRig(code),
            Ended::Refused(_) => node.state = State::Failed,
            // A stopped node is handled like one that crashed.
            Ended::Well | Ended::Badly => {
                let too_often = failures.count(name, now);
                if node.may_restart() && !too_often {
                    node.state = State::Restarting;
                    node.due = Some(now + RESTART_PAUSE);
                    let how = match ended {
                        Ended::Well => "ended",
                        _ => "failed",
                    };
                    tracing::warn!("node '{name}' {how} and is started again");
                    return Exit::Restarts;
                }
                node.state = State::Failed;
            }
        }
        if role.is_spare() {
            tracing::error!("node '{name}' failed and is not started again");
            Exit::Rests
        } else {
            Exit::Fails(
                UserError::failure(format!("node '{name}' does not stay up")).help(
                    "its messages above give the reason; three failures in ten seconds are the limit",
                ),
            )
        }
    }

    /// The system refused to start a node: where a retry may help it follows later, and the others continue.
    ///
    /// # Errors
    /// The fault, where the node is indispensable and a retry does not help.
    pub(super) fn put_off(
        &mut self,
        name: &str,
        fault: UserError,
        now: Instant,
    ) -> Result<(), UserError> {
        let Some(node) = self.find(name) else {
            return Ok(());
        };
        if node.put_off(now) {
            tracing::warn!("{}; it is tried again", fault.what);
            return Ok(());
        }
        node.state = State::Failed;
        if node.spec.role.is_spare() {
            tracing::error!("{}; it is not tried again", fault.what);
            Ok(())
        } else {
            Err(fault)
        }
    }

    /// Actions whose time has come: starts of nodes that are due, and kills of those that do not answer, get ready or
    /// leave in time. A painting that is being `opened` has its own time.
    pub(super) fn look(
        &mut self,
        now: Instant,
        config: &RigConfig,
        opened: Option<Role>,
    ) -> Vec<Action> {
        let mut actions = Vec::new();
        for node in &mut self.nodes {
            if node.due.is_some_and(|due| due <= now) {
                node.due = None;
                actions.push(Action::Start(node.spec.name.clone()));
            } else if node.pid.is_some() && is_overdue(node, now, config, opened) {
                actions.push(Action::Kill(node.spec.name.clone()));
            }
        }
        actions
    }

    /// The time at which the next node is due.
    pub(super) fn next_due(&self) -> Option<Instant> {
        self.nodes.iter().filter_map(|node| node.due).min()
    }

    /// Restarts a take: its brush and paint are killed and restarted, and the player is made again.
    pub(super) fn play_again(&mut self, now: Instant) -> Vec<Action> {
        let again = |node: &&mut Node| {
            matches!(node.spec.role, Role::Paint | Role::Brush | Role::Player) && node.pid.is_some()
        };
        let again = self.nodes.iter_mut().filter(again);
        let actions = again.map(|node| {
            (node.state, node.leaving_since) = (State::Restarting, Some(now));
            Action::Kill(node.spec.name.clone())
        });
        let actions = actions.collect();
        self.nodes.retain(|node| node.spec.role != Role::Player);
        actions
    }

    /// Extends the deadlines of all nodes.
    pub(super) fn postpone(&mut self, by: Duration) {
        self.nodes.iter_mut().for_each(|node| node.postpone(by));
    }
}

/// True if a node does not answer, get ready or leave in time.
fn is_overdue(node: &mut Node, now: Instant, config: &RigConfig, opened: Option<Role>) -> bool {
    let (name, role) = (&node.spec.name, node.spec.role);
    let passed = |since: Option<Instant>, limit: Duration| {
        since.is_some_and(|since| now.saturating_duration_since(since) > limit)
    };
    let is_starting = node.state == State::Starting && opened != Some(role);
    if node.state == State::Running && passed(node.missed, FROZEN) {
        tracing::warn!("node '{name}' does not answer and is ended");
        node.missed = None;
        return true;
    }
    if is_starting && passed(node.started, node.start_time(config)) {
        tracing::warn!("node '{name}' does not get ready");
        node.started = None;
        return true;
    }
    // Paint is still writing.
    role != Role::Paint && passed(node.leaving_since, FROZEN)
}

/// True if the rig can do without a node that ended with success.
fn may_end(role: Role, hands: Hands) -> bool {
    match role {
        Role::Paint | Role::Brush | Role::Recorder => false,
        // While its take is conducted it stays, even after the take's end.
        Role::Player => hands == Hands::Devices,
        Role::Device | Role::Window => true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::up::plan::{Window, nodes};

    /// A crew of which all runs, at a time.
    fn crew(window: Window) -> (Crew, Instant) {
        let config = RigConfig::default();
        let mut crew = Crew::new(nodes(&config, window, Hands::Devices));
        let now = Instant::now();
        for (node, pid) in crew.nodes.iter_mut().zip(1..) {
            node.has_started(pid, now);
            node.state = State::Running;
        }
        (crew, now)
    }

    fn gone(crew: &mut Crew, name: &str, ended: Ended, now: Instant) -> Exit {
        crew.find(name).expect("a node").pid = None;
        crew.ended(name, ended, Hands::Devices, now)
    }

    #[test]
    fn a_brush_that_crashes_is_back_after_a_pause_and_the_third_time_too_much() {
        let ((mut crew, now), config) = (crew(Window::Headless), RigConfig::default());
        for _ in 0..2 {
            let exit = gone(&mut crew, "brush-main", Ended::Badly, now);
            assert_eq!(exit, Exit::Restarts);
            assert_eq!(crew.next_due(), Some(now + RESTART_PAUSE));
            assert_eq!(crew.look(now, &config, None), []);
            let start = Action::Start("brush-main".into());
            let later = now + RESTART_PAUSE;
            assert_eq!(crew.look(later, &config, None), [start]);
            assert_eq!(crew.next_due(), None, "once");
        }
        let exit = gone(&mut crew, "brush-main", Ended::Badly, now);
        assert!(matches!(exit, Exit::Fails(_)));
    }

    #[test]
    fn the_end_of_the_window_ends_the_rig_and_that_of_the_paint_does_not() {
        let (mut crew, now) = crew(Window::Shown);
        let exit = gone(&mut crew, "paint", Ended::Well, now);
        assert_eq!(exit, Exit::Restarts);
        assert_eq!(gone(&mut crew, "ui", Ended::Badly, now), Exit::Restarts);
        assert_eq!(gone(&mut crew, "ui", Ended::Well, now), Exit::EndsRig(0));
    }

    #[test]
    fn a_node_whose_token_is_gone_for_five_seconds_is_killed_once() {
        let ((mut crew, now), config) = (crew(Window::Headless), RigConfig::default());
        crew.token("paint", false, now);
        let at = |s: u64| now + Duration::from_secs(s);
        assert_eq!(crew.look(at(5), &config, None), []);
        assert_eq!(
            crew.look(at(6), &config, None),
            [Action::Kill("paint".into())]
        );
        assert_eq!(crew.look(at(7), &config, None), []);
        crew.postpone(Duration::from_secs(60));
        crew.token("brush-main", false, now);
        crew.token("brush-main", true, at(1));
        assert_eq!(crew.look(at(9), &config, None), []);
    }

    #[test]
    fn a_node_that_is_renewed_may_take_as_long_and_paint_longer() {
        let ((mut crew, now), config) = (crew(Window::Headless), RigConfig::default());
        for name in ["paint", "brush-main"] {
            let asked = crew.renew(name, now);
            assert_eq!(asked, Some(Action::Terminate(name.into())));
        }
        let late = now + FROZEN + Duration::from_secs(1);
        let killed = Action::Kill("brush-main".into());
        assert_eq!(crew.look(late, &config, None), [killed]);
        assert_eq!(crew.renew("nobody", now), None);
    }
}
