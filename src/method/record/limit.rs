//! Bounds on the heat of films in a step. Heat flows from hot to cold, and no place of a wall that
//! responds to heat leaves the range of the hottest and the coldest film on it.
//!
//! The rise of a cell is that of purely vertical conduction, `u`. Where heat arrives laterally from
//! its neighbours, the rise is limited by a mean of u about the cell. Films that would bring a cell
//! beyond its bound transfer the fraction that it can absorb, and the remainder later. A cell that
//! is far beyond its bound without them absorbs nothing, and bounds none of its neighbours.

use super::footprint::{Footprint, Ring};
use super::lateral::Lateral;
use super::replay::Contribution;
use super::surface::SurfaceAt;
use crate::port::Surface;

/// Effect of a film on the wall.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    Warms,
    Cools,
}

impl Side {
    /// Side of a film from its heat [J] and the difference between the drop and the wall at contact
    /// [K]. It is `None` for heat that a ring takes back, as occurs in some records.
    pub fn of(difference: f64, heat: f64) -> Option<Self> {
        match (difference > 0.0, heat > 0.0) {
            _ if heat == 0.0 => None,
            (true, true) => Some(Side::Warms),
            (false, false) => Some(Side::Cools),
            _ => None,
        }
    }

    fn place(self) -> usize {
        usize::from(self == Side::Cools)
    }
}

/// Bound from films that warm a cell, or that cool it: the change that they cause [K], and the
/// temperature that they cannot exceed [K].
#[derive(Debug, Clone, Copy)]
struct Bound {
    rise: f64,
    bound: f64,
}

/// Temperature by which films may bring a cell beyond its bound, as the mean along the wall is an
/// estimate, over the difference between the bound and the wall. At twice as much other heat did,
/// and the cell bounds no neighbour.
const SLIGHT: f64 = 0.05;

/// Signs of the sides: warming and cooling.
const SIGNS: [f64; 2] = [1.0, -1.0];
const NONE: [Bound; 2] =
    [Bound { rise: 0.0, bound: f64::NEG_INFINITY }, Bound { rise: 0.0, bound: f64::INFINITY }];

/// A wall at the end of a step, with the contributions of films.
pub struct Limit<'a> {
    surface: SurfaceAt<'a>,
    areas: &'a [f64],
    duration: f64,
    /// Rises [K m²] under a mean flux of 1 J over the step and under one that falls from 1 W to −1
    /// W.
    held: f64,
    falling: f64,
    cells: Vec<[Bound; 2]>,
    touched: Vec<usize>,
}

/// Transferable fractions of the warming and of the cooling contributions of each cell.
pub type Parts = Vec<[f64; 2]>;

impl<'a> Limit<'a> {
    pub fn new(surface: &'a Surface, areas: &'a [f64], duration: f64) -> Self {
        Self {
            surface: SurfaceAt::new(surface, 1.0, duration),
            areas,
            duration,
            held: surface.response.of_held_flux(duration) / duration,
            falling: surface.response.of_falling_flux(duration),
            cells: vec![NONE; areas.len()],
            touched: Vec::new(),
        }
    }

    /// Adds the contribution of a film.
    pub fn add(&mut self, footprint: &Footprint, temperature: f64, rings: &[Contribution]) {
        for (ring, given) in footprint.rings.iter().zip(rings) {
            let Some(side) = given.side.map(Side::place) else { continue };
            let rise = (self.held * given.heat + self.falling * given.fall).abs();
            for part in &ring.parts {
                let sides = &mut self.cells[part.cell];
                if sides.iter().all(|side| side.bound.is_infinite()) {
                    self.touched.push(part.cell);
                }
                let Bound { rise: sum, bound } = &mut sides[side];
                *sum += part.weight * rise / self.areas[part.cell];
                let beyond = SIGNS[side] * (temperature - *bound);
                if beyond > 0.0 {
                    *bound = temperature;
                }
            }
        }
    }

