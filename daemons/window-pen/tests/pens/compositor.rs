//! A compositor that speaks tablet-v2 to one client, and does what it is told.

use std::os::fd::AsFd;
use std::os::unix::net::UnixStream;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;

use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use nix::sys::eventfd::{EfdFlags, EventFd};
use wayland_protocols::wp::tablet::zv2::server::{
    zwp_tablet_manager_v2::{self, ZwpTabletManagerV2},
    zwp_tablet_seat_v2::{self, ZwpTabletSeatV2},
    zwp_tablet_tool_v2::{self, ButtonState, Capability, Type, ZwpTabletToolV2},
    zwp_tablet_v2::{self, ZwpTabletV2},
};
use wayland_server::backend::{ClientData, ClientId, DisconnectReason};
use wayland_server::protocol::{wl_compositor, wl_region, wl_seat, wl_surface};
use wayland_server::{Client, DataInit, Dispatch, Display, DisplayHandle, GlobalDispatch, New};

/// Next events of a tool; several between two frames.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Do {
    /// It is near surface number so many of the client.
    Near(usize),
    Away,
    Down,
    Up,
    Move(f64, f64),
    Press(u32),
    Tilt(f64, f64),
    Rotate(f64),
    Button(u32, bool),
    Frame(u32),
    Remove,
}

/// A tool: its kind, its serial, its capabilities.
#[derive(Clone, Debug)]
pub(crate) struct NewTool {
    pub(crate) kind: Type,
    pub(crate) serial: u64,
    pub(crate) capabilities: Vec<Capability>,
}

enum Order {
    Tool(NewTool),
    Do(usize, Vec<Do>),
    Lend(usize, Sender<(ZwpTabletToolV2, DisplayHandle)>),
    Close,
}

#[derive(Default)]
struct Server {
    seats: Vec<ZwpTabletSeatV2>,
    tablets: Vec<ZwpTabletV2>,
    tools: Vec<ZwpTabletToolV2>,
    surfaces: Vec<wl_surface::WlSurface>,
    /// Orders that wait for what they need of the client.
    waiting: Vec<Order>,
    serial: u32,
}

struct Nothing;

impl ClientData for Nothing {
    fn initialized(&self, _: ClientId) {}
    fn disconnected(&self, _: ClientId, _: DisconnectReason) {}
}

/// A compositor on a thread of its own.
pub(crate) struct Compositor {
    orders: Sender<Order>,
    bell: Arc<EventFd>,
    thread: Option<JoinHandle<()>>,
}

impl Compositor {
    /// A compositor with its client's end; without tablets it does not speak their protocol.
    pub(crate) fn start(tablets: bool) -> (Self, UnixStream) {
        let (own, other) = UnixStream::pair().expect("sockets");
        let (orders, told) = channel();
        let flags = EfdFlags::EFD_CLOEXEC | EfdFlags::EFD_NONBLOCK;
        let bell = Arc::new(EventFd::from_value_and_flags(0, flags).expect("a bell"));
        let rung = Arc::clone(&bell);
        let thread = std::thread::spawn(move || {
            let mut display = Display::<Server>::new().expect("a display");
            let mut handle = display.handle();
            handle.create_global::<Server, wl_compositor::WlCompositor, ()>(4, ());
            handle.create_global::<Server, wl_seat::WlSeat, ()>(1, ());
            if tablets {
                handle.create_global::<Server, ZwpTabletManagerV2, ()>(1, ());
            }
            let client = handle
                .insert_client(own, Arc::new(Nothing))
                .expect("a client");
            let mut server = Server::default();
            loop {
                display.flush_clients().expect("flushed");
                let fd = display
                    .backend()
                    .poll_fd()
                    .try_clone_to_owned()
                    .expect("its own");
                let mut both =
                    [fd.as_fd(), rung.as_fd()].map(|fd| PollFd::new(fd, PollFlags::POLLIN));
                poll(&mut both, PollTimeout::NONE).expect("waited");
                rung.read().ok();
                display.dispatch_clients(&mut server).expect("heard");
                server.waiting.extend(told.try_iter());
                for order in std::mem::take(&mut server.waiting) {
                    if matches!(order, Order::Close) {
                        return;
                    }
                    if let Err(order) = server.obey(&handle, &client, order) {
                        server.waiting.push(order);
                    }
                }
            }
        });
        let compositor = Self {
            orders,
            bell,
            thread: Some(thread),
        };
        (compositor, other)
    }

    fn order(&self, order: Order) {
        self.orders.send(order).expect("it lives");
        self.bell.write(1).expect("rung");
    }

    pub(crate) fn tool(&self, tool: NewTool) {
        self.order(Order::Tool(tool));
    }

    /// The tool of this number does all of these.
    pub(crate) fn act(&self, tool: usize, all: &[Do]) {
        self.order(Order::Do(tool, all.to_vec()));
    }

    /// The tool of this number once it has done all that, and what flushes its events: it acts in the caller's time then.
    #[allow(
        dead_code,
        reason = "the benchmark of pens includes this file; the tests send by orders"
    )]
    pub(crate) fn lend(&self, tool: usize) -> Receiver<(ZwpTabletToolV2, DisplayHandle)> {
        let (to, lent) = channel();
        self.order(Order::Lend(tool, to));
        lent
    }
}

impl Drop for Compositor {
    fn drop(&mut self) {
        self.order(Order::Close);
        if let Some(thread) = self.thread.take() {
            thread.join().expect("it ended well");
        }
    }
}

