//! Values that a reduced model provides: those of the scene's probes and fields, each a row of its output matrix.

use std::collections::BTreeMap;

use crate::body::point_quantities;
use crate::body::solid::Measure;
use crate::scene::{Gives, Sampling, Scene};

/// A value that is linear in the drives and the state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Value {
    Temperature([f64; 3]),
    /// Mean temperature over a cell of a field, by its place among the scene's.
    Mean {
        field: usize,
        cell: usize,
    },
    /// xx, yy, zz, xy, yz, xz.
    Stress([f64; 3], usize),
    Displacement([f64; 3], usize),
    Stored,
}

/// Kinds of values, each with its unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    Temperature,
    Stress,
    Displacement,
    Heat,
}

impl Value {
    pub fn kind(&self) -> Kind {
        match self {
            Self::Temperature(_) | Self::Mean { .. } => Kind::Temperature,
            Self::Stress(..) => Kind::Stress,
            Self::Displacement(..) => Kind::Displacement,
            Self::Stored => Kind::Heat,
        }
    }
}

/// The values of a body in their order, with their places.
#[derive(Debug, Clone, Default)]
pub struct Values {
    pub list: Vec<Value>,
    /// By the bits of the point.
    points: BTreeMap<[u64; 3], Rows>,
    /// Places of the first cells of fields, by the places of the fields.
    means: BTreeMap<usize, usize>,
}

/// Places of the first row of a point's temperature, stress and displacement.
#[derive(Debug, Clone, Copy, Default)]
pub struct Rows {
    pub temperature: Option<usize>,
    pub stress: Option<usize>,
    pub displacement: Option<usize>,
}

impl Values {
    /// Returns the values of a body that probes and fields request; the stored heat comes first.
    pub fn of(scene: &Scene, body: &str) -> Self {
        let mut values = Self { list: vec![Value::Stored], ..Self::default() };
        for probe in scene.probe.iter().filter(|probe| probe.body == body) {
            values.add_point(scene.point_of(probe), &probe.gives);
        }
        for (place, field) in scene.field.iter().enumerate() {
            let (name, _) = field.body_and_place();
            let Some(solid) = scene.solid(name).filter(|_| name == body) else { continue };
            match field.sampling(solid) {
                Sampling::Points(grid) => {
                    let [rows, columns] = grid.count;
                    for at in (0..rows).flat_map(|i| (0..columns).map(move |j| [i, j])) {
                        values.add_point(grid.point(at[0], at[1]), &field.gives);
                    }
                }
                Sampling::Cells(cells) => {
                    values.means.insert(place, values.list.len());
                    let count = cells.footprint.cell_count();
                    values.list.extend((0..count).map(|cell| Value::Mean { field: place, cell }));
                }
            }
        }
        values
    }

    fn add_point(&mut self, point: [f64; 3], gives: &[Gives]) {
        let rows = self.points.entry(point.map(f64::to_bits)).or_default();
        let is_wanted = |wish: &&Gives| gives.contains(wish);
        let quantities = point_quantities().iter();
        for quantity in
            quantities.filter(|quantity| quantity.given_by.iter().any(|w| is_wanted(&w)))
        {
            let (place, list) = (self.list.len(), &mut self.list);
            match quantity.measure {
                Measure::Temperature if rows.temperature.is_none() => {
                    rows.temperature = Some(place);
                    list.push(Value::Temperature(point));
                }
                Measure::Stress(_) | Measure::OfStress(..) if rows.stress.is_none() => {
                    rows.stress = Some(place);
                    list.extend((0..6).map(|slot| Value::Stress(point, slot)));
                }
                Measure::Displacement(_) if rows.displacement.is_none() => {
                    rows.displacement = Some(place);
                    list.extend((0..3).map(|axis| Value::Displacement(point, axis)));
                }
                _ => {}
            }
        }
    }

    pub fn rows_at(&self, point: [f64; 3]) -> Rows {
        self.points.get(&point.map(f64::to_bits)).copied().unwrap_or_default()
    }

    /// The row of a mean.
    pub fn mean(&self, field: usize, cell: usize) -> usize {
        self.means[&field] + cell
    }

    pub fn kinds(&self) -> impl Iterator<Item = Kind> + '_ {
        self.list.iter().map(Value::kind)
    }
}
