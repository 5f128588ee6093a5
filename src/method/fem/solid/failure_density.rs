//! Failure density of a body of brittle material at a point: `h/V₀ = (s/σ₀)^m / V₀` over flaws in the volume [1/m³],
//! `h/A₀` over those of its faces [1/m²]. Its integral is the risk B.

use super::risk::Flaws;
use super::{SolidFem, weighted};
use crate::laws::{Extent, FlawStatistics};
use crate::method::mesh::Mesh;

/// Place of the flaws that a density counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FlawsIn {
    Volume,
    Faces,
}

/// Distance from a face within which a point is on it, over the extent of the body.
const ON_FACE: f64 = 1e-9;

impl FlawsIn {
    fn are_of(self, statistics: &FlawStatistics) -> bool {
        match statistics.extent {
            Extent::Volume(_) => self == Self::Volume,
            Extent::Area(_) => self == Self::Faces,
        }
    }
}

impl SolidFem {
    /// Failure density at a point, from the equivalent stress at the nodes of all images [Pa]. It is zero where no such
    /// flaws are: in layers without them, and within the body for those of faces. At an interface it is that of the
    /// side to which the point belongs.
    pub fn failure_density_at(
        &self,
        flaws: &Flaws,
        which: FlawsIn,
        equivalent: &[f64],
        point: [f64; 3],
    ) -> f64 {
        let (place, image) = self.mesh.locate(point);
        let statistics = flaws.of_layer(self.layer_at(place[2])).filter(|own| which.are_of(own));
        let Some(own) = statistics else { return 0.0 };
        if which == FlawsIn::Faces && !is_on_face(&self.mesh, flaws, place) {
            return 0.0;
        }
        let weights = self.sided_weights(place);
        let number = self.all_images().position(|own| own == image).unwrap_or_default();
        let nodes = self.mesh.sided_nodes();
        let stress = &equivalent[number * nodes..][..nodes];
        let found = weighted(stress, weights.each_ref(), self.mesh.sided_counts(), (0, 1));
        own.power(found / own.strength) / own.extent.size()
    }

    /// The layer at a height; on interfaces the one above.
    fn layer_at(&self, z: f64) -> usize {
        self.mesh.layering.layer_of(self.element_at(z))
    }
}

/// Returns true if a place of the mesh is on a face on which flaws may be.
fn is_on_face(mesh: &Mesh, flaws: &Flaws, place: [f64; 3]) -> bool {
    let is_on = |axis: usize| {
        let nodes = &mesh.axes[axis].nodes;
        let [Some(&low), Some(&high)] = [nodes.first(), nodes.last()] else { return false };
        let near = |end: f64| (place[axis] - end).abs() <= ON_FACE * (high - low);
        let on = |end: f64, is_high: bool| near(end) && flaws.may_be_on(axis, is_high);
        high > low && (on(high, true) || on(low, false))
    };
    (0..3).any(is_on)
}
