//! A sweep as the hand gets it: a thousand times a second, as the solver last gave it, and filtered.

use maulstick_haptics::bartlett_hanning::BartlettHanning;

use crate::geometry::ProbeState;
use crate::sweep::{ARC_S, RATE_HZ, Sample, arc};

/// Ticks a second.
pub const HAND_HZ: f64 = 1000.0;

/// Taps of the filter before the hand.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum HandFilter {
    /// A tap a tick over one period of the solver.
    #[default]
    Period,
    /// The dissertation's eleven, a tick apart.
    Dissertation,
}

impl HandFilter {
    fn filter(self) -> BartlettHanning {
        match self {
            Self::Period => BartlettHanning::over(1.0 / RATE_HZ, 1.0 / HAND_HZ),
            Self::Dissertation => BartlettHanning::dissertation(),
        }
    }
}

/// A tick of the hand; forces are those for a metre of depth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HandTick {
    /// Time, s.
    pub time_s: f64,
    /// The probe.
    pub state: ProbeState,
    /// Drag, force across and torque as the solver last gave them, N/m and N·m/m.
    pub raw: [f64; 3],
    /// The filtered force and torque.
    pub filtered: [f64; 3],
}

/// The ticks of a sweep along the arc.
#[must_use]
pub fn hand_ticks(sweep: &[Sample], filter: HandFilter) -> Vec<HandTick> {
    let mut filters = [0; 3].map(|_| filter.filter());
    let ticks = (ARC_S * HAND_HZ) as usize;
    let told = |tick: usize| {
        let steps = (tick as f64 * RATE_HZ / HAND_HZ) as usize;
        let newest = steps.checked_sub(1).and_then(|step| sweep.get(step));
        newest.map_or([0.0; 3], |it| [it.drag_n, it.across_n, it.torque_n_m])
    };
    (0..ticks)
        .map(|tick| {
            let raw = told(tick);
            let mut filtered = raw;
            for (value, filter) in filtered.iter_mut().zip(&mut filters) {
                *value = filter.next(*value);
            }
            let time_s = tick as f64 / HAND_HZ;
            HandTick {
                time_s,
                state: arc(time_s),
                raw,
                filtered,
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Boundary;
    use crate::sweep::arc_sweep;

    #[test]
    fn filtered_forces_have_no_steps_and_are_half_a_period_late() {
        let sweep = arc_sweep(24, Boundary::Covered, |_| {});
        let ticks = hand_ticks(&sweep, HandFilter::Period);
        assert_eq!(ticks.len(), 4000);
        let jump = |of: fn(&HandTick) -> f64| {
            let changes = ticks
                .windows(2)
                .map(|pair| (of(&pair[1]) - of(&pair[0])).abs());
            changes.fold(0.0, f64::max)
        };
        let (raw, filtered) = (jump(|it| it.raw[0]), jump(|it| it.filtered[0]));
        println!("{raw:.5} N, filtered {filtered:.5} N a tick");
        assert!(filtered < 0.2 * raw);
        // Shift of the filtered force that agrees best with the raw one, ticks.
        let off = |shift: usize| -> f64 {
            let pairs = ticks.iter().zip(&ticks[shift..]);
            pairs
                .map(|(raw, late)| (late.filtered[0] - raw.raw[0]).powi(2))
                .take(3900)
                .sum()
        };
        let late = (0..30).min_by(|a, b| off(*a).total_cmp(&off(*b)));
        println!("{late:?} ms late");
        assert!(late.is_some_and(|ticks| (7..=10).contains(&ticks)));
    }
}
