//! Pens of Wayland: the protocol tablet-unstable-v2.
//!
//! A compositor that speaks it to a window moves no pointer there with a pen: the window does.

use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::os::fd::BorrowedFd;
use std::time::Duration;

use maulstick_device::pen::{End, Presence, Reading};
use maulstick_rig::UserError;
use raw_window_handle::WaylandDisplayHandle;
use wayland_backend::client::{Backend, ObjectId, WaylandError};
use wayland_client::globals::{GlobalListContents, registry_queue_init};
use wayland_client::protocol::{wl_registry, wl_seat};
use wayland_client::{Connection, Dispatch, EventQueue, Proxy, QueueHandle, event_created_child};
use wayland_protocols::wp::tablet::zv2::client::{
    zwp_tablet_manager_v2::ZwpTabletManagerV2,
    zwp_tablet_pad_dial_v2::ZwpTabletPadDialV2,
    zwp_tablet_pad_group_v2::{self, ZwpTabletPadGroupV2},
    zwp_tablet_pad_ring_v2::ZwpTabletPadRingV2,
    zwp_tablet_pad_strip_v2::ZwpTabletPadStripV2,
    zwp_tablet_pad_v2::{self, ZwpTabletPadV2},
    zwp_tablet_seat_v2::{self, ZwpTabletSeatV2},
    zwp_tablet_tool_v2::{self, ZwpTabletToolV2},
    zwp_tablet_v2::ZwpTabletV2,
};

use crate::reading::{Axes, PenReading, Tool};
use crate::source::{Source, gone, readable};

/// Full pressure.
const PRESSURE: f64 = 65_535.0;
/// Buttons of a pen, that nearest to the tip first: `BTN_STYLUS`, `BTN_STYLUS2` and `BTN_STYLUS3` of Linux' input event
/// codes.
const BUTTONS: [u32; 3] = [0x14b, 0x14c, 0x149];

/// The connection of a window.
///
/// # Safety
/// The display is that of a living window, which outlives the connection.
#[must_use]
#[expect(
    unsafe_code,
    reason = "the window's library hands out its connection as a pointer"
)]
pub(crate) unsafe fn foreign_connection(display: WaylandDisplayHandle) -> Connection {
    // SAFETY: as the caller promises.
    let backend = unsafe { Backend::from_foreign_display(display.display.as_ptr().cast()) };
    Connection::from_backend(backend)
}

/// State of a tool by its events so far.
#[derive(Debug, Default)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "events of the protocol change them one by one"
)]
struct KnownTool {
    tool: Tool,
    axes: Axes,
    eraser: bool,
    is_near: bool,
    is_down: bool,
    point_px: [f64; 2],
    pressure: f64,
    tilt_rad: [f64; 2],
    twist_rad: f64,
    switches: u32,
    /// It was near at the last frame of events, and has left since.
    has_left: bool,
    /// Time of that frame, ms.
    time_ms: u32,
}

impl KnownTool {
    /// Follows an event that concerns the tool alone.
    fn follow(&mut self, event: zwp_tablet_tool_v2::Event) {
        use zwp_tablet_tool_v2::{ButtonState, Capability, Event, Type};
        match event {
            Event::Type { tool_type } => {
                self.eraser = tool_type.into_result().is_ok_and(|own| own == Type::Eraser);
            }
            Event::Capability { capability } => match capability.into_result() {
                Ok(Capability::Pressure) => self.axes.pressure = true,
                Ok(Capability::Tilt) => self.axes.tilt = true,
                Ok(Capability::Rotation) => self.axes.twist = true,
                _ => {}
            },
            Event::HardwareSerial {
                hardware_serial_hi,
                hardware_serial_lo,
            } => {
                let serial = u64::from(hardware_serial_hi) << 32 | u64::from(hardware_serial_lo);
                // The connection distinguishes pens without one.
                if serial != 0 {
                    self.tool = Tool(serial << 1 | u64::from(self.eraser));
                }
            }
            Event::ProximityOut => {
                self.has_left = self.is_near;
                (self.is_near, self.is_down) = (false, false);
            }
            Event::Down { .. } => self.is_down = true,
            Event::Up => self.is_down = false,
            Event::Motion { x, y } => self.point_px = [x, y],
            Event::Pressure { pressure } => self.pressure = f64::from(pressure) / PRESSURE,
            Event::Tilt { tilt_x, tilt_y } => {
                // Theirs leans toward the hand with y.
                self.tilt_rad = [tilt_x.to_radians(), -tilt_y.to_radians()];
            }
            // Theirs turns clockwise, seen from above.
            Event::Rotation { degrees } => self.twist_rad = -degrees.to_radians(),
            Event::Button { button, state, .. } => {
                if let Some(place) = BUTTONS.iter().position(|own| *own == button) {
                    let bit = 1 << place;
                    match state.into_result() {
                        Ok(ButtonState::Pressed) => self.switches |= bit,
                        _ => self.switches &= !bit,
                    }
                }
            }
            _ => {}
        }
    }

