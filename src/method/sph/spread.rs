//! Spread diameter of fluid on the wall.

use std::f64::consts::{PI, TAU};

use super::plan::DropletPlan;

/// Radius over Δx of the disc of wall that a particle covers. A lattice of particles leaves no hole
/// up to a distance of √2 Δx, so a film may thin out.
const COVER: f64 = 1.0;
/// Width of rings over Δx.
const RING: f64 = 0.25;

/// Arrangement of particles on a wall.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Film {
    /// Points on a line, of a plane model.
    Line,
    /// Points in a plane.
    Plane,
    /// Rings about the origin with radius x.
    Rings,
}

impl Film {
    pub fn of(plan: &DropletPlan) -> Self {
        match plan.dimension {
            2 => Film::Line,
            _ if plan.axisymmetric => Film::Rings,
            _ => Film::Plane,
        }
    }
}

/// Diameter of the film that particles on the wall form around the origin, in units of their
/// distance Δx.
///
/// Every particle covers a disc of radius Δx, and c(r) is the covered fraction of a circle of
/// radius r. A fraction above 3/4 counts as 1, one below 1/4 as 0, which excludes drops that flew
/// off. Each circle counts at least as much as any circle outside it, which fills holes:
/// `s(r) = max over r' ≥ r of min(1, max(0, 2c(r') − 1/2))`. The film is as large as the disc of
/// the same area, `(D/2 + Δx/2)² = ∫ s d(r²)`. In a plane model it is the line of the same length,
/// `D/2 + Δx/2 = ∫ s dr`. A disc of radius Δx/2 of the outermost particles belongs to the film,
/// hence the Δx/2. Additional particles never reduce D, and one among many changes it by a small
/// fraction of Δx.
pub fn spread_diameter(places: &[[f64; 2]], film: Film) -> f64 {
    let mut arcs: Vec<Arc> = places.iter().flat_map(|&place| arcs_of(place, film)).collect();
    arcs.sort_by(|a, b| b.ring.cmp(&a.ring).then(a.start.total_cmp(&b.start)));
    let (mut share, mut size, mut outer) = (0.0_f64, 0.0, 0);
    let power = if film == Film::Line { 1 } else { 2 };
    let extent = |rings: usize| (rings as f64 * RING).powi(power);
    // From the outermost ring inwards.
    for arcs in arcs.chunk_by(|a, b| a.ring == b.ring) {
        let next = arcs[0].ring + 1;
        size += share * (extent(outer) - extent(next.min(outer)));
        share = share.max((2.0 * union(arcs) / TAU - 0.5).clamp(0.0, 1.0));
        outer = next;
    }
    size += share * extent(outer);
    let radius = if film == Film::Line { size } else { size.sqrt() };
    (2.0 * radius - (2.0 * COVER - 1.0)).max(0.0)
}

/// Part of a circle that one particle covers [rad], within 0 and 2π.
#[derive(Debug, Clone, Copy)]
struct Arc {
    ring: usize,
    start: f64,
    end: f64,
}

/// Arcs of the rings' middle circles that a particle covers; in a plane model a half circle
/// represents each side.
fn arcs_of([x, y]: [f64; 2], film: Film) -> Vec<Arc> {
    let distance = x.hypot(y);
    let first = ((distance - COVER) / RING).max(0.0) as usize;
    let last = ((distance + COVER) / RING) as usize;
    let mut arcs = Vec::new();
    for ring in first..=last {
        let radius = (ring as f64 + 0.5) * RING;
        let mut add = |start: f64, end: f64| arcs.push(Arc { ring, start, end });
        if film == Film::Rings {
            if (radius - x).abs() < COVER {
                add(0.0, TAU);
            }
            continue;
        }
        if film == Film::Line {
            [1.0, -1.0].into_iter().zip([0.0, PI]).for_each(|(side, start)| {
                if (side * radius - x).abs() < COVER {
                    add(start, start + PI);
                }
            });
            continue;
        }
        // Law of cosines in the triangle of origin, particle and end of the arc.
        let cosine =
            (radius * radius + distance * distance - COVER * COVER) / (2.0 * radius * distance);
        if cosine <= -1.0 || distance == 0.0 {
            if radius < COVER {
                add(0.0, TAU);
            }
        } else if cosine < 1.0 {
            let (middle, half) = (y.atan2(x).rem_euclid(TAU), cosine.acos());
            add((middle - half).max(0.0), (middle + half).min(TAU));
            if middle < half {
                add(TAU + middle - half, TAU);
            } else if middle + half > TAU {
                add(0.0, middle + half - TAU);
            }
        }
    }
    arcs
}

