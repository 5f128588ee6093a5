//! The C ABI as a master sees it: the built library is loaded and driven through its symbols.

mod bounds;
mod derivatives;
mod droplets;
mod endurance;
mod exports;
mod forged;
mod functions;
mod fuzz;
mod header;
mod hosts;
mod instantiation;
mod life_cycle;
mod logging;
mod long_steps;
mod master;
mod model_description;
mod peaks;
mod records;
mod reduced;
mod refusals;
mod state_bytes;
mod states;
mod stepping;
mod threads;
mod three;
mod tunable;
