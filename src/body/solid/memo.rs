use std::any::Any;

use crate::body::{BodyError, Memo};
use crate::method::fem::{Deformation, SolidFem, SolidLoads, Temperatures};

/// What acts on a solid, and what follows from that and from a state, computed when first asked for.
#[derive(Debug, Default)]
pub struct SolidMemo {
    /// By the inputs.
    outside: SolidLoads,
    /// The same with what came through ports, if anything did.
    with_received: Option<SolidLoads>,
    temperatures: Option<Temperatures>,
    deformation: Option<Deformation>,
    max_temperature: Option<f64>,
    max_stress: Option<[f64; 2]>,
    /// The last point asked for: its components are read one after another.
    stress: Option<([f64; 3], [f64; 6])>,
}

const OWN: &str = "a memo is that of the body that made it";

impl SolidMemo {
    pub fn new(outside: SolidLoads) -> Self {
        Self { outside, ..Self::default() }
    }

    pub fn of(memo: &Memo) -> &Self {
        let memo: &(dyn Any + Send + Sync) = memo.as_ref();
        memo.downcast_ref().expect(OWN)
    }

    pub fn of_mut(memo: &mut Memo) -> &mut Self {
        let memo: &mut (dyn Any + Send + Sync) = memo.as_mut();
        memo.downcast_mut().expect(OWN)
    }

    /// Forgets all that depends on the state.
    pub fn forget_state(&mut self) {
        let outside = std::mem::take(&mut self.outside);
        let with_received = self.with_received.take();
        *self = Self { outside, with_received, ..Self::default() };
    }

    /// What acts by the inputs alone.
    pub fn outside(&self) -> &SolidLoads {
        &self.outside
    }

    /// All that acts.
    pub fn loads(&self) -> &SolidLoads {
        self.with_received.as_ref().unwrap_or(&self.outside)
    }

    /// All that acts, for what comes through ports to be added.
    pub fn received(&mut self) -> &mut SolidLoads {
        self.with_received.get_or_insert_with(|| self.outside.clone())
    }

    /// Nodal temperatures above the initial one.
    pub fn heat(&mut self, solid: &SolidFem, state: &[f64]) -> &Temperatures {
        if self.temperatures.is_none() {
            self.temperatures = Some(solid.temperatures(state, self.loads()));
        }
        self.temperatures.as_ref().expect("just computed")
    }

    /// Nodal temperatures and the deformation.
    pub fn solve(
        &mut self,
        solid: &SolidFem,
        state: &[f64],
    ) -> Result<(&Temperatures, &Deformation), BodyError> {
        self.heat(solid, state);
        let temperatures = self.temperatures.as_ref().expect("just computed");
        if self.deformation.is_none() {
            let loads = self.with_received.as_ref().unwrap_or(&self.outside);
            self.deformation = Some(solid.deformation(temperatures, loads)?);
        }
        Ok((temperatures, self.deformation.as_ref().expect("just computed")))
    }

    /// Whether stresses need but be looked up.
    pub fn is_solved(&self) -> bool {
        self.deformation.is_some()
    }

    pub fn has_max_stress(&self) -> bool {
        self.max_stress.is_some()
    }

    pub fn max_temperature(&mut self, solid: &SolidFem, state: &[f64]) -> f64 {
        if let Some(known) = self.max_temperature {
            return known;
        }
        let value = solid.max_temperature(self.heat(solid, state));
        self.max_temperature = Some(value);
        value
    }

    /// Highest von Mises and largest principal stress.
    pub fn max_stress(&mut self, solid: &SolidFem, state: &[f64]) -> Result<[f64; 2], BodyError> {
        if let Some(known) = self.max_stress {
            return Ok(known);
        }
        let (temperatures, deformation) = self.solve(solid, state)?;
        let value = solid.max_stress(temperatures, deformation);
        self.max_stress = Some(value);
        Ok(value)
    }

    pub fn stress_at(
        &mut self,
        solid: &SolidFem,
        state: &[f64],
        point: [f64; 3],
    ) -> Result<[f64; 6], BodyError> {
        if let Some((place, stress)) = self.stress
            && place == point
        {
            return Ok(stress);
        }
        let (temperatures, deformation) = self.solve(solid, state)?;
        let stress = solid.stress_at(temperatures, deformation, point);
        self.stress = Some((point, stress));
        Ok(stress)
    }
}
