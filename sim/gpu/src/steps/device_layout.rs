//! A window and a load while they are on the device.

use bytemuck::{cast_slice, pod_collect_to_vec};
use maulstick_brush::Head;
use maulstick_brush::head::STATIONS;
use maulstick_canvas::quantum::SLOTS;
use maulstick_canvas::window::Window;
use maulstick_model::brush::load::BrushLoad;
use maulstick_model::interface::Step;
use maulstick_types::paint::TILE;

/// Greatest buffer that every device can bind, bytes.
const MOST_BYTES: usize = 128 << 20;
/// Greatest number of bits of a key that number a segment; the others hold the score.
const MOST_BITS: u32 = 17;

/// Shader-visible layout of a window and a brush load.
#[derive(Clone, Debug)]
pub struct DeviceLayout {
    /// Slots of the paints, in order of plane.
    pub slots: Vec<usize>,
    /// True if as many planes follow with what is in the upper sheet.
    pub sheets: bool,
    /// Number of cells of the window.
    pub cells: usize,
    /// Number of texels of the brush.
    pub texels: usize,
    /// Number of strips of the brush.
    pub strips: usize,
    /// Number of faces of its skin.
    pub faces: usize,
    /// Number of points of its skin.
    pub vertices: usize,
    /// Number of steps with contact before.
    steps: u64,
}

/// State read back from the device.
pub struct Settled {
    /// Rows of the window.
    pub rows: std::ops::Range<usize>,
    /// Counts on those rows, paint after paint.
    pub planes: Vec<f32>,
    /// Load of the brush, in the layout of step.wgsl.
    pub load: Vec<u32>,
    /// Greatest height of paint over all steps, quanta.
    pub top: f32,
}

impl DeviceLayout {
    /// Layout of a step's window and load, with the upper sheets where the model has `sheets`; `None` where they are too
    /// large for the device.
    pub fn new(step: &Step<'_>, sheets: bool) -> Option<Self> {
        let head = step.head;
        let in_use = |slot: &usize| step.window.has(*slot) || step.load.has(*slot);
        let slots: Vec<usize> = (0..SLOTS).filter(in_use).collect();
        let layout = Self {
            sheets: sheets && step.may_have_sheets(),
            slots,
            cells: step.window.width() * step.window.height(),
            texels: step.load.texels(),
            strips: head.strips(),
            faces: head.skin().map_or(0, |skin| skin.faces().len()),
            vertices: head.skin().map_or(0, |skin| skin.places().len()),
            steps: step.load.steps(),
        };
        let fits = layout.has_room(layout.cells as u64)
            && 4 * layout.load_words() <= MOST_BYTES
            && layout.segment_bits() <= MOST_BITS;
        fits.then_some(layout)
    }

    /// True if a grid with this number of cells fits.
    pub fn has_room(&self, cells: u64) -> bool {
        cells * self.bytes_by_cell() as u64 <= MOST_BYTES as u64
    }

    /// A cell of the grid takes up to 32 bytes, of the window 4 a plane.
    fn bytes_by_cell(&self) -> usize {
        (4 * self.planes_in_use()).max(32)
    }

    /// Number of planes of the window.
    pub fn planes_in_use(&self) -> usize {
        self.slots.len() * (1 + usize::from(self.sheets))
    }

    /// Number of steps with contact before.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Number of segments of the drawn head.
    pub fn segments(&self) -> usize {
        2 * self.faces + self.strips * (STATIONS - 1)
    }

    /// Number of bits that number a segment, with one value to spare.
    pub fn segment_bits(&self) -> u32 {
        usize::BITS - self.segments().leading_zeros()
    }

    /// The plane of a paint; `u32::MAX` where it is not in use.
    pub fn plane_of(&self, slot: usize) -> u32 {
        let place = self.slots.iter().position(|of| *of == slot);
        place.map_or(u32::MAX, |place| place as u32)
    }

    /// By slot, the excess of the settled state over the current window and load.
    pub fn gained(&self, settled: &Settled, window: &Window, load: &BrushLoad) -> [i64; SLOTS] {
        let mut gained = [0; SLOTS];
        let run = settled.rows.start * window.width()..settled.rows.end * window.width();
        let sum = |plane: &[f32]| plane.iter().map(|count| *count as i64).sum::<i64>();
        let carried = load.counts();
        for (place, slot) in self.slots.iter().enumerate() {
            let lies = &settled.planes[place * run.len()..][..run.len()];
            let lay = window
                .plane(*slot)
                .map_or(0, |plane| sum(&plane[run.clone()]));
            let parts = [place, self.slots.len() + place];
            let carries = parts
                .iter()
                .flat_map(|part| &settled.load[1 + (1 + part) * self.texels..][..self.texels]);
            let carries: i64 = carries.map(|count| i64::from(*count)).sum();
            gained[*slot] = sum(lies) - lay + carries - carried[*slot] as i64;
        }
        gained
    }

    /// Size of the load, words.
    pub fn load_words(&self) -> usize {
        1 + (1 + 2 * self.slots.len()) * self.texels
    }

