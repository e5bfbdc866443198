//! Stacked layers of a tile, in either colouring.

use maulstick_appearance::colouring::{Colouring, EncodedTile, VolumeColours};
use maulstick_appearance::show_paint::counted_films;
use maulstick_canvas::planes::{Planes, TILE_CELLS};
use maulstick_canvas::sheet::sheets;
use maulstick_optics::colour::srgb_decode;
use maulstick_optics::{FilmPlanes, Under};

use crate::cell::encoded;
use crate::palette::Palette;

/// Kind of a layer.
#[derive(Clone, Debug)]
pub(crate) enum Kind {
    Wet,
    /// Dried paint.
    Dry {
        /// Factor on its optical thickness.
        opacity: f32,
        /// Wet quanta over it when it dried, by cell, if known.
        over: Option<Vec<f32>>,
    },
}

impl Kind {
    /// Factor on the optical thickness of its film.
    pub(crate) fn opacity(&self) -> f32 {
        match self {
            Self::Wet => 1.0,
            Self::Dry { opacity, .. } => *opacity,
        }
    }

    /// Opacity of a cell's quanta as a volume.
    pub(crate) fn hides(&self, volumes: &VolumeColours, cell: usize, quanta: f32) -> f32 {
        match self {
            Self::Wet => (volumes.hides)(quanta),
            Self::Dry { opacity, over } => {
                let stays = over.as_ref().map_or(0.0, |over| over[cell]);
                ((volumes.dry_share)(quanta, stays) * opacity).min(1.0)
            }
        }
    }
}

/// Colours of the paints in one of the colourings.
#[derive(Debug)]
pub(crate) enum Paints {
    /// Colours by the optics of films.
    Films,
    /// Colours of a model whose paint mixes by volume.
    Volumes(VolumePaints),
}

/// Encoded colours of paints that mix by volume.
#[derive(Debug)]
pub(crate) struct VolumePaints {
    /// Colours by slot; `None` for the thinner.
    pub(crate) of: &'static VolumeColours,
    /// By slot; none of the thinner.
    by_slot: Vec<Option<[f32; 3]>>,
    /// Colours in the order of the palette.
    pub(crate) encoded: Vec<[f64; 3]>,
}

impl Paints {
    pub(crate) fn of(colouring: Colouring, palette: &Palette<'_>) -> Self {
        let Colouring::Volumes(of) = colouring else {
            return Self::Films;
        };
        let by_slot = (of.colours)(palette.look);
        let slots = palette.slots.iter();
        let encoded = slots.map(|slot| by_slot[*slot].unwrap_or_default());
        Self::Volumes(VolumePaints {
            of,
            encoded: encoded.map(|rgb| rgb.map(f64::from)).collect(),
            by_slot,
        })
    }

    /// Wet quanta noted over dried planes.
    pub(crate) fn wet_over(&self, dried: &Planes) -> Option<Vec<f32>> {
        match self {
            Self::Films => None,
            Self::Volumes(volumes) => (volumes.of.wet_over)(dried),
        }
    }
}

/// Appearance of a tile's layers so far.
#[derive(Clone, Debug)]
pub(crate) enum Shown {
    /// Internal reflectances, a plane a wavelength.
    Films(Vec<f32>),
    /// Encoded red, green and blue.
    Volumes(EncodedTile),
}

impl Shown {
    /// The ground alone.
    pub(crate) fn ground(paints: &Paints, palette: &Palette<'_>, ground: Under<'_>) -> Self {
        match paints {
            Paints::Films => Self::Films(match ground {
                Under::Planes(planes) => planes.to_vec(),
                Under::Even(values) => {
                    let plane = |value: &f32| std::iter::repeat_n(*value, TILE_CELLS);
                    values.iter().flat_map(plane).collect()
                }
            }),
            Paints::Volumes(..) => {
                let mut rgb = [const { Vec::new() }; 3];
                rgb.iter_mut()
                    .for_each(|plane| plane.resize(TILE_CELLS, 0.0f32));
                let [red, green, blue] = &mut rgb;
                let bare = FilmPlanes {
                    paints: &[],
                    opacity: 1.0,
                    under: ground,
                };
                palette.look.studio.shade(&bare, [red, green, blue]);
                let even = matches!(ground, Under::Even(_));
                for value in rgb.iter_mut().flat_map(|plane| {
                    if even {
                        plane[..1].iter_mut()
                    } else {
                        plane.iter_mut()
                    }
                }) {
                    *value = encoded(*value);
                }
                if even {
                    for plane in &mut rgb {
                        let value = plane[0];
                        plane.fill(value);
                    }
                }
                Self::Volumes(rgb)
            }
        }
    }

    /// Composites a layer over it.
    pub(crate) fn lay(
        &mut self,
        paints: &Paints,
        palette: &Palette<'_>,
        planes: &Planes,
        kind: &Kind,
    ) {
        match self {
            Self::Films(under) => {
                let films = match sheets(planes) {
                    Some(sheets) => sheets.into(),
                    None => vec![counted_films(planes)],
                };
                for films in films {
                    let paints: Vec<(usize, &[f32])> =
                        films.iter().map(|(slot, film)| (*slot, &**film)).collect();
                    let film = FilmPlanes {
                        paints: &paints,
                        opacity: kind.opacity(),
                        under: Under::Planes(under),
                    };
                    *under = palette.look.studio.bake(&film, TILE_CELLS);
                }
            }
            Self::Volumes(rgb) => {
                if let Paints::Volumes(VolumePaints { of, by_slot, .. }) = paints {
                    let share = |cell: usize, volume: f32| kind.hides(of, cell, volume);
                    (of.lay)(rgb, planes, by_slot, &share);
                }
            }
        }
    }

    /// CIELAB of a cell, gloss included.
    pub(crate) fn lab(&self, palette: &Palette<'_>, cell: usize) -> [f64; 3] {
        let xyz = match self {
            Self::Films(planes) => {
                let cells = planes.iter().skip(cell).step_by(TILE_CELLS);
                palette.xyz_of(cells.map(|r| f64::from(*r)))
            }
            Self::Volumes(rgb) => {
                let rgb = [0, 1, 2].map(|i| f64::from(rgb[i][cell]).clamp(0.0, 1.0));
                palette.xyz(rgb.map(srgb_decode))
            }
        };
        palette.lab(xyz)
    }
}
