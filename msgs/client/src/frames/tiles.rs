//! Tiles of a surface: those that a view wants, and rectangles of them.

/// A rectangle of tiles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TileRect {
    /// Least column and row.
    pub from: [u32; 2],
    /// One past the greatest.
    pub to: [u32; 2],
}

impl TileRect {
    /// No tile.
    pub const NONE: Self = Self {
        from: [0; 2],
        to: [0; 2],
    };

    /// The tiles from the lowest to, not with, `to`.
    #[must_use]
    pub const fn up_to(to: [u32; 2]) -> Self {
        Self { from: [0; 2], to }
    }

    /// True if it holds no tile.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        (0..2).any(|i| self.from[i] >= self.to[i])
    }

    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        [0, 1].map(|i| self.to[i].saturating_sub(self.from[i]))
    }

    /// The intersection; [`NONE`](Self::NONE) if it is empty.
    #[must_use]
    pub fn within(&self, other: &Self) -> Self {
        let both = Self {
            from: [0, 1].map(|i| self.from[i].max(other.from[i])),
            to: [0, 1].map(|i| self.to[i].min(other.to[i])),
        };
        if both.is_empty() { Self::NONE } else { both }
    }

    /// True if it contains all of `other`.
    #[must_use]
    pub fn holds(&self, other: &Self) -> bool {
        other.is_empty() || self.within(other) == *other
    }

    /// Its difference from `other`, in parts that do not overlap.
    #[must_use]
    pub fn without(&self, other: &Self) -> Vec<Self> {
        let both = self.within(other);
        if both.is_empty() {
            return vec![*self];
        }
        let (mut rest, mut parts) = (*self, Vec::new());
        for i in 0..2 {
            for (from, to) in [(rest.from[i], both.from[i]), (both.to[i], rest.to[i])] {
                let mut part = rest;
                (part.from[i], part.to[i]) = (from, to);
                parts.push(part);
            }
            (rest.from[i], rest.to[i]) = (both.from[i], both.to[i]);
        }
        parts.retain(|part| !part.is_empty());
        parts
    }

    /// As a request has it.
    #[must_use]
    pub fn to_request(&self) -> [u32; 4] {
        [self.from[0], self.from[1], self.to[0], self.to[1]]
    }
}

/// Tiles that a view wants of a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wanted {
    /// The level that the pixels ask for.
    pub level: u32,
    /// Its tiles that are visible, with a margin.
    pub tiles: TileRect,
    /// Tiles that there must be room for, whatever the view shows of the surface at this scale.
    pub room: [u32; 2],
    /// The level of a picture of the whole surface; `None` if `tiles` are all.
    pub base: Option<u32>,
    /// Tiles of the whole surface at that level.
    pub base_tiles: [u32; 2],
    /// True if wet paint is tinted.
    pub wet: bool,
}

impl Wanted {
    /// All tiles of a surface at a level.
    #[must_use]
    pub fn whole(level: u32, all: [u32; 2]) -> Self {
        Self {
            level,
            tiles: TileRect::up_to(all),
            room: all,
            base: None,
            base_tiles: [0; 2],
            wet: false,
        }
    }
}
