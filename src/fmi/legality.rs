//! Which function may be called when: FMI 2.0.4, section 4.2.4, as one table.

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

    /// The standard's name.
    pub fn name(self) -> &'static str {
        match self {
            Phase::Instantiated => "instantiated",
            Phase::InitializationMode => "initializationMode",
            Phase::StepComplete => "stepComplete",
            Phase::StepInProgress => "stepInProgress",
            Phase::StepFailed => "stepFailed",
            Phase::StepCanceled => "stepCanceled",
            Phase::Terminated => "terminated",
            Phase::Error => "error",
            Phase::Fatal => "fatal",
        }
    }
}

/// Makes the enum of functions, their names and their rows from one table.
macro_rules! table {
    ($($function:ident $row:literal)*) => {
        /// A function that acts on an instance.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Function { $($function),* }

        impl Function {
            #[cfg(test)]
            pub const ALL: &[Function] = &[$(Function::$function),*];

            /// Name in C.
            pub fn name(self) -> &'static str {
                match self { $(Function::$function => concat!("fmi2", stringify!($function))),* }
            }

            fn row(self) -> &'static str {
                match self { $(Function::$function => $row),* }
            }
        }
    };
}

// One column a phase, in the order of `Phase::ALL`; x: allowed. The last group is model exchange.
table! {
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

impl Function {
    /// Whether the standard allows this call in a phase.
    pub fn allowed_in(self, phase: Phase) -> bool {
        self.row().as_bytes()[phase as usize] == b'x'
    }

    /// The phases that allow this call, for messages.
    pub fn allowed_phases(self) -> Vec<&'static str> {
        Phase::ALL.into_iter().filter(|&p| self.allowed_in(p)).map(Phase::name).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_has_a_column_for_each_phase() {
        for &function in Function::ALL {
            assert_eq!(function.row().len(), Phase::ALL.len(), "{}", function.name());
            assert!(function.row().bytes().all(|b| b == b'x' || b == b'.'), "{}", function.name());
        }
    }

    #[test]
    fn nothing_is_allowed_after_a_fatal_error() {
        assert!(Function::ALL.iter().all(|f| !f.allowed_in(Phase::Fatal)));
    }

    #[test]
    fn phases_stand_in_the_order_of_the_columns() {
        assert!(Phase::ALL.into_iter().enumerate().all(|(i, phase)| phase as usize == i));
    }

    #[test]
    fn steps_are_done_only_between_steps() {
        assert_eq!(Function::DoStep.allowed_phases(), ["stepComplete"]);
        assert_eq!(Function::SetupExperiment.allowed_phases(), ["instantiated"]);
    }
}
