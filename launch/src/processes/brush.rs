//! The process of a brush: follows a stylus.

use std::collections::BTreeMap;
use std::sync::Arc;

use maulstick_brush_node::contact_model::ForceKind;
use maulstick_brush_node::{BrushDevices, BrushNode, BrushSettings};
use maulstick_bus::typed::random_epoch;
use maulstick_rig::UserError;
use maulstick_rig::config::{
    FOREIGN_PRIORITY, MOUSE_PRIORITY, PEN_PRIORITY, PLAYER_PRIORITY, RigConfig,
};
use maulstick_rig::node_handle::CONFIG_FILE;
use nix::sys::signal::Signal;

use maulstick_painting_setup::brush_file;

use super::{MOUSE, NodeOptions, PEN, PLAYER, brush_node_name};

/// Options of a brush node.
#[derive(clap::Args, Debug)]
pub(crate) struct BrushOptions {
    #[command(flatten)]
    node: NodeOptions,
    /// The brush of rig.toml
    #[arg(long, value_name = "BRUSH")]
    brush: String,
}

fn brush_settings(config: &RigConfig, brush: &str) -> Result<BrushSettings, UserError> {
    let section = config.brush_named(brush).ok_or_else(|| {
        let what = format!("there is no brush '{brush}' in rig.toml");
        UserError::unknown(
            what,
            brush,
            config.brush.iter().map(|brush| brush.name.as_str()),
        )
    })?;
    Ok(BrushSettings {
        name: brush.to_owned(),
        file: brush_file(section)?,
        depth_share: section.depth_share,
        devices: brush_devices(config, brush),
        epoch: random_epoch(),
    })
}

/// The devices of a rig, as a brush sees them.
fn brush_devices(config: &RigConfig, brush: &str) -> BrushDevices {
    let first = config.brush[0].name == brush;
    let mut priorities = BTreeMap::from([(PLAYER.to_owned(), PLAYER_PRIORITY)]);
    if first {
        priorities.insert(MOUSE.to_owned(), MOUSE_PRIORITY);
        priorities.insert(PEN.to_owned(), PEN_PRIORITY);
    }
    let (mut others, mut laws) = (Vec::new(), BTreeMap::new());
    for device in &config.device {
        if device.brush == brush {
            if let Some(law) = ForceKind::of(&device.force) {
                laws.insert(device.name.clone(), law);
            }
            priorities.insert(device.name.clone(), device.priority);
        } else {
            others.push(device.name.clone());
        }
    }
    BrushDevices {
        priorities,
        laws,
        others,
        foreign_priority: first.then_some(FOREIGN_PRIORITY),
    }
}

pub(super) fn run(options: &BrushOptions) -> Result<i32, UserError> {
    let mut member = options
        .node
        .join(&brush_node_name(&options.brush), Signal::SIGKILL)?;
    let settings = brush_settings(&member.config, &options.brush)?;
    let mut node = BrushNode::new(
        Arc::clone(&member.bus),
        &member.topics,
        &member.wake,
        settings,
    )?;
    member.ready()?;
    let (path, brush) = (member.folder.join(CONFIG_FILE), &options.brush);
    let modified = || {
        std::fs::metadata(&path)
            .and_then(|data| data.modified())
            .ok()
    };
    let mut seen = modified();
    member.run(|| {
        // The launcher rewrites them when a device is added, removed or changed.
        let newest = modified();
        if newest != seen {
            seen = newest;
            match RigConfig::read(&path) {
                Ok(config) => node.set_devices(brush_devices(&config, brush)),
                Err(fault) => tracing::warn!("the rig's settings: {fault}"),
            }
        }
        let wait = node.poll()?;
        member.work.set(node.work());
        Ok(wait)
    })?;
    member.leave();
    Ok(0)
}
