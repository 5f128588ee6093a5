//! Mesh sizes of a solid below heated faces and under loads.

mod layers;

use super::grading::{Fine, graded_ends};
use super::plan::Refinement;
use crate::method::mesh::{Layering, Mesh};
use crate::scene::{Face, FaceName, HeatMethod, Mesh as MeshKeys, Shape, Solid, Stratum};

/// Nodes across a feature of a load, unless the scene sets a spacing.
const NODES_PER_FEATURE: f64 = 10.0;
/// Nodes across the heat penetration depth at the shortest time of interest, unless the scene sets a spacing.
const NODES_PER_DIFFUSION_LENGTH: f64 = 5.0;
/// Growth of elements away from loads, and of the layers of elements that heat crosses. A thermal layer as deep as
/// √(at) varies only over its own depth, so the second growth may be larger. A growth of 1.4 keeps surface temperatures
/// and heat within 1e-4 at all times.
const DEFAULT_GROWTH: f64 = 1.2;
const LAYER_GROWTH: f64 = 1.4;
const DEFAULT_ORDER: usize = 2;
/// Time over h²/a from which on nodes h apart below a heated face resolve its temperature to a few per cent.
const RESOLVED: f64 = 0.4;
/// Smallest number of elements through the thickness.
const THICKNESS_ELEMENTS: f64 = 6.0;
/// Smallest chosen node spacing over the thickness at which coordinates still distinguish nodes.
const FINEST: f64 = 1e-6;

/// Note on a body that is one element along the surface.
const COLUMN: &str = "a column, one element along the surface: faces are uniform there, no load acts on a part of one, \
                      other bodies touch whole faces, and what holds the sides, where stress is asked for, are rollers; \
                      this is exact";

/// Node spacings and growth of elements.
pub struct Fineness<'a> {
    solid: &'a Solid,
    /// Layers, from the lowest on.
    strata: &'a [Stratum],
    refinements: &'a [Refinement],
    /// Node spacing along the surface at loads [m].
    lateral: f64,
    /// Node spacing along the normal of heated faces, unless the scene sets a spacing [m].
    layer: f64,
    pub order: usize,
    /// Shortest time of interest [s].
    shortest: f64,
    /// Numbers of elements along the surface and through the thickness over those from the rules above.
    factors: [f64; 2],
    /// True if nothing varies along the surface, so that one element spans it.
    is_column: bool,
}

/// Loads and times that a mesh has to resolve.
#[derive(Debug, Clone, Copy)]
pub struct Resolution<'a> {
    /// Areas where loads act.
    pub refinements: &'a [Refinement],
    /// Shortest time of interest [s].
    pub shortest: f64,
    /// Numbers of elements along the surface and through the thickness over the usual ones.
    pub factors: [f64; 2],
    /// True if nothing varies along the surface.
    pub is_column: bool,
}

impl<'a> Fineness<'a> {
    /// Chooses the values that the scene does not set.
    pub fn choose(
        solid: &'a Solid,
        strata: &'a [Stratum],
        Resolution { refinements, shortest, factors, is_column }: Resolution<'a>,
        notes: &mut Vec<String>,
    ) -> Self {
        let given = &solid.mesh;
        let default = if solid.heat == HeatMethod::Sph { 1 } else { DEFAULT_ORDER };
        let order = given.order.unwrap_or(default);
        let width = lateral_extents(&solid.shape).into_iter().fold(f64::INFINITY, f64::min);
        let feature = refinements.iter().map(|r| r.feature).fold(width, f64::min);
        let lateral = given.spacing.unwrap_or(feature / NODES_PER_FEATURE);
        let diffusivity = slowest(strata);
        let reach = (diffusivity * shortest).sqrt();
        let finest = FINEST * solid.shape.thickness();
        let layer = lateral.min(reach / NODES_PER_DIFFUSION_LENGTH).max(finest);
        let chosen = Self {
            solid,
            strata,
            refinements,
            lateral,
            layer,
            order,
            shortest,
            factors,
            is_column,
        };
        notes.extend(chosen.notes(reach, shortest));
        notes.extend(chosen.note_on_depth(diffusivity, shortest));
        notes.extend(chosen.note_on_edges(diffusivity, shortest));
        chosen
    }

