//! Common cells of two faces in contact.

use std::f64::consts::PI;

use super::cells::{Domain, WallCells};
use super::lateral_modes::LateralModes;

/// Places of the contact of two faces: the element ends of either face, within the extent of both.
/// On either face, everything is linear between its own places, so that all heat that leaves one
/// face enters the other.
#[derive(Debug, Clone, PartialEq)]
pub struct CommonCells {
    /// Coordinates along x and y, or radii and none [m].
    places: [Vec<f64>; 2],
    /// Area that belongs to each place [m²].
    pub areas: Vec<f64>,
    /// Places of fluxes, which are linear between them: along each axis those of the face with
    /// fewer places. Fluxes that vary faster than one of the faces resolves would be determined by
    /// rounding alone.
    flux_places: [Vec<f64>; 2],
    flux_areas: Vec<f64>,
    /// For each face, then for fluxes, and for each axis: the interpolation of each place.
    between: [[Vec<Between>; 2]; 3],
}

/// Index of the fluxes, after the faces.
const FLUXES: usize = 2;

/// Interpolation between the place `first` and the next, at this fraction of their distance.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Between {
    first: usize,
    part: f64,
}

/// Relative distance below which two places coincide.
const SAME: f64 = 1e-9;

impl CommonCells {
    /// Common cells of two faces; `None` if only one of them is round.
    pub fn of(faces: [&WallCells; 2]) -> Option<Self> {
        let axes = match faces {
            [WallCells::Nodes { x, y }, WallCells::Nodes { x: other_x, y: other_y }] => {
                [[x, other_x], [y, other_y]].map(|pair| pair.map(Vec::as_slice))
            }
            [WallCells::RadialNodes { r }, WallCells::RadialNodes { r: other }] => {
                [[r.as_slice(), other.as_slice()], [&[0.0], &[0.0]]]
            }
            _ => return None,
        };
        let places = axes.map(merged);
        let whole = match faces[0] {
            WallCells::RadialNodes { .. } => WallCells::RadialNodes { r: places[0].clone() },
            _ => WallCells::Nodes { x: places[0].clone(), y: places[1].clone() },
        };
        let flux_places = [0, 1].map(|axis| fewer(axes[axis], &places[axis]));
        let between = [0, 1, FLUXES].map(|face| {
            [0, 1].map(|axis| {
                let own = if face == FLUXES { &flux_places[axis] } else { axes[axis][face] };
                places[axis].iter().map(|&place| Between::of(own, place)).collect()
            })
        });
        let areas = whole.areas(Domain::whole(3));
        let mut cells = Self { areas, places, flux_places, flux_areas: Vec::new(), between };
        cells.flux_areas = cells.gathered(&cells.areas);
        Some(cells)
    }

    /// Modes of heat on the places of fluxes.
    pub fn modes(&self) -> LateralModes {
        let [x, y] = &self.flux_places;
        if y.len() == 1 && *y == [0.0] {
            let ring = |r: f64| 2.0 * PI * r;
            return LateralModes::of([(x, self.flux_areas.clone()), (y, vec![1.0])], ring);
        }
        let lengths = |places: &[f64]| {
            let half = |i: usize| 0.5 * (places[i + 1] - places[i]);
            let last = places.len() - 1;
            let of = |i: usize| {
                (if i > 0 { half(i - 1) } else { 0.0 }) + (if i < last { half(i) } else { 0.0 })
            };
            (0..places.len()).map(of).collect::<Vec<f64>>()
        };
        LateralModes::of([(x, lengths(x)), (y, lengths(y))], |_| 1.0)
    }

    pub fn len(&self) -> usize {
        self.areas.len()
    }

    pub fn is_empty(&self) -> bool {
        self.areas.is_empty()
    }

    /// Number of fluxes.
    pub fn fluxes(&self) -> usize {
        self.flux_areas.len()
    }

    /// Interpolates fluxes from their own places to the common ones.
    pub fn spread(&self, fluxes: &[f64]) -> Vec<f64> {
        self.values(FLUXES, fluxes, self.flux_places[0].len())
    }

    /// Averages values at the common places about the places of fluxes.
    pub fn means(&self, values: &[f64]) -> Vec<f64> {
        let amounts: Vec<f64> = values.iter().zip(&self.areas).map(|(v, area)| v * area).collect();
        let gathered = self.gathered(&amounts);
        gathered.iter().zip(&self.flux_areas).map(|(sum, area)| sum / area).collect()
    }

    fn gathered(&self, amounts: &[f64]) -> Vec<f64> {
        let [x, y] = self.flux_places.each_ref().map(Vec::len);
        self.deposit(FLUXES, amounts, [x, x * y])
    }

    /// Interpolates a face's values from its own places, `width` of them along x, to the common
    /// ones.
    pub fn values(&self, face: usize, own: &[f64], width: usize) -> Vec<f64> {
        let value = |weights: [(usize, f64); 4]| weights.map(|(at, w)| w * own[at]).iter().sum();
        (0..self.len()).map(|place| value(self.weights(face, place, width))).collect()
    }

    /// Distributes amounts at the common places to a face's own places, of which there are `count`.
    pub fn deposit(&self, face: usize, amounts: &[f64], [width, count]: [usize; 2]) -> Vec<f64> {
        let mut own = vec![0.0; count];
        for (place, amount) in amounts.iter().enumerate() {
            for (at, weight) in self.weights(face, place, width) {
                own[at] += weight * amount;
            }
        }
        own
    }

