//! The grid on both sides of free surfaces over which their energy is summed.

use super::cloud::Cloud;
use super::field::Field;
use super::fractions::{Energies, Fractions, Sheet, Slopes, from};
use super::grid::Grid;
use super::images::{Ends, Images};
use super::lanes::WIDTH;
use super::neighbours::Displacements;
use super::order::{BLOCK, Bounds, space_order};
use super::plan::DropletPlan;
use super::pulls::{Pull, Pulls};
use super::tension::SurfaceEnergy;
use crate::runtime::parallel::Team;
use crate::scene::Precision;

/// Grid points per support radius of the volume fraction. The energy's dependence on the grid's
/// position damps an oscillating drop like friction. At 6 this adds 0.12 of the amplitude per
/// period to viscous damping (32 particles per diameter), at 8 a third of that.
const FINENESS: f64 = 8.0;
/// Reach of the set of points beyond the surface, in steps of the motion against the grid; its
/// bounds.
const SKIN_STEPS: f64 = 20.0;
const SKINS: [f64; 2] = [0.1, 0.3];
/// Number of bins whose particles are searched for together.
const TOGETHER: usize = 4;

/// Settings of the free surfaces of a model.
#[derive(Debug, Clone)]
pub struct Setting {
    pub energy: SurfaceEnergy,
    pub grid: Grid,
    pub images: Images,
    pub precision: Precision,
    /// True if particles are rings.
    pub rings: bool,
}

impl Setting {
    /// Settings for a plan with images of the model, and a surface tension over ρ₀c₀²H.
    pub fn of(plan: &DropletPlan, tension: f64, images: &Images) -> Self {
        let cosine = plan.wall.as_ref().map_or(0.0, |wall| wall.contact_angle.cos());
        let spacing = 1.0 / plan.support;
        let mut ends = images.ends();
        if plan.axisymmetric {
            // Points begin at the axis, as they do at a plane.
            ends[0] = Ends::Planes { near: true, far: None };
        }
        let energy = SurfaceEnergy::of(tension, cosine, spacing, plan.dimension);
        Self {
            energy,
            grid: Grid::of(ends, energy.smoothing.reach / FINENESS, plan.axes()),
            images: images.clone(),
            precision: plan.precision,
            rings: plan.axisymmetric,
        }
    }

    fn fractions<'a>(&'a self, cloud: &'a Cloud, field: &'a Field) -> Fractions<'a> {
        Fractions {
            field,
            images: &self.images,
            positions: &cloud.position,
            volumes: &cloud.mass,
            smoothing: self.energy.smoothing,
            precision: self.precision,
            rings: self.rings,
            origin: mean(&cloud.position, &cloud.mass, &self.grid),
        }
    }
}

/// Sheets of points near free surfaces.
///
/// Along axes without planes and periods the grid moves with the fluid's centre of mass. The energy
/// then depends on no absolute position, and its forces conserve momentum.
#[derive(Default)]
pub struct FreeSurface {
    sheets: Vec<Sheet>,
    /// Lengths of consecutive groups of neighbouring sheets.
    together: Vec<usize>,
    /// Remaining motion of the fluid against the grid; `None` where no sheets are known.
    slack: Option<f64>,
    /// Slopes of all sheets, and their pulls on all particles.
    slopes: Vec<Slopes>,
    pulls: Vec<Pull>,
}

impl FreeSurface {
    /// Discards the points, so that they are found anew when next needed.
    pub fn forget(&mut self) {
        self.slack = None;
    }

    /// Finds all points near surfaces of the particles of `cloud`, at their positions and along
    /// their paths.
    pub fn prepare(
        &mut self,
        setting: &Setting,
        cloud: &Cloud,
        displacements: &Displacements,
        team: &Team,
    ) {
        let drift = centre_displacement(displacements, cloud, &setting.grid);
        let apart = |way: &Bounds| way.joined(&drift).diagonal();
        let motion = displacements.of_blocks.iter().map(apart).fold(0.0, f64::max);
        self.slack = self.slack.map(|slack| slack - motion).filter(|&slack| slack > 0.0);
        if self.slack.is_none() {
            let skin = (SKIN_STEPS * motion).clamp(SKINS[0], SKINS[1]).max(1.5 * motion);
            self.find(setting, cloud, skin, team);
            self.slack = Some(skin - motion);
        }
    }

