//! The device and the hand that holds it.

use glam::DVec3;
use maulstick_haptics::{Hand, Plant};

use crate::codes;
use crate::script::{Event, Grip, Script};

/// A tick, s.
const TICK_S: f64 = 1e-3;

/// A device that has been initiated.
pub(crate) struct Phantom {
    pub(crate) script: Script,
    plant: Plant,
    /// What the motors give, N.
    pub(crate) force: [f64; 3],
    /// Frames begun.
    pub(crate) frames: u64,
}

impl Phantom {
    pub(crate) fn new(script: &Script) -> Self {
        let start = DVec3::from_array(script.position) * 1e-3;
        Self {
            plant: Plant::omni(Hand::PEN_GRIP, start),
            script: script.clone(),
            force: [0.0; 3],
            frames: 0,
        }
    }

    /// A tick passes.
    pub(crate) fn advance(&mut self) {
        if self.script.grip == Grip::Hand {
            let target = DVec3::from_array(self.script.position) * 1e-3;
            self.plant
                .advance(DVec3::from_array(self.force), target, TICK_S);
        }
    }

    /// What happens to the hand and the device; the rest is the library's.
    pub(crate) fn undergo(&mut self, event: &Event) {
        let script = &mut self.script;
        match event {
            Event::Error(..)
            | Event::ErrorAtEnd(..)
            | Event::Stall
            | Event::Unplug
            | Event::Plug => {}
            Event::Buttons(bits) => script.buttons = *bits,
            Event::Inkwell(state) => script.inkwell = *state,
            Event::Safety(state) => script.safety = *state,
            Event::Temperatures(temperatures) => script.temperatures = *temperatures,
            Event::Position(position) => script.position = *position,
            Event::Axes(axes) => script.axes = *axes,
            Event::Calibration(states) => script.calibration.clone_from(states),
        }
    }

    fn position(&self) -> [f64; 3] {
        match self.script.grip {
            Grip::Fast => self.script.position,
            Grip::Hand => (self.plant.read_position() * 1e3).to_array(),
        }
    }

    fn velocity(&self) -> [f64; 3] {
        match self.script.grip {
            Grip::Fast => self.script.velocity,
            Grip::Hand => (self.plant.read_velocity() * 1e3).to_array(),
        }
    }

    /// Values of a parameter of type double; whether it is legal outside a frame, `codes` says.
    pub(crate) fn doubles(&self, parameter: u32) -> Option<Vec<f64>> {
        let script = &self.script;
        Some(match parameter {
            codes::POSITION => self.position().to_vec(),
            codes::VELOCITY => self.velocity().to_vec(),
            codes::TRANSFORM => {
                let column = |at: [f64; 3], last: f64| [at[0], at[1], at[2], last];
                let [x, y, z] = script.axes.map(|axis| column(axis, 0.0));
                [x, y, z, column(self.position(), 1.0)].concat()
            }
            codes::USABLE_WORKSPACE => script.workspace.to_vec(),
            codes::MAX_STIFFNESS => vec![script.stiffness],
            codes::MAX_FORCE => vec![script.max_force],
            codes::CONTINUOUS_FORCE => vec![script.continuous_force],
            codes::VELOCITY_LIMIT => vec![script.velocity_limit],
            codes::MAX_TORQUE => vec![script.max_torque],
            codes::TEMPERATURE => script.temperatures.to_vec(),
            codes::FORCE => self.force.to_vec(),
            _ => return None,
        })
    }

    /// Values of a parameter that may be got as floats.
    pub(crate) fn floats(&self, parameter: u32) -> Option<Vec<f64>> {
        match parameter {
            codes::IMPULSE_LIMIT => Some(vec![self.script.impulse_limit]),
            _ => self.doubles(parameter),
        }
    }

    /// The value of a parameter of type integer.
    pub(crate) fn integer(&self, parameter: u32) -> Option<i32> {
        Some(match parameter {
            codes::BUTTONS => self.script.buttons,
            codes::INPUT_DOF => self.script.input_dof,
            codes::OUTPUT_DOF => self.script.output_dof,
            codes::CALIBRATION_STYLE => self.script.styles,
            _ => return None,
        })
    }

    /// The value of a parameter of type boolean.
    pub(crate) fn boolean(&self, parameter: u32) -> Option<u8> {
        Some(match parameter {
            codes::SAFETY_SWITCH => self.script.safety,
            codes::INKWELL_SWITCH => self.script.inkwell,
            _ => return None,
        })
    }
}
