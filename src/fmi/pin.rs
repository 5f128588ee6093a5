//! Keeps this library in memory once it may have started threads.
//!
//! Masters unload the library after the last instance is freed. Threads of a pool still wait in its
//! code then, and the host would crash when one of them wakes up.

use std::sync::Once;

/// From now on, unloading this library has no effect.
pub fn keep_loaded() {
    static ONCE: Once = Once::new();
    ONCE.call_once(pin);
}

#[cfg(unix)]
fn pin() {
    use std::ffi::c_void;
    use std::mem::MaybeUninit;

    let here = (keep_loaded as fn()) as *const c_void;
    let mut place = MaybeUninit::<libc::Dl_info>::zeroed();
    // SAFETY: `dladdr` fills `place` with the name of the library that holds `here`; opening it once
    // more with RTLD_NOLOAD loads and runs nothing.
    unsafe {
        if libc::dladdr(here, place.as_mut_ptr()) != 0 {
            let name = place.assume_init().dli_fname;
            libc::dlopen(name, libc::RTLD_NOW | libc::RTLD_NOLOAD | libc::RTLD_NODELETE);
        }
    }
}

#[cfg(not(unix))]
fn pin() {}
