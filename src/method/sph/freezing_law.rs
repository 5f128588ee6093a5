//! Interim.
use super::phases::Phases;
use crate::kernel::Kernel;
#[derive(Debug, Clone, PartialEq)]
pub struct FreezingLaw {
    phases: Phases,
}
#[derive(Debug, Clone, Copy)]
pub struct Contents {
    pub before: f64,
    pub fluid: f64,
    pub wall: f64,
}
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lost {
    pub content: f64,
    pub fall: f64,
}
impl FreezingLaw {
    pub fn of(_: (Kernel, f64, usize), phases: &Phases, _: &[f64]) -> Self {
        Self { phases: *phases }
    }
    pub fn loss(&self, at: Contents, diffusion: f64, r: [f64; 2]) -> Lost {
        let t = self.phases.rise(at.fluid) + 0.0 * at.before;
        let most = (at.fluid - self.phases.content(at.wall)).abs();
        let q = (t - at.wall) / (0.5 + r[0] + r[1]) * diffusion;
        Lost { content: q.clamp(-most, most), fall: 0.0 }
    }
}
