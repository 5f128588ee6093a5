//! Look-ups in a checked scene.

use super::coupling::Coupling;
use super::droplet::{Droplet, SOUND_OVER_FLOW};
use super::filament::{Filament, Target};
use super::large_strain::{LargeStrain, SolidShape};
use super::lattice::Lattice;
use super::reservoir::Reservoir;
use super::route::{Leg, Route};
use super::types::*;
use crate::limits::Bounds;
use crate::quantity::Quantity;

/// Least speed of sound over that of a nozzle: one faster than a fifth of it is refused.
const SOUND_OVER_NOZZLE: f64 = 6.0;

/// Position of a field in its body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Place {
    Face(FaceName),
    Section(Plane),
}

/// An input of a body as a whole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyInput {
    /// Last part of the variable's name.
    pub key: &'static str,
    pub words: &'static str,
    pub quantity: Quantity,
    pub start: f64,
    /// Bounds of the variable.
    pub bounds: Bounds,
}

impl Scene {
    /// Discards estimated errors, which belong to other parameters.
    pub fn forget_estimates(&mut self) {
        self.refinement.values_mut().for_each(|mesh| mesh.estimated_error = None);
    }

    /// The solid body of that name.
    pub fn solid(&self, name: &str) -> Option<&Solid> {
        match self.body.get(name)? {
            Body::Solid(solid) => Some(solid),
            _ => None,
        }
    }

    /// The droplet of that name.
    pub fn droplet(&self, name: &str) -> Option<&Droplet> {
        match self.body.get(name)? {
            Body::Droplet(droplet) => Some(droplet),
            _ => None,
        }
    }

    /// The reservoir of that name.
    pub fn reservoir(&self, name: &str) -> Option<&Reservoir> {
        match self.body.get(name)? {
            Body::Reservoir(reservoir) => Some(reservoir),
            _ => None,
        }
    }

    /// The solid of large strain of that name.
    pub fn large_strain(&self, name: &str) -> Option<&LargeStrain> {
        match self.body.get(name)? {
            Body::LargeStrain(solid) => Some(solid),
            _ => None,
        }
    }

    /// The filament of that name.
    pub fn filament(&self, name: &str) -> Option<&Filament> {
        match self.body.get(name)? {
            Body::Filament(filament) => Some(filament),
            _ => None,
        }
    }

    /// The route of a filament's nozzle; `None` if inputs move it, or for a file that has been refused.
    pub fn route(&self, filament: &Filament) -> Option<Route> {
        filament.route(&self.files).ok().flatten()
    }

    /// Returns true if a strand is laid on the body.
    pub fn lies_below_strand(&self, name: &str) -> bool {
        let is_on_it = |place: &str| place.rsplit_once('.').is_some_and(|(body, _)| body == name);
        self.coupling.iter().any(|own| is_on_it(&own.to) && self.filament(&own.from).is_some())
    }

    /// Legs of a filament's route that the run reaches, up to the stop time.
    fn legs_of(&self, filament: &Filament) -> Vec<Leg> {
        let route = self.route(filament);
        route.iter().flat_map(|route| route.legs_until(self.stop_time)).collect()
    }

    /// Largest volume flow of a filament by its path until the stop time, or by the start value of its input [m³/s].
    pub fn largest_flow(&self, filament: &Filament) -> f64 {
        let legs = self.legs_of(filament);
        legs.iter().map(Leg::largest_flow).fold(filament.nozzle.flow, f64::max)
    }

    /// Largest speed of fluid, and of the nozzle while fluid comes, that a filament of particles expects until the stop
    /// time [m/s]: that of the flow, of the path, of a fall from the outlet and of surface tension. A flow that only
    /// inputs set is expected to bring `most` by the stop time.
    pub fn fastest_strand(&self, filament: &Filament) -> f64 {
        let flow = match self.largest_flow(filament) {
            0.0 => filament.most / self.stop_time,
            flow => flow,
        };
        let legs: Vec<Leg> = self.legs_of(filament).into_iter().filter(Leg::lays).collect();
        let speed = legs.iter().map(Leg::fastest).fold(0.0, f64::max);
        let heights = legs.iter().map(|leg| leg.place[0][2].max(leg.at(leg.duration)[2]));
        let height = heights.reduce(f64::max).unwrap_or(filament.nozzle.height);
        let fall = (2.0 * filament.gravity * height).sqrt();
        let radius = 0.5 * filament.nozzle.diameter;
        let capillary = filament.fluid.capillary_speed_squared(radius).sqrt();
        [flow / filament.outlet(), speed, fall, capillary].into_iter().fold(0.0, f64::max)
    }

