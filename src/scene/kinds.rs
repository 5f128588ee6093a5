//! Questions about bodies, answered for each kind: others ask these instead of which kind a body is.

use super::check::takes_newton;
use super::coupling::{Coupling, Wall};
use super::droplet::Droplet;
use super::grid::Grid;
use super::lookup::BodyInput;
use super::materials::MaterialChoice;
use super::sampling::Sampling;
use super::types::*;

/// Places at which a body's fields are given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Drawn {
    /// Nodes of a mesh.
    Grid,
    Particles,
}

impl Body {
    /// Uniform temperature at the beginning [K].
    pub fn initial_temperature(&self) -> f64 {
        match self {
            Body::Solid(solid) => solid.initial_temperature,
            Body::Droplet(droplet) => droplet.initial_temperature,
            Body::Reservoir(reservoir) => reservoir.initial_temperature,
            Body::LargeStrain(solid) => solid.initial_temperature,
            Body::Filament(filament) => filament.nozzle.temperature,
            Body::Lattice(lattice) => lattice.initial_temperature,
        }
    }

    /// Heat capacity of a solid of small strain [J/K].
    pub fn heat_capacity(&self) -> Option<f64> {
        let Body::Solid(solid) = self else { return None };
        Some(solid.heat_capacity())
    }

    /// The initial temperature, to be changed.
    pub fn initial_temperature_mut(&mut self) -> &mut f64 {
        match self {
            Body::Solid(solid) => &mut solid.initial_temperature,
            Body::Droplet(droplet) => &mut droplet.initial_temperature,
            Body::Reservoir(reservoir) => &mut reservoir.initial_temperature,
            Body::LargeStrain(solid) => &mut solid.initial_temperature,
            Body::Filament(filament) => &mut filament.nozzle.temperature,
            Body::Lattice(lattice) => &mut lattice.initial_temperature,
        }
    }

    /// Inputs other than those of loads, faces and walls.
    pub fn inputs(&self) -> Vec<BodyInput> {
        match self {
            Body::Solid(_) => Vec::new(),
            Body::Droplet(droplet) => droplet.inputs(),
            Body::Reservoir(reservoir) => reservoir.inputs(),
            Body::LargeStrain(solid) => solid.inputs(),
            Body::Filament(filament) => filament.inputs(),
            Body::Lattice(lattice) => lattice.inputs(),
        }
    }

    /// A description of a body that has no extent.
    pub(super) fn lump(&self) -> Option<String> {
        match self {
            Body::Reservoir(reservoir) => Some(reservoir.words()),
            _ => None,
        }
    }

    /// Returns true if probes and fields can read the body, whose outputs then have an estimate of their errors.
    pub fn resolves_fields(&self) -> bool {
        matches!(self, Body::Solid(_))
    }

    /// Elements of pictures of the body's fields; `None` for a body without extent.
    pub fn drawn_as(&self) -> Option<Drawn> {
        match self {
            Body::Solid(_) => Some(Drawn::Grid),
            Body::Droplet(_) | Body::LargeStrain(_) | Body::Filament(_) | Body::Lattice(_) => {
                Some(Drawn::Particles)
            }
            Body::Reservoir(_) => None,
        }
    }

    /// Returns true if the body's shape is round about z, so that a meridian section represents it.
    pub fn is_round(&self) -> bool {
        matches!(self, Body::Solid(solid) if matches!(solid.shape, Shape::Disc(_)))
    }

    /// Returns true if the model of the body is plane, per metre of depth.
    pub fn is_plane(&self) -> bool {
        match self {
            Body::Droplet(droplet) => droplet.dimension == 2,
            Body::LargeStrain(solid) => solid.dimension == 2,
            Body::Solid(_) | Body::Reservoir(_) | Body::Filament(_) | Body::Lattice(_) => false,
        }
    }

    /// Conditions that the scene sets on faces of the body; of a solid of large strain the thermal ones.
    pub fn faces(&self) -> impl Iterator<Item = (FaceName, Face)> {
        let (small, large) = match self {
            Body::Solid(solid) => (Some(&solid.faces), None),
            Body::LargeStrain(solid) => (None, Some(&solid.faces)),
            _ => (None, None),
        };
        let small = small.into_iter().flatten().map(|(&name, face)| (name, *face));
        small.chain(large.into_iter().flatten().map(|(&name, face)| (name, face.heated())))
    }

    /// All temperatures that the scene names for the body and its surroundings [K].
    pub fn temperatures(&self) -> Vec<f64> {
        let own = match self {
            Body::Solid(solid) => solid.stress_free_temperature,
            Body::Droplet(_) | Body::LargeStrain(_) | Body::Lattice(_) => None,
            Body::Reservoir(reservoir) => reservoir.ambient,
            Body::Filament(filament) => filament.convection.map(|convection| convection.ambient),
        };
        let of_faces = self.faces().flat_map(|(_, face)| {
            let ambient = face.convection.map(|convection| convection.ambient);
            let around = face.radiation.map(|radiation| radiation.ambient);
            [face.temperature, ambient, around].into_iter().flatten()
        });
        of_faces.chain(own).chain([self.initial_temperature()]).collect()
    }

    /// The materials of the body and of its layers.
    pub fn materials(&self) -> Vec<&MaterialChoice> {
        let (material, layers) = match self {
            Body::Solid(solid) => (&solid.material, &solid.layers),
            Body::LargeStrain(solid) => (&solid.material, &solid.layers),
            Body::Droplet(_) | Body::Reservoir(_) | Body::Filament(_) | Body::Lattice(_) => {
                return Vec::new();
            }
        };
        let layers = layers.iter().flatten().map(|layer| &layer.material);
        material.iter().chain(layers).collect()
    }

