//! The cleaning key: a tap cleans the brush; while it is held the brush lifts paint.

use maulstick_painting::edits::common;
use maulstick_types::scene::{BrushHandling, BrushMode};

use maulstick_client::request::Request;

use crate::rig::requests::Requests;

/// Longest press that counts as a tap, s.
const TAP_S: f64 = 0.25;

/// The key that is down.
#[derive(Clone, Debug)]
struct Down {
    since_s: f64,
    /// The brush, and how it was used before it began to lift.
    brush: String,
    before: Option<BrushHandling>,
}

#[derive(Debug, Default)]
pub(crate) struct CleanKey {
    down: Option<Down>,
    /// Its requests, also within a stroke.
    requests: Requests,
}

impl CleanKey {
    /// Follows the key at a time of the window, s; `painting` while the brush touches something, `now` is
    /// how the brush in hand is used.
    pub(crate) fn follow(
        &mut self,
        now_s: f64,
        is_down: bool,
        painting: bool,
        now: &BrushHandling,
    ) {
        let requests = &mut self.requests;
        if !is_down {
            match self.down.take() {
                Some(Down {
                    before: Some(handling),
                    ..
                }) => handle(requests, &handling),
                Some(Down { brush, .. }) => {
                    if let Ok(clean) = common::clean(&brush) {
                        requests.send(clean);
                    }
                }
                None => {}
            }
            return;
        }
        let down = self.down.get_or_insert_with(|| Down {
            since_s: now_s,
            brush: now.brush.clone(),
            before: None,
        });
        if down.before.is_none() && (painting || now_s - down.since_s > TAP_S) {
            down.before = Some(now.clone());
            let lifts = BrushHandling {
                mode: BrushMode::Vacuum,
                ..now.clone()
            };
            handle(requests, &lifts);
        }
    }

    /// Takes its requests.
    #[must_use]
    pub(crate) fn take(&mut self) -> Vec<Request> {
        self.requests.take()
    }

    /// True while the key is down: it has to be checked again soon.
    #[must_use]
    pub(crate) fn is_down(&self) -> bool {
        self.down.is_some()
    }
}

/// Uses a brush so.
fn handle(requests: &mut Requests, handling: &BrushHandling) {
    if let Ok(edit) = common::handle(handling) {
        requests.send(edit);
    }
}

#[cfg(test)]
mod tests {
    use maulstick_painting::edits::{Clean, Handle};
    use maulstick_types::command::Command;
    use maulstick_types::values::BrushName;

    use super::*;

    fn asked(steps: &[(f64, bool, bool)]) -> Vec<Command> {
        let now = BrushHandling {
            mode: BrushMode::NoPush,
            ..BrushHandling::normal("main")
        };
        let mut key = CleanKey::default();
        for (at, down, painting) in steps {
            key.follow(*at, *down, *painting, &now);
        }
        let command = |order| match order {
            Request::Command { command, .. } => command,
            Request::Force { .. } => panic!("no force"),
        };
        key.take().into_iter().map(command).collect()
    }

    fn modes(commands: &[Command]) -> Vec<BrushMode> {
        let mode = |command: &Command| command.edit::<Handle>().expect("a mode").mode;
        commands.iter().map(mode).collect()
    }

    #[test]
    fn a_tap_cleans_and_a_held_key_lifts_until_it_is_let_go() {
        let tap = asked(&[(0.0, true, false), (0.1, true, false), (0.12, false, false)]);
        let brush = BrushName::main();
        assert_eq!(tap, [Command::from(Clean { brush })]);
        let held = [BrushMode::Vacuum, BrushMode::NoPush];
        let long = asked(&[(0.0, true, false), (0.3, true, false), (0.5, false, false)]);
        assert_eq!(modes(&long), held);
        let stroke = asked(&[(0.0, true, true), (0.05, true, true), (0.1, false, true)]);
        assert_eq!(modes(&stroke), held, "in a stroke at once");
        assert!(asked(&[(0.0, false, true)]).is_empty());
    }
}
