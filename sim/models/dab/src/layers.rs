//! Appearance of stacked layers (Baxter 2004, § 4.6, 4.7).
//!
//! Colours are encoded sRGB, as the 8-bit textures of the text: in a layer they mix by the volumes of the paints. Wet
//! paint of volume V hides α = min(V·O_t, 1) of what lies under it (eq. 4.1). A layer that dries under wet paint gets
//! the colour that leaves the appearance unchanged: with α' of the paint that stays wet, C'_d = (α·C_w + (1 − α)·C_d −
//! α'·C_w)/(1 − α').

mod wet_over;

use maulstick_appearance::Appearance;
use maulstick_appearance::colouring::{Colouring, EncodedTile, VolumeColours};
use maulstick_appearance::display::DisplayTile;
use maulstick_appearance::show_paint::{Seen, ShowPaint};
use maulstick_canvas::planes::{Planes, TILE_CELLS};
use maulstick_canvas::tile::Tile;
use maulstick_optics::colour::{srgb_decode, srgb_encode};

use wet_over::{noted, wet_over, with_wet_noted};

use crate::emboss::emboss;
use crate::volume::{OPAQUE, UNIT};

/// Thickness of the film over white from which a paint's colour is taken, m: dark transparent paints are nearly black
/// in thick films, and their mixtures would be grey.
const SHOWN_M: f64 = 40e-6;
/// Reflectance of that white.
const WHITE: f32 = 0.95;
/// Number of values in a table of the transfer curve.
const TABLE: usize = 4096;

/// Appearance of dAb's paint.
#[derive(Clone, Copy, Debug)]
pub struct Layers {
    /// Strength of the embossing, change of an encoded channel per metre of height at a relief of 1: the text's
    /// bumpiness.
    pub emboss: f32,
}

/// Colours of dAb's paint, for conversions.
pub static VOLUMES: VolumeColours = VolumeColours {
    colours,
    opaque: OPAQUE * UNIT,
    hides,
    dry_share,
    lay: |rgb, planes, colours, share| lay(rgb, planes, colours, share),
    wet_over,
    noted,
};

/// Opacity of a number of quanta.
#[inline]
fn hides(quanta: f32) -> f32 {
    (quanta * (1.0 / (OPAQUE * UNIT))).min(1.0)
}

/// Share by which dried paint replaces the colour under it, with `stays` quanta wet over it: C'_d of the text is C_d +
/// share·(C_w − C_d).
#[inline]
fn dry_share(dried: f32, stays: f32) -> f32 {
    let left = hides(stays);
    if dried <= 0.0 {
        0.0
    } else if left >= 1.0 {
        1.0
    } else {
        (hides(dried + stays) - left) / (1.0 - left)
    }
}

/// A tabulated curve from 0 to 1.
#[derive(Debug)]
struct Curve(Vec<f32>);

impl Curve {
    fn of(curve: impl Fn(f64) -> f64) -> Self {
        let value = |i: usize| curve(i as f64 / TABLE as f64) as f32;
        Self((0..=TABLE + 1).map(value).collect())
    }

    fn at(&self, value: f32) -> f32 {
        let place = value.clamp(0.0, 1.0) * TABLE as f32;
        let below = place as usize;
        let share = place - below as f32;
        self.0[below] + share * (self.0[below + 1] - self.0[below])
    }
}

/// The sRGB curve and its inverse.
static CURVES: std::sync::LazyLock<[Curve; 2]> =
    std::sync::LazyLock::new(|| [Curve::of(srgb_encode), Curve::of(srgb_decode)]);

/// Encoded colours of the paints by slot; `None` for thinner and varnish, which hide nothing.
fn colours(look: &Appearance) -> Vec<Option<[f32; 3]>> {
    let studio = &look.studio;
    let white = vec![WHITE; studio.wavelengths()];
    let colour = |slot: usize| {
        let film = studio.colour(&[(slot, SHOWN_M)], &white);
        (!look.is_clear(slot)).then(|| film.map(|channel| srgb_encode(channel) as f32))
    };
    (0..studio.slots()).map(colour).collect()
}

/// Volume of a layer, quanta a cell, and its colours times that.
fn mixed(planes: &Planes, colours: &[Option<[f32; 3]>]) -> [Vec<f32>; 4] {
    let mut mixed = [const { Vec::new() }; 4];
    mixed
        .iter_mut()
        .for_each(|plane| plane.resize(TILE_CELLS, 0.0));
    for (slot, counts) in planes {
        let Some(Some([red, green, blue])) = colours.get(*slot) else {
            continue;
        };
        for (plane, factor) in mixed.iter_mut().zip([*red, *green, *blue, 1.0]) {
            let cells = plane.iter_mut().zip(counts.iter());
            cells.for_each(|(sum, count)| *sum += factor * count);
        }
    }
    mixed
}

