//! What the runtime remembers.

use std::collections::VecDeque;
use std::sync::{Mutex, PoisonError};

use crate::script::{Call, Script};

/// An action of the program.
#[derive(Default)]
pub(crate) struct Action {
    /// For each profile, the path that it is bound to.
    bindings: Vec<(String, String)>,
}

/// All of it.
#[derive(Default)]
pub(crate) struct State {
    pub(crate) script: Script,
    pub(crate) calls: Vec<Call>,
    pub(crate) states: VecDeque<i32>,
    /// Texts that have become paths; the first is path 1.
    texts: Vec<String>,
    actions: Vec<Action>,
    is_attached: bool,
    is_synced: bool,
}

static STATE: Mutex<Option<State>> = Mutex::new(None);

/// The state, for a moment.
pub(crate) fn with<T>(work: impl FnOnce(&mut State) -> T) -> T {
    let mut state = STATE.lock().unwrap_or_else(PoisonError::into_inner);
    work(state.get_or_insert_default())
}

impl State {
    /// The device is another from now on.
    pub(crate) fn change(&mut self, script: Script) {
        self.states.extend(&script.states);
        self.script = script;
    }

    /// A new instance knows nothing of the one before.
    pub(crate) fn begin(&mut self) {
        let script = std::mem::take(&mut self.script);
        let calls = std::mem::take(&mut self.calls);
        *self = Self {
            states: script.states.iter().copied().collect(),
            script,
            calls,
            ..Self::default()
        };
    }

    /// The path of a text.
    pub(crate) fn path(&mut self, text: String) -> u64 {
        let known = self.texts.iter().position(|other| *other == text);
        let place = known.unwrap_or_else(|| {
            self.texts.push(text);
            self.texts.len() - 1
        });
        place as u64 + 1
    }

    fn text(&self, path: u64) -> Option<&String> {
        self.texts.get(path.checked_sub(1)? as usize)
    }

    /// A new action; the first is 1.
    pub(crate) fn action(&mut self) -> u64 {
        self.actions.push(Action::default());
        self.actions.len() as u64
    }

    /// Binds actions of a profile; what the runtime says.
    pub(crate) fn suggest(&mut self, profile: u64, bindings: &[(u64, u64)]) -> Suggested {
        let Some(profile) = self.text(profile).cloned() else {
            return Suggested::Invalid;
        };
        if !self.script.profiles.contains(&profile) {
            return Suggested::Unsupported;
        }
        for (action, path) in bindings {
            let text = self.text(*path).cloned();
            let action = self.actions.get_mut(action.wrapping_sub(1) as usize);
            let (Some(text), Some(action), false) = (text, action, self.is_attached) else {
                return Suggested::Invalid;
            };
            action.bindings.push((profile.clone(), text));
        }
        Suggested::Taken
    }

    pub(crate) fn attach(&mut self) {
        self.is_attached = true;
    }

    pub(crate) fn sync(&mut self) {
        self.is_synced = self.is_attached;
    }

    /// What the controller in hand has for an action.
    pub(crate) fn part(&self, action: u64) -> Option<&String> {
        let action = self.actions.get(action.checked_sub(1)? as usize)?;
        let of_hand = |(profile, _): &&(String, String)| *profile == self.script.profile;
        action.bindings.iter().find(of_hand).map(|(_, path)| path)
    }

    /// How far the part of an action is pressed; none where it is not active.
    pub(crate) fn pressed(&self, action: u64) -> Option<f32> {
        let part = self.part(action).filter(|_| self.is_synced)?;
        Some(self.script.inputs.get(part).copied().unwrap_or_default())
    }
}

/// What becomes of suggested bindings.
pub(crate) enum Suggested {
    Taken,
    Unsupported,
    Invalid,
}
