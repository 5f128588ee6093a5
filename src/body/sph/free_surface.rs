//! The grid on both sides of free surfaces over which their energy is summed.

use super::cloud::Cloud;
use super::grid::Grid;
use super::images::Images;
use super::loops::{Precision, for_all};
use super::neighbours::{Neighbours, Travelling, Ways};
use super::order::{BLOCK, Bounds, space_order};
use super::plan::DropletPlan;
use super::tension::{Fraction, Fractions, Pull, Pulls, Slopes, SurfaceEnergy};
use crate::kernel::Kernel;
use crate::math::parallel::Team;

/// Points of the grid over the support radius of the volume fraction. At 5 the grid slows the flow of
/// a drop of 28 particles over its diameter, at 6 no more.
const FINENESS: f64 = 6.0;
/// Reach of the set of points beyond the surface, in steps of the motion against the grid; its bounds.
const SKIN_STEPS: f64 = 20.0;
const SKINS: [f64; 2] = [0.1, 0.3];

/// What a model's free surfaces are computed with.
#[derive(Debug, Clone)]
pub struct Setting {
    pub energy: SurfaceEnergy,
    pub grid: Grid,
    pub images: Images,
    pub kernel: Kernel,
    pub precision: Precision,
}

impl Setting {
    /// For a plan with images of the model, and a surface tension over ρ₀c₀²H.
    pub fn of(plan: &DropletPlan, tension: f64, images: &Images) -> Self {
        let cosine = plan.wall.as_ref().map_or(0.0, |wall| wall.contact_angle.cos());
        let spacing = 1.0 / plan.support;
        let energy = SurfaceEnergy::of(tension, cosine, plan.kernel, spacing, plan.dimension);
        Self {
            energy,
            grid: Grid::of(images.ends(), energy.reach / FINENESS, plan.dimension),
            images: images.clone(),
            kernel: plan.kernel,
            precision: plan.precision,
        }
    }
}

/// Points near free surfaces, and their neighbours among the particles.
///
/// Along axes without planes and periods the grid moves with the fluid's centre of mass, so that the
/// energy depends on no place in space and its forces change no momentum.
#[derive(Default)]
pub struct FreeSurface {
    /// About the grid's origin, and whether they stand for the wall.
    bases: Vec<([f64; 3], bool)>,
    points: Vec<[f64; 3]>,
    round_points: Neighbours,
    round_particles: Neighbours,
    /// How far the fluid may still move against the grid; nothing where no points are known.
    slack: Option<f64>,
    fractions: Vec<Fraction>,
}

impl FreeSurface {
    /// Looks for all points anew when they are next needed.
    pub fn forget(&mut self) {
        self.slack = None;
    }

    /// Makes sure of all points near surfaces, and of their neighbours, where the particles of `cloud`
    /// are and on their ways.
    pub fn prepare(&mut self, setting: &Setting, cloud: &Cloud, ways: &Ways, team: &Team) {
        let drift = middle_way(ways, cloud, &setting.grid);
        let apart = |way: &Bounds| way.joined(&drift).diagonal();
        let motion = ways.of_blocks.iter().map(apart).fold(0.0, f64::max);
        self.slack = self.slack.map(|slack| slack - motion).filter(|&slack| slack > 0.0);
        if self.slack.is_none() {
            let skin = (SKIN_STEPS * motion).clamp(SKINS[0], SKINS[1]).max(1.5 * motion);
            self.find(setting, cloud, skin, team);
            self.slack = Some(skin - motion);
        }
        let blocks = self.points.len().div_ceil(BLOCK);
        let drifts = Ways { of_blocks: vec![drift; blocks], steps: ways.steps };
        let points = Travelling { points: &self.points, ways: &drifts };
        let particles = Travelling { points: &cloud.position, ways };
        self.round_points.prepare_between(points, particles, &setting.images, team);
        self.round_particles.prepare_between(particles, points, &setting.images, team);
    }

