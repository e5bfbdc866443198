//! Monitors the other processes of the rig, and notifies the painter of each event once, with advice.

use std::collections::{BTreeMap, BTreeSet};

use maulstick_bus::typed::{Reason, Refusal};
use maulstick_rig::config::BRUSH_NODE;
use maulstick_types::DecodeError;
use maulstick_types::paint::Decision;
use maulstick_types::stylus::StylusStatus;
use maulstick_types::wire::topics::Topics;
use maulstick_ui_kit::notifications::Notifications;

use maulstick_client::state::RigEvent;

use crate::rig::state::RigState;

/// The node of the painting.
const PAINT: &str = "paint";
/// The device that ends with its take.
const PLAYER: &str = "player";
/// Message that a node has left.
fn stopped(who: &str) -> String {
    tr!("{who} stopped; it is being started again.", who)
}

/// Fault of a device.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
enum DeviceFault {
    /// It is in order.
    #[default]
    None,
    /// There is no device.
    Trouble { what: String, help: String },
    /// It gives no force: the faults that it has latched.
    NoForce(String),
}

impl DeviceFault {
    fn of(status: &StylusStatus) -> Self {
        if !status.faults.is_empty() {
            return Self::NoForce(status.faults.join("; "));
        }
        status
            .trouble()
            .map_or(Self::None, |trouble| Self::Trouble {
                what: trouble.what.to_owned(),
                help: trouble.help.to_owned(),
            })
    }
}

/// Events notified so far.
#[derive(Debug, Default)]
pub(crate) struct HealthMonitor {
    /// Nodes that were there, and those of them that are gone.
    known: BTreeSet<String>,
    gone: BTreeSet<String>,
    /// Those that left for another painting.
    expected: BTreeSet<String>,
    /// Fault that each device reported.
    troubles: BTreeMap<String, DeviceFault>,
    /// Nodes of another version.
    strange: BTreeSet<String>,
    /// True while the painting cannot be saved.
    unsaved: bool,
}

impl HealthMonitor {
    /// Tells what has changed since the last look.
    pub(crate) fn look(
        &mut self,
        state: &mut RigState,
        topics: &Topics,
        notifications: &mut Notifications,
    ) {
        for events in std::mem::take(&mut state.live.events) {
            match events {
                RigEvent::Refused(refusal) => self.refused(topics, &refusal, notifications),
                RigEvent::Decided(decision) => decided(&decision, notifications),
            }
        }
        self.nodes(state, notifications);
        self.devices(state, notifications);
        self.saving(state, notifications);
    }

    fn nodes(&mut self, state: &RigState, notifications: &mut Notifications) {
        let present: BTreeSet<String> = state.live.nodes.iter().cloned().collect();
        for node in self.known.difference(&present) {
            if !self.gone.insert(node.clone()) {
                continue;
            }
            let changes = state.setup.is_changing || state.setup.fit.is_some();
            // A session is painted again in a painting of its own: what leaves later has failed.
            let opens = state.switching || state.replay.as_ref().is_some_and(|own| own.opens);
            if opens || changes && state.live.devices.contains_key(node) {
                self.expected.insert(node.clone());
                continue;
            }
            match who(node, state) {
                Some((who, Some(help))) => notifications.fault(stopped(&who), help),
                Some((who, None)) => notifications.note(tr!(
                    "{who} is disconnected. Any other stylus and the mouse still paint.",
                    who
                )),
                None => {}
            }
        }
        for node in &present {
            if self.gone.remove(node)
                && !self.expected.remove(node)
                && let Some((who, _)) = who(node, state)
            {
                notifications.over(&stopped(&who));
                notifications.note(tr!("{who} is back.", who));
            }
        }
        self.known.extend(present);
    }

    fn devices(&mut self, state: &RigState, notifications: &mut Notifications) {
        for (name, device) in &state.live.devices {
            let Some(status) = &device.status else {
                continue;
            };
            let fault = DeviceFault::of(status);
            let told = self.troubles.entry(name.clone()).or_default();
            if *told == fault {
                continue;
            }
            match &fault {
                DeviceFault::None => {
                    notifications.note(tr!("The device '{name}' is in order again.", name));
                }
                DeviceFault::Trouble { what, help } => {
                    notifications.fault(tr!("The device '{name}': {what}", name, what), help);
                }
                DeviceFault::NoForce(trouble) => notifications.fault(
                    tr!(
                        "The device '{name}' gives no force: {trouble}",
                        name,
                        trouble
                    ),
                    tr!("Lift the brush, then press Re-arm in the panel Device."),
                ),
            }
            *told = fault;
        }
    }

