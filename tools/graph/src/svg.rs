//! The graph as a drawing: a column for each stage, in each box the inputs on its left side and the outputs on its
//! right one, as in a node editor. A wire to the next column is a curve; any other runs below the boxes, in a lane of
//! its own.

use std::fmt::Write as _;

use crate::processes::{Arrow, Graph, Process, Stage};

/// Width of a letter of the monospaced font, and height of a row, px.
const LETTER: f64 = 6.7;
const ROW: f64 = 16.0;
/// Height of a box's title, and padding at its edges, px.
const TITLE: f64 = 24.0;
const PAD: f64 = 8.0;
/// Margin between boxes, and around all of them, px.
const SPACE: f64 = 24.0;
/// From a box to the first lane that passes it, and from one lane to the next, px.
const REACH: f64 = 14.0;
const LANE: f64 = 5.0;
const INK: &str = "#282421";
const PALE: &str = "#7a706a";
const STAGES: [Stage; 4] = [Stage::Device, Stage::Brush, Stage::Paint, Stage::Viewer];

/// Colour of a stage and its outputs, from Okabe and Ito's palette for colour-blind readers.
fn colour(stage: Stage) -> &'static str {
    match stage {
        Stage::Device => "#0072b2",
        Stage::Brush => "#d55e00",
        Stage::Paint => "#009e73",
        Stage::Viewer => PALE,
    }
}

/// The rows of a box, with their anchor and colour.
fn rows(process: &Process) -> Vec<(String, &'static str, &'static str)> {
    let receives = process.receives.iter();
    let receives = receives.map(|topic| (topic.clone(), "start", INK));
    let sends = process.sends.iter().map(|sent| (sent.label(), "end", INK));
    let answers = process.answers.iter();
    let answers = answers.map(|topic| (format!("answers {topic}"), "start", PALE));
    receives.chain(sends).chain(answers).collect()
}

/// Place of a box: its upper left corner and its size, px.
#[derive(Clone, Copy, Debug)]
struct Place {
    x: f64,
    y: f64,
    width: f64,
    height: f64,
}

impl Place {
    /// Middle of a row, px.
    fn row(&self, row: usize) -> f64 {
        self.y + TITLE + ROW * (row as f64 + 0.5)
    }
}

/// Places of boxes and lanes.
struct Layout {
    boxes: Vec<Place>,
    /// Senders and topics whose wires run below the boxes, in the order of their lanes.
    lanes: Vec<(usize, usize)>,
    /// The first lane, px.
    bottom: f64,
    /// Size of the drawing, px.
    size: [f64; 2],
}

/// True for an arrow from one column to the next.
fn is_forward(graph: &Graph, arrow: &Arrow) -> bool {
    let column = |place: usize| graph.processes[place].stage as usize;
    column(arrow.to) == column(arrow.from) + 1
}

impl Layout {
    fn of(graph: &Graph) -> Self {
        let below = graph.arrows.iter();
        let below = below.filter(|arrow| !is_forward(graph, arrow));
        let mut lanes: Vec<_> = below.map(|arrow| (arrow.from, arrow.sent)).collect();
        // Arrows are in the order of their senders and topics.
        lanes.dedup();
        let gutter = 2.0 * (REACH + LANE * lanes.len() as f64) + REACH;
        let width = |process: &Process| {
            let rows = rows(process);
            let texts = rows.iter().map(|(text, ..)| text.chars().count());
            // The title is in larger letters.
            let widest = texts.max().unwrap_or(0);
            widest.max(process.name.chars().count() + 4) as f64 * LETTER + 2.0 * PAD
        };
        let mut boxes = Vec::new();
        let [mut x, mut bottom] = [gutter, SPACE];
        for stage in STAGES {
            let own = || graph.processes.iter().filter(|own| own.stage == stage);
            let Some(width) = own().map(width).reduce(f64::max) else {
                continue;
            };
            let mut y = SPACE;
            for process in own() {
                let height = TITLE + ROW * rows(process).len() as f64 + PAD;
                boxes.push(Place {
                    x,
                    y,
                    width,
                    height,
                });
                y += height + SPACE;
            }
            bottom = bottom.max(y);
            x += width + gutter;
        }
        let size = [x, bottom + 2.0 * LANE * lanes.len() as f64 + SPACE];
        Self {
            boxes,
            lanes,
            bottom,
            size,
        }
    }

