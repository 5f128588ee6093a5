//! Readings of a solid by influence rows instead of one solution per state.
//!
//! A row takes as long to solve for as one state. Probes and fields are therefore read by rows if two conditions hold.
//! The scene's default experiment must have four times as many communication points as rows, including those of earlier
//! probes and fields in the scene; and the memory must suffice. Reading such points alone then needs no solution for
//! any state. Reading everything, extremes of the body included, takes a quarter more solutions than without rows. The
//! choice follows from the scene alone, so results are bitwise independent of the order of reading. Rows are solved for
//! when first read: those of even classes at once, those of others when something first drives them.

use std::collections::{HashMap, HashSet};

use super::SolidBody;
use super::crack::Crack;
use super::memo::SolidMemo;
use super::point::PointQuantity;
use crate::body::BodyError;
use crate::coupling::FaceMeans;
use crate::math::cholesky::SolverError;
use crate::method::fem::{
    ClassRow, Component, Functional, Geometry, Plan, SolidFem, Term, memory_of_row,
    most_memory_of_rows,
};
use crate::runtime::made_once::MadeOnce;
use crate::scene::{Gives, Sampling, Scene, Solid};

/// Readings by rows.
#[derive(Default)]
pub struct Choice {
    points: Vec<([f64; 3], Kinds)>,
    /// Place of a field of cells among the scene's, and number of the cell.
    cells: Vec<(usize, usize, Kinds)>,
    /// Places of flaws among the scene's.
    flaws: Vec<usize>,
    /// Rows of each symmetry class.
    pub rows: usize,
}

/// Flags: stresses are read, displacements are read.
type Kinds = [bool; 2];

/// Number of communication points for which a row pays off.
const READINGS_OF_A_ROW: f64 = 4.0;

/// Largest number of symmetry classes.
const CLASSES: usize = 4;
/// Parts of a reading by classes.
pub type ByClass = [f64; CLASSES];

/// A component along x, y, z as a sum of rows, each with its weights by classes.
type Parts = Vec<(usize, ByClass)>;
/// Stresses xx, yy, zz, xy, yz, xz and displacements along x, y, z; `None` where a solution is needed.
type PartsOfAll = [Option<Parts>; 9];

/// The rows of a body.
#[derive(Default)]
pub struct Rows {
    rows: Vec<LazyRow>,
    of_points: HashMap<[u64; 3], PartsOfAll>,
    /// By places of fields among the scene's, and numbers of cells.
    of_cells: HashMap<(usize, usize), PartsOfAll>,
    /// By places of flaws among the scene's.
    of_flaws: HashMap<usize, Parts>,
}

/// The rows of one reading, one for each symmetry class.
struct LazyRow {
    functional: Functional,
    classes: [MadeOnce<ClassRow>; CLASSES],
}

/// All components along x, y, z in the order of [`PartsOfAll`].
fn components() -> [Component; 9] {
    std::array::from_fn(|n| match n {
        0..6 => Component::Stress(n),
        _ => Component::Displacement(n - 6),
    })
}

fn is_of(component: Component, [stress, displacement]: Kinds) -> bool {
    match component {
        Component::Stress(_) => stress,
        Component::Displacement(_) => displacement,
    }
}

fn bits(point: [f64; 3]) -> [u64; 3] {
    point.map(f64::to_bits)
}

/// Kinds of components that a list of outputs needs at points. Over cells, the mean of a measure does not follow from
/// the means of components.
fn kinds(gives: &[Gives], of_cells: bool) -> Kinds {
    let of_stress = |gives: &Gives| match gives {
        Gives::Stress => true,
        Gives::VonMises | Gives::MaxPrincipal => !of_cells,
        _ => false,
    };
    [gives.iter().any(of_stress), gives.contains(&Gives::Displacement)]
}

