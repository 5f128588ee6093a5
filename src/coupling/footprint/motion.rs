//! Rates of the nodal vectors of a load while its footprint moves or grows.
//!
//! They are exact, by Reynolds' transport theorem: the change is the area swept by the edge. The values on the
//! footprint's cells do not change.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::{Pattern, Placement, add_scaled, chord, gaussian, outer, scaled, tile_sum};
use crate::math::gauss::gauss_on;
use crate::method::mesh::Axis;
use crate::scene::{Footprint, Profile};

/// A strip of tiles along an axis, and its rate.
type Strip = (Vec<f64>, Vec<f64>);

impl Pattern {
    /// Rate of [`Pattern::on_plane`] when the place changes at `rate`.
    pub fn motion_on_plane(
        self,
        [x, y]: [&Axis; 2],
        footprint: &Footprint,
        (place, rate): (&Placement, &Placement),
        values: &[f64],
        image: [bool; 2],
    ) -> Vec<f64> {
        let (place, rate) = (place.mirrored(image), rate.mirrored(image));
        match footprint.profile(place.radius, values) {
            Profile::Discs(discs) => {
                let motion = Motion {
                    axes: [x, y],
                    centre: [place.x, place.y],
                    velocity: [rate.x, rate.y],
                    growth: rate.radius / place.radius,
                    discs,
                };
                let turned = matches!(self, Pattern::Outward(axis) if image[axis]);
                scaled(motion.of(self), if turned { -1.0 } else { 1.0 })
            }
            Profile::Gaussian(value) => {
                let along = |axis, centre| gaussian(axis, centre, place.radius);
                let change = |axis: &Axis, centre, velocity| {
                    gaussian_motion(axis, [centre, velocity], [place.radius, rate.radius])
                };
                let moved_x = change(x, place.x, rate.x);
                let mut sum = outer(&moved_x, &along(y, place.y));
                let moved_y = change(y, place.y, rate.y);
                add_scaled(&mut sum, &outer(&along(x, place.x), &moved_y), 1.0);
                scaled(sum, value)
            }
            Profile::Tiles { count, size } => {
                let columns = strip_motions(x, [place.x, rate.x], count[0], size[0]);
                let rows = strip_motions(y, [place.y, rate.y], count[1], size[1]);
                let pick = |strips: &[Strip], moved: bool| -> Vec<Vec<f64>> {
                    let part = |(still, change): &Strip| if moved { change } else { still }.clone();
                    strips.iter().map(part).collect()
                };
                let sum = |moved_x: bool, moved_y: bool| {
                    tile_sum(&pick(&columns, moved_x), &pick(&rows, moved_y), values, image)
                };
                let mut total = sum(true, false);
                add_scaled(&mut total, &sum(false, true), 1.0);
                total
            }
        }
    }

    /// Rate of [`Pattern::on_radius`] when the radius changes at `growth`.
    pub fn growth_on_radius(
        self,
        axis: &Axis,
        footprint: &Footprint,
        [radius, growth]: [f64; 2],
        values: &[f64],
    ) -> Vec<f64> {
        // The circle of a given radius sweeps over `2 π r` of area for each metre that it grows.
        let circle = |radius: f64, growth: f64| {
            let mut out = vec![0.0; axis.len()];
            let at = axis.shape_at(radius);
            for i in 0..at.count {
                out[at.first + i] = TAU * radius * growth * at.values[i];
            }
            out
        };
        match footprint.profile(radius, values) {
            Profile::Discs(discs) => {
                let mut sum = vec![0.0; axis.len()];
                for (edge, value) in discs {
                    add_scaled(&mut sum, &circle(edge, growth * edge / radius), value);
                }
                sum
            }
            Profile::Gaussian(value) => {
                scaled(gaussian_motion(axis, [0.0; 2], [radius, growth]), value)
            }
            // Scenes with tiles on a disc are refused.
            Profile::Tiles { .. } => vec![0.0; axis.len()],
        }
    }
}