/// Composites a layer over the encoded colours of a tile; `share` is the opacity of a cell's quanta.
fn lay(
    rgb: &mut EncodedTile,
    planes: &Planes,
    colours: &[Option<[f32; 3]>],
    share: impl Fn(usize, f32) -> f32,
) {
    let [red, green, blue, volume] = mixed(planes, colours);
    let shares = volume.iter().enumerate();
    let shares: Vec<f32> = shares.map(|(cell, volume)| share(cell, *volume)).collect();
    for (own, mixed) in rgb.iter_mut().zip([red, green, blue]) {
        for cell in 0..TILE_CELLS {
            if shares[cell] > 0.0 {
                own[cell] += shares[cell] * (mixed[cell] / volume[cell] - own[cell]);
            }
        }
    }
}

impl ShowPaint for Layers {
    fn colouring(&self) -> Colouring {
        Colouring::Volumes(&VOLUMES)
    }

    fn dried(&self, tile: Tile) -> Tile {
        with_wet_noted(tile)
    }

    fn finish(&self, seen: &Seen<'_>, shown: &mut DisplayTile) {
        let colours = colours(seen.look);
        let mut rgb = shown
            .rgb
            .each_ref()
            .map(|plane| -> Vec<f32> { plane.iter().map(|value| CURVES[0].at(*value)).collect() });
        let ground = rgb.clone();
        let stack = seen.tile.dry();
        let layers: Vec<_> = stack.into_iter().flat_map(|stack| stack.layers()).collect();
        for layer in layers.iter().rev() {
            let planes = layer.planes.get();
            let (over, opacity) = (wet_over(&planes), seen.look.opacity(layer.number));
            lay(&mut rgb, &planes, &colours, |cell, volume| {
                let stays = over.as_ref().map_or(0.0, |over| over[cell]);
                (dry_share(volume, stays) * opacity).min(1.0)
            });
        }
        lay(&mut rgb, &seen.tile.wet(), &colours, |_, volume| {
            hides(volume)
        });
        let heights = self.height(seen.bare, seen.id, seen.tile);
        // The palette is drawn without relief.
        let strength = self.emboss * seen.look.relief();
        let raised = if seen.bare.wells.is_empty() && strength != 0.0 {
            emboss(&heights)
        } else {
            vec![0.0; TILE_CELLS]
        };
        for (own, (mixed, ground)) in shown.rgb.iter_mut().zip(rgb.iter().zip(&ground)) {
            for cell in 0..TILE_CELLS {
                let lit = strength * raised[cell];
                if lit != 0.0 || mixed[cell] != ground[cell] {
                    own[cell] = CURVES[1].at(mixed[cell] + lit);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const ONE: f32 = OPAQUE * UNIT;

    #[test]
    fn yellow_and_cyan_make_a_dull_green() {
        let planes = Planes::from_iter([
            (0, vec![500.0; TILE_CELLS].into()),
            (1, vec![500.0; TILE_CELLS].into()),
        ]);
        let colours = [Some([1.0, 1.0, 0.0]), Some([0.0, 1.0, 1.0])];
        let [red, green, blue, volume] = mixed(&planes, &colours);
        let mean = [red, green, blue].map(|plane| plane[7] / volume[7]);
        assert_eq!(mean, [0.5, 1.0, 0.5]);
    }

    #[test]
    fn drying_nothing_or_under_opaque_paint_does_nothing() {
        assert_eq!(dry_share(0.0, 0.3 * ONE), 0.0);
        assert_eq!(dry_share(-5.0, 0.0), 0.0);
        assert_eq!(
            dry_share(0.2 * ONE, ONE),
            1.0,
            "0/0 of the text: the colour of the wet paint"
        );
        assert_eq!(dry_share(0.25 * ONE, 0.0), 0.25);
    }

    proptest! {
        /// However a film dries in parts, its appearance is that of the whole film wet.
        #[test]
        fn partial_drying_keeps_the_colour(
            film in 0.0..1.5f32, parts in prop::collection::vec(0.01..0.99f32, 1..6), under in 0.0..1.0f32,
        ) {
            let (wet, deep) = (0.9f32, under);
            let seen = |wet_quanta: f32, deep: f32| {
                let alpha = hides(wet_quanta);
                alpha * wet + (1.0 - alpha) * deep
            };
            let before = seen(film * ONE, deep);
            let (mut left, mut colour) = (film * ONE, deep);
            for part in parts {
                let dried = left * part;
                left -= dried;
                colour += dry_share(dried, left) * (wet - colour);
                let now = seen(left, colour);
                prop_assert!((now - before).abs() < 2e-4, "{now} {before}");
            }
            // Plain layers would not keep it.
            let plain = seen(0.5 * 0.8 * ONE, deep + hides(0.5 * 0.8 * ONE) * (wet - deep));
            prop_assert!((plain - seen(0.8 * ONE, deep)).abs() > 1e-3 || (wet - deep).abs() < 0.05);
        }
    }
}
