//! A primed plain weave: threads that pass over and under each other, with the unevenness of spun flax, and the gesso
//! in the valleys between them.
//!
//! Each thread has a width and a strength of its own and wanders a little. Here and there it has a *slub*, a thick
//! place a few threads long that was spun in, which stands higher and pushes its neighbours aside. Flax has many of
//! them, cotton few. The gesso is scraped on: it is level in the valleys, thin over the threads, and uneven in amount.

use super::lattice_noise::{LatticeNoise, ease};

/// Variation of the width of a thread, in thread spacings.
const UNEVEN: f64 = 0.26;
/// Common wander of all threads.
const WANDER: f64 = 0.3;
/// Sine and cosine of the angle of the threads against the cells: 4°.
const TURNED: [f64; 2] = [0.069_756_474, 0.997_564_05];
/// Range of the drift of the threads, in thread spacings.
const DRIFT: f64 = 4.0;
/// Waves of the drift per thread spacing, across and along.
const DRIFT_WAVES: [f64; 2] = [0.05, 0.02];
/// Extra width of a thread at its slub.
const SLUB_WIDTH: f64 = 0.34;
/// Length of a slub with the thin stretch to the next, in thread spacings.
const SLUB_LENGTH: f64 = 5.0;
/// Height of the gesso in the valleys, relative to the depth of the relief, and its variation.
const GESSO: [f64; 2] = [0.24, 0.1];
/// Height of the gesso's meniscus on the flank of a thread.
const MENISCUS: f64 = 0.24;

/// A weave with a mean thread spacing of 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Weave<'a> {
    /// Its randomness.
    pub noise: &'a LatticeNoise,
    /// Share of the threads' length that is slubs, 0 to 1.
    pub slubs: f64,
}

/// Position in a thread.
#[derive(Clone, Copy, Debug)]
struct Thread {
    number: i64,
    /// Place across the thread, from edge to edge, 0 to 1.
    across: f64,
    slub: f64,
}

impl Thread {
    /// Height of its round back, 0 at the edges to 1.
    fn arch(&self) -> f64 {
        let off = 2.0 * self.across - 1.0;
        1.0 - off * off
    }
}

impl Weave<'_> {
    /// Height at a place, about 0 to 1.
    pub(crate) fn height(&self, [x, y]: [f64; 2]) -> f64 {
        let noise = self.noise;
        let [x, y] = self.laid([x, y]);
        let wander = |axis: u64, along: f64, across: f64| {
            WANDER * (noise.at(axis, [0.31 * across, 0.11 * along]) - 0.5)
        };
        let warp = self.thread(3, x + wander(1, y, x), y);
        let weft = self.thread(4, y + wander(2, x, y), x);
        let warp_over = (warp.number + weft.number).rem_euclid(2) == 0;
        let over = if warp_over { 1.0 } else { -1.0 };
        // A thread is highest where it passes over another one, and lowest under it.
        let back = |axis: u64, thread: &Thread, over: f64, other: f64| {
            let own = 0.58 + 0.26 * noise.hash(axis, [thread.number, 0]) + 0.24 * thread.slub;
            own * thread.arch() * (0.56 + 0.44 * over * other)
        };
        let top = back(3, &warp, over, weft.arch()).max(back(4, &weft, -over, warp.arch()));
        let grain = noise.at(5, [3.1 * x, 3.1 * y]) - 0.5;
        let level = GESSO[0] + 2.0 * GESSO[1] * (noise.at(6, [0.23 * x, 0.23 * y]) - 0.5);
        smooth_max(top + 0.05 * grain, level + 0.03 * grain, MENISCUS)
    }

    /// A place in threads: the weave lies some degrees off the cells, and its threads run closer here and wider there,
    /// so that nothing repeats at their mean spacing.
    fn laid(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [sine, cosine] = TURNED;
        let [x, y] = [x * cosine - y * sine, x * sine + y * cosine];
        let drift = |axis: u64, along: f64, across: f64| {
            let place = [DRIFT_WAVES[0] * across, DRIFT_WAVES[1] * along];
            DRIFT * (self.noise.at(axis, place) - 0.5)
        };
        [x + drift(21, y, x), y + drift(22, x, y)]
    }

    /// The thread of an axis at `across`, at `along` its length.
    fn thread(&self, axis: u64, across: f64, along: f64) -> Thread {
        let mut number = across.floor() as i64;
        let slub = |number: i64| self.slub(axis, number, along);
        // The edges of a thread, moved by less than half a distance.
        let edge = |number: i64, below: f64, above: f64| {
            let own = UNEVEN * (self.noise.hash(axis + 8, [number, 1]) - 0.5);
            number as f64 + own + 0.5 * SLUB_WIDTH * (below - above)
        };
        let mut slubs = [number - 1, number, number + 1].map(slub);
        let mut low = edge(number, slubs[0], slubs[1]);
        let mut high = edge(number + 1, slubs[1], slubs[2]);
        if across < low {
            number -= 1;
            slubs = [slub(number - 1), slubs[0], slubs[1]];
            (low, high) = (edge(number, slubs[0], slubs[1]), low);
        } else if across >= high {
            number += 1;
            slubs = [slubs[1], slubs[2], slub(number + 1)];
            (low, high) = (high, edge(number + 1, slubs[1], slubs[2]));
        }
        Thread {
            number,
            across: (across - low) / (high - low),
            slub: slubs[1],
        }
    }

    /// Additional thickness of a thread: 0 to 1, at the middle of a slub.
    fn slub(&self, axis: u64, number: i64, along: f64) -> f64 {
        let noise = self.noise.along(axis + 16, number, along / SLUB_LENGTH);
        let least = 1.0 - self.slubs;
        ease(((noise - least) / self.slubs.max(1e-3)).clamp(0.0, 1.0))
    }
}

