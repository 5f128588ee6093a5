//! Positions of the cells that variables belong to, for coupling with other tools.

use serde::Serialize;

use super::{Causality, Registry};
use crate::scene::{CellShape, Cells, FieldCells, Footprint, Grid, Sampling, Scene};

/// The cells or points of a load, a wall or a field, lists in the order of the elements of their variables.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CellFamily {
    /// First part of the variables' names.
    pub name: String,
    /// `load`, `wall` or `field`.
    pub kind: &'static str,
    /// The face, `BODY.FACE`, or the body of a section.
    pub on: String,
    /// Kind of footprint, or `grid`.
    pub footprint: &'static str,
    /// Number of elements along each index; none of a single value.
    pub count: Vec<usize>,
    /// Last parts of the names of its variables of many elements or one.
    pub inputs: Vec<String>,
    pub outputs: Vec<String>,
    /// Place of the centre at the start [m].
    pub at: [f64; 2],
    /// Area of each cell, weighted with the profile of a spot [m²]; of plane droplets per metre of depth [m].
    pub area: Vec<f64>,
    /// Radii of rings [m].
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub inner: Vec<f64>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub outer: Vec<f64>,
    /// Middles of tiles, points of grids [m].
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub x: Vec<f64>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub y: Vec<f64>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub z: Vec<f64>,
    /// Extents of each tile or cell of a grid along its axes [m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub size: Option<[f64; 2]>,
}

impl CellFamily {
    /// Returns all families of a checked scene: of loads, walls and fields, in this order.
    pub fn all(scene: &Scene) -> Vec<Self> {
        let mut families = Self::places(scene);
        let registry = Registry::structured(scene);
        families.iter_mut().for_each(|family| family.name_quantities(&registry));
        families
    }

    /// Returns the families without the names of variables.
    pub fn places(scene: &Scene) -> Vec<Self> {
        let loads = scene.load.iter().map(|load| {
            let at = [load.start.x, load.start.y].map(Option::unwrap_or_default);
            let radius = load.start.radius;
            Self::of_footprint((&load.name, "load", &load.on), &load.footprint, radius, at)
        });
        let walls = scene.wall.iter().map(|wall| {
            let family = Self::of_footprint(
                (&wall.name, "wall", &wall.under),
                &wall.footprint,
                None,
                [0.0; 2],
            );
            if scene.body[&wall.under].is_plane() { family.of_plane() } else { family }
        });
        let fields = scene.field.iter().filter_map(|field| {
            let (body, _) = field.body_and_place();
            let on = field.on.as_deref().unwrap_or(body);
            let names = (field.name.as_str(), "field", on);
            Some(match scene.sampling(field)? {
                Sampling::Points(grid) => Self::of_grid(names, &grid),
                Sampling::Cells(FieldCells { footprint, at, .. }) => {
                    Self::of_footprint(names, &footprint, None, at)
                }
            })
        });
        loads.chain(walls).chain(fields).collect()
    }

    fn new(
        (name, kind, on): (&str, &'static str, &str),
        footprint: &'static str,
        count: Vec<usize>,
        at: [f64; 2],
    ) -> Self {
        let (inputs, outputs) = (Vec::new(), Vec::new());
        let [area, inner, outer, x, y, z] = [const { Vec::new() }; 6];
        let (name, on) = (name.to_owned(), on.to_owned());
        let size = None;
        Self {
            name,
            kind,
            on,
            footprint,
            count,
            inputs,
            outputs,
            at,
            area,
            inner,
            outer,
            x,
            y,
            z,
            size,
        }
    }

    fn of_footprint(
        names: (&str, &'static str, &str),
        footprint: &Footprint,
        radius: Option<f64>,
        at: [f64; 2],
    ) -> Self {
        let count = match footprint.cells() {
            None => Vec::new(),
            Some(CellShape::Rings(count)) => vec![count],
            Some(CellShape::Tiles(count)) => count.to_vec(),
        };
        let radius = radius.or(footprint.radius()).unwrap_or_default();
        let mut family = Self::new(names, footprint.name(), count, at);
        family.area = footprint.areas(radius);
        match footprint.cells_about_centre(radius) {
            Cells::Rings(rings) => {
                (family.inner, family.outer) = rings.into_iter().map(|[a, b]| (a, b)).unzip();
            }
            Cells::Tiles { middles, size } => {
                family.x = middles.iter().map(|[x, _]| at[0] + x).collect();
                family.y = middles.iter().map(|[_, y]| at[1] + y).collect();
                family.size = Some(size);
            }
        }
        family
    }

    fn of_grid(names: (&str, &'static str, &str), grid: &Grid) -> Self {
        let mut family = Self::new(names, "grid", grid.count.to_vec(), [0.0; 2]);
        let points: Vec<[f64; 3]> = grid.points().collect();
        let along = |axis: usize| points.iter().map(|point| point[axis]).collect();
        (family.x, family.y, family.z) = (along(0), along(1), along(2));
        let [a, b] = [0, 1].map(|axis| grid.size[axis] / grid.count[axis] as f64);
        family.area = vec![a * b; points.len()];
        family.size = Some([a, b]);
        family
    }

    /// Converts to a plane model, whose cells are strips.
    fn of_plane(mut self) -> Self {
        if let Some([width, _]) = self.size {
            self.area = vec![width; self.area.len()];
        }
        self
    }

    /// Finds the variables that have an element for each cell.
    fn name_quantities(&mut self, registry: &Registry) {
        let label = match self.count[..] {
            [] => "",
            [_] => "[1]",
            _ => "[1,1]",
        };
        for variable in &registry.variables {
            let quantity = variable.name.strip_prefix(self.name.as_str());
            let quantity = quantity.and_then(|rest| rest.strip_prefix('.'));
            let Some(key) = quantity.and_then(|rest| rest.strip_suffix(label)) else { continue };
            let is_of_place = ["x", "y", "radius"].contains(&key) || key.ends_with(']');
            match variable.causality() {
                Causality::Input if !is_of_place => self.inputs.push(key.to_owned()),
                Causality::Output if !is_of_place => self.outputs.push(key.to_owned()),
                _ => {}
            }
        }
    }
}