    /// The materials of the body, each with the number of its layer.
    pub(super) fn materials_mut(&mut self) -> Vec<(Option<usize>, &mut MaterialChoice)> {
        let (material, layers) = match self {
            Body::Solid(solid) => (&mut solid.material, &mut solid.layers),
            Body::LargeStrain(solid) => (&mut solid.material, &mut solid.layers),
            Body::Droplet(_) | Body::Reservoir(_) | Body::Filament(_) | Body::Lattice(_) => {
                return Vec::new();
            }
        };
        let layers = layers.iter_mut().flatten().enumerate();
        let layers = layers.map(|(i, layer)| (Some(i), &mut layer.material));
        material.iter_mut().map(|own| (None, own)).chain(layers).collect()
    }

    /// The solid whose heat finite elements conduct, on a mesh that can be refined.
    fn meshed(&self) -> Option<&Solid> {
        match self {
            Body::Solid(solid) if solid.heat == HeatMethod::Fem => Some(solid),
            _ => None,
        }
    }
}

impl Scene {
    /// The body of that name if its mesh can be refined.
    pub fn meshed(&self, name: &str) -> Option<&Solid> {
        self.body.get(name)?.meshed()
    }

    /// The same, to be changed.
    pub fn meshed_mut(&mut self, name: &str) -> Option<&mut Solid> {
        match self.body.get_mut(name)? {
            Body::Solid(solid) if solid.heat == HeatMethod::Fem => Some(solid),
            _ => None,
        }
    }

    /// The bodies that probes and fields can read.
    pub fn with_fields(&self) -> impl Iterator<Item = (&str, &Body)> {
        let own = self.body.iter().filter(|(_, body)| body.resolves_fields());
        own.map(|(name, body)| (name.as_str(), body))
    }

    /// Returns true if a body has nodes or particles to draw: reduced solids and replayed drops have none.
    pub fn is_drawn(&self, name: &str) -> bool {
        !self.is_reduced(name) && !self.droplet(name).is_some_and(Droplet::is_replayed)
    }

    /// Returns true if drops fall in the scene.
    pub fn has_drops(&self) -> bool {
        self.droplets().next().is_some()
    }

    /// Returns true if units report the progress of a step, as those with drops do.
    pub fn reports_progress(&self) -> bool {
        self.has_drops()
    }

    /// Returns true if a body that falls or is laid transfers heat or force to a solid below.
    pub fn has_links(&self) -> bool {
        self.coupling.iter().any(|coupling| coupling.solid().is_some())
    }

    /// Returns true if heat and deformation of a solid obey linear equations.
    pub fn has_linear_solids(&self) -> bool {
        self.solids().any(|(_, solid)| {
            !takes_newton(self, solid) && solid.deforms_linearly() && !solid.cracks()
        })
    }

    /// Returns true if drops are repeated from records or closed forms.
    pub fn has_replayed_drops(&self) -> bool {
        self.droplets().any(|(_, droplet)| droplet.is_replayed())
    }

    /// Returns true if particles fill a body, which then takes inner steps, however long a step is.
    pub fn has_particles(&self) -> bool {
        let is_filled = |body: &Body| match body {
            Body::Solid(solid) => solid.heat == HeatMethod::Sph,
            Body::Droplet(_) => true,
            Body::LargeStrain(solid) => solid.is_above(),
            Body::Reservoir(_) | Body::Filament(_) | Body::Lattice(_) => false,
        };
        self.body.values().any(is_filled)
    }

    /// Returns true if a body may crack or come apart, which is an event.
    pub fn has_events(&self) -> bool {
        let may_break = |body: &Body| match body {
            Body::Solid(solid) => solid.cracks(),
            Body::Lattice(_) => true,
            Body::Droplet(_) | Body::LargeStrain(_) | Body::Reservoir(_) | Body::Filament(_) => {
                false
            }
        };
        self.body.values().any(may_break)
    }

    /// The bodies that have no extent, each with its description.
    pub fn lumps(&self) -> impl Iterator<Item = (&str, String)> {
        self.body.iter().filter_map(|(name, body)| Some((name.as_str(), body.lump()?)))
    }

    /// The drop that a coupling lets fall.
    pub fn drop_of(&self, coupling: &Coupling) -> Option<&Droplet> {
        self.droplet(&coupling.from)
    }

    /// The drop above a wall.
    pub fn drop_above(&self, wall: &Wall) -> Option<&Droplet> {
        self.droplet(&wall.under)
    }

    /// The drops that fall on a body.
    pub fn drops_on(&self, name: &str) -> impl Iterator<Item = (&Coupling, &Droplet)> {
        self.couplings_to(name).filter_map(|coupling| Some((coupling, self.drop_of(coupling)?)))
    }

    /// The solid that a coupling lets something act on, with its name.
    pub fn solid_below<'a>(&'a self, coupling: &'a Coupling) -> Option<(&'a str, &'a Solid)> {
        let name = coupling.solid()?;
        Some((name, self.solid(name)?))
    }

    /// The solid that a load acts on.
    pub fn solid_under(&self, load: &Load) -> Option<&Solid> {
        self.solid(load.body_and_face().0)
    }

    /// The points or cells at which a field of a checked scene is sampled.
    pub fn sampling(&self, field: &Field) -> Option<Sampling> {
        let (name, place) = field.body_and_place();
        match self.body.get(name)? {
            Body::Solid(solid) => Some(field.sampling(solid)),
            Body::LargeStrain(solid) => {
                Some(Sampling::Points(Grid::at(place, field, &solid.plate()?)))
            }
            _ => None,
        }
    }
}
