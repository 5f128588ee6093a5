//! Equidistant points of the wall, through which fluid and wall exchange heat and momentum.
//!
//! Every point represents the square about it. So each part of the wall has its true area,
//! regardless of the particles above it and of the size of the cells that receive the squares'
//! heat.

use std::collections::HashMap;
use std::f64::consts::TAU;

use super::images::{copies, sides};
use super::plan::{DropletPlan, Extent};
use super::resistive_law::Resistance;
use super::wall_heat::Touching;
use crate::port::Cover;
use crate::port::{CellHeat, Surface};
use crate::port::{Domain, WallCells, WallExchange};

/// Number of points along an edge of a page; a page is allocated when fluid first reaches it.
const PAGE: i32 = 16;

/// Points along an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Row {
    /// Distance of points [m]; `None` along the axis that a plane model lacks.
    pitch: Option<f64>,
    /// True if a mirror stands at 0.
    mirrored: bool,
    /// Number of points to the far end, and whether that end is periodic (true) or a mirror.
    end: Option<(i32, bool)>,
}

/// Arrangement of points on the wall of a plan.
#[derive(Debug, Clone, PartialEq)]
pub struct PointLattice {
    rows: [Row; 2],
    mirrors: [bool; 2],
    /// True if points are rings about the origin, in a row along the radius.
    rings: bool,
    /// Area that a point represents [m²]: of metres of depth in a plane model, of a ring the square
    /// of its width.
    pub area: f64,
}

/// Interpolation of a particle to points: up to nine of them, their weights and the signs that
/// reflect a vector there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stencil {
    points: [(u32, f64); 9],
    signs: [[f64; 2]; 9],
    count: usize,
}

/// A point and what it received during a step of the model, images at mirrors excluded.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Point {
    /// Indices of the point, counted from the origin.
    place: [i32; 2],
    /// True if the following fields are set.
    pub active: bool,
    /// Its area over that of the lattice.
    pub extent: f64,
    /// Columns below its square and the fractions that they cover.
    pub below: Vec<(u32, f64)>,
    /// The fraction beyond the outermost cells of a wall that continues there, and the column whose
    /// temperature it has.
    pub beyond: Option<(u32, f64)>,
    /// Sums over the fluid at the wall of mass, and of mass times heat content, now and at the
    /// release, each over their units.
    pub mass: f64,
    pub content_sum: f64,
    pub initial_sum: f64,
    /// Heat content of fluid at the mean temperature of the wall [K], and the fraction of its
    /// difference from the fluid that the fluid loses.
    pub wall: f64,
    pub relaxation: f64,
    /// Heat content that all fluid at the point loses alike [K].
    pub even_loss: f64,
    /// True if the contact of the fluid begins anew.
    pub begins_anew: bool,
    /// Impulse [N s].
    pub impulse: [f64; 3],
}

/// A solid column below a cell of the wall, for the heat of one step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Column {
    cell: usize,
    /// Area of the cell, images at mirrors excluded [m²].
    pub area: f64,
    /// Temperature [K] without the amplitudes, and its additions in the course of the step.
    pub base: f64,
    pub drift: f64,
    /// Temperature at the end if the fluid transferred no heat [K].
    free: f64,
    /// Heat received so far [J].
    pub heat: f64,
}

/// All points that fluid has reached, and the columns below them, in the course of a step of the
/// model.
pub struct WallPoints<'a> {
    lattice: &'a PointLattice,
    cells: &'a WallCells,
    pub surface: &'a Surface,
    pages: HashMap<[i32; 2], usize>,
    last: ([i32; 2], usize),
    pub points: Vec<Point>,
    pub columns: Vec<Column>,
    /// Amplitudes of [`Surface`] for each column at the current time.
    pub amplitudes: Vec<f64>,
    /// Column of each cell, and the cell's area.
    column_of: Vec<Option<u32>>,
    areas: Vec<f64>,
    /// Heat transferred to the wall beyond the outermost cells [J].
    pub heat_beyond: f64,
    /// Time since the beginning of the step, and its length [s].
    pub time: f64,
    pub duration: f64,
    /// Thermal resistance of the contact; `None` for perfect contact.
    pub resistance: Option<Resistance>,
    /// Fluid at rest outside the cloud of a step, with its heat content now.
    pub resting: Vec<Touching>,
}

