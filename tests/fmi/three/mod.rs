//! What FMI 3.0 has beside FMI 2.0, or in another way.

mod arrays;
mod derivatives;
mod early_return;
mod events;
mod fuzz;
mod instantiation;
mod life_cycle;
mod model_description;
mod refusals;
mod states;