    /// Size of the poses of one drawing of the head, words.
    pub fn poses_words(&self) -> usize {
        (5 * STATIONS + 2) * self.strips + 5 * self.vertices
    }

    /// Size of the requests to the brush, words.
    pub fn asks_words(&self) -> usize {
        (2 + self.slots.len()) * self.texels + 2 * self.strips
    }

    /// Constant geometry of the head, in the layout of the shaders.
    pub fn head(&self, head: &Head) -> Vec<u32> {
        let mut words = Vec::new();
        if let Some(skin) = head.skin() {
            words.extend(skin.faces().iter().flatten());
            words.extend(skin.places().iter().flatten().map(|place| place.to_bits()));
        }
        let around = (0..self.strips)
            .map(|place| head.strip_around((place as f32 + 0.5) / self.strips as f32) as u32);
        words.extend(around);
        words.extend(head.capacity().iter().map(|share| share.to_bits()));
        words.extend(head.beside().iter().flatten());
        words
    }

    /// Load of the brush, in the layout of step.wgsl.
    pub fn load(&self, load: &BrushLoad) -> Vec<u32> {
        let mut words = Vec::with_capacity(self.load_words());
        words.push(load.steps() as u32);
        words.extend_from_slice(load.films());
        let planes = [BrushLoad::film_of, BrushLoad::inside];
        for plane in planes {
            for slot in &self.slots {
                match plane(load, *slot) {
                    Some(counts) => words.extend_from_slice(counts),
                    None => words.resize(words.len() + self.texels, 0),
                }
            }
        }
        words
    }

    /// Planes of the window as bytes; `nothing` stands for one without paint.
    pub fn planes<'a>(&self, window: &'a Window, nothing: &'a [f32]) -> Vec<&'a [u8]> {
        let all = self.slots.iter().map(|slot| window.plane(*slot));
        let upper = self.slots.iter().filter(|_| self.sheets);
        let planes = all.chain(upper.map(|slot| window.upper(*slot)));
        planes
            .map(|plane| cast_slice(plane.unwrap_or(nothing)))
            .collect()
    }

    /// Writes the settled state into window and load.
    pub fn write(&self, settled: &Settled, window: &mut Window, load: &mut BrushLoad) {
        self.write_planes(settled, window);
        self.write_load(settled, load);
        window.note_top(settled.top);
    }

    fn write_planes(&self, settled: &Settled, window: &mut Window) {
        let (width, first) = (window.width(), settled.rows.start);
        let cells = settled.rows.len() * width;
        let mut changed = Vec::new();
        let places = self.slots.iter().chain(&self.slots).enumerate();
        for ((place, slot), counts) in places.zip(settled.planes.chunks_exact(cells)) {
            let is_upper = place >= self.slots.len();
            let known = if is_upper {
                window.upper(*slot)
            } else {
                window.plane(*slot)
            };
            if known.is_none() && counts.iter().all(|count| *count == 0.0) {
                continue;
            }
            let plane = if is_upper {
                let [_, upper] = window.sheets_mut(*slot);
                upper
            } else {
                window.plane_mut(*slot)
            };
            let plane = &mut plane[first * width..][..cells];
            // A row of a tile at a time.
            let rows = plane.chunks_exact_mut(TILE).zip(counts.chunks_exact(TILE));
            for (place, (now, counts)) in rows.enumerate() {
                if now != counts {
                    now.copy_from_slice(counts);
                    changed.push(place * TILE);
                }
            }
        }
        for place in changed {
            let (x, y) = (place % width, first + place / width);
            window.touch(([x, y], [x + 1, y + 1]));
        }
    }

    fn write_load(&self, settled: &Settled, load: &mut BrushLoad) {
        let words = &settled.load;
        // Counted modulo 2³².
        let made = words[0].wrapping_sub(self.steps as u32);
        let parts: Vec<&[u32]> = words[1..].chunks_exact(self.texels.max(1)).collect();
        let Some((films, planes)) = parts.split_first() else {
            return;
        };
        let (film, inside) = planes.split_at(self.slots.len());
        let is_there = |slot: usize, parts: [&[u32]; 2]| {
            load.has(slot) || parts.iter().any(|part| part.iter().any(|count| *count > 0))
        };
        let pairs = film
            .iter()
            .zip(inside)
            .map(|(film, inside)| [*film, *inside]);
        let held = self.slots.iter().zip(pairs);
        let held = held
            .filter(|(slot, parts)| is_there(**slot, *parts))
            .map(|(slot, parts)| (*slot, parts.map(<[u32]>::to_vec)));
        let steps = self.steps + u64::from(made);
        let settled = BrushLoad::of_planes(steps, films.to_vec(), held.collect());
        if let Some(settled) = settled.filter(|settled| settled != load) {
            *load = settled;
        }
    }
}

impl Settled {
    /// Decodes a read-back: counts of `words` words, then the load.
    pub fn read(bytes: &[u8], words: usize, rows: std::ops::Range<usize>, top: f32) -> Self {
        let (planes, load) = bytes.split_at(words * size_of::<f32>());
        Self {
            rows,
            planes: pod_collect_to_vec(planes),
            load: pod_collect_to_vec(load),
            top,
        }
    }
}
