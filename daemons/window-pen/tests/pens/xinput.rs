//! Pens of X11, by events as its server sends them. Ranges are those of the drivers `wacom` (tilt of -64 to 63, 57 units a
//! radian, wheel of -900 to 899) and of servers that name no resolution.

use maulstick_device::pen::{End, Presence};
use maulstick_window_pen::xinput::{Labels, NearTool, XinputDevice};
use x11rb::protocol::xinput::{
    BUTTON_PRESS_EVENT, BUTTON_RELEASE_EVENT, ButtonPressEvent, DeviceClass, DeviceClassData,
    DeviceClassDataValuator, DeviceType, Fp3232, MOTION_EVENT, ValuatorMode, XIDeviceInfo,
};

const LABELS: Labels = Labels {
    pressure: 301,
    tilt: [302, 303],
    wheel: 304,
};
const ID: u16 = 11;

fn fixed(value: f64) -> Fp3232 {
    let integral = value.floor();
    Fp3232 {
        integral: integral as i32,
        frac: ((value - integral) * 4_294_967_296.0) as u32,
    }
}

/// A valuator: number, label, least and most, units a radian.
type Axis = (u16, u32, [f64; 2], u32);

const WACOM: [Axis; 6] = [
    (0, 299, [0.0, 44_704.0], 200_000),
    (1, 300, [0.0, 27_940.0], 200_000),
    (2, 301, [0.0, 65_536.0], 0),
    (3, 302, [-64.0, 63.0], 57),
    (4, 303, [-64.0, 63.0], 57),
    (5, 304, [-900.0, 899.0], 1),
];

fn device(name: &str, axes: &[Axis]) -> Option<XinputDevice> {
    let classes = axes
        .iter()
        .map(|(number, label, [min, max], resolution)| DeviceClass {
            len: 11,
            sourceid: ID,
            data: DeviceClassData::Valuator(DeviceClassDataValuator {
                number: *number,
                label: *label,
                min: fixed(*min),
                max: fixed(*max),
                value: fixed(0.0),
                resolution: *resolution,
                mode: ValuatorMode::ABSOLUTE,
            }),
        });
    let info = XIDeviceInfo {
        deviceid: ID,
        type_: DeviceType::SLAVE_POINTER,
        attachment: 2,
        enabled: true,
        name: name.as_bytes().to_vec(),
        classes: classes.collect(),
    };
    XinputDevice::of(&info, &LABELS)
}

/// An event of a type and a button, with the buttons that were down before it.
fn event((kind, detail): (u16, u32), buttons: u32, values: &[(u16, f64)]) -> ButtonPressEvent {
    ButtonPressEvent {
        response_type: 35,
        extension: 131,
        sequence: 0,
        length: 0,
        event_type: kind,
        deviceid: ID,
        time: 7000,
        detail,
        root: 1,
        event: 2,
        child: 0,
        root_x: 0,
        root_y: 0,
        event_x: (100.5 * 65_536.0) as i32,
        event_y: (50.25 * 65_536.0) as i32,
        sourceid: ID,
        flags: 0u32.into(),
        mods: Default::default(),
        group: Default::default(),
        button_mask: vec![buttons],
        valuator_mask: vec![values.iter().fold(0, |all, (number, _)| all | 1 << number)],
        axisvalues: values.iter().map(|(_, value)| fixed(*value)).collect(),
    }
}

const MOVES: (u16, u32) = (MOTION_EVENT, 0);

/// The tools of two pens: one that senses its rotation, one that does not.
const ART_PEN: NearTool = NearTool {
    serial: 0x0815,
    kind: 0x804,
};
const GRIP_PEN: NearTool = NearTool {
    serial: 0x4711,
    kind: 0x802,
};

#[test]
fn valuators_are_read_by_their_labels() {
    let mut pen = device("Wacom Intuos Pro M Pen stylus", &WACOM).expect("a pen");
    pen.set_near(Some(ART_PEN));
    let values = [(2, 32_768.0), (3, 28.5), (4, -57.0), (5, 449.75)];
    let read = pen.read(&event(MOVES, 0b10, &values)).expect("its own");
    assert_eq!(read.time_ms, 7000);
    let reading = read.reading;
    assert_eq!(
        (reading.presence, reading.end),
        (Presence::Touching, End::Tip)
    );
    assert_eq!(read.point_px, [100.5, 50.25]);
    assert!((reading.pressure - 0.5).abs() < 1e-9);
    // Half a radian to the right, one away from the hand; a quarter turn clockwise.
    let [x, y] = reading.tilt_rad.expect("tilt");
    assert!((x - 0.5).abs() < 1e-9 && (y - 1.0).abs() < 1e-9, "{x} {y}");
    let twist = reading.twist_rad.expect("twist");
    assert!(
        (twist + std::f64::consts::FRAC_PI_2).abs() < 1e-9,
        "{twist}"
    );
    // An event tells of those values alone that have changed.
    let read = pen
        .read(&event(MOVES, 0b10, &[(2, 65_536.0)]))
        .expect("its own");
    assert!((read.reading.pressure - 1.0).abs() < 1e-9);
    assert_eq!(read.reading.tilt_rad, Some([x, y]));
}

