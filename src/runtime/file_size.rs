//! Files that grow beyond what the process may write.

/// Lets writes beyond the limit of file sizes (`RLIMIT_FSIZE`) fail as those to a full disk do, where they would end the
/// process otherwise. For programs: a library leaves the signals of its host alone.
pub fn report_limits() {
    #[cfg(unix)]
    // SAFETY: ignoring a signal runs no code of ours.
    unsafe {
        libc::signal(libc::SIGXFSZ, libc::SIG_IGN);
    }
}