/// The greater of two, rounded where they differ by less than `width`.
fn smooth_max(a: f64, b: f64, width: f64) -> f64 {
    let near = (width - (a - b).abs()).max(0.0) / width;
    a.max(b) + 0.25 * width * near * near
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn threads_are_uneven_and_slubs_push_their_neighbours_aside() {
        let widths = |slubs: f64, along: f64| -> Vec<f64> {
            let noise = &LatticeNoise::new(5);
            let weave = Weave { noise, slubs };
            let mut edges = Vec::new();
            let mut last = weave.thread(3, 0.0, along).number;
            for step in 1..40_000 {
                let across = f64::from(step) * 1e-3;
                let number = weave.thread(3, across, along).number;
                assert!(number == last || number == last + 1, "threads lie in order");
                if number > last {
                    edges.push(across);
                }
                last = number;
            }
            edges.windows(2).map(|pair| pair[1] - pair[0]).collect()
        };
        let spread = |widths: &[f64]| {
            let ends = widths.iter().fold((f64::MAX, f64::MIN), |(low, high), v| {
                (low.min(*v), high.max(*v))
            });
            println!("{} threads, widths {ends:.2?}", widths.len());
            ends
        };
        let plain = spread(&widths(0.0, 0.3));
        assert!(plain.0 > 0.7 && plain.1 < 1.3 && plain.1 - plain.0 > 0.2);
        let flax = spread(&widths(0.3, 0.3));
        assert!(flax.1 > plain.1 && flax.0 > 0.35);
    }

    #[test]
    fn the_surface_has_no_steps_but_where_threads_cross() {
        // At the boundary between threads both backs are at 0: gesso joins them.
        let noise = &LatticeNoise::new(5);
        let weave = Weave { noise, slubs: 0.3 };
        let row: Vec<f64> = (0..60_000)
            .map(|i| weave.height([f64::from(i) * 1e-3, 7.3]))
            .collect();
        let steepest = row.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        let steepest = steepest.fold(0.0, f64::max);
        println!("steepest {:.1} a thread", steepest / 1e-3);
        assert!(steepest < 6e-3, "{steepest}");
        let low = row.iter().copied().fold(f64::MAX, f64::min);
        assert!(low > GESSO[0] - 1.5 * GESSO[1], "{low}: valleys are filled");
    }
}
