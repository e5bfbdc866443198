//! A value that the rig has not confirmed yet.

/// Longest wait for an answer, s; then the rig's value is shown.
const WAITED_S: f64 = 2.0;

/// A value that may be in the hand.
#[derive(Clone, Debug)]
pub struct Pending<T> {
    asked: Option<(T, f64)>,
}

impl<T> Default for Pending<T> {
    fn default() -> Self {
        Self { asked: None }
    }
}

impl<T: Clone + PartialEq> Pending<T> {
    /// The value shown at `now_s` of the window's clock if the rig's own value is `actual`.
    pub fn shown(&mut self, now_s: f64, actual: &T) -> T {
        let waits = |(asked, until_s): &(T, f64)| asked != actual && now_s < *until_s;
        self.asked = self.asked.take().filter(waits);
        self.asked
            .as_ref()
            .map_or_else(|| actual.clone(), |(asked, _)| asked.clone())
    }

    /// Holds a value that was requested at `now_s`, or that is being dragged then.
    pub fn hold(&mut self, now_s: f64, value: T) {
        self.asked = Some((value, now_s + WAITED_S));
    }

    /// Discards the request: the rig's value is shown from now on.
    pub fn release(&mut self) {
        self.asked = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_asked_is_shown_until_it_is_so_or_nobody_answered() {
        let mut held = Pending::default();
        assert_eq!(held.shown(0.0, &1), 1);
        held.hold(0.0, 2);
        assert_eq!(held.shown(0.5, &1), 2, "the rig has not answered yet");
        assert_eq!(held.shown(0.6, &2), 2);
        assert_eq!(held.shown(0.7, &1), 1, "an undo after the answer is seen");
        held.hold(1.0, 3);
        assert_eq!(held.shown(1.0 + WAITED_S, &1), 1, "it was refused");
        held.hold(5.0, 4);
        held.release();
        assert_eq!(held.shown(5.0, &1), 1);
    }
}
