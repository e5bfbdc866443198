//! Where orders to a replay come from: keys of a terminal, or lines of another program.

use std::io::{BufRead as _, IsTerminal as _};
use std::sync::mpsc::{Receiver, Sender, channel};

use console::{Key, Term};
use maulstick_rig::UserError;
use nix::sys::termios::{SetArg, Termios, tcgetattr, tcsetattr};

use super::guide::STRONGER;
use super::transport::Order;

/// Seconds that an arrow key goes.
const SKIP_S: f64 = 5.0;
/// What the keys do.
pub(super) const KEYS: &str =
    "space: pause   ← →: 5 s   . : next event   + -: faster, slower   0: beginning   q: end";

/// What the keys do while it guides a hand.
pub(super) const GUIDE_KEYS: &str =
    "space: let go   [ ]: softer, stronger   ← →: 5 s   0: beginning   q: end";

/// Orders as they come.
#[derive(Debug)]
pub(super) struct Orders {
    orders: Receiver<Order>,
    /// The terminal as it was.
    before: Option<Termios>,
}

impl Orders {
    /// Keys of the terminal, where there is one; with `lines` lines of the standard input instead.
    ///
    /// # Errors
    /// A [`UserError`] where no thread can be started.
    pub(super) fn listen(lines: bool) -> Result<Self, UserError> {
        let (send, orders) = channel();
        let is_terminal = std::io::stdin().is_terminal() && !lines;
        let before = tcgetattr(std::io::stdin()).ok().filter(|_| is_terminal);
        let read = match (lines, is_terminal) {
            (true, _) => read_lines,
            (false, true) => read_keys,
            (false, false) => return Ok(Self { orders, before }),
        };
        std::thread::Builder::new()
            .name("orders".into())
            .spawn(move || read(&send))
            .map_err(|error| UserError::failure(error.to_string()))?;
        Ok(Self { orders, before })
    }

    /// True if keys are orders.
    pub(super) fn are_keys(&self) -> bool {
        self.before.is_some()
    }

    /// The next order, if there is one.
    pub(super) fn next(&self) -> Option<Order> {
        self.orders.try_recv().ok()
    }
}

impl Drop for Orders {
    fn drop(&mut self) {
        // A key was being waited for.
        if let Some(before) = &self.before {
            tcsetattr(std::io::stdin(), SetArg::TCSANOW, before).ok();
        }
    }
}

fn read_lines(send: &Sender<Order>) {
    for line in std::io::stdin().lock().lines().map_while(Result::ok) {
        match line.parse() {
            Ok(order) if send.send(order).is_err() => return,
            Ok(_) => {}
            Err(what) => eprintln!("{what}"),
        }
    }
}

fn read_keys(send: &Sender<Order>) {
    let terminal = Term::stderr();
    while let Ok(key) = terminal.read_key() {
        let order = match key {
            Key::Char(' ') => Order::Pause,
            Key::ArrowLeft => Order::Skip(-SKIP_S),
            Key::ArrowRight => Order::Skip(SKIP_S),
            Key::Char('.') => Order::Step,
            Key::Char('+' | '=') => Order::Faster(2.0),
            Key::Char('-') => Order::Faster(0.5),
            Key::Char(']') => Order::Stronger(STRONGER),
            Key::Char('[') => Order::Stronger(-STRONGER),
            Key::Char('0') | Key::Home => Order::Seek(0.0),
            Key::Char('q') | Key::Escape => Order::End,
            _ => continue,
        };
        if send.send(order).is_err() {
            return;
        }
    }
}