    /// Speed of sound of a filament of particles [m/s]: that of its fluid, or ten times the fastest of its flow, of the
    /// pressure of its surface and of that of its viscosity. A nozzle that moves while no fluid comes has the sixth of
    /// it at most.
    pub fn sound_of_strand(&self, filament: &Filament) -> f64 {
        let (fluid, diameter) = (&filament.fluid, filament.nozzle.diameter);
        let fastest = self.fastest_strand(filament);
        let viscosity = fluid.reference_viscosity(filament.nozzle.temperature, fastest / diameter);
        let viscous = fluid.viscous_speed(viscosity, fastest, diameter);
        let surface = fluid.laplace_speed(filament.particle_distance());
        let of_flow = SOUND_OVER_FLOW * fastest.max(viscous).max(surface);
        let of_nozzle = self.legs_of(filament).iter().map(Leg::fastest).fold(0.0, f64::max);
        fluid.sound_speed.unwrap_or(of_flow.max(SOUND_OVER_NOZZLE * of_nozzle))
    }

    /// The filaments, in the order of their names.
    pub fn filaments(&self) -> impl Iterator<Item = (&str, &Filament)> {
        self.body.keys().filter_map(|name| Some((name.as_str(), self.filament(name)?)))
    }

    /// The lattices, in the order of their names.
    pub fn lattices(&self) -> impl Iterator<Item = (&str, &Lattice)> {
        self.body.iter().filter_map(|(name, body)| match body {
            Body::Lattice(lattice) => Some((name.as_str(), lattice.as_ref())),
            _ => None,
        })
    }

    /// The target of a filament.
    pub fn target_of(&self, filament: &str) -> Option<&Target> {
        self.target.iter().find(|target| target.of == filament)
    }

    /// The solids of large strain, in the order of their names.
    pub fn large_strains(&self) -> impl Iterator<Item = (&str, &LargeStrain)> {
        self.body.keys().filter_map(|name| Some((name.as_str(), self.large_strain(name)?)))
    }

    /// The solids, in the order of their names.
    pub fn solids(&self) -> impl Iterator<Item = (&str, &Solid)> {
        self.body.keys().filter_map(|name| Some((name.as_str(), self.solid(name)?)))
    }

    /// The scene of a single isolated solid, with its loads, outputs and mesh settings.
    pub fn alone(&self, name: &str) -> Self {
        let mut own = self.clone();
        own.body.retain(|other, _| other == name);
        own.load.retain(|load| load.body_and_face().0 == name);
        own.probe.retain(|probe| probe.body == name);
        own.field.retain(|field| field.body_and_place().0 == name);
        own.flaw.retain(|flaw| flaw.body == name);
        own.refinement.retain(|other, _| other == name);
        own.wall.clear();
        own.coupling.clear();
        own.target.clear();
        own.resolved.clear();
        own
    }

    /// The droplets, in the order of their names.
    pub fn droplets(&self) -> impl Iterator<Item = (&str, &Droplet)> {
        self.body.keys().filter_map(|name| Some((name.as_str(), self.droplet(name)?)))
    }

    /// The reservoirs, in the order of their names.
    pub fn reservoirs(&self) -> impl Iterator<Item = (&str, &Reservoir)> {
        self.body.keys().filter_map(|name| Some((name.as_str(), self.reservoir(name)?)))
    }

    /// The index of the wall below a droplet or a solid of large strain.
    pub fn wall_under(&self, body: &str) -> Option<usize> {
        self.wall.iter().position(|wall| wall.under == body)
    }

