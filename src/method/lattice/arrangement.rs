//! Places of the particles of a strip, and the pairs that links join.

use std::collections::HashMap;

use super::voronoi::{Rectangle, random_points, tessellate};

/// A strip of a sheet, `−length/2 ≤ x ≤ length/2` and `0 ≤ y ≤ depth`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Strip {
    /// [m]
    pub length: f64,
    pub depth: f64,
    /// Wanted distance of neighbours [m].
    pub spacing: f64,
    pub arrangement: Arrangement,
    pub notch: Option<Notch>,
}

/// Arrangement of the particles of a strip.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Arrangement {
    /// Hexagons with links across the strip.
    Across,
    /// Hexagons with links along the strip.
    Along,
    /// Random particles, whose links cross the facets of their Voronoi cells.
    Random {
        /// Number of the sample.
        seed: u32,
    },
}

/// A cut from the lower face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Notch {
    /// Place of its middle, x [m].
    pub at: f64,
    /// [m]
    pub depth: f64,
    pub width: f64,
}

impl Notch {
    /// Side of its middle on which a place x [m] is, −1 on the left and 1 on the right. A particle in the plane of a cut
    /// without width is on the right, and one above a wider notch on neither.
    pub fn side(&self, x: f64) -> f64 {
        match x - self.at {
            0.0 if self.width > 0.0 => 0.0,
            left if left < 0.0 => -1.0,
            _ => 1.0,
        }
    }
}

/// Particles with the pairs of neighbours.
#[derive(Debug, Clone, PartialEq)]
pub struct Particles {
    /// x and y [m].
    pub places: Vec<[f64; 2]>,
    pub pairs: Vec<Pair>,
    /// Distance of neighbours [m].
    pub spacing: f64,
    /// Area of the strip for each particle [m²].
    pub area: f64,
    /// Cell of each particle.
    pub cells: Vec<Cell>,
}

/// Part of a strip that moves with a particle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cell {
    /// [m²]
    pub area: f64,
    /// Polar second moment of area about the particle [m⁴].
    pub moment: f64,
}

/// Two neighbours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    pub ends: [usize; 2],
    /// Width of the facet between them [m].
    pub facet: f64,
}

/// Distance of two columns of hexagons over that of neighbours, `√3/2`.
const COLUMN: f64 = 0.866_025_403_784_438_6;
/// Distance over the spacing below which particles are neighbours: between 1 and √3.
const HORIZON: f64 = 1.3;
/// Square of a hexagon's radius of gyration over that of the spacing.
const GYRATION: f64 = 5.0 / 36.0;
/// Part of the spacing that is rounding.
const ROUNDING: f64 = 1e-6;

impl Arrangement {
    /// Height over the spacing of which a strip's depth is a multiple: a particle with links across, a row along.
    pub fn unit(self) -> f64 {
        match self {
            Self::Across => 1.0,
            Self::Along | Self::Random { .. } => COLUMN,
        }
    }
}

impl Strip {
    /// Number of particles, or of rows, over the depth.
    pub fn layers(&self) -> usize {
        (self.depth / (self.arrangement.unit() * self.spacing)).round().max(1.0) as usize
    }

    /// Distance of neighbours [m]: the wanted one, changed so that a whole number of particles fills the depth.
    pub fn fitted_spacing(&self) -> f64 {
        self.depth / (self.arrangement.unit() * self.layers() as f64)
    }

    /// Number of particles, a notch not counted.
    pub fn count(&self) -> usize {
        let columns = self.columns().count();
        match self.arrangement {
            Arrangement::Across => columns * self.layers(),
            Arrangement::Along => columns * self.layers() / 2,
            Arrangement::Random { .. } => {
                let cell = COLUMN * self.fitted_spacing().powi(2);
                (self.length * self.depth / cell).round() as usize
            }
        }
    }

    /// Distance of columns parallel to z [m].
    fn column(&self) -> f64 {
        self.fitted_spacing()
            * match self.arrangement {
                Arrangement::Across => COLUMN,
                Arrangement::Along | Arrangement::Random { .. } => 0.5,
            }
    }