/// Length of the union of arcs sorted by their starts.
fn union(arcs: &[Arc]) -> f64 {
    let (mut length, mut reached) = (0.0, 0.0_f64);
    for arc in arcs {
        length += (arc.end - arc.start.max(reached)).max(0.0);
        reached = reached.max(arc.end);
    }
    length
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points of a square lattice, turned and stretched, within a radius.
    fn lattice(radius: f64, stretch: f64, hole: f64) -> Vec<[f64; 2]> {
        let reach = (radius / stretch) as i64 + 2;
        let (sine, cosine) = 0.3_f64.sin_cos();
        let turned = |i: i64, j: i64| {
            let [x, y] = [i, j].map(|n| (n as f64 + 0.5) * stretch);
            [cosine * x - sine * y, sine * x + cosine * y]
        };
        let points = (-reach..reach).flat_map(|i| (-reach..reach).map(move |j| turned(i, j)));
        points.filter(|[x, y]| (hole..radius).contains(&x.hypot(*y))).collect()
    }

    /// Concentric rings, as an evenly spread drop leaves them.
    fn rings(count: usize) -> Vec<[f64; 2]> {
        let ring = |k: usize| {
            let radius = k as f64 + 0.5;
            let points = (TAU * radius).round();
            (0..points as usize).map(move |i| {
                let (sine, cosine) = (TAU * i as f64 / points).sin_cos();
                [radius * cosine, radius * sine]
            })
        };
        (0..count).flat_map(ring).collect()
    }

    #[test]
    fn diameter_of_a_round_film() {
        for count in [3, 8, 20, 40] {
            let diameter = spread_diameter(&rings(count), Film::Plane);
            assert!((diameter - 2.0 * count as f64).abs() < 0.3, "{count}: {diameter}");
        }
        for radius in [5.2, 12.0, 25.7, 40.0] {
            let diameter = spread_diameter(&lattice(radius, 1.0, 0.0), Film::Plane);
            assert!((diameter - 2.0 * radius).abs() < 0.5, "{radius}: {diameter}");
        }
    }

    #[test]
    fn length_of_a_plane_film() {
        for count in [1, 4, 31] {
            let places: Vec<[f64; 2]> =
                (0..count).map(|i| [i as f64 + 0.5 - 0.5 * count as f64, 0.0]).collect();
            let length = spread_diameter(&places, Film::Line);
            assert!((length - count as f64).abs() < 0.3, "{count}: {length}");
        }
    }

    #[test]
    fn holes_thinning_and_spray_are_ignored() {
        let whole = spread_diameter(&lattice(20.0, 1.0, 0.0), Film::Plane);
        assert_eq!(spread_diameter(&lattice(20.0, 1.0, 10.0), Film::Plane), whole);
        let thin = spread_diameter(&lattice(20.0, 1.4, 0.0), Film::Plane);
        assert!((thin - whole).abs() < 1.0, "{thin} {whole}");
        let mut spray = lattice(20.0, 1.0, 0.0);
        spray.extend((0..8).map(|i| [30.0 + f64::from(i), f64::from(3 * i)]));
        assert_eq!(spread_diameter(&spray, Film::Plane), whole);
        assert_eq!(spread_diameter(&[], Film::Plane), 0.0);
    }

    #[test]
    fn one_more_particle_changes_the_diameter_little() {
        let mut places = lattice(15.0, 1.0, 0.0);
        places.sort_by(|a, b| a[0].hypot(a[1]).total_cmp(&b[0].hypot(b[1])));
        let mut before = spread_diameter(&places[..300], Film::Plane);
        for count in 301..=places.len() {
            let now = spread_diameter(&places[..count], Film::Plane);
            assert!((-1e-12..0.2).contains(&(now - before)), "{count}: {before} {now}");
            before = now;
        }
    }
}
