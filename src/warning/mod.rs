//! Warnings: one table of rules with the texts that users see. The test of a rule is next to the code that it examines:
//! in `advice` for scenes, in `body` for running bodies, in `model` for meshes and steps.
//!
//! Every warning reads `place: what is wrong, with the number; remedy [id]`.

mod drops;
mod rule;
mod runs;
mod scenes;

pub use drops::*;
pub use rule::{Finding, Rule, Warning, When};
pub use runs::*;
pub use scenes::*;

/// All rules, in the order of the page `docs/warnings.md`.
pub fn table() -> impl Iterator<Item = &'static Rule> {
    [scenes::TABLE, drops::TABLE, runs::TABLE].into_iter().flatten()
}