    /// Notes the overshoot of temperatures near the edge of a heated footprint before heat has spread half a node
    /// spacing along the surface. There the flux of an element's whole side spreads over nodes as a parabola, which
    /// overshoots.
    fn note_on_edges(&self, diffusivity: f64, shortest: f64) -> Option<String> {
        let resolved = (0.5 * self.lateral).powi(2) / diffusivity;
        let heated = self.refinements.iter().any(|refinement| refinement.heats);
        (heated && !self.is_column && shortest < resolved).then(|| {
            format!(
                "beside the edge of a heated area heat is resolved after {resolved:.1e} s; before, temperatures \
                 within {:.1e} m of it are up to a third of the rise too high or too low (the finer \
                 `mesh.spacing`, the sooner)",
                2.0 * self.lateral
            )
        })
    }

    /// Notes the effect of a node spacing set by the scene below heated faces while heat has not penetrated as far.
    fn note_on_depth(&self, diffusivity: f64, shortest: f64) -> Option<String> {
        let keys = self.keys();
        let mut heated = self.solid.shape.faces().iter().filter(|face| self.is_heated(**face));
        let of_face = |face: &FaceName| match face.normal().unwrap_or(0) {
            2 => keys.depth_spacing.or(keys.spacing),
            _ => keys.spacing,
        };
        let named = heated.by_ref().filter_map(of_face).fold(0.0, f64::max);
        let resolved = RESOLVED * named.powi(2) / diffusivity;
        (shortest < resolved).then(|| {
            format!(
                "heat through faces is resolved after {resolved:.1e} s, when it has gone further than the nodes are \
                 apart below them ({named:.1e} m); before, rises of heated surfaces are too low and heat of \
                 prescribed temperatures and of droplets too high, by several times at first (the finer \
                 `mesh.depth_spacing`, the sooner; a mesh without `spacing` is as fine as the step asks)"
            )
        })
    }

    /// Returns notes on the choices, with reasons.
    fn notes(&self, reach: f64, shortest: f64) -> Vec<String> {
        let Self { lateral, layer, .. } = self;
        if self.is_column {
            return vec![COLUMN.to_owned()];
        }
        let mut notes = Vec::new();
        if self.keys().spacing.is_none() && !self.refinements.is_empty() {
            notes.push(format!(
                "mesh spacing chosen: {:.3e} m along the surface (a tenth of the finest load, over {:.2})",
                lateral / self.factors[0],
                self.factors[0]
            ));
        }
        let half = lateral_extents(&self.solid.shape).into_iter().fold(0.0_f64, f64::max) / 2.0;
        let widest = half / (MeshKeys::LATERAL_ELEMENTS * self.order as f64);
        if self.keys().growth != Some(1.0) && *lateral > 1.01 * widest {
            notes.push(format!(
                "nodes along the surface are {widest:.3e} m apart at most: {} elements from the centre to a side, \
                 unless `mesh.growth` is 1",
                MeshKeys::LATERAL_ELEMENTS
            ));
        }
        if self.chooses_layers() {
            let why = if layer == lateral {
                "no more than along the surface".to_owned()
            } else if *layer > 1.01 * reach / NODES_PER_DIFFUSION_LENGTH {
                "a millionth of the thickness, the finest that is chosen".to_owned()
            } else {
                format!("a fifth of the {reach:.3e} m that heat goes in {shortest:.3e} s")
            };
            notes.push(format!(
                "mesh spacing chosen: {:.3e} m below the faces that heat passes ({why}; over {:.2})",
                layer / self.factors[1],
                self.factors[1]
            ));
        }
        notes
    }

    /// Returns true if the scene does not set the node spacing below some heated face.
    fn chooses_layers(&self) -> bool {
        let keys = self.keys();
        let faces = self.solid.shape.faces().iter();
        let mut heated = faces.filter(|&&face| self.is_heated(face));
        keys.spacing.is_none()
            && heated.any(|face| face.normal().unwrap_or(0) < 2 || keys.depth_spacing.is_none())
    }

    /// Returns the ends of the elements along x (0) or y (1) on `[start, end]`; a mesh that begins at a plane of
    /// symmetry begins at 0.
    pub fn lateral_ends(&self, axis: usize, [start, end]: [f64; 2]) -> Vec<f64> {
        if self.is_column {
            return vec![start, end];
        }
        let size = self.order as f64 * self.lateral;
        let mut fine: Vec<Fine> = self.loads(axis, start);
        for face in self.sides(axis, start < 0.0) {
            if self.is_heated(face) {
                let at = if is_high(face) { end } else { start };
                fine.push(self.layer_at(at, self.keys().spacing));
            }
        }
        if self.keys().spacing.is_some() && !self.has_lateral_places() {
            fine.push(self.stretch([start, end], size));
        }
        let coarsest = self.coarsest(end / MeshKeys::LATERAL_ELEMENTS, size);
        let factor = self.factors[0];
        let breaks = self.edges(axis, [start, end], size / factor);
        ends_through(&breaks, &finer(&fine, factor), coarsest / factor)
    }

