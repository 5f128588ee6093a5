//! Stress that kernels and particles read wrongly where a material hardly changes its volume.

use super::Reviewer;
use crate::scene::locate::Path;
use crate::scene::{Gives, KernelIntegration, LargeStrain, Mechanics};
use crate::warning;

pub fn review(reviewer: &mut Reviewer) {
    let scene = reviewer.scene;
    for (name, _) in scene.large_strains().filter(|(_, solid)| has_swinging_pressure(solid)) {
        let probes = scene.probe.iter().map(|probe| (probe.body.as_str(), &probe.gives));
        let fields = scene.field.iter().map(|field| (field.body_and_place().0, &field.gives));
        let probes = probes.enumerate().map(|(place, own)| ("probe", place, own));
        let fields = fields.enumerate().map(|(place, own)| ("field", place, own));
        let reads = |(_, _, (body, gives)): &(_, _, (&str, &Vec<Gives>))| {
            *body == name && gives.iter().any(has_pressure)
        };
        if let Some((kind, place, _)) = probes.chain(fields).find(reads) {
            let path = Path::default().key(kind).index(place).key("gives");
            reviewer.warn(&path, warning::pressure_is_spurious(name));
        }
    }
}

fn has_pressure(gives: &Gives) -> bool {
    matches!(gives, Gives::Stress | Gives::MaxPrincipal)
}

/// Returns true if the points of a body hardly change their volume, and pressure swings from one to the next. A sheet
/// has the pressure that its free faces leave.
fn has_swinging_pressure(solid: &LargeStrain) -> bool {
    let swings = match solid.mechanics {
        Mechanics::Fem => false,
        Mechanics::Rkpm => solid.rkpm.unwrap_or_default().integration != KernelIntegration::Gauss,
        Mechanics::Efg | Mechanics::Sph => true,
    };
    let temperature = solid.initial_temperature;
    let materials = solid.materials_of_layers();
    let mut laws =
        materials.iter().filter_map(|own| own.law.deformation().large_strain(temperature));
    swings && !solid.is_sheet() && laws.any(|law| law.is_nearly_incompressible())
}
