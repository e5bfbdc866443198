//! Watches over the other processes of the rig and tells what became of them: each thing once, and what
//! to do about it.

use std::collections::{BTreeMap, BTreeSet};

use maulstick_bus::typed::{Reason, Refusal};
use maulstick_types::DecodeError;
use maulstick_types::advice::parted;
use maulstick_types::topics::Topics;

use crate::rig::state::Studio;
use crate::widgets::notifications::Toasts;

/// The node of the painting.
const PAINT: &str = "paint";
/// What the names of brush nodes begin with.
const BRUSH: &str = "brush-";
/// The device that ends with its take.
const PLAYER: &str = "player";
/// That a node has left.
fn stopped(who: &str) -> String {
    format!("{who} stopped; it is being started again.")
}

/// What the decision begins with that the processor takes over what the graphics card computed.
const FALL: &str = "backend cpu: ";

/// Something heard that changes nothing of what is known of the rig.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum News {
    /// A message that this window does not understand.
    Refused(Refusal),
    /// The paint node has decided something, in its words.
    Decided(String),
}

/// What was told so far.
#[derive(Debug, Default)]
pub(crate) struct Watch {
    /// Nodes that were there, and those of them that are gone.
    known: BTreeSet<String>,
    gone: BTreeSet<String>,
    /// Those that left for another painting.
    expected: BTreeSet<String>,
    /// What each device said was wrong.
    troubles: BTreeMap<String, String>,
    /// Nodes of another version.
    strange: BTreeSet<String>,
    /// Whether the painting cannot be saved.
    unsaved: bool,
}

impl Watch {
    /// Tells what has changed since the last look.
    pub(crate) fn look(&mut self, studio: &mut Studio, topics: &Topics, toasts: &mut Toasts) {
        for news in std::mem::take(&mut studio.news) {
            match news {
                News::Refused(refusal) => self.refused(topics, &refusal, toasts),
                News::Decided(what) => decided(&what, toasts),
            }
        }
        self.nodes(studio, toasts);
        self.devices(studio, toasts);
        self.saving(studio, toasts);
    }

    fn nodes(&mut self, studio: &Studio, toasts: &mut Toasts) {
        let present: BTreeSet<String> = studio.nodes.iter().cloned().collect();
        for node in self.known.difference(&present) {
            if !self.gone.insert(node.clone()) {
                continue;
            }
            if studio.switching {
                self.expected.insert(node.clone());
            } else if let Some((who, help)) = who(node, studio) {
                toasts.fault(stopped(&who), help);
            }
        }
        for node in &present {
            if self.gone.remove(node)
                && !self.expected.remove(node)
                && let Some((who, _)) = who(node, studio)
            {
                toasts.over(&stopped(&who));
                toasts.note(format!("{who} is back."));
            }
        }
        self.known.extend(present);
    }

    fn devices(&mut self, studio: &Studio, toasts: &mut Toasts) {
        for (name, device) in &studio.devices {
            let Some(status) = &device.status else {
                continue;
            };
            let trouble = match status.faults.is_empty() {
                true => status.trouble.clone(),
                false => status.faults.join("; "),
            };
            let told = self.troubles.entry(name.clone()).or_default();
            if *told == trouble {
                continue;
            }
            if trouble.is_empty() {
                toasts.note(format!("The device '{name}' is in order again."));
            } else if status.faults.is_empty() {
                let (what, help) = parted(&trouble);
                toasts.fault(
                    format!("The device '{name}': {what}"),
                    help.unwrap_or_default(),
                );
            } else {
                toasts.fault(
                    format!("The device '{name}' gives no force: {trouble}"),
                    "Lift the brush, then press Re-arm in the panel Device (Tab).",
                );
            }
            *told = trouble;
        }
    }

