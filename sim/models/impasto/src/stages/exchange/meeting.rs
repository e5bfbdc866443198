//! What a contact demands from the brush, and offers to it.

use maulstick_canvas::quantum::{CELL_MAX, QUANTA_PER_UNIT};
use maulstick_model::brush::traits::BrushTraits;
use maulstick_model::footprint::contact::Contact;
use maulstick_model::interface::{Handling, Transfer};
use maulstick_model::transfer::{Exchanging, POOL};
use maulstick_num::select::{larger, smaller};
use maulstick_num::wide;

/// [`Meeting`]s, a plane each.
#[derive(Clone, Debug, Default)]
pub(super) struct Meetings {
    pub travel: Vec<f32>,
    cover: Vec<f32>,
    on_brush: Vec<f32>,
    pub lying: Vec<f32>,
    pub fraction: Vec<f32>,
    gap: Vec<f32>,
}

impl Meetings {
    /// Meetings of contacts; what lies on their cells is known.
    pub(super) fn of(&mut self, contacts: &[Contact], films: &[u32], traits: &BrushTraits) {
        let on_brush = |contact: &Contact| {
            films[contact.texel as usize] as f32 * traits.film_units_per_quantum
        };
        for plane in [
            &mut self.travel,
            &mut self.cover,
            &mut self.on_brush,
            &mut self.fraction,
            &mut self.gap,
        ] {
            plane.clear();
        }
        self.travel
            .extend(contacts.iter().map(|contact| contact.travel(traits)));
        self.cover
            .extend(contacts.iter().map(|contact| contact.cover));
        self.on_brush.extend(contacts.iter().map(on_brush));
        self.fraction
            .extend(contacts.iter().map(|contact| contact.fraction));
        let gap = |contact: &Contact| contact.gap * traits.units_per_cell;
        self.gap.extend(contacts.iter().map(gap));
    }
}

/// State of a contact before the exchange.
#[derive(Clone, Copy, Debug, Default)]
struct Meeting {
    /// Path of the brush, reference cells.
    travel: f32,
    /// Share of the cell that is covered, 0 to 1.
    cover: f32,
    /// The brush's film, units.
    on_brush: f32,
    /// Wet paint on the cell, quanta.
    lying: f32,
    /// Share of it that the brush reaches.
    fraction: f32,
    /// Gap between brush and paint, units.
    gap: f32,
}

/// Demand of a contact: quanta from the brush, and to it.
#[must_use]
#[inline(always)]
fn wanted(meeting: &Meeting, rule: &Exchanging, handling: &Handling) -> [f32; 2] {
    let quanta = meeting.cover * QUANTA_PER_UNIT as f32;
    let lying = meeting.lying * (1.0 / QUANTA_PER_UNIT as f32);
    let on_canvas = lying * meeting.fraction * rule.shears;
    let (net, swap) = match handling.transfer {
        Transfer::Marker { flow } => (flow * meeting.travel, 0.0),
        _ => {
            let share = rule.share(meeting.travel);
            let amounts = [meeting.on_brush, on_canvas, lying, meeting.gap];
            let net = rule.transfer(amounts, meeting.travel, share);
            let wet = [meeting.on_brush, lying, larger(meeting.gap, 0.0)];
            (net, rule.swapped(wet, meeting.travel))
        }
    };
    let hollow = larger(meeting.gap, 0.0) * QUANTA_PER_UNIT as f32;
    let pool = smaller(hollow, POOL * handling.most);
    let most = smaller(handling.most + pool, CELL_MAX as f32);
    let room = larger(most - meeting.lying, 0.0);
    // Swapped paint has room on both sides, or stays on both.
    let swap = smaller(swap * quanta, room);
    let given = smaller(larger(net, 0.0) * quanta + swap, room);
    let taken = smaller(larger(-net, 0.0) * quanta + swap, meeting.lying);
    [given.floor(), taken.floor()]
}

wide! {
    /// Demands of all contacts: quanta from the brush, and to it.
    pub(super) fn want(
        meetings: &Meetings,
        rule: &Exchanging,
        handling: &Handling,
        wants: &mut [Vec<f32>; 2],
    ) {
        let count = meetings.travel.len();
        let [given, taken] = wants;
        for plane in [&mut *given, &mut *taken] {
            plane.clear();
            plane.resize(count, 0.0);
        }
        let (given, taken) = (&mut given[..count], &mut taken[..count]);
        let (travel, cover) = (&meetings.travel[..count], &meetings.cover[..count]);
        let (on_brush, lying) = (&meetings.on_brush[..count], &meetings.lying[..count]);
        let (fraction, gap) = (&meetings.fraction[..count], &meetings.gap[..count]);
        for i in 0..count {
            let meeting = Meeting {
                travel: travel[i],
                cover: cover[i],
                on_brush: on_brush[i],
                lying: lying[i],
                fraction: fraction[i],
                gap: gap[i],
            };
            [given[i], taken[i]] = wanted(&meeting, rule, handling);
        }
    }
}