    /// √(kρc) of the solid below a droplet [W √s/(m² K)], of its top layer; `None` for a wall of prescribed
    /// temperature.
    pub fn effusivity_below(&self, droplet: &str) -> Option<f64> {
        let solid = self.coupling_from(droplet).and_then(|index| self.coupling[index].solid());
        match solid.and_then(|solid| self.solid(solid)) {
            Some(solid) => solid.strata().first().map(|layer| layer.constants.effusivity()),
            None => self.wall[self.wall_under(droplet)?].effusivity,
        }
    }

    /// Conductance between a droplet and what lies below it [W/(m² K)]; `None` for perfect contact.
    pub fn conductance_below(&self, droplet: &str) -> Option<f64> {
        match self.coupling_from(droplet) {
            Some(coupling) => self.coupling[coupling].conductance,
            None => self.wall[self.wall_under(droplet)?].conductance,
        }
    }

    /// The index of the coupling of a droplet.
    pub fn coupling_from(&self, droplet: &str) -> Option<usize> {
        self.coupling.iter().position(|coupling| coupling.from == droplet)
    }

    /// Returns true if a wall or a body lies below a droplet; else its drops fall freely.
    pub fn has_surface_below(&self, droplet: &str) -> bool {
        self.wall_under(droplet).is_some() || self.coupling_from(droplet).is_some()
    }

    /// Returns true if the surface below a droplet is modelled as round: a disc, or a wall of rings.
    fn is_round_below(&self, droplet: &str) -> bool {
        if let Some(wall) = self.wall_under(droplet) {
            return matches!(self.wall[wall].footprint, Footprint::Rings { .. });
        }
        let below = self.coupling_from(droplet).and_then(|place| self.coupling[place].solid());
        below.and_then(|name| self.body.get(name)).is_some_and(Body::is_round)
    }

    /// Stores in each droplet and each solid of large strain the properties of the surface below it.
    pub(super) fn store_surfaces_below(&mut self) {
        let names: Vec<String> = self.droplets().map(|(name, _)| name.to_owned()).collect();
        for name in names {
            let is_round = self.is_round_below(&name);
            if let Some(Body::Droplet(droplet)) = self.body.get_mut(&name) {
                droplet.is_on_round = is_round;
            }
        }
        for wall in &self.wall {
            if let Some(Body::LargeStrain(solid)) = self.body.get_mut(&wall.under) {
                solid.conductance_below = wall.conductance.filter(|_| solid.is_above());
                solid.is_on_tiles = matches!(wall.footprint, Footprint::Tiles { .. });
            }
        }
        for coupling in &self.coupling {
            if let Some(Body::LargeStrain(solid)) = self.body.get_mut(&coupling.from) {
                solid.conductance_below = coupling.conductance;
            }
        }
    }

    /// Reads the parts of solids of large strain from the texts of the scene's files.
    pub(super) fn store_parts(&mut self) {
        for body in self.body.values_mut() {
            let Body::LargeStrain(solid) = body else { continue };
            let form = solid.form();
            if let SolidShape::Part(part) = &mut solid.shape
                && let Some(text) = self.files.get(&part.file)
            {
                part.read(text, form);
            }
        }
    }

    /// Returns true if axisymmetric bodies stand on a box and exchange with it over rings.
    pub fn meets_rings(&self, solid: &str) -> bool {
        let is_box = self.solid(solid).is_some_and(|solid| matches!(solid.shape, Shape::Box(_)));
        let falls_round = |coupling: &Coupling| {
            let body = self.large_strain(&coupling.from);
            body.is_some_and(LargeStrain::is_axisymmetric)
        };
        is_box
            && (self.drops_on(solid).any(|(_, drop)| drop.is_axisymmetric())
                || self.couplings_to(solid).any(falls_round))
    }

    /// The couplings that act on a solid.
    pub fn couplings_to(&self, solid: &str) -> impl Iterator<Item = &Coupling> {
        self.coupling.iter().filter(move |coupling| coupling.solid() == Some(solid))
    }

    /// Returns true if the mechanics of a body is modelled: if outputs or loads require it, or if a droplet loads a
    /// body with known elastic constants.
    pub fn asks_mechanics(&self, body: &str) -> bool {
        let is_elastic = || self.solid(body).is_some_and(Solid::is_elastic);
        self.needs_mechanics(body)
            || self.couplings_to(body).any(|coupling| coupling.traction) && is_elastic()
    }

