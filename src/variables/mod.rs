//! The registry: every variable of a unit once, with name, unit, causality, start value and meaning. XML, get and set,
//! CSV headers and documentation are all generated from it. [`ArrayRegistry`] lists the same variables with each family
//! `name[i,j]` as one array.

mod arrays;
mod cells;
mod dependencies;
mod inputs;
mod outputs;
mod parameter;
mod parameters;
mod plausibility;
mod registry;

pub use crate::inputs::InputLayout;
pub use crate::laws::MaterialConstant;
pub use crate::quantity::{DisplayUnit, Quantity};
pub use arrays::{ArrayRegistry, ArrayVariable, Content};
pub use cells::CellFamily;
pub use dependencies::{followed_inputs, follows_nothing};
pub use parameter::Parameter;
pub use registry::{Causality, Output, Registry, Slot, Value, Variable};
