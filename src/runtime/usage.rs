//! Processor time and memory that this process has used so far.

/// Processor time and memory of a process.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Usage {
    /// Processor time of all threads, in the program and in the system [s].
    pub processor_time: f64,
    /// Largest resident memory so far [B].
    pub peak_memory: f64,
}

impl Usage {
    /// Returns the usage so far; zero where the system does not report it.
    pub fn now() -> Self {
        read().unwrap_or(Self { processor_time: 0.0, peak_memory: 0.0 })
    }
}

#[cfg(unix)]
fn read() -> Option<Usage> {
    let mut usage = std::mem::MaybeUninit::<libc::rusage>::uninit();
    // SAFETY: the call fills the structure where it returns zero.
    let usage = unsafe {
        (libc::getrusage(libc::RUSAGE_SELF, usage.as_mut_ptr()) == 0).then(|| usage.assume_init())
    }?;
    let seconds = |time: libc::timeval| time.tv_sec as f64 + 1e-6 * time.tv_usec as f64;
    // In kilobytes, but in bytes on Apple's systems.
    let unit = if cfg!(target_vendor = "apple") { 1.0 } else { 1024.0 };
    Some(Usage {
        processor_time: seconds(usage.ru_utime) + seconds(usage.ru_stime),
        peak_memory: peak_of_this_program().unwrap_or(unit * usage.ru_maxrss as f64),
    })
}

/// Largest resident memory of this program [B]; Linux counts in `ru_maxrss` that of the program that started it, too.
#[cfg(unix)]
fn peak_of_this_program() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: f64 = line.trim().strip_suffix("kB")?.trim_end().parse().ok()?;
    Some(1024.0 * kilobytes)
}

#[cfg(not(unix))]
fn read() -> Option<Usage> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn usage_grows_with_work_and_memory() {
        let before = Usage::now();
        let block = vec![1_u8; 64 << 20];
        let sum: u64 = (0..4).flat_map(|_| &block).map(|&byte| u64::from(byte)).sum();
        let after = Usage::now();
        assert_eq!(sum, 4 * (64 << 20));
        assert!(after.processor_time > before.processor_time);
        assert!(after.peak_memory >= (64 << 20) as f64);
    }
}
