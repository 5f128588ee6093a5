//! FMI functions of model exchange, section 3.2 of the standard. A unit is for co-simulation; the
//! functions exist so that tools which look up all names find them.

use super::refused::{Reason, refused};
use super::types::{Boolean, EventInfo, Real};

refused! { Reason::ModelExchange;
    fn fmi2EnterEventMode: EnterEventMode();
    fn fmi2NewDiscreteStates: NewDiscreteStates(*mut EventInfo);
    fn fmi2EnterContinuousTimeMode: EnterContinuousTimeMode();
    fn fmi2CompletedIntegratorStep:
        CompletedIntegratorStep(Boolean, *mut Boolean, *mut Boolean);
    fn fmi2SetTime: SetTime(Real);
    fn fmi2SetContinuousStates: SetContinuousStates(*const Real, usize);
    fn fmi2GetDerivatives: GetDerivatives(*mut Real, usize);
    fn fmi2GetEventIndicators: GetEventIndicators(*mut Real, usize);
    fn fmi2GetContinuousStates: GetContinuousStates(*mut Real, usize);
    fn fmi2GetNominalsOfContinuousStates: GetNominalsOfContinuousStates(*mut Real, usize);
}
