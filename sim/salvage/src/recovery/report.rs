//! Report of a recovery.

use maulstick_painting::history::TilePlace;

/// Content recovered from a damaged painting, and its losses.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SalvageReport {
    /// Number of tiles with paint that are intact.
    pub tiles: u64,
    /// Tiles restored from the history or an older copy.
    pub older: Vec<TilePlace>,
    /// Tiles that lost wet paint or a dry layer.
    pub thinned: Vec<TilePlace>,
    /// Tiles that lost everything.
    pub missing: Vec<TilePlace>,
    /// Number of dry layers of tiles that lost their paint, or all layers below.
    pub layers: u64,
    /// Number of recovered steps.
    pub steps: u64,
    /// Number of lost steps.
    pub lost_steps: u64,
    /// Number of recovered versions.
    pub versions: u64,
    /// Lost versions.
    pub lost_versions: Vec<String>,
    /// Brushes that are clean because their load is lost.
    pub brushes: Vec<String>,
    /// Lost files that were replaced by others.
    pub files: Vec<String>,
    /// Number of accepted records that were replayed.
    pub records: u64,
    /// Number of accepted records that were lost.
    pub lost_records: u64,
    /// Number of damaged rows.
    pub rows: u64,
    /// Number of lost pages of the file, with all rows on them.
    pub pages: u64,
    /// True if the state of the painting besides its tiles is an older one.
    pub is_old: bool,
    /// Format of the file, if unknown: a newer one may contain more than was found.
    pub format: Option<i32>,
}

impl SalvageReport {
    /// True if nothing was damaged.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        let whole = Self {
            tiles: self.tiles,
            steps: self.steps,
            versions: self.versions,
            records: self.records,
            ..Self::default()
        };
        *self == whole
    }
}
