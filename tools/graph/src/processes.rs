//! The graph: processes, and topics between them.

use std::collections::BTreeMap;

use maulstick_bus::Participant;
use maulstick_bus::participants::is_received;
use maulstick_rig::node_handle::HUB;
use maulstick_streams::topic_pattern::matches;
use maulstick_types::wire::topics::Topics;
use serde::Serialize;
use serde_json::{Value, json};

/// Stage of a process between the hand and the eye.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Stage {
    /// It sends samples of a hand.
    Device,
    /// It solves a brush.
    Brush,
    /// It paints.
    Paint,
    /// It shows, records or supervises.
    Viewer,
}

impl Stage {
    /// The stage of a process by its topics. The window, which also sends its mouse, is a viewer.
    fn of(sent: &[Sent]) -> Self {
        let sends = |pattern: &str| sent.iter().any(|sent| matches(pattern, &sent.topic));
        if sends("ui/**") {
            Self::Viewer
        } else if sends("brush/*/state") {
            Self::Brush
        } else if sends("paint/**") {
            Self::Paint
        } else if sends("stylus/**") || sends("control/**") {
            Self::Device
        } else {
            Self::Viewer
        }
    }
}

/// Statuses of nodes for the launcher: each node sends one, and they are no part of a stroke's path.
const STATUS: &str = "node/*/status";

/// A topic that a process sends.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Sent {
    /// The topic.
    pub topic: String,
    /// Messages a second of the topic, of all its senders; 0 where fewer than two came.
    pub rate_hz: f64,
}

impl Sent {
    /// The topic with its rate, if it has one.
    pub fn label(&self) -> String {
        match self.rate_hz {
            0.0 => self.topic.clone(),
            rate if rate < 10.0 => format!("{} {rate:.1}/s", self.topic),
            rate => format!("{} {rate:.0}/s", self.topic),
        }
    }
}

/// A process.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Process {
    /// Its name in the rig.
    pub name: String,
    /// Its stage.
    pub stage: Stage,
    /// Topics that it sends.
    pub sends: Vec<Sent>,
    /// Patterns of topics that it receives.
    pub receives: Vec<String>,
    /// Queries that it answers, except those for lost messages.
    pub answers: Vec<String>,
}

/// A stream from one process to another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Arrow {
    /// Place of the sender.
    pub from: usize,
    /// Index of the topic among the sender's.
    pub sent: usize,
    /// Place of the receiver.
    pub to: usize,
    /// Index of the pattern among the receiver's.
    pub received: usize,
}

/// Processes, and the arrows between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Graph {
    /// By stage, then by name.
    pub processes: Vec<Process>,
    /// By sender, topic and receiver.
    pub arrows: Vec<Arrow>,
}

impl Graph {
    /// The graph of a rig's participants, with rates by topic, messages a second.
    pub fn of(participants: &[Participant], rates: &BTreeMap<&str, f64>, topics: &Topics) -> Self {
        let relative = |key: &String| topics.relative(key).unwrap_or(key).to_owned();
        let process = |participant: &Participant| {
            let topics = participant.sends.iter().map(relative);
            let own = topics.filter(|topic| !matches(STATUS, topic));
            let sends = own.map(|topic| Sent {
                rate_hz: rates.get(topic.as_str()).copied().unwrap_or(0.0),
                topic,
            });
            let sends: Vec<Sent> = sends.collect();
            let answers = participant.answers.iter().map(relative);
            let receives = participant.receives.iter().map(relative);
            Process {
                name: match participant.name.as_deref() {
                    Some(HUB) => "launcher".to_owned(),
                    Some(name) => name.to_owned(),
                    None => format!("program {:.8}", participant.session),
                },
                stage: Stage::of(&sends),
                sends,
                receives: receives.filter(|topic| topic != STATUS).collect(),
                answers: answers.filter(|topic| !matches("gap/**", topic)).collect(),
            }
        };
        let mut processes: Vec<Process> = participants.iter().map(process).collect();
        processes.retain(|process| {
            !(process.sends.is_empty() && process.receives.is_empty() && process.answers.is_empty())
        });
        processes.sort_by(|a, b| (a.stage, &a.name).cmp(&(b.stage, &b.name)));
        let arrows = arrows(&processes);
        Self { processes, arrows }
    }

