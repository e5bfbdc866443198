//! The terminal of a progress bar, without blocking: the bar is drawn whole, or not at all while the terminal is
//! stopped.

use std::fmt::Write as _;
use std::io;
use std::sync::{Mutex, PoisonError};

use console::Term;
use indicatif::{ProgressDrawTarget, TermLike};
use maulstick_rig::log::show;

/// Standard error, through the log.
#[derive(Debug)]
pub(super) struct BarTerminal {
    terminal: Term,
    /// What is drawn next.
    drawing: Mutex<String>,
}

/// Drawings a second.
const HZ: u8 = 10;

impl BarTerminal {
    /// A target for a bar; hidden where the standard error is no terminal.
    pub(super) fn target() -> ProgressDrawTarget {
        let terminal = Term::stderr();
        if !terminal.is_term() {
            return ProgressDrawTarget::hidden();
        }
        let drawing = Mutex::default();
        ProgressDrawTarget::term_like_with_hz(Box::new(Self { terminal, drawing }), HZ)
    }

    fn draw(&self, text: std::fmt::Arguments<'_>) -> io::Result<()> {
        let mut drawing = self.drawing.lock().unwrap_or_else(PoisonError::into_inner);
        drawing.write_fmt(text).map_err(io::Error::other)
    }

    /// Moves the cursor by `n`, in the direction of a letter of ECMA-48.
    fn move_cursor(&self, n: usize, direction: char) -> io::Result<()> {
        match n {
            0 => Ok(()),
            _ => self.draw(format_args!("\x1b[{n}{direction}")),
        }
    }
}

impl TermLike for BarTerminal {
    fn width(&self) -> u16 {
        self.terminal.size().1
    }

    fn height(&self) -> u16 {
        self.terminal.size().0
    }

    fn move_cursor_up(&self, n: usize) -> io::Result<()> {
        self.move_cursor(n, 'A')
    }

    fn move_cursor_down(&self, n: usize) -> io::Result<()> {
        self.move_cursor(n, 'B')
    }

    fn move_cursor_right(&self, n: usize) -> io::Result<()> {
        self.move_cursor(n, 'C')
    }

    fn move_cursor_left(&self, n: usize) -> io::Result<()> {
        self.move_cursor(n, 'D')
    }

    fn write_line(&self, text: &str) -> io::Result<()> {
        self.draw(format_args!("{text}\n"))
    }

    fn write_str(&self, text: &str) -> io::Result<()> {
        self.draw(format_args!("{text}"))
    }

    fn clear_line(&self) -> io::Result<()> {
        self.draw(format_args!("\r\x1b[2K"))
    }

    fn flush(&self) -> io::Result<()> {
        let mut drawing = self.drawing.lock().unwrap_or_else(PoisonError::into_inner);
        show(&std::mem::take(&mut *drawing));
        Ok(())
    }
}
