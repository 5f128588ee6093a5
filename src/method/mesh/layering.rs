//! Interfaces between a body's layers along z.

use std::ops::Range;

/// The interfaces between the layers of a body, from bottom to top; the default is one layer.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Layering {
    /// First element along z of each layer above the lowest.
    starts: Vec<usize>,
    /// Thermal resistance of the contact below each of these layers [m² K/W].
    resistances: Vec<f64>,
}

impl Layering {
    /// Layering with layers that begin at these elements, each with the resistance of the contact
    /// below it [m² K/W].
    pub fn new(starts: Vec<usize>, resistances: Vec<f64>) -> Self {
        assert_eq!(starts.len(), resistances.len(), "each interface has a contact");
        Self { starts, resistances }
    }

    /// The same layers on a mesh with some elements in the place of each.
    pub fn in_parts(&self, parts: usize) -> Self {
        let starts = self.starts.iter().map(|start| start * parts).collect();
        Self { starts, resistances: self.resistances.clone() }
    }

    pub fn count(&self) -> usize {
        self.starts.len() + 1
    }

    pub fn interfaces(&self) -> usize {
        self.starts.len()
    }

    /// The layer of an element along z.
    pub fn layer_of(&self, element: usize) -> usize {
        self.starts.partition_point(|&start| start <= element)
    }

    /// Elements along z of a layer, of `total`.
    pub fn elements(&self, layer: usize, total: usize) -> Range<usize> {
        let start = if layer == 0 { 0 } else { self.starts[layer - 1] };
        start..self.starts.get(layer).copied().unwrap_or(total)
    }

    /// Thermal resistance of the contact above a layer [m² K/W].
    pub fn resistance_above(&self, layer: usize) -> f64 {
        self.resistances[layer]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_map_to_their_layers() {
        let layering = Layering::new(vec![3, 5], vec![0.0, 1.0]);
        let layers: Vec<usize> = (0..7).map(|element| layering.layer_of(element)).collect();
        assert_eq!(layers, [0, 0, 0, 1, 1, 2, 2]);
        let ranges: Vec<_> = (0..3).map(|layer| layering.elements(layer, 7)).collect();
        assert_eq!(ranges, [0..3, 3..5, 5..7]);
        let halves: Vec<usize> = (0..14).map(|half| layering.in_parts(2).layer_of(half)).collect();
        assert_eq!(halves, [0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2]);
        assert_eq!((Layering::default().count(), Layering::default().elements(0, 4)), (1, 0..4));
    }
}
