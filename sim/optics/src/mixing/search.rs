//! Minima of functions that cost little and have no derivative at hand.

/// Golden section (Kiefer 1953): the place in `from`..`to` and the least value of `f`, which has one
/// minimum there. `steps` evaluations narrow the interval by .618 each.
pub fn golden_section(
    [from, to]: [f64; 2],
    steps: usize,
    mut f: impl FnMut(f64) -> f64,
) -> (f64, f64) {
    let ratio = 0.5 * (5.0f64.sqrt() - 1.0);
    let (mut low, mut high) = (from, to);
    let mut left = high - ratio * (high - low);
    let mut right = low + ratio * (high - low);
    let (mut at_left, mut at_right) = (f(left), f(right));
    for _ in 0..steps {
        if at_left < at_right {
            (high, right, at_right) = (right, left, at_left);
            left = high - ratio * (high - low);
            at_left = f(left);
        } else {
            (low, left, at_left) = (left, right, at_right);
            right = low + ratio * (high - low);
            at_right = f(right);
        }
    }
    if at_left < at_right {
        (left, at_left)
    } else {
        (right, at_right)
    }
}

/// The simplex of Nelder and Mead (1965) in the plane, from a right-angled triangle of legs `leg` at
/// `start`, until its values differ by less than `tolerance` or `limit` evaluations are spent. The
/// place and the least value.
pub fn simplex(
    start: [f64; 2],
    leg: f64,
    tolerance: f64,
    limit: usize,
    mut f: impl FnMut([f64; 2]) -> f64,
) -> ([f64; 2], f64) {
    let [x, y] = start;
    let mut corners = [[x, y], [x + leg, y], [x, y + leg]].map(|at| (at, f(at)));
    let mut spent = 3;
    let by_value = |a: &([f64; 2], f64), b: &([f64; 2], f64)| a.1.total_cmp(&b.1);
    while spent < limit {
        corners.sort_by(by_value);
        let [best, middle, worst] = corners;
        if worst.1 - best.1 < tolerance {
            break;
        }
        let centre = [0, 1].map(|i| 0.5 * (best.0[i] + middle.0[i]));
        let mut at = |factor: f64| {
            let place = [0, 1].map(|i| centre[i] + factor * (centre[i] - worst.0[i]));
            (place, f(place))
        };
        let reflected = at(1.0);
        spent += 1;
        let better = if reflected.1 < best.1 {
            let expanded = at(2.0);
            spent += 1;
            Some(if expanded.1 < reflected.1 {
                expanded
            } else {
                reflected
            })
        } else if reflected.1 < middle.1 {
            Some(reflected)
        } else {
            let contracted = at(if reflected.1 < worst.1 { 0.5 } else { -0.5 });
            spent += 1;
            (contracted.1 < worst.1.min(reflected.1)).then_some(contracted)
        };
        match better {
            Some(corner) => corners[2] = corner,
            None => {
                for corner in &mut corners[1..] {
                    let place = [0, 1].map(|i| 0.5 * (best.0[i] + corner.0[i]));
                    *corner = (place, f(place));
                }
                spent += 2;
            }
        }
    }
    corners.sort_by(by_value);
    corners[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn golden_section_finds_the_bottom() {
        let (x, value) = golden_section([-3.0, 5.0], 40, |x| (x - 1.25) * (x - 1.25) + 2.0);
        println!("{x} {value}");
        assert!((x - 1.25).abs() < 1e-7 && (value - 2.0).abs() < 1e-12);
        let (edge, _) = golden_section([0.0, 1.0], 40, |x| x);
        assert!(edge < 1e-7, "a minimum at the end");
    }

    #[test]
    fn the_simplex_goes_down_a_curved_valley() {
        // Rosenbrock 1960; the minimum is at (1, 1).
        let valley = |[x, y]: [f64; 2]| {
            let (a, b) = (1.0 - x, y - x * x);
            a * a + 100.0 * b * b
        };
        let (place, value) = simplex([-1.2, 1.0], 0.5, 1e-16, 400, valley);
        println!("{place:?} {value:e}");
        assert!((place[0] - 1.0).abs() < 1e-5 && (place[1] - 1.0).abs() < 1e-5);
        let (_, early) = simplex([-1.2, 1.0], 0.5, 1e-16, 40, valley);
        assert!(early > 1e-6, "a fault would pass");
    }
}
