//! IMPaSTo (Baxter 2004, ch. 6): how paint moves in one step of a brush on a surface.
//!
//! Pure: a window on counted paint, the head of a brush and its load go in; the same come out, and nothing is lost to
//! the quantum. [`Impasto`] is one [`PaintModel`](maulstick_model::interface::PaintModel); [`stages`] holds its stages, a
//! file each, and levelling at rest.
//!
//! What a stroke leaves is decided where bristles lift off: a film that bridges a gap splits in its middle, and levels as
//! far as the yield stress of worked paint lets it. Paint flows within the head each second step, strips in turn:
//! all at once, or more seldom, each time shows along the stroke. `maulstick bench looks` measures ridges, streaks and films.
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
//! path.advance(&head, (at(0.02), 0), |sweep, _| {
//!     impasto.step(&mut Step {
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
//! });
//! let left: f64 = window.plane(0).expect("painted").iter().map(|count| f64::from(*count)).sum();
//! assert!(left > 0.0);
//! assert_eq!(left as u64 + load.total(), loaded);
//! # Ok(())
//! # }
//! ```

pub mod stages;

pub use stages::Impasto;