    /// Finds all sheets with points that lie within `skin` of a surface.
    fn find(&mut self, setting: &Setting, cloud: &Cloud, skin: f64, team: &Team) {
        let Setting { grid, energy, .. } = setting;
        let field = Field::of(&cloud.position, team);
        let fractions = setting.fractions(cloud, &field);
        let bins = grid.bins(&cloud.position, fractions.origin, energy.farthest() + skin);
        let middles: Vec<_> = bins.iter().map(|&bin| grid.middle(bin)).collect();
        let order = space_order(&middles, team);
        let middles: Vec<_> = order.iter().map(|&k| middles[k as usize]).collect();
        let quarters = fractions.about(&middles, &grid.quarters(), team);
        let reach = grid.quarter_radius() + skin;
        let is_near = |&[fraction, length]: &[f64; 2]| energy.is_near(fraction, length, reach);
        self.sheets.clear();
        self.together.clear();
        for (numbers, quarters) in order.chunks(TOGETHER).zip(quarters.chunks(TOGETHER)) {
            let before = self.sheets.len();
            for (&k, quarters) in numbers.iter().zip(quarters) {
                let of_sheets = quarters.chunks(WIDTH / 4);
                let near = of_sheets.map(|quarters| quarters.iter().any(is_near));
                self.keep(setting, bins[k as usize], near);
            }
            self.together.push(self.sheets.len() - before);
        }
        self.together.retain(|&count| count > 0);
    }

    /// Keeps the sheets of a bin that a surface may reach, and their points in the wall below the
    /// lowest sheet.
    fn keep(&mut self, setting: &Setting, bin: [i32; 3], near: impl Iterator<Item = bool>) {
        let Setting { grid, energy, .. } = setting;
        let sheets = grid.sheets(bin).into_iter().zip(near).enumerate();
        for (n, (middle, _)) in sheets.filter(|&(_, (_, near))| near) {
            self.sheets.push(Sheet { middle, at_wall: 0 });
            let below = grid.at_wall(bin).filter(|_| n == 0 && energy.wets());
            self.sheets.extend(below.map(|(middle, at_wall)| Sheet { middle, at_wall }));
        }
    }

    /// Pulls on all particles, and the energy over ρ₀c₀²H^d.
    pub fn pulls(&mut self, setting: &Setting, cloud: &Cloud, team: &Team) -> (&[Pull], f64) {
        let Setting { grid, energy, images, precision, rings } = setting;
        let field = Field::of(&cloud.position, team);
        let fractions = setting.fractions(cloud, &field);
        let spread = grid.spread();
        let energies = Energies { law: *energy, volume: grid.volume(), area: grid.area() };
        self.slopes.resize(self.sheets.len(), Slopes::default());
        let sheets = (&self.sheets[..], &self.together[..]);
        fractions.slopes(sheets, (&energies, &spread), &mut self.slopes, team);
        let at = |n: u32| from(fractions.origin, self.sheets[n as usize].middle);
        let all = 0..self.sheets.len() as u32;
        let pulling: Vec<u32> = all.filter(|&n| !self.slopes[n as usize].are_none()).collect();
        let middles: Vec<[f64; 3]> = pulling.iter().map(|&n| at(n)).collect();
        let pass = Pulls {
            images,
            smoothing: energy.smoothing,
            precision: *precision,
            rings: *rings,
            spread: &spread,
            sheets: &pulling,
            middles: &middles,
            slopes: &self.slopes,
        };
        self.pulls.resize(cloud.len(), Pull::default());
        pass.on(&cloud.position, &mut self.pulls, team);
        (&self.pulls, self.slopes.iter().map(|slopes| slopes.energy).sum())
    }
}

/// Mean of a vector of every particle along the axes in which the grid is free; 0 along others.
fn mean(vectors: &[[f64; 3]], masses: &[f64], grid: &Grid) -> [f64; 3] {
    let mass: f64 = masses.iter().sum();
    [0, 1, 2].map(|a| match grid.is_free(a) && mass > 0.0 {
        true => vectors.iter().zip(masses).map(|(v, m)| m * v[a]).sum::<f64>() / mass,
        false => 0.0,
    })
}

