//! Motion of the canvas by the free hand: samples of a 6-DOF mouse become edits of its place.
//!
//! Pushing right and up pans, pushing away from the desk zooms in, turning about the axis out of the desk turns the
//! canvas; all about the middle of the desk, where the painter looks. The commands go into the journal, so a replay
//! repeats the placements of the canvas.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver as Samples, RecvTimeoutError, SyncSender, sync_channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use glam::DVec3;
use maulstick_brush::placement::SurfacePlacement;
use maulstick_bus::typed::Receiver;
use maulstick_bus::{Bus, Qos, Queue, Wake};
use maulstick_num::exp;
use maulstick_rig::UserError;
use maulstick_rig::thread::start;
use maulstick_types::Edit;
use maulstick_types::control::ControlSample;
use maulstick_types::scene::{CANVAS, Scene};
use maulstick_types::wire::topics::Topics;

use maulstick_rig::command_client::CommandClient;

/// Pushed to the stop the canvas goes this fast, m/s.
const PAN_M_S: f64 = 0.2;
/// Pushed to the stop it grows by e this often a second.
const ZOOM_S: f64 = 1.0;
/// Turned to the stop it turns this fast, rad/s.
const TURN_S: f64 = 1.5;
/// Time between two commands while the hand pushes.
const PERIOD: Duration = Duration::from_millis(33);
/// Longest time for which a push counts, however late it is followed.
const LONGEST_PUSH: Duration = Duration::from_millis(100);
/// Longest wait of a command for its answer.
const PATIENCE: Duration = Duration::from_secs(2);
/// Time after which a command is sent again, and for which a daemon's end waits for it at most.
const ASK: Duration = Duration::from_millis(300);

/// Placement of a surface after a push of `dt` s.
#[must_use]
pub fn pushed(lie: &SurfacePlacement, control: &ControlSample, dt: f64) -> SurfacePlacement {
    // Slow where the push is light: the third power leaves the stops where they are.
    let eased = |value: f64| value * value * value;
    let [x, y, z] = control.push.map(eased);
    lie.zoomed(DVec3::ZERO, exp(z * ZOOM_S * dt))
        .turned(DVec3::ZERO, DVec3::Z, eased(control.turn[2]) * TURN_S * dt)
        .moved(DVec3::new(x, y, 0.0) * (PAN_M_S * dt))
}

/// True if the mouse is pushed or turned along an axis that moves the canvas.
#[must_use]
pub fn pushes(control: &ControlSample) -> bool {
    control.push != [0.0; 3] || control.turn[2] != 0.0
}

/// Sends the commands from a thread of its own: reading a device never waits for an answer.
pub struct CanvasMover {
    controls: Option<SyncSender<ControlSample>>,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl CanvasMover {
    /// A mover of the canvas of a rig.
    ///
    /// # Errors
    /// A [`UserError`] where the rig or the system refuses.
    pub fn start(bus: &Arc<dyn Bus>, topics: &Topics) -> Result<Self, UserError> {
        let wake = Wake::new();
        let topic = topics.scene();
        let mut scenes = Receiver::new(&**bus, &topic, Qos::Cached, Queue::Latest, &wake)?
            .checking(Scene::fault);
        let mut commander = CommandClient::new(Arc::clone(bus), topics).asking(ASK);
        let (controls, heard) = sync_channel(64);
        let stop = Arc::new(AtomicBool::new(false));
        let ends = Arc::clone(&stop);
        let run = move || {
            let stopped = || ends.load(Ordering::SeqCst);
            follow(
                &heard,
                || scenes.newest().and_then(|scene| canvas(&scene.message)),
                |command| commander.send(command, None, PATIENCE, &stopped).map(drop),
            );
        };
        Ok(Self {
            controls: Some(controls),
            stop,
            thread: Some(start("mover", run)?),
        })
    }

    /// Takes in a sample; one that finds no room is followed by the next.
    pub fn receive(&self, control: &ControlSample) {
        if let Some(controls) = &self.controls {
            controls.try_send(control.clone()).ok();
        }
    }
}

impl Drop for CanvasMover {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::SeqCst);
        self.controls = None;
        if let Some(thread) = self.thread.take() {
            thread.join().ok();
        }
    }
}

/// Follows the hand until the device's reader has ended; `shown` is the newest placement of the canvas in the scene.
fn follow(
    heard: &Samples<ControlSample>,
    mut shown: impl FnMut() -> Option<SurfacePlacement>,
    mut send: impl FnMut(Edit) -> Result<(), UserError>,
) {
    let mut lie: Option<SurfacePlacement> = None;
    while let Ok(mut control) = heard.recv() {
        // The placement is the scene's until the hand pushes, and our own while it does.
        lie = shown().or(lie);
        let mut moved = Instant::now();
        while pushes(&control) {
            // Commands keep their distance however often the device speaks; and however long one
            // takes, what the hand has done meanwhile is heard before the next.
            let due = moved + PERIOD;
            loop {
                match heard.recv_timeout(due.saturating_duration_since(Instant::now())) {
                    Ok(newest) => control = newest,
                    Err(RecvTimeoutError::Timeout) => break,
                    Err(RecvTimeoutError::Disconnected) => return,
                }
            }
            let Some(from) = lie.filter(|_| pushes(&control)) else {
                break;
            };
            let to = pushed(
                &from,
                &control,
                moved.elapsed().min(LONGEST_PUSH).as_secs_f64(),
            );
            moved = Instant::now();
            match to.edit(CANVAS).map_err(UserError::from).and_then(&mut send) {
                Ok(()) => lie = Some(to),
                Err(fault) => tracing::warn!("the canvas is not moved: {}", fault.what),
            }
        }
    }
}

