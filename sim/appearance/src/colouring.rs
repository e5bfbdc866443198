//! The two ways in which counts become colours.

use maulstick_canvas::planes::Planes;

use crate::appearance::Appearance;

/// Encoded red, green and blue of a tile, a plane each.
pub type EncodedTile = [Vec<f32>; 3];

/// Lays planes over a tile in colours by slot; the last is the share that a cell's quanta replace.
pub type LayVolumes =
    fn(&mut EncodedTile, &Planes, &[Option<[f32; 3]>], &dyn Fn(usize, f32) -> f32);

/// How the counts of a paint model become colours.
#[derive(Clone, Copy, Debug)]
pub enum Colouring {
    /// Films over each other (Kubelka and Munk; Baxter 2004, ch. 7).
    Films,
    /// Encoded colours mixed by volume, each layer over the one below (Baxter 2004, § 4.5.2).
    Volumes(&'static VolumeColours),
}

/// A model's colours of paint that hides by its volume.
#[derive(Debug)]
pub struct VolumeColours {
    /// Encoded colours of the paints by slot; none of the thinner, which hides nothing.
    pub colours: fn(&Appearance) -> Vec<Option<[f32; 3]>>,
    /// Quanta of a cell that hide all that lies under them.
    pub opaque: f32,
    /// Share of what lies under wet paint that it hides, by its quanta.
    pub hides: fn(f32) -> f32,
    /// Share by which dried paint replaces the colour under it, by its quanta and by those that stayed wet over it.
    pub dry_share: fn(f32, f32) -> f32,
    /// Lays planes over a tile.
    pub lay: LayVolumes,
    /// Wet quanta that stayed over dried planes, a cell; `None` where nothing did.
    pub wet_over: fn(&Planes) -> Option<Vec<f32>>,
    /// Dried planes with these wet quanta noted over each cell.
    pub noted: fn(Planes, &[f32]) -> Planes,
}

impl Colouring {
    /// The colours by volume, if that is what they are.
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
