//! The two conversions of counts into colours.

use maulstick_canvas::planes::Planes;

use crate::appearance::Appearance;

/// Encoded red, green and blue of a tile, a plane each.
pub type EncodedTile = [Vec<f32>; 3];

/// Composites planes over a tile in colours by slot; the last argument is the opacity of a cell's quanta.
pub type LayVolumes =
    fn(&mut EncodedTile, &Planes, &[Option<[f32; 3]>], &dyn Fn(usize, f32) -> f32);

/// Conversion of a paint model's counts into colours.
#[derive(Clone, Copy, Debug)]
pub enum Colouring {
    /// Stacked films (Kubelka and Munk; Baxter 2004, ch. 7).
    Films,
    /// Encoded colours mixed by volume, each layer over the one below (Baxter 2004, § 4.5.2).
    Volumes(&'static VolumeColours),
}

/// Colours of a model whose paint's opacity depends on its volume.
#[derive(Debug)]
pub struct VolumeColours {
    /// Encoded colours of the paints by slot; `None` for the thinner, which hides nothing.
    pub colours: fn(&Appearance) -> Vec<Option<[f32; 3]>>,
    /// Quanta of an opaque cell.
    pub opaque: f32,
    /// Opacity of wet paint by its quanta.
    pub hides: fn(f32) -> f32,
    /// Share by which dried paint replaces the colour under it, by its quanta and by the wet quanta over it.
    pub dry_share: fn(f32, f32) -> f32,
    /// Composites planes over a tile.
    pub lay: LayVolumes,
    /// Wet quanta over dried planes, by cell; `None` without any.
    pub wet_over: fn(&Planes) -> Option<Vec<f32>>,
    /// Dried planes with a note of these wet quanta over each cell.
    pub noted: fn(Planes, &[f32]) -> Planes,
}

impl Colouring {
    /// The colours by volume; `None` for films.
    #[must_use]
    pub fn volumes(self) -> Option<&'static VolumeColours> {
        match self {
            Self::Films => None,
            Self::Volumes(volumes) => Some(volumes),
        }
    }
}

impl PartialEq for Colouring {
    fn eq(&self, other: &Self) -> bool {
        match (self.volumes(), other.volumes()) {
            (Some(own), Some(other)) => std::ptr::eq(own, other),
            (own, other) => own.is_none() && other.is_none(),
        }
    }
}
