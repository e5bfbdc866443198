//! Successive windows in the same memory.

use maulstick_gpu::Choice;
use maulstick_num::{cos, sin};
use maulstick_stokes::domain::Solids;
use maulstick_stokes::flow::{Conditions, Effort, Flow};
use maulstick_stokes::grid::Grid;
use maulstick_stokes::rheology::Paint;
use maulstick_stokes_paint::coarse::FlowWindow;
use maulstick_stokes_paint::device::{GpuBrushFlow, GpuFlow, Tuning};
use maulstick_stokes_paint::flow_backend::{FlowBackend as _, FlowError};

use crate::device;

/// A window of a brush.
struct Window {
    grid: Grid,
    fill: Vec<f32>,
    solids: Solids,
    conditions: Conditions,
}

impl Window {
    /// A window of cells in which paint with waves lies up to a height over a slope; bristles of a resistance move
    /// through its middle at a speed, m/s.
    fn new(cells: [usize; 3], top: f64, (resistance, speed): (f32, f32)) -> Self {
        let grid = Grid::walled(cells);
        let fill = |place: usize| {
            let [x, y, z] = grid.cell(place).map(|at| at as f64);
            let waves = 0.4 * sin(0.7 * x) * cos(0.5 * y);
            (top + waves - z).clamp(0.0, 1.0) as f32
        };
        let mut solids = Solids::walls(&grid);
        solids.add(&grid, |[x, y, z]| z - 0.3 - 0.05 * (x - y));
        let [width, height, _] = cells.map(|cells| cells as isize);
        let mut bristles = [const { Vec::new() }; 3];
        for (axis, bristles) in bristles.iter_mut().enumerate() {
            *bristles = grid.field();
            for place in grid.block([2, 2, 0], [width - 2, height - 2, 9]) {
                bristles[place] = resistance;
                solids.velocity[axis][place] = if axis == 0 { speed } else { 0.0 };
            }
        }
        solids.resistance = Some(bristles);
        Self {
            fill: (0..grid.len()).map(fill).collect(),
            grid,
            solids,
            conditions: Conditions {
                cell_m: 5e-4,
                seconds: 5e-3,
                paint: Paint::newtonian(1e-2),
                pull: [0.0, 0.0, -9.81],
            },
        }
    }

    fn as_flow(&self) -> FlowWindow<'_> {
        FlowWindow {
            grid: &self.grid,
            fill: &self.fill,
            solids: &self.solids,
            conditions: &self.conditions,
        }
    }
}

/// Resistance and speed of bristles: part of the window, and one that fills its window.
const BRISTLES: (f32, f32) = (2.0, 0.1);

fn windows() -> Vec<Window> {
    let sizes = [
        ([14, 12, 10], 2.3),
        ([25, 23, 11], 4.6),
        ([7, 9, 9], 1.4),
        ([25, 24, 11], 4.6),
        ([14, 12, 10], 2.3),
    ];
    sizes
        .map(|(cells, top)| Window::new(cells, top, BRISTLES))
        .into()
}

fn backend(tuning: &Tuning) -> GpuBrushFlow {
    GpuBrushFlow::tuned(device(), Choice::Forced, tuning).expect("made")
}

/// Bit by bit: remnants of an earlier window in the memory have no effect.
#[test]
fn a_window_has_the_answer_that_it_has_alone() {
    let mut shared = backend(&Tuning::default());
    for window in windows() {
        let got = shared.flow(&window.as_flow()).expect("a flow").clone();
        let mut alone = backend(&Tuning::default());
        let want = alone.flow(&window.as_flow()).expect("a flow");
        assert!(got == *want, "{:?}", window.grid.cells);
        assert!(got.iter().flatten().all(|velocity| velocity.is_finite()));
    }
    // A flow that is not restarted continues, and the comparison detects it.
    let Window {
        grid,
        fill,
        solids,
        conditions,
    } = &windows()[0];
    let mut flow = GpuFlow::new(device(), grid, Effort::default()).expect("made");
    let mut step = |restarts: bool| {
        if restarts {
            flow.restart(grid).expect("restarted");
        }
        flow.step(fill, solids, conditions).expect("a step");
        flow.read_velocity().expect("read")
    };
    let (first, second, again) = (step(false), step(false), step(true));
    assert!(first == again && first != second);
}