    /// Returns true if the mechanics of a body must be modelled: it has mechanical outputs, or a load carries traction.
    pub fn needs_mechanics(&self, body: &str) -> bool {
        self.gives_mechanics(body)
            || self.loads_on(body).any(|load| load.carries.iter().any(Carries::is_mechanical))
    }

    /// The loads on faces of a body.
    pub fn loads_on(&self, body: &str) -> impl Iterator<Item = &Load> {
        self.load.iter().filter(move |load| split_place(&load.on).is_some_and(|(on, _)| on == body))
    }

    /// Returns true if a probe, a field, a flaw, a running maximum, a probability of failure or cracks need stresses or
    /// displacements of a body.
    pub fn gives_mechanics(&self, body: &str) -> bool {
        let own = self.solid(body);
        own.is_some_and(|solid| solid.has_stress_peaks() || solid.has_flaws() || solid.cracks())
            || self.flaws_in(body).next().is_some()
            || self.gives_mechanics_at_places(body)
    }

    /// Returns true if a probe or a field has stresses or displacements of a body as outputs.
    pub fn gives_mechanics_at_places(&self, body: &str) -> bool {
        let mechanical = |gives: &[Gives]| gives.iter().any(Gives::is_mechanical);
        self.probe.iter().any(|probe| probe.body == body && mechanical(&probe.gives))
            || self.field.iter().any(|field| field.body() == Some(body) && mechanical(&field.gives))
    }
}

impl Shape {
    /// The single faces of the shape, in the order of their numbers.
    pub fn faces(&self) -> &'static [FaceName] {
        match self {
            Shape::Box(_) => &FaceName::OF_BOX,
            Shape::Disc(_) => &FaceName::OF_DISC,
        }
    }
}

impl Solid {
    /// Settings of particle conduction; `None` for finite elements.
    pub fn sph(&self) -> Option<SphSettings> {
        (self.heat == HeatMethod::Sph).then(|| self.sph.unwrap_or_default())
    }

    /// Returns true if running maxima of stress are kept, which requires a stress solution at every communication
    /// point.
    pub fn has_stress_peaks(&self) -> bool {
        self.peaks.iter().any(PeakOf::is_mechanical)
    }

    /// The conditions on a face, those of `sides` included on the lateral faces of a box.
    pub fn face(&self, name: FaceName) -> Face {
        let own = self.faces.get(&name).copied().unwrap_or_default();
        if !name.is_one_of_four_sides() {
            return own;
        }
        let sides = self.faces.get(&FaceName::Sides).copied().unwrap_or_default();
        Face {
            temperature: own.temperature.or(sides.temperature),
            flux: own.flux.or(sides.flux),
            convection: own.convection.or(sides.convection),
            radiation: own.radiation.or(sides.radiation),
            clamped: own.clamped || sides.clamped,
            roller: own.roller || sides.roller,
            role: if own.thermal().is_empty() { sides.role } else { own.role },
        }
    }
}

impl Face {
    /// Keys of the thermal conditions that are set.
    pub fn thermal(&self) -> Vec<&'static str> {
        let given = [
            ("temperature", self.temperature.is_some()),
            ("flux", self.flux.is_some()),
            ("convection", self.convection.is_some()),
        ];
        given.into_iter().filter(|(_, given)| *given).map(|(key, _)| key).collect()
    }

    /// Keys of the mechanical conditions that are set.
    pub fn mechanical(&self) -> Vec<&'static str> {
        let given = [("clamped", self.clamped), ("roller", self.roller)];
        given.into_iter().filter(|(_, given)| *given).map(|(key, _)| key).collect()
    }
}

impl FaceName {
    pub(super) const ALL: [Self; 7] =
        [Self::Top, Self::Bottom, Self::Sides, Self::Left, Self::Right, Self::Front, Self::Back];
    const OF_BOX: [Self; 6] =
        [Self::Top, Self::Bottom, Self::Left, Self::Right, Self::Front, Self::Back];
    const OF_DISC: [Self; 3] = [Self::Top, Self::Bottom, Self::Sides];