    /// Notifies that saving works again; that it fails stays in the progress lines meanwhile.
    fn saving(&mut self, state: &RigState, notifications: &mut Notifications) {
        let Some(paint) = &state.live.paint else {
            return;
        };
        let unsaved = !paint.status.fault.is_empty();
        if std::mem::replace(&mut self.unsaved, unsaved) && !unsaved {
            notifications.note(tr!("The painting is being saved again."));
        }
    }

    fn refused(&mut self, topics: &Topics, refusal: &Refusal, notifications: &mut Notifications) {
        let relative = topics.relative(&refusal.topic).unwrap_or(&refusal.topic);
        let who = match relative.split('/').collect::<Vec<_>>()[..] {
            ["stylus" | "control" | "haptics", device, ..] => tr!("The device '{device}'", device),
            ["brush", brush, ..] => tr!("The node of the brush '{brush}'", brush),
            ["paint", ..] | ["scene"] => tr!("The painting engine").to_owned(),
            _ => tr!("Who sends {relative}", relative),
        };
        if !self.strange.insert(who.clone()) {
            return;
        }
        match &refusal.reason {
            Reason::Unread(DecodeError::UnknownSchema { .. }) => notifications.fault(
                tr!(
                    "{who} is of another version of Maulstick than this window.",
                    who
                ),
                tr!("End the rig, and start it again with all of its programs of one version."),
            ),
            Reason::Rival | Reason::Leap => notifications.fault(
                tr!("{who} is running twice: the newest one is used.", who),
                tr!("End the other program, or give it another name."),
            ),
            error => notifications.fault(
                tr!(
                    "{who} sends messages that cannot be read: {error}",
                    who,
                    error
                ),
                tr!("Start it again; if it is a program of your own, see docs/devices.md."),
            ),
        }
    }
}

/// Description of a node, and advice while it is away, which a device that may have been removed has not; `None` for a
/// process that comes and goes.
fn who(node: &str, state: &RigState) -> Option<(String, Option<&'static str>)> {
    if node == PAINT {
        let help = tr!("The canvas stays as displayed, and painting continues after the restart.");
        return Some((tr!("The painting engine").to_owned(), Some(help)));
    }
    if let Some(brush) = node.strip_prefix(BRUSH_NODE) {
        let help = tr!("Lift the stylus; the brush follows again when it is back.");
        return Some((tr!("The node of the brush '{brush}'", brush), Some(help)));
    }
    let is_device = node != PLAYER && state.live.devices.contains_key(node);
    let device = node;
    is_device.then(|| (tr!("The device '{device}'", device), None))
}

