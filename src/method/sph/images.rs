//! Images of particles beyond the planes that bound a model, or one period away.

use super::plan::{DropletPlan, Extent};

/// Bits of an image's code for each axis: beyond its far end, or beyond the plane at 0.
const FAR: u8 = 1;
const NEAR: u8 = 2;
const BITS: u8 = 6;
/// The wall z = 0 is the highest bit, so its images have the highest codes.
const WALL: u8 = NEAR << 4;
/// Shortest period, and smallest distance of planes, over H: it keeps images of images out of
/// reach.
const SHORTEST: f64 = 2.0;
/// Distance beyond its period, in periods, at which a particle is wrapped back.
const BEYOND: f64 = 0.1;

/// A particle, or an image of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Source(u32);

impl Source {
    /// Largest number of particles of a model.
    pub const MOST: usize = 1 << (32 - BITS);

    pub fn new(particle: usize, code: u8) -> Self {
        Self((particle as u32) << BITS | u32::from(code))
    }

    #[inline(always)]
    pub fn particle(self) -> usize {
        (self.0 >> BITS) as usize
    }

    /// Returns true if this is an image, not the particle itself.
    #[inline(always)]
    pub fn is_image(self) -> bool {
        self.code() != 0
    }

    #[inline(always)]
    pub fn code(self) -> u8 {
        (self.0 & ((1 << BITS) - 1)) as u8
    }
}

/// Position and motion of an image: each axis is reflected and then displaced.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Image {
    /// −1 along reflected axes.
    pub signs: [f64; 3],
    /// Displacement over H.
    pub offset: [f64; 3],
    /// 1, or −1 beyond a no-slip plane: such an image moves against its original.
    stick: f64,
    /// Body force per mass over c₀²/H along reflected axes.
    weight: [f64; 3],
}

impl Image {
    #[inline(always)]
    pub fn place(&self, x: [f64; 3]) -> [f64; 3] {
        [
            self.signs[0] * x[0] + self.offset[0],
            self.signs[1] * x[1] + self.offset[1],
            self.signs[2] * x[2] + self.offset[2],
        ]
    }

    /// Transforms a vector, such as the velocity of an image that slips.
    #[inline(always)]
    pub fn turn(&self, v: [f64; 3]) -> [f64; 3] {
        [self.signs[0] * v[0], self.signs[1] * v[1], self.signs[2] * v[2]]
    }

    /// The velocity of an image under no slip at the plane between it and its original.
    #[inline(always)]
    pub fn no_slip(&self, [u, v, w]: [f64; 3]) -> [f64; 3] {
        // Along z all of these planes reflect the velocity already.
        [self.stick * self.signs[0] * u, self.stick * self.signs[1] * v, self.signs[2] * w]
    }

    /// Excess of the image's pressure over that of its original at `x`, over ρ₀c₀²: the body force
    /// continues beyond a plane.
    #[inline(always)]
    pub fn overpressure(&self, x: [f64; 3]) -> f64 {
        self.weight[0] * (self.offset[0] - 2.0 * x[0])
            + self.weight[1] * (self.offset[1] - 2.0 * x[1])
            + self.weight[2] * (self.offset[2] - 2.0 * x[2])
    }

    /// Gradient of the pressure in an image, from that of its original.
    #[inline(always)]
    pub fn gradient(&self, g: [f64; 3]) -> [f64; 3] {
        [
            self.signs[0] * g[0] + 2.0 * self.weight[0],
            self.signs[1] * g[1] + 2.0 * self.weight[1],
            self.signs[2] * g[2] + 2.0 * self.weight[2],
        ]
    }

    /// The image whose image is the original.
    pub fn inverse(&self) -> Self {
        let offset = [0, 1, 2].map(|a| -self.signs[a] * self.offset[a]);
        Self { offset, ..*self }
    }
}

/// Number of copies of a particle due to the mirrors x = 0 and y = 0, itself included.
pub fn copies(mirrors: [bool; 2]) -> f64 {
    mirrors.iter().map(|&mirrored| if mirrored { 2.0 } else { 1.0 }).product()
}

/// Signs of x and y of these copies.
pub fn sides(mirrors: [bool; 2]) -> impl Iterator<Item = [f64; 2]> + use<> {
    let [along_x, along_y] =
        mirrors.map(|mirrored| if mirrored { &[1.0, -1.0][..] } else { &[1.0][..] });
    along_x.iter().flat_map(move |&x| along_y.iter().map(move |&y| [x, y]))
}

