//! FMI 3.0: the same library driven through its other symbols.

mod arrays;
mod derivatives;
mod early_return;
mod exports;
mod fuzz;
mod instantiation;
mod life_cycle;
pub mod master;
mod model_description;
mod refusals;
mod states;
