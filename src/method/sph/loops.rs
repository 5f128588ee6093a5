//! Loops over pairs of particles: blocks over threads, neighbours over the lanes of a vector.

use std::marker::PhantomData;

use num_traits::Float;

use super::dispatch::{Work, dispatch};
use super::images::{Images, Source};
use super::lanes::{Annex, Lanes, Record, WIDTH};
use super::neighbours::Block;
use super::order::BLOCK;
use super::rings::{Form, with_form};
use crate::kernel::{Chosen, Kernel, Number, Shape, WendlandC2};
use crate::runtime::parallel::Team;
use crate::scene::Precision;

/// Number of blocks that share the memory of one local copy.
const GROUP: usize = 2;
pub const PART: usize = GROUP * BLOCK;

/// Properties common to all sums over pairs of a model.
#[derive(Debug, Clone, Copy)]
pub struct PairKind {
    pub kernel: Kernel,
    pub precision: Precision,
    /// True if particles are rings.
    pub rings: bool,
}

/// A quantity computed for every particle from its neighbours.
pub trait PairSum: Sync {
    /// Result for one particle.
    type Output: Send;

    /// Numbers of every particle that all loops read: position first.
    fn records(&self) -> &[[f64; 8]];

    fn images(&self) -> &Images;

    /// Record of an image; by default only its position differs from that of its original.
    #[inline(always)]
    fn record(&self, source: Source) -> [f64; 8] {
        let [x, y, z, u, v, w, volume, last] = self.records()[source.particle()];
        let [x, y, z] = self.images().get(source.code()).place([x, y, z]);
        [x, y, z, u, v, w, volume, last]
    }

    /// Further numbers of every particle, where [`Self::ANNEX`].
    fn annexes(&self) -> &[[f64; 4]] {
        &[]
    }

    /// Annex of an image.
    fn annex(&self, _source: Source) -> [f64; 4] {
        [0.0; 4]
    }

    const ANNEX: bool = false;

    /// Sums over the neighbours of the k-th particle of a block.
    fn sum<L: Lanes, S: Shape, F: Form>(
        &self,
        shape: S,
        block: &Block,
        k: usize,
        local: &Local<L::Real>,
    ) -> Self::Output;
}

/// Local copy of a block's surroundings, about its centre. Place 0 is a dummy far away.
#[derive(Debug, Default)]
pub struct Local<R> {
    pub records: Vec<Record<R>>,
    pub annexes: Vec<Annex<R>>,
}

impl<R: Float + Number> Local<R> {
    /// Gathers records at places of the block that this copy belongs to.
    #[inline(always)]
    pub fn gather<L: Lanes<Real = R>>(&self, places: &[u16; WIDTH]) -> [L; 8] {
        // SAFETY: `fill` makes a record for place 0 and for each source of the block, and a block's
        // lists hold no place beyond its sources. `Block::find_places` checks all of them whenever
        // lists are made; a check of every vector here would cost a tenth of the time.
        unsafe { L::gather(&self.records, places) }
    }

    /// Gathers annexes at places of the block that this copy belongs to.
    #[inline(always)]
    pub fn gather_annex<L: Lanes<Real = R>>(&self, places: &[u16; WIDTH]) -> [L; 4] {
        assert!(self.annexes.len() == self.records.len());
        // SAFETY: as above, and each has an annex.
        unsafe { L::gather_annex(&self.annexes, places) }
    }

    #[inline(always)]
    fn fill<P: PairSum, L: Lanes<Real = R>>(&mut self, pass: &P, block: &Block) {
        let far = R::constant(1e3);
        let [x, y, z] = block.centre;
        let centre = [x, y, z, 0.0, 0.0, 0.0, 0.0, 0.0];
        self.records.resize(block.sources().len() + 1, [R::zero(); 8]);
        self.records[0] = [far, far, far, R::zero(), R::zero(), R::zero(), R::zero(), R::zero()];
        let records = pass.records();
        for (local, &source) in self.records[1..].iter_mut().zip(block.sources()) {
            if source.is_image() {
                *local = L::about(&pass.record(source), &centre);
            } else {
                *local = L::about(&records[source.particle()], &centre);
            }
        }
        if P::ANNEX {
            self.annexes.resize(block.sources().len() + 1, [R::zero(); 4]);
            self.annexes[0] = [R::zero(); 4];
            let annexes = pass.annexes();
            for (local, &source) in self.annexes[1..].iter_mut().zip(block.sources()) {
                let annex =
                    if source.is_image() { pass.annex(source) } else { annexes[source.particle()] };
                for n in 0..4 {
                    local[n] = R::constant(annex[n]);
                }
            }
        }
    }
}

