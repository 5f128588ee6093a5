//! Limits of file sizes.

/// Makes writes beyond the limit of file sizes (`RLIMIT_FSIZE`) fail like those to a full disk; otherwise they would
/// end the process. For programs only: a library must not change the signals of its host.
pub fn report_limits() {
    #[cfg(unix)]
    // SAFETY: ignoring a signal runs no code of ours.
    unsafe {
        libc::signal(libc::SIGXFSZ, libc::SIG_IGN);
    }
}