    /// Finds all points that a surface may come to within `skin`.
    fn find(&mut self, setting: &Setting, cloud: &Cloud, skin: f64, team: &Team) {
        let Setting { grid, energy, .. } = setting;
        let origin = mean(&cloud.position, &cloud.mass, grid);
        let from_origin = |base: [f64; 3]| [0, 1, 2].map(|a| origin[a] + base[a]);
        let bins = grid.bins(&cloud.position, origin);
        let cells: Vec<[i32; 3]> = bins.into_iter().flat_map(|bin| grid.cells(bin)).collect();
        let middles: Vec<_> = cells.iter().map(|&cell| from_origin(grid.middle(cell))).collect();
        let order = space_order(&middles, team);
        let cells: Vec<_> = order.iter().map(|&k| cells[k as usize]).collect();
        let middles: Vec<_> = order.iter().map(|&k| middles[k as usize]).collect();
        let particles = &cloud.position;
        let mut neighbours = Neighbours::between(middles.len(), particles, energy.reach, team);
        let [still, at_rest] = [middles.len(), cloud.len()].map(Ways::none);
        neighbours.prepare_between(
            Travelling { points: &middles, ways: &still },
            Travelling { points: particles, ways: &at_rest },
            &setting.images,
            team,
        );
        let fractions = fractions(setting, cloud, &middles, &neighbours, team, Vec::new());
        let reach = grid.cell_radius() + skin;
        let near = cells.iter().zip(&fractions).filter(|(_, f)| energy.is_near(f, reach));
        let points: Vec<[i32; 3]> = near.flat_map(|(&cell, _)| grid.points(cell)).collect();
        let mut bases: Vec<_> = points.iter().map(|&point| (grid.place(point), false)).collect();
        if energy.wets() {
            let lowest = points.iter().filter(|point| point[2] == 0);
            bases.extend(lowest.map(|&point| {
                let [x, y, _] = grid.place(point);
                ([x, y, 0.0], true)
            }));
        }
        let places: Vec<_> = bases.iter().map(|&(base, _)| from_origin(base)).collect();
        let order = space_order(&places, team);
        self.bases = order.iter().map(|&k| bases[k as usize]).collect();
        self.points = order.iter().map(|&k| places[k as usize]).collect();
        let count = self.points.len();
        self.round_points = Neighbours::between(count, particles, energy.reach, team);
        self.round_particles = Neighbours::between(cloud.len(), &self.points, energy.reach, team);
    }

    /// Pull on all particles, and the energy over ρ₀c₀²H^d.
    pub fn pulls(&mut self, setting: &Setting, cloud: &Cloud, team: &Team) -> (Vec<Pull>, f64) {
        let Setting { grid, energy, images, kernel, precision } = setting;
        let origin = mean(&cloud.position, &cloud.mass, grid);
        for (point, (base, _)) in self.points.iter_mut().zip(&self.bases) {
            *point = [0, 1, 2].map(|a| origin[a] + base[a]);
        }
        let memory = std::mem::take(&mut self.fractions);
        let round = &self.round_points;
        self.fractions = fractions(setting, cloud, &self.points, round, team, memory);
        let (volume, area) = (grid.volume(), grid.area());
        let slopes: Vec<Slopes> = team.map(self.points.len(), |k| match self.bases[k].1 {
            true => energy.of_wall(&self.fractions[k], area),
            false => energy.of_free(&self.fractions[k], volume),
        });
        let records: Vec<[f64; 8]> = team.map(self.points.len(), |k| {
            let ([x, y, z], slopes) = (self.points[k], &slopes[k]);
            let [a, b, c] = slopes.by_gradient;
            [x, y, z, a, b, c, slopes.by_fraction, 0.0]
        });
        let pass = Pulls { images, records: &records, points: &cloud.position, energy: *energy };
        let blocks = &self.round_particles.blocks;
        let pulls = for_all(&pass, blocks, (*kernel, *precision), team, Vec::new());
        (pulls, slopes.iter().map(|slopes| slopes.energy).sum())
    }
}

fn fractions(
    setting: &Setting,
    cloud: &Cloud,
    points: &[[f64; 3]],
    neighbours: &Neighbours,
    team: &Team,
    memory: Vec<Fraction>,
) -> Vec<Fraction> {
    let Setting { images, energy, kernel, precision, .. } = setting;
    // Volumes are those at rest, so that the energy depends on places alone.
    let records: Vec<[f64; 8]> = team.map(cloud.len(), |i| {
        let [x, y, z] = cloud.position[i];
        [x, y, z, 0.0, 0.0, 0.0, cloud.mass[i], 0.0]
    });
    let pass = Fractions { images, records: &records, points, energy: *energy };
    for_all(&pass, &neighbours.blocks, (*kernel, *precision), team, memory)
}

/// Mean of a vector of every particle along the axes in which the grid is free; 0 along others.
fn mean(vectors: &[[f64; 3]], masses: &[f64], grid: &Grid) -> [f64; 3] {
    let mass: f64 = masses.iter().sum();
    [0, 1, 2].map(|a| match grid.is_free(a) && mass > 0.0 {
        true => vectors.iter().zip(masses).map(|(v, m)| m * v[a]).sum::<f64>() / mass,
        false => 0.0,
    })
}

