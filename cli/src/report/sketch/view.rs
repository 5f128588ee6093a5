//! The two views of a sketch while they are drawn.

use crate::report::document::{Shape, Sketch, View};

/// A detail is drawn if what acts takes less than this share of a view.
const SMALL: f64 = 0.35;
/// Widening of the detail around what acts.
const MARGIN: f64 = 1.6;

/// Views from the side (x, z) and from above (x, y).
#[derive(Default)]
pub struct Views {
    pub side: Drawing,
    pub top: Drawing,
}

impl Views {
    pub fn sketch(self, title: String) -> Sketch {
        let views = [
            self.side.view("From the side (x, z)", true),
            self.top.view("From above (x, y)", false),
        ];
        Sketch { title, views: views.into_iter().flatten().collect() }
    }
}

/// Shapes of a view, the ends of all and the ends of what acts.
#[derive(Default)]
pub struct Drawing {
    shapes: Vec<Shape>,
    whole: Ends,
    acting: Ends,
}

/// Least and largest coordinates of what was added.
#[derive(Clone, Copy)]
struct Ends {
    low: [f64; 2],
    high: [f64; 2],
}

impl Default for Ends {
    fn default() -> Self {
        Self { low: [f64::INFINITY; 2], high: [f64::NEG_INFINITY; 2] }
    }
}

impl Ends {
    fn add(&mut self, points: &[[f64; 2]]) {
        for point in points {
            for (axis, &place) in point.iter().enumerate() {
                self.low[axis] = self.low[axis].min(place);
                self.high[axis] = self.high[axis].max(place);
            }
        }
    }

    fn is_empty(&self) -> bool {
        self.low[0] > self.high[0]
    }

    fn size(&self) -> [f64; 2] {
        [0, 1].map(|axis| self.high[axis] - self.low[axis])
    }
}

/// Words of a shape: its full text, and the one that is drawn.
pub struct Words<'w> {
    pub label: String,
    pub short: &'w str,
}

impl Words<'_> {
    pub fn none() -> Self {
        Self { label: String::new(), short: "" }
    }
}

impl Drawing {
    /// Adds a shape; `extent` are points that it reaches.
    fn add(&mut self, shape: &str, role: &str, at: Vec<f64>, words: Words, extent: &[[f64; 2]]) {
        self.whole.add(extent);
        if ["load", "drop", "wall"].contains(&role) {
            self.acting.add(extent);
        }
        self.shapes.push(Shape {
            shape: shape.to_owned(),
            role: role.to_owned(),
            at,
            out: None,
            label: words.label,
            short: words.short.to_owned(),
        });
    }

    pub fn rectangle(&mut self, role: &str, [x0, y0, x1, y1]: [f64; 4], words: Words) {
        self.add("box", role, vec![x0, y0, x1, y1], words, &[[x0, y0], [x1, y1]]);
    }

    pub fn disc(&mut self, role: &str, [x, y]: [f64; 2], radius: f64, words: Words) {
        let extent = [[x - radius, y - radius], [x + radius, y + radius]];
        self.add("disc", role, vec![x, y, radius], words, &extent);
    }

    pub fn point(&mut self, role: &str, at: [f64; 2], words: Words) {
        self.add("point", role, at.to_vec(), words, &[at]);
    }

    pub fn arrow(&mut self, role: &str, tip: [f64; 2], direction: [f64; 2], words: Words) {
        self.add("arrow", role, [tip, direction].concat(), words, &[tip]);
    }

    pub fn line(&mut self, role: &str, [from, to]: [[f64; 2]; 2], words: Words) {
        self.add("line", role, [from, to].concat(), words, &[from, to]);
    }

    /// An edge with a support or a condition on its outer side.
    pub fn edge(&mut self, role: &str, ends: [[f64; 2]; 2], out: [f64; 2], words: Words) {
        self.line(role, ends, words);
        if let Some(shape) = self.shapes.last_mut() {
            shape.out = Some(out);
        }
    }

    fn view(self, title: &str, is_side: bool) -> Option<View> {
        if self.whole.is_empty() {
            return None;
        }
        let focus = self.focus(is_side);
        let Ends { low, high } = self.whole;
        // A view has an extent along both axes.
        let least = 1e-3 * self.whole.size().into_iter().fold(1e-12, f64::max);
        let bounds = [low[0] - least, low[1] - least, high[0] + least, high[1] + least];
        Some(View { title: title.to_owned(), bounds, focus, shapes: self.shapes })
    }

    /// The part where something acts, if it is small.
    fn focus(&self, is_side: bool) -> Option<[f64; 4]> {
        if self.acting.is_empty() {
            return None;
        }
        let size = |ends: &Ends| ends.size().into_iter().fold(0.0, f64::max);
        let (whole, acting) = (size(&self.whole), size(&self.acting));
        if acting <= 0.0 || acting > SMALL * whole {
            return None;
        }
        let middle = [0, 1].map(|axis| 0.5 * (self.acting.low[axis] + self.acting.high[axis]));
        let half = 0.5 * MARGIN * acting;
        let reach = [half, if is_side { half.max(self.acting.size()[1]) } else { half }];
        Some([
            middle[0] - reach[0],
            middle[1] - reach[1],
            middle[0] + reach[0],
            middle[1] + reach[1],
        ])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_loads_have_a_detail() {
        let mut drawing = Drawing::default();
        drawing.rectangle("solid", [-1.0, -0.2, 1.0, 0.0], Words::none());
        drawing.disc("drop", [0.0, 0.05], 0.05, Words::none());
        let view = drawing.view("side", true).unwrap();
        let [x0, y0, x1, y1] = view.focus.unwrap();
        assert!(x0 < -0.05 && x1 > 0.05 && y0 < 0.0 && y1 > 0.1 && x1 - x0 < 0.5);
        assert!(view.bounds[3] >= 0.1);
    }

    #[test]
    fn wide_loads_have_no_detail() {
        let mut drawing = Drawing::default();
        drawing.rectangle("solid", [-1.0, -0.2, 1.0, 0.0], Words::none());
        drawing.disc("load", [0.0, 0.0], 0.8, Words::none());
        assert_eq!(drawing.view("side", true).unwrap().focus, None);
    }
}
