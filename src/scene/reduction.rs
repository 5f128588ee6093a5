//! Solids that a scene allows to be reduced, and obstacles to that.

use super::Sampling;
use super::check::takes_newton;
use super::lookup::split_place;
use super::types::{FidelityLevel, Gives, HeatMethod, Load, Scene, Solid, SolidLevel};

/// A reason why a solid cannot be reduced.
#[derive(Debug, Clone, PartialEq)]
pub struct Obstacle {
    /// Position in the scene.
    pub at: Place,
    pub message: String,
    pub allowed: &'static str,
}

/// A part of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Place {
    /// A key of the body.
    Body(&'static str),
    /// An element of these tables, by number.
    Element(&'static str, usize),
    /// The scene as a whole.
    Level,
}

/// Largest product of inputs, outputs and the smaller of both: work of the reduction.
const MOST_WORK: usize = 20_000;
/// Largest number of points with stresses or displacements as outputs: each of their components needs a solution.
const MOST_MECHANICAL: usize = 100;

impl Scene {
    /// Returns true if a solid is a reduced model.
    pub fn is_reduced(&self, name: &str) -> bool {
        match self.fidelity.level {
            FidelityLevel::Full => false,
            FidelityLevel::Reduced => self.solid(name).is_some(),
            FidelityLevel::Auto => match self.resolved.get(name) {
                Some(resolved) => resolved.level == SolidLevel::Reduced,
                None => self.solid(name).is_some() && self.obstacle(name).is_none(),
            },
        }
    }

    /// Returns true if the level of a solid is still to be chosen.
    pub fn is_open_level(&self, name: &str) -> bool {
        self.fidelity.level == FidelityLevel::Auto && !self.resolved.contains_key(name)
    }

    /// Names of the bodies that are reduced models.
    pub fn reduced_bodies(&self) -> impl Iterator<Item = &str> {
        self.solids().map(|(name, _)| name).filter(|name| self.is_reduced(name))
    }

    /// Names of the bodies whose level is to be found.
    pub fn open_levels(&self) -> impl Iterator<Item = &str> {
        self.solids().map(|(name, _)| name).filter(|name| self.is_open_level(name))
    }

    /// The first obstacle to the reduction of a solid.
    pub fn obstacle(&self, name: &str) -> Option<Obstacle> {
        let solid = self.solid(name)?;
        self.obstacle_of_kind(name, solid)
            .or_else(|| self.obstacle_of_neighbours(name))
            .or_else(|| self.obstacle_of_fields(name, solid))
            .or_else(|| self.obstacle_of_size(name))
    }

    fn obstacle_of_kind(&self, name: &str, solid: &Solid) -> Option<Obstacle> {
        let obstacle = |at, message: &str, allowed| {
            Some(Obstacle { at, message: message.to_owned(), allowed })
        };
        if solid.heat == HeatMethod::Sph {
            let message = "a reduced model is derived from modes, not from particles";
            return obstacle(Place::Body("heat"), message, "fem");
        }
        if takes_newton(self, solid) {
            let message = "a reduced model needs linear heat: constants independent of temperature, nothing that \
                           melts, no face that radiates and no bath";
            return obstacle(Place::Level, message, "full, auto");
        }
        if self.asks_mechanics(name) && !solid.deforms_linearly() {
            let message = "a reduced model is elastic: nothing yields, relaxes or creeps";
            return obstacle(Place::Level, message, "full, auto");
        }
        if solid.cracks() {
            let message = "a reduced model is elastic: nothing cracks";
            return obstacle(Place::Level, message, "full, auto, or no `fracture`");
        }
        if solid.has_flaws() {
            let message = "a reduced model computes only its probes and fields, not the probability of failure, which \
                           needs the stress of the whole body";
            return obstacle(Place::Level, message, "full, auto, or no `weibull`");
        }
        if !solid.peaks.is_empty() {
            let message =
                "a reduced model computes only its probes and fields, not the extremes of the body";
            return obstacle(Place::Body("peaks"), message, "no `peaks`, or fidelity full, auto");
        }
        None
    }

    fn obstacle_of_neighbours(&self, name: &str) -> Option<Obstacle> {
        let touches =
            |place: &str| place == name || split_place(place).is_some_and(|(body, _)| body == name);
        let own = |coupling: &super::Coupling| touches(&coupling.from) || touches(&coupling.to);
        let place = self.coupling.iter().position(own)?;
        let message =
            format!("`{name}` is a reduced model, which cannot be in contact with other bodies");
        Some(Obstacle {
            at: Place::Element("coupling", place),
            message,
            allowed: "loads and conditions on its faces, or fidelity full, auto",
        })
    }

    fn obstacle_of_fields(&self, name: &str, solid: &Solid) -> Option<Obstacle> {
        let is_of_cells = |field: &super::Field| {
            field.body() == Some(name)
                && field.gives.iter().any(Gives::is_mechanical)
                && matches!(field.sampling(solid), Sampling::Cells(_))
        };
        let place = self.field.iter().position(is_of_cells)?;
        Some(Obstacle {
            at: Place::Element("field", place),
            message: "a reduced model does not compute means of stress or displacement over cells"
                .to_owned(),
            allowed: "temperature, or points of a `grid`, or fidelity full, auto",
        })
    }

    fn obstacle_of_size(&self, name: &str) -> Option<Obstacle> {
        let [mechanical, thermal] = self.points_read(name);
        if mechanical > MOST_MECHANICAL {
            let message = format!(
                "stress and displacement at {mechanical} points of `{name}`; each needs some solutions of mechanics in a \
                 reduced model, which computes them at {MOST_MECHANICAL} at most"
            );
            return Some(Obstacle { at: Place::Level, message, allowed: "full, auto" });
        }
        let outputs = 1 + thermal + 9 * mechanical;
        let inputs = self.driving_inputs(name);
        if inputs * outputs * inputs.min(outputs) > MOST_WORK {
            let message = format!(
                "{inputs} ways to drive `{name}` and some {outputs} outputs are too many for a reduced model (the one times the \
                 other times the fewer of both: {MOST_WORK} at most); a footprint counts once for each place and radius that \
                 its `range` lets it take: smaller ranges, or fewer quantities that it carries, would do"
            );
            return Some(Obstacle { at: Place::Level, message, allowed: "full, auto" });
        }
        None
    }

    /// Numbers of points with stress or displacement as outputs, and of places with temperature.
    fn points_read(&self, name: &str) -> [usize; 2] {
        let mut counts = [0; 2];
        let mut add = |gives: &[Gives], count: usize| {
            counts[0] += if gives.iter().any(Gives::is_mechanical) { count } else { 0 };
            counts[1] += if gives.contains(&Gives::Temperature) { count } else { 0 };
        };
        self.probe.iter().filter(|probe| probe.body == name).for_each(|probe| add(&probe.gives, 1));
        for field in self.field.iter().filter(|field| field.body() == Some(name)) {
            let count = match (&field.footprint, field.grid) {
                (Some(footprint), _) => footprint.cell_count(),
                (None, grid) => grid.map_or(1, |[rows, columns]| rows * columns),
            };
            add(&field.gives, count);
        }
        counts
    }

    /// Number of values of loads and faces that drive a body.
    fn driving_inputs(&self, name: &str) -> usize {
        let of_load = |load: &Load| {
            let footprints: usize = footprints_along(load).into_iter().product();
            load.carries.len() * load.footprint.cell_count() * footprints
        };
        let faces = self.body.get(name).map_or(0, |body| body.faces().count());
        self.loads_on(name).map(of_load).sum::<usize>() + faces
    }
}

/// Numbers of footprints along the range of a load along x, y and the radius. They suffice for a load smoothed by heat
/// conduction: about four for each of its radii in the range. A Gaussian of 1/e² radius R is a polynomial of degree 4
/// L/R over a range L to 1e-5.
pub fn footprints_along(load: &Load) -> [usize; 3] {
    let own = load.footprint.radius().unwrap_or(0.0);
    let least = load.range.radius.map_or(load.start.radius.unwrap_or(own), |[low, _]| low);
    let half = load.footprint.half_extents(Some(least));
    let along = |range: Option<[f64; 2]>, size: f64| {
        let length = range.map_or(0.0, |[low, high]| high - low);
        let count = FIRST_FOOTPRINTS + FOOTPRINTS * length / size;
        if length > 0.0 { (count.ceil() as usize).min(MOST_FOOTPRINTS) } else { 1 }
    };
    let radius = load.range.radius.filter(|[low, high]| low < high);
    let of_radius = radius.map_or(1, |[low, high]| {
        (FIRST_FOOTPRINTS + OF_RADIUS * (high / low).ln()).ceil() as usize
    });
    [along(load.range.x, half[0]), along(load.range.y, half[1]), of_radius]
}

/// Numbers of footprints that represent a moving one: at least; per radius of the range's length; per e-fold of the
/// radius; at most.
const FIRST_FOOTPRINTS: f64 = 3.0;
const FOOTPRINTS: f64 = 4.0;
const OF_RADIUS: f64 = 5.0;
const MOST_FOOTPRINTS: usize = 64;
