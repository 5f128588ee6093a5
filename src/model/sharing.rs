//! Units of one process that have equal scenes share one immutable model.

use std::sync::Arc;

use super::tolerance::{self, Resolved};
use super::{Model, ModelError, check_memory};
use crate::body::{forget_unused_records, forget_unused_reductions};
use crate::method::fem::forget_unused_stiffness;
use crate::runtime::shared_values::SharedValues;
use crate::runtime::thread::aside;
use crate::scene::Scene;

static MODELS: SharedValues<Scene, Model> = SharedValues::new();

impl Model {
    /// Returns the model of `scene`, which is built unless another holder in this process already has it. Callers for
    /// the same model wait meanwhile; callers for another do not. A model that needs more memory than is `available`
    /// [B] is not built.
    pub fn shared(scene: &Scene, threads: usize, available: f64) -> Result<Arc<Model>, ModelError> {
        aside(|| {
            let Resolved { scene, choices } = tolerance::resolve(scene);
            MODELS.get_or_make(&scene, || {
                check_memory(&scene, available)?;
                Ok(Model { choices, ..Model::build_as_it_is(&scene, threads)? })
            })
        })
    }

    /// Drops scenes whose models are no longer held.
    pub fn forget_unused() {
        MODELS.forget_unused();
        forget_unused_stiffness();
        forget_unused_records();
        forget_unused_reductions();
        tolerance::forget_unused();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::parse;

    const SCENE: &str = include_str!("../../tests/fmi/scene.toml");
    const ENOUGH: f64 = 1e9;

    #[test]
    fn equal_scenes_have_one_model_as_long_as_somebody_holds_it() {
        let scene = parse(SCENE, "scene.toml").unwrap();
        let first = Model::shared(&scene, 1, ENOUGH).unwrap();
        let second = Model::shared(&scene, 1, ENOUGH).unwrap();
        assert!(Arc::ptr_eq(&first, &second), "the second holder built nothing");
        let mut warmer = scene.clone();
        warmer.name = "Other".into();
        let other = Model::shared(&warmer, 1, ENOUGH).unwrap();
        assert!(!Arc::ptr_eq(&first, &other));
        let weak = Arc::downgrade(&first);
        drop((first, second));
        assert!(weak.upgrade().is_none(), "nobody holds the model");
    }

    #[test]
    fn models_that_differ_in_what_concerns_heat_share_their_stiffness() {
        let scene = parse(SCENE, "scene.toml").unwrap();
        let built = |edit: fn(&mut crate::laws::Material)| {
            let mut scene = scene.clone();
            let solid = scene.meshed_mut("plate").unwrap();
            solid.mesh.depth_spacing = Some(2e-5);
            edit(solid.material.as_mut().unwrap().material_mut());
            Model::build(&scene, 1).unwrap()
        };
        let first = built(|_| {});
        let denser = built(|material| material.heat.density *= 2.0);
        let stiffer = built(|material| *material.number("young").unwrap() = 2e11);
        assert!(Arc::ptr_eq(&first.stiffness()[0], &denser.stiffness()[0]));
        assert!(!Arc::ptr_eq(&first.stiffness()[0], &stiffer.stiffness()[0]));
    }

    #[test]
    fn only_a_model_that_is_to_be_built_asks_for_memory() {
        let mut scene = parse(SCENE, "scene.toml").unwrap();
        scene.name = "Large".into();
        let refused = Model::shared(&scene, 1, 1e3).err().unwrap();
        assert!(matches!(refused, ModelError::Memory { .. }), "{refused}");
        let first = Model::shared(&scene, 1, ENOUGH).unwrap();
        assert!(Arc::ptr_eq(&first, &Model::shared(&scene, 1, 1e3).unwrap()));
    }

    #[test]
    fn concurrent_callers_share_one_model() {
        let mut scene = parse(SCENE, "scene.toml").unwrap();
        scene.name = "AtOnce".into();
        let models: Vec<Arc<Model>> = std::thread::scope(|scope| {
            let ask = |_| scope.spawn(|| Model::shared(&scene, 1, ENOUGH).unwrap());
            let asked: Vec<_> = (0..4).map(ask).collect();
            asked.into_iter().map(|thread| thread.join().unwrap()).collect()
        });
        assert!(models.iter().all(|model| Arc::ptr_eq(model, &models[0])));
    }
}
