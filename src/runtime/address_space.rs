//! Limits of address space, of any kind (`RLIMIT_AS`) or writable (`RLIMIT_DATA`). Reserved space counts, used or not.
//! Without such a limit, everything fits.

/// Address space that the C library reserves for a thread that allocates, if possible [B].
pub const ARENA: usize = 64 << 20;

/// Scratch memory of the matrix product kernels per thread [B].
pub const PRODUCTS: usize = 4 << 20;

/// Reserve for small, uncounted requests [B].
pub const SPARE: usize = 4 << 20;

/// Size below which requests are not checked: the allocator's reserve is larger [B].
const SMALL: usize = 256 << 10;

/// Error: the process may not take as much as is needed.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "this requires up to {:.3} MB of address space; the limit of this process ({limit}) leaves {:.3} MB",
    *needed as f64 / 1e6,
    *left as f64 / 1e6
)]
pub struct TooLittle {
    /// Needed size [B].
    pub needed: usize,
    pub left: usize,
    /// Name of the limit.
    pub limit: &'static str,
}

/// Refuses sizes that might exceed what the process may have.
pub fn expect(bytes: usize) -> Result<(), TooLittle> {
    if fits(bytes) {
        return Ok(());
    }
    let (left, limit) = (left().unwrap_or(usize::MAX), system::limits());
    Err(TooLittle { needed: bytes, left, limit })
}

/// Returns true if the process may take so many more bytes.
pub fn fits(bytes: usize) -> bool {
    bytes <= SMALL || !system::is_limited() || system::can_be_reserved(bytes)
}

/// Largest single request in bytes; `None` without a limit.
pub fn left() -> Option<usize> {
    if !system::is_limited() {
        return None;
    }
    let (mut had, mut missed) = (0, 1 << 46);
    while missed - had > 1 << 16 {
        let middle = had + (missed - had) / 2;
        match system::can_be_reserved(middle) {
            true => had = middle,
            false => missed = middle,
        }
    }
    Some(had)
}

#[cfg(target_os = "linux")]
mod system {
    use std::mem::MaybeUninit;
    use std::ptr;

    /// Resource numbers have different types in different C libraries.
    fn has_limit(read: impl FnOnce(*mut libc::rlimit) -> i32) -> bool {
        let mut limit = MaybeUninit::uninit();
        // SAFETY: the limit is read only where the system has written it.
        read(limit.as_mut_ptr()) == 0
            && unsafe { limit.assume_init() }.rlim_cur != libc::RLIM_INFINITY
    }

    fn has_limit_of_space() -> bool {
        // SAFETY: writes a limit where one may stand.
        has_limit(|limit| unsafe { libc::getrlimit(libc::RLIMIT_AS, limit) })
    }

    fn has_limit_of_data() -> bool {
        // SAFETY: as above.
        has_limit(|limit| unsafe { libc::getrlimit(libc::RLIMIT_DATA, limit) })
    }

    pub fn is_limited() -> bool {
        has_limit_of_space() || has_limit_of_data()
    }

    /// Names of the limits on this system.
    pub fn limits() -> &'static str {
        match [has_limit_of_space(), has_limit_of_data()] {
            [true, true] => "RLIMIT_AS, RLIMIT_DATA",
            [false, true] => "RLIMIT_DATA",
            _ => "RLIMIT_AS",
        }
    }

    /// Tests a reservation by making and releasing it, since only the system knows what counts. Only writable space
    /// counts as data.
    pub fn can_be_reserved(bytes: usize) -> bool {
        let flags = libc::MAP_PRIVATE | libc::MAP_ANONYMOUS | libc::MAP_NORESERVE;
        let access = match has_limit_of_data() {
            true => libc::PROT_READ | libc::PROT_WRITE,
            false => libc::PROT_NONE,
        };
        // SAFETY: a new mapping, which nobody else knows of, is given back.
        unsafe {
            let place = libc::mmap(ptr::null_mut(), bytes, access, flags, -1, 0);
            place != libc::MAP_FAILED && libc::munmap(place, bytes) == 0
        }
    }
}

#[cfg(not(target_os = "linux"))]
mod system {
    pub fn is_limited() -> bool {
        false
    }

    pub fn limits() -> &'static str {
        "none"
    }

    pub fn can_be_reserved(_bytes: usize) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_limit_admits_everything() {
        if left().is_none() {
            assert!(fits(usize::MAX));
        }
        assert!(fits(SMALL));
    }
}