/// Ends of a model along an axis. Lengths over H.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ends {
    /// Impermeable planes at 0 and at a distance.
    Planes {
        near: bool,
        far: Option<f64>,
    },
    Period(f64),
}

/// All kinds of images of a model.
#[derive(Debug, Clone)]
pub struct Images {
    ends: [Ends; 3],
    /// True if the plane z = 0 is a wall that exchanges heat and momentum.
    walled: bool,
    /// True if x is a radius, so that a particle at x < 0 has crossed the axis.
    round: bool,
    /// Codes in ascending order; 0 is the particle itself.
    codes: Vec<u8>,
    /// Images for all codes.
    table: Vec<Image>,
}

impl Images {
    /// Images of a plan with support radius `length` [m], under a body force over c₀²/H.
    ///
    /// # Panics
    /// If an axis has a period and a plane, or is shorter than two support radii.
    pub fn of(plan: &DropletPlan, length: f64, gravity: [f64; 3]) -> Self {
        let walled = plan.wall.is_some();
        let near = [plan.mirrors[0], plan.mirrors[1], walled];
        let ends = [0, 1, 2].map(|a| match plan.extents[a] {
            Extent::Open => Ends::Planes { near: near[a], far: None },
            Extent::Closed(end) => Ends::Planes { near: true, far: Some(end / length) },
            Extent::Periodic(period) => {
                assert!(!near[a], "axis {a} is periodic, but has a plane at 0");
                Ends::Period(period / length)
            }
        });
        Self { round: plan.axisymmetric, ..Self::new(ends, walled, gravity) }
    }

    pub fn new(ends: [Ends; 3], walled: bool, gravity: [f64; 3]) -> Self {
        for (a, end) in ends.iter().enumerate() {
            if let Ends::Planes { far: Some(length), .. } | Ends::Period(length) = *end {
                assert!(
                    length >= SHORTEST,
                    "axis {a} is {length:.2} support radii long, at least 2"
                );
            }
        }
        let axis = |a: usize, code: u8| ends[a].image(code >> (2 * a) & (NEAR | FAR));
        let exists = |code: &u8| (0..3).all(|a| axis(a, *code).is_some());
        let image = |code: u8| {
            let axes = [0, 1, 2].map(|a| axis(a, code).unwrap_or((1.0, 0.0)));
            let signs = axes.map(|axis| axis.0);
            let weight = [0, 1, 2].map(|a| if signs[a] < 0.0 { gravity[a] } else { 0.0 });
            Image { signs, offset: axes.map(|axis| axis.1), stick: signs[2], weight }
        };
        let codes = (0..1 << BITS).filter(exists).collect();
        Self { ends, walled, round: false, codes, table: (0..1 << BITS).map(image).collect() }
    }

    /// Returns true if no planes bound the model but those at zero.
    pub fn are_open(&self) -> bool {
        self.ends.iter().all(|ends| !matches!(ends, Ends::Planes { far: Some(_), .. }))
    }

    pub fn ends(&self) -> [Ends; 3] {
        self.ends
    }

    /// Returns for each axis whether all particles stay above 0.
    pub fn begin(&self) -> [bool; 3] {
        let mut begin = self.ends.map(|ends| matches!(ends, Ends::Planes { near: true, .. }));
        begin[0] |= self.round;
        begin
    }

    /// Codes of all images, those at the wall last.
    pub fn codes(&self) -> &[u8] {
        &self.codes
    }

    #[inline(always)]
    pub fn get(&self, code: u8) -> &Image {
        &self.table[usize::from(code)]
    }

    /// Returns true if an image lies beyond the wall.
    pub fn is_at_wall(&self, code: u8) -> bool {
        self.walled && code & WALL != 0
    }

    /// Wraps a position beyond a period back into it.
    pub fn wrap(&self, x: &mut [f64; 3]) {
        for (x, ends) in x.iter_mut().zip(self.ends) {
            if let Ends::Period(period) = ends {
                *x -= period * (*x / period).floor();
            }
        }
    }

    /// Returns true if particles are so far beyond a period that they must be wrapped back. Until
    /// then they keep their positions, so that lists of neighbours remain valid.
    pub fn are_beyond_period(&self, points: &[[f64; 3]]) -> bool {
        (0..3).any(|a| match self.ends[a] {
            Ends::Period(period) => {
                let range = -BEYOND * period..(1.0 + BEYOND) * period;
                points.iter().any(|x| !range.contains(&x[a]))
            }
            Ends::Planes { .. } => false,
        })
    }

