//! The functions of FMI 3.0 and the phases that allow them: FMI 3.0, sections 2.3 and 4.2, as one table.

use super::types::{
    Binary, Boolean, Clock, Float32, Float64, Int8, Int16, Int64, IntervalQualifier, UInt8, UInt16,
    UInt32, UInt64,
};
use crate::fmi::gate::answer::{Reference, Refusal};
use crate::fmi::table::{Phase, Version, table};
use crate::fmi::unit::Unit;

// One column per phase; x: allowed. There are none for modes that a unit without clocks and structural parameters never
// enters.
table! {
    Fmi3
    //                                   Instantiated
    //                                   |Initialization Mode
    //                                   ||Event Mode
    //                                   |||Step Mode
    //                                   ||||Terminated
    //                                   |||||after an internal error
    //                                   ||||||after a fatal one
    fmi3SetDebugLogging                 "xxxxxx."
    fmi3FreeInstance                    "xxxxxx."
    fmi3EnterInitializationMode         "x......"
    fmi3ExitInitializationMode          ".x....."
    fmi3EnterEventMode                  "...x..."
    fmi3UpdateDiscreteStates            "..x...."
    fmi3EnterStepMode                   "..x...."
    fmi3Terminate                       "..xx..."
    fmi3Reset                           "xxxxxx."
    fmi3GetFloat64                      "xxxxx.."
    fmi3GetInt32                        "xxxxx.."
    fmi3GetString                       "xxxxx.."
    fmi3SetFloat64                      "xxxx..."
    fmi3SetInt32                        "xxxx..."
    fmi3SetString                       "xxxx..."
    fmi3GetNumberOfVariableDependencies "xxxxx.."
    fmi3GetVariableDependencies         "xxxxx.."
    fmi3GetFMUState                     "xxxxx.."
    fmi3SetFMUState                     "xxxxxx."
    fmi3FreeFMUState                    "xxxxxx."
    fmi3SerializedFMUStateSize          "xxxxxx."
    fmi3SerializeFMUState               "xxxxxx."
    fmi3DeserializeFMUState             "xxxxxx."
    fmi3GetDirectionalDerivative        ".xxxx.."
    fmi3GetAdjointDerivative            ".xxxx.."
    fmi3GetOutputDerivatives            "...xx.."
    fmi3DoStep                          "...x..."

    #[absent("xxxxx..")] {
        fn fmi3GetFloat32(value_references: *const Reference, value_reference_count: usize,
            values: *mut Float32, value_count: usize);
        fn fmi3GetInt8(value_references: *const Reference, value_reference_count: usize, values: *mut Int8,
            value_count: usize);
        fn fmi3GetUInt8(value_references: *const Reference, value_reference_count: usize, values: *mut UInt8,
            value_count: usize);
        fn fmi3GetInt16(value_references: *const Reference, value_reference_count: usize, values: *mut Int16,
            value_count: usize);
        fn fmi3GetUInt16(value_references: *const Reference, value_reference_count: usize,
            values: *mut UInt16, value_count: usize);
        fn fmi3GetUInt32(value_references: *const Reference, value_reference_count: usize,
            values: *mut UInt32, value_count: usize);
        fn fmi3GetInt64(value_references: *const Reference, value_reference_count: usize, values: *mut Int64,
            value_count: usize);
        fn fmi3GetUInt64(value_references: *const Reference, value_reference_count: usize,
            values: *mut UInt64, value_count: usize);
        fn fmi3GetBoolean(value_references: *const Reference, value_reference_count: usize,
            values: *mut Boolean, value_count: usize);
        fn fmi3GetBinary(value_references: *const Reference, value_reference_count: usize,
            value_sizes: *mut usize, values: *mut Binary, value_count: usize);
    }
    #[absent("xxxx...")] {
        fn fmi3SetFloat32(value_references: *const Reference, value_reference_count: usize,
            values: *const Float32, value_count: usize);
        fn fmi3SetInt8(value_references: *const Reference, value_reference_count: usize, values: *const Int8,
            value_count: usize);
        fn fmi3SetUInt8(value_references: *const Reference, value_reference_count: usize,
            values: *const UInt8, value_count: usize);
        fn fmi3SetInt16(value_references: *const Reference, value_reference_count: usize,
            values: *const Int16, value_count: usize);
        fn fmi3SetUInt16(value_references: *const Reference, value_reference_count: usize,
            values: *const UInt16, value_count: usize);
        fn fmi3SetUInt32(value_references: *const Reference, value_reference_count: usize,
            values: *const UInt32, value_count: usize);
        fn fmi3SetInt64(value_references: *const Reference, value_reference_count: usize,
            values: *const Int64, value_count: usize);
        fn fmi3SetUInt64(value_references: *const Reference, value_reference_count: usize,
            values: *const UInt64, value_count: usize);
        fn fmi3SetBoolean(value_references: *const Reference, value_reference_count: usize,
            values: *const Boolean, value_count: usize);
        fn fmi3SetBinary(value_references: *const Reference, value_reference_count: usize,
            value_sizes: *const usize, values: *const Binary, value_count: usize);
    }

    #[refused(NoDiscreteStates)] {
        fn fmi3EvaluateDiscreteStates();
    }
    #[refused(NoStructuralParameters)] {
        fn fmi3EnterConfigurationMode();
        fn fmi3ExitConfigurationMode();
    }
    #[refused(NoClocks)] {
        fn fmi3GetClock(value_references: *const Reference, value_reference_count: usize, values: *mut Clock);
        fn fmi3SetClock(value_references: *const Reference, value_reference_count: usize,
            values: *const Clock);
        fn fmi3GetIntervalDecimal(value_references: *const Reference, value_reference_count: usize,
            intervals: *mut Float64, qualifiers: *mut IntervalQualifier);
        fn fmi3GetIntervalFraction(value_references: *const Reference, value_reference_count: usize,
            counters: *mut UInt64, resolutions: *mut UInt64, qualifiers: *mut IntervalQualifier);
        fn fmi3GetShiftDecimal(value_references: *const Reference, value_reference_count: usize,
            shifts: *mut Float64);
        fn fmi3GetShiftFraction(value_references: *const Reference, value_reference_count: usize,
            counters: *mut UInt64, resolutions: *mut UInt64);
        fn fmi3SetIntervalDecimal(value_references: *const Reference, value_reference_count: usize,
            intervals: *const Float64);
        fn fmi3SetIntervalFraction(value_references: *const Reference, value_reference_count: usize,
            counters: *const UInt64, resolutions: *const UInt64);
        fn fmi3SetShiftDecimal(value_references: *const Reference, value_reference_count: usize,
            shifts: *const Float64);
        fn fmi3SetShiftFraction(value_references: *const Reference, value_reference_count: usize,
            counters: *const UInt64, resolutions: *const UInt64);
    }
    #[refused(ModelExchange)] {
        fn fmi3EnterContinuousTimeMode();
        fn fmi3CompletedIntegratorStep(no_set_fmustate_prior_to_current_point: Boolean,
            enter_event_mode: *mut Boolean, terminate_simulation: *mut Boolean);
        fn fmi3SetTime(time: Float64);
        fn fmi3SetContinuousStates(continuous_states: *const Float64, continuous_state_count: usize);
        fn fmi3GetContinuousStateDerivatives(derivatives: *mut Float64, continuous_state_count: usize);
        fn fmi3GetEventIndicators(event_indicators: *mut Float64, event_indicator_count: usize);
        fn fmi3GetContinuousStates(continuous_states: *mut Float64, continuous_state_count: usize);
        fn fmi3GetNominalsOfContinuousStates(nominals: *mut Float64, continuous_state_count: usize);
        fn fmi3GetNumberOfEventIndicators(event_indicator_count: *mut usize);
        fn fmi3GetNumberOfContinuousStates(continuous_state_count: *mut usize);
    }
    #[refused(ScheduledExecution)] {
        fn fmi3ActivateModelPartition(clock_reference: Reference, activation_time: Float64);
    }
}

impl Version for Fmi3 {
    const PHASES: &'static [(Phase, &'static str)] = &[
        (Phase::Instantiated, "Instantiated"),
        (Phase::InitializationMode, "Initialization Mode"),
        (Phase::EventMode, "Event Mode"),
        (Phase::StepComplete, "Step Mode"),
        (Phase::Terminated, "Terminated"),
        (Phase::Error, "after an internal error"),
        (Phase::Fatal, "after a fatal error"),
    ];
    const MARKER: u64 = 0x696d_7069_6e67_6533;
    const REFERENCES: &'static str = "valueReferences";

    fn of_another_type(unit: &Unit, reference: Reference, wanted: &str) -> Refusal {
        unit.array_of_another_type(reference, wanted)
    }
}
