//! The points of a field.

use std::f64::consts::SQRT_2;

use super::lookup::Place;
use super::types::{Disc, FaceName, Field, Shape, Solid};

/// A regular grid of equal cells over a face or a section of a body, with a point in the middle of
/// each cell. It is centred on the face or section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// The axes the grid runs along, ascending: 0 = x, 1 = y, 2 = z.
    pub axes: [usize; 2],
    /// The axis of the constant coordinate.
    pub normal: usize,
    /// The constant coordinate [m].
    pub offset: f64,
    /// Coordinates of the middle along `axes` [m].
    pub centre: [f64; 2],
    /// Extents along `axes` [m].
    pub size: [f64; 2],
    /// Number of points along `axes`.
    pub count: [usize; 2],
}

impl Grid {
    /// The grid of a checked field in its body.
    ///
    /// # Panics
    /// If the scene has not been checked and the field is in no plane of the body.
    pub fn of(field: &Field, solid: &Solid) -> Self {
        let (_, place) = field.body_and_place();
        let mut grid = Self::at(place, field, &solid.shape);
        if grid.normal == 2 {
            // On an interface between layers, z of the upper layer.
            grid.offset = solid.interface_at(grid.offset).unwrap_or(grid.offset);
        }
        grid
    }

    /// The grid of a field at a place.
    pub(super) fn at(place: Place, field: &Field, shape: &Shape) -> Self {
        let (normal, offset) = match place {
            Place::Face(face) => plane_of(face, shape),
            Place::Section(plane) => (plane.normal(), plane.offset()),
        };
        let axes = [[1, 2], [0, 2], [0, 1]][normal];
        let middle = [0.0, 0.0, -shape.thickness() / 2.0];
        Self {
            axes,
            normal,
            offset,
            centre: axes.map(|axis| middle[axis]),
            size: field.size.unwrap_or_else(|| whole_size(shape, normal, offset)),
            count: field.grid.unwrap_or_default(),
        }
    }

    /// The middle [m] of cell `i` along the first axis and `j` along the second, counted from 0.
    pub fn point(&self, i: usize, j: usize) -> [f64; 3] {
        let mut point = [self.offset; 3];
        for (k, index) in [i, j].into_iter().enumerate() {
            let fraction = (index as f64 + 0.5) / self.count[k] as f64 - 0.5;
            point[self.axes[k]] = self.centre[k] + fraction * self.size[k];
        }
        point
    }

    /// All points [m], the index along the second axis running fastest.
    pub fn points(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        let [rows, columns] = self.count;
        (0..rows).flat_map(move |i| (0..columns).map(move |j| self.point(i, j)))
    }
}

/// Normal and constant coordinate of a plane face.
fn plane_of(face: FaceName, shape: &Shape) -> (usize, f64) {
    let [x, y] = lateral_extents(shape);
    match face {
        FaceName::Top => (2, 0.0),
        FaceName::Bottom => (2, -shape.thickness()),
        FaceName::Left => (0, -x / 2.0),
        FaceName::Right => (0, x / 2.0),
        FaceName::Front => (1, -y / 2.0),
        FaceName::Back => (1, y / 2.0),
        FaceName::Sides => panic!("a checked field is on a plane face"),
    }
}

/// Extents of a body along x and y [m].
pub fn lateral_extents(shape: &Shape) -> [f64; 2] {
    match *shape {
        Shape::Box([x, y, _]) => [x, y],
        Shape::Disc(Disc { radius, .. }) => [2.0 * radius; 2],
    }
}

/// Extents of the whole face or section [m]; of the inscribed square if it is round.
fn whole_size(shape: &Shape, normal: usize, offset: f64) -> [f64; 2] {
    match *shape {
        Shape::Disc(Disc { radius, .. }) if normal == 2 => [SQRT_2 * radius; 2],
        _ => section_size(shape, normal, offset),
    }
}

/// Extents of a section [m]; of the bounding rectangle if it is round.
pub(super) fn section_size(shape: &Shape, normal: usize, offset: f64) -> [f64; 2] {
    let [x, y] = lateral_extents(shape);
    let thickness = shape.thickness();
    match (shape, normal) {
        (_, 2) => [x, y],
        (Shape::Box(_), 0) => [y, thickness],
        (Shape::Box(_), _) => [x, thickness],
        (Shape::Disc(Disc { radius, .. }), _) => {
            [2.0 * (radius * radius - offset * offset).max(0.0).sqrt(), thickness]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::parse;

    fn grid(shape: &str, field: &str) -> Grid {
        let text = format!(
            "name = 'n'\nstop_time = 1\nstep = 1\n[body.plate]\nkind = 'solid'\nshape = {shape}\n\
             material = {{ model = 'thermoelastic', density = 1, specific_heat = 1, conductivity = \
             1, young = 1, poisson = 0, expansion = 0 }}\ninitial_temperature = 1\n\
             [[field]]\nname = 'f'\ngives = ['temperature']\n{field}"
        );
        let scene = parse(&text, "grid").unwrap();
        Grid::of(&scene.field[0], scene.solid("plate").unwrap())
    }

    const BOX: &str = "{ box = [4, 8, 2] }";
    const DISC: &str = "{ disc = { radius = 5, thickness = 2 } }";

    #[test]
    fn box_face_is_covered_by_default() {
        let top = grid(BOX, "on = 'plate.top'\ngrid = [2, 4]");
        assert_eq!((top.axes, top.normal, top.offset, top.size), ([0, 1], 2, 0.0, [4.0, 8.0]));
        assert_eq!(top.point(0, 0), [-1.0, -3.0, 0.0]);
        assert_eq!(top.point(1, 3), [1.0, 3.0, 0.0]);
        let left = grid(BOX, "on = 'plate.left'\ngrid = [2, 1]");
        assert_eq!((left.axes, left.normal, left.offset, left.size), ([1, 2], 0, -2.0, [8.0, 2.0]));
        assert_eq!(left.point(0, 0), [-2.0, -2.0, -1.0]);
        let back = grid(BOX, "on = 'plate.back'\ngrid = [1, 1]");
        assert_eq!(back.point(0, 0), [0.0, 4.0, -1.0]);
        let bottom = grid(BOX, "on = 'plate.bottom'\ngrid = [1, 1]");
        assert_eq!(bottom.point(0, 0), [0.0, 0.0, -2.0]);
    }

    #[test]
    fn section_is_centred_at_half_thickness() {
        let section = grid(BOX, "in = 'plate'\nplane = { y = 1 }\ngrid = [1, 2]\nsize = [1, 1]");
        assert_eq!((section.axes, section.normal), ([0, 2], 1));
        assert_eq!(section.point(0, 0), [0.0, 1.0, -1.25]);
        assert_eq!(section.point(0, 1), [0.0, 1.0, -0.75]);
    }

    #[test]
    fn round_face_is_covered_by_its_inscribed_square() {
        let top = grid(DISC, "on = 'plate.top'\ngrid = [3, 3]");
        assert_eq!(top.size, [SQRT_2 * 5.0; 2]);
        let section = grid(DISC, "in = 'plate'\nplane = { x = 3 }\ngrid = [3, 3]");
        assert_eq!((section.axes, section.size), ([1, 2], [8.0, 2.0]));
    }

    #[test]
    fn points_run_fastest_along_the_second_axis() {
        let top = grid(BOX, "on = 'plate.top'\ngrid = [2, 3]");
        let points: Vec<_> = top.points().collect();
        assert_eq!(points.len(), 6);
        assert_eq!(points[1], top.point(0, 1));
        assert_eq!(points[3], top.point(1, 0));
    }
}
