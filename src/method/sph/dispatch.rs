//! Loops compiled for several instruction sets; the widest one available runs.

use super::lanes::{Array, Lanes};
use crate::scene::Precision;

/// Work on vectors, generic in the vector type.
pub trait Work {
    /// Runs the work. Mark implementations `inline(always)`, so that they are compiled for the
    /// chosen instructions.
    fn run<L: Lanes>(self);
}

/// Instruction set of a processor, or a limit on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Instructions {
    Plain,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

/// Runs the work with the widest instructions that the processor has.
pub fn dispatch(work: impl Work, precision: Precision) {
    if precision == Precision::Double {
        return work.run::<Array<f64>>();
    }
    match widest() {
        Instructions::Plain => work.run::<Array<f32>>(),
        // SAFETY: the processor has the features that the functions require.
        #[cfg(target_arch = "x86_64")]
        Instructions::Avx2 => unsafe { run_avx2(work) },
        #[cfg(target_arch = "x86_64")]
        Instructions::Avx512 => unsafe { run_avx512(work) },
    }
}

fn widest() -> Instructions {
    #[cfg(test)]
    return tests::LIMIT.get().map_or(found(), |limit| limit.min(found()));
    #[cfg(not(test))]
    found()
}

fn found() -> Instructions {
    #[cfg(target_arch = "x86_64")]
    {
        if is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512vl") {
            return Instructions::Avx512;
        }
        if is_x86_feature_detected!("avx2") {
            return Instructions::Avx2;
        }
    }
    Instructions::Plain
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512vl")]
fn run_avx512(work: impl Work) {
    work.run::<super::lanes::Avx512>();
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn run_avx2(work: impl Work) {
    work.run::<Array<f32>>();
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::Instructions;
    use crate::kernel::Kernel;
    use crate::method::sph::{DropletPlan, DropletSph, Extent, Fluid, Placement, Precision};
    use crate::method::sph::{Release, Viscous, Wall};
    use crate::port::WallCells;

    thread_local! {
        /// Instruction set to which a test limits its thread.
        pub static LIMIT: Cell<Option<Instructions>> = const { Cell::new(None) };
    }

    /// A hot drop on a wall that it wets, with every feature of droplets, on this thread.
    fn drop() -> DropletSph {
        let (diameter, spacing) = (1e-4, 1e-5);
        let fluid = Fluid {
            density: 1000.0,
            viscosity: 1e-3.into(),
            specific_heat: 4000.0,
            conductivity: 0.6,
            surface_tension: 0.07,
            sound_speed: 100.0,
            freezing: None,
        };
        let release = Release {
            time: 0.0,
            centre: [0.0, 0.0, 0.5 * (diameter + spacing)],
            diameter,
            velocity: [0.0, 0.0, -5.0],
            temperature: 350.0,
        };
        let cells = WallCells::Tiles { count: [3, 3], size: [4.0 * diameter; 2] };
        let plan = DropletPlan {
            dimension: 3,
            axisymmetric: false,
            spacing,
            support: 3.0,
            kernel: Kernel::WendlandC2,
            fluid,
            placement: Placement::Lattice,
            precision: Precision::Single,
            viscous: Viscous::Explicit,
            density_diffusion: 0.1,
            corrected_diffusion: true,
            shifting: true,
            gravity: [0.0, 0.0, -9.81],
            mirrors: [true, false],
            extents: [Extent::Open; 3],
            demand: None,
            feed: None,
            releases: vec![release],
            wall: Some(Wall { cells, contact_angle: 1.0, effusivity: None, conductance: None }),
        };
        DropletSph::new(plan, 1)
    }

    #[test]
    fn results_are_bit_identical_for_all_instruction_sets() {
        let run = |limit: Instructions| {
            LIMIT.set(Some(limit));
            let drop = drop();
            let mut state = drop.initial_state();
            drop.advance(&mut state, &[300.0; 9], 1e-6).unwrap();
            assert!(drop.totals(&state).steps > 10.0);
            LIMIT.set(None);
            state
        };
        let plain = run(Instructions::Plain);
        #[cfg(target_arch = "x86_64")]
        for limit in [Instructions::Avx2, Instructions::Avx512] {
            assert!(run(limit) == plain, "{limit:?}");
        }
        assert!(plain.iter().all(|number| number.is_finite()));
    }
}
