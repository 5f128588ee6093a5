//! FMI functions that save and restore states or differentiate, section 2.1.8 and 2.1.9 of the
//! standard: optional, and not offered.

use super::refused::{Reason, refused};
use super::types::{Byte, Real, Reference, SavedState};

refused! { Reason::NotOffered;
    fn fmi2GetFMUstate: GetFMUstate(*mut SavedState);
    fn fmi2SetFMUstate: SetFMUstate(SavedState);
    fn fmi2FreeFMUstate: FreeFMUstate(*mut SavedState);
    fn fmi2SerializedFMUstateSize: SerializedFMUstateSize(SavedState, *mut usize);
    fn fmi2SerializeFMUstate: SerializeFMUstate(SavedState, *mut Byte, usize);
    fn fmi2DeSerializeFMUstate: DeSerializeFMUstate(*const Byte, usize, *mut SavedState);
    fn fmi2GetDirectionalDerivative:
        GetDirectionalDerivative(*const Reference, usize, *const Reference, usize, *const Real, *mut Real);
}