    /// Returns the ends of the elements along z, and the interfaces between layers.
    pub fn depth(&self) -> (Vec<f64>, Layering) {
        match self.strata {
            [_] => (self.depth_ends(), Layering::default()),
            strata => self.ends_in_layers(strata),
        }
    }

    /// Ends of the elements along z in a body of one material.
    fn depth_ends(&self) -> Vec<f64> {
        let thickness = self.solid.shape.thickness();
        let keys = self.keys();
        let named = keys.depth_spacing.or(keys.spacing);
        let size = self.order as f64 * named.unwrap_or(self.lateral);
        let mut fine = self.fine_at_ends(size, |_, z| self.layer_at(z, named));
        if fine.is_empty() && keys.depth_spacing.is_some() {
            fine.push(self.stretch([-thickness, 0.0], size));
        }
        let least = fine.iter().map(|f| f.size).fold(f64::INFINITY, f64::min);
        let usual = (thickness / THICKNESS_ELEMENTS).max(least.min(size));
        let coarsest = self.coarsest(usual, least.min(size));
        graded_ends(-thickness, 0.0, &finer(&fine, self.factors[1]), coarsest / self.factors[1])
    }

    /// Stretches along z with fine elements for loads on the top and the bottom; `heated` returns those for heat that
    /// enters through either at z.
    fn fine_at_ends(&self, size: f64, heated: impl Fn(bool, f64) -> Fine) -> Vec<Fine> {
        let thickness = self.solid.shape.thickness();
        let mut fine = Vec::new();
        for (top, face, z) in [(true, FaceName::Top, 0.0), (false, FaceName::Bottom, -thickness)] {
            if self.refinements.iter().any(|r| r.top == top) {
                fine.push(self.stretch([z - size, z + size], size));
            }
            if self.is_heated(face) {
                fine.push(heated(top, z));
            }
        }
        fine
    }

    /// Stretches of an axis that loads may act on, with a margin.
    fn loads(&self, axis: usize, start: f64) -> Vec<Fine> {
        let stretch = |r: &Refinement| {
            // A wide load next to a small one needs no small elements over its whole area.
            let own = (r.feature / NODES_PER_FEATURE).max(self.lateral);
            let distance = self.keys().spacing.unwrap_or(own);
            let [from, to] = fold([r.x, r.y][axis], start);
            let margin = 2.0 * distance;
            self.stretch([from - margin, to + margin], self.order as f64 * distance)
        };
        self.refinements.iter().map(stretch).collect()
    }

    /// Returns the ends of an axis and, between them, places of sharp edges of loads. Ends of elements coincide with
    /// these if the program chooses them. None is nearer to the next than `least` [m].
    fn edges(&self, axis: usize, [start, end]: [f64; 2], least: f64) -> Vec<f64> {
        let mut places = vec![start, end];
        if self.keys().spacing.is_some() || self.solid.heat == HeatMethod::Sph {
            return places;
        }
        for refinement in self.refinements {
            let [from, to] = [refinement.x, refinement.y][axis];
            let centre = 0.5 * (from + to);
            for edge in refinement.edges.iter().flatten() {
                for place in [centre - edge, centre + edge] {
                    let place = if start == 0.0 { place.abs() } else { place };
                    let is_apart = |other: &f64| (place - other).abs() > 0.99 * least;
                    if place > start && place < end && places.iter().all(is_apart) {
                        places.push(place);
                    }
                }
            }
        }
        places.sort_by(f64::total_cmp);
        places
    }

    /// Returns true if loads or heated sides determine where the mesh is fine along the surface; otherwise the scene's
    /// settings apply everywhere.
    fn has_lateral_places(&self) -> bool {
        let mut faces = self.solid.shape.faces().iter();
        let is_side = |face: &FaceName| !matches!(face, FaceName::Top | FaceName::Bottom);
        !self.refinements.is_empty() || faces.any(|face| is_side(face) && self.is_heated(*face))
    }