    /// The wire of an arrow, as the data of a path, and its end.
    fn wire(&self, graph: &Graph, arrow: &Arrow) -> (String, [f64; 2]) {
        let [from, to] = [self.boxes[arrow.from], self.boxes[arrow.to]];
        let first = graph.processes[arrow.from].receives.len();
        let [x0, y0] = [from.x + from.width, from.row(first + arrow.sent)];
        let [x1, y1] = [to.x, to.row(arrow.received)];
        let lane = self
            .lanes
            .iter()
            .position(|lane| *lane == (arrow.from, arrow.sent));
        let wire = match lane.filter(|_| !is_forward(graph, arrow)) {
            Some(lane) => {
                let off = REACH + LANE * lane as f64;
                let y = self.bottom + 2.0 * LANE * lane as f64;
                let [out, back] = [x0 + off, x1 - off];
                format!("M{x0:.1} {y0:.1}H{out:.1}V{y:.1}H{back:.1}V{y1:.1}H{x1:.1}")
            }
            None => {
                let middle = 0.5 * (x0 + x1);
                format!("M{x0:.1} {y0:.1}C{middle:.1} {y0:.1} {middle:.1} {y1:.1} {x1:.1} {y1:.1}")
            }
        };
        (wire, [x1, y1])
    }
}

/// The drawing.
#[must_use]
pub fn text(graph: &Graph) -> String {
    let layout = Layout::of(graph);
    let [width, height] = layout.size;
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\" width=\"{width:.0}\" \
         height=\"{height:.0}\" font-family=\"monospace\" font-size=\"11\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n"
    );
    for arrow in &graph.arrows {
        let colour = colour(graph.processes[arrow.from].stage);
        let (wire, [x, y]) = layout.wire(graph, arrow);
        let [thick, opacity] = if graph.sent(arrow).rate_hz > 0.0 {
            [1.6, 1.0]
        } else {
            [1.0, 0.4]
        };
        writeln!(
            text,
            "<path d=\"{wire}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{thick}\" \
             stroke-linejoin=\"round\" opacity=\"{opacity}\"/>\n\
             <path d=\"M{x:.1} {y:.1}l-7 -3.5v7z\" fill=\"{colour}\"/>"
        )
        .ok();
    }
    for (process, place) in graph.processes.iter().zip(&layout.boxes) {
        add_box(&mut text, process, place);
    }
    text + "</svg>\n"
}

fn add_box(text: &mut String, process: &Process, place: &Place) {
    let Place {
        x,
        y,
        width,
        height,
    } = *place;
    let colour = colour(process.stage);
    let [left, right] = [x + PAD, x + width - PAD];
    let title = y + ROW;
    writeln!(
        text,
        "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" rx=\"4\" \
         fill=\"#faf8f4\" stroke=\"{colour}\"/>\n\
         <text x=\"{left:.1}\" y=\"{title:.1}\" font-size=\"13\" font-weight=\"bold\" fill=\"{colour}\">{}</text>",
        escaped(&process.name)
    )
    .ok();
    for (row, (words, anchor, colour)) in rows(process).into_iter().enumerate() {
        let x = if anchor == "end" { right } else { left };
        let y = place.row(row) + 4.0;
        writeln!(
            text,
            "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" fill=\"{colour}\">{}</text>",
            escaped(&words)
        )
        .ok();
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::processes::tests::studio;

    #[test]
    fn boxes_stand_apart_and_wires_end_at_them() {
        let graph = studio();
        let layout = Layout::of(&graph);
        assert_eq!(layout.boxes.len(), graph.processes.len());
        for (place, one) in layout.boxes.iter().enumerate() {
            assert!(one.x + one.width < layout.size[0] && one.y + one.height < layout.bottom);
            for other in &layout.boxes[..place] {
                let beside = other.x + other.width < one.x;
                let above = other.y + other.height < one.y;
                assert!(beside || above, "{one:?} {other:?}");
            }
        }
        for arrow in &graph.arrows {
            let (wire, [x, y]) = layout.wire(&graph, arrow);
            let to = &layout.boxes[arrow.to];
            assert!(x == to.x && (to.y..to.y + to.height).contains(&y), "{wire}");
            // Wires to other columns than the next pass below the boxes.
            assert_eq!(wire.contains('V'), !is_forward(&graph, arrow), "{wire}");
        }
    }

    #[test]
    fn each_process_is_named_and_each_arrow_has_a_head() {
        let graph = studio();
        let text = text(&graph);
        for process in &graph.processes {
            assert!(
                text.contains(&format!(">{}</text>", process.name)),
                "{text}"
            );
        }
        assert_eq!(text.matches("l-7 -3.5v7z").count(), graph.arrows.len());
        assert!(text.starts_with("<svg ") && text.ends_with("</svg>\n"));
        assert_eq!(escaped("a<b>&c"), "a&lt;b&gt;&amp;c");
    }
}