/// Tells of a decision that the painter ought to know.
fn decided(decision: &Decision, notifications: &mut Notifications) {
    match decision {
        Decision::LighterModel { model } => notifications.note(tr!(
            "Painting falls behind on this machine. The paint model {model} is faster: Paint model in the panel Canvas \
             converts this painting, and that can be undone.",
            model
        )),
        Decision::CoarserFlow { why } => notifications.note(tr!(
            "The graphics card has too little memory for so wide a brush: thick paint flows in less detail around it ({why})",
            why
        )),
        Decision::Fallback { why, .. } => notifications.fault(
            tr!(
                "The paint is computed by the processor from now on: {why}",
                why
            ),
            tr!(
                "Nothing is missing, but large brushes may lag. Starting the rig again tries the \
             graphics card anew."
            ),
        ),
        Decision::Backend { .. } | Decision::Resumed | Decision::Words { .. } => {}
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;
    use std::sync::Arc;

    use maulstick_optics::PaintLibrary;
    use maulstick_types::stylus::Trouble;

    use super::*;
    use crate::sessions::progress::ReplayProgress;
    use crate::test_support::panel_bench::status;
    use maulstick_client::state::PaintNode;
    use maulstick_ui_kit::notifications::Severity;

    struct Rig {
        watch: HealthMonitor,
        state: RigState,
    }

    impl Rig {
        fn new() -> Self {
            let library = Arc::new(PaintLibrary::measured().expect("paints"));
            let mut state = RigState::new("t", &["main".to_owned()], library);
            state.live.nodes = ["paint", "brush-main", "arm", "player", "ui"]
                .map(str::to_owned)
                .to_vec();
            for device in ["arm", "player"] {
                let device = state.live.devices.entry(device.to_owned()).or_default();
                device.status = Some(StylusStatus::fresh(0));
            }
            state.live.paint = Some(PaintNode {
                status: status(),
                heard_ns: 0,
            });
            let mut rig = Self {
                watch: HealthMonitor::default(),
                state,
            };
            assert_eq!(rig.look(), [], "all is well");
            rig
        }

        /// Notifications of one look; ten more looks add none.
        fn look(&mut self) -> Vec<(Severity, String)> {
            let topics = Topics::new("t");
            let told = |notifications: &Notifications| {
                let told = notifications.shown().iter();
                told.map(|toast| (toast.severity, toast.what.clone()))
                    .collect::<Vec<_>>()
            };
            let mut notifications = Notifications::default();
            self.watch
                .look(&mut self.state, &topics, &mut notifications);
            let first = told(&notifications);
            let mut again = Notifications::default();
            for _ in 0..10 {
                self.watch.look(&mut self.state, &topics, &mut again);
            }
            assert_eq!(told(&again), [], "once is enough");
            first
        }

        fn arm(&mut self) -> &mut StylusStatus {
            let arm = self.state.live.devices.get_mut("arm").expect("an arm");
            arm.status.as_mut().expect("a status")
        }

        fn saving(&mut self) -> &mut String {
            &mut self.state.live.paint.as_mut().expect("paint").status.fault
        }
    }

    fn fault(what: &str) -> Vec<(Severity, String)> {
        vec![(Severity::Fault, what.to_owned())]
    }

    fn note(what: &str) -> Vec<(Severity, String)> {
        vec![(Severity::Note, what.to_owned())]
    }

    #[test]
    fn a_node_that_goes_and_comes_is_told_once_each_time() {
        for (node, who) in [
            ("paint", "The painting engine"),
            ("brush-main", "The node of the brush 'main'"),
        ] {
            let mut rig = Rig::new();
            for _ in 0..2 {
                rig.state.live.nodes.retain(|other| other != node);
                let told = fault(&format!("{who} stopped; it is being started again."));
                assert_eq!(rig.look(), told);
                rig.state.live.nodes.push(node.to_owned());
                assert_eq!(rig.look(), note(&format!("{who} is back.")));
            }
        }
        let mut rig = Rig::new();
        rig.state.live.nodes.retain(|other| other != "player");
        assert_eq!(rig.look(), [], "its take is over");
    }

    #[test]
    fn a_device_that_leaves_is_no_fault() {
        let mut rig = Rig::new();
        for _ in 0..2 {
            rig.state.live.nodes.retain(|other| other != "arm");
            let left =
                "The device 'arm' is disconnected. Any other stylus and the mouse still paint.";
            assert_eq!(rig.look(), note(left));
            rig.state.live.nodes.push("arm".to_owned());
            assert_eq!(rig.look(), note("The device 'arm' is back."));
        }
    }

    #[test]
    fn nodes_that_another_painting_starts_anew_are_not_told() {
        let mut rig = Rig::new();
        rig.state.switching = true;
        rig.state.live.nodes.retain(|node| node != "arm");
        assert_eq!(rig.look(), []);
        // The answer may come before the last of them is back.
        rig.state.switching = false;
        rig.state.live.nodes.push("arm".to_owned());
        assert_eq!(rig.look(), []);
        rig.state.live.nodes.retain(|node| node != "arm");
        assert_eq!(rig.look().len(), 1, "it is told where nothing is switched");
    }

    #[test]
    fn a_replay_hides_who_leaves_for_its_painting_and_nobody_later() {
        let mut rig = Rig::new();
        rig.state.replay = Some(ReplayProgress {
            opens: true,
            ..ReplayProgress::new(Path::new("sea.mcap"))
        });
        rig.state.live.nodes.retain(|node| node != "paint");
        assert_eq!(rig.look(), [], "it goes on in another painting");
        rig.state.live.nodes.push("paint".to_owned());
        assert_eq!(rig.look(), []);
        rig.state.replay = Some(ReplayProgress::new(Path::new("sea.mcap")));
        for node in ["paint", "brush-main"] {
            rig.state.live.nodes.retain(|other| other != node);
            assert_eq!(rig.look().len(), 1, "{node} failed");
        }
    }

    #[test]
    fn a_device_that_is_changed_here_is_not_told() {
        let mut rig = Rig::new();
        rig.state.setup.is_changing = true;
        for node in ["arm", "paint"] {
            rig.state.live.nodes.retain(|other| other != node);
        }
        assert_eq!(rig.look().len(), 1, "the paint is");
        rig.state.live.nodes.push("arm".to_owned());
        assert_eq!(rig.look(), []);
    }

    #[test]
    fn a_devices_trouble_and_its_end_are_told() {
        let mut rig = Rig::new();
        let trouble = Trouble {
            what: "no arm (/dev/ttyACM0)",
            help: "plug it in",
        };
        assert!(rig.arm().report(trouble));
        assert_eq!(rig.look(), fault("The device 'arm': no arm (/dev/ttyACM0)"));
        rig.arm().clear_trouble();
        assert_eq!(rig.look(), note("The device 'arm' is in order again."));
        rig.arm().faults = vec!["it shakes".into()];
        let told = fault("The device 'arm' gives no force: it shakes");
        assert_eq!(rig.look(), told);
    }

    #[test]
    fn a_painting_that_is_saved_again_is_told() {
        let mut rig = Rig::new();
        *rig.saving() = "no room: free some space".into();
        assert_eq!(rig.look(), [], "it stands on the window");
        rig.saving().clear();
        assert_eq!(rig.look(), note("The painting is being saved again."));
    }

    #[test]
    fn who_is_of_another_version_is_named_once() {
        let mut rig = Rig::new();
        let topics = Topics::new("t");
        let refused = |topic: String| {
            let error = DecodeError::UnknownSchema {
                name: "PaintStatus",
                wanted: 1,
                got: 2,
                version: 9,
            };
            RigEvent::Refused(Refusal {
                topic,
                reason: error.into(),
            })
        };
        rig.state.live.events = vec![refused(topics.paint_status()), refused(topics.scene())];
        let strange = |who: &str| {
            fault(&format!(
                "{who} is of another version of Maulstick than this window."
            ))
        };
        assert_eq!(rig.look(), strange("The painting engine"));
        rig.state.live.events = vec![refused(topics.paint_status())];
        assert_eq!(rig.look(), []);
        rig.state.live.events = vec![refused(topics.stylus_info("arm"))];
        assert_eq!(rig.look(), strange("The device 'arm'"));
        rig.state.live.events = vec![refused(topics.brush_def("main"))];
        assert_eq!(rig.look(), strange("The node of the brush 'main'"));
    }

    #[test]
    fn that_the_processor_has_taken_over_is_told_and_a_choice_at_the_start_is_not() {
        let mut rig = Rig::new();
        let chosen = |name: &str| Decision::Backend { name: name.into() };
        rig.state.live.events = [chosen("cpu"), chosen("gpu A: B"), Decision::Resumed]
            .map(RigEvent::Decided)
            .to_vec();
        assert_eq!(rig.look(), []);
        let lost = Decision::Fallback {
            name: "cpu".into(),
            why: "the device is lost".into(),
        };
        rig.state.live.events = vec![RigEvent::Decided(lost)];
        let told = fault("The paint is computed by the processor from now on: the device is lost");
        assert_eq!(rig.look(), told);
    }

    #[test]
    fn that_flow_is_found_on_coarser_cells_is_told() {
        let mut rig = Rig::new();
        let why = "a window needs 300 MiB".to_owned();
        rig.state.live.events = vec![RigEvent::Decided(Decision::CoarserFlow { why })];
        let told = note(
            "The graphics card has too little memory for so wide a brush: thick paint flows in less detail around it (a window \
             needs 300 MiB)",
        );
        assert_eq!(rig.look(), told);
    }
}
