//! Elements along z of bodies that are made of layers.
//!
//! Heat that has come through a layer spreads in the next one over `√(a₂/a₁)` times the distance. So a mesh
//! that is graded along z in a body of one material is so along `∫ dz/√a` in one of several: sizes jump at an
//! interface as √a does, and grow from there as before.

use super::Fineness;
use crate::method::fem::grading::{Fine, graded_ends};
use crate::method::mesh::Layering;
use crate::scene::{FaceName, Shape, Stratum};

impl Fineness<'_> {
    pub(super) fn ends_in_layers(&self, strata: &[Stratum]) -> (Vec<f64>, Layering) {
        let mut ends = vec![strata[0].z[0]];
        let mut starts = Vec::new();
        for (i, layer) in strata.iter().enumerate() {
            if i > 0 {
                starts.push(ends.len() - 1);
            }
            let [bottom, top] = layer.z;
            let fine = self.fine_in(strata, i);
            let coarsest = self.coarsest_in(layer, &fine) / self.factors[1];
            let own = graded_ends(bottom, top, &super::finer(&fine, self.factors[1]), coarsest);
            ends.extend_from_slice(&own[1..]);
        }
        // The contact of a layer with the one above is stored with the lower layer.
        let resistances = strata.iter().take(starts.len()).map(|layer| layer.contact_resistance);
        let resistances = resistances.collect();
        (ends, Layering::new(starts, resistances))
    }

    /// Largest element of a layer.
    fn coarsest_in(&self, layer: &Stratum, fine: &[Fine]) -> f64 {
        // Two quadratic elements, three linear ones.
        let fewest = 4 - self.order.min(2);
        let most = layer.thickness() / fewest as f64;
        let keys = self.keys();
        let size = self.order as f64 * keys.depth_spacing.or(keys.spacing).unwrap_or(self.lateral);
        let least = fine.iter().map(|f| f.size).fold(size, f64::min);
        let usual = (self.solid.shape.thickness() / super::THICKNESS_ELEMENTS).max(least);
        self.coarsest(usual, least).min(most)
    }

    /// Stretches of a layer with fine elements.
    fn fine_in(&self, strata: &[Stratum], index: usize) -> Vec<Fine> {
        let thickness = self.solid.shape.thickness();
        let keys = self.keys();
        let named = keys.depth_spacing.or(keys.spacing);
        let size = self.order as f64 * named.unwrap_or(self.lateral);
        let mut fine = self.fine_at_ends(size, |top, _| self.below(strata, index, top, named));
        if self.heats_sides() {
            // Layers warm up at different rates, so heat passes between them from the beginning.
            let own = self.size_in(&strata[index], named);
            let [bottom, top] = strata[index].z;
            let meets =
                |low: usize| low + 1 < strata.len() && differ(&strata[low], &strata[low + 1]);
            let low = index.checked_sub(1).is_some_and(meets).then_some(bottom);
            let high = meets(index).then_some(top);
            fine.extend(low.into_iter().chain(high).map(|z| self.graded_from(z, own)));
        }
        if fine.is_empty() && keys.depth_spacing.is_some() {
            fine.push(self.stretch([-thickness, 0.0], size));
        }
        fine
    }

    /// Elements of a layer for heat that enters through the top or the bottom, past the layers in between.
    fn below(&self, strata: &[Stratum], index: usize, top: bool, named: Option<f64>) -> Fine {
        let root = |layer: &Stratum| layer.constants.diffusivity().sqrt();
        let (first, between) = match top {
            true => (&strata[strata.len() - 1], &strata[index + 1..]),
            false => (&strata[0], &strata[..index]),
        };
        let way: f64 = between.iter().map(|layer| layer.thickness() / root(layer)).sum();
        let fine = self.graded_from(0.0, 0.0);
        let size = self.size_in(first, named) / root(first) + (fine.growth - 1.0) * way;
        let z = if top { strata[index].z[1] } else { strata[index].z[0] };
        self.graded_from(z, root(&strata[index]) * size)
    }

    /// Size of the first element below a heated face of a layer.
    fn size_in(&self, layer: &Stratum, named: Option<f64>) -> f64 {
        let reach = (layer.constants.diffusivity() * self.shortest).sqrt();
        let finest = super::FINEST * layer.thickness();
        let chosen = self.lateral.min(reach / super::NODES_PER_DIFFUSION_LENGTH).max(finest);
        self.order as f64 * named.unwrap_or(chosen)
    }

    fn graded_from(&self, z: f64, size: f64) -> Fine {
        let growth = self.layer_at(z, self.keys().depth_spacing.or(self.keys().spacing)).growth;
        Fine { from: z, to: z, size, growth }
    }

    /// Returns true if heat passes a lateral face.
    fn heats_sides(&self) -> bool {
        let faces: &[FaceName] = match self.solid.shape {
            Shape::Box(_) => &[FaceName::Left, FaceName::Right, FaceName::Front, FaceName::Back],
            Shape::Disc(_) => &[FaceName::Sides],
        };
        faces.iter().any(|&face| self.is_heated(face))
    }
}

/// Returns true if heat conduction differs between two layers.
fn differ(a: &Stratum, b: &Stratum) -> bool {
    a.constants.diffusivity() != b.constants.diffusivity()
        || a.constants.conductivity != b.constants.conductivity
}
