//! A display for windows, and a hand at its mouse.

use std::io::{BufRead as _, BufReader};
use std::process::{Child, Command, Stdio};

use maulstick_bus::typed::Receiver;
use maulstick_types::stylus::StylusSample;
use x11rb::connection::Connection as _;
use x11rb::protocol::xproto::{
    AtomEnum, BUTTON_PRESS_EVENT, BUTTON_RELEASE_EVENT, ClientMessageEvent, ConnectionExt as _,
    EventMask, ImageFormat, MOTION_NOTIFY_EVENT, MapState, Window,
};
use x11rb::protocol::xtest::ConnectionExt as _;
use x11rb::rust_connection::RustConnection;

use super::{PATIENCE, hear, wait_for};

/// An X server without a screen.
pub struct Display {
    server: Child,
    /// For the environment of programs.
    pub name: String,
    connection: RustConnection,
    root: Window,
}

impl Display {
    pub fn start() -> Self {
        // The server picks a free number and writes it to descriptor 1.
        let mut server = Command::new("Xvfb")
            .args([
                "-displayfd",
                "1",
                "-screen",
                "0",
                "1280x1024x24",
                "-nolisten",
                "tcp",
            ])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("Xvfb is installed: ./test sees to it");
        let mut number = String::new();
        let out = server.stdout.take().expect("piped");
        BufReader::new(out)
            .read_line(&mut number)
            .expect("a number");
        let name = format!(":{}", number.trim());
        let (connection, screen) = x11rb::connect(Some(&name)).expect("a display");
        let root = connection.setup().roots[screen].root;
        Self {
            server,
            name,
            connection,
            root,
        }
    }

    /// The window whose title begins with `title`, once it is there.
    pub fn window(&self, title: &str) -> Window {
        wait_for(PATIENCE, || {
            let tree = self.connection.query_tree(self.root).ok()?.reply().ok()?;
            tree.children
                .into_iter()
                .find(|window| self.visible(*window) && self.title(*window).starts_with(title))
        })
        .unwrap_or_else(|| panic!("no window '{title}'"))
    }

    fn visible(&self, window: Window) -> bool {
        let attributes = self.connection.get_window_attributes(window).ok();
        attributes
            .and_then(|cookie| cookie.reply().ok())
            .is_some_and(|attributes| attributes.map_state == MapState::VIEWABLE)
    }

    fn title(&self, window: Window) -> String {
        self.connection
            .get_property(false, window, AtomEnum::WM_NAME, AtomEnum::ANY, 0, 64)
            .ok()
            .and_then(|cookie| cookie.reply().ok())
            .map(|reply| String::from_utf8_lossy(&reply.value).into_owned())
            .unwrap_or_default()
    }

    fn atom(&self, name: &str) -> u32 {
        self.connection
            .intern_atom(false, name.as_bytes())
            .expect("sent")
            .reply()
            .expect("one")
            .atom
    }

    /// Asks a window to close, as a window manager does.
    pub fn close(&self, window: Window) {
        let data = [self.atom("WM_DELETE_WINDOW"), 0, 0, 0, 0];
        let event = ClientMessageEvent::new(32, window, self.atom("WM_PROTOCOLS"), data);
        self.connection
            .send_event(false, window, EventMask::NO_EVENT, event)
            .expect("sent");
        self.connection.flush().expect("flushed");
    }

    fn fake(&self, kind: u8, detail: u8, at: [i16; 2]) {
        self.connection
            .xtest_fake_input(kind, detail, 0, self.root, at[0], at[1], 0)
            .expect("sent")
            .check()
            .expect("accepted");
    }

    /// Drags the pressed mouse through points of the screen in one go, and waits until the rig has
    /// heard it all as samples of `mouse`. One go is one stroke: a window that draws slowly sends
    /// what it finds in a frame together.
    pub fn drag(&self, points: &[[i16; 2]], mouse: &mut Receiver<StylusSample>) {
        // The pointer stirs until it is heard: the window may not have a frame to look at it yet.
        let mut stirred = 0;
        let heard = wait_for(PATIENCE, || {
            stirred += 1;
            let [x, y] = points[0];
            self.fake(MOTION_NOTIFY_EVENT, 0, [x + stirred % 2, y]);
            mouse.try_recv()
        });
        assert!(heard.is_some(), "the pointer is not heard");
        self.fake(BUTTON_PRESS_EVENT, 1, points[0]);
        for point in points {
            self.fake(MOTION_NOTIFY_EVENT, 0, *point);
        }
        self.fake(BUTTON_RELEASE_EVENT, 1, points[points.len() - 1]);
        hear(mouse, |sample| sample.switches == 1).expect("the press is heard");
        hear(mouse, |sample| sample.switches == 0).expect("the release is heard");
    }

    /// A pixel of a window.
    pub fn pixel(&self, window: Window, x: i16, y: i16) -> [u8; 3] {
        let image = self
            .connection
            .get_image(ImageFormat::Z_PIXMAP, window, x, y, 1, 1, u32::MAX)
            .expect("sent")
            .reply()
            .expect("a pixel");
        [image.data[2], image.data[1], image.data[0]]
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        self.server.kill().ok();
        self.server.wait().ok();
    }
}