/// Largest difference from the processor's velocities, by the fastest.
fn off(window: &Window, device: &mut GpuBrushFlow) -> f64 {
    let got = device.flow(&window.as_flow()).expect("a flow");
    let mut cpu = Flow::new(&window.grid);
    cpu.step(&window.fill, &window.solids, &window.conditions);
    let pairs = got.iter().flatten().zip(cpu.velocity.iter().flatten());
    let apart = pairs.map(|(a, b)| f64::from((a - b).abs()));
    apart.fold(0.0, f64::max) / cpu.fastest()
}

/// Tolerance relative to the fastest velocity.
const TOLERANCE: f64 = 1e-5;

#[test]
fn a_window_has_the_processors_velocities() {
    let mut device = backend(&Tuning::default());
    let mut faulty = backend(&Tuning {
        fault: Some(("fault_link", 1.01)),
        ..Tuning::default()
    });
    for window in &windows()[..3] {
        let found = off(window, &mut device);
        println!("{:?}: {found:.1e}", window.grid.cells);
        assert!(found < TOLERANCE, "{:?}: {found:e}", window.grid.cells);
        let found = off(window, &mut faulty);
        assert!(
            found > TOLERANCE,
            "a weight that is wrong passes: {found:e}"
        );
    }
}

/// Any number of layers of air above the paint.
#[test]
fn layers_of_air_do_not_matter() {
    let mut device = backend(&Tuning::default());
    let found = [10, 13, 24].map(|depth| {
        let window = Window::new([14, 12, depth], 2.3, BRISTLES);
        let velocity = device.flow(&window.as_flow()).expect("a flow");
        let layers = 8 * window.grid.stride(2);
        velocity.each_ref().map(|axis| axis[..layers].to_vec())
    });
    assert!(found[0] == found[1] && found[0] == found[2]);
    let lower = Window::new([14, 12, 10], 2.0, BRISTLES);
    let velocity = device.flow(&lower.as_flow()).expect("a flow");
    assert!(found[0][0] != velocity[0][..found[0][0].len()]);
}

#[test]
fn a_window_beyond_the_limit_is_refused_and_the_next_one_is_not() {
    let [small, large] =
        [[14, 12, 10], [30, 28, 14]].map(|cells| Window::new(cells, 2.3, BRISTLES));
    // A window that fits is laid out without the air.
    let most_bytes = GpuFlow::window_bytes(&Grid::walled([14, 12, 10]), Effort::default())
        .expect("it has an index");
    let tuning = Tuning {
        most_bytes,
        ..Tuning::default()
    };
    let mut device = backend(&tuning);
    for _ in 0..2 {
        let refusal = device.flow(&large.as_flow()).err();
        let Some(FlowError::TooLarge { needs, most }) = refusal else {
            panic!("{refusal:?}");
        };
        assert!(needs > most && most == most_bytes);
        device.flow(&small.as_flow()).expect("it fits");
    }
}

#[test]
fn whatever_the_brush_does_all_is_finite() {
    let mut device = backend(&Tuning::default());
    let sizes = [([9, 8, 7], 2.5), ([1, 1, 1], 0.7), ([12, 3, 6], 0.0)];
    for resistance in [0.0, 1e-6, 1.0, 1e7] {
        for speed in [0.0, 0.1, -1e4] {
            for seconds in [1e-6, 10.0] {
                for (cells, top) in sizes {
                    let mut window = Window::new(cells, top, (resistance, speed));
                    window.conditions.seconds = seconds;
                    if let Some(bristles) = &mut window.solids.resistance {
                        bristles[0].fill(resistance);
                        window.solids.velocity[0].fill(speed);
                    }
                    let velocity = device.flow(&window.as_flow()).expect("a flow");
                    assert!(
                        velocity.iter().flatten().all(|u| u.is_finite()),
                        "{cells:?}, resistance {resistance}, {speed} m/s, {seconds} s"
                    );
                }
            }
        }
    }
}

/// By default a device is used where it is faster; a forced one always.
#[test]
fn small_windows_are_the_processors_unless_it_must_be_the_device() {
    let [auto, forced] = [Choice::Auto, Choice::Forced]
        .map(|choice| GpuBrushFlow::new(device(), choice).expect("made"));
    let small = Window::new([16, 16, 8], 2.3, BRISTLES);
    let large = Window::new([64, 64, 16], 7.6, BRISTLES);
    // Much air makes a window no larger.
    let high = Window::new([16, 16, 200], 2.3, BRISTLES);
    let sooner = |device: &GpuBrushFlow| {
        [&small, &large, &high].map(|window| device.is_faster(&window.as_flow()))
    };
    assert_eq!(sooner(&auto), [false, true, false]);
    assert_eq!(sooner(&forced), [true; 3]);
}
