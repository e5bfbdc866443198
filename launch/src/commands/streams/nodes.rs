//! `maulstick nodes`: the processes of a running rig.

use std::collections::BTreeSet;
use std::time::{Duration, Instant};

use clap::Args;
use maulstick_rig::UserError;
use serde_json::json;

use super::listener::Listener;
use crate::commands::client::Target;
use crate::commands::{print_json, print_text};

/// Options of `maulstick nodes`.
#[derive(Args, Clone, Debug)]
pub struct NodesOptions {
    /// Print JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    target: Target,
}

/// Time within which the nodes that live show themselves.
const PATIENCE: Duration = Duration::from_millis(500);

/// Lists them.
///
/// # Errors
/// A [`UserError`] where the rig does not run.
pub fn run(options: &NodesOptions) -> Result<i32, UserError> {
    let listener = Listener::open(&options.target, "scene")?;
    let member = &listener.member;
    let tokens = member.bus.watch(&member.topics.node("*"), &member.wake)?;
    let mut names = BTreeSet::new();
    let until = Instant::now() + PATIENCE;
    while Instant::now() < until && !listener.is_over() {
        while let Some(token) = tokens.try_recv() {
            let Some(name) = member.topics.node_of(&token.key) else {
                continue;
            };
            match token.present {
                true => names.insert(name.to_owned()),
                false => names.remove(name),
            };
        }
        member
            .wake
            .wait(until.saturating_duration_since(Instant::now()));
    }
    match options.json {
        true => print_json(&json!(names))?,
        false => {
            let lines: String = names.iter().map(|name| format!("{name}\n")).collect();
            print_text(&lines)?;
        }
    }
    Ok(0)
}
