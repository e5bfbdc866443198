//! Pens of Wayland, by a compositor of our own.

use std::os::fd::AsFd;
use std::os::unix::net::UnixStream;
use std::time::{Duration, Instant};

use maulstick_device::pen::{End, Presence};
use maulstick_window_pen::source::Source;
use maulstick_window_pen::wayland::WaylandPens;
use maulstick_window_pen::window::PointerEvent;
use maulstick_window_pen::{PenReading, PenThread};
use nix::sys::eventfd::EventFd;
use wayland_client::globals::{GlobalListContents, registry_queue_init};
use wayland_client::protocol::{wl_compositor, wl_registry, wl_surface};
use wayland_client::{Connection, Dispatch, Proxy, QueueHandle};
use wayland_protocols::wp::tablet::zv2::server::zwp_tablet_tool_v2::{Capability, Type};

use crate::compositor::{Compositor, Do, NewTool};
use crate::desk::{Desk, words};

/// Longest wait for what is on its way.
const PATIENCE: Duration = Duration::from_secs(20);

/// The client of a window: what it hears besides pens is nothing.
struct Window;

impl Dispatch<wl_registry::WlRegistry, GlobalListContents> for Window {
    fn event(
        _: &mut Self,
        _: &wl_registry::WlRegistry,
        _: wl_registry::Event,
        _: &GlobalListContents,
        _: &Connection,
        _: &QueueHandle<Self>,
    ) {
    }
}

impl Dispatch<wl_compositor::WlCompositor, ()> for Window {
    fn event(
        _: &mut Self,
        _: &wl_compositor::WlCompositor,
        _: wl_compositor::Event,
        _: &(),
        _: &Connection,
        _: &QueueHandle<Self>,
    ) {
    }
}

impl Dispatch<wl_surface::WlSurface, ()> for Window {
    fn event(
        _: &mut Self,
        _: &wl_surface::WlSurface,
        _: wl_surface::Event,
        _: &(),
        _: &Connection,
        _: &QueueHandle<Self>,
    ) {
    }
}

/// A client with two surfaces; the pens are those over the first.
fn client(stream: UnixStream) -> (Connection, Vec<wl_surface::WlSurface>) {
    let connection = Connection::from_socket(stream).expect("connected");
    let (globals, queue) = registry_queue_init::<Window>(&connection).expect("globals");
    let handle = queue.handle();
    let compositor: wl_compositor::WlCompositor =
        globals.bind(&handle, 1..=4, ()).expect("a compositor");
    let surfaces = (0..2)
        .map(|_| compositor.create_surface(&handle, ()))
        .collect();
    connection.flush().expect("flushed");
    (connection, surfaces)
}

fn pens(stream: UnixStream) -> (WaylandPens, Vec<wl_surface::WlSurface>) {
    let (connection, surfaces) = client(stream);
    let own = surfaces[0].id().as_ptr() as usize;
    let pens = WaylandPens::new(&connection, Some(own)).expect("tablets");
    (pens, surfaces)
}

fn pen(serial: u64) -> NewTool {
    NewTool {
        kind: Type::Pen,
        serial,
        capabilities: vec![Capability::Pressure, Capability::Tilt, Capability::Rotation],
    }
}

/// The next `count` readings.
fn next(pens: &mut WaylandPens, count: usize) -> Vec<PenReading> {
    let never = EventFd::new().expect("a descriptor");
    let (mut readings, begun) = (Vec::new(), Instant::now());
    while readings.len() < count {
        pens.wait(never.as_fd(), Some(PATIENCE), &mut readings)
            .expect("connected");
        assert!(begun.elapsed() < PATIENCE, "only {readings:?}");
    }
    readings
}

#[test]
fn a_frame_of_events_is_a_reading() {
    let (compositor, stream) = Compositor::start(true);
    let (mut pens, _surfaces) = pens(stream);
    compositor.tool(pen(0x1_0000_0002));
    compositor.act(
        0,
        &[
            Do::Near(0),
            Do::Move(10.5, 20.25),
            Do::Frame(1000),
            Do::Down,
            Do::Press(32_768),
            Do::Tilt(30.0, -45.0),
            Do::Rotate(90.0),
            Do::Button(0x14b, true),
            Do::Button(0x149, true),
            Do::Frame(1004),
            Do::Up,
            Do::Button(0x14b, false),
            Do::Frame(1008),
            Do::Away,
            Do::Frame(1012),
        ],
    );
    let readings = next(&mut pens, 4);
    let times: Vec<u32> = readings.iter().map(|read| read.time_ms).collect();
    assert_eq!(times, [1000, 1004, 1008, 1012]);
    let presences: Vec<Presence> = readings.iter().map(|read| read.reading.presence).collect();
    use Presence::{Away, Hovering, Touching};
    assert_eq!(presences, [Hovering, Touching, Hovering, Away]);
    let touch = readings[1].reading;
    assert_eq!(
        (readings[1].point_px, touch.end, touch.switches),
        ([10.5, 20.25], End::Tip, 0b101)
    );
    assert!((touch.pressure - 32_768.0 / 65_535.0).abs() < 1e-9);
    // Their y goes toward the hand, their rotation clockwise.
    let quarter = std::f64::consts::FRAC_PI_4;
    let [x, y] = touch.tilt_rad.expect("tilt");
    assert!(
        (x - quarter * 2.0 / 3.0).abs() < 1e-9 && (y - quarter).abs() < 1e-9,
        "{x} {y}"
    );
    let twist = touch.twist_rad.expect("twist");
    assert!((twist + 2.0 * quarter).abs() < 1e-9, "{twist}");
    assert_eq!(readings[2].reading.switches, 0b100);
}

