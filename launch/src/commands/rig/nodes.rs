//! `maulstick node list`: the processes of a running rig, and their work.

use std::collections::{BTreeMap, BTreeSet};
use std::time::{Duration, Instant};

use clap::Args;
use maulstick_bus::typed::Receiver;
use maulstick_bus::{Qos, Queue};
use maulstick_recorder::Listener;
use maulstick_rig::UserError;
use maulstick_types::node::NodeStatus;
use serde_json::{Value, json};

use crate::commands::client::Target;
use crate::commands::table::table;
use crate::commands::{print_json, print_text};

/// Options of `maulstick node list`.
#[derive(Args, Clone, Debug)]
pub struct NodesOptions {
    /// Print JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    target: Target,
}

/// Time within which live nodes appear with their status.
const PATIENCE: Duration = Duration::from_nanos(NodeStatus::PERIOD_NS + 300_000_000);

/// Lists them.
///
/// # Errors
/// A [`UserError`] where the rig does not run.
pub fn run(options: &NodesOptions) -> Result<i32, UserError> {
    let listener = Listener::open(options.target.rig(), "scene")?;
    let (member, topics) = (&listener.member, &listener.member.topics);
    let tokens = member.bus.watch(&topics.node("*"), &member.wake)?;
    let (topic, queue) = (topics.node_status("*"), Queue::Ring(1024));
    let mut statuses =
        Receiver::<NodeStatus>::new(&*member.bus, &topic, Qos::Background, queue, &member.wake)?;
    let (mut nodes, mut said) = (BTreeSet::new(), BTreeMap::new());
    let until = Instant::now() + PATIENCE;
    while Instant::now() < until && !listener.is_over() {
        while let Some(token) = tokens.try_recv() {
            let Some(name) = topics.node_of(&token.key) else {
                continue;
            };
            if token.present {
                nodes.insert(name.to_owned())
            } else {
                nodes.remove(name)
            };
        }
        while let Some(status) = statuses.try_recv() {
            let name = topics.middle(&status.key).unwrap_or_default();
            said.insert(name.to_owned(), status.message);
        }
        member
            .wake
            .wait(until.saturating_duration_since(Instant::now()));
    }
    let nodes: Vec<(String, Option<NodeStatus>)> = nodes
        .into_iter()
        .map(|name| {
            let status = said.remove(&name);
            (name, status)
        })
        .collect();
    if options.json {
        print_json(&Value::Array(nodes.iter().map(to_json).collect()))?
    } else {
        print_text(&to_text(&nodes))?
    }
    Ok(0)
}

fn to_json((name, status): &(String, Option<NodeStatus>)) -> Value {
    let Some(NodeStatus {
        process,
        turns,
        work,
    }) = status
    else {
        return json!({ "name": name });
    };
    json!({
        "name": name,
        "process": process,
        "turns": turns,
        "consumed": work.consumed,
        "produced": work.produced,
        "waiting": work.waiting,
        "held": work.held,
        "refused": work.refused,
        "lost": work.lost,
        "too_fast": work.too_fast,
    })
}

/// The table; a node without a status has its name alone.
fn to_text(nodes: &[(String, Option<NodeStatus>)]) -> String {
    let head = [
        "node", "pid", "consumed", "sent", "waiting", "held", "refused", "lost", "too fast",
    ];
    let row = |(name, status): &(String, Option<NodeStatus>)| {
        let numbers = status.as_ref().map(|status| {
            let work = &status.work;
            [
                status.process.into(),
                work.consumed,
                work.produced,
                work.waiting,
                work.held,
                work.refused,
                work.lost,
                work.too_fast,
            ]
        });
        let cell = |place: usize| match &numbers {
            Some(numbers) => numbers[place].to_string(),
            None => "–".to_owned(),
        };
        std::array::from_fn(|column| match column.checked_sub(1) {
            None => name.clone(),
            Some(place) => cell(place),
        })
    };
    table(head, &nodes.iter().map(row).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use maulstick_types::node::NodeWork;

    use super::*;

    #[test]
    fn a_node_says_what_it_has_done_and_one_that_is_silent_is_there_too() {
        let status = NodeStatus {
            process: 41,
            turns: 2,
            work: NodeWork {
                consumed: 7,
                too_fast: 9,
                ..NodeWork::default()
            },
        };
        let nodes = [("brush-main", Some(status)), ("paint", None)];
        let nodes = nodes.map(|(name, status)| (name.to_owned(), status));
        let text = to_text(&nodes);
        let rows: Vec<Vec<&str>> = text
            .lines()
            .map(|row| row.split_whitespace().collect())
            .collect();
        assert_eq!(
            rows[1],
            ["brush-main", "41", "7", "0", "0", "0", "0", "0", "9"]
        );
        assert_eq!((rows[2][0], rows[2].len()), ("paint", 9));
        assert_eq!(to_json(&nodes[0])["too_fast"], 9);
        assert_eq!(to_json(&nodes[1]), json!({ "name": "paint" }));
    }
}
