//! Orders to a player: keys of a terminal, or lines of another program.

use std::future::pending;
use std::io::{BufRead as _, IsTerminal as _};

use console::{Key, Term};
use maulstick_device::player::Rate;
use maulstick_recorder::{Order, RATES, ReplayReport};
use nix::sys::termios::{SetArg, Termios, tcgetattr, tcsetattr};
use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};
use tokio::task::spawn_blocking;

use crate::commands::option_error::{OptionError, number_within};

/// Seconds that an arrow key goes.
const SKIP_S: f64 = 5.0;
/// Step of a key that changes the strength.
const STRONGER: f64 = 0.1;
/// Help of the keys.
const KEYS: &str =
    "space: pause   ← →: 5 s   . : next event   + -: faster, slower   0: beginning   q: end";
/// Help of the keys while a hand is guided.
const GUIDE_KEYS: &str = "space: let go   [ ]: softer, stronger   ← →: 5 s   0: beginning   q: end";

/// Orders as they come.
#[derive(Debug)]
pub(super) struct Orders {
    /// True if they are lines of the standard input.
    are_lines: bool,
    orders: Option<UnboundedReceiver<Order>>,
    /// The terminal's earlier mode.
    before: Option<Termios>,
}

impl Orders {
    /// Lines of the standard input, or keys of the terminal where there is one.
    pub(super) fn new(are_lines: bool) -> Self {
        Self {
            are_lines,
            orders: None,
            before: None,
        }
    }

    /// Listens from the first report on that says where the player is.
    pub(super) fn listen(&mut self, report: &ReplayReport) {
        let keys = match report {
            ReplayReport::Position(_) => KEYS,
            ReplayReport::Guiding(_) => GUIDE_KEYS,
            ReplayReport::Opening { .. } | ReplayReport::Painting { .. } => return,
        };
        if self.orders.is_some() {
            return;
        }
        let (send, orders) = unbounded_channel();
        self.orders = Some(orders);
        // The system's only way to wait for either is to block a thread.
        if self.are_lines {
            spawn_blocking(move || read_lines(&send));
        } else if std::io::stdin().is_terminal() {
            self.before = tcgetattr(std::io::stdin()).ok();
            eprintln!("{keys}");
            spawn_blocking(move || read_keys(&send));
        }
    }

    /// True if keys are orders.
    pub(super) fn are_keys(&self) -> bool {
        self.before.is_some()
    }

    /// The next order; for ever none where there are no more.
    pub(super) async fn next(&mut self) -> Order {
        let next = match &mut self.orders {
            Some(orders) => orders.recv().await,
            None => None,
        };
        match next {
            Some(order) => order,
            None => pending().await,
        }
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

fn read_lines(send: &UnboundedSender<Order>) {
    for line in std::io::stdin().lock().lines().map_while(Result::ok) {
        match parse(&line) {
            Ok(order) if send.send(order).is_err() => return,
            Ok(_) => {}
            Err(what) => eprintln!("{what}"),
        }
    }
}

fn read_keys(send: &UnboundedSender<Order>) {
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

/// An order as a line.
fn parse(line: &str) -> Result<Order, OptionError> {
    let (word, rest) = line.trim().split_once(' ').unwrap_or((line.trim(), ""));
    let number = || match rest.trim().parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err(OptionError::unexpected(
            line,
            format!("{word} with a number of seconds"),
        )),
    };
    match word {
        "pause" => Ok(Order::Pause),
        "step" => Ok(Order::Step),
        "end" => Ok(Order::End),
        "seek" => number().map(Order::Seek),
        "skip" => number().map(Order::Skip),
        "rate" => parse_rate(rest.trim()).map(Order::Rate),
        "strength" => parse_strength(rest.trim()).map(Order::Strength),
        _ => Err(OptionError::unexpected(
            line,
            "pause, step, seek S, skip S, rate R, strength P or end",
        )),
    }
}

/// A rate within [`RATES`], or `max`.
///
/// # Errors
/// An [`OptionError`] for another text.
pub(super) fn parse_rate(text: &str) -> Result<Rate, OptionError> {
    match text.parse() {
        Ok(Rate::Times(rate)) if RATES.contains(&rate) => Ok(Rate::Times(rate)),
        Ok(Rate::Max) => Ok(Rate::Max),
        _ => Err(OptionError::unexpected(
            text,
            "a rate from .1 to 100, or max",
        )),
    }
}

/// A strength from 0 to 1.
///
/// # Errors
/// An [`OptionError`] for another text.
pub(super) fn parse_strength(text: &str) -> Result<f64, OptionError> {
    number_within(text, 0.0..=1.0, "strength")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_are_read_and_wrong_ones_rejected() {
        assert_eq!(parse("seek 3.5"), Ok(Order::Seek(3.5)));
        assert_eq!(parse(" skip -2\n"), Ok(Order::Skip(-2.0)));
        assert_eq!(parse("rate max"), Ok(Order::Rate(Rate::Max)));
        assert_eq!(parse("strength 0.4"), Ok(Order::Strength(0.4)));
        for wrong in [
            "",
            "seek",
            "seek nan",
            "rate 0",
            "rate 101",
            "halt",
            "strength 1.1",
        ] {
            assert!(parse(wrong).is_err(), "{wrong}");
        }
    }
}