#[test]
fn tools_are_told_apart_and_a_pen_over_another_surface_is_none_of_ours() {
    let (compositor, stream) = Compositor::start(true);
    let (mut pens, _surfaces) = pens(stream);
    compositor.tool(pen(7));
    compositor.tool(NewTool {
        kind: Type::Eraser,
        capabilities: vec![Capability::Pressure],
        ..pen(7)
    });
    compositor.tool(pen(0));
    compositor.tool(pen(0));
    compositor.act(
        0,
        &[Do::Near(1), Do::Down, Do::Frame(1), Do::Away, Do::Frame(2)],
    );
    for tool in 0..4 {
        compositor.act(tool, &[Do::Near(0), Do::Frame(3), Do::Away, Do::Frame(4)]);
    }
    let readings = next(&mut pens, 8);
    assert!(readings.iter().all(|read| read.time_ms > 2), "{readings:?}");
    let mut tools: Vec<_> = readings.iter().map(|read| read.tool).collect();
    tools.dedup();
    assert_eq!(tools.len(), 4, "{tools:?}");
    let eraser = &readings[2];
    assert_eq!(eraser.reading.end, End::Eraser);
    assert_eq!((eraser.reading.tilt_rad, eraser.axes.tilt), (None, false));
}

#[test]
fn a_tool_that_is_taken_away_has_left() {
    let (compositor, stream) = Compositor::start(true);
    let (mut pens, _surfaces) = pens(stream);
    compositor.tool(pen(1));
    compositor.act(
        0,
        &[
            Do::Near(0),
            Do::Down,
            Do::Press(9000),
            Do::Frame(5),
            Do::Remove,
        ],
    );
    let readings = next(&mut pens, 2);
    assert_eq!(readings[1].reading.presence, Presence::Away);
    // Also where it left without another frame.
    compositor.tool(pen(2));
    compositor.act(
        1,
        &[Do::Near(0), Do::Down, Do::Frame(6), Do::Away, Do::Remove],
    );
    let readings = next(&mut pens, 2);
    assert_eq!(readings[1].reading.presence, Presence::Away);
}

#[test]
fn a_compositor_without_the_protocol_is_told_of() {
    let (_compositor, stream) = Compositor::start(false);
    let (connection, _surfaces) = client(stream);
    let fault = WaylandPens::new(&connection, None).expect_err("no tablets");
    assert!(
        fault.what.contains("zwp_tablet_manager_v2"),
        "{}",
        fault.what
    );
    assert!(fault.help.is_some());
}

/// Of a pen of 250 reports a second and of one of 1,000 each one comes to the bus, in order and at its time, though ten
/// are read at once.
#[test]
fn every_sample_arrives_at_its_time() {
    for step_ms in [4, 1] {
        let (compositor, stream) = Compositor::start(true);
        let (pens, _surfaces) = pens(stream);
        let (mut desk, stylus) = Desk::new();
        compositor.tool(pen(1));
        let thread = PenThread::of(Box::new(pens), stylus).expect("a thread");
        let hovers = [
            Do::Near(0),
            Do::Move(1.0, 100.0),
            Do::Frame(50_000),
            Do::Down,
        ];
        compositor.act(0, &hovers);
        let waits = |what: &dyn Fn() -> bool| {
            let begun = Instant::now();
            while !what() {
                assert!(begun.elapsed() < PATIENCE, "nothing more comes");
                std::thread::yield_now();
            }
        };
        waits(&|| desk.link.state().is_near);
        // The compositor sends ten frames at a time.
        let count = 2000;
        let place = |number: u32| 1.0 + 0.125 * f64::from(number);
        for first in (0..count).step_by(10) {
            let frames = (first..first + 10).flat_map(|number| {
                let time = 50_000 + step_ms * (number + 1);
                let at = Do::Move(place(number), 100.0);
                [at, Do::Press(30_000 + number), Do::Frame(time)]
            });
            desk.net.advance(10_000_000 * u64::from(step_ms));
            compositor.act(0, &frames.collect::<Vec<_>>());
            let last = PointerEvent::Moved([place(first + 9), 100.0]);
            waits(&|| desk.link.state().pointer.last() == Some(&last));
        }
        let end = 50_000 + step_ms * (count + 1);
        compositor.act(0, &[Do::Up, Do::Away, Do::Frame(end)]);
        waits(&|| !desk.link.state().is_near);
        drop(thread);
        let heard = desk.heard();
        let pressed: Vec<_> = heard
            .iter()
            .filter(|(_, sample)| words(sample).1 > 0.0)
            .collect();
        assert_eq!(pressed.len(), count as usize, "{step_ms} ms apart");
        for pair in pressed.windows(2) {
            let ([x0, _], p0, _) = words(&pair[0].1);
            let ([x1, _], p1, _) = words(&pair[1].1);
            let apart_ns = pair[1].0 - pair[0].0;
            let exact = u64::from(step_ms) * 1_000_000;
            assert!(x1 > x0 && p1 > p0, "{step_ms} ms apart");
            assert!(
                apart_ns.abs_diff(exact) < 10_000,
                "{apart_ns} ns, not {exact}"
            );
        }
    }
}