    /// That the painting cannot be saved stands on the window for as long as it is so; here its end is told.
    fn saving(&mut self, studio: &Studio, toasts: &mut Toasts) {
        let Some(paint) = &studio.paint else {
            return;
        };
        let unsaved = !paint.status.fault.is_empty();
        if std::mem::replace(&mut self.unsaved, unsaved) && !unsaved {
            toasts.note("The painting is being saved again.");
        }
    }

    fn refused(&mut self, topics: &Topics, refusal: &Refusal, toasts: &mut Toasts) {
        let relative = topics.relative(&refusal.topic).unwrap_or(&refusal.topic);
        let who = match relative.split('/').collect::<Vec<_>>()[..] {
            ["stylus" | "control" | "haptics", device, ..] => format!("The device '{device}'"),
            ["brush", brush, ..] => format!("The node of the brush '{brush}'"),
            ["paint", ..] | ["scene"] => "The paint node".to_owned(),
            _ => format!("Who sends {relative}"),
        };
        if !self.strange.insert(who.clone()) {
            return;
        }
        match &refusal.reason {
            Reason::Unread(DecodeError::UnknownSchema { .. }) => toasts.fault(
                format!("{who} is of another version of Maulstick than this window."),
                "End the rig, and start it again with all of its programs of one version.",
            ),
            Reason::Rival | Reason::Leap => toasts.fault(
                format!("{who} is there twice: the one that started last is followed."),
                "End the other program, or give it another name.",
            ),
            error => toasts.fault(
                format!("{who} sends what is not understood: {error}"),
                "Start it again; if it is a program of your own, see docs/devices.md.",
            ),
        }
    }
}

/// A node in words, and what to do while it is away; none for one that comes and goes.
fn who(node: &str, studio: &Studio) -> Option<(String, &'static str)> {
    if node == PAINT {
        let help = "The canvas stays as it is shown, and goes on when it is back.";
        return Some(("The paint node".to_owned(), help));
    }
    if let Some(brush) = node.strip_prefix(BRUSH) {
        let help = "Lift the stylus; the brush follows again when it is back.";
        return Some((format!("The node of the brush '{brush}'"), help));
    }
    let is_device = node != PLAYER && studio.devices.contains_key(node);
    let help = "Any other stylus and the mouse go on painting.";
    is_device.then(|| (format!("The driver of '{node}'"), help))
}

