//! The relief of a painting as a picture: light is high.

use std::io::Write;

use maulstick_appearance::bands::{Banded, in_order};
use maulstick_painting::Painting;

use crate::ExchangeError;
use crate::grey_map::write_grey_map;
use crate::surface::{Progress, Steps, banded, check_whole};

/// Range of the heights of a surface, m above the highest peaks of its bare ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeightRange {
    /// Lowest height, m.
    pub least_m: f32,
    /// Greatest height, m.
    pub greatest_m: f32,
}

impl HeightRange {
    /// The range of a surface, by two threads.
    fn of(banded: &Banded<'_>, steps: &mut Steps<'_>) -> Result<Self, ExchangeError> {
        let mut range = Self {
            least_m: f32::INFINITY,
            greatest_m: f32::NEG_INFINITY,
        };
        let job = |band: usize| {
            let ends = (f32::INFINITY, f32::NEG_INFINITY);
            let heights = banded.heights(band);
            let heights = heights.iter();
            heights.fold(ends, |(least, most), h| (least.min(*h), most.max(*h)))
        };
        in_order(banded.bands(), job, |_, (least, greatest)| {
            range.least_m = range.least_m.min(least);
            range.greatest_m = range.greatest_m.max(greatest);
            steps.step();
            Ok::<(), ExchangeError>(())
        })?;
        Ok(range)
    }

    /// 0 for the lowest height, 65535 for the highest; 0 where all is level.
    fn level(&self, height: f32) -> u16 {
        let [height, least, greatest] = [height, self.least_m, self.greatest_m].map(f64::from);
        if greatest <= least {
            return 0;
        }
        ((height - least) / (greatest - least) * 65_535.0 + 0.5) as u16
    }
}

/// Writes the heights of a surface as a grey PNG of 16 bits, linear between the range that is returned and stored in
/// its `tEXt`, in micrometres. `pHYs` has the size of a cell.
///
/// # Errors
/// [`ExchangeError`].
pub fn write_height_map(
    painting: &mut Painting,
    surface: u32,
    to: impl Write,
    progress: Progress<'_>,
) -> Result<HeightRange, ExchangeError> {
    let banded = banded(painting, surface)?;
    let mut steps = Steps::new(progress, 2 * banded.bands());
    let range = HeightRange::of(&banded, &mut steps)?;
    let [least, greatest] = [range.least_m, range.greatest_m].map(|m| f64::from(m) * 1e6);
    let text = format!("0 is {least:.4} micrometres, 65535 is {greatest:.4}");
    let values = |band: usize| {
        let heights = banded.heights(band);
        heights.iter().map(|height| range.level(*height)).collect()
    };
    write_grey_map(&banded, ("Height", text), values, to, &mut steps)?;
    check_whole(painting)?;
    Ok(range)
}
