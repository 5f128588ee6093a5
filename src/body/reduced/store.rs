//! Known reductions: made once for equal keys, shared within a process, and stored in units.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::{ReducedBody, Reduction};
use crate::body::BodyError;
use crate::method::reduced::ReducedSystem;
use crate::runtime::sealed::{Content, Format, Reader};
use crate::runtime::shared_values::SharedValues;
use crate::scene::{FidelityLevel, MeshFactors, Naming, Scene, Solver};

/// Version of the reductions; to be raised when their contents change.
const VERSION: u32 = 2;

const REDUCTION: Format = Format { magic: b"IMPRED01", noun: "reduction", of: "a solid" };

static REDUCTIONS: SharedValues<String, Reduction> = SharedValues::new();

/// Keeps a reduction available to the models of this process while it is held.
#[derive(Clone)]
pub struct KeptReduction(Arc<Reduction>);

impl PartialEq for KeptReduction {
    /// Returns true if both are the same object.
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl ReducedBody {
    pub(super) fn kept(&self) -> KeptReduction {
        KeptReduction(Arc::clone(&self.reduction))
    }

    /// Returns the reduction as bytes, with its key; the scene is that of the body.
    pub fn to_bytes(&self, scene: &Scene) -> Vec<u8> {
        self.reduction.to_bytes(&key(scene, &self.name))
    }
}

/// Returns the reduction of a solid, which is made unless this process holds it.
pub fn known(
    scene: &Scene,
    name: &str,
    make: impl FnOnce() -> Result<Reduction, BodyError>,
) -> Result<Arc<Reduction>, BodyError> {
    REDUCTIONS.get_or_make(&key(scene, name), make)
}

/// Returns the reduction of a solid if this process holds it.
pub fn held(scene: &Scene, name: &str) -> Option<Arc<Reduction>> {
    REDUCTIONS.get(&key(scene, name))
}

/// Makes a reduction available to this process and refuses bytes that are damaged or describe no possible reduction.
/// Units with other solids make their own.
pub fn keep_reduction(bytes: &[u8]) -> Result<KeptReduction, String> {
    let (key, reduction) = Reduction::from_bytes(bytes)?;
    let reduction = REDUCTIONS.get_or_make(&key, || Ok::<_, String>(reduction))?;
    Ok(KeptReduction(reduction))
}

/// Drops all reductions that are no longer held.
pub fn forget_unused_reductions() {
    REDUCTIONS.forget_unused();
}

/// All data that determine a reduction: the scene without data of other bodies, and without names.
fn key(scene: &Scene, name: &str) -> String {
    let [along, through] = scene.refinement.get(name).map_or([1.0; 2], MeshFactors::factors);
    let mesh = MeshFactors::of([along, through]);
    let mut own = Scene {
        name: String::new(),
        description: String::new(),
        naming: Naming::default(),
        // Solids hold copies of their materials.
        material: BTreeMap::new(),
        refinement: [(name.to_owned(), mesh)].into(),
        solver: Solver { method: scene.solver.method, ..Solver::default() },
        ..scene.alone(name)
    };
    own.fidelity.level = FidelityLevel::Reduced;
    serde_json::to_string(&(VERSION, own)).unwrap_or_default()
}

impl Reduction {
    fn to_bytes(&self, key: &str) -> Vec<u8> {
        let mut content = Content::default();
        content.count(self.modes);
        self.system.put(&mut content);
        for numbers in [&self.offsets, &self.errors, &self.brought] {
            content.numbers(numbers.iter().copied());
        }
        REDUCTION.seal(key, &content)
    }

    fn from_bytes(bytes: &[u8]) -> Result<(String, Self), String> {
        let (key, found) = REDUCTION.open(bytes, Self::read)?;
        let checked = found.check();
        checked
            .map_err(|reason| format!("the reduction is none that this program makes: {reason}"))?;
        Ok((key, found))
    }

    fn read(reader: &mut Reader) -> Option<Self> {
        let modes = reader.whole()?;
        let system = ReducedSystem::read(reader)?;
        let (outputs, inputs) = (system.outputs, system.inputs);
        let [offsets, errors] = [reader.numbers(outputs)?, reader.numbers(outputs)?];
        Some(Self { offsets, errors, brought: reader.numbers(inputs)?, system, modes })
    }

    fn check(&self) -> Result<(), String> {
        self.system.check()?;
        let numbers = [&self.offsets, &self.errors, &self.brought];
        if let Some(value) = numbers.into_iter().flatten().find(|value| !value.is_finite()) {
            return Err(format!("{value} is no finite number"));
        }
        match self.errors.iter().find(|error| **error < 0.0) {
            Some(error) => Err(format!("{error} as an error")),
            None => Ok(()),
        }
    }

    /// Refuses a reduction whose numbers of drives and values differ from the body's.
    pub(super) fn fits(&self, name: &str, [inputs, outputs]: [usize; 2]) -> Result<(), BodyError> {
        let own = [self.system.inputs, self.system.outputs];
        if own == [inputs, outputs] {
            return Ok(());
        }
        let message = format!(
            "the stored reduction of {name} is of {} inputs and {} outputs, where this body has {inputs} and {outputs}",
            own[0], own[1]
        );
        Err(BodyError::Reduction { message })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reduction() -> Reduction {
        let system = ReducedSystem {
            inputs: 1,
            outputs: 2,
            rates: vec![0.0, 3.0],
            turns: vec![0.0; 2],
            entering: vec![1.0, 2.0],
            leaving: vec![1.0, 2.0, 3.0, 4.0],
            direct: vec![0.0; 2],
            bounds: vec![1e-3; 2],
            ranges: vec![1.0; 2],
        };
        Reduction {
            system,
            offsets: vec![0.0, 300.0],
            brought: vec![2.0],
            errors: vec![1e-3; 2],
            modes: 1 << 40,
        }
    }

    #[test]
    fn reductions_round_trip_and_forged_ones_are_refused() {
        let bytes = reduction().to_bytes("a plate");
        assert_eq!(Reduction::from_bytes(&bytes), Ok(("a plate".to_owned(), reduction())));
        let forged = [
            Reduction { errors: vec![-0.5, 0.0], ..reduction() },
            Reduction { brought: vec![f64::NAN], ..reduction() },
            // One number is missing, so all following numbers are misplaced.
            Reduction { errors: vec![0.0], ..reduction() },
            Reduction { offsets: vec![0.0; 3], ..reduction() },
        ];
        for forged in forged {
            assert!(keep_reduction(&forged.to_bytes("a plate")).is_err(), "{forged:?}");
        }
        assert!(reduction().fits("plate", [1, 2]).is_ok());
        let refused = reduction().fits("plate", [2, 2]).unwrap_err().to_string();
        assert!(
            refused.contains("1 inputs and 2 outputs, where this body has 2 and 2"),
            "{refused}"
        );
    }
}
