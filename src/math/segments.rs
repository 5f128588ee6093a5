//! Straight segments in a plane.

/// Place in a plane.
pub type Place = [f64; 2];
/// Ends of a segment.
pub type Segment = [Place; 2];

/// Sine of the angle below which segments are parallel.
const PARALLEL: f64 = 1e-9;

/// Joins segments that lie on each other, or touch in line, into one.
pub fn united(segments: &[Segment], reach: f64) -> Vec<Segment> {
    let mut all: Vec<Segment> = Vec::new();
    for own in segments {
        let mut own = *own;
        let is_one = |own: &Segment, other: &Segment| {
            is_parallel(own, other) && contact(own, other, reach).is_some()
        };
        while let Some(place) = all.iter().position(|other| is_one(&own, other)) {
            let other = all.swap_remove(place);
            let ends = [own[0], own[1], other[0], other[1]];
            let pairs = ends.iter().flat_map(|a| ends.map(|b| [*a, b]));
            let length = |pair: &Segment| distance(pair[0], pair[1]);
            own = pairs.max_by(|a, b| length(a).total_cmp(&length(b))).unwrap_or(own);
        }
        all.push(own);
    }
    all
}

fn is_parallel(a: &Segment, b: &Segment) -> bool {
    let (r, s) = (difference(a[1], a[0]), difference(b[1], b[0]));
    cross(r, s).abs() <= PARALLEL * (dot(r, r) * dot(s, s)).sqrt()
}

/// Returns a place that two segments share, to a distance; `None` if they are apart.
pub fn contact(a: &Segment, b: &Segment, reach: f64) -> Option<Place> {
    let on = |at: &Place, [from, to]: &Segment| {
        let along = difference(*to, *from);
        let part = dot(difference(*at, *from), along) / dot(along, along);
        let part = part.clamp(0.0, 1.0);
        let nearest = [from[0] + part * along[0], from[1] + part * along[1]];
        distance(*at, nearest) <= reach
    };
    let end = a.iter().find(|at| on(at, b)).or_else(|| b.iter().find(|at| on(at, a)));
    if let Some(end) = end {
        return Some(*end);
    }
    let (r, s, apart) = (difference(a[1], a[0]), difference(b[1], b[0]), difference(b[0], a[0]));
    if is_parallel(a, b) {
        return None;
    }
    let sine = cross(r, s);
    let parts = [cross(apart, s) / sine, cross(apart, r) / sine];
    let crosses = parts.iter().all(|part| (0.0..=1.0).contains(part));
    crosses.then(|| [a[0][0] + parts[0] * r[0], a[0][1] + parts[0] * r[1]])
}

fn difference(a: Place, b: Place) -> Place {
    [a[0] - b[0], a[1] - b[1]]
}

pub fn distance(a: Place, b: Place) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

fn dot(a: Place, b: Place) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn cross(a: Place, b: Place) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn segments_in_line_are_united() {
        let along = |from: f64, to: f64| [[1.0, from], [1.0, to]];
        let length = |segments: &[Segment]| -> f64 {
            united(segments, 1e-9).iter().map(|[a, b]| distance(*a, *b)).sum()
        };
        for (segments, wanted) in [
            (&[along(-5.0, -3.0), along(-2.5, -4.0)][..], 2.5),
            (&[along(-5.0, -3.0), along(-3.0, -5.0)], 2.0),
            (&[along(-5.0, -4.0), along(-2.0, -1.0), along(-4.5, -1.5)], 4.0),
            (&[along(-5.0, -3.0), along(-2.0, -1.0)], 3.0),
            // Across each other.
            (&[along(-1.0, 1.0), [[0.0, 0.0], [2.0, 0.0]]], 4.0),
        ] {
            assert!((length(segments) - wanted).abs() < 1e-12, "{segments:?}");
        }
    }
}