/// Computes a sum for all particles, in their order; reuses the memory of `all`. The default kernel has compiled loops of
/// its own, all others share theirs: a third of the library's code would be such loops.
pub fn for_all<P: PairSum<Output: Clone + Default>>(
    pass: &P,
    blocks: &[Block],
    kind: PairKind,
    team: &Team,
    all: Vec<P::Output>,
) -> Vec<P::Output> {
    match kind.kernel {
        Kernel::WendlandC2 => for_all_of(WendlandC2, pass, blocks, kind, team, all),
        other => for_all_of(Chosen(other), pass, blocks, kind, team, all),
    }
}

/// Same as [`for_all`], with the shape of a kernel other than the model's.
pub fn for_all_of<S: Shape, P: PairSum<Output: Clone + Default>>(
    shape: S,
    pass: &P,
    blocks: &[Block],
    kind: PairKind,
    team: &Team,
    mut all: Vec<P::Output>,
) -> Vec<P::Output> {
    let count = blocks.iter().map(|block| block.count).sum();
    all.resize(count, P::Output::default());
    let mut parts: Vec<&mut [P::Output]> = all.chunks_mut(PART).collect();
    let store = |part: &mut &mut [P::Output], sums: &[P::Output]| part.clone_from_slice(sums);
    for_parts_of(shape, pass, blocks, kind, team, &mut parts, store);
    all
}

/// Computes a sum for all particles and passes it, [`PART`] particles at a time, to the part that
/// it belongs to.
pub fn for_parts<P: PairSum, T: Send>(
    pass: &P,
    blocks: &[Block],
    kind: PairKind,
    team: &Team,
    parts: &mut [T],
    take: impl Fn(&mut T, &[P::Output]) + Sync,
) {
    match kind.kernel {
        Kernel::WendlandC2 => for_parts_of(WendlandC2, pass, blocks, kind, team, parts, take),
        other => for_parts_of(Chosen(other), pass, blocks, kind, team, parts, take),
    }
}

fn for_parts_of<S: Shape, P: PairSum, T: Send>(
    shape: S,
    pass: &P,
    blocks: &[Block],
    PairKind { precision, rings, .. }: PairKind,
    team: &Team,
    parts: &mut [T],
    take: impl Fn(&mut T, &[P::Output]) + Sync,
) {
    team.for_pieces(parts, |first, parts| {
        let last = blocks.len().min((first + parts.len()) * GROUP);
        let (blocks, take) = (&blocks[first * GROUP..last], &take);
        with_form!(rings, F => {
            let form = PhantomData::<F>;
            dispatch(PairWork { pass, blocks, parts, take, shape, form }, precision);
        });
    });
}

/// Work of one thread at a time.
struct PairWork<'a, P, T, K, S, F> {
    pass: &'a P,
    /// [`GROUP`] blocks for each part.
    blocks: &'a [Block],
    parts: &'a mut [T],
    take: &'a K,
    shape: S,
    form: PhantomData<F>,
}

impl<P: PairSum, T, K, S: Shape, F: Form> Work for PairWork<'_, P, T, K, S, F>
where
    K: Fn(&mut T, &[P::Output]),
{
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let mut local = Local::<L::Real>::default();
        let mut sums = Vec::with_capacity(PART);
        for (part, blocks) in self.parts.iter_mut().zip(self.blocks.chunks(GROUP)) {
            sums.clear();
            for block in blocks {
                local.fill::<P, L>(self.pass, block);
                for k in 0..block.count {
                    sums.push(self.pass.sum::<L, S, F>(self.shape, block, k, &local));
                }
            }
            (self.take)(part, &sums);
        }
    }
}