/// A sum of concentric discs that move and grow.
struct Motion<'a> {
    axes: [&'a Axis; 2],
    centre: [f64; 2],
    velocity: [f64; 2],
    /// Relative growth of all radii.
    growth: f64,
    /// Radius and value of each disc.
    discs: Vec<(f64, f64)>,
}

const GAUSS_OVER_ARC: usize = 12;
/// Exact for quadratic shape functions along a slanted ray.
const GAUSS_ALONG_RAY: usize = 3;

impl Motion<'_> {
    fn of(&self, pattern: Pattern) -> Vec<f64> {
        let [x, y] = self.axes;
        let mut out = vec![0.0; x.len() * y.len()];
        for &disc in &self.discs {
            self.add_swept(&mut out, pattern, disc);
        }
        if let Pattern::Outward(axis) = pattern
            && self.velocity != [0.0; 2]
        {
            self.add_turned(&mut out, axis);
        }
        out
    }

    /// Adds `∮ N f (v · n + Ṙ) R dφ` over the edge of a disc, with `f` the pattern.
    fn add_swept(&self, out: &mut [f64], pattern: Pattern, (radius, value): (f64, f64)) {
        for piece in ascending(self.edge_angles(radius)).windows(2) {
            for (angle, w) in gauss_on(GAUSS_OVER_ARC, piece[0], piece[1]) {
                let normal = [angle.cos(), angle.sin()];
                let speed = self.velocity[0] * normal[0] + self.velocity[1] * normal[1];
                let direction = match pattern {
                    Pattern::Scalar => 1.0,
                    Pattern::Outward(axis) => normal[axis],
                };
                let weight = w * radius * (speed + self.growth * radius) * direction;
                self.add_at(out, normal, radius, value * weight);
            }
        }
    }

    /// Adds `−∫ N f (v_i − n_i (v · n))/r dA`: the change of the directions away from the centre as it moves. Along a
    /// ray the 1/r cancels with the element of area, so that the integrand is smooth.
    fn add_turned(&self, out: &mut [f64], axis: usize) {
        for piece in self.ray_angles().windows(2) {
            for (angle, w) in gauss_on(GAUSS_OVER_ARC, piece[0], piece[1]) {
                let normal = [angle.cos(), angle.sin()];
                let along = self.velocity[0] * normal[0] + self.velocity[1] * normal[1];
                let factor = w * (normal[axis] * along - self.velocity[axis]);
                for part in self.ray_ends(normal).windows(2) {
                    let value = self.value_at(0.5 * (part[0] + part[1]));
                    for (r, weight) in gauss_on(GAUSS_ALONG_RAY, part[0], part[1]) {
                        self.add_at(out, normal, r, factor * weight * value);
                    }
                }
            }
        }
    }

    /// Sum of the discs at a distance from the centre.
    fn value_at(&self, r: f64) -> f64 {
        self.discs.iter().filter(|(radius, _)| *radius > r).map(|(_, value)| value).sum()
    }

    /// Radius of the largest disc.
    fn reach(&self) -> f64 {
        self.discs.iter().map(|(radius, _)| *radius).fold(0.0, f64::max)
    }

    /// Adds `weight N` of the point at the distance `r` along `normal`, if it is on the mesh.
    fn add_at(&self, out: &mut [f64], normal: [f64; 2], r: f64, weight: f64) {
        let [x, y] = self.axes;
        let place = [0, 1].map(|a| self.centre[a] + r * normal[a]);
        let inside = |a: usize| {
            let axis = self.axes[a];
            (axis.start()..=axis.end()).contains(&place[a])
        };
        if !(inside(0) && inside(1)) {
            return;
        }
        let (along_x, along_y) = (x.shape_at(place[0]), y.shape_at(place[1]));
        for j in 0..along_y.count {
            let row = &mut out[(along_y.first + j) * x.len() + along_x.first..];
            for (target, value) in row.iter_mut().zip(&along_x.values[..along_x.count]) {
                *target += weight * value * along_y.values[j];
            }
        }
    }

    /// Angles between which the edge of a disc meets no border of elements.
    fn edge_angles(&self, radius: f64) -> Vec<f64> {
        let mut angles: Vec<f64> = (-2..=2).map(|i| f64::from(i) * FRAC_PI_2).collect();
        for end in self.ends(0) {
            let cosine = (end - self.centre[0]) / radius;
            if cosine.abs() < 1.0 {
                angles.extend([cosine.acos(), -cosine.acos()]);
            }
        }
        for end in self.ends(1) {
            let sine = (end - self.centre[1]) / radius;
            if sine.abs() < 1.0 {
                let angle = sine.asin();
                angles.extend([angle, if angle > 0.0 { PI - angle } else { -PI - angle }]);
            }
        }
        angles
    }

    /// Ascending angles between which rays meet no corner of elements, and no border of elements on
    /// an edge.
    fn ray_angles(&self) -> Vec<f64> {
        let radii = self.discs.iter().map(|(radius, _)| *radius);
        let mut angles: Vec<f64> = radii.flat_map(|radius| self.edge_angles(radius)).collect();
        let reach = self.reach();
        for end_y in self.ends(1) {
            for end_x in self.ends(0) {
                let offset = [end_x - self.centre[0], end_y - self.centre[1]];
                let distance = offset[0].hypot(offset[1]);
                if distance > 0.0 && distance < reach {
                    angles.push(offset[1].atan2(offset[0]));
                }
            }
        }
        ascending(angles)
    }

    /// Ascending distances along a ray at which it meets edges and borders of elements.
    fn ray_ends(&self, normal: [f64; 2]) -> Vec<f64> {
        let reach = self.reach();
        let mut ends: Vec<f64> = self.discs.iter().map(|(radius, _)| *radius).collect();
        ends.push(0.0);
        for axis in [0, 1] {
            for end in self.ends(axis) {
                let r = (end - self.centre[axis]) / normal[axis];
                if r > 0.0 && r < reach {
                    ends.push(r);
                }
            }
        }
        ascending(ends)
    }

    fn ends(&self, axis: usize) -> impl Iterator<Item = f64> {
        let axis = self.axes[axis];
        (0..=axis.elements()).map(|e| axis.nodes[e * axis.order])
    }
}

