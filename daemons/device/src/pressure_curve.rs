//! Pressure curves of pens: points (sensed, given) from (0, 0) to (1, 1), and straight lines between them.

/// The pressure that is given where `sensed` is sensed.
#[must_use]
pub fn given(curve: &[[f64; 2]], sensed: f64) -> f64 {
    between(curve, sensed, [0, 1])
}

/// The least pressure that is sensed where `given` is given.
#[must_use]
pub fn sensed(curve: &[[f64; 2]], given: f64) -> f64 {
    between(curve, given, [1, 0])
}

/// True if points rise from (0, 0) to (1, 1), as those of a curve do.
#[must_use]
pub fn rises(points: &[[f64; 2]]) -> bool {
    let rise = |pair: &[[f64; 2]]| pair[0][0] < pair[1][0] && pair[0][1] <= pair[1][1];
    points.first() == Some(&[0.0, 0.0])
        && points.last() == Some(&[1.0, 1.0])
        && points.windows(2).all(rise)
}

/// Along one axis of the curve to the other.
fn between(curve: &[[f64; 2]], at: f64, [from, to]: [usize; 2]) -> f64 {
    for pair in curve.windows(2) {
        let (before, after) = (pair[0], pair[1]);
        let run = after[from] - before[from];
        if at <= after[from] {
            let share = if run > 0.0 {
                ((at - before[from]) / run).clamp(0.0, 1.0)
            } else {
                0.0
            };
            return (before[to] + share * (after[to] - before[to])).clamp(0.0, 1.0);
        }
    }
    at.clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_goes_in_straight_lines_there_and_back() {
        let curve = [[0.0, 0.0], [0.25, 0.0], [0.5, 0.8], [1.0, 1.0]];
        for (soft, hard) in [
            (0.25, 0.0),
            (0.375, 0.4),
            (0.5, 0.8),
            (0.75, 0.9),
            (1.0, 1.0),
        ] {
            assert!((given(&curve, soft) - hard).abs() < 1e-12);
            let back = if hard == 0.0 { 0.0 } else { soft };
            assert!((sensed(&curve, hard) - back).abs() < 1e-12);
        }
        assert_eq!((given(&curve, -1.0), given(&curve, 2.0)), (0.0, 1.0));
        assert_eq!(given(&[], 0.3), 0.3);
        assert!(rises(&curve));
        for wrong in [
            &[[0.0, 0.0], [0.5, 0.6], [0.7, 0.5], [1.0, 1.0]][..],
            &[[0.0, 0.0], [0.5, f64::NAN], [1.0, 1.0]],
            &[[0.0, 0.0]],
            &[],
        ] {
            assert!(!rises(wrong), "{wrong:?}");
        }
    }
}