impl Server {
    /// Obeys an order, or gives it back until the client has what it takes. Orders are obeyed in turn.
    fn obey(&mut self, handle: &DisplayHandle, client: &Client, order: Order) -> Result<(), Order> {
        if !self.waiting.is_empty() {
            return Err(order);
        }
        match order {
            Order::Tool(tool) => {
                let Some(seat) = self.seats.first() else {
                    return Err(Order::Tool(tool));
                };
                let new = client.create_resource::<ZwpTabletV2, _, Self>(handle, 1, ());
                let tablet = new.expect("a tablet");
                seat.tablet_added(&tablet);
                tablet.done();
                self.tablets.push(tablet);
                let new = client.create_resource::<ZwpTabletToolV2, _, Self>(handle, 1, ());
                let own = new.expect("a tool");
                seat.tool_added(&own);
                own._type(tool.kind);
                own.hardware_serial((tool.serial >> 32) as u32, tool.serial as u32);
                for capability in tool.capabilities {
                    own.capability(capability);
                }
                own.done();
                self.tools.push(own);
            }
            Order::Do(tool, all) => {
                let needed = all.iter().filter_map(|act| match act {
                    Do::Near(surface) => Some(*surface),
                    _ => None,
                });
                let surfaces = needed.max().map_or(0, |surface| surface + 1);
                if tool >= self.tools.len() || surfaces > self.surfaces.len() {
                    return Err(Order::Do(tool, all));
                }
                for act in all {
                    self.act(tool, act);
                }
            }
            Order::Lend(tool, to) => {
                to.send((self.tools[tool].clone(), handle.clone())).ok();
            }
            Order::Close => {}
        }
        Ok(())
    }

    fn act(&mut self, tool: usize, act: Do) {
        self.serial += 1;
        let (serial, own) = (self.serial, &self.tools[tool]);
        match act {
            Do::Near(surface) => {
                own.proximity_in(serial, &self.tablets[tool], &self.surfaces[surface]);
            }
            Do::Away => own.proximity_out(),
            Do::Down => own.down(serial),
            Do::Up => own.up(),
            Do::Move(x, y) => own.motion(x, y),
            Do::Press(pressure) => own.pressure(pressure),
            Do::Tilt(x, y) => own.tilt(x, y),
            Do::Rotate(degrees) => own.rotation(degrees),
            Do::Button(button, down) => {
                let state = if down {
                    ButtonState::Pressed
                } else {
                    ButtonState::Released
                };
                own.button(serial, button, state);
            }
            Do::Frame(time) => own.frame(time),
            Do::Remove => own.removed(),
        }
    }
}

impl GlobalDispatch<ZwpTabletManagerV2, ()> for Server {
    fn bind(
        _: &mut Self,
        _: &DisplayHandle,
        _: &Client,
        new: New<ZwpTabletManagerV2>,
        _: &(),
        init: &mut DataInit<'_, Self>,
    ) {
        init.init(new, ());
    }
}

impl Dispatch<ZwpTabletManagerV2, ()> for Server {
    fn request(
        server: &mut Self,
        _: &Client,
        _: &ZwpTabletManagerV2,
        request: zwp_tablet_manager_v2::Request,
        _: &(),
        _: &DisplayHandle,
        init: &mut DataInit<'_, Self>,
    ) {
        if let zwp_tablet_manager_v2::Request::GetTabletSeat { tablet_seat, .. } = request {
            server.seats.push(init.init(tablet_seat, ()));
        }
    }
}

impl GlobalDispatch<wl_compositor::WlCompositor, ()> for Server {
    fn bind(
        _: &mut Self,
        _: &DisplayHandle,
        _: &Client,
        new: New<wl_compositor::WlCompositor>,
        _: &(),
        init: &mut DataInit<'_, Self>,
    ) {
        init.init(new, ());
    }
}

impl Dispatch<wl_compositor::WlCompositor, ()> for Server {
    fn request(
        server: &mut Self,
        _: &Client,
        _: &wl_compositor::WlCompositor,
        request: wl_compositor::Request,
        _: &(),
        _: &DisplayHandle,
        init: &mut DataInit<'_, Self>,
    ) {
        if let wl_compositor::Request::CreateSurface { id } = request {
            server.surfaces.push(init.init(id, ()));
        }
    }
}

impl GlobalDispatch<wl_seat::WlSeat, ()> for Server {
    fn bind(
        _: &mut Self,
        _: &DisplayHandle,
        _: &Client,
        new: New<wl_seat::WlSeat>,
        _: &(),
        init: &mut DataInit<'_, Self>,
    ) {
        init.init(new, ());
    }
}

/// Objects whose requests are taken in silence.
macro_rules! silent {
    ($($object:ty, $request:ty);+ $(;)?) => {$(
        impl Dispatch<$object, ()> for Server {
            fn request(
                _: &mut Self,
                _: &Client,
                _: &$object,
                _: $request,
                _: &(),
                _: &DisplayHandle,
                _: &mut DataInit<'_, Self>,
            ) {
            }
        }
    )+};
}

silent! {
    wl_seat::WlSeat, wl_seat::Request;
    wl_surface::WlSurface, wl_surface::Request;
    wl_region::WlRegion, wl_region::Request;
    ZwpTabletSeatV2, zwp_tablet_seat_v2::Request;
    ZwpTabletV2, zwp_tablet_v2::Request;
    ZwpTabletToolV2, zwp_tablet_tool_v2::Request;
}
