//! Strokes of a take, as a list.

use maulstick_device::Take;
use maulstick_motion::strokes::bounds;
use maulstick_motion::{Stroke, strokes};
use maulstick_rig::UserError;
use serde_json::json;

use maulstick::commands::table::table;
use maulstick::commands::{print_json, print_text, say};
use maulstick_tool_options::motions::StrokesOptions;

use crate::recorded::read_motion;

/// Measures of a stroke.
struct Measures {
    start_s: f64,
    seconds: f64,
    way_mm: f64,
    /// Least x and y, then greatest, mm from the middle of the desk.
    box_mm: [f64; 4],
}

impl Measures {
    fn of(take: &Take, stroke: &Stroke, head_m: f64) -> Self {
        let path = stroke.path(&take.samples, head_m);
        let step = |pair: &[[f64; 3]]| {
            let [x, y] = [0, 1].map(|axis| pair[1][axis] - pair[0][axis]);
            (x * x + y * y).sqrt()
        };
        let way_m: f64 = path.windows(2).map(step).sum();
        let own = std::slice::from_ref(stroke);
        let [least, most] = bounds(&take.samples, own, head_m).unwrap_or_default();
        Self {
            start_s: stroke.start_ns as f64 * 1e-9,
            seconds: stroke.length_ns as f64 * 1e-9,
            way_mm: 1e3 * way_m,
            box_mm: [least[0], least[1], most[0], most[1]].map(|m| 1e3 * m),
        }
    }
}

pub(crate) fn run(options: &StrokesOptions) -> Result<i32, UserError> {
    let take = read_motion(&options.take, options.device.as_deref())?;
    let head_m = options.head.length_m(&take, &options.take)?;
    let strokes = strokes(&take.samples, head_m);
    let measures = strokes
        .iter()
        .map(|stroke| Measures::of(&take, stroke, head_m));
    let measures: Vec<Measures> = measures.collect();
    let seconds = take.length_ns() as f64 * 1e-9;
    if options.json {
        let one = |(number, own): (usize, &Measures)| {
            json!({
                "stroke": number + 1,
                "start_s": own.start_s,
                "seconds": own.seconds,
                "way_mm": own.way_mm,
                "box_mm": own.box_mm,
            })
        };
        let all: Vec<_> = measures.iter().enumerate().map(one).collect();
        print_json(&json!({ "seconds": seconds, "strokes": all }))?;
        return Ok(0);
    }
    let row = |(number, own): (usize, &Measures)| {
        let [x0, y0, x1, y1] = own.box_mm;
        [
            (number + 1).to_string(),
            format!("{:.2} s", own.start_s),
            format!("{:.2} s", own.seconds),
            format!("{:.1} mm", own.way_mm),
            format!("{x0:.1},{y0:.1} to {x1:.1},{y1:.1} mm"),
        ]
    };
    let rows: Vec<[String; 5]> = measures.iter().enumerate().map(row).collect();
    print_text(&table(
        [
            "stroke",
            "start",
            "takes",
            "way",
            "from the middle of the desk",
        ],
        &rows,
    ))?;
    say!("{} strokes over {seconds:.2} s", rows.len());
    Ok(0)
}
