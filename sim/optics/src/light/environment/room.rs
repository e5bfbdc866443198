//! Rooms about a picture that hangs or stands in the middle of one wall: boxes with a window at the left.
//!
//! Radiances are of one another alone: a wall that the window lights has a tenth of the sky's.

/// A room. Lengths are in m from the middle of the picture: x right, y up, z into the room.
pub(super) struct Room {
    /// Distance of the walls at the left and at the right, of floor and ceiling, and of the wall behind the viewer.
    aside: f64,
    floor: f64,
    ceiling: f64,
    depth: f64,
    /// Radiance of the wall behind the viewer, of that with the window, of the one that it lights, of the ceiling and
    /// of the floor.
    behind: [f64; 3],
    left: [f64; 3],
    right: [f64; 3],
    above: [f64; 3],
    below: [f64; 3],
    window: Window,
}

struct Window {
    /// Its nearer and farther edge along the wall, and its lower and upper edge.
    along: [f64; 2],
    up: [f64; 2],
    /// Panes along and up, and the width of the bars about each.
    panes: [f64; 2],
    bar: f64,
    /// Radiance of the sky in it.
    sky: [f64; 3],
}

/// 5 m wide, 3 m high and 5 m deep; a window wall, 2.4 m by 1.9 m of it sky.
pub(super) const STUDIO: Room = Room {
    aside: 2.5,
    floor: 1.2,
    ceiling: 1.8,
    depth: 5.0,
    behind: [0.12; 3],
    left: [0.35; 3],
    right: [0.5, 0.49, 0.47],
    above: [0.5; 3],
    below: [0.36, 0.28, 0.2],
    window: Window {
        along: [0.8, 3.2],
        up: [-0.4, 1.5],
        panes: [3.0, 1.0],
        bar: 0.06,
        sky: [5.7, 6.0, 6.4],
    },
};

/// 5 m wide, 4 m high and 6 m deep; a window of two by four panes, 1.2 m wide and 2.6 m high.
pub(super) const CHAMBER: Room = Room {
    aside: 2.5,
    floor: 1.4,
    ceiling: 2.6,
    depth: 6.0,
    behind: [0.06; 3],
    left: [0.12; 3],
    right: [0.3, 0.29, 0.28],
    above: [0.2; 3],
    below: [0.16, 0.12, 0.09],
    window: Window {
        along: [0.7, 1.9],
        up: [-0.6, 2.0],
        panes: [2.0, 4.0],
        bar: 0.1,
        sky: [8.6, 9.0, 9.5],
    },
};

impl Room {
    /// Radiance from a direction, unit vector with z ≥ 0.
    pub(super) fn radiance(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let run = |toward: f64, distance: f64| distance / toward.max(1e-9);
        let vertical = if y > 0.0 {
            run(y, self.ceiling)
        } else {
            run(-y, self.floor)
        };
        let [aside, back] = [run(x.abs(), self.aside), run(z, self.depth)];
        if back <= aside.min(vertical) {
            self.behind
        } else if vertical <= aside {
            if y > 0.0 { self.above } else { self.below }
        } else if x > 0.0 {
            self.right
        } else if self.window.holds([z * aside, y * aside]) {
            self.window.sky
        } else {
            self.left
        }
    }
}

impl Window {
    /// True where the sky is seen through it, along the wall and up.
    fn holds(&self, at: [f64; 2]) -> bool {
        [0, 1].iter().all(|i| {
            let [low, high] = [self.along, self.up][*i];
            let pane = (high - low) / self.panes[*i];
            let within = (at[*i] - low) / pane;
            let from_edge = (within - within.floor()).min(within.ceil() - within) * pane;
            at[*i] > low && at[*i] < high && from_edge > 0.5 * self.bar
        })
    }
}
