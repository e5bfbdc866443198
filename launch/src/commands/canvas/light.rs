//! `maulstick canvas light`: the lamp over a running rig.

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use maulstick_appearance::light::changes_colour;
use maulstick_bus::Qos;
use maulstick_painting::edits::{Exposure, LightChange, common};
use maulstick_rig::UserError;
use maulstick_types::paint::PaintStatus;
use maulstick_types::scene::{Light, Scene};
use serde_json::json;

use maulstick_painting_setup::lamp::changed;

use crate::commands::client::{Client, Feed, Target};
use crate::commands::print_json;
use crate::commands::say;

/// Options of `maulstick canvas light`; absent ones are unchanged.
#[derive(Args, Clone, Debug)]
pub struct LightOptions {
    #[command(flatten)]
    change: LightChange,
    /// Print the light as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    target: Target,
}

impl LightOptions {
    /// The requested change.
    #[must_use]
    pub fn change(&self) -> &LightChange {
        &self.change
    }
}

/// Changes the light and waits until the dry layers are recomputed; without changes it only prints the light.
///
/// # Errors
/// A [`UserError`] for an invalid light, or if no rig runs.
pub(super) fn run(options: &LightOptions) -> Result<i32, UserError> {
    // An invalid change is refused even if no rig runs.
    let change = &options.change;
    changed(change, &Light::default())?;
    let client = Client::open(&options.target)?;
    let mut scenes: Feed<Scene> = client.follow(&client.topics().scene(), Qos::Cached)?;
    let before = scenes.wait_for_next()?.message.light;
    let mut light = changed(change, &before)?;
    let expose = match change.exposure {
        Some(chosen) => chosen == Exposure::Auto,
        None => changes_colour(&light, &before),
    };
    if light != before || expose {
        let mut statuses = client.follow(&client.topics().paint_status(), Qos::Background)?;
        client.send(if expose {
            common::relight_exposed(light)
        } else {
            common::relight(light)
        })?;
        wait_for_baking(&mut statuses, client.now_ns())?;
        light = scenes.wait_for_next()?.message.light;
    } else {
        light = before;
    }
    tell(&light, options)
}

/// Shows how far the dry layers are.
fn wait_for_baking(statuses: &mut Feed<PaintStatus>, since_ns: u64) -> Result<(), UserError> {
    let bar = ProgressBar::new(0).with_message("relighting");
    if let Ok(style) = ProgressStyle::with_template("{msg} {bar:40} {pos}/{len} tiles, {eta} left")
    {
        bar.set_style(style);
    }
    loop {
        let status = statuses.wait_for_next()?;
        if status.header.sent_ns < since_ns {
            continue;
        }
        let PaintStatus { baking, baked, .. } = status.message;
        bar.set_length(u64::from(baking));
        bar.set_position(u64::from(baked));
        if baked >= baking {
            bar.finish_and_clear();
            return Ok(());
        }
    }
}

fn tell(light: &Light, options: &LightOptions) -> Result<i32, UserError> {
    let Light {
        direction,
        intensity,
        exposure,
        relief,
        softness,
        samples,
        ..
    } = light;
    if options.json {
        print_json(&json!({
            "illuminant": light.illuminant, "observer": light.observer, "adapted": light.adapted,
            "rule": light.rule, "samples": samples, "direction": direction,
            "intensity": intensity, "exposure": exposure, "relief": relief, "softness": softness,
            "environment": light.environment.name(),
        }))?;
        return Ok(0);
    }
    let [x, y, z] = direction;
    let eye = if light.adapted {
        "adapted"
    } else {
        "not adapted"
    };
    say!(
        "{} from {x:.2}, {y:.2}, {z:.2}, {eye} observer of {}",
        light.illuminant,
        light.observer
    );
    say!("environment: {}", light.environment.name());
    say!("intensity {intensity}, exposure {exposure:.3}, relief {relief}, softness {softness}");
    match light.rule.as_str() {
        "reference" => say!("all 101 wavelengths"),
        rule => say!("{samples} wavelengths, {rule}"),
    }
    Ok(0)
}