/// Tells of a decision that the painter ought to know.
fn decided(what: &str, toasts: &mut Toasts) {
    if let Some(why) = what.strip_prefix(FALL) {
        toasts.fault(
            format!("The paint is computed by the processor from now on: {why}"),
            "Nothing is missing, but large brushes may lag. Starting the rig again tries the \
             graphics card anew.",
        );
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use maulstick_optics::PaintLibrary;
    use maulstick_types::stylus::StylusStatus;

    use super::*;
    use crate::rig::state::PaintNode;
    use crate::test_support::panel_bench::status;
    use crate::widgets::notifications::Weight;

    struct Rig {
        watch: Watch,
        studio: Studio,
    }

    impl Rig {
        fn new() -> Self {
            let library = Arc::new(PaintLibrary::measured().expect("paints"));
            let mut studio = Studio::new("t", &["main".to_owned()], library);
            studio.nodes = ["paint", "brush-main", "arm", "player", "ui"]
                .map(str::to_owned)
                .to_vec();
            for device in ["arm", "player"] {
                let device = studio.devices.entry(device.to_owned()).or_default();
                device.status = Some(StylusStatus::fresh(0));
            }
            studio.paint = Some(PaintNode {
                status: status(),
                heard_ns: 0,
            });
            let mut rig = Self {
                watch: Watch::default(),
                studio,
            };
            assert_eq!(rig.look(), [], "all is well");
            rig
        }

        /// What is told by a look, and that ten more tell nothing.
        fn look(&mut self) -> Vec<(Weight, String)> {
            let topics = Topics::new("t");
            let told = |toasts: &Toasts| {
                let told = toasts.told().iter();
                told.map(|toast| (toast.weight, toast.what.clone()))
                    .collect::<Vec<_>>()
            };
            let mut toasts = Toasts::default();
            self.watch.look(&mut self.studio, &topics, &mut toasts);
            let first = told(&toasts);
            let mut again = Toasts::default();
            for _ in 0..10 {
                self.watch.look(&mut self.studio, &topics, &mut again);
            }
            assert_eq!(told(&again), [], "once is enough");
            first
        }

        fn arm(&mut self) -> &mut StylusStatus {
            let arm = self.studio.devices.get_mut("arm").expect("an arm");
            arm.status.as_mut().expect("a status")
        }

        fn saving(&mut self) -> &mut String {
            &mut self.studio.paint.as_mut().expect("paint").status.fault
        }
    }

    fn fault(what: &str) -> Vec<(Weight, String)> {
        vec![(Weight::Fault, what.to_owned())]
    }

    fn note(what: &str) -> Vec<(Weight, String)> {
        vec![(Weight::Note, what.to_owned())]
    }

    #[test]
    fn a_node_that_goes_and_comes_is_told_once_each_time() {
        for (node, who) in [
            ("paint", "The paint node"),
            ("brush-main", "The node of the brush 'main'"),
            ("arm", "The driver of 'arm'"),
        ] {
            let mut rig = Rig::new();
            for _ in 0..2 {
                rig.studio.nodes.retain(|other| other != node);
                let told = fault(&format!("{who} stopped; it is being started again."));
                assert_eq!(rig.look(), told);
                rig.studio.nodes.push(node.to_owned());
                assert_eq!(rig.look(), note(&format!("{who} is back.")));
            }
        }
        let mut rig = Rig::new();
        rig.studio.nodes.retain(|other| other != "player");
        assert_eq!(rig.look(), [], "its take is over");
    }

    #[test]
    fn nodes_that_another_painting_starts_anew_are_not_told() {
        let mut rig = Rig::new();
        rig.studio.switching = true;
        rig.studio.nodes.retain(|node| node != "arm");
        assert_eq!(rig.look(), []);
        // The answer may come before the last of them is back.
        rig.studio.switching = false;
        rig.studio.nodes.push("arm".to_owned());
        assert_eq!(rig.look(), []);
        rig.studio.nodes.retain(|node| node != "arm");
        assert_eq!(rig.look().len(), 1, "it is told where nothing is switched");
    }

    #[test]
    fn a_devices_trouble_and_its_end_are_told() {
        let mut rig = Rig::new();
        rig.arm().trouble = "no arm (/dev/ttyACM0); plug it in".into();
        assert_eq!(rig.look(), fault("The device 'arm': no arm (/dev/ttyACM0)"));
        rig.arm().trouble = String::new();
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
            News::Refused(Refusal {
                topic,
                reason: error.into(),
            })
        };
        rig.studio.news = vec![refused(topics.paint_status()), refused(topics.scene())];
        let strange = |who: &str| {
            fault(&format!(
                "{who} is of another version of Maulstick than this window."
            ))
        };
        assert_eq!(rig.look(), strange("The paint node"));
        rig.studio.news = vec![refused(topics.paint_status())];
        assert_eq!(rig.look(), []);
        rig.studio.news = vec![refused(topics.stylus_info("arm"))];
        assert_eq!(rig.look(), strange("The device 'arm'"));
        rig.studio.news = vec![refused(topics.brush_def("main"))];
        assert_eq!(rig.look(), strange("The node of the brush 'main'"));
    }

    #[test]
    fn that_the_processor_has_taken_over_is_told_and_a_choice_at_the_start_is_not() {
        let mut rig = Rig::new();
        rig.studio.news = ["backend cpu", "backend gpu A: B", "goes on"]
            .map(|what| News::Decided(what.to_owned()))
            .to_vec();
        assert_eq!(rig.look(), []);
        rig.studio.news = vec![News::Decided("backend cpu: the device is lost".into())];
        let told = fault("The paint is computed by the processor from now on: the device is lost");
        assert_eq!(rig.look(), told);
    }
}