fn canvas(scene: &Scene) -> Option<SurfacePlacement> {
    let surface = scene.surfaces.iter().find(|surface| surface.id == CANVAS)?;
    Some(SurfacePlacement::from(surface))
}

#[cfg(test)]
mod tests {
    use maulstick_brush::placement::{FARTHEST_M, ZOOMS};
    use maulstick_num::geometry::Rigid;

    use super::*;

    fn lie() -> SurfacePlacement {
        SurfacePlacement {
            pose: Rigid {
                translation: DVec3::new(-0.128, -0.128, 0.0),
                ..Rigid::IDENTITY
            },
            zoom: 1.0,
        }
    }

    /// The point of the surface at the middle of the desk, m.
    fn middle(lie: &SurfacePlacement) -> DVec3 {
        lie.pose.inverse().point(DVec3::ZERO) / lie.zoom
    }

    #[test]
    fn zoom_and_turn_keep_what_is_in_the_middle() {
        let mut control = ControlSample::at_rest();
        (control.push[2], control.turn[2]) = (0.7, -0.5);
        let mut now = lie();
        (0..200).for_each(|_| now = pushed(&now, &control, 0.033));
        assert!(now.zoom > 3.0, "{now:?}");
        assert!((middle(&now) - middle(&lie())).length() < 1e-12, "{now:?}");
        let quarter = now.pose.vector(DVec3::X);
        assert!(quarter.y < -0.1 && quarter.z == 0.0, "{quarter}");
        assert!(now.edit(CANVAS).is_ok());
    }

    #[test]
    fn a_push_pans_at_its_speed_and_a_light_one_more_slowly() {
        let pan = |by: f64| {
            let mut control = ControlSample::at_rest();
            control.push[0] = by;
            pushed(&lie(), &control, 0.5).pose.translation.x - lie().pose.translation.x
        };
        assert!((pan(1.0) - 0.1).abs() < 1e-12);
        assert!((pan(-0.5) + 0.0125).abs() < 1e-12);
        assert!(!pushes(&ControlSample::at_rest()));
    }

    #[test]
    fn whatever_is_pushed_the_canvas_stays_within_reach() {
        let mut control = ControlSample::at_rest();
        for sign in [1.0, -1.0] {
            control.push = [sign; 3];
            let mut now = lie();
            (0..2000).for_each(|_| now = pushed(&now, &control, 0.033));
            assert!((ZOOMS[0]..=ZOOMS[1]).contains(&now.zoom));
            assert!(now.pose.translation.abs().max_element() <= FARTHEST_M * ZOOMS[1]);
        }
    }

    #[test]
    fn a_zoom_beyond_what_a_hand_may_choose_stays_in_a_pan_and_comes_back_without_a_leap() {
        let mut control = ControlSample::at_rest();
        control.push[0] = 1.0;
        let far = SurfacePlacement {
            zoom: 0.05,
            ..lie()
        };
        assert_eq!(pushed(&far, &control, 0.033).zoom, 0.05);
        control.push[2] = 1.0;
        let nearer = pushed(&far, &control, 0.033).zoom;
        assert!(nearer > 0.05 && nearer < 0.06, "{nearer}");
        control.push[2] = -1.0;
        assert_eq!(pushed(&far, &control, 0.033).zoom, 0.05);
    }

    /// A paint node that takes longer than [`PERIOD`] for a command must not keep the canvas running
    /// once the hand has let go, nor the daemon once nobody can push any more.
    #[test]
    fn however_long_a_command_takes_the_hand_and_the_end_are_heard() {
        for letting_go in [Some(ControlSample::at_rest()), None] {
            let (hand, heard) = sync_channel(64);
            let mut push = ControlSample::at_rest();
            push.push[0] = 1.0;
            hand.send(push).expect("room");
            let (mut hand, mut letting_go, mut count) = (Some(hand), letting_go, 0);
            let slow = |_| {
                count += 1;
                assert!(count < 5, "the canvas runs on by itself");
                let over = Instant::now() + 2 * PERIOD;
                if let (Some(hand), Some(rest)) = (hand.take(), letting_go.take()) {
                    hand.send(rest).expect("room");
                }
                while Instant::now() < over {
                    std::thread::yield_now();
                }
                Err(UserError::failure("the node does not answer"))
            };
            follow(&heard, || Some(lie()), slow);
            assert_eq!(count, 1);
        }
    }
}
