//! Groups of keys that laws share: a material's table is the union of its parts.

use schemars::JsonSchema;
use serde::de::DeserializeOwned;

use super::{MaterialConstant, Property};

/// A group of related constants of a scene, such as those of elasticity.
pub trait Part {
    /// Rows of the constants that units offer as parameters.
    fn parameters() -> &'static [MaterialConstant]
    where
        Self: Sized,
    {
        &[]
    }

    /// The given constants that may be tables over the temperature, each with its key.
    fn properties(&self) -> Vec<(&'static str, &Property)> {
        Vec::new()
    }

    /// The number that the scene gives for a key; `None` if the part has no such key, or a table stands there.
    fn number(&mut self, _key: &str) -> Option<&mut f64> {
        None
    }
}

/// Operation on every part of a material, by type.
pub trait PartVisitor {
    fn part<P: Part + DeserializeOwned + JsonSchema>(&mut self);
}

/// Returns the constant of a key, if it is a number.
pub fn number_among<'p, const N: usize>(
    key: &str,
    constants: [(&str, Option<&'p mut Property>); N],
) -> Option<&'p mut f64> {
    constants.into_iter().find(|(own, _)| *own == key)?.1?.number()
}