impl Choice {
    /// Chooses the readings of a scene's solid that use rows.
    pub fn of(scene: &Scene, (name, solid): (&str, &Solid), plan: &Plan) -> Self {
        let mut choice = Self::default();
        // Running maxima of stress and flaws that grow need a solution at every communication point anyway.
        let is_noted = solid.has_stress_peaks() || solid.has_flaws();
        let is_solved = is_noted || scene.has_growing_flaws(name);
        let Some(laws) = plan.law.as_ref().filter(|_| !is_solved) else {
            return choice;
        };
        let classes = plan.mesh.parities().len() as f64;
        let by_memory =
            most_memory_of_rows(&plan.mesh, laws) / (memory_of_row(&plan.mesh) * classes);
        let readings = (scene.stop_time / scene.step).ceil();
        let most = (readings / READINGS_OF_A_ROW).min(by_memory);
        // Number of components of stress and displacement in the axes of the mesh.
        let counts = match plan.mesh.geometry {
            Geometry::Box => [6, 3],
            Geometry::Axisymmetric => [4, 2],
        };
        let mut known: HashSet<([u64; 3], bool)> = HashSet::new();
        let mut take_points = |choice: &mut Self, points: &[[f64; 3]], kinds: Kinds| {
            let places = points.iter().map(|&point| bits(plan.mesh.locate(point).0));
            let both = places.flat_map(|place| [(place, false), (place, true)]);
            let wanted = both.filter(|&(_, moves)| kinds[usize::from(moves)]);
            let new: HashSet<_> = wanted.filter(|one| !known.contains(one)).collect();
            let rows = new.iter().map(|&(_, moves)| counts[usize::from(moves)]).sum::<usize>();
            if ((choice.rows + rows) as f64) < most {
                choice.rows += rows;
                choice.points.extend(points.iter().map(|&point| (point, kinds)));
                known.extend(new);
            }
        };
        for probe in scene.probe.iter().filter(|probe| probe.body == name) {
            let kinds = kinds(&probe.gives, false);
            take_points(&mut choice, &[scene.point_of(probe)], kinds);
        }
        for (place, field) in scene.field.iter().enumerate() {
            if field.body_and_place().0 != name || !field.gives.iter().any(Gives::is_mechanical) {
                continue;
            }
            match field.sampling(solid) {
                Sampling::Points(grid) => {
                    let points: Vec<_> = grid.points().collect();
                    take_points(&mut choice, &points, kinds(&field.gives, false));
                }
                Sampling::Cells(cells) => {
                    let kinds = kinds(&field.gives, true);
                    let count = cells.footprint.cell_count();
                    let of_cell: usize =
                        components().map(|c| usize::from(is_of(c, kinds))).iter().sum();
                    if ((choice.rows + count * of_cell) as f64) < most {
                        choice.rows += count * of_cell;
                        choice.cells.extend((0..count).map(|cell| (place, cell, kinds)));
                    }
                }
            }
        }
        for (place, flaw) in scene.flaw.iter().enumerate() {
            let is_fixed = flaw.depth.given().is_some() && flaw.growth.is_none();
            let is_one_row = flaw.body == name && is_fixed;
            if is_one_row && ((choice.rows + 1) as f64) < most {
                choice.rows += 1;
                choice.flaws.push(place);
            }
        }
        choice.points.retain(|(_, kinds)| kinds.contains(&true));
        choice
    }

    /// Returns a note for users.
    pub fn note(&self) -> Option<String> {
        (self.rows > 0).then(|| {
            format!(
                "{} components of stress and displacement at points and cells, and stress intensities of flaws, are \
                 read by influence rows: each is solved for once, when it is first read, and costs a dot product from then on",
                self.rows
            )
        })
    }
}

impl Rows {
    /// Returns true if rows cost less than one solution for each of so many states.
    pub fn pay_in(&self, states: usize) -> bool {
        self.rows.len() as f64 * READINGS_OF_A_ROW <= states as f64
    }

    pub fn new(
        choice: Choice,
        solid: &SolidFem,
        means: &[(usize, FaceMeans)],
        cracks: &[(usize, Crack)],
    ) -> Self {
        let mut made = Self::default();
        let mut numbers: HashMap<([u64; 3], Component), usize> = HashMap::new();
        for (point, kinds) in choice.points {
            let mut own: PartsOfAll = made.of_points.remove(&bits(point)).unwrap_or_default();
            for (component, parts) in components().into_iter().zip(&mut own) {
                if parts.is_none() && is_of(component, kinds) {
                    let part = |term: Term| {
                        let number = *numbers
                            .entry((bits(term.place), term.component))
                            .or_insert_with(|| {
                                // Row of the place itself: mirror images differ only in signs.
                                let own = Term { image: [false; 2], weight: 1.0, ..term };
                                made.rows.push(LazyRow::of(Functional { terms: vec![own] }));
                                made.rows.len() - 1
                            });
                        let sign = |class| match class < solid.classes() {
                            true => term.weight * solid.sign(class, term.component, term.image),
                            false => 0.0,
                        };
                        (number, std::array::from_fn(sign))
                    };
                    *parts = Some(solid.terms(component, point).into_iter().map(part).collect());
                }
            }
            made.of_points.insert(bits(point), own);
        }
        for (field, cell, kinds) in choice.cells {
            let Some((_, means)) = means.iter().find(|(place, _)| *place == field) else {
                continue;
            };
            let own = components().map(|component| {
                is_of(component, kinds).then(|| {
                    let functional = solid.functional(component, means.points(cell));
                    made.rows.push(LazyRow::of(functional));
                    vec![(made.rows.len() - 1, [1.0; CLASSES])]
                })
            });
            made.of_cells.insert((field, cell), own);
        }
        for (place, crack) in
            cracks.iter().filter(|(place, _)| choice.flaws.binary_search(place).is_ok())
        {
            if let Some(functional) = crack.functional(solid) {
                made.rows.push(LazyRow::of(functional));
                made.of_flaws.insert(*place, vec![(made.rows.len() - 1, [1.0; CLASSES])]);
            }
        }
        made
    }

