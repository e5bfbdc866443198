//! Readings of a pen, as a window system reports them.

use maulstick_device::pen::Reading;
use maulstick_types::stylus::axes;

/// Identity of a tool among all those of a window system.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Tool(pub u64);

/// Axes that a tool senses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "each axis is there or not, whatever the others"
)]
pub struct Axes {
    /// Pressure of its tip.
    pub pressure: bool,
    /// Its tilt.
    pub tilt: bool,
    /// Its rotation about its axis.
    pub twist: bool,
    /// True if the window system says when it is away.
    pub range: bool,
}

impl Axes {
    /// The same as bits of [`axes`].
    #[must_use]
    pub fn bits(self) -> u32 {
        let each = [
            (self.pressure, axes::PRESSURE),
            (self.tilt, axes::TILT),
            (self.twist, axes::TWIST),
            (self.range, axes::PROXIMITY),
        ];
        let sensed = each.into_iter().filter(|(senses, _)| *senses);
        sensed.fold(axes::POSITION | axes::SWITCHES, |all, (_, bit)| all | bit)
    }
}

/// One reading of a tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PenReading {
    /// The tool.
    pub tool: Tool,
    /// Axes that it senses.
    pub axes: Axes,
    /// Time of the window system, ms, from any beginning; it wraps.
    pub time_ms: u32,
    /// The point under it: pixels of the window, from its upper left corner, y **down**.
    pub point_px: [f64; 2],
    /// The pen then; its `point_m` is found by the window.
    pub reading: Reading,
}
