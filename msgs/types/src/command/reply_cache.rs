//! The newest reply to each client: a command that is sent again is answered again, not done again. The sequencer's is
//! saved with the painting.

use std::cmp::Ordering;
use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::command::{CommandRequest, Outcome};

/// Clients whose newest answer is kept. A client repeats within seconds; of more clients than these the
/// one that was answered longest ago is forgotten.
const CLIENTS: usize = 256;

/// The newest answer to each client.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ReplyCache {
    newest: BTreeMap<u64, Answer>,
    answers: u64,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Answer {
    number: u64,
    outcome: Outcome,
    age: u64,
}

impl ReplyCache {
    /// The answer to this very command, or the refusal of one that comes after a later one of its client.
    #[must_use]
    pub fn find(&self, request: &CommandRequest) -> Option<Outcome> {
        let newest = self.newest.get(&request.client)?;
        match newest.number.cmp(&request.number) {
            Ordering::Less => None,
            Ordering::Equal => Some(newest.outcome.clone()),
            Ordering::Greater => Some(Outcome::refused(
                format!(
                    "command {} comes after command {}",
                    request.number, newest.number
                ),
                "number commands upward",
            )),
        }
    }

    /// The number of the newest command of a client that was answered.
    #[must_use]
    pub fn newest(&self, client: u64) -> Option<u64> {
        self.newest.get(&client).map(|answer| answer.number)
    }

    /// Keeps what became of command `number` of a client.
    pub fn keep(&mut self, client: u64, number: u64, outcome: Outcome) {
        if self.newest.len() >= CLIENTS && !self.newest.contains_key(&client) {
            let oldest = self.newest.iter().min_by_key(|(_, answer)| answer.age);
            if let Some(oldest) = oldest.map(|(client, _)| *client) {
                self.newest.remove(&oldest);
            }
        }
        self.answers += 1;
        let answer = Answer {
            number,
            outcome,
            age: self.answers,
        };
        self.newest.insert(client, answer);
    }
}

#[cfg(test)]
mod tests {
    use crate::command::TakeCommand;

    use super::*;

    fn request(client: u64, number: u64) -> CommandRequest {
        CommandRequest {
            client,
            number,
            after: None,
            command: TakeCommand::Mark.into(),
        }
    }

    #[test]
    fn the_oldest_answer_goes_and_a_later_command_is_another_one() {
        let mut replies = ReplyCache::default();
        for client in 0..CLIENTS as u64 {
            replies.keep(client, 1, Outcome::Waiting);
        }
        replies.keep(0, 2, Outcome::Waiting);
        replies.keep(1000, 1, Outcome::Waiting);
        assert_eq!(replies.find(&request(0, 2)), Some(Outcome::Waiting));
        assert!(
            matches!(replies.find(&request(0, 1)), Some(Outcome::Refused { .. })),
            "too late"
        );
        assert_eq!(replies.find(&request(0, 3)), None);
        assert_eq!(replies.find(&request(1, 1)), None, "answered longest ago");
        assert!(replies.find(&request(1000, 1)).is_some());
    }
}
