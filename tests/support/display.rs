//! A display for windows, and a hand at its mouse.

use std::io::{BufRead as _, BufReader};
use std::process::{Child, Command, Stdio};

use eframe::egui::{Pos2, Rect};
use glam::DVec3;
use maulstick_brush::palette_place::Side;
use maulstick_bus::typed::Receiver;
use maulstick_painting::PaintingSetup;
use maulstick_types::stylus::StylusSample;
use maulstick_ui::app::rack;
use maulstick_ui::settings::preferences::Preferences;
use maulstick_ui::view::camera::View;
use x11rb::connection::Connection as _;
use x11rb::protocol::xproto::{
    AtomEnum, BUTTON_PRESS_EVENT, BUTTON_RELEASE_EVENT, ClientMessageEvent, ConnectionExt as _,
    EventMask, ImageFormat, InputFocus, KEY_PRESS_EVENT, KEY_RELEASE_EVENT, MOTION_NOTIFY_EVENT,
    MapState, Window,
};
use x11rb::protocol::xtest::ConnectionExt as _;
use x11rb::rust_connection::RustConnection;

use super::{PATIENCE, hear, wait_for};

/// Keysyms that have no letter.
pub const SHIFT: u32 = 0xffe1;
pub const CONTROL: u32 = 0xffe3;
pub const RETURN: u32 = 0xff0d;
pub const TAB: u32 = 0xff09;
pub const ESCAPE: u32 = 0xff1b;
pub const BACKSPACE: u32 = 0xff08;

/// Where a new painting of the default size lies in a window of the default size.
pub fn desk_view() -> View {
    let scene = PaintingSetup::default().scene();
    let size = Preferences::default().window.size;
    let area = Rect::from_min_size(Pos2::ZERO, size.into());
    let (canvas, palette) = (&scene.surfaces[0], scene.surfaces.get(1));
    View::of(area, canvas, palette, Side::Left, rack::WIDTH).expect("a view")
}

/// The point of the window over one of the desk, mm.
pub fn over(x: f64, y: f64) -> [i16; 2] {
    let at = desk_view().to_window(1e-3 * DVec3::new(x, y, 0.0));
    [at.x, at.y].map(|at| at.round() as i16)
}

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

    /// The window whose title has `title` in it, once it is there; it has the keyboard.
    pub fn window(&self, title: &str) -> Window {
        let window = wait_for(PATIENCE, || {
            let tree = self.connection.query_tree(self.root).ok()?.reply().ok()?;
            tree.children
                .into_iter()
                .find(|window| self.visible(*window) && self.title(*window).contains(title))
        })
        .unwrap_or_else(|| panic!("no window '{title}'"));
        // No window manager does it here.
        self.connection
            .set_input_focus(InputFocus::POINTER_ROOT, window, x11rb::CURRENT_TIME)
            .expect("sent")
            .check()
            .expect("focused");
        window
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

    /// Moves the pointer over a point of the screen.
    pub fn point(&self, at: [i16; 2]) {
        self.fake(MOTION_NOTIFY_EVENT, 0, at);
    }

    /// Presses and lets go a button of the mouse, or turns its wheel a notch: 4 is up, 5 is down.
    pub fn click(&self, button: u8, at: [i16; 2]) {
        self.point(at);
        self.fake(BUTTON_PRESS_EVENT, button, at);
        self.fake(BUTTON_RELEASE_EVENT, button, at);
    }

    /// Presses a button at the first of some points and holds it along them.
    pub fn press(&self, button: u8, points: &[[i16; 2]]) {
        self.point(points[0]);
        self.fake(BUTTON_PRESS_EVENT, button, points[0]);
        for point in points {
            self.point(*point);
        }
    }

    /// Goes on with a held button, and lets it go.
    pub fn release(&self, button: u8, points: &[[i16; 2]]) {
        for point in points {
            self.point(*point);
        }
        self.fake(BUTTON_RELEASE_EVENT, button, [0, 0]);
    }

    /// Turns the wheel while another button is held.
    pub fn click_held(&self, button: u8, at: [i16; 2]) {
        self.fake(BUTTON_PRESS_EVENT, button, at);
        self.fake(BUTTON_RELEASE_EVENT, button, at);
    }

    /// Presses keys together, named by their X keysyms, and lets them go.
    pub fn keys(&self, keysyms: &[u32]) {
        self.hold(keysyms);
        self.let_go(keysyms);
    }

    /// Presses keys, the first one first.
    pub fn hold(&self, keysyms: &[u32]) {
        for code in self.codes(keysyms) {
            self.fake(KEY_PRESS_EVENT, code, [0, 0]);
        }
    }

    /// Lets keys go, the last one first.
    pub fn let_go(&self, keysyms: &[u32]) {
        for code in self.codes(keysyms).into_iter().rev() {
            self.fake(KEY_RELEASE_EVENT, code, [0, 0]);
        }
    }

    fn codes(&self, keysyms: &[u32]) -> Vec<u8> {
        let setup = self.connection.setup();
        let (least, most) = (setup.min_keycode, setup.max_keycode);
        let mapping = self
            .connection
            .get_keyboard_mapping(least, most - least + 1)
            .expect("sent")
            .reply()
            .expect("a keyboard");
        let wide = usize::from(mapping.keysyms_per_keycode);
        let code = |keysym: &u32| {
            let place = mapping
                .keysyms
                .chunks(wide)
                .position(|row| row.contains(keysym));
            least + place.unwrap_or_else(|| panic!("no key {keysym:#x}")) as u8
        };
        keysyms.iter().map(code).collect()
    }

    /// A picture of a window, rows from the top.
    pub fn picture(&self, window: Window, width: u16, height: u16) -> Vec<[u8; 3]> {
        let image = self
            .connection
            .get_image(ImageFormat::Z_PIXMAP, window, 0, 0, width, height, u32::MAX)
            .expect("sent")
            .reply()
            .expect("pixels");
        let pixels = image.data.chunks_exact(4);
        pixels.map(|bgrx| [bgrx[2], bgrx[1], bgrx[0]]).collect()
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