    /// Name in scenes.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Top => "top",
            Self::Bottom => "bottom",
            Self::Sides => "sides",
            Self::Left => "left",
            Self::Right => "right",
            Self::Front => "front",
            Self::Back => "back",
        }
    }

    /// The face with this name in scenes.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|face| face.as_str() == name)
    }

    /// Returns true if `sides` of a box includes the face.
    pub fn is_one_of_four_sides(self) -> bool {
        matches!(self, Self::Left | Self::Right | Self::Front | Self::Back)
    }

    /// The axis along the normal, 0 = x, 1 = y, 2 = z; `None` for `sides`, which has several.
    pub fn normal(self) -> Option<usize> {
        match self {
            Self::Left | Self::Right => Some(0),
            Self::Front | Self::Back => Some(1),
            Self::Top | Self::Bottom => Some(2),
            Self::Sides => None,
        }
    }
}

impl Load {
    /// The body and the face that the load acts on.
    ///
    /// # Panics
    /// If the scene has not been checked and `on` is not `BODY.FACE`.
    pub fn body_and_face(&self) -> (&str, FaceName) {
        split_place(&self.on).expect("a checked load is on BODY.FACE")
    }
}

impl Coupling {
    /// The solid that a droplet is coupled to, if the coupling names one.
    pub fn solid(&self) -> Option<&str> {
        self.upper().is_none().then(|| split_place(&self.to).map(|(body, _)| body))?
    }

    /// The lower solid of a contact and its face; `None` for the coupling of a droplet.
    pub fn lower(&self) -> Option<(&str, FaceName)> {
        split_place(&self.from)
    }

    /// The upper solid of a contact and its face.
    pub fn upper(&self) -> Option<(&str, FaceName)> {
        self.lower().and_then(|_| split_place(&self.to))
    }
}

impl Field {
    /// The body and the face or section that the field lies in.
    ///
    /// # Panics
    /// If the scene has not been checked and the field says neither `on` nor `in` and `plane`.
    pub fn body_and_place(&self) -> (&str, Place) {
        match (&self.on, &self.body, self.plane) {
            (Some(on), None, None) => {
                let (body, face) = split_place(on).expect("a checked field is on BODY.FACE");
                (body, Place::Face(face))
            }
            (None, Some(body), Some(plane)) => (body, Place::Section(plane)),
            _ => panic!("a checked field has either `on` or `in` and `plane`"),
        }
    }

    /// Name of the body, if the field names one.
    pub(super) fn body(&self) -> Option<&str> {
        match (&self.on, &self.body) {
            (Some(on), _) => split_place(on).map(|(body, _)| body),
            (None, body) => body.as_deref(),
        }
    }
}

impl Plane {
    /// The axis along the normal, 0 = x, 1 = y, 2 = z.
    pub fn normal(self) -> usize {
        match self {
            Plane::X(_) => 0,
            Plane::Y(_) => 1,
            Plane::Z(_) => 2,
        }
    }

    /// The constant coordinate [m].
    pub fn offset(self) -> f64 {
        match self {
            Plane::X(offset) | Plane::Y(offset) | Plane::Z(offset) => offset,
        }
    }
}

impl Carries {
    /// Returns true if it is a traction.
    pub fn is_mechanical(&self) -> bool {
        matches!(self, Carries::Pressure | Carries::Shear)
    }
}

impl PeakOf {
    /// Returns true if it derives from the displacements.
    pub fn is_mechanical(&self) -> bool {
        !matches!(self, PeakOf::Temperature)
    }
}

impl Gives {
    /// Returns true if it derives from the displacements.
    pub fn is_mechanical(&self) -> bool {
        !matches!(self, Gives::Temperature)
    }

    /// Returns true if it depends on what the body has borne before.
    pub fn is_of_history(&self) -> bool {
        matches!(
            self,
            Gives::PlasticStrain
                | Gives::Damage
                | Gives::FailureDensity
                | Gives::SurfaceFailureDensity
        )
    }
}

/// The two parts of `BODY.FACE`.
pub(super) fn split_place(place: &str) -> Option<(&str, FaceName)> {
    let (body, face) = place.rsplit_once('.')?;
    Some((body, FaceName::named(face)?))
}
