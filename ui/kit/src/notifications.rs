//! Notifications over the desk: errors with advice, and notes. A click dismisses an error; notes let the pointer
//! through.

use eframe::egui::{self, Align2, Area, Color32, Context, Frame, Id, Order, RichText};
use maulstick_rig::UserError;

/// Most notifications at once; the oldest is dropped.
const MOST: usize = 4;
/// Display times of a note and an error, s.
const NOTE_S: f64 = 3.0;
const FAULT_S: f64 = 12.0;
/// Width of the text, points.
const WIDTH: f32 = 360.0;

/// Severity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// A completed action.
    Note,
    /// Something was not done.
    Fault,
}

/// A notification.
#[derive(Clone, Debug, PartialEq)]
pub struct Notification {
    /// Severity.
    pub severity: Severity,
    /// The message.
    pub what: String,
    /// Advice; empty if there is none.
    pub help: String,
    /// Name of the value that it shows; the next one takes its place.
    topic: Option<&'static str>,
    /// Time of its end by the window's clock, s; `None` before it was first shown.
    until_s: Option<f64>,
}

/// The current notifications.
#[derive(Debug, Default)]
pub struct Notifications {
    shown: Vec<Notification>,
}

impl Notifications {
    /// Notifies that something was done.
    pub fn note(&mut self, what: impl Into<String>) {
        self.push(Severity::Note, what.into(), String::new());
    }

    /// Notifies of a value that keys change, in the place of the one before.
    pub fn value(&mut self, topic: &'static str, what: impl Into<String>) {
        self.shown.retain(|toast| toast.topic != Some(topic));
        self.note(what);
        if let Some(newest) = self.shown.last_mut() {
            newest.topic = Some(topic);
        }
    }

    /// Notifies of a failure, with a remedy.
    pub fn fault(&mut self, what: impl Into<String>, help: impl Into<String>) {
        self.push(Severity::Fault, what.into(), help.into());
    }

    /// Notifies of an error.
    pub fn of(&mut self, fault: &UserError) {
        self.fault(fault.what.clone(), fault.help.clone().unwrap_or_default());
    }

    /// Removes a notification whose cause is over.
    pub fn over(&mut self, what: &str) {
        self.shown.retain(|toast| toast.what != what);
    }

    /// The notifications, the oldest first.
    pub fn shown(&self) -> &[Notification] {
        &self.shown
    }

    /// A repeated notification restarts its time, and is not shown twice.
    fn push(&mut self, severity: Severity, what: String, help: String) {
        self.shown.retain(|toast| toast.what != what);
        if self.shown.len() >= MOST {
            self.shown.remove(0);
        }
        self.shown.push(Notification {
            severity,
            what,
            help,
            topic: None,
            until_s: None,
        });
    }

    /// Shows the notifications at the upper edge; a click removes one.
    pub fn show(&mut self, context: &Context) {
        let now = context.input(|input| input.time);
        for toast in &mut self.shown {
            let stays = match toast.severity {
                Severity::Note => NOTE_S,
                Severity::Fault => FAULT_S,
            };
            toast.until_s.get_or_insert(now + stays);
        }
        self.shown
            .retain(|toast| toast.until_s.is_none_or(|until| now < until));
        let Some(first) = self
            .shown
            .iter()
            .filter_map(|toast| toast.until_s)
            .reduce(f64::min)
        else {
            return;
        };
        context.request_repaint_after_secs((first - now) as f32);
        let mut gone = None;
        let faults = self
            .shown
            .iter()
            .any(|toast| toast.severity == Severity::Fault);
        Area::new(Id::unique("toasts"))
            .order(Order::Foreground)
            .interactable(faults)
            .anchor(Align2::CENTER_TOP, [0.0, 12.0])
            .show(context, |ui| {
                for (place, toast) in self.shown.iter().enumerate() {
                    let sign = match toast.severity {
                        Severity::Note => ui.visuals().widgets.noninteractive.bg_stroke.color,
                        Severity::Fault => Color32::from_rgb(214, 112, 48),
                    };
                    let frame = Frame::popup(ui.style()).stroke(egui::Stroke::new(1.5, sign));
                    let shown = frame.show(ui, |ui| {
                        ui.set_max_width(WIDTH);
                        ui.label(RichText::new(&toast.what).strong());
                        if !toast.help.is_empty() {
                            ui.label(&toast.help);
                        }
                    });
                    if shown.response.interact(egui::Sense::click()).clicked() {
                        gone = Some(place);
                    }
                    ui.add_space(6.0);
                }
            });
        if let Some(place) = gone {
            self.shown.remove(place);
        }
    }
}

#[cfg(test)]
mod tests {
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;

    use super::*;

    #[test]
    fn the_same_thing_is_told_once_and_the_oldest_goes() {
        let mut notifications = Notifications::default();
        for what in ["a", "b", "c", "a", "d", "e"] {
            notifications.note(what);
        }
        let told: Vec<&str> = notifications
            .shown()
            .iter()
            .map(|t| t.what.as_str())
            .collect();
        assert_eq!(told, ["c", "a", "d", "e"]);
    }

    #[test]
    fn a_value_takes_the_place_of_the_one_before() {
        let mut notifications = Notifications::default();
        notifications.value("width", "10 mm");
        notifications.note("saved");
        notifications.value("pressure", "50 %");
        notifications.value("width", "12 mm");
        let told = notifications.shown().iter().map(|toast| &*toast.what);
        assert_eq!(told.collect::<Vec<_>>(), ["saved", "50 %", "12 mm"]);
    }

    #[test]
    fn a_fault_says_what_to_do_and_goes_by_itself() {
        let mut notifications = Notifications::default();
        notifications.fault("the arm is gone", "plug it in");
        let show =
            |ui: &mut egui::Ui, notifications: &mut Notifications| notifications.show(ui.ctx());
        let mut harness = Harness::builder()
            .with_step_dt(1.0)
            .build_ui_state(show, notifications);
        harness.step();
        harness.get_by_label("the arm is gone");
        harness.get_by_label("plug it in");
        harness.run_steps(FAULT_S as usize + 2);
        assert!(harness.query_by_label("the arm is gone").is_none());
        assert!(harness.state().shown().is_empty());
    }
}