    /// True if the strip is cut between two columns.
    fn has_saw_cut(&self) -> bool {
        self.notch.is_some_and(|notch| notch.width <= 0.0)
    }

    /// Numbers of the columns with their places x [m], symmetric about x = 0: one is there, unless a cut without
    /// width is.
    fn columns(&self) -> impl Iterator<Item = (i64, f64)> {
        let column = self.column();
        let shift = if self.has_saw_cut() { 0.5 } else { 0.0 };
        let most = (0.5 * self.length / column - 0.5 + shift + ROUNDING).floor().max(1.0) as i64;
        let last = if self.has_saw_cut() { most - 1 } else { most };
        (-most..=last).map(move |j| (j, (j as f64 + shift) * column))
    }

    /// Places the particles, the outer rows half a row inside the faces, and joins neighbours except across the notch.
    pub fn fill(&self) -> Particles {
        let spacing = self.fitted_spacing();
        let (places, pairs, cells) = match self.arrangement {
            Arrangement::Random { seed } => {
                let half = 0.5 * self.length;
                let whole = Rectangle { low: [-half, 0.0], high: [half, self.depth] };
                let places = random_points(whole, spacing, seed);
                let (pairs, cells) = tessellate(&places, whole, spacing);
                (places, pairs, cells)
            }
            _ => {
                let places = self.hexagons(spacing);
                let facet = spacing / 3.0_f64.sqrt();
                let pairs = neighbours(&places, HORIZON * spacing);
                let pairs = pairs.into_iter().map(|ends| Pair { ends, facet }).collect();
                let cells = self.cells_of_hexagons(&places, spacing);
                (places, pairs, cells)
            }
        };
        let area = self.length * self.depth / places.len() as f64;
        let area = match self.arrangement {
            Arrangement::Random { .. } => area,
            _ => COLUMN * spacing * spacing,
        };
        self.cut(Particles { places, pairs, spacing, area, cells })
    }

    /// Takes the particles of the notch out, and of the links across it the part of their facet that is in it:
    /// stiffness and strength follow its depth continuously.
    fn cut(&self, whole: Particles) -> Particles {
        let mut number = Vec::with_capacity(whole.places.len());
        let (mut places, mut cells) = (Vec::new(), Vec::new());
        for (&place, &cell) in whole.places.iter().zip(&whole.cells) {
            let stays = !self.is_in_notch(place);
            number.push(stays.then_some(places.len()));
            places.extend(stays.then_some(place));
            cells.extend(stays.then_some(cell));
        }
        let stays = |pair: &Pair| {
            let [Some(a), Some(b)] = pair.ends.map(|i| number[i]) else { return None };
            let left = 1.0 - self.part_in_notch(pair.facet, [places[a], places[b]]);
            (left > ROUNDING).then_some(Pair { ends: [a, b], facet: left * pair.facet })
        };
        let pairs = whole.pairs.iter().filter_map(stays).collect();
        Particles { places, pairs, cells, ..whole }
    }

    /// Hexagons, column by column, symmetric about x = 0. With links along, one is across x = 0 in the first row
    /// above the notch.
    fn hexagons(&self, spacing: f64) -> Vec<[f64; 2]> {
        let layers = self.layers();
        let cut = self.notch.map_or(0.0, |notch| notch.depth / (COLUMN * spacing));
        let parity = cut.round() as i64 + 1;
        let heights = |j: i64| -> Vec<f64> {
            match self.arrangement {
                Arrangement::Across => {
                    let first = if j.rem_euclid(2) == 0 { 0.25 } else { 0.75 };
                    (0..layers).map(|k| (first + k as f64) * spacing).collect()
                }
                Arrangement::Along | Arrangement::Random { .. } => {
                    let rows = ((j + parity).rem_euclid(2) as usize..layers).step_by(2);
                    rows.map(|k| (0.5 + k as f64) * COLUMN * spacing).collect()
                }
            }
        };
        let of_column = |(j, x): (i64, f64)| heights(j).into_iter().map(move |y| [x, y]);
        self.columns().flat_map(of_column).collect()
    }

