//! Predicts whether a solid may melt, which determines the cost of its heat.

use std::f64::consts::PI;

use crate::laws::{Conduction, Melting};
use crate::scene::{Face, Load, Scene, Solid};

/// Returns true unless all initial loads are known to keep the solid below every solidus.
///
/// Loads without a heat flux in the scene may carry any flux later.
pub fn may_melt(scene: &Scene, name: &str, solid: &Solid) -> bool {
    let heat = Heat::on(scene, name, solid);
    solid.materials_of_layers().into_iter().any(|material| {
        let melts =
            |melting: &Melting| heat.hottest(&material.heat, scene.stop_time) >= melting.solidus;
        material.heat.melting.as_ref().is_some_and(melts)
    })
}

/// Heating of a solid: the highest temperature in contact with it [K], and its fluxes [W/m²] with their radii [m].
struct Heat {
    hottest: f64,
    fluxes: Vec<(f64, f64)>,
    /// Area of the top [m²].
    area: f64,
    /// Heat capacity of the whole body [J/K].
    capacity: f64,
}

/// Temperatures of bodies that touch a solid, and of their faces [K].
pub fn temperatures_in_contact<'s>(
    scene: &'s Scene,
    name: &'s str,
) -> impl Iterator<Item = f64> + use<'s> {
    let touched = scene.coupling.iter().filter_map(move |coupling| {
        let ends = [coupling.lower()?.0, coupling.upper()?.0];
        Some(ends[1 - ends.iter().position(|&end| end == name)?])
    });
    touched.flat_map(move |other| {
        let solid = scene.solid(other);
        let of_faces = solid.into_iter().flat_map(|solid| {
            let faces = solid.shape.faces().iter();
            faces.flat_map(|&face| temperatures_of(&solid.face(face)))
        });
        let of_reservoir = scene.reservoir(other).map(|own| own.initial_temperature);
        of_faces.chain(solid.map(|solid| solid.initial_temperature)).chain(of_reservoir)
    })
}

impl Heat {
    fn on(scene: &Scene, name: &str, solid: &Solid) -> Self {
        let faces: Vec<Face> = solid.shape.faces().iter().map(|&face| solid.face(face)).collect();
        let droplets =
            scene.couplings_to(name).filter_map(|coupling| scene.droplet(&coupling.from));
        let hottest = faces
            .iter()
            .flat_map(temperatures_of)
            .chain(droplets.map(|droplet| droplet.initial_temperature))
            .chain(temperatures_in_contact(scene, name))
            .fold(solid.initial_temperature, f64::max);
        let of_faces = faces.iter().filter_map(|face| Some((face.flux?, f64::INFINITY)));
        let of_loads = scene.loads_on(name).filter(|load| load.heats()).map(flux_of);
        let fluxes = of_faces.chain(of_loads).collect();
        Self { hottest, fluxes, area: solid.top_area(), capacity: solid.heat_capacity() }
    }

    /// Temperature at the centre of all fluxes together after a time [K]. Each contributes `q/k · min(2√(at/π), R)`: a
    /// half space under a uniform flux, and the steady state under a disc. The body as a whole warms by the heat over its
    /// capacity.
    fn hottest(&self, conduction: &Conduction, time: f64) -> f64 {
        let least = |values: &[f64]| values.iter().copied().fold(f64::INFINITY, f64::min);
        let conductivity = least(conduction.conductivity.values());
        let capacity = conduction.density * least(conduction.specific_heat.values());
        let depth = 2.0 * (conductivity / capacity * time / PI).sqrt();
        let rise = |(flux, radius): &(f64, f64)| flux / conductivity * depth.min(*radius);
        let power = |(flux, radius): &(f64, f64)| flux * self.area.min(PI * radius * radius);
        let whole = self.fluxes.iter().map(power).sum::<f64>() * time / self.capacity;
        self.hottest + self.fluxes.iter().map(rise).sum::<f64>() + whole.max(0.0)
    }
}

/// Temperatures that a face has or is surrounded by [K].
pub fn temperatures_of(face: &Face) -> impl Iterator<Item = f64> + use<> {
    let ambient = face.convection.as_ref().map(|convection| convection.ambient);
    let surroundings = face.radiation.as_ref().map(|radiation| radiation.ambient);
    [face.temperature, ambient, surroundings].into_iter().flatten()
}

/// Heat flux of a load [W/m²] and its radius [m]; the flux is infinite if the scene does not set it.
fn flux_of(load: &Load) -> (f64, f64) {
    let values = load.start_fluxes().map_or(Vec::new(), |(_, values)| values);
    let most = values.into_iter().fold(0.0, f64::max);
    let [x, y] = load.footprint.half_extents(load.start.radius);
    (if most > 0.0 { most } else { f64::INFINITY }, load.footprint.reach() * x.max(y))
}
