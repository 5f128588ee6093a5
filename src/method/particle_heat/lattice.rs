//! Particles at the crossings of three axes, and their mirror images beyond the ends.

/// Temperature of the images beyond an end of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// The temperature of the mirrored particle: the end is insulated.
    Mirror,
    /// Twice the temperature of the end less that of the mirrored particle: the end is held.
    Held,
}

/// Positions of the particles along one axis. A single position is a direction outside the model.
#[derive(Debug, Clone, PartialEq)]
pub struct LatticeAxis {
    /// Positions, ascending [m]; the radius, from 0 on, if `radial`.
    pub nodes: Vec<f64>,
    /// Share of each node in the measure of the axis: [m], or [m²] if `radial`.
    pub measures: Vec<f64>,
    pub ends: [End; 2],
    pub radial: bool,
}

/// A particle or an image near another particle, along one axis.
#[derive(Debug, Clone, PartialEq)]
pub struct AxisNeighbour {
    /// Distance along the axis, and the associated length, in units of the other's scale.
    pub offset: f64,
    pub width: f64,
    /// Its temperature as a sum over particles, `(index, factor)`.
    pub terms: Vec<(usize, f64)>,
    /// True for the low and the high end if it is held and contributes to the temperature.
    pub held: [bool; 2],
    /// Distance beyond the low and the high end [m]; 0 within.
    pub beyond: [f64; 2],
}

impl LatticeAxis {
    pub fn is_modelled(&self) -> bool {
        self.nodes.len() > 1
    }

    /// Unit of length around a node: half the distance of its neighbours [m].
    pub fn scale(&self, i: usize) -> f64 {
        self.width(i as isize)
    }

    /// All neighbours within `reach` units of the scale of a node, itself included.
    pub fn neighbours(&self, i: usize, reach: f64) -> Vec<AxisNeighbour> {
        if !self.is_modelled() {
            let own = AxisNeighbour {
                offset: 0.0,
                width: 1.0,
                terms: vec![(0, 1.0)],
                held: [false; 2],
                beyond: [0.0; 2],
            };
            return vec![own];
        }
        let (here, scale) = (self.nodes[i], self.scale(i));
        let near = |p: &isize| ((self.place(*p) - here) / scale).abs() < reach;
        let below = (1..).map(|steps| i as isize - steps).take_while(near);
        let above = (0..).map(|steps| i as isize + steps).take_while(near);
        below.chain(above).map(|p| self.neighbour(p, here, scale)).collect()
    }

    fn neighbour(&self, p: isize, here: f64, scale: f64) -> AxisNeighbour {
        let place = self.place(p);
        let (mut terms, mut held) = (Vec::new(), [false; 2]);
        self.unfold(p, 1.0, &mut terms, &mut held);
        let [low, high] = [self.nodes[0], self.nodes[self.nodes.len() - 1]];
        AxisNeighbour {
            offset: (place - here) / scale,
            width: self.width(p) / scale,
            terms,
            held,
            beyond: [(low - place).max(0.0), (place - high).max(0.0)],
        }
    }

    /// Coordinate of the p-th place, mirrored at the ends as often as necessary.
    fn place(&self, p: isize) -> f64 {
        let last = self.nodes.len() as isize - 1;
        match p {
            p if p < 0 => 2.0 * self.nodes[0] - self.place(-p),
            p if p > last => 2.0 * self.nodes[last as usize] - self.place(2 * last - p),
            p => self.nodes[p as usize],
        }
    }

    fn width(&self, p: isize) -> f64 {
        0.5 * (self.place(p + 1) - self.place(p - 1))
    }

    /// Adds the terms of the temperature at the p-th place, and records the held ends among them.
    fn unfold(&self, p: isize, factor: f64, terms: &mut Vec<(usize, f64)>, held: &mut [bool; 2]) {
        let last = self.nodes.len() as isize - 1;
        let (end, mirrored) = match p {
            p if p < 0 => (0, -p),
            p if p > last => (1, 2 * last - p),
            p => {
                terms.push((p as usize, factor));
                held[0] |= p == 0 && self.ends[0] == End::Held;
                held[1] |= p == last && self.ends[1] == End::Held;
                return;
            }
        };
        match self.ends[end] {
            End::Mirror => self.unfold(mirrored, factor, terms, held),
            End::Held => {
                let node = if end == 0 { 0 } else { last as usize };
                terms.push((node, 2.0 * factor));
                self.unfold(mirrored, -factor, terms, held);
                held[end] = true;
            }
        }
    }

    /// Distance of a node from the low or the high end [m].
    pub fn distance(&self, i: usize, end: usize) -> f64 {
        let last = self.nodes[self.nodes.len() - 1];
        if end == 0 { self.nodes[i] - self.nodes[0] } else { last - self.nodes[i] }
    }

    /// Returns true if a node is a held end.
    pub fn holds(&self, i: usize) -> bool {
        i == 0 && self.ends[0] == End::Held
            || i + 1 == self.nodes.len() && self.ends[1] == End::Held
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(ends: [End; 2]) -> LatticeAxis {
        let nodes = vec![0.0, 1.0, 3.0];
        LatticeAxis { nodes, measures: vec![0.5, 1.5, 1.0], ends, radial: false }
    }

    fn value(neighbour: &AxisNeighbour, f: impl Fn(f64) -> f64) -> f64 {
        let nodes = [0.0, 1.0, 3.0];
        neighbour.terms.iter().map(|&(node, factor)| factor * f(nodes[node])).sum()
    }

    #[test]
    fn images_extend_even_and_odd_functions() {
        let axis = axis([End::Mirror, End::Held]);
        let scale = axis.scale(1);
        assert_eq!(scale, 1.5);
        let neighbours = axis.neighbours(1, 5.0);
        let places: Vec<f64> = neighbours.iter().map(|s| 1.0 + s.offset * scale).collect();
        assert_eq!(
            places,
            [0.0, -1.0, -3.0, -5.0, -6.0, 1.0, 3.0, 5.0, 6.0, 7.0]
                .into_iter()
                .filter(|x: &f64| ((x - 1.0) / scale).abs() < 5.0)
                .collect::<Vec<_>>()
        );
        for (neighbour, place) in neighbours.iter().zip(&places) {
            // Even about 0 and odd about its value at 3: the triangle wave of period 12.
            let wave = |x: f64| 3.0 - ((x + 6.0).rem_euclid(12.0) - 6.0f64).abs();
            assert!((value(neighbour, wave) - wave(*place)).abs() < 1e-14, "{place}");
            let beyond = [(-place).max(0.0), (place - 3.0).max(0.0)];
            assert_eq!(neighbour.beyond, beyond);
            assert_eq!(neighbour.held, [false, *place >= 3.0 || *place <= -3.0]);
        }
    }

    #[test]
    fn end_widths_match_complete_neighbourhoods() {
        let axis = axis([End::Mirror; 2]);
        assert_eq!([0, 1, 2].map(|i| axis.scale(i)), [1.0, 1.5, 2.0]);
    }
}
