//! What a command may say.

use super::*;
use crate::scene::{FLOWS, STAINS_M, WellKind};
use crate::stylus::FARTHEST_M;
use crate::topics::check_name;

impl Command {
    /// Checks names, paths and mixtures for their length, so that whoever answers may quote them,
    /// and that no surface is put out of reach.
    ///
    /// # Errors
    /// What is wrong and what to do, in few words, as [`parted`](crate::advice::parted) tells them apart.
    pub fn check(&self) -> Result<(), String> {
        match self {
            Self::Load { brush, mixture } => brush_name(brush).and_then(|()| short(mixture)),
            Self::Clean { brush } => brush_name(brush),
            Self::LoadBeside { brush, left, right } => {
                brush_name(brush).and_then(|()| [left, right].into_iter().try_for_each(short))
            }
            Self::Define { brush, toml } => {
                brush_name(brush).and_then(|()| match toml.len() > BRUSH_FILE_MAX {
                    true => Err(format!(
                        "a brush file of {} bytes; give one of at most {BRUSH_FILE_MAX}",
                        toml.len()
                    )),
                    false => Ok(()),
                })
            }
            Self::Tune { tuning } => brush_name(&tuning.brush).and_then(|()| {
                let good =
                    STIFFNESS.contains(&tuning.stiffness) && (0.0..=1.0).contains(&tuning.wetness);
                match good {
                    true => Ok(()),
                    false => Err(format!(
                        "a stiffness of {} and a wetness of {}; choose 0.05 to 20, and 0 to 1",
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
                        "a path of {length} bytes; give one of at most {PATH_MAX}"
                    )),
                    None => Ok(()),
                }
            }
            Self::Place { pose, .. } => {
                let near = |metres: &f64| metres.abs() <= FARTHEST_M;
                match pose.position_m.iter().all(near) {
                    true => Ok(()),
                    false => Err(format!(
                        "the surface is out of reach; place it within {FARTHEST_M} m of the desk's origin"
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
                false => Err(format!(
                    "a drying that takes {ticks} sixtieths of a second; choose one to a year"
                )),
            },
            Self::Wet { region, .. } => checked(region.as_ref()),
            Self::Opacity { opacity, .. } => opaque(*opacity),
            Self::LayerOpacity { layer, opacity } => {
                layer_name(layer).and_then(|()| opaque(*opacity))
            }
            Self::NameLayer { name, .. } => layer_name(name).and_then(|()| {
                match name.trim().is_empty() || name.contains(char::is_control) {
                    true => Err(
                        "a layer cannot be called this; give it letters, and no line breaks".into(),
                    ),
                    false => Ok(()),
                }
            }),
            Self::GroundSpectrum { spectrum, .. } => match spectrum.len() > SPECTRUM_MAX {
                true => Err(format!(
                    "a spectrum of {} bytes; give one of at most {SPECTRUM_MAX}",
                    spectrum.len()
                )),
                false => Ok(()),
            },
            Self::Undo { brush } | Self::Redo { brush } => {
                brush.as_deref().map_or(Ok(()), brush_name)
            }
            Self::Ground { ground: name, .. } | Self::Tooth { tooth: name, .. } => {
                match name.len() > PATH_MAX {
                    true => Err(format!(
                        "a name of {} bytes; give one of at most {PATH_MAX}",
                        name.len()
                    )),
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
                        "a flow of {} µm/mm; choose .001 to 100",
                        micrometres(handling.flow * 1e-3)
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
                    "a stain of {} µm; choose 0 to 1000 µm",
                    micrometres(*stain_m)
                )),
            },
            Self::Piles { .. } => Ok(()),
            Self::Wells { wells, .. } => match wells.len() > WELLS_MAX {
                true => Err(format!(
                    "a palette of {} wells; give one of at most {WELLS_MAX}",
                    wells.len()
                )),
                false => wells.iter().try_for_each(well),
            },
            Self::Keep { name } | Self::Return { name } | Self::Forget { name } => {
                version_name(name)
            }
            Self::Branch { from, name } => [from, name]
                .into_iter()
                .try_for_each(|name| version_name(name)),
            Self::Open { path, .. } | Self::SaveAs { path, .. } => whole_path(path),
            Self::New { path, canvas, .. } => path
                .as_deref()
                .map_or(Ok(()), whole_path)
                .and_then(|()| canvas.check()),
            Self::Export { order } => order.check(),
            Self::Mark | Self::StopDrying { .. } | Self::StopExport => Ok(()),
        }
    }
}

impl NewCanvas {
    /// Checks that it can be made: whether there are such a ground and tooth is seen later.
    ///
    /// # Errors
    /// As [`Command::check`].
    pub fn check(&self) -> Result<(), String> {
        for name in [&self.ground, &self.tooth] {
            if name.is_empty() || name.len() > PATH_MAX {
                return Err(format!(
                    "a ground or tooth with a name of {} bytes; give one of 1 to {PATH_MAX}",
                    name.len()
                ));
            }
        }
        if !CELLS_M.contains(&self.cell_m) {
            return Err(format!(
                "cells of {} mm; choose .01 to 10 mm",
                self.cell_m * 1e3
            ));
        }
        let [width, height] = [self.width_m, self.height_m].map(|side| side / self.cell_m);
        if !(CELLS.contains(&width) && CELLS.contains(&height)) {
            let [most, least] = [65_536.0, 1.0].map(|cells| cells * self.cell_m * 100.0);
            return Err(format!(
                "a canvas of {}×{} cm; with cells of {} mm choose {least:.3} to {most:.0} cm either way",
                self.width_m * 100.0,
                self.height_m * 100.0,
                self.cell_m * 1e3
            ));
        }
        match width * height <= CELLS_IN_ALL {
            true => Ok(()),
            false => Err(format!(
                "a canvas of {:.0} million cells; choose a smaller one or larger cells: {:.0} million are the most",
                width * height * 1e-6,
                CELLS_IN_ALL * 1e-6
            )),
        }?;
        match STAINS_M.contains(&self.stain_m) {
            true => Ok(()),
            false => Err(format!(
                "a stain of {} µm; choose 0 to 1000 µm",
                micrometres(self.stain_m)
            )),
        }
    }
}

impl ExportOrder {
    /// Checks path, format and numbers: whether it can be written is seen later.
    ///
    /// # Errors
    /// As [`Command::check`].
    pub fn check(&self) -> Result<(), String> {
        whole_path(&self.path)?;
        let names = [&self.format, &self.profile, &self.gamut];
        if names.iter().any(|name| name.len() > PAINT_NAME_MAX) {
            return Err("a format, profile or gamut of that length; choose a known one".to_owned());
        }
        match [8, 16].contains(&self.bits) {
            true => Ok(()),
            false => Err(format!(
                "a PNG of {} bits a channel; choose 8 or 16",
                self.bits
            )),
        }
    }
}

fn whole_path(path: &str) -> Result<(), String> {
    if path.len() > PATH_MAX {
        return Err(format!(
            "a path of {} bytes; give one of at most {PATH_MAX}",
            path.len()
        ));
    }
    match path.starts_with('/') && !path.contains('\0') {
        true => Ok(()),
        false => Err(
            "a path that does not begin at the root; give the whole one, for each program has a folder \
             of its own"
                .to_owned(),
        ),
    }
}

/// Micrometres without the noise of the last digits.
fn micrometres(m: f64) -> f64 {
    (m * 1e12).round() * 1e-6
}

fn film(thickness_m: f64) -> Result<(), String> {
    match FILM_M.contains(&thickness_m) {
        true => Ok(()),
        false => Err(format!(
            "a film of {} µm; choose 1 to 5000 µm",
            micrometres(thickness_m)
        )),
    }
}

fn well(well: &Well) -> Result<(), String> {
    let round = well.radius_m > 0.0 && well.radius_m <= FARTHEST_M;
    if !round || !well.center_m.iter().all(|m| m.abs() <= FARTHEST_M) {
        return Err(format!(
            "a well with a radius of {} mm; choose one above 0, within the surface",
            well.radius_m * 1e3
        ));
    }
    match &well.kind {
        WellKind::Paint { mixture } => short(mixture),
        WellKind::Cleaner => Ok(()),
    }
}

fn brush_name(name: &str) -> Result<(), String> {
    check_name(name).map_err(|what| {
        if name.len() > 2 * PAINT_NAME_MAX {
            format!(
                "a brush's name of {} bytes; choose a shorter one",
                name.len()
            )
        } else {
            format!("the brush's name {what}; give it another one")
        }
    })
}

fn layer_name(name: &str) -> Result<(), String> {
    match name.len() > LAYER_NAME_MAX {
        true => Err(format!(
            "a layer's name of {} bytes; give one of at most {LAYER_NAME_MAX}",
            name.len()
        )),
        false => Ok(()),
    }
}

fn drying_share(share: f32) -> Result<(), String> {
    match share > 0.0 && share <= 1.0 {
        true => Ok(()),
        false => Err(format!(
            "a share of {share} that dries; choose one above 0, at most 1"
        )),
    }
}

fn opaque(opacity: f32) -> Result<(), String> {
    match (0.0..=1.0).contains(&opacity) {
        true => Ok(()),
        false => Err(format!("an opacity of {opacity}; choose 0 to 1")),
    }
}

fn checked(region: Option<&Region>) -> Result<(), String> {
    region.map_or(Ok(()), Region::check)
}

fn version_name(name: &str) -> Result<(), String> {
    if name.trim().is_empty() || name.len() > VERSION_NAME_MAX || name.contains(char::is_control) {
        return Err(format!(
            "a version cannot be called this; give it 1 to {VERSION_NAME_MAX} bytes, and no line breaks"
        ));
    }
    Ok(())
}

fn short(mixture: &Mixture) -> Result<(), String> {
    if mixture.parts.len() > PARTS_MAX {
        let parts = mixture.parts.len();
        return Err(format!(
            "a mixture of {parts} paints; give one of at most {PARTS_MAX}"
        ));
    }
    let longest = mixture.parts.iter().map(|part| part.paint.len()).max();
    match longest.filter(|length| *length > PAINT_NAME_MAX) {
        Some(length) => Err(format!(
            "a paint's name of {length} bytes; give one of at most {PAINT_NAME_MAX}"
        )),
        None => Ok(()),
    }
}
