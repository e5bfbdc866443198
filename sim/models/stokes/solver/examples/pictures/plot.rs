//! Plots: axes with ticks, curves, marks, fields as colours and as contours.

use crate::image::{BLACK, Colour, Image, PALE, viridis};

/// A rectangle of an image and the values at its sides.
#[derive(Clone, Copy)]
pub(crate) struct Axes {
    /// Left, top, width, height, pixels.
    pub area: [f64; 4],
    /// Values at the left and at the right.
    pub x: [f64; 2],
    /// Values at the bottom and at the top.
    pub y: [f64; 2],
}

impl Axes {
    /// Pixel of a value.
    pub(crate) fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [left, top, width, height] = self.area;
        let right = (x - self.x[0]) / (self.x[1] - self.x[0]);
        let up = (y - self.y[0]) / (self.y[1] - self.y[0]);
        [left + width * right, top + height * (1.0 - up)]
    }

    /// Value at a pixel.
    fn value(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [left, top, width, height] = self.area;
        let right = (x - left) / width;
        let up = 1.0 - (y - top) / height;
        [
            self.x[0] + right * (self.x[1] - self.x[0]),
            self.y[0] + up * (self.y[1] - self.y[0]),
        ]
    }

    /// A frame with a numbered tick and a pale line at each multiple of the steps.
    pub(crate) fn frame(&self, image: &mut Image, steps: [f64; 2], decimals: [usize; 2]) {
        let multiples = |[low, high]: [f64; 2], step: f64| {
            let first = (low / step - 1e-9).ceil() as i32;
            let last = (high / step + 1e-9).floor() as i32;
            (first..=last).map(move |number| f64::from(number) * step)
        };
        for x in multiples(self.x, steps[0]) {
            let [below, above] = [self.at([x, self.y[0]]), self.at([x, self.y[1]])];
            image.line(below, above, 1.0, PALE);
            image.line(below, [below[0], below[1] + 6.0], 1.0, BLACK);
            image.number(x, decimals[0], [below[0], below[1] + 16.0]);
        }
        for y in multiples(self.y, steps[1]) {
            let [left, right] = [self.at([self.x[0], y]), self.at([self.x[1], y])];
            image.line(left, right, 1.0, PALE);
            image.line(left, [left[0] - 6.0, left[1]], 1.0, BLACK);
            image.number(y, decimals[1], [left[0] - 26.0, left[1]]);
        }
        self.outline(image);
    }

    pub(crate) fn outline(&self, image: &mut Image) {
        let [left, top, width, height] = self.area;
        let corners = [
            [left, top],
            [left + width, top],
            [left + width, top + height],
            [left, top + height],
        ];
        for i in 0..4 {
            image.line(corners[i], corners[(i + 1) % 4], 1.0, BLACK);
        }
    }

    pub(crate) fn curve(&self, image: &mut Image, points: &[[f64; 2]], width: f64, colour: Colour) {
        for pair in points.windows(2) {
            image.line(self.at(pair[0]), self.at(pair[1]), width, colour);
        }
    }

    /// Rings, so that a curve is seen through them.
    pub(crate) fn marks(&self, image: &mut Image, points: &[[f64; 2]], colour: Colour) {
        const CORNERS: usize = 16;
        for point in points {
            let [x, y] = self.at(*point);
            let corner = |number: usize| {
                let angle = 2.0 * std::f64::consts::PI * number as f64 / CORNERS as f64;
                let [sine, cosine] = [maulstick_num::sin(angle), maulstick_num::cos(angle)];
                [x + 4.0 * cosine, y + 4.0 * sine]
            };
            for number in 0..CORNERS {
                image.line(corner(number), corner(number + 1), 1.2, colour);
            }
        }
    }

    /// Colours from 0 to 1 of what a value has at each pixel.
    pub(crate) fn colours(&self, image: &mut Image, value: impl Fn([f64; 2]) -> Option<f64>) {
        self.pixels(|x, y, at| {
            if let Some(value) = value(at) {
                image.blend(x, y, viridis(value), 1.0);
            }
        });
    }

    /// Line along which a function has a level.
    pub(crate) fn contour(
        &self,
        image: &mut Image,
        function: impl Fn([f64; 2]) -> Option<f64>,
        level: f64,
        (width, colour): (f64, Colour),
    ) {
        self.pixels(|x, y, _| {
            let near = |dx: f64, dy: f64| {
                let pixel = [x as f64 + 0.5 + dx, y as f64 + 0.5 + dy];
                function(self.value(pixel))
            };
            let [Some(here), Some(left), Some(right), Some(up), Some(down)] = [
                near(0.0, 0.0),
                near(-1.0, 0.0),
                near(1.0, 0.0),
                near(0.0, -1.0),
                near(0.0, 1.0),
            ] else {
                return;
            };
            let [across, along] = [0.5 * (right - left), 0.5 * (down - up)];
            let slope = (across * across + along * along).sqrt().max(1e-12);
            let distance = (here - level).abs() / slope;
            image.blend(x, y, colour, 0.5 * width + 0.5 - distance);
        });
    }

    fn pixels(&self, mut each: impl FnMut(isize, isize, [f64; 2])) {
        let [left, top, width, height] = self.area.map(|side| side as isize);
        for y in top..top + height {
            for x in left..left + width {
                each(x, y, self.value([x as f64 + 0.5, y as f64 + 0.5]));
            }
        }
    }
}

/// Colours of all values, at the right of a place.
pub(crate) fn colour_bar(image: &mut Image, area: [f64; 4], most: f64, step: f64, decimals: usize) {
    let bar = Axes {
        area,
        x: [0.0, 1.0],
        y: [0.0, most],
    };
    bar.colours(image, |[_, y]| Some(y / most));
    bar.outline(image);
    let [left, _, width, _] = area;
    let mut value = 0.0;
    while value < most + 1e-9 {
        let [_, y] = bar.at([0.0, value]);
        image.line([left + width, y], [left + width + 5.0, y], 1.0, BLACK);
        image.number(value, decimals, [left + width + 24.0, y]);
        value += step;
    }
}
