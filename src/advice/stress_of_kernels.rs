//! Stress that kernels and particles read wrongly where a material hardly changes its volume.

use super::Reviewer;
use crate::scene::locate::Path;
use crate::scene::{Gives, KernelIntegration, LargeStrain, Mechanics, Probe};
use crate::warning;

pub fn review(reviewer: &mut Reviewer) {
    let scene = reviewer.scene;
    for (name, _) in scene.large_strains().filter(|(_, solid)| has_pressure_of_its_own(solid)) {
        let reads = |probe: &Probe| {
            probe.body == name
                && probe
                    .gives
                    .iter()
                    .any(|gives| matches!(gives, Gives::Stress | Gives::MaxPrincipal))
        };
        if let Some(place) = scene.probe.iter().position(reads) {
            let path = Path::default().key("probe").index(place).key("gives");
            reviewer.warn(&path, warning::pressure_is_spurious(name));
        }
    }
}

/// Returns true if the points of a body hardly change their volume, and pressure swings from one to the next.
fn has_pressure_of_its_own(solid: &LargeStrain) -> bool {
    let swings = match solid.mechanics {
        Mechanics::Fem => false,
        Mechanics::Rkpm => solid.rkpm.unwrap_or_default().integration != KernelIntegration::Gauss,
        Mechanics::Efg | Mechanics::Sph => true,
    };
    let temperature = solid.initial_temperature;
    let materials = solid.materials_of_layers();
    let mut laws =
        materials.iter().filter_map(|own| own.law.deformation().large_strain(temperature));
    swings && laws.any(|law| law.is_nearly_incompressible())
}