    fn read(&self) -> PenReading {
        PenReading {
            tool: self.tool,
            axes: self.axes,
            time_ms: self.time_ms,
            point_px: self.point_px,
            reading: self.reading(),
        }
    }

    fn reading(&self) -> Reading {
        Reading {
            presence: match (self.is_near, self.is_down) {
                (false, _) => Presence::Away,
                (true, false) => Presence::Hovering,
                (true, true) => Presence::Touching,
            },
            end: if self.eraser { End::Eraser } else { End::Tip },
            point_m: [0.0; 2],
            height_m: 0.0,
            pressure: if self.axes.pressure {
                self.pressure
            } else {
                0.5
            },
            tilt_rad: self.axes.tilt.then_some(self.tilt_rad),
            twist_rad: self.axes.twist.then_some(self.twist_rad),
            switches: self.switches,
        }
    }
}

/// Listener to the events of the connection.
#[derive(Debug, Default)]
struct Listener {
    /// The window's surface; others' are not its own.
    surface: Option<usize>,
    tools: BTreeMap<u32, KnownTool>,
    /// Tools seen so far.
    tools_seen: u64,
    readings: Vec<PenReading>,
}

/// True if the compositor that `WAYLAND_DISPLAY` names reports pens.
///
/// # Errors
/// A [`UserError`] where there is none.
pub fn tells_of_pens() -> Result<bool, UserError> {
    let away = |error: &dyn std::fmt::Display| {
        UserError::failure(format!("no Wayland compositor answers: {error}"))
            .help("start it from a terminal of a graphical session")
    };
    let connection = Connection::connect_to_env().map_err(|error| away(&error))?;
    let (globals, _) =
        registry_queue_init::<Listener>(&connection).map_err(|error| away(&error))?;
    Ok(globals.contents().with_list(|list| {
        let mut names = list.iter().map(|global| global.interface.as_str());
        names.any(|name| name == "zwp_tablet_manager_v2")
    }))
}

/// Pens of a Wayland connection.
pub struct WaylandPens {
    connection: Connection,
    queue: EventQueue<Listener>,
    listener: Listener,
    _seats: Vec<ZwpTabletSeatV2>,
}

impl WaylandPens {
    /// The pens of a connection over `surface`, the address of its proxy; over any surface without.
    ///
    /// # Errors
    /// A [`UserError`] where the compositor does not speak the protocol.
    pub fn new(connection: &Connection, surface: Option<usize>) -> Result<Self, UserError> {
        let (globals, queue) =
            registry_queue_init::<Listener>(connection).map_err(|error| gone(&error))?;
        let handle = queue.handle();
        let manager = globals.bind::<ZwpTabletManagerV2, _, _>(&handle, 1..=1, ());
        let manager = manager.map_err(|_| {
            UserError::failure("this compositor does not report pens (zwp_tablet_manager_v2)").help(
                "the pen paints as a mouse does; to use its pressure, add its tablet to the rig (`maulstick device list` says how)",
            )
        })?;
        let seats = globals.contents().with_list(|list| {
            let seats = list.iter().filter(|global| global.interface == "wl_seat");
            let bind = |global: &wayland_client::globals::Global| {
                let seat =
                    globals
                        .registry()
                        .bind::<wl_seat::WlSeat, _, _>(global.name, 1, &handle, ());
                manager.get_tablet_seat(&seat, &handle, ())
            };
            seats.map(bind).collect()
        });
        flush(connection)?;
        Ok(Self {
            connection: connection.clone(),
            queue,
            listener: Listener {
                surface,
                ..Listener::default()
            },
            _seats: seats,
        })
    }
}

impl std::fmt::Debug for WaylandPens {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("WaylandPens")
            .field("listener", &self.listener)
            .finish_non_exhaustive()
    }
}

/// Sends what waits; what the compositor does not take yet is sent the next time.
fn flush(connection: &Connection) -> Result<(), UserError> {
    match connection.flush() {
        Err(WaylandError::Io(error)) if error.kind() == ErrorKind::WouldBlock => Ok(()),
        flushed => flushed.map_err(|error| gone(&error)),
    }
}

impl Source for WaylandPens {
    fn wait(
        &mut self,
        stop: BorrowedFd<'_>,
        timeout: Option<Duration>,
        readings: &mut Vec<PenReading>,
    ) -> Result<(), UserError> {
        flush(&self.connection)?;
        // Events that wait already come first.
        if let Some(guard) = self.queue.prepare_read() {
            if readable(guard.connection_fd(), stop, timeout)? {
                match guard.read() {
                    Ok(_) => {}
                    // The window's own thread has read them.
                    Err(WaylandError::Io(error)) if error.kind() == ErrorKind::WouldBlock => {}
                    Err(error) => return Err(gone(&error)),
                }
            } else {
                drop(guard)
            }
        }
        self.queue
            .dispatch_pending(&mut self.listener)
            .map_err(|error| gone(&error))?;
        readings.append(&mut self.listener.readings);
        Ok(())
    }