/// Bounds of the way of the fluid's centre of mass along the axes in which the grid is free.
fn middle_way(ways: &Ways, cloud: &Cloud, grid: &Grid) -> Bounds {
    let masses: Vec<f64> = cloud.mass.chunks(BLOCK).map(|masses| masses.iter().sum()).collect();
    let corners = |corner: fn(&Bounds) -> [f64; 3]| -> [f64; 3] {
        let corners: Vec<_> = ways.of_blocks.iter().map(corner).collect();
        mean(&corners, &masses, grid)
    };
    Bounds { low: corners(|way| way.low), high: corners(|way| way.high) }
}

#[cfg(test)]
mod tests {
    use super::super::images::Ends;
    use super::*;

    const SPACING: f64 = 0.4;

    /// A lump of particles over the wall and beside a mirror, and what its surface is computed with.
    fn lump(cosine: f64) -> (Setting, Cloud) {
        let mut cloud = Cloud::default();
        let shake = |n: i32| 0.1 * ((f64::from(n) * 0.754877666).fract() - 0.5);
        let numbers =
            (0..4).flat_map(|i| (-3..3).flat_map(move |j| (0..3).map(move |k| [i, j, k])));
        for (n, number) in (0..).zip(numbers) {
            let at = |a: usize| SPACING * (f64::from(number[a]) + 0.5 + shake(3 * n + a as i32));
            cloud.push([at(0), at(1), at(2)], [0.0; 3], SPACING.powi(3), 0.0);
        }
        let open = Ends::Planes { near: false, far: None };
        let plane = Ends::Planes { near: true, far: None };
        let ends = [plane, open, plane];
        let energy = SurfaceEnergy::of(1.0, cosine, Kernel::WendlandC2, SPACING, 3);
        let setting = Setting {
            energy,
            grid: Grid::of(ends, energy.reach / FINENESS, 3),
            images: Images::new(ends, true, [0.0; 3]),
            kernel: Kernel::WendlandC2,
            precision: Precision::Double,
        };
        (setting, cloud)
    }

    fn pulls(setting: &Setting, cloud: &Cloud) -> (Vec<Pull>, f64) {
        let (team, mut surface) = (Team::new(1), FreeSurface::default());
        surface.prepare(setting, cloud, &Ways::none(cloud.len()), &team);
        surface.pulls(setting, cloud, &team)
    }

    #[test]
    fn pulls_are_the_derivatives_of_the_energy() {
        const STEP: f64 = 1e-5;
        for cosine in [0.0, 0.6] {
            let (setting, cloud) = lump(cosine);
            let (all, _) = pulls(&setting, &cloud);
            let mass: f64 = cloud.mass.iter().sum();
            for i in [0, 7, 30, 71] {
                for a in 0..3 {
                    let moved = |step: f64| {
                        let mut cloud = cloud.clone();
                        cloud.position[i][a] += step;
                        pulls(&setting, &cloud).1
                    };
                    let slope = (moved(-STEP) - moved(STEP)) / (2.0 * STEP) / cloud.mass[i];
                    let force = |pull: &Pull| pull.by_fluid[a] + pull.by_wall[a];
                    // Along y the grid goes with the centre of mass.
                    let all_of_them: f64 =
                        all.iter().zip(&cloud.mass).map(|(pull, m)| m * force(pull)).sum();
                    let mean = if a == 1 { all_of_them / mass } else { 0.0 };
                    let found = force(&all[i]) - mean;
                    assert!((slope - found).abs() < 1e-4, "{cosine} {i} {a}: {slope} {found}");
                }
            }
        }
    }

    #[test]
    fn the_potential_is_the_derivative_by_volume() {
        let (setting, cloud) = lump(0.6);
        let (all, _) = pulls(&setting, &cloud);
        for i in [0, 30, 71] {
            let grown = |by: f64| {
                let mut cloud = cloud.clone();
                cloud.mass[i] += by;
                // The grid's place depends on masses.
                pulls(&setting, &cloud).1
            };
            let slope = (grown(1e-6) - grown(-1e-6)) / 2e-6;
            assert!((slope - all[i].potential).abs() < 2e-2, "{i}: {slope} {}", all[i].potential);
        }
    }

    #[test]
    fn points_last_while_the_fluid_goes_by() {
        let (setting, mut cloud) = lump(0.0);
        let (team, mut surface) = (Team::new(1), FreeSurface::default());
        for step in 0..30 {
            let way = [0.0, 0.3, if step < 15 { 0.01 } else { -0.01 }];
            let ways = Ways::along(&vec![way; cloud.len()], 30.0, &team);
            surface.prepare(&setting, &cloud, &ways, &team);
            cloud.position.iter_mut().for_each(|x| (0..3).for_each(|a| x[a] += way[a]));
            let kept = surface.pulls(&setting, &cloud, &team).1;
            let anew = pulls(&setting, &cloud).1;
            // Points where the surface is faint may be left out.
            assert!((kept - anew).abs() < 3e-5 * anew, "{step}: {kept} {anew}");
        }
    }
}
