//! Bartlett-Hanning window (Baxter 2004, § 8.8.6): the filter between a slow solver and a hand at 1 kHz.
//!
//! ```text
//! w(x) = .62 − .48·|x − ½| + .38·cos 2π(x − ½),   x from 0 to 1
//! ```
//!
//! The dissertation's filter has eleven taps. At 1 kHz they span 11 ms, less than one period of a source of 70 Hz, so its
//! steps stay steps; [`BartlettHanning::over`] spaces the taps over one period of the source instead.

use std::f64::consts::PI;

use maulstick_num::{cos, sin};

/// Order of the dissertation's filter: eleven taps.
pub const DISSERTATION_ORDER: usize = 10;

/// The window at a place of 0 to 1; 0 at both ends.
#[must_use]
pub fn window(x: f64) -> f64 {
    let off = x - 0.5;
    (0.62 - 0.48 * off.abs() + 0.38 * cos(2.0 * PI * off)).max(0.0)
}

/// Response to a step, 0 to 1, at a share of the window's length after it: the integral of [`window`] by its whole,
/// ½. NaN gives 0.
#[must_use]
pub fn step_response(share: f64) -> f64 {
    if share >= 1.0 {
        return 1.0;
    }
    if share.is_nan() || share <= 0.0 {
        return 0.0;
    }
    let off = share - 0.5;
    let area = 0.62 * share - 0.24 * (0.25 + off * off.abs()) + 0.19 / PI * sin(2.0 * PI * off);
    area / 0.5
}

/// A finite impulse response filter with the taps of the window.
#[derive(Clone, Debug)]
pub struct BartlettHanning {
    taps: Vec<f64>,
    /// Inputs, the newest last.
    inputs: Vec<f64>,
}

impl BartlettHanning {
    /// A filter of `order` + 1 taps whose sum is 1, before its first input.
    #[must_use]
    pub fn new(order: usize) -> Self {
        let order = order.max(2);
        let mut taps: Vec<f64> = (0..=order)
            .map(|i| window(i as f64 / order as f64))
            .collect();
        let sum: f64 = taps.iter().sum();
        for tap in &mut taps {
            *tap /= sum;
        }
        Self {
            inputs: Vec::with_capacity(taps.len()),
            taps,
        }
    }

    /// The dissertation's eleven taps.
    #[must_use]
    pub fn dissertation() -> Self {
        Self::new(DISSERTATION_ORDER)
    }

    /// Taps at each tick of `tick_s` over one `period_s` of the source.
    #[must_use]
    pub fn over(period_s: f64, tick_s: f64) -> Self {
        Self::new((period_s / tick_s).round() as usize)
    }

    /// The taps, which sum to 1.
    #[must_use]
    pub fn taps(&self) -> &[f64] {
        &self.taps
    }

    /// Adds an input and returns the output. Before the first input all are equal to it.
    pub fn next(&mut self, input: f64) -> f64 {
        if self.inputs.is_empty() {
            self.inputs.resize(self.taps.len(), input);
        }
        self.inputs.rotate_left(1);
        if let Some(newest) = self.inputs.last_mut() {
            *newest = input;
        }
        let pairs = self.inputs.iter().zip(&self.taps);
        pairs.map(|(input, tap)| input * tap).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_eleven_taps_are_those_of_the_window() {
        // Erratum 33, by hand.
        let expected = [
            0.0, 0.024_115, 0.071_715, 0.128_285, 0.175_885, 0.2, 0.175_885, 0.128_285, 0.071_715,
            0.024_115, 0.0,
        ];
        let filter = BartlettHanning::dissertation();
        for (tap, expected) in filter.taps().iter().zip(expected) {
            println!("{tap:.6}, expected {expected}");
            assert!((tap - expected).abs() < 1e-6);
        }
        assert!((filter.taps().iter().sum::<f64>() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn the_step_response_is_the_integral_of_the_window() {
        let mut sum = 0.0;
        for i in 0..10_000 {
            let x = (f64::from(i) + 0.5) * 1e-4;
            sum += 2e-4 * window(x);
            let error = step_response(x + 5e-5) - sum;
            assert!(error.abs() < 1e-6, "{x}: {error}");
        }
        let ends = [-1.0, 0.0, 0.5, 1.0, 2.0, f64::NAN].map(step_response);
        assert_eq!(ends, [0.0, 0.0, 0.5, 1.0, 1.0, 0.0]);
    }

    /// Largest change within a tick of a source whose values jump by 1 each period.
    fn jump(mut filter: BartlettHanning) -> f64 {
        let mut last = filter.next(0.0);
        let mut most: f64 = 0.0;
        for tick in 0..200 {
            let now = filter.next(if (tick / 15) % 2 == 0 { 1.0 } else { 0.0 });
            most = most.max((now - last).abs());
            last = now;
        }
        most
    }

    #[test]
    fn over_a_period_the_steps_of_a_slow_source_are_a_ramp() {
        let (over, printed) = (
            jump(BartlettHanning::over(0.015, 1e-3)),
            jump(BartlettHanning::dissertation()),
        );
        println!("{over:.3}, the dissertation's {printed:.3}");
        assert!(over < 0.14 && printed > 0.19);
        // The seeded fault: without a filter a step is a step.
        assert!(jump(BartlettHanning::new(2)) > 0.9);
    }
}
