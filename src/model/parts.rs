//! Steps that are taken in parts, so that a host can follow their progress.

use super::{Cache, Model, ModelError, State};
use crate::runtime::allowance::{Allowance, PART_UPDATES};

impl Model {
    /// Number of parts into which a step of `dt` [s] is cut for a host that follows its progress. Bodies that take any
    /// step at the same cost do not count.
    pub fn parts(&self, dt: f64) -> f64 {
        let updates: f64 = self.bodies.iter().map(|body| body.updates(dt)).sum();
        (updates / PART_UPDATES).ceil().max(1.0)
    }

    /// Refuses a step of `dt` [s] that would exceed the allowed work.
    pub fn foresee(&self, state: &State, dt: f64, allowance: &Allowance) -> Result<(), ModelError> {
        let mut bodies = self.bodies.iter().zip(&state.bodies);
        Ok(bodies.try_for_each(|(body, unknowns)| body.foresee(unknowns, dt, allowance))?)
    }

    /// Advances by `dt` [s] as a further part of the last step, whose rest is `ahead` [s]: means over the last step
    /// then cover all its parts.
    pub fn step_on(
        &self,
        allowance: &Allowance,
        state: &mut State,
        cache: &mut Cache,
        (dt, ahead): (f64, f64),
    ) -> Result<(), ModelError> {
        let before = state.bodies.clone();
        self.step_within(allowance, state, cache, (dt, ahead))?;
        for ((body, before), state) in self.bodies.iter().zip(&before).zip(&mut state.bodies) {
            body.join_steps(before, state);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene;

    /// A body with further keys.
    fn model(keys: &str) -> Model {
        let text = format!("name = \"One\"\nstop_time = 1.0\nstep = 0.1\n[body.one]\n{keys}");
        let scene = scene::parse(&text, "scene.toml").unwrap_or_else(|error| panic!("{error}"));
        Model::build(&scene, 1).unwrap_or_else(|error| panic!("{error}"))
    }

    #[test]
    fn equilibria_implicit_steps_and_lines_cut_no_step() {
        let solid = r#"
kind = "solid"
strain = "finite"
dimension = 2
shape = { box = [2e-3, 1e-3, 1e-3] }
initial_temperature = 293.15
material = { model = "neo_hookean", density = 1000.0, specific_heat = 1900.0, conductivity = 0.2, young = 1e6, poisson = 0.4 }
mesh = { spacing = 1e-3 }
"#;
        let held = "faces.bottom = { clamped = true }";
        let lattice = r#"
kind = "lattice"
length = 0.1
depth = 0.05
thickness = 0.05
spacing = 1e-2
support = "ends"
material = { density = 2300.0, young = 30e9, poisson = 0.2, softening = { model = "openings", strength = 4.5e6, openings = [9.05e-6, 2e-5], share = 0.13 } }
"#;
        let line = r#"
kind = "filament"
fluid = { density = 1e3, viscosity = 1.0, specific_heat = 1e3, conductivity = 0.2 }
nozzle = { diameter = 1e-3, height = 2e-3, temperature = 300.0 }
most = 1e-6
path = { time = [0.0, 1.0], x = [0.0, 5e-3], y = [0.0, 0.0] }
"#;
        let at_rest = format!("{solid}{held}");
        let implicit = format!("{solid}inertia = true\nmotion = \"implicit\"\n{held}");
        for keys in [&at_rest[..], &implicit, lattice, line] {
            let updates = model(keys).bodies[0].updates(1.0);
            assert_eq!(updates, 0.0, "{keys}");
        }
        let explicit = model(&format!("{solid}inertia = true"));
        assert!(explicit.parts(1.0) > 1.0);
    }
}