    /// Transferable fractions; `None` if everything can be transferred everywhere.
    pub fn parts(&self, lateral: &Lateral) -> Option<Parts> {
        let mut parts = vec![[1.0; 2]; self.cells.len()];
        let free = self.touched.iter().map(|&cell| self.surface.temperature(cell));
        let free: Vec<f64> = free.collect();
        for (side, sign) in SIGNS.into_iter().enumerate() {
            self.straight_down((side, sign), &free, &mut parts);
            if self.is_near_bound((side, sign), &free) {
                let along = self.along((side, sign), &free, lateral, &parts);
                parts.iter_mut().zip(along).for_each(|(p, along)| p[side] = p[side].min(along));
            }
        }
        parts.iter().any(|parts| parts.iter().any(|part| *part < 1.0)).then_some(parts)
    }

    fn straight_down(&self, (side, sign): (usize, f64), free: &[f64], parts: &mut Parts) {
        for (&cell, free) in self.touched.iter().zip(free) {
            let Bound { rise, bound } = self.cells[cell][side];
            if bound.is_finite() {
                parts[cell][side] = part(sign * (bound - free), rise);
            }
        }
    }

    /// Returns true if some cell could exceed its bound with the largest rise of all cells.
    fn is_near_bound(&self, (side, sign): (usize, f64), free: &[f64]) -> bool {
        let on_side = || {
            let touched = self.touched.iter().zip(free);
            touched
                .map(|(&cell, free)| (self.cells[cell][side], *free))
                .filter(|(s, _)| s.bound.is_finite())
        };
        let most = on_side().map(|(side, _)| side.rise).fold(0.0, f64::max);
        on_side().any(|(side, free)| {
            let room = sign * (side.bound - free);
            room > 0.0 && room < most
        })
    }

    /// Fractions of each cell's contribution whose lateral heat fits all cells that it goes to.
    /// Those whose `parts` are zero give none.
    fn along(
        &self,
        (side, sign): (usize, f64),
        free: &[f64],
        lateral: &Lateral,
        parts: &Parts,
    ) -> Vec<f64> {
        let mut fractions = vec![1.0; parts.len()];
        let coldest = free.iter().map(|free| sign * free).fold(f64::INFINITY, f64::min);
        for (&cell, free) in self.touched.iter().zip(free) {
            let around = lateral.around(cell, self.duration);
            let of = |other: usize| self.cells[other][side];
            let giving = || around.iter().filter(|(other, _)| of(*other).bound.is_finite());
            let rise = |other: usize| {
                if parts[other][side] > 0.0 { of(other).rise } else { 0.0 }
            };
            let mean: f64 = giving().map(|(other, share)| share * rise(*other)).sum();
            let bound = giving().map(|(other, _)| sign * of(*other).bound).fold(f64::MIN, f64::max);
            let room = bound - sign * free;
            let part = match room > 0.0 {
                true => part(room, mean),
                false => (-room / (SLIGHT * (bound - coldest)) - 1.0).clamp(0.0, 1.0),
            };
            giving().for_each(|(other, _)| fractions[*other] = part.min(fractions[*other]));
        }
        fractions
    }

    /// Fraction of a ring's contribution that its cells can absorb.
    pub fn part_of(parts: &Parts, ring: &Ring, given: &Contribution) -> f64 {
        match given.side.map(Side::place) {
            Some(side) if !ring.parts.is_empty() => ring.mean(|cell| parts[cell][side]),
            _ => 1.0,
        }
    }
}

/// Heat [J] of each cell, and its fall [W], beyond an even distribution of each ring's.
pub struct Uneven {
    pub heat: Vec<f64>,
    pub fall: Vec<f64>,
}

impl Uneven {
    pub fn none(cells: usize) -> Self {
        Self { heat: vec![0.0; cells], fall: vec![0.0; cells] }
    }

    /// Distributes a ring's contribution, of which the fraction that its cells absorb remains, in
    /// proportion to what each of them absorbs.
    pub fn add(&mut self, parts: &Parts, ring: &Ring, given: &Contribution) {
        let mean = Limit::part_of(parts, ring, given);
        let Some(side) = given.side.map(Side::place).filter(|_| mean > 0.0 && mean < 1.0) else {
            return;
        };
        for part in &ring.parts {
            let more = part.weight * (parts[part.cell][side] / mean - 1.0);
            self.heat[part.cell] += more * given.heat;
            self.fall[part.cell] += more * given.fall;
        }
    }
}

/// Fraction of a rise that fits the available room.
fn part(room: f64, rise: f64) -> f64 {
    match rise {
        _ if room <= 0.0 => 0.0,
        rise if rise > room => room / rise,
        _ => 1.0,
    }
}
