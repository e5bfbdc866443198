//! `maulstick light`: the lamp over a running rig.

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use maulstick_appearance::light::changes_colour;
use maulstick_bus::Qos;
use maulstick_rig::UserError;
use maulstick_types::command::Command;
use maulstick_types::paint::PaintStatus;
use maulstick_types::scene::{Light, Scene};
use serde_json::json;

use crate::commands::print_json;
use crate::commands::say;
use crate::commands::session::{Feed, PAINT, Session, Target};
use crate::lamp::LightChange;

/// Options of `maulstick light`; what is not given stays as it is.
#[derive(Args, Clone, Debug)]
pub struct LightOptions {
    /// Spectrum: A, D50, D65, FL2, FL8, FL11, or a CSV file of nm,power
    #[arg(long, value_name = "NAME|FILE")]
    illuminant: Option<String>,
    /// Direction toward the lamp: right, up the canvas, out of it
    #[arg(long, value_name = "X,Y,Z", value_parser = three, allow_hyphen_values = true)]
    direction: Option<[f64; 3]>,
    /// Factor on the strength of the light
    #[arg(long, allow_negative_numbers = true)]
    intensity: Option<f64>,
    /// Exposure; auto: the bare canvas just does not clip. Another spectrum starts with auto
    #[arg(long, value_name = "FACTOR|auto", value_parser = exposure, allow_negative_numbers = true)]
    exposure: Option<Exposure>,
    /// Factor on the slopes of the relief
    #[arg(long, allow_negative_numbers = true)]
    relief: Option<f64>,
    /// Softness of shadows: tangent of half the angle under which the lamp is seen
    #[arg(long, allow_negative_numbers = true)]
    softness: Option<f64>,
    /// CIE observer
    #[arg(long, value_name = "1931|1964")]
    observer: Option<u32>,
    /// Wavelength rule: fitted, gauss, reference
    #[arg(long)]
    rule: Option<String>,
    /// Number of wavelengths, 4 to 16
    #[arg(long)]
    samples: Option<u32>,
    /// Adapt colours to the white of the light (white balance)
    #[arg(long, value_name = "true|false")]
    adapt: Option<bool>,
    /// Print the light as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    target: Target,
}

impl LightOptions {
    /// The requested change.
    fn change(&self) -> LightChange {
        LightChange {
            illuminant: self.illuminant.clone(),
            direction: self.direction,
            intensity: self.intensity,
            exposure: match self.exposure {
                Some(Exposure::Factor(factor)) => Some(factor),
                _ => None,
            },
            relief: self.relief,
            softness: self.softness,
            observer: self.observer,
            rule: self.rule.clone(),
            samples: self.samples,
            adapted: self.adapt,
        }
    }
}

/// Of the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Exposure {
    Auto,
    Factor(f64),
}

fn exposure(text: &str) -> Result<Exposure, String> {
    match text.parse() {
        Ok(factor) => Ok(Exposure::Factor(factor)),
        Err(_) if text == "auto" => Ok(Exposure::Auto),
        Err(_) => Err("give a number, or auto".to_owned()),
    }
}

/// Reads `x,y,z`.
fn three(text: &str) -> Result<[f64; 3], String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|cell| cell.trim().parse()).collect();
    numbers
        .ok()
        .and_then(|numbers| numbers.try_into().ok())
        .ok_or_else(|| format!("'{text}' is not three numbers such as -0.5,0.5,0.7"))
}

/// Changes the light and waits until the dry layers are computed anew; without changes it only prints the light.
///
/// # Errors
/// A [`UserError`] for an invalid light, or if no rig runs.
pub fn run(options: &LightOptions) -> Result<i32, UserError> {
    // An invalid change is refused even if no rig runs.
    let change = options.change();
    change.on(&Light::default())?;
    let session = Session::open(&options.target)?;
    let mut scenes: Feed<Scene> = session.follow(&session.topics().scene(), Qos::Cached)?;
    let before = scenes.hear()?.message.light;
    let mut light = change.on(&before)?;
    let expose = match options.exposure {
        Some(chosen) => chosen == Exposure::Auto,
        None => changes_colour(&light, &before),
    };
    if light != before || expose {
        let mut statuses = session.follow(&session.topics().paint_status(), Qos::Background)?;
        session.send(PAINT, Command::Relight { light, expose })?;
        wait_for_baking(&mut statuses, session.now_ns())?;
        light = scenes.hear()?.message.light;
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
        let status = statuses.hear()?;
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
    say!("intensity {intensity}, exposure {exposure:.3}, relief {relief}, softness {softness}");
    match light.rule.as_str() {
        "reference" => say!("all 101 wavelengths"),
        rule => say!("{samples} wavelengths, {rule}"),
    }
    Ok(0)
}