    /// The four own places around a common one, and their weights.
    fn weights(&self, face: usize, place: usize, width: usize) -> [(usize, f64); 4] {
        let columns = self.places[0].len();
        let [x, y] = &self.between[face];
        let (x, y) = (x[place % columns], y[place / columns]);
        let next = |between: Between| between.first + usize::from(between.part > 0.0);
        [
            (x.first + width * y.first, (1.0 - x.part) * (1.0 - y.part)),
            (next(x) + width * y.first, x.part * (1.0 - y.part)),
            (x.first + width * next(y), (1.0 - x.part) * y.part),
            (next(x) + width * next(y), x.part * y.part),
        ]
    }
}

impl Between {
    fn of(own: &[f64], place: f64) -> Self {
        if own.len() < 2 {
            return Self { first: 0, part: 0.0 };
        }
        let above = own.partition_point(|&other| other <= place).clamp(1, own.len() - 1);
        let [low, high] = [own[above - 1], own[above]];
        let part = ((place - low) / (high - low)).clamp(0.0, 1.0);
        match part {
            part if part < SAME => Self { first: above - 1, part: 0.0 },
            part if part > 1.0 - SAME => Self { first: above, part: 0.0 },
            part => Self { first: above - 1, part },
        }
    }
}

/// The places of the shorter list within the common span, with the ends of that span.
fn fewer(lists: [&[f64]; 2], common: &[f64]) -> Vec<f64> {
    let (low, high) = (common[0], common[common.len() - 1]);
    let slack = SAME * (high - low);
    let within = lists.map(|list| {
        let inner =
            list.iter().copied().filter(|place| *place > low + slack && *place < high - slack);
        inner.collect::<Vec<f64>>()
    });
    let [one, other] = within;
    let inner = if one.len() <= other.len() { one } else { other };
    match common {
        [single] => vec![*single],
        _ => std::iter::once(low).chain(inner).chain([high]).collect(),
    }
}

/// The places of both lists within their common span, ascending, without duplicates.
fn merged([a, b]: [&[f64]; 2]) -> Vec<f64> {
    let ends = |list: &[f64]| [list[0], list[list.len() - 1]];
    let ([a0, a1], [b0, b1]) = (ends(a), ends(b));
    let (low, high) = (a0.max(b0), a1.min(b1));
    let slack = SAME * (high - low);
    let mut all: Vec<f64> = a.iter().chain(b).copied().collect();
    all.retain(|place| (low..=high).contains(place));
    all.sort_by(f64::total_cmp);
    all.dedup_by(|next, kept| *next - *kept <= slack);
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    fn faces() -> [[WallCells; 2]; 2] {
        let nodes = |x: &[f64], y: &[f64]| WallCells::Nodes { x: x.to_vec(), y: y.to_vec() };
        let radial = |r: &[f64]| WallCells::RadialNodes { r: r.to_vec() };
        [
            [
                nodes(&[-2.0, -0.5, 0.0, 2.0], &[-1.0, 0.3, 1.0]),
                nodes(&[-1.0, -0.5, 0.7, 1.0], &[-3.0, 0.0, 3.0]),
            ],
            [radial(&[0.0, 0.2, 1.0, 3.0]), radial(&[0.0, 0.5, 1.5])],
        ]
    }

    #[test]
    fn areas_sum_to_the_overlap() {
        let wanted = [2.0 * 2.0, std::f64::consts::PI * 1.5 * 1.5];
        for ([a, b], wanted) in faces().iter().zip(wanted) {
            let common = CommonCells::of([a, b]).unwrap();
            assert!((common.areas.iter().sum::<f64>() - wanted).abs() < 1e-12, "{common:?}");
        }
        let [[a, _], [b, _]] = &faces();
        assert_eq!(CommonCells::of([a, b]), None);
    }

    #[test]
    fn deposits_preserve_amounts_and_values_linear_functions() {
        for pair in faces() {
            let common = CommonCells::of([&pair[0], &pair[1]]).unwrap();
            let amounts: Vec<f64> = (0..common.len()).map(|i| (i as f64).sin()).collect();
            for (face, cells) in pair.iter().enumerate() {
                let (width, places) = match cells {
                    WallCells::Nodes { x, y } => (x.len(), [x.clone(), y.clone()]),
                    WallCells::RadialNodes { r } => (r.len(), [r.clone(), vec![0.0]]),
                    _ => unreachable!(),
                };
                let own = common.deposit(face, &amounts, [width, cells.len()]);
                assert!((own.iter().sum::<f64>() - amounts.iter().sum::<f64>()).abs() < 1e-12);
                // Linear functions are the same on both.
                let linear = |x: f64, y: f64| 1.0 + 2.0 * x - 3.0 * y;
                let at = |n: usize| linear(places[0][n % width], places[1][n / width]);
                let values: Vec<f64> = (0..cells.len()).map(at).collect();
                let columns = common.places[0].len();
                for (n, value) in common.values(face, &values, width).iter().enumerate() {
                    let wanted =
                        linear(common.places[0][n % columns], common.places[1][n / columns]);
                    assert!((value - wanted).abs() < 1e-12, "{face} {n}");
                }
            }
        }
    }
}
