//! Numbers of strokes: contacts separated by less than a gap share one.

/// Gap between contacts from which they are two strokes, ns.
const STROKE_GAP_NS: u64 = 150_000_000;

/// Numbers the strokes of a brush, from 1.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct StrokeCount {
    number: u64,
    end_ns: u64,
}

impl StrokeCount {
    /// The number of the newest stroke; 0 before the first.
    #[must_use]
    pub(crate) const fn number(self) -> u64 {
        self.number
    }

    /// Extends the newest stroke to `ns`, with or without contact.
    pub(crate) const fn extend(&mut self, ns: u64) {
        self.end_ns = ns;
    }

    /// The stroke of a contact at `ns`.
    pub(crate) const fn touch(&mut self, ns: u64) -> u64 {
        if self.number == 0 || ns.abs_diff(self.end_ns) >= STROKE_GAP_NS {
            self.number += 1;
        }
        self.end_ns = ns;
        self.number
    }
}
