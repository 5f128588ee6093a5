//! The C ABI as a master sees it: the built library is loaded and driven through its symbols.

mod exports;
mod fuzz;
mod instantiation;
mod life_cycle;
mod logging;
mod master;
mod model_description;
mod refusals;
mod stepping;
mod threads;