    /// Moves a particle that crossed a plane to the position of its image, which crossed it at the
    /// same time. Returns the signs for its velocity.
    pub fn reflect_back(&self, x: &mut [f64; 3]) -> [f64; 3] {
        let mut signs = [1.0; 3];
        for a in 0..3 {
            let Ends::Planes { near, far } = self.ends[a] else { continue };
            if (near || (a == 0 && self.round)) && x[a] < 0.0 {
                x[a] = -x[a];
                signs[a] = -1.0;
            } else if let Some(end) = far.filter(|&end| x[a] > end) {
                x[a] = 2.0 * end - x[a];
                signs[a] = -1.0;
            }
        }
        signs
    }
}

impl Ends {
    /// Sign and offset of an image; `None` where there is none.
    fn image(self, side: u8) -> Option<(f64, f64)> {
        match (side, self) {
            (0, _) => Some((1.0, 0.0)),
            (NEAR, Ends::Planes { near, .. }) => near.then_some((-1.0, 0.0)),
            (FAR, Ends::Planes { far, .. }) => far.map(|end| (-1.0, 2.0 * end)),
            (NEAR, Ends::Period(period)) => Some((1.0, -period)),
            (FAR, Ends::Period(period)) => Some((1.0, period)),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const OPEN: Ends = Ends::Planes { near: false, far: None };

    #[test]
    fn source_round_trips_particle_and_code() {
        for particle in [0, 1, Source::MOST - 1] {
            for code in [0, 1, 42, 63] {
                let source = Source::new(particle, code);
                assert_eq!((source.particle(), source.code()), (particle, code));
            }
        }
    }

    #[test]
    fn inverse_image_restores_the_particle() {
        let ends = [Ends::Period(4.0), OPEN, Ends::Planes { near: true, far: Some(5.0) }];
        let images = Images::new(ends, true, [0.0; 3]);
        assert_eq!(images.codes().len(), 9);
        let x = [0.3, -2.0, 4.1];
        for &code in images.codes() {
            let image = images.get(code);
            let back = image.inverse().place(image.place(x));
            assert!((0..3).all(|a| (back[a] - x[a]).abs() < 1e-14), "{code}: {back:?}");
        }
    }

    #[test]
    fn images_at_planes_are_reflections() {
        let ends = [OPEN, OPEN, Ends::Planes { near: true, far: Some(5.0) }];
        let images = Images::new(ends, true, [0.0, 0.0, -0.1]);
        let x = [0.3, -2.0, 4.1];
        let heights: Vec<f64> = images.codes().iter().map(|&c| images.get(c).place(x)[2]).collect();
        assert_eq!(heights, [4.1, 5.9, -4.1]);
        for &code in images.codes() {
            let image = images.get(code);
            // As in a fluid at rest.
            let height = image.place(x)[2] - x[2];
            assert!((image.overpressure(x) + 0.1 * height).abs() < 1e-14);
            assert_eq!(image.gradient([0.0, 0.0, -0.1]), [0.0, 0.0, -0.1]);
        }
        let [lid, wall] = [1, 2].map(|n| images.codes()[n]);
        assert!(images.is_at_wall(wall) && !images.is_at_wall(lid));
        assert_eq!(images.get(lid).no_slip([1.0, 2.0, 3.0]), [-1.0, -2.0, -3.0]);
    }

    #[test]
    fn particles_stay_between_planes_and_within_periods() {
        let ends = [Ends::Period(4.0), OPEN, Ends::Planes { near: true, far: Some(5.0) }];
        let images = Images::new(ends, false, [0.0; 3]);
        let mut low = [-0.5, -7.0, -0.25];
        assert_eq!(images.reflect_back(&mut low), [1.0, 1.0, -1.0]);
        images.wrap(&mut low);
        assert_eq!(low, [3.5, -7.0, 0.25]);
        let mut high = [9.0, 7.0, 5.25];
        assert_eq!(images.reflect_back(&mut high), [1.0, 1.0, -1.0]);
        assert!(images.are_beyond_period(&[high]) && !images.are_beyond_period(&[low]));
        images.wrap(&mut high);
        assert_eq!(high, [1.0, 7.0, 4.75]);
    }

    #[test]
    #[should_panic(expected = "support radii")]
    fn axis_shorter_than_two_supports_is_refused() {
        Images::new([Ends::Period(1.9), OPEN, OPEN], false, [0.0; 3]);
    }
}
