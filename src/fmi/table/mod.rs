//! Tables of functions: the phases that allow each, or the reason why it is always refused.
//!
//! A version of the standard has one [`table!`], with a row for each function that acts on an instance. Functions with
//! a body of their own are in the version's other files, under the name of their row. Functions that only refuse are in
//! the table alone, with their arguments, and are exported from there.

mod phase;
mod reason;

pub use phase::Phase;
pub use reason::Reason;

use super::gate::answer::{Reference, Refusal};
use super::unit::Unit;

/// A version of the standard, identified by the enum of its functions.
pub trait Version {
    /// The phases of this version with its names for them, in the order of the columns of its table.
    const PHASES: &'static [(Phase, &'static str)];
    /// Marks an active instance of this version.
    const MARKER: u64;
    /// Name of arguments that are value references.
    const REFERENCES: &'static str;

    /// Returns the refusal of a variable whose type is not that of a function, or of an unknown reference.
    fn of_another_type(unit: &Unit, reference: Reference, wanted: &str) -> Refusal;
}

/// A function of one version of the standard that acts on an instance.
pub trait Function: Version + Copy + 'static {
    /// All functions of the version.
    const ALL: &'static [Self];

    /// Name in C.
    fn name(self) -> &'static str;

    /// The function's row.
    fn rule(self) -> Rule;

    /// Returns true if the standard allows this call in a phase.
    fn allowed_in(self, phase: Phase) -> bool {
        let Rule::In(row) = self.rule() else { return false };
        let column = Self::PHASES.iter().position(|(known, _)| *known == phase);
        column.is_some_and(|column| row.as_bytes()[column] == b'x')
    }

    /// Returns the phases that allow this call, for messages.
    fn allowed_phases(self) -> Vec<&'static str> {
        let allowed = Self::PHASES.iter().filter(|(phase, _)| self.allowed_in(*phase));
        allowed.map(|(_, name)| *name).collect()
    }

    /// Returns this version's name of a phase.
    fn phase_name(phase: Phase) -> &'static str {
        let known = Self::PHASES.iter().find(|(known, _)| *known == phase);
        known.map_or("unknown", |(_, name)| name)
    }

    /// Returns the type in the name of a function that gets or sets variables of one type.
    fn kind(self) -> &'static str {
        &self.name()["fmi3Get".len()..]
    }
}

/// Phases in which a function may be called.
#[derive(Debug, Clone, Copy)]
pub enum Rule {
    /// One letter per phase; x: allowed.
    In(&'static str),
    Never(Reason),
}

/// Generates the enum of a version's functions with their rows from one table, and exports those that only refuse.
///
/// First come rows of functions with a body: name in C and one letter per phase. Then, as `absent` with one letter per
/// phase, come functions that get and set variables of a type that no variable has. Last, as `refused` with a reason,
/// come functions that no phase allows. Both kinds are exported with the instance before their arguments, and return a
/// status.
macro_rules! table {
    (
        $table:ident
        $($function:ident $row:literal)*
        $(#[absent($letters:literal)] {$(
            fn $absent:ident($references:ident: $reference:ty, $count:ident: usize
                $(, $more:ident: $type_of_more:ty)* $(,)?);
        )*})*
        $(#[refused($reason:ident)] {$(
            fn $refused:ident($($argument:ident: $type:ty),* $(,)?);
        )*})*
    ) => {
        /// A function that acts on an instance, by its name in C.
        #[allow(non_camel_case_types, clippy::enum_variant_names)]
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum $table { $($function,)* $($($absent,)*)* $($($refused,)*)* }

        impl $crate::fmi::table::Function for $table {
            const ALL: &'static [$table] =
                &[$($table::$function,)* $($($table::$absent,)*)* $($($table::$refused,)*)*];

            fn name(self) -> &'static str {
                match self {
                    $($table::$function => stringify!($function),)*
                    $($($table::$absent => stringify!($absent),)*)*
                    $($($table::$refused => stringify!($refused),)*)*
                }
            }

            fn rule(self) -> $crate::fmi::table::Rule {
                use $crate::fmi::table::{Reason, Rule};
                match self {
                    $($table::$function => Rule::In($row),)*
                    $($($table::$absent => Rule::In($letters),)*)*
                    $($($table::$refused => Rule::Never(Reason::$reason),)*)*
                }
            }
        }

        $($(
            /// Refuses all variables, as none has this type.
            ///
            /// # Safety
            /// Pointers are null or as the standard asks.
            #[allow(unused_variables)]
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn $absent(
                handle: $crate::fmi::gate::answer::Handle,
                $references: $reference,
                $count: usize,
                $($more: $type_of_more),*
            ) -> $crate::fmi::gate::answer::Status {
                // SAFETY: by contract.
                unsafe {
                    $crate::fmi::gate::refusing::absent(handle, $table::$absent, $references, $count)
                }
            }
        )*)*

        $($(
            /// Refuses every call, with the reason in the log.
            ///
            /// # Safety
            /// The handle is null or comes from this library.
            #[allow(unused_variables)]
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn $refused(
                handle: $crate::fmi::gate::answer::Handle,
                $($argument: $type),*
            ) -> $crate::fmi::gate::answer::Status {
                // SAFETY: by contract.
                unsafe { $crate::fmi::gate::refusing::refuse(handle, $table::$refused) }
            }
        )*)*
    };
}
pub(super) use table;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fmi::three::table::Fmi3;
    use crate::fmi::two::table::Fmi2;

    fn every_row_has_a_column_for_each_phase<F: Function>() {
        for function in F::ALL {
            let Rule::In(row) = function.rule() else { continue };
            assert_eq!(row.len(), F::PHASES.len(), "{}", function.name());
            assert!(row.bytes().all(|b| b == b'x' || b == b'.'), "{}", function.name());
            assert!(row.contains('x'), "{} is refused without a reason", function.name());
            assert!(!function.allowed_in(Phase::Fatal), "{}", function.name());
        }
    }

    #[test]
    fn every_row_has_a_column_for_each_phase_and_allows_nothing_after_a_fatal_error() {
        every_row_has_a_column_for_each_phase::<Fmi2>();
        every_row_has_a_column_for_each_phase::<Fmi3>();
    }

    #[test]
    fn states_are_saved_in_phases_that_last() {
        for phase in Phase::ALL {
            let is_allowed =
                Fmi2::fmi2GetFMUstate.allowed_in(phase) || Fmi3::fmi3GetFMUState.allowed_in(phase);
            assert_eq!(phase.lasts(), is_allowed, "{phase:?}");
        }
    }

    #[test]
    fn steps_are_done_only_between_steps() {
        assert_eq!(Fmi2::fmi2DoStep.allowed_phases(), ["stepComplete"]);
        assert_eq!(Fmi2::fmi2SetupExperiment.allowed_phases(), ["instantiated"]);
        assert_eq!(Fmi3::fmi3DoStep.allowed_phases(), ["Step Mode"]);
    }

    #[test]
    fn only_a_saved_state_or_a_reset_leads_on_from_an_internal_error() {
        let allowed = |f: &&Fmi3| f.allowed_in(Phase::Error);
        let names: Vec<&str> = Fmi3::ALL.iter().filter(allowed).map(|f| f.name()).collect();
        assert!(names.contains(&"fmi3Reset") && names.contains(&"fmi3SetFMUState"));
        assert!(!names.iter().any(|name| name.contains("Float") || name.contains("DoStep")));
    }
}
