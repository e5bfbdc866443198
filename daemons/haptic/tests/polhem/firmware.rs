//! The firmware side of a WoodenHaptics or Polhem stylus, from what is known of it: what it answers,
//! when its watchdog bites, when its amplifiers refuse. On whatever clock it is told.

/// End of a pose line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Style {
    /// 63 bytes and one newline, November 2020.
    Single,
    /// A newline after the numbers, spaces, and another at 64 bytes: uAPI v0.2.
    Double,
}

/// Which lines from the host are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Reads {
    /// Any that ends in a newline within 64 bytes.
    Lines,
    /// Of commands only those of exactly 64 bytes.
    Only64,
    /// As `Lines`, but command 2 is none that it knows.
    NoForces,
    /// None; it answers nothing.
    Nothing,
    /// None; it answers each by a modem's word.
    Modem,
}

/// After this time without a command there is no force, s.
const WATCHDOG_S: f64 = 0.1;
/// Current that holds a newton, mA; the same of each motor and axis, for the kinematics are the firmware's.
const MILLIAMPS_PER_NEWTON: f64 = 1000.0;

#[derive(Clone, Debug)]
pub(crate) struct Firmware {
    pub(crate) style: Style,
    pub(crate) reads: Reads,
    /// Largest current of an amplifier, mA: a larger one is none.
    pub(crate) escon_max: i32,
    /// x toward the user, y right, z up, mm; then t_A, λ, t_D, t_E.
    pub(crate) pose: [f64; 7],
    pub(crate) encoders: [i16; 6],
    /// Currents of the motors, mA.
    pub(crate) currents: [i32; 3],
    pub(crate) enabled: bool,
    /// Commands that were read.
    pub(crate) commands: u64,
    buffer: Vec<u8>,
    tells_poses: bool,
    fed_s: f64,
}

impl Firmware {
    pub(crate) fn new(style: Style, reads: Reads) -> Self {
        Self {
            style,
            reads,
            escon_max: 6000,
            pose: [-59.276, 13.383, -148.002, 0.0919, -1.8483, 1.0370, -1.9512],
            encoders: [8298, -10771, 19756, 0, 30, 0],
            currents: [0; 3],
            enabled: false,
            commands: 0,
            buffer: Vec::new(),
            tells_poses: false,
            fed_s: f64::NEG_INFINITY,
        }
    }

    /// Force on the hand, N, in its own axes.
    pub(crate) fn force(&self) -> [f64; 3] {
        if self.enabled {
            self.currents
                .map(|current| f64::from(current) / MILLIAMPS_PER_NEWTON)
        } else {
            [0.0; 3]
        }
    }

    /// Lets the watchdog look at the clock.
    pub(crate) fn watch(&mut self, now_s: f64) {
        if now_s - self.fed_s >= WATCHDOG_S {
            self.enabled = false;
            self.currents = [0; 3];
        }
    }

    /// Takes in bytes; returns what it answers.
    pub(crate) fn hear(&mut self, bytes: &[u8], now_s: f64) -> Vec<u8> {
        self.watch(now_s);
        let mut answers = Vec::new();
        for byte in bytes {
            self.buffer.push(*byte);
            if *byte == b'\n' {
                let line = std::mem::take(&mut self.buffer);
                match self.reads {
                    Reads::Nothing => {}
                    Reads::Modem => answers.extend(b"ERROR\r\n"),
                    _ => {
                        self.obey(&line, now_s);
                        answers.extend(self.answer());
                    }
                }
            } else if self.buffer.len() == 64 {
                self.buffer.clear();
            }
        }
        answers
    }

    fn obey(&mut self, line: &[u8], now_s: f64) {
        self.currents = [0; 3];
        let text = String::from_utf8_lossy(line);
        let numbers: Vec<i16> = text
            .split_whitespace()
            .map_while(|word| word.parse().ok())
            .collect();
        if numbers.len() < 7 || (self.reads == Reads::Only64 && line.len() != 64) {
            return;
        }
        let motors = [numbers[0], numbers[1], numbers[2]].map(f64::from);
        let currents = match (numbers[3], self.reads) {
            (2, Reads::NoForces) => [0.0; 3],
            (2, _) => {
                self.tells_poses = true;
                motors.map(|mn| mn * 1e-3 * MILLIAMPS_PER_NEWTON)
            }
            _ => {
                self.tells_poses = false;
                motors
            }
        };
        self.currents = currents.map(|current| {
            let current = current as i32;
            if current.abs() <= self.escon_max {
                current
            } else {
                0
            }
        });
        self.enabled = true;
        self.commands += 1;
        self.fed_s = now_s;
    }

    /// Its next answer.
    pub(crate) fn answer(&self) -> Vec<u8> {
        let mut line = if self.tells_poses {
            let [x, y, z, a, l, d, e] = self.pose;
            let mm = |value: f64| format!("{:>8}", format!("{value:.3}"));
            let rad = |value: f64| format!("{:>7}", format!("{value:.4}"));
            let (x, y, z) = (mm(x), mm(y), mm(z));
            let (a, l, d, e) = (rad(a), rad(l), rad(d), rad(e));
            format!("{x} {y} {z} {a} {l} {d} {e} 0")
        } else {
            let [a, b, c, d, e, f] = self.encoders;
            format!("{a} {b} {c} {d} {e} {f} 0")
        };
        let length = match (self.tells_poses, self.style) {
            (true, Style::Single) => 63,
            (true, Style::Double) => {
                line.push('\n');
                64
            }
            (false, _) => 64,
        };
        while line.len() < length - 1 {
            line.push(' ');
        }
        line.push('\n');
        line.into_bytes()
    }
}
