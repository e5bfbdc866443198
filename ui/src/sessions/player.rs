//! A replay in progress.

use std::time::Duration;

use eframe::egui::Context;
use maulstick_recorder::{Order, Player, RecorderError, ReplaySettings};
use maulstick_ui_kit::notifications::Notifications;
use tokio::runtime::Runtime;

use crate::dialogs::paths;
use crate::rig::state::RigState;
use crate::sessions::progress::ReplayProgress;

/// Interval at which reports are looked for.
const LOOK: Duration = Duration::from_millis(200);

/// Plays a recording or a take.
pub(super) fn start(runtime: &Runtime, settings: ReplaySettings, rig: &mut RigState) -> Player {
    rig.replay = Some(ReplayProgress::new(&settings.recording));
    Player::start(runtime.handle(), &rig.live.name, settings)
}

/// Sends an order; the slider stays where it was let go until the player says where it is.
pub(super) fn send(player: &Player, order: Order, rig: &mut RigState) {
    player.order(order);
    if let (Order::Seek(seconds), Some(replay)) = (order, &mut rig.replay)
        && let Some(position) = &mut replay.position
    {
        position.position_s = seconds;
    }
}

/// Takes what the player reports, and notifies of its end; true then.
pub(super) fn poll(
    player: &mut Player,
    context: &Context,
    rig: &mut RigState,
    notifications: &mut Notifications,
) -> bool {
    let result = player.result();
    let Some(replay) = &mut rig.replay else {
        return true;
    };
    while let Ok(report) = player.events.try_recv() {
        replay.update(report);
    }
    let Some(result) = result else {
        context.request_repaint_after(LOOK);
        return false;
    };
    notify_end(result, replay, notifications);
    rig.replay = None;
    true
}

fn notify_end(
    result: Result<(), RecorderError>,
    replay: &ReplayProgress,
    notifications: &mut Notifications,
) {
    match (result, &replay.painting) {
        (Ok(()), Some(painting)) => {
            let file = paths::shown(painting);
            notifications.note(tr!("The recording is painted in {file}.", file));
        }
        (Ok(()), None) => {
            let name = paths::name(&replay.recording);
            notifications.note(tr!("{name} has been played.", name));
        }
        (Err(error), _) => notifications.of(&error.into()),
    }
}
