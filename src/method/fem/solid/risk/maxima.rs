//! Running maxima of the equivalent stress at the nodes.

use super::Flaws;
use super::patch::Patch;
use crate::method::fem::solid::SolidFem;
use crate::method::mesh::Mesh;

/// Share of the largest equivalent stress below which tension may be rounding.
const NEGLIGIBLE: f64 = 1e-6;
/// Share of the largest tension of a node by which tension may differ that meets it, and least share of tension that
/// flaws have grown under which is there at the moment.
const ROUNDING: f64 = 1e-9;
const PRESENT: f64 = 0.5;

/// Present tension of a patch beside its running maxima.
struct Rise {
    /// The largest tension so far, zero for none, and the larger of it and the present one.
    before: f64,
    after: f64,
    /// True if a node meets its largest tension now, and if all nodes with tension do.
    is_met: bool,
    is_met_by_all: bool,
}

impl Rise {
    /// Compares running maxima with values of now; up to `least` there is no tension. Those of flaws that have grown
    /// exceed the present stress.
    fn of(mesh: &Mesh, patch: &Patch, [noted, now, present]: [&[f64]; 3], least: f64) -> Self {
        let mut own = Self { before: 0.0, after: 0.0, is_met: false, is_met_by_all: true };
        patch.for_nodes(mesh, |_, node| {
            let (noted, now) = (noted[node], now[node]);
            let is_present = present[node] >= PRESENT * now;
            let is_met = now >= noted * (1.0 - ROUNDING) && is_present;
            own.is_met |= is_met && now > 0.0;
            own.after = own.after.max(noted).max(now);
            if noted > least {
                own.before = own.before.max(noted);
                own.is_met_by_all &= is_met;
            }
        });
        own
    }

    /// The value of a node without tension under which the tension so far has its share of the risk: all of it where
    /// only a part of the nodes meets its largest one. Otherwise the largest value T has grown by a factor g. Between
    /// it and a negative value v, over the part `T/(T − v)` of the length, the share is as `T^(m+1)/(T − v)`, so that v
    /// falls to `gT − g^(m+1) (T − v)`.
    fn reach(&self, modulus: f64) -> impl Fn(f64) -> f64 {
        let Self { before, after, is_met_by_all, .. } = *self;
        let after = if is_met_by_all { after } else { before };
        let growth = (after / before).powf(modulus + 1.0);
        move |value| match before > 0.0 {
            true if growth == 1.0 => value,
            true => after - growth * (before - value),
            false => f64::NEG_INFINITY,
        }
    }
}

impl SolidFem {
    /// Updates running maxima of the equivalent stress to the present one. Tension keeps its largest value. Where none
    /// has been, the continued value says how far tension reaches from the other nodes of the same element. It follows
    /// the present one when these meet their largest tension, as far as [`Rise::reach`] says, so that both belong
    /// together; `nothing` marks nodes before the first update. Flaws that grow have more than the present stress.
    pub fn note_largest(
        &self,
        flaws: &Flaws,
        noted: &mut [f64],
        [now, present]: [&[f64]; 2],
        nothing: f64,
    ) {
        let nodes = self.mesh.sided_nodes();
        let (mut rises, mut least_reach) = (vec![false; nodes], vec![f64::NEG_INFINITY; nodes]);
        let images = now.chunks_exact(nodes).zip(present.chunks_exact(nodes));
        for (noted, (now, present)) in noted.chunks_exact_mut(nodes).zip(images) {
            let largest = noted.iter().chain(now).fold(0.0_f64, |most, value| most.max(*value));
            let least = NEGLIGIBLE * largest;
            rises.fill(false);
            least_reach.fill(f64::NEG_INFINITY);
            for patch in &flaws.patches {
                let rise = Rise::of(&self.mesh, patch, [noted, now, present], least);
                let reach = rise.reach(flaws.of_patch(patch).modulus);
                patch.for_nodes(&self.mesh, |_, node| {
                    rises[node] |= rise.is_met;
                    least_reach[node] = least_reach[node].max(reach(noted[node]));
                });
            }
            for (node, (noted, &now)) in noted.iter_mut().zip(now).enumerate() {
                if *noted == nothing || now > noted.max(0.0) {
                    *noted = now;
                } else if *noted <= least && rises[node] {
                    *noted = now.max(least_reach[node].min(*noted));
                }
            }
        }
    }
}
