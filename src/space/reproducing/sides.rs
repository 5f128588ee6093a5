//! Sets of sides.

use super::super::Side;

/// A set of sides of a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Sides(u8);

impl Sides {
    pub fn of(sides: &[Side]) -> Self {
        Self(sides.iter().fold(0, |set, &side| set | 1 << side as u8))
    }

    pub fn contains(self, side: Side) -> bool {
        self.0 & 1 << side as u8 != 0
    }
}
