//! Exported functions that only refuse.

use super::types::Refusal;

/// Why a function is never done.
#[derive(Debug, Clone, Copy)]
pub enum Reason {
    /// An optional capability that the XML does not declare.
    NotOffered,
    ModelExchange,
    NothingPending,
}

impl From<Reason> for Refusal {
    fn from(reason: Reason) -> Self {
        Refusal::error(match reason {
            Reason::NotOffered => "not offered, as the capability flags of the unit say",
            Reason::ModelExchange => "belongs to model exchange; this unit is for co-simulation",
            Reason::NothingPending => "no step is pending",
        })
    }
}

/// Exports functions that act on an instance and refuse for one reason. A line holds the C name, the
/// row in the table of legal calls and the types of the arguments after the instance:
///
/// `refused! { Reason::ModelExchange; fn fmi2SetTime: SetTime(Real); }`
macro_rules! refused {
    ($reason:expr; $(fn $name:ident: $function:ident($($argument:ty),*);)*) => {$(
        /// Refused, with the reason in the log.
        ///
        /// # Safety
        /// `component` is null or comes from fmi2Instantiate.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(
            component: $crate::fmi::types::Handle $(, _: $argument)*
        ) -> $crate::fmi::types::Status {
            // SAFETY: by contract.
            unsafe {
                $crate::fmi::instance::call(
                    component,
                    $crate::fmi::legality::Function::$function,
                    |_| Err($reason.into()),
                )
            }
        }
    )*};
}

pub(super) use refused;