    /// Time after a jump from which on the mesh resolves the temperature of all heated faces [s]; zero if none is
    /// heated.
    pub fn resolved_from(&self, mesh: &Mesh) -> f64 {
        let heated = self.solid.shape.faces().iter().filter(|face| self.is_heated(**face));
        let time = |face: &FaceName| {
            let (axis, layer) = match face {
                FaceName::Top => (2, self.strata.last()),
                FaceName::Bottom => (2, self.strata.first()),
                FaceName::Front | FaceName::Back => (1, None),
                _ => (0, None),
            };
            let diffusivity = match layer {
                Some(layer) => layer.constants.diffusivity(),
                None => slowest(self.strata),
            };
            let distance =
                mesh.axes[axis].end_distance(is_high(*face) && *face != FaceName::Bottom);
            RESOLVED * distance.powi(2) / diffusivity
        };
        heated.map(time).fold(0.0, f64::max)
    }

    /// Returns true if heat passes a face, by a condition or a load.
    fn is_heated(&self, face: FaceName) -> bool {
        let Face { temperature, flux, convection, radiation, .. } = self.solid.face(face);
        let loaded = |r: &Refinement| {
            r.heats && face == if r.top { FaceName::Top } else { FaceName::Bottom }
        };
        temperature.is_some()
            || flux.is_some()
            || convection.is_some()
            || radiation.is_some()
            || self.refinements.iter().any(loaded)
    }

    /// Faces at the meshed ends of an axis; the low one is included if `whole` is set.
    fn sides(&self, axis: usize, whole: bool) -> Vec<FaceName> {
        let all = match (&self.solid.shape, axis) {
            (Shape::Disc(_), _) => return vec![FaceName::Sides],
            (Shape::Box(_), 0) => [FaceName::Right, FaceName::Left],
            (Shape::Box(_), _) => [FaceName::Back, FaceName::Front],
        };
        all[..if whole { 2 } else { 1 }].to_vec()
    }

    fn keys(&self) -> &MeshKeys {
        &self.solid.mesh
    }

    /// The first element below a heated face at a coordinate, of the spacing `named` by the scene or of the chosen one.
    fn layer_at(&self, at: f64, named: Option<f64>) -> Fine {
        let size = self.order as f64 * named.unwrap_or(self.layer);
        let fine = self.stretch([at - size, at + size], size);
        // Particles need spacings that change little.
        let layered = named.is_none() && self.solid.heat == HeatMethod::Fem;
        let growth = self.keys().growth.unwrap_or(LAYER_GROWTH);
        if layered { Fine { growth, ..fine } } else { fine }
    }

    fn stretch(&self, [from, to]: [f64; 2], size: f64) -> Fine {
        Fine { from, to, size, growth: self.keys().growth.unwrap_or(DEFAULT_GROWTH) }
    }

    /// Size of the largest element, in general `usual`: without growth all are of one `size`.
    fn coarsest(&self, usual: f64, size: f64) -> f64 {
        if self.keys().growth == Some(1.0) { size } else { usual }
    }
}

/// Ends of elements through given places, of which the first and the last are the ends of the axis.
fn ends_through(places: &[f64], fine: &[Fine], coarsest: f64) -> Vec<f64> {
    let mut ends = vec![places[0]];
    for piece in places.windows(2) {
        ends.extend_from_slice(&graded_ends(piece[0], piece[1], fine, coarsest)[1..]);
    }
    ends
}

/// Refines stretches for a multiple of the number of elements: sizes and growth decrease alike, so that each element is
/// divided into about as many equal ones.
fn finer(fine: &[Fine], factor: f64) -> Vec<Fine> {
    let divide =
        |f: &Fine| Fine { size: f.size / factor, growth: 1.0 + (f.growth - 1.0) / factor, ..*f };
    fine.iter().map(divide).collect()
}

/// Diffusivity of the layer with the slowest diffusion [m²/s].
fn slowest(strata: &[Stratum]) -> f64 {
    strata.iter().map(|layer| layer.constants.diffusivity()).fold(f64::INFINITY, f64::min)
}

fn is_high(face: FaceName) -> bool {
    !matches!(face, FaceName::Left | FaceName::Front)
}

pub fn lateral_extents(shape: &Shape) -> Vec<f64> {
    match shape {
        Shape::Box([x, y, _]) => vec![*x, *y],
        Shape::Disc(disc) => vec![disc.radius],
    }
}

/// Maps a stretch to the meshed half, if the mesh begins at the symmetry plane.
fn fold([from, to]: [f64; 2], start: f64) -> [f64; 2] {
    if start != 0.0 {
        return [from, to];
    }
    let far = from.abs().max(to.abs());
    let near = if from < 0.0 && to > 0.0 { 0.0 } else { from.abs().min(to.abs()) };
    [near, far]
}