/// Bounds of the path of the fluid's centre of mass along the axes in which the grid is free.
fn centre_displacement(displacements: &Displacements, cloud: &Cloud, grid: &Grid) -> Bounds {
    let masses: Vec<f64> = cloud.mass.chunks(BLOCK).map(|masses| masses.iter().sum()).collect();
    let corners = |corner: fn(&Bounds) -> [f64; 3]| -> [f64; 3] {
        let corners: Vec<_> = displacements.of_blocks.iter().map(corner).collect();
        mean(&corners, &masses, grid)
    };
    Bounds { low: corners(|way| way.low), high: corners(|way| way.high) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPACING: f64 = 0.4;

    /// A lump of particles over the wall, next to a mirror, and the settings of its surface.
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
        let energy = SurfaceEnergy::of(1.0, cosine, SPACING, 3);
        let setting = Setting {
            energy,
            grid: Grid::of(ends, energy.smoothing.reach / FINENESS, 3),
            images: Images::new(ends, true, [0.0; 3]),
            precision: Precision::Double,
            rings: false,
        };
        (setting, cloud)
    }

    /// The same for rings about the axis, over the wall.
    fn rings(cosine: f64) -> (Setting, Cloud) {
        let (setting, lump) = lump(cosine);
        let ends = setting.images.ends();
        let grid = Grid::of(ends, setting.energy.smoothing.reach / FINENESS, 2);
        let ends = [Ends::Planes { near: false, far: None }, ends[1], ends[2]];
        let images = Images::new(ends, true, [0.0; 3]);
        let mut cloud = Cloud::default();
        for [x, _, z] in lump.position.into_iter().filter(|x| (0.0..SPACING).contains(&x[1])) {
            let volume = 2.0 * std::f64::consts::PI * x * SPACING.powi(2);
            cloud.push([x, 0.0, z], [0.0; 3], volume, 0.0);
        }
        (Setting { grid, images, rings: true, ..setting }, cloud)
    }

    #[test]
    fn pulls_on_rings_are_energy_derivatives() {
        const STEP: f64 = 1e-4;
        for cosine in [0.0, 0.6] {
            let (setting, cloud) = rings(cosine);
            let (all, _) = pulls(&setting, &cloud);
            let force = |pull: &Pull, a: usize| pull.by_fluid[a] + pull.by_wall[a];
            let largest = all.iter().flat_map(|pull| [force(pull, 0), force(pull, 2)]);
            let largest = largest.map(f64::abs).fold(0.0, f64::max);
            for (i, pull) in all.iter().enumerate() {
                assert_eq!(force(pull, 1), 0.0);
                for a in [0, 2] {
                    let moved = |step: f64| {
                        let mut cloud = cloud.clone();
                        cloud.position[i][a] += step;
                        pulls(&setting, &cloud).1
                    };
                    let slope = (moved(-STEP) - moved(STEP)) / (2.0 * STEP) / cloud.mass[i];
                    let found = force(pull, a);
                    // Places on arcs move with their ends.
                    assert!(
                        (slope - found).abs() < 0.02 * largest,
                        "{cosine} {i} {a}: {slope} {found}, of up to {largest}"
                    );
                }
            }
        }
    }

    fn pulls(setting: &Setting, cloud: &Cloud) -> (Vec<Pull>, f64) {
        let (team, mut surface) = (Team::new(1), FreeSurface::default());
        surface.prepare(setting, cloud, &Displacements::none(cloud.len()), &team);
        let (pulls, energy) = surface.pulls(setting, cloud, &team);
        (pulls.to_vec(), energy)
    }

    #[test]
    fn pulls_are_energy_derivatives() {
        const STEP: f64 = 1e-5;
        for cosine in [0.0, 0.6] {
            let (setting, cloud) = lump(cosine);
            let (all, _) = pulls(&setting, &cloud);
            let mass: f64 = cloud.mass.iter().sum();
            for i in [0, 30] {
                for a in 0..3 {
                    let moved = |step: f64| {
                        let mut cloud = cloud.clone();
                        cloud.position[i][a] += step;
                        pulls(&setting, &cloud).1
                    };
                    let slope = (moved(-STEP) - moved(STEP)) / (2.0 * STEP) / cloud.mass[i];
                    let force = |pull: &Pull| pull.by_fluid[a] + pull.by_wall[a];
                    // Along y the grid moves with the centre of mass.
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
    fn potential_is_the_energy_derivative_by_volume() {
        let (setting, cloud) = lump(0.6);
        let (all, _) = pulls(&setting, &cloud);
        for i in [0, 30, 71] {
            let grown = |by: f64| {
                let mut cloud = cloud.clone();
                cloud.mass[i] += by;
                // The grid's position depends on masses.
                pulls(&setting, &cloud).1
            };
            let slope = (grown(1e-6) - grown(-1e-6)) / 2e-6;
            assert!((slope - all[i].potential).abs() < 2e-2, "{i}: {slope} {}", all[i].potential);
        }
    }

    #[test]
    fn points_remain_valid_while_the_fluid_moves() {
        let (setting, mut cloud) = lump(0.0);
        let (team, mut surface) = (Team::new(1), FreeSurface::default());
        for step in 0..12 {
            let way = [0.0, 0.3, if step < 6 { 0.01 } else { -0.01 }];
            let displacements = Displacements::along(&vec![way; cloud.len()], 30.0, &team);
            surface.prepare(&setting, &cloud, &displacements, &team);
            cloud.position.iter_mut().for_each(|x| (0..3).for_each(|a| x[a] += way[a]));
            let kept = surface.pulls(&setting, &cloud, &team).1;
            let anew = pulls(&setting, &cloud).1;
            // Points where the surface is faint may be skipped.
            assert!((kept - anew).abs() < 3e-5 * anew, "{step}: {kept} {anew}");
        }
    }
}