impl PointLattice {
    pub fn of(plan: &DropletPlan) -> Self {
        let rows = [0, 1].map(|axis| {
            let flat = axis == 1 && plan.axes() == 2;
            let fitted = |length: f64| {
                let count = (length / plan.spacing).round().max(1.0);
                (length / count, count as i32)
            };
            let (pitch, mirrored, end) = match plan.extents[axis] {
                Extent::Open => (plan.spacing, plan.even()[axis], None),
                Extent::Periodic(length) => {
                    let (pitch, count) = fitted(length);
                    (pitch, false, Some((count, true)))
                }
                Extent::Closed(length) => {
                    let (pitch, count) = fitted(length);
                    (pitch, true, Some((count, false)))
                }
            };
            Row { pitch: (!flat).then_some(pitch), mirrored, end }
        });
        let rings = plan.axisymmetric;
        let sides = rows.iter().filter_map(|row| row.pitch);
        let area = sides.map(|side| if rings { side * side } else { side }).product();
        Self { rows, mirrors: plan.mirrors, rings, area }
    }

    /// Region of the model's points along x and y [m]; a plane model is a metre deep.
    fn domain(&self) -> Domain {
        let along = self.rows.map(|row| {
            let pitch = row.pitch?;
            let begins = row.mirrored || row.end.is_some();
            let first = if begins { 0.0 } else { f64::NEG_INFINITY };
            Some([first, row.end.map_or(f64::INFINITY, |(count, _)| pitch * f64::from(count))])
        });
        Domain { along, images: copies(self.mirrors) }
    }

    /// Area of a point over that of the lattice.
    fn extent(&self, [i, _]: [i32; 2]) -> f64 {
        if self.rings { TAU * (f64::from(i) + 0.5) } else { 1.0 }
    }

    /// Cells covered by the part of the wall that a point represents.
    fn cover(&self, cells: &WallCells, place: [i32; 2]) -> Cover {
        let square = self.square(place);
        if self.rings { cells.cover_ring(square[0]) } else { cells.cover(square) }
    }

    /// Square that a point represents [m]; a line in a plane model, and for a ring.
    fn square(&self, place: [i32; 2]) -> [[f64; 2]; 2] {
        [0, 1].map(|axis| match self.rows[axis].pitch {
            Some(pitch) => [place[axis], place[axis] + 1].map(|n| pitch * f64::from(n)),
            None => [0.0; 2],
        })
    }
}

impl Row {
    /// Three points about a position [m], their quadratic B-spline weights, and −1 where the point
    /// is a mirror image.
    fn about(&self, at: f64) -> ([(i32, f64, f64); 3], usize) {
        let Some(pitch) = self.pitch else { return ([(0, 1.0, 1.0); 3], 1) };
        let place = at / pitch;
        let middle = place.floor();
        let off = place - middle - 0.5;
        let weights = [0.5 * (0.5 - off).powi(2), 0.75 - off * off, 0.5 * (0.5 + off).powi(2)];
        let point = |n: usize| {
            let (index, sign) = self.within(middle as i32 + n as i32 - 1);
            (index, weights[n], sign)
        };
        ([point(0), point(1), point(2)], 3)
    }

    /// Index of a point within the model, and −1 if it is its mirror image.
    fn within(&self, index: i32) -> (i32, f64) {
        match self.end {
            Some((count, true)) => (index.rem_euclid(count), 1.0),
            Some((count, false)) if index >= count => (2 * count - 1 - index, -1.0),
            _ if self.mirrored && index < 0 => (-1 - index, -1.0),
            _ => (index, 1.0),
        }
    }
}

impl Stencil {
    pub fn weights(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.points[..self.count].iter().map(|&(point, weight)| (point as usize, weight))
    }
}

impl<'a> WallPoints<'a> {
    pub fn new(
        lattice: &'a PointLattice,
        cells: &'a WallCells,
        surface: &'a Surface,
        duration: f64,
    ) -> Self {
        Self {
            lattice,
            cells,
            surface,
            pages: HashMap::new(),
            last: ([i32::MIN; 2], 0),
            points: Vec::new(),
            columns: Vec::new(),
            amplitudes: Vec::new(),
            column_of: vec![None; cells.len()],
            areas: cells.areas(lattice.domain()),
            heat_beyond: 0.0,
            time: 0.0,
            duration,
            resistance: None,
            resting: Vec::new(),
        }
    }