    /// Cells of hexagons. Those of the outermost columns extend to the ends of the strip.
    fn cells_of_hexagons(&self, places: &[[f64; 2]], spacing: f64) -> Vec<Cell> {
        let area = COLUMN * spacing * spacing;
        let cell = Cell { area, moment: GYRATION * spacing * spacing * area };
        let beyond = 0.5 * (self.length * self.depth - places.len() as f64 * area).max(0.0);
        let outermost = outermost(places) - ROUNDING * spacing;
        let in_column = places.iter().filter(|[x, _]| *x > outermost).count().max(1) as f64;
        // The part beyond each is a rectangle.
        let (more, height) = (beyond / in_column, self.depth / in_column);
        let width = more / height;
        let lever = 0.5 * (self.column() + width);
        let moment = more * (lever * lever + (width * width + height * height) / 12.0);
        let stretched = Cell { area: area + more, moment: cell.moment + moment };
        places.iter().map(|[x, _]| if x.abs() > outermost { stretched } else { cell }).collect()
    }

    /// Part of the stiffness of links that those of hexagons to the platens at the ends have, at a Poisson's ratio: they
    /// stand for the strip up to its ends. A platen holds one column of links across, and two of links along, of which
    /// diagonals and links of both rows bear the load in the proportion of their stiffness.
    pub fn part_to_platens(&self, places: &[[f64; 2]], poisson: f64) -> f64 {
        let beyond = (0.5 * self.length - outermost(places)).max(0.0) / self.column();
        // Stiffness across over that along a link.
        let across = (1.0 - 3.0 * poisson) / (1.0 + poisson);
        match self.arrangement {
            Arrangement::Across => 1.0 / (1.0 + beyond),
            Arrangement::Along => {
                let per_column = 1.25 + 0.75 * across;
                (2.25 + 0.75 * across) / (0.5 + per_column * (2.0 + beyond))
            }
            Arrangement::Random { .. } => 1.0,
        }
    }

    fn is_in_notch(&self, [x, y]: [f64; 2]) -> bool {
        self.notch.filter(|notch| notch.width > 0.0).is_some_and(|notch| {
            y < notch.depth && (x - notch.at).abs() <= 0.5 * notch.width + ROUNDING * self.spacing
        })
    }

    /// Part of the facet of a link that is in the notch: the facet stands across the middle of the link.
    fn part_in_notch(&self, facet: f64, [a, b]: [[f64; 2]; 2]) -> f64 {
        let Some(notch) = self.notch else { return 0.0 };
        if notch.side(a[0]) * notch.side(b[0]) >= 0.0 {
            return 0.0;
        }
        let height = facet * (b[0] - a[0]).abs() / distance(a, b);
        let lower = 0.5 * (a[1] + b[1] - height);
        ((notch.depth - lower) / height).clamp(0.0, 1.0)
    }
}

/// Distance of the outermost places from x = 0 [m].
fn outermost(places: &[[f64; 2]]) -> f64 {
    places.iter().fold(0.0, |most, [x, _]| most.max(x.abs()))
}

/// Pairs of places nearer than a distance [m], the lower number first, ascending.
fn neighbours(places: &[[f64; 2]], horizon: f64) -> Vec<[usize; 2]> {
    let cell = |place: &[f64; 2]| place.map(|x| (x / horizon).floor() as i64);
    let mut cells: HashMap<[i64; 2], Vec<usize>> = HashMap::new();
    for (i, place) in places.iter().enumerate() {
        cells.entry(cell(place)).or_default().push(i);
    }
    let mut pairs = Vec::new();
    for (i, place) in places.iter().enumerate() {
        let [x, y] = cell(place);
        let around = (x - 1..=x + 1).flat_map(|x| (y - 1..=y + 1).map(move |y| [x, y]));
        let others = around.filter_map(|at| cells.get(&at)).flatten();
        let near = others.filter(|&&j| j > i && distance(*place, places[j]) < horizon);
        let mut near: Vec<usize> = near.copied().collect();
        near.sort_unstable();
        pairs.extend(near.into_iter().map(|j| [i, j]));
    }
    pairs
}

/// Distance of two places [m].
pub fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (b[0] - a[0]).hypot(b[1] - a[1])
}
