//! The processes of the two pens.

use std::io::{ErrorKind, Read as _};
use std::os::fd::AsFd as _;
use std::os::unix::net::UnixStream;
use std::sync::Arc;
use std::time::Duration;

use maulstick_bus::{Bus, Dial, RigClock, Wake, ZenohBus};
use maulstick_hid::daemon::{Daemon, HidSettings};
use maulstick_hid::device_source::{Found, HidSource, Ports};
use maulstick_hid::recording::Recorded;
use maulstick_rig::UserError;
use maulstick_rig::config::{CanvasSection, DeviceSection};
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Origin, name_hash};
use maulstick_window_pen::wayland::WaylandPens;
use maulstick_window_pen::{DeskView, PenLink, PenThread, WindowStylus};
use nix::sys::prctl::set_pdeathsig;
use nix::sys::signal::Signal;
use wayland_client::globals::{GlobalListContents, registry_queue_init};
use wayland_client::protocol::{wl_compositor, wl_registry, wl_surface};
use wayland_client::{Connection, Dispatch, Proxy as _, QueueHandle, delegate_noop};

use super::{PENS, recorded};
use crate::running::fault;

/// Sends the samples of a pen, whose system is the socket at the standard input: its name, the locator of the brush node, and
/// the offset of the rig's clock, ns. It ends with the process that started it.
pub(crate) fn send(argument: &str) -> Result<(), UserError> {
    set_pdeathsig(Signal::SIGKILL).map_err(fault)?;
    let [pen, locator, offset] = argument.split(' ').collect::<Vec<_>>()[..] else {
        return Err(fault("no pen, locator and clock"));
    };
    let system = std::io::stdin().as_fd().try_clone_to_owned();
    let system = UnixStream::from(system.map_err(fault)?);
    let dial = Dial {
        name: pen.into(),
        listen: Some(locator.replace("brush.sock", &format!("{pen}.sock"))),
        connect: vec![locator.to_owned()],
    };
    let clock = RigClock::with_offset(offset.parse().map_err(fault)?);
    let bus: Arc<dyn Bus> = Arc::new(ZenohBus::open(&dial, clock)?);
    let origin = Origin {
        source: name_hash(pen),
        epoch: 1,
    };
    if pen == PENS[0] {
        send_windows(system, bus, origin)
    } else {
        send_tablets(system, bus, origin)
    }
}

/// Samples of a tablet whose reports come through a socket.
fn send_tablets(reports: UnixStream, bus: Arc<dyn Bus>, origin: Origin) -> Result<(), UserError> {
    let settings = HidSettings {
        device: DeviceSection::new(PENS[1], "pen", "main"),
        canvas: CanvasSection::default(),
        replay: None,
        record: None,
    };
    let (topics, wake) = (Topics::new("bench"), Wake::new());
    let socket = Box::new(Socket {
        reports,
        recorded: recorded()?,
    });
    let mut daemon = Daemon::new(bus, &topics, &wake, origin, &settings, socket)?;
    loop {
        let wait = daemon.poll()?;
        wake.wait(wait);
    }
}

/// A tablet at the other end of a socket.
struct Socket {
    reports: UnixStream,
    recorded: Recorded,
}

impl Ports for Socket {
    fn list(&mut self) -> Result<Vec<Found>, UserError> {
        Ok(vec![Found {
            identity: self.recorded.identity.clone(),
            // A digitizer's pen.
            usages: vec![(0x0D, 0x02)],
        }])
    }

    fn open(&mut self, _: &Found) -> Result<Box<dyn HidSource>, UserError> {
        Ok(Box::new(Self {
            reports: self.reports.try_clone().map_err(fault)?,
            recorded: self.recorded.clone(),
        }))
    }
}

impl HidSource for Socket {
    fn descriptor(&self) -> &[u8] {
        &self.recorded.descriptor
    }

    fn read(&mut self, report: &mut [u8], limit: Duration) -> Result<usize, UserError> {
        let length = self.recorded.events.first().map(|event| event.report.len());
        let length = length.unwrap_or_default().min(report.len());
        self.reports.set_read_timeout(Some(limit)).map_err(fault)?;
        match self.reports.read(&mut report[..length]) {
            Ok(0) => Err(fault("the reports are over")),
            Ok(length) => Ok(length),
            Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {
                Ok(0)
            }
            Err(error) => Err(fault(error)),
        }
    }

    fn write(&mut self, _: &[u8]) -> Result<(), UserError> {
        Ok(())
    }
}

/// Samples of a pen over a window of the compositor behind a socket.
fn send_windows(
    compositor: UnixStream,
    bus: Arc<dyn Bus>,
    origin: Origin,
) -> Result<(), UserError> {
    let connection = Connection::from_socket(compositor).map_err(fault)?;
    let (globals, queue) = registry_queue_init::<Window>(&connection).map_err(fault)?;
    let handle = queue.handle();
    let compositor: wl_compositor::WlCompositor =
        globals.bind(&handle, 1..=4, ()).map_err(fault)?;
    let surface = compositor.create_surface(&handle, ());
    let pens = WaylandPens::new(&connection, Some(surface.id().as_ptr() as usize))?;
    let link = PenLink::default();
    link.show(Some(Arc::new(Window)), "main");
    let stylus = WindowStylus::new(bus, &Topics::new("bench"), (PENS[0], origin), link)?;
    let _pens = PenThread::of(Box::new(pens), stylus)?;
    loop {
        std::thread::park();
    }
}

/// A window that shows only the desk.
struct Window;

impl DeskView for Window {
    fn is_desk(&self, _: [f64; 2]) -> bool {
        true
    }

    fn to_desk(&self, [x, y]: [f64; 2]) -> [f64; 3] {
        [1e-5 * x, -1e-5 * y, 0.0]
    }

    fn takes_strokes(&self) -> bool {
        true
    }

    fn is_mirrored(&self) -> bool {
        false
    }
}

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

delegate_noop!(Window: wl_compositor::WlCompositor);
delegate_noop!(Window: ignore wl_surface::WlSurface);