    fn moves_pointer(&self) -> bool {
        false
    }
}

impl Listener {
    fn is_own(&self, surface: &ObjectId) -> bool {
        let address = surface.as_ptr() as usize;
        self.surface.is_none_or(|own| own == address)
    }
}

impl Dispatch<ZwpTabletToolV2, ()> for Listener {
    fn event(
        listener: &mut Self,
        proxy: &ZwpTabletToolV2,
        event: zwp_tablet_tool_v2::Event,
        (): &(),
        _: &Connection,
        _: &QueueHandle<Self>,
    ) {
        use zwp_tablet_tool_v2::Event;
        let id = proxy.id().protocol_id();
        let near = match &event {
            Event::ProximityIn { surface, .. } => listener.is_own(&surface.id()),
            _ => false,
        };
        let tools_seen = &mut listener.tools_seen;
        let tool = listener.tools.entry(id).or_insert_with(|| {
            *tools_seen += 1;
            KnownTool {
                tool: Tool(*tools_seen),
                axes: Axes {
                    range: true,
                    ..Axes::default()
                },
                ..KnownTool::default()
            }
        });
        match event {
            Event::ProximityIn { serial, .. } => {
                tool.is_near = near;
                if near {
                    // The window draws brush and pointer itself.
                    proxy.set_cursor(serial, None, 0, 0);
                }
            }
            Event::Frame { time } => {
                tool.time_ms = time;
                if std::mem::take(&mut tool.has_left) || tool.is_near {
                    listener.readings.push(tool.read());
                }
            }
            Event::Removed => {
                let was_near = std::mem::take(&mut tool.is_near);
                if std::mem::take(&mut tool.has_left) || was_near {
                    listener.readings.push(tool.read());
                }
                listener.tools.remove(&id);
                proxy.destroy();
            }
            event => tool.follow(event),
        }
    }
}

impl Dispatch<ZwpTabletSeatV2, ()> for Listener {
    fn event(
        _: &mut Self,
        _: &ZwpTabletSeatV2,
        _: zwp_tablet_seat_v2::Event,
        (): &(),
        _: &Connection,
        _: &QueueHandle<Self>,
    ) {
    }

    event_created_child!(Self, ZwpTabletSeatV2, [
        zwp_tablet_seat_v2::EVT_TABLET_ADDED_OPCODE => (ZwpTabletV2, ()),
        zwp_tablet_seat_v2::EVT_TOOL_ADDED_OPCODE => (ZwpTabletToolV2, ()),
        zwp_tablet_seat_v2::EVT_PAD_ADDED_OPCODE => (ZwpTabletPadV2, ()),
    ]);
}

impl Dispatch<ZwpTabletPadV2, ()> for Listener {
    fn event(
        _: &mut Self,
        _: &ZwpTabletPadV2,
        _: zwp_tablet_pad_v2::Event,
        (): &(),
        _: &Connection,
        _: &QueueHandle<Self>,
    ) {
    }

    event_created_child!(Self, ZwpTabletPadV2, [
        zwp_tablet_pad_v2::EVT_GROUP_OPCODE => (ZwpTabletPadGroupV2, ()),
    ]);
}

impl Dispatch<ZwpTabletPadGroupV2, ()> for Listener {
    fn event(
        _: &mut Self,
        _: &ZwpTabletPadGroupV2,
        _: zwp_tablet_pad_group_v2::Event,
        (): &(),
        _: &Connection,
        _: &QueueHandle<Self>,
    ) {
    }

    event_created_child!(Self, ZwpTabletPadGroupV2, [
        zwp_tablet_pad_group_v2::EVT_RING_OPCODE => (ZwpTabletPadRingV2, ()),
        zwp_tablet_pad_group_v2::EVT_STRIP_OPCODE => (ZwpTabletPadStripV2, ()),
        zwp_tablet_pad_group_v2::EVT_DIAL_OPCODE => (ZwpTabletPadDialV2, ()),
    ]);
}

/// Objects whose events tell nothing of pens.
macro_rules! silent {
    ($($proxy:ty, $data:ty);+ $(;)?) => {$(
        impl Dispatch<$proxy, $data> for Listener {
            fn event(
                _: &mut Self,
                _: &$proxy,
                _: <$proxy as Proxy>::Event,
                _: &$data,
                _: &Connection,
                _: &QueueHandle<Self>,
            ) {
            }
        }
    )+};
}

silent! {
    wl_registry::WlRegistry, GlobalListContents;
    wl_seat::WlSeat, ();
    ZwpTabletManagerV2, ();
    ZwpTabletV2, ();
    ZwpTabletPadRingV2, ();
    ZwpTabletPadStripV2, ();
    ZwpTabletPadDialV2, ();
}