    /// Returns true if a quantity at a point needs no solution.
    pub fn give(&self, quantity: &PointQuantity, point: [f64; 3]) -> bool {
        // Measures of stress need all its components.
        let component = quantity.component().unwrap_or(stress(0));
        !quantity.is_of_history() && self.of_point(point, component).is_some()
    }

    /// Returns true if the mean of a quantity over a cell needs no solution.
    pub fn give_mean(&self, quantity: &PointQuantity, cell: (usize, usize)) -> bool {
        quantity.component().is_some_and(|component| self.of_cell(cell, component).is_some())
    }

    /// Returns true if the stress intensity of a flaw needs no solution.
    pub fn give_flaw(&self, flaw: usize) -> bool {
        self.of_flaws.contains_key(&flaw)
    }

    fn of_point(&self, point: [f64; 3], component: usize) -> Option<&Parts> {
        self.of_points.get(&bits(point))?[component].as_ref()
    }

    fn of_cell(&self, cell: (usize, usize), component: usize) -> Option<&Parts> {
        self.of_cells.get(&cell)?[component].as_ref()
    }
}

impl LazyRow {
    fn of(functional: Functional) -> Self {
        Self { functional, classes: Default::default() }
    }

    /// Creates a missing row. Threads that find it missing at the same time all create it, with the same bits.
    fn class(&self, solid: &SolidFem, class: usize) -> Result<&ClassRow, SolverError> {
        let lock = &self.classes[class];
        if let Some(row) = lock.get() {
            return Ok(row);
        }
        let row = solid.row(&self.functional, class);
        let row = row.expect("rows are chosen where mechanics is linear")?;
        Ok(lock.get_or_make(|| row))
    }
}

/// A state and its loads, or a change of both.
pub struct Acting<'a> {
    pub body: &'a SolidBody,
    pub state: &'a [f64],
    pub memo: &'a mut SolidMemo,
}

/// Place of a component among those of a point.
pub const fn stress(slot: usize) -> usize {
    slot
}

pub const fn displacement(axis: usize) -> usize {
    6 + axis
}

impl Acting<'_> {
    /// Component at a point; `None` if it needs a solution.
    pub fn at_point(
        &mut self,
        point: [f64; 3],
        component: usize,
    ) -> Option<Result<f64, BodyError>> {
        let body = self.body;
        body.rows.of_point(point, component).map(|parts| self.sum(parts))
    }

    /// Mean of a component over a cell of a field; `None` if it needs a solution.
    pub fn over_cell(
        &mut self,
        cell: (usize, usize),
        component: usize,
    ) -> Option<Result<f64, BodyError>> {
        let body = self.body;
        body.rows.of_cell(cell, component).map(|parts| self.sum(parts))
    }

    /// Signed stress intensity of a flaw; `None` if it needs a solution.
    pub fn of_flaw(&mut self, flaw: usize) -> Option<Result<f64, BodyError>> {
        let body = self.body;
        body.rows.of_flaws.get(&flaw).map(|parts| self.sum(parts))
    }

    fn sum(&mut self, parts: &Parts) -> Result<f64, BodyError> {
        let mut sum = 0.0;
        for (row, weights) in parts {
            let values = self.values(*row)?;
            sum += weights.iter().zip(values).map(|(weight, value)| weight * value).sum::<f64>();
        }
        Ok(sum)
    }

    fn values(&mut self, number: usize) -> Result<ByClass, BodyError> {
        if let Some(known) = self.memo.by_row(number) {
            return Ok(known);
        }
        let (body, solid) = (self.body, &self.body.solid);
        let heat = body.heat_of(self.state);
        let driven = self.memo.driven(body, heat);
        let row = &body.rows.rows[number];
        let mut values = [0.0; CLASSES];
        // The row of the even class is created even at rest: hosts read initial values before the first step.
        for class in (0..solid.classes()).filter(|&class| class == 0 || driven[class] != [false; 2])
        {
            let row = row.class(solid, class)?;
            let content = match driven[class][0] {
                true => self.memo.content(body, heat, class),
                false => &[],
            };
            values[class] = row.of(content, self.memo.faces(class), self.memo.forces(class));
            if !self.memo.is_change() {
                values[class] += row.constant;
            }
        }
        self.memo.keep_by_row(number, values);
        Ok(values)
    }
}
