//! Totals of heat that methods of conduction keep at the end of their states.

use crate::state::{Field, Layout, Per};

/// Heat that has passed since time zero [J], or in some time.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct HeatTotals {
    pub brought_in: f64,
    pub lost: f64,
}

impl HeatTotals {
    const BROUGHT_IN: Field = Self::field("brought_in", "heat brought in since time zero [J]");
    const LOST: Field = Self::field("lost", "heat lost since time zero [J]");

    const fn field(name: &'static str, words: &'static str) -> Field {
        Field { name, words, per: Per::Body, width: 1 }
    }

    /// A layout that ends with the totals since time zero.
    pub fn at_end_of(layout: Layout) -> Layout {
        layout.with(Self::BROUGHT_IN, 1).with(Self::LOST, 1)
    }

    /// The totals at the end of a state.
    pub fn read(state: &[f64]) -> Self {
        let &[.., brought_in, lost] = state else { return Self::default() };
        Self { brought_in, lost }
    }

    /// The totals of so many copies of a body.
    pub fn times(&self, copies: f64) -> Self {
        Self { brought_in: copies * self.brought_in, lost: copies * self.lost }
    }

    /// Adds these totals to those at the end of a state.
    pub fn add_to(&self, state: &mut [f64]) {
        if let [.., brought_in, lost] = state {
            *brought_in += self.brought_in;
            *lost += self.lost;
        }
    }
}