fn ascending(mut values: Vec<f64>) -> Vec<f64> {
    values.sort_by(f64::total_cmp);
    values.dedup();
    values
}

/// Rate of [`gaussian`]: `∫ N (4 u ċ/w + 4 u² ẇ/w) e^{−2u²} dx` with `u = (x − c)/w`.
fn gaussian_motion(
    axis: &Axis,
    [centre, velocity]: [f64; 2],
    [radius, growth]: [f64; 2],
) -> Vec<f64> {
    super::gaussian_moment(axis, centre, radius, |u| 4.0 * u * (velocity + u * growth) / radius)
}

/// Strips of tiles along an axis, `∫ N dx` each, and their rates.
fn strip_motions(
    axis: &Axis,
    [centre, velocity]: [f64; 2],
    count: usize,
    length: f64,
) -> Vec<Strip> {
    let strip = |i: usize| {
        let ends = [i, i + 1].map(|i| centre + length * (i as f64 / count as f64 - 0.5));
        let [from, to] = ends.map(|end| end.clamp(axis.start(), axis.end()));
        let mut change = vec![0.0; axis.len()];
        if from >= to {
            return (vec![0.0; axis.len()], change);
        }
        for (end, sign) in ends.into_iter().zip([-1.0, 1.0]) {
            if (axis.start()..=axis.end()).contains(&end) {
                let at = axis.shape_at(end);
                for i in 0..at.count {
                    change[at.first + i] += sign * velocity * at.values[i];
                }
            }
        }
        (chord(axis, from, to), change)
    };
    (0..count).map(strip).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::method::mesh::Weight;

    fn axis(order: usize) -> Axis {
        let ends = [-1.0, -0.6, -0.55, -0.1, 0.0, 0.03, 0.2, 0.7, 1.0];
        Axis::from_element_ends(&ends, order, Weight::Uniform)
    }

    /// The half that is meshed at a plane of symmetry.
    fn half(order: usize) -> Axis {
        Axis::from_element_ends(&[0.0, 0.03, 0.2, 0.7, 1.0], order, Weight::Uniform)
    }

    fn moved(place: &Placement, rate: &Placement, by: f64) -> Placement {
        Placement {
            x: place.x + by * rate.x,
            y: place.y + by * rate.y,
            radius: place.radius + by * rate.radius,
        }
    }

    #[test]
    fn motion_is_the_limit_of_differences_for_every_footprint_and_image() {
        let place = Placement { x: 0.117, y: -0.083, radius: 0.29 };
        let rates = [
            Placement { x: 1.0, y: 0.0, radius: 0.0 },
            Placement { x: 0.0, y: 1.0, radius: 0.0 },
            Placement { x: 0.0, y: 0.0, radius: 1.0 },
            Placement { x: 0.4, y: -0.7, radius: 0.5 },
        ];
        let values = [1.0, -2.0, 0.5, 4.0, 3.0, 2.5];
        let cases = [
            (Footprint::Disc { radius: 0.29 }, Pattern::Scalar, 1e-7),
            (Footprint::Gaussian { radius: 0.29 }, Pattern::Scalar, 1e-7),
            (Footprint::Ring { inner: 0.11, outer: 0.29 }, Pattern::Scalar, 1e-6),
            (Footprint::Tiles { count: [2, 3], size: [0.41, 0.57] }, Pattern::Scalar, 1e-7),
            (Footprint::Rings { count: 6, radius: 0.29 }, Pattern::Scalar, 1e-6),
            (Footprint::Rings { count: 2, radius: 0.29 }, Pattern::Outward(0), 3e-5),
            (Footprint::Rings { count: 2, radius: 0.29 }, Pattern::Outward(1), 3e-5),
        ];
        let step = 1e-6;
        for order in [1, 2] {
            let (full, half) = (axis(order), half(order));
            let meshes = [
                ([&full, &full], [false; 2]),
                ([&half, &full], [true, false]),
                ([&half; 2], [true; 2]),
            ];
            for (axes, image) in meshes {
                for (footprint, pattern, tolerance) in &cases {
                    for rate in &rates {
                        let at = |by| {
                            let place = moved(&place, rate, by);
                            pattern.on_plane(axes, footprint, &place, &values, image)
                        };
                        let moved = (&place, rate);
                        let found = pattern.motion_on_plane(axes, footprint, moved, &values, image);
                        let scale = found.iter().fold(0.0_f64, |s, v| s.max(v.abs()));
                        for ((a, b), value) in at(step).iter().zip(at(-step)).zip(&found) {
                            let wanted = (a - b) / (2.0 * step);
                            assert!(
                                (value - wanted).abs() <= tolerance * scale,
                                "{footprint:?} {pattern:?} {image:?} {rate:?}: {value} {wanted}"
                            );
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn growth_on_a_radius_is_the_limit_of_differences() {
        let ends = [0.0, 0.1, 0.33, 0.5, 1.0];
        let values = [1.0, -2.0, 0.5];
        for order in [1, 2] {
            let axis = Axis::from_element_ends(&ends, order, Weight::Radial);
            for footprint in [
                Footprint::Disc { radius: 0.4 },
                Footprint::Gaussian { radius: 0.1 },
                Footprint::Ring { inner: 0.13, outer: 0.4 },
                Footprint::Rings { count: 3, radius: 0.4 },
            ] {
                let at = |r| Pattern::Scalar.on_radius(&axis, &footprint, r, &values);
                let (radius, step) = (footprint.radius().unwrap(), 1e-5);
                let found =
                    Pattern::Scalar.growth_on_radius(&axis, &footprint, [radius, 2.0], &values);
                for ((a, b), value) in at(radius + step).iter().zip(at(radius - step)).zip(&found) {
                    let wanted = (a - b) / step;
                    assert!((value - wanted).abs() < 1e-6, "{footprint:?}: {value} {wanted}");
                }
            }
        }
    }
}
