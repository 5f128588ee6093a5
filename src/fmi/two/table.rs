//! The functions of FMI 2.0 and the phases that allow them: FMI 2.0.4, section 4.2.4, as one table.

use super::types::{Boolean, EventInfo, Real};
use crate::fmi::gate::answer::{Reference, Refusal};
use crate::fmi::table::{Phase, Version, table};
use crate::fmi::unit::Unit;

// One column per phase; x: allowed.
table! {
    Fmi2
    //                            instantiated
    //                            |initializationMode
    //                            ||stepComplete
    //                            |||stepInProgress
    //                            ||||stepFailed
    //                            |||||stepCanceled
    //                            ||||||terminated
    //                            |||||||error
    //                            ||||||||fatal
    fmi2SetDebugLogging          "xxxxxxxx."
    fmi2FreeInstance             "xxx.xxxx."
    fmi2SetupExperiment          "x........"
    fmi2EnterInitializationMode  "x........"
    fmi2ExitInitializationMode   ".x......."
    fmi2Terminate                "..x.x...."
    fmi2Reset                    "xxx.xxxx."
    fmi2GetReal                  ".xx.xxxx."
    fmi2GetInteger               ".xx.xxxx."
    fmi2GetBoolean               ".xx.xxxx."
    fmi2GetString                ".xx.xxxx."
    fmi2SetReal                  "xxx......"
    fmi2SetInteger               "xxx......"
    fmi2SetBoolean               "xxx......"
    fmi2SetString                "xxx......"
    fmi2GetFMUstate              "xxx.xxxx."
    fmi2SetFMUstate              "xxx.xxxx."
    fmi2FreeFMUstate             "xxx.xxxx."
    fmi2SerializedFMUstateSize   "xxx.xxxx."
    fmi2SerializeFMUstate        "xxx.xxxx."
    fmi2DeSerializeFMUstate      "xxx.xxxx."
    fmi2GetDirectionalDerivative ".xx.xxxx."
    fmi2SetRealInputDerivatives  "xxx......"
    fmi2GetRealOutputDerivatives "..x.xxxx."
    fmi2DoStep                   "..x......"
    fmi2CancelStep               "...x....."
    fmi2GetStatus                "..xxx.x.."
    fmi2GetRealStatus            "..xxx.x.."
    fmi2GetIntegerStatus         "..xxx.x.."
    fmi2GetBooleanStatus         "..xxx.x.."
    fmi2GetStringStatus          "..xxx.x.."

    #[refused(ModelExchange)] {
        fn fmi2EnterEventMode();
        fn fmi2NewDiscreteStates(event_info: *mut EventInfo);
        fn fmi2EnterContinuousTimeMode();
        fn fmi2CompletedIntegratorStep(no_set_state_prior_to_current_point: Boolean,
            enter_event_mode: *mut Boolean, terminate_simulation: *mut Boolean);
        fn fmi2SetTime(time: Real);
        fn fmi2SetContinuousStates(states: *const Real, count: usize);
        fn fmi2GetDerivatives(derivatives: *mut Real, count: usize);
        fn fmi2GetEventIndicators(indicators: *mut Real, count: usize);
        fn fmi2GetContinuousStates(states: *mut Real, count: usize);
        fn fmi2GetNominalsOfContinuousStates(nominals: *mut Real, count: usize);
    }
}

impl Version for Fmi2 {
    const PHASES: &'static [(Phase, &'static str)] = &[
        (Phase::Instantiated, "instantiated"),
        (Phase::InitializationMode, "initializationMode"),
        (Phase::StepComplete, "stepComplete"),
        (Phase::StepInProgress, "stepInProgress"),
        (Phase::StepFailed, "stepFailed"),
        (Phase::StepCanceled, "stepCanceled"),
        (Phase::Terminated, "terminated"),
        (Phase::Error, "error"),
        (Phase::Fatal, "fatal"),
    ];
    const MARKER: u64 = 0x696d_7069_6e67_6532;
    const REFERENCES: &'static str = "vr";

    fn of_another_type(unit: &Unit, reference: Reference, wanted: &str) -> Refusal {
        unit.scalar_of_another_type(reference, wanted)
    }
}
