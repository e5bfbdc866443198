//! Pairing of the surfaces of two neighbouring columns (the correspondence problem of surfaces from cross-sections; Meyers,
//! Skinner and Sloan 1992, *Surfaces from contours*).
//!
//! A column is a list of the ends of its pieces from the lowest up: the top of the paint on the ground, then bottom and
//! top of each piece over air. So even ends are tops, odd ones bottoms. Overlapping pieces of two columns form one
//! piece between them: an edge joins their lowest bottoms, another their highest tops. Pieces and gaps that the other
//! column lacks are capped in between, at a cusp. No two of these edges cross.

/// Place of the cusp between its column and the next: short of that, or cusps from opposite sides would touch.
pub(super) const CUSP: f64 = 127.0 / 128.0;
/// The same in walls: short of that, or it would be where the cusp of the surface beside the wall is.
pub(super) const WALL_CUSP: f64 = 63.0 / 64.0;

/// Cap of a piece or a gap that one column alone has, between end `end` of its column and the next one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Cap {
    /// True if the second column has it.
    pub(super) is_second: bool,
    /// Lower end: even for a gap, odd for a piece.
    pub(super) end: usize,
}

/// Edges and caps between two columns. It is empty between columns of one end each, whose ends are joined.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct ColumnPairing {
    /// Edges: an end of the first column, and one of the second.
    pub(super) joined: Vec<[usize; 2]>,
    /// Pieces and gaps that are capped.
    pub(super) caps: Vec<Cap>,
}

impl ColumnPairing {
    /// The pairing of columns of these ends.
    pub(super) fn between(a: &[f32], b: &[f32]) -> Self {
        let mut pairing = Self::default();
        if a.len() == 1 && b.len() == 1 {
            return pairing;
        }
        // The highest tops so far.
        let (mut i, mut j) = (0, 0);
        loop {
            // The piece in which both are grows while one of its columns has more that the other overlaps.
            loop {
                if i + 2 < a.len() && a[i + 1] <= b[j] {
                    pairing.cap(false, i);
                    i += 2;
                } else if j + 2 < b.len() && b[j + 1] <= a[i] {
                    pairing.cap(true, j);
                    j += 2;
                } else {
                    break;
                }
            }
            pairing.joined.push([i, j]);
            loop {
                match (i + 2 < a.len(), j + 2 < b.len()) {
                    (false, false) => return pairing,
                    (true, true) if a[i + 1] <= b[j + 2] && b[j + 1] <= a[i + 2] => break,
                    (true, other) if !other || a[i + 1] < b[j + 1] => {
                        pairing.cap(false, i + 1);
                        i += 2;
                    }
                    _ => {
                        pairing.cap(true, j + 1);
                        j += 2;
                    }
                }
            }
            pairing.joined.push([i + 1, j + 1]);
            (i, j) = (i + 2, j + 2);
        }
    }

    fn cap(&mut self, is_second: bool, end: usize) {
        self.caps.push(Cap { is_second, end });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cap(is_second: bool, end: usize) -> Cap {
        Cap { is_second, end }
    }

    #[test]
    fn pieces_that_overlap_are_joined_and_others_close() {
        let overhang = ColumnPairing::between(&[1.0, 5.0, 6.0], &[2.0]);
        assert_eq!(overhang.joined, [[0, 0]]);
        assert_eq!(overhang.caps, [cap(false, 1)]);
        let ledge = ColumnPairing::between(&[1.0, 5.0, 6.0], &[5.5]);
        assert_eq!(
            (ledge.joined, ledge.caps),
            (vec![[2, 0]], vec![cap(false, 0)])
        );
        let sheet = ColumnPairing::between(&[1.0, 5.0, 6.0], &[2.0, 5.5, 7.0]);
        assert_eq!(sheet.joined, [[0, 0], [1, 1], [2, 2]]);
        assert!(sheet.caps.is_empty());
        let fork = ColumnPairing::between(&[0.0, 4.0, 8.0], &[0.0, 3.0, 5.0, 7.0, 9.0]);
        assert_eq!(fork.joined, [[0, 0], [1, 1], [2, 4]]);
        assert_eq!(fork.caps, [cap(true, 2)]);
    }

    /// Every end has one line, and lines keep the order of their ends.
    #[test]
    fn no_lines_cross() {
        let mut state = 7u32;
        let mut next = |most: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 16) % most
        };
        for _ in 0..5000 {
            let mut column = || {
                let (mut ends, mut at) = (vec![next(4) as f32], 4.0);
                for _ in 0..2 * next(4) {
                    at += 1.0 + next(4) as f32;
                    ends.push(at);
                }
                ends
            };
            let (a, b) = (column(), column());
            let pairing = ColumnPairing::between(&a, &b);
            if a.len() == 1 && b.len() == 1 {
                continue;
            }
            let mut met = [vec![0; a.len()], vec![0; b.len()]];
            let mut lines: Vec<[f32; 2]> = Vec::new();
            for [i, j] in &pairing.joined {
                assert_eq!(i % 2, j % 2);
                (met[0][*i], met[1][*j]) = (met[0][*i] + 1, met[1][*j] + 1);
                lines.push([a[*i], b[*j]]);
            }
            for cap in &pairing.caps {
                let (side, own) = if cap.is_second { (1, &b) } else { (0, &a) };
                let middle = 0.5 * (own[cap.end] + own[cap.end + 1]);
                for end in [cap.end, cap.end + 1] {
                    met[side][end] += 1;
                    lines.push(if side == 1 {
                        [middle, own[end]]
                    } else {
                        [own[end], middle]
                    });
                }
            }
            assert!(met.iter().flatten().all(|times| *times == 1), "{a:?} {b:?}");
            for one in &lines {
                for other in &lines {
                    assert!(
                        (one[0] - other[0]) * (one[1] - other[1]) >= 0.0,
                        "{a:?} {b:?}"
                    );
                }
            }
        }
    }
}
