//! The registry: every variable of a unit once, with name, unit, causality, start value and what it
//! stands for. XML, get and set, CSV headers and documentation are all made from it.
//! [`ArrayRegistry`] lists the same variables with each family `name[i,j]` as one array.

mod arrays;
mod doubt;
mod droplet;
mod layout;
mod layers;
mod parameter;
mod quantity;
mod registry;

pub use arrays::{ArrayRegistry, ArrayVariable, Content};
pub use droplet::{DropletConstant, DropletTotal, WallOutput};
pub use layout::{FaceInput, FaceInputKind, InputLayout, LoadInputs};
pub use parameter::{LayersOf, MaterialConstant, Parameter};
pub use quantity::{DisplayUnit, Quantity};
pub use registry::{BodyTotal, Causality, Component, Output, Registry, Slot, Value, Variable};
