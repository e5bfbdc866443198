//! IMPaSTo (Baxter 2004, ch. 6): how paint moves in one step of a brush on a surface.
//!
//! Input and output are a window on counted paint, the head of a brush and its load; not a quantum is lost. [`Impasto`]
//! is one [`PaintModel`](maulstick_model::interface::PaintModel); [`stages`] holds its stages, a file each, and
//! levelling at rest.
//!
//! The trace of a stroke is decided where bristles lift off: a film that bridges a gap splits, three tenths to the bristle, and
//! levels as far as the yield stress of what the brush has left allows. Paint flows within the head in every step: strips
//! that take turns would show along the stroke. `maulstick bench looks` measures ridges, streaks and films.
//!
//! A loaded round brush drawn 10 mm over a level ground:
//!
//! ```
//! use maulstick_brush::{BrushFile, Head};
//! use maulstick_canvas::{relief::Relief, store::TileStore, window::Window};
//! use maulstick_impasto::Impasto;
//! use maulstick_model::brush::head::Waypoint;
//! use maulstick_model::brush::load::{BrushLoad, Half};
//! use maulstick_model::brush::{scale::Scale, traits::BrushTraits};
//! use maulstick_model::interface::{Handling, PaintModel as _, Step};
//! use maulstick_model::path::PathStepper;
//! use maulstick_types::{Pose, brush::Solve};
//!
//! # fn main() -> Result<(), maulstick_brush::BrushError> {
//! let file = BrushFile::library("round")?;
//! let head = Head::of(&file);
//! let scale = Scale { cell_m: 2.5e-4, zoom: 1.0 };
//! let traits = BrushTraits::of(&file, scale.cell_m, scale.zoom);
//! let mut load = BrushLoad::clean(head.strips());
//! load.fill(&head, &traits, &[(0, 1.0)], None, (Half::Both, 1));
//! let loaded = load.total();
//!
//! let mut store = TileStore::new([128, 128]);
//! let all = store.around([0, 0], [128, 128]).expect("a surface");
//! let mut window = Window::open(&mut store, all, &Relief::flat(scale.cell_m)).expect("not leased");
//!
//! let at = |x_m: f64| {
//!     let solve = Solve {
//!         event_ns: 0,
//!         stroke: 1,
//!         surface: 0,
//!         flags: 0,
//!         pose: Pose { position_m: [x_m, 0.016, 0.6 * file.length_m()], ..Pose::IDENTITY },
//!         zoom: scale.zoom,
//!         angles_rad: vec![[0.2, 0.3]; file.spines.all_joints()],
//!         contacts: Vec::new(),
//!     };
//!     Waypoint::of(&solve, scale, 1.0)
//! };
//! let mut impasto = Impasto::default();
//! let mut path = PathStepper::begin(&head, at(0.01), scale);
//! let mut wiped = 0;
//! path.advance(&head, (at(0.02), 0), |sweep, _| {
//!     let report = impasto.step(&mut Step {
//!         window: &mut window,
//!         head: &head,
//!         sweep,
//!         bounds: ([0, 0], [128, 128]),
//!         load: &mut load,
//!         traits,
//!         handling: Handling::default(),
//!         stain: 0.0,
//!         lasting: false,
//!         thinner: None,
//!     });
//!     wiped += report.lifted.iter().sum::<u64>();
//! });
//! let left: f64 = window.plane(0).expect("painted").iter().map(|count| f64::from(*count)).sum();
//! assert!(left > 0.0);
//! // What went over the border is wiped off.
//! assert_eq!(left as u64 + load.total() + wiped, loaded);
//! # Ok(())
//! # }
//! ```
//!
//! # On a device
//!
//! Whole steps, with the feature `device`: an indirect dispatch skips the rest where nothing is touched; the requests
//! to one donor are summed in integers before they are truncated, so the ledger balances to zero.
//!
//! # Notes on the step
//!
//! - Order (Baxter 2004, fig. 6.3): footprint, velocity, advection, exchange both ways, flow within the head. Every stage
//!   has an f64 oracle in `tests/oracle`, and every comparison a seeded fault.
//! - Velocities are found for faces between cells; paint goes through them one axis after the other with van Leer's
//!   limiter, truncated to quanta. Nothing divides converging paint, so it piles up. A global pressure would add to the
//!   velocities of the faces.
//! - The squish −c·∇p is an explicit diffusion of coefficient c·h, bounded by .04. Central differences in cells grow
//!   speckles above .2; differences across faces do not.
//! - Between the ride of a bristle and the relief lies a gap, which its film fills beyond the gap's height, 16
//!   times as fast as films even out; a bridging film splits, and the bristle keeps 3/10. So a full brush fills most of the tooth, an
//!   empty one catches on peaks, a light one on dry ridges. A brush with a limit (a glaze) leaves up to as much again
//!   in hollows, and has no limit on a palette, where paints are mixed.
//! - Colour travels by a skin that bristle and paint shear between them wherever their films touch, both ways, so also
//!   where they are equal: the wider the gap, the less. The stroke of a white brush through wet blue stays bluish for a
//!   hand's length. A brush that hardly presses glides: it shears by the square of its press.
//! - Wet paint lies in two sheets. What is laid last lies on top: a light stroke covers what is wet, broken where it
//!   starves, and takes from the upper sheet alone. Bristles that plough through work the two into one. Light sees body
//!   and sheet in order. Where there is one paint there is one sheet, and one is paid for.
//! - A deposit is spread along its step, over cells that the bristles touch, too; otherwise every second row would have
//!   another bristle as its last. What is pushed over the border of the surface is wiped off.
//! - A badger exchanges more than it takes up, so it softens. A blade floats on its paint by its pressure, takes up
//!   what stands above its edge and fills what lies below: it scrapes and deposits slabs.
//! - The lowest strip of a cell depends on the cell size. To keep the trace of a brush independent of it, paint flows
//!   in every strip and seeps between neighbours, down to a difference held by the yield stress, which keeps streaks.
//!   Along a strip a thin film clings: what a clean brush takes up stays near its tips, and a brush that is painted out
//!   starves bristle by bristle.
//! - Levelling belongs to the stroke. Under moving bristles, a hundredth of a second a cell, it is not measurable.
//!   Heights go through sixteen rounds before all paints follow by their sum; blocks without flow rest; cells up to
//!   .5 mm flow on coarser grids first. Paint that a brush has worked yields at 12 Pa, and at its rest stress within
//!   tenths of a second, by pigment: so the ridges of bristles stand. Thinner takes that away: thinned paint flows for
//!   17 s, off ridges and onto bare ground.

#[cfg(feature = "device")]
pub mod device;
mod entry;
pub mod stages;

pub use entry::ENTRY;
pub use stages::Impasto;
