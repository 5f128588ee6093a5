//! Whether a scene fits into the memory that there is, before anything large is built.

use super::{Forecast, ModelError, forecast};
use crate::scene::Scene;

impl Forecast {
    /// Memory of all bodies [B].
    pub fn memory(&self) -> f64 {
        self.needs().iter().map(|need| need.memory).sum()
    }

    fn needs(&self) -> Vec<Need<'_>> {
        let solids = self.bodies.iter().map(|body| {
            let unknowns: f64 = body.unknowns.iter().map(|&count| count as f64).sum();
            Need {
                name: &body.name,
                memory: body.memory,
                size: format!("{unknowns:.2e} unknowns"),
                remedy: "a larger `mesh.spacing`",
            }
        });
        let droplets = self.droplets.iter().map(|droplet| Need {
            name: &droplet.name,
            memory: droplet.memory,
            size: format!("{:.2e} particles", droplet.particles as f64),
            remedy: "a larger `spacing`",
        });
        solids.chain(droplets).collect()
    }
}

/// What a body asks for.
struct Need<'a> {
    name: &'a str,
    /// [B]
    memory: f64,
    size: String,
    remedy: &'static str,
}

/// Refuses a scene that is forecast to need more memory than is `available` [B].
pub fn check_memory(scene: &Scene, available: f64) -> Result<(), ModelError> {
    let forecast = forecast(scene);
    let needed = forecast.memory();
    // Numbers that are none are too many, too.
    if needed <= available {
        return Ok(());
    }
    let needs = forecast.needs().into_iter();
    let most = needs.max_by(|a, b| a.memory.total_cmp(&b.memory)).expect("a body needs it");
    Err(ModelError::Memory {
        needed,
        available,
        body: most.name.to_owned(),
        size: most.size,
        remedy: most.remedy,
    })
}
