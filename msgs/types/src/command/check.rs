//! What a command may say.

use super::*;
use crate::scene::{FLOWS, STAINS_M};
use crate::stylus::FARTHEST_M;
use crate::topics::check_name;

impl Command {
    /// Checks names, paths and mixtures for their length, so that whoever answers may quote them,
    /// and that no surface is put out of reach.
    ///
    /// # Errors
    /// What is wrong, in few words.
    pub fn check(&self) -> Result<(), String> {
        match self {
            Self::Load { brush, mixture } => brush_name(brush).and_then(|()| short(mixture)),
            Self::Clean { brush } => brush_name(brush),
            Self::LoadBeside { brush, left, right } => {
                brush_name(brush).and_then(|()| [left, right].into_iter().try_for_each(short))
            }
            Self::Define { brush, toml } => {
                brush_name(brush).and_then(|()| match toml.len() > BRUSH_FILE_MAX {
                    true => Err(format!("a brush file of {} bytes is too long", toml.len())),
                    false => Ok(()),
                })
            }
            Self::Tune { tuning } => brush_name(&tuning.brush).and_then(|()| {
                let good =
                    STIFFNESS.contains(&tuning.stiffness) && (0.0..=1.0).contains(&tuning.wetness);
                match good {
                    true => Ok(()),
                    false => Err(format!(
                        "stiffness is {}, wetness {}, but must be 0.05 to 20 and 0 to 1",
                        tuning.stiffness, tuning.wetness
                    )),
                }
            }),
            Self::Take { brush, loads, .. } => {
                brush_name(brush).and_then(|()| loads.iter().try_for_each(short))
            }
            Self::Snapshot { path, ledger } => {
                let paths = std::iter::once(path).chain(ledger);
                match paths.map(String::len).find(|length| *length > PATH_MAX) {
                    Some(length) => Err(format!(
                        "a path of {length} bytes is longer than {PATH_MAX}"
                    )),
                    None => Ok(()),
                }
            }
            Self::Place { pose, .. } => {
                let near = |metres: &f64| metres.abs() <= FARTHEST_M;
                match pose.position_m.iter().all(near) {
                    true => Ok(()),
                    false => Err(format!(
                        "the surface's place is not within {FARTHEST_M} m of the desk's origin"
                    )),
                }
            }
            Self::Relight { light, .. } => light.check(),
            Self::Dry { share, name, .. } => drying_share(*share).and_then(|()| layer_name(name)),
            Self::DryRegion {
                share,
                name,
                region,
                ..
            } => drying_share(*share)
                .and_then(|()| layer_name(name))
                .and_then(|()| region.check()),
            Self::DryOver {
                ticks,
                name,
                region,
                ..
            } => match DRYING_TICKS.contains(ticks) {
                true => layer_name(name).and_then(|()| checked(region.as_ref())),
                false => Err("a drying takes a sixtieth of a second to a year".to_owned()),
            },
            Self::Wet { region, .. } => checked(region.as_ref()),
            Self::Opacity { opacity, .. } => opaque(*opacity),
            Self::LayerOpacity { layer, opacity } => {
                layer_name(layer).and_then(|()| opaque(*opacity))
            }
            Self::GroundSpectrum { spectrum, .. } => match spectrum.len() > SPECTRUM_MAX {
                true => Err(format!(
                    "a spectrum of {} bytes is too long",
                    spectrum.len()
                )),
                false => Ok(()),
            },
            Self::Undo { brush } | Self::Redo { brush } => {
                brush.as_deref().map_or(Ok(()), brush_name)
            }
            Self::Ground { ground: name, .. } | Self::Tooth { tooth: name, .. } => {
                match name.len() > PATH_MAX {
                    true => Err(format!("a name of {} bytes is too long", name.len())),
                    false => Ok(()),
                }
            }
            Self::Fill {
                mixture,
                thickness_m,
                ..
            } => film(*thickness_m).and_then(|()| short(mixture)),
            Self::FillWith {
                brush, thickness_m, ..
            } => film(*thickness_m).and_then(|()| brush_name(brush)),
            Self::Handle { handling } => brush_name(&handling.brush).and_then(|()| {
                if !FLOWS.contains(&handling.flow) {
                    return Err(format!(
                        "a flow of {} µm/mm, but it must be .001 to 100",
                        handling.flow * 1e3
                    ));
                }
                match handling.most_m == 0.0 {
                    true => Ok(()),
                    false => film(handling.most_m),
                }
            }),
            Self::Size { stain_m, .. } => match STAINS_M.contains(stain_m) {
                true => Ok(()),
                false => Err(format!(
                    "a stain of {} µm, but it must be 0 to 1000 µm",
                    stain_m * 1e6
                )),
            },
            Self::Piles { .. } => Ok(()),
            Self::Keep { name } | Self::Return { name } | Self::Forget { name } => {
                version_name(name)
            }
            Self::Branch { from, name } => [from, name]
                .into_iter()
                .try_for_each(|name| version_name(name)),
            Self::Mark | Self::StopDrying { .. } => Ok(()),
        }
    }
}

fn film(thickness_m: f64) -> Result<(), String> {
    match FILM_M.contains(&thickness_m) {
        true => Ok(()),
        false => Err(format!(
            "a film of {} µm, but it must be 1 to 5000 µm",
            thickness_m * 1e6
        )),
    }
}

fn brush_name(name: &str) -> Result<(), String> {
    check_name(name).map_err(|what| {
        if name.len() > 2 * PAINT_NAME_MAX {
            format!("a brush's name of {} bytes is too long", name.len())
        } else {
            format!("the brush's name {what}")
        }
    })
}

fn layer_name(name: &str) -> Result<(), String> {
    match name.len() > LAYER_NAME_MAX {
        true => Err(format!(
            "a layer's name of {} bytes is too long",
            name.len()
        )),
        false => Ok(()),
    }
}

fn drying_share(share: f32) -> Result<(), String> {
    match share > 0.0 && share <= 1.0 {
        true => Ok(()),
        false => Err(format!(
            "the share that dries is {share}, but must be above 0 to 1"
        )),
    }
}

fn opaque(opacity: f32) -> Result<(), String> {
    match (0.0..=1.0).contains(&opacity) {
        true => Ok(()),
        false => Err(format!("the opacity is {opacity}, but must be 0 to 1")),
    }
}

fn checked(region: Option<&Region>) -> Result<(), String> {
    region.map_or(Ok(()), Region::check)
}

fn version_name(name: &str) -> Result<(), String> {
    if name.trim().is_empty() || name.len() > VERSION_NAME_MAX || name.contains(char::is_control) {
        return Err(format!(
            "a version's name has 1 to {VERSION_NAME_MAX} bytes, and no line breaks"
        ));
    }
    Ok(())
}

fn short(mixture: &Mixture) -> Result<(), String> {
    if mixture.parts.len() > PARTS_MAX {
        let parts = mixture.parts.len();
        return Err(format!("a mixture of {parts} paints has over {PARTS_MAX}"));
    }
    let longest = mixture.parts.iter().map(|part| part.paint.len()).max();
    match longest.filter(|length| *length > PAINT_NAME_MAX) {
        Some(length) => Err(format!("a paint's name of {length} bytes is too long")),
        None => Ok(()),
    }
}
