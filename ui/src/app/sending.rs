//! Requests on their way to the rig, in their order among the strokes; what has to wait for a brush to lift, or is
//! refused until then.

use std::time::Duration;

use eframe::egui::Context;

use super::App;
use crate::rig::state::BrushContact;
use crate::widgets::context::PanelContext;
use maulstick_client::request::Request;

/// Interval at which a request that waits for its stroke is checked again.
const BARRIER_LOOK: Duration = Duration::from_millis(50);

impl App {
    /// Sends the requests whose preceding strokes are painted.
    pub(super) fn send(&mut self, context: &Context) {
        let now_ns = self.bus.now_ns();
        let is_shown = self.shows_devices();
        let orders = self.requests.take_device_orders();
        let told = (&mut self.rig, &mut self.notifications);
        self.device_commands.turn(context, orders, is_shown, told);
        let orders = self.requests.take_session_orders();
        let told = (&mut self.rig, &mut self.notifications);
        self.session_processes.turn(context, orders, told);
        // The mouse's samples until then are sent, and those of others heard.
        let heard_ns = self.tracker.heard_until_ns().min(now_ns);
        let asked_ns = self.rig.live.now_ns.max(heard_ns);
        for follow_up in self.requests.take_follow_ups() {
            self.barrier.push_follow_up(follow_up);
        }
        // The cleaning key acts within a stroke, and so does the free hand.
        let mut within = self.clean_key.take();
        within.append(&mut self.navigation.take());
        let contact = match self.holds_desk() {
            true => BrushContact::Held,
            false => BrushContact::Lifted,
        };
        let asked = self.requests.take();
        for request in self.held_places.release(contact, asked, &within) {
            if !self.refuses(&request) {
                let newest = self.tracker.newest(now_ns);
                self.barrier.push(now_ns, (request, asked_ns), newest);
            }
        }
        for request in within {
            let newest = self.tracker.newest(now_ns);
            self.barrier.push(now_ns, (request, asked_ns), newest);
        }
        while let Some(ready) = self.barrier.next_ready(now_ns) {
            self.dispatcher.send(ready);
        }
        let oldest = [self.barrier.oldest_ns(), self.dispatcher.oldest_ns()];
        let since_ns = oldest.into_iter().flatten().min();
        if let Err(error) = self.pending.send(now_ns, since_ns) {
            tracing::warn!("the brushes are not told what is pending: {error}");
        }
        if self.barrier.is_waiting() || since_ns.is_some() {
            context.request_repaint_after(BARRIER_LOOK);
        }
    }

    /// Whether the hand has the brush of the panels on a surface. What the mouse's own samples say comes late.
    pub(super) fn contact(&self) -> BrushContact {
        let name = self.rig.brush_name();
        let is_held = match self.tracker.is_led_by_mouse(name) {
            true => self.pointer_path.is_pressed(),
            false => self.tracker.aim(name).is_some_and(|(_, in_air)| !in_air),
        };
        match is_held {
            true => BrushContact::Held,
            false => BrushContact::Lifted,
        }
    }

    /// True while a brush touches the desk: neither the view nor a surface is moved under it, whoever asks for that, but
    /// for the painter's free hand.
    pub(super) fn holds_desk(&self) -> bool {
        self.pointer_path.is_pressed() || self.tracker.touches()
    }

    /// True if a request is refused: the brush is not changed while the hand has it on a surface.
    fn refuses(&mut self, request: &Request) -> bool {
        let work = &mut PanelContext {
            rig: &mut self.rig,
            requests: &mut self.requests,
            preferences: &mut self.preferences,
            notifications: &mut self.notifications,
        };
        work.refuses(request)
    }
}