    /// What an arrow carries.
    pub fn sent(&self, arrow: &Arrow) -> &Sent {
        &self.processes[arrow.from].sends[arrow.sent]
    }

    /// The graph for programs.
    pub fn json(&self) -> Value {
        let arrow = |arrow: &Arrow| {
            json!({
                "from": self.processes[arrow.from].name,
                "to": self.processes[arrow.to].name,
                "topic": self.sent(arrow).topic,
                "rate_hz": self.sent(arrow).rate_hz,
            })
        };
        let arrows: Vec<Value> = self.arrows.iter().map(arrow).collect();
        json!({ "processes": self.processes, "arrows": arrows })
    }
}

fn arrows(processes: &[Process]) -> Vec<Arrow> {
    let mut arrows = Vec::new();
    for (from, sender) in processes.iter().enumerate() {
        for (sent, topic) in sender.sends.iter().enumerate() {
            for (to, receiver) in processes.iter().enumerate() {
                let mut patterns = receiver.receives.iter();
                let received = patterns.position(|pattern| is_received(pattern, &topic.topic));
                let arrow = received.filter(|_| to != from).map(|received| Arrow {
                    from,
                    sent,
                    to,
                    received,
                });
                arrows.extend(arrow);
            }
        }
    }
    arrows
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A participant of the rig `studio`.
    fn participant(name: &str, sends: &[&str], receives: &[&str], answers: &[&str]) -> Participant {
        let keys = |topics: &[&str]| {
            let keys = topics
                .iter()
                .map(|topic| format!("maulstick/studio/{topic}"));
            keys.collect()
        };
        Participant {
            session: format!("{name}0123456789"),
            name: (name != "x").then(|| name.to_owned()),
            process: None,
            sends: keys(sends),
            receives: keys(receives),
            answers: keys(answers),
        }
    }

    /// A rig with a window, a pen and a program of which only its topics are known.
    pub(crate) fn studio() -> Graph {
        let participants = [
            participant(
                "ui",
                &["ui/presented", "stylus/mouse/sample"],
                &["brush/*/state", "scene", "stylus/*/sample"],
                &[],
            ),
            participant("x", &["stylus/x/sample"], &["scene"], &[]),
            participant("hub", &[], &["scene"], &["command/rig"]),
            participant("cli", &[], &[], &[]),
            participant(
                "paint",
                &["paint/consumed", "scene"],
                &["brush/*/state"],
                &["gap/paint/journal", "paint/frame"],
            ),
            participant(
                "brush-main",
                &["brush/main/state"],
                &["stylus/*/sample", "paint/consumed"],
                &[],
            ),
        ];
        let rates = BTreeMap::from([("stylus/x/sample", 199.6), ("paint/consumed", 1.04)]);
        Graph::of(&participants, &rates, &Topics::new("studio"))
    }

    #[test]
    fn arrows_lead_from_who_sends_to_who_receives() {
        let graph = studio();
        let names: Vec<&str> = graph
            .processes
            .iter()
            .map(|own| own.name.as_str())
            .collect();
        assert_eq!(
            names,
            ["program x0123456", "brush-main", "paint", "launcher", "ui"]
        );
        let arrows: Vec<String> = graph
            .arrows
            .iter()
            .map(|arrow| {
                let sent = graph.sent(arrow);
                format!(
                    "{} > {} > {}",
                    names[arrow.from],
                    sent.label(),
                    names[arrow.to]
                )
            })
            .collect();
        assert_eq!(
            arrows,
            [
                "program x0123456 > stylus/x/sample 200/s > brush-main",
                "program x0123456 > stylus/x/sample 200/s > ui",
                "brush-main > brush/main/state > paint",
                "brush-main > brush/main/state > ui",
                "paint > paint/consumed 1.0/s > brush-main",
                "paint > scene > program x0123456",
                "paint > scene > launcher",
                "paint > scene > ui",
                "ui > stylus/mouse/sample > brush-main",
            ]
        );
        assert_eq!(graph.processes[2].answers, ["paint/frame"]);
    }
}
