//! Which function may be called when: FMI 2.0.4, section 4.2.4, as one table; and what such tables
//! have in common.

use super::refused::Reason;

/// Phase of an instance, a state of the co-simulation state machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    Instantiated,
    InitializationMode,
    StepComplete,
    /// Seen only by calls that come while another call on the same instance runs.
    StepInProgress,
    StepFailed,
    StepCanceled,
    Terminated,
    Error,
    Fatal,
}

impl Phase {
    pub const ALL: [Phase; 9] = [
        Phase::Instantiated,
        Phase::InitializationMode,
        Phase::StepComplete,
        Phase::StepInProgress,
        Phase::StepFailed,
        Phase::StepCanceled,
        Phase::Terminated,
        Phase::Error,
        Phase::Fatal,
    ];
}

/// A function of one version of the standard that acts on an instance.
pub trait Function: Copy + 'static {
    /// The phases of this version with its names for them, in the order of the columns of its table.
    const PHASES: &'static [(Phase, &'static str)];
    /// Says that a pointer is an instance of this version that was given out and not taken back.
    const MARKER: u64;

    /// Name in C.
    fn name(self) -> &'static str;

    /// A letter a phase; x: allowed.
    fn row(self) -> &'static str;

    /// Why a function that no phase allows is refused.
    fn never(self) -> Reason;

    /// Whether the standard allows this call in a phase.
    fn allowed_in(self, phase: Phase) -> bool {
        let column = Self::PHASES.iter().position(|(known, _)| *known == phase);
        column.is_some_and(|column| self.row().as_bytes()[column] == b'x')
    }

    /// The phases that allow this call, for messages.
    fn allowed_phases(self) -> Vec<&'static str> {
        let allowed = Self::PHASES.iter().filter(|(phase, _)| self.allowed_in(*phase));
        allowed.map(|(_, name)| *name).collect()
    }

    /// This version's name of a phase.
    fn phase_name(phase: Phase) -> &'static str {
        let known = Self::PHASES.iter().find(|(known, _)| *known == phase);
        known.map_or("unknown", |(_, name)| name)
    }
}

/// Makes the enum of a version's functions, their names and their rows from one table: the enum's
/// name, the prefix of names in C, then the rows.
macro_rules! table {
    ($table:ident $prefix:literal $($function:ident $row:literal)*) => {
        /// A function that acts on an instance.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum $table { $($function),* }

        impl $table {
            #[cfg(test)]
            pub const ALL: &[$table] = &[$($table::$function),*];

            fn c_name(self) -> &'static str {
                match self { $($table::$function => concat!($prefix, stringify!($function))),* }
            }

            fn letters(self) -> &'static str {
                match self { $($table::$function => $row),* }
            }
        }
    };
}
pub(super) use table;

// One column a phase; x: allowed. The last group is model exchange.
table! {
    Fmi2 "fmi2"
    //                             instantiated
    //                             |initializationMode
    //                             ||stepComplete
    //                             |||stepInProgress
    //                             ||||stepFailed
    //                             |||||stepCanceled
    //                             ||||||terminated
    //                             |||||||error
    //                             ||||||||fatal
    SetDebugLogging               "xxxxxxxx."
    FreeInstance                  "xxx.xxxx."
    SetupExperiment               "x........"
    EnterInitializationMode       "x........"
    ExitInitializationMode        ".x......."
    Terminate                     "..x.x...."
    Reset                         "xxx.xxxx."
    GetReal                       ".xx.xxxx."
    GetInteger                    ".xx.xxxx."
    GetBoolean                    ".xx.xxxx."
    GetString                     ".xx.xxxx."
    SetReal                       "xxx......"
    SetInteger                    "xxx......"
    SetBoolean                    "xxx......"
    SetString                     "xxx......"
    GetFMUstate                   "xxx.xxxx."
    SetFMUstate                   "xxx.xxxx."
    FreeFMUstate                  "xxx.xxxx."
    SerializedFMUstateSize        "xxx.xxxx."
    SerializeFMUstate             "xxx.xxxx."
    DeSerializeFMUstate           "xxx.xxxx."
    GetDirectionalDerivative      ".xx.xxxx."
    SetRealInputDerivatives       "xxx......"
    GetRealOutputDerivatives      "..x.xxxx."
    DoStep                        "..x......"
    CancelStep                    "...x....."
    GetStatus                     "..xxx.x.."
    GetRealStatus                 "..xxx.x.."
    GetIntegerStatus              "..xxx.x.."
    GetBooleanStatus              "..xxx.x.."
    GetStringStatus               "..xxx.x.."
    EnterEventMode                "........."
    NewDiscreteStates             "........."
    EnterContinuousTimeMode       "........."
    CompletedIntegratorStep       "........."
    SetTime                       "........."
    SetContinuousStates           "........."
    GetDerivatives                "........."
    GetEventIndicators            "........."
    GetContinuousStates           "........."
    GetNominalsOfContinuousStates "........."
}

impl Function for Fmi2 {
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

    fn name(self) -> &'static str {
        self.c_name()
    }

    fn row(self) -> &'static str {
        self.letters()
    }

    fn never(self) -> Reason {
        Reason::ModelExchange
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_has_a_column_for_each_phase() {
        for &function in Fmi2::ALL {
            assert_eq!(function.row().len(), Fmi2::PHASES.len(), "{}", function.name());
            assert!(function.row().bytes().all(|b| b == b'x' || b == b'.'), "{}", function.name());
        }
    }

    #[test]
    fn nothing_is_allowed_after_a_fatal_error() {
        assert!(Fmi2::ALL.iter().all(|f| !f.allowed_in(Phase::Fatal)));
    }

    #[test]
    fn phases_are_listed_in_their_order() {
        assert!(Phase::ALL.into_iter().enumerate().all(|(i, phase)| phase as usize == i));
    }

    #[test]
    fn steps_are_done_only_between_steps() {
        assert_eq!(Fmi2::DoStep.allowed_phases(), ["stepComplete"]);
        assert_eq!(Fmi2::SetupExperiment.allowed_phases(), ["instantiated"]);
    }
}