    /// Interpolation to the points about a position [m].
    pub fn stencil(&mut self, [x, y]: [f64; 2]) -> Stencil {
        let x = if self.lattice.rings { spread_radius(x, self.lattice.area) } else { x };
        let (columns, nx) = self.lattice.rows[0].about(x);
        let (rows, ny) = self.lattice.rows[1].about(y);
        let mut stencil = Stencil { points: [(0, 0.0); 9], signs: [[1.0; 2]; 9], count: nx * ny };
        for (n, &(j, b, sign_y)) in rows[..ny].iter().enumerate() {
            for (m, &(i, a, sign_x)) in columns[..nx].iter().enumerate() {
                stencil.points[n * nx + m] = (self.index([i, j]) as u32, a * b);
                stencil.signs[n * nx + m] = [sign_x, sign_y];
            }
        }
        stencil
    }

    /// Index of a point; allocates its page if needed.
    fn index(&mut self, place: [i32; 2]) -> usize {
        let page = place.map(|n| n.div_euclid(PAGE));
        if self.last.0 != page {
            let known = self.pages.get(&page).copied();
            self.last = (page, known.unwrap_or_else(|| self.open(page)));
        }
        let [i, j] = place.map(|n| n.rem_euclid(PAGE) as usize);
        self.last.1 + i + PAGE as usize * j
    }

    fn open(&mut self, page: [i32; 2]) -> usize {
        let first = self.points.len();
        let [x, y] = page.map(|n| n * PAGE);
        let places = (0..PAGE).flat_map(|j| (0..PAGE).map(move |i| [x + i, y + j]));
        let lattice = self.lattice;
        let point = |place| Point { place, extent: lattice.extent(place), ..Point::default() };
        self.points.extend(places.map(point));
        self.pages.insert(page, first);
        first
    }

    /// Adds an impulse [N s] to the points about a position [m].
    pub fn push(&mut self, at: [f64; 2], [x, y, z]: [f64; 3]) {
        let stencil = self.stencil(at);
        for (n, (point, weight)) in stencil.weights().enumerate() {
            let [along_x, along_y] = stencil.signs[n];
            let impulse = [along_x * x, along_y * y, z];
            let sum = &mut self.points[point].impulse;
            (0..3).for_each(|a| sum[a] += weight * impulse[a]);
        }
    }

    /// Connects a point to the columns below it.
    pub fn activate(&mut self, point: usize) {
        let cover = self.lattice.cover(self.cells, self.points[point].place);
        let below = cover.cells.iter().map(|&(cell, part)| (self.column(cell), part));
        let below: Vec<(u32, f64)> = below.collect();
        // A body ends here: nothing has the temperature of its edge.
        let goes_on = cover.outside > 0.0 && !self.cells.end_with_the_body();
        let beyond = goes_on.then(|| (self.column(cover.nearest), cover.outside));
        let point = &mut self.points[point];
        (point.active, point.below, point.beyond) = (true, below, beyond);
    }

    /// Column of a cell, with its current temperatures in the absence of heat from the fluid.
    fn column(&mut self, cell: usize) -> u32 {
        if let Some(column) = self.column_of[cell] {
            return column;
        }
        let (surface, count) = (self.surface, self.surface.response.len());
        let (base, drift) = (surface.base[cell], surface.drift[cell]);
        let mut free = base + drift;
        for (m, rate) in surface.response.rates.iter().enumerate() {
            let amplitude = surface.amplitudes[cell * count + m];
            self.amplitudes.push(amplitude * (-rate * self.time).exp());
            free += amplitude * (-rate * self.duration).exp();
        }
        let column = self.columns.len() as u32;
        self.columns.push(Column { cell, area: self.areas[cell], base, drift, free, heat: 0.0 });
        self.column_of[cell] = Some(column);
        column
    }

    /// Heat [J] and impulse [N s] that all points received, images at mirrors included.
    pub fn totals(&self) -> (f64, [f64; 3]) {
        let images = copies(self.lattice.mirrors);
        let heat = self.columns.iter().map(|column| column.heat).sum::<f64>() + self.heat_beyond;
        let impulse =
            [0, 1, 2].map(|n| match n < 2 && (self.lattice.mirrors[n] || self.lattice.rings) {
                // The images' contributions along a mirrored axis cancel, and so do a ring's along
                // its radius.
                true => 0.0,
                false => images * self.points.iter().map(|point| point.impulse[n]).sum::<f64>(),
            });
        (images * heat, impulse)
    }

