//! Which function may be called when: FMI 3.0, sections 2.3 and 4.2, as one table.

use crate::fmi::legality::{Function, Phase, table};
use crate::fmi::refused::Reason;

// One column a phase; x: allowed. Modes that a unit without events, clocks and structural parameters
// never enters have none.
table! {
    Fmi3 "fmi3"
    //                               Instantiated
    //                               |Initialization Mode
    //                               ||Step Mode
    //                               |||Terminated
    //                               ||||after an internal error
    //                               |||||after a fatal one
    SetDebugLogging                 "xxxxx."
    FreeInstance                    "xxxxx."
    EnterInitializationMode         "x....."
    ExitInitializationMode          ".x...."
    Terminate                       "..x..."
    Reset                           "xxxxx."
    GetFloat32                      "xxxx.."
    GetFloat64                      "xxxx.."
    GetInt8                         "xxxx.."
    GetUInt8                        "xxxx.."
    GetInt16                        "xxxx.."
    GetUInt16                       "xxxx.."
    GetInt32                        "xxxx.."
    GetUInt32                       "xxxx.."
    GetInt64                        "xxxx.."
    GetUInt64                       "xxxx.."
    GetBoolean                      "xxxx.."
    GetString                       "xxxx.."
    GetBinary                       "xxxx.."
    SetFloat32                      "xxx..."
    SetFloat64                      "xxx..."
    SetInt8                         "xxx..."
    SetUInt8                        "xxx..."
    SetInt16                        "xxx..."
    SetUInt16                       "xxx..."
    SetInt32                        "xxx..."
    SetUInt32                       "xxx..."
    SetInt64                        "xxx..."
    SetUInt64                       "xxx..."
    SetBoolean                      "xxx..."
    SetString                       "xxx..."
    SetBinary                       "xxx..."
    GetNumberOfVariableDependencies "xxxx.."
    GetVariableDependencies         "xxxx.."
    GetFMUState                     "xxxx.."
    SetFMUState                     "xxxxx."
    FreeFMUState                    "xxxxx."
    SerializedFMUStateSize          "xxxxx."
    SerializeFMUState               "xxxxx."
    DeserializeFMUState             "xxxxx."
    GetDirectionalDerivative        ".xxx.."
    GetAdjointDerivative            ".xxx.."
    GetOutputDerivatives            "..xx.."
    DoStep                          "..x..."
    EnterEventMode                  "......"
    EnterStepMode                   "......"
    EvaluateDiscreteStates          "......"
    UpdateDiscreteStates            "......"
    EnterConfigurationMode          "......"
    ExitConfigurationMode           "......"
    GetClock                        "......"
    SetClock                        "......"
    GetIntervalDecimal              "......"
    GetIntervalFraction             "......"
    GetShiftDecimal                 "......"
    GetShiftFraction                "......"
    SetIntervalDecimal              "......"
    SetIntervalFraction             "......"
    SetShiftDecimal                 "......"
    SetShiftFraction                "......"
    EnterContinuousTimeMode         "......"
    CompletedIntegratorStep         "......"
    SetTime                         "......"
    SetContinuousStates             "......"
    GetContinuousStateDerivatives   "......"
    GetEventIndicators              "......"
    GetContinuousStates             "......"
    GetNominalsOfContinuousStates   "......"
    GetNumberOfEventIndicators      "......"
    GetNumberOfContinuousStates     "......"
    ActivateModelPartition          "......"
}

impl Function for Fmi3 {
    const PHASES: &'static [(Phase, &'static str)] = &[
        (Phase::Instantiated, "Instantiated"),
        (Phase::InitializationMode, "Initialization Mode"),
        (Phase::StepComplete, "Step Mode"),
        (Phase::Terminated, "Terminated"),
        (Phase::Error, "after an internal error"),
        (Phase::Fatal, "after a fatal error"),
    ];
    const MARKER: u64 = 0x696d_7069_6e67_6533;

    fn name(self) -> &'static str {
        self.c_name()
    }

    fn row(self) -> &'static str {
        self.letters()
    }

    fn never(self) -> Reason {
        match self {
            Fmi3::EnterEventMode
            | Fmi3::EnterStepMode
            | Fmi3::EvaluateDiscreteStates
            | Fmi3::UpdateDiscreteStates => Reason::NoEvents,
            Fmi3::EnterConfigurationMode | Fmi3::ExitConfigurationMode => {
                Reason::NoStructuralParameters
            }
            Fmi3::GetClock
            | Fmi3::SetClock
            | Fmi3::GetIntervalDecimal
            | Fmi3::GetIntervalFraction
            | Fmi3::GetShiftDecimal
            | Fmi3::GetShiftFraction
            | Fmi3::SetIntervalDecimal
            | Fmi3::SetIntervalFraction
            | Fmi3::SetShiftDecimal
            | Fmi3::SetShiftFraction => Reason::NoClocks,
            Fmi3::ActivateModelPartition => Reason::ScheduledExecution,
            _ => Reason::ModelExchange,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_has_a_column_for_each_phase() {
        for &function in Fmi3::ALL {
            assert_eq!(function.row().len(), Fmi3::PHASES.len(), "{}", function.name());
            assert!(function.row().bytes().all(|b| b == b'x' || b == b'.'), "{}", function.name());
        }
    }

    #[test]
    fn nothing_is_allowed_after_a_fatal_error() {
        assert!(Fmi3::ALL.iter().all(|f| !f.allowed_in(Phase::Fatal)));
    }

    #[test]
    fn only_a_saved_state_or_a_reset_leads_on_from_an_internal_error() {
        let allowed = |f: &&Fmi3| f.allowed_in(Phase::Error);
        let names: Vec<&str> = Fmi3::ALL.iter().filter(allowed).map(|f| f.name()).collect();
        assert!(names.contains(&"fmi3Reset") && names.contains(&"fmi3SetFMUState"));
        assert!(!names.iter().any(|name| name.contains("Float") || name.contains("DoStep")));
    }
}