#[test]
fn buttons_count_from_their_own_event_on() {
    let mut pen = device("pen", &WACOM).expect("a pen");
    let mut at = |what, buttons| {
        let read = pen.read(&event(what, buttons, &[])).expect("its own");
        (read.reading.presence, read.reading.switches)
    };
    use Presence::{Hovering, Touching};
    assert_eq!(at(MOVES, 0), (Hovering, 0));
    assert_eq!(at((BUTTON_PRESS_EVENT, 1), 0), (Touching, 0));
    assert_eq!(at((BUTTON_PRESS_EVENT, 2), 0b10), (Touching, 0b1));
    assert_eq!(at(MOVES, 0b1110), (Touching, 0b11));
    assert_eq!(at((BUTTON_RELEASE_EVENT, 1), 0b1110), (Hovering, 0b11));
    assert_eq!(at((BUTTON_RELEASE_EVENT, 3), 0b1100), (Hovering, 0b1));
}

#[test]
fn a_device_without_pressure_is_no_pen_and_a_pen_may_lack_the_rest() {
    assert_eq!(device("a mouse", &WACOM[..2]), None);
    assert_eq!(device("a range of zero", &[(2, 301, [0.0, 0.0], 0)]), None);
    assert_eq!(
        device("a range upside down", &[(2, 301, [9.0, 3.0], 0)]),
        None
    );
    let mut plain = device("a cheap pen", &WACOM[..3]).expect("a pen");
    let read = plain.read(&event(MOVES, 0, &[])).expect("its own");
    assert_eq!(
        (read.reading.tilt_rad, read.reading.twist_rad),
        (None, None)
    );
    assert!(!read.axes.tilt && !read.axes.twist && read.axes.pressure && !read.axes.range);
    // Pens that cannot turn send the least value of the wheel.
    let mut grip = device("a grip pen", &WACOM).expect("a pen");
    grip.set_near(Some(GRIP_PEN));
    let read = grip
        .read(&event(MOVES, 0, &[(5, -900.0)]))
        .expect("its own");
    assert_eq!((read.reading.twist_rad, read.axes.twist), (None, false));
    for other in [
        "Pad pad",
        "Finger touch",
        "Intuos Pro M Cursor",
        "Tablet Mouse",
    ] {
        assert_eq!(
            device(other, &WACOM),
            None,
            "{other} has a pressure and is no pen"
        );
    }
}

#[test]
fn tilt_without_a_resolution_goes_by_its_range() {
    let mut axes = WACOM;
    (axes[3].3, axes[4].3) = (0, 0);
    (axes[3].2, axes[4].2) = ([-1000.0, 1000.0], [-1000.0, 1000.0]);
    let mut pen = device("pen", &axes).expect("a pen");
    let read = pen.read(&event(MOVES, 0, &[(3, 500.0)])).expect("its own");
    let [x, y] = read.reading.tilt_rad.expect("tilt");
    assert!(
        (x - 32f64.to_radians()).abs() < 1e-9 && y.abs() < 1e-9,
        "{x} {y}"
    );
}

#[test]
fn a_pen_leaves_where_its_driver_says_so() {
    let mut pen = device("Wacom Intuos eraser", &WACOM).expect("a pen");
    let tip = pen.read(&event(MOVES, 0, &[])).expect("its own");
    assert_eq!((tip.reading.end, tip.axes.range), (End::Eraser, false));
    assert_eq!(pen.left(7001), None, "nothing is said");
    // The driver names the tool after its first events: it stays the one that it began as, until it leaves.
    pen.set_near(Some(GRIP_PEN));
    let read = pen.read(&event(MOVES, 0, &[])).expect("its own");
    assert!(read.axes.range && read.tool == tip.tool);
    assert_eq!(pen.left(7002), None, "it is near");
    pen.set_near(Some(NearTool::default()));
    let left = pen.left(7003).expect("gone");
    assert_eq!(
        (left.reading.presence, left.time_ms),
        (Presence::Away, 7003)
    );
    assert_eq!(left.tool, tip.tool);
    assert_eq!(pen.left(7004), None, "once");
    let mut by = |tool: NearTool| {
        pen.set_near(Some(tool));
        let read = pen.read(&event(MOVES, 0, &[])).expect("its own");
        pen.set_near(Some(NearTool::default()));
        pen.left(7005).expect("gone");
        read.tool
    };
    assert_ne!(by(GRIP_PEN), by(ART_PEN), "told apart by their serials");
    let mut other = event(MOVES, 0, &[]);
    other.deviceid = 12;
    assert_eq!(pen.read(&other), None);
}