    /// Exchange of all cells, images at mirrors included, and the rises of their surface due to it
    /// [K m²].
    pub fn settle(&self) -> (WallExchange, Vec<f64>) {
        let mut exchange = WallExchange::none(self.cells.len());
        exchange.duration = self.duration;
        exchange.heat_outside = copies(self.lattice.mirrors) * self.heat_beyond;
        let rises = self.settle_heat(&mut exchange);
        // All images are equally far out, and push alike along their radius.
        let radial = self.cells.are_radial();
        let images = if radial { copies(self.lattice.mirrors) } else { 1.0 };
        for point in self.points.iter().filter(|point| point.impulse != [0.0; 3]) {
            for signs in self.images() {
                let impulse = point.impulse.map(|p| images * p);
                let given = Contribution { place: point.place, impulse }.turned(signs);
                self.deposit(&given, &mut exchange);
            }
        }
        (exchange, rises)
    }

    /// Heat received so far by the cells that have a column.
    pub fn cell_heat(&self) -> impl Iterator<Item = CellHeat<'_>> {
        let count = self.surface.response.len();
        self.columns.iter().enumerate().map(move |(n, column)| CellHeat {
            cell: column.cell,
            heat: column.heat / column.area,
            amplitudes: &self.amplitudes[n * count..][..count],
        })
    }

    /// Signs of x and y of the images' individual contributions.
    fn images(&self) -> impl Iterator<Item = [f64; 2]> + use<> {
        sides(self.lattice.mirrors.map(|mirrored| mirrored && !self.cells.are_radial()))
    }

    fn settle_heat(&self, exchange: &mut WallExchange) -> Vec<f64> {
        let mut rises = vec![0.0; self.cells.len()];
        let count = self.surface.response.len();
        let together = if self.cells.are_radial() { copies(self.lattice.mirrors) } else { 1.0 };
        for (n, column) in self.columns.iter().enumerate() {
            let amplitudes = &self.amplitudes[n * count..][..count];
            let end = column.base + column.drift + amplitudes.iter().sum::<f64>();
            let (heat, rise) =
                (together * column.heat, together * column.area * (end - column.free));
            for signs in self.images() {
                for (cell, part) in self.cells.image(column.cell, signs) {
                    exchange.heat[cell] += part * heat;
                    rises[cell] += part * rise;
                }
            }
        }
        rises
    }

    fn deposit(&self, given: &Contribution, exchange: &mut WallExchange) {
        let square = self.lattice.square(given.place);
        let cover = self.lattice.cover(self.cells, given.place);
        let radial = self.cells.are_radial();
        let middle = square.map(|[low, high]| 0.5 * (low + high));
        let impulse = if radial { radially(middle, given.impulse) } else { given.impulse };
        for &(cell, weight) in &cover.cells {
            (0..3).for_each(|n| exchange.impulse[cell][n] += weight * impulse[n]);
        }
        let round = self.lattice.rings;
        let cancels = |n: usize| n < 2 && radial && (round || self.lattice.mirrors[n]);
        for n in (0..3).filter(|&n| !cancels(n)) {
            exchange.impulse_outside[n] += cover.outside * given.impulse[n];
        }
    }
}

/// Square of the length, over the width of rings, by which [`spread_radius`] moves a contribution
/// at the origin.
const OFF_AXIS: f64 = 0.1742;

/// Radius at which a contribution from a radius is assigned to rings of a squared width [m²].
///
/// The B-spline spreads along a line across the axis. With it an even film would assign to the ring
/// at the axis a quarter more than its share, and correspondingly less to those at its edge. In the
/// plane, isotropic spreading moves the mean outward. At `√(r² + 0.1742 Δ²)` the first ring
/// receives its share, and every other to 0.3 %.
fn spread_radius(radius: f64, area: f64) -> f64 {
    (radius * radius + OFF_AXIS * area).sqrt()
}

/// Contribution of a point or of an image of it.
struct Contribution {
    place: [i32; 2],
    impulse: [f64; 3],
}

impl Contribution {
    /// The contribution reflected by mirrors.
    fn turned(self, signs: [f64; 2]) -> Self {
        let along = |n: usize| if signs[n] < 0.0 { -1 - self.place[n] } else { self.place[n] };
        let [x, y, z] = self.impulse;
        Self { place: [along(0), along(1)], impulse: [signs[0] * x, signs[1] * y, z] }
    }
}

/// The impulse at a position: along its radius from the origin, 0, and along z.
fn radially([x, y]: [f64; 2], [u, v, w]: [f64; 3]) -> [f64; 3] {
    let radius = x.hypot(y);
    if radius > 0.0 { [(x * u + y * v) / radius, 0.0, w] } else { [0.0, 0.0, w] }
}
