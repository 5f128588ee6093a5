//! Memory available to this process.

/// Memory that this process may still take [B]; infinite if the system does not report it.
///
/// On Linux it is the smaller of the free or reclaimable memory (`/proc/meminfo`) and the remainder of the process's
/// control groups (version 2, or the memory groups of version 1). On Windows it is the smaller of the free physical
/// memory and the memory that the process may still commit. Address space is separate: see
/// [`crate::runtime::address_space`].
pub fn available_memory() -> f64 {
    system::available()
}

#[cfg(windows)]
mod system {
    use std::mem;

    /// `MEMORYSTATUSEX` of `sysinfoapi.h`.
    #[repr(C)]
    #[derive(Default)]
    struct MemoryStatus {
        length: u32,
        load: u32,
        physical: u64,
        free_physical: u64,
        page_file: u64,
        /// Memory that the process may still commit.
        free_page_file: u64,
        virtual_space: u64,
        free_virtual_space: u64,
        free_extended: u64,
    }

    #[link(name = "kernel32")]
    unsafe extern "system" {
        fn GlobalMemoryStatusEx(status: *mut MemoryStatus) -> i32;
    }

    pub fn available() -> f64 {
        let length = mem::size_of::<MemoryStatus>() as u32;
        let mut status = MemoryStatus { length, ..MemoryStatus::default() };
        // SAFETY: the structure has the length that it states.
        match unsafe { GlobalMemoryStatusEx(&mut status) } {
            0 => f64::INFINITY,
            _ => status.free_physical.min(status.free_page_file) as f64,
        }
    }
}

#[cfg(not(windows))]
mod system {
    use std::fs;
    use std::path::Path;

    pub fn available() -> f64 {
        let read = |path: &str| fs::read_to_string(path).unwrap_or_default();
        let free = kilobytes(&read("/proc/meminfo"), "MemAvailable:");
        let groups =
            groups(&read("/proc/self/cgroup")).into_iter().filter_map(|path| remaining_in(&path));
        free.into_iter().chain(groups).fold(f64::INFINITY, f64::min)
    }

    /// The number behind a key of lines `Key: number kB` [B].
    fn kilobytes(text: &str, key: &str) -> Option<f64> {
        let line = text.lines().find_map(|line| line.strip_prefix(key))?;
        let number: f64 = line.split_whitespace().next()?.parse().ok()?;
        Some(1024.0 * number)
    }

    /// Folders of the control groups in `/proc/self/cgroup`, and of their parents.
    fn groups(text: &str) -> Vec<String> {
        let mut all = Vec::new();
        for line in text.lines() {
            let mut parts = line.splitn(3, ':').skip(1);
            let (Some(controllers), Some(path)) = (parts.next(), parts.next()) else { continue };
            let root = match controllers {
                "" => "/sys/fs/cgroup",
                list if list.split(',').any(|name| name == "memory") => "/sys/fs/cgroup/memory",
                _ => continue,
            };
            let around =
                Path::new(path).ancestors().map(|path| format!("{root}{}", path.display()));
            all.extend(around);
        }
        all
    }

    /// Remaining memory of a control group [B]; `None` without a limit.
    fn remaining_in(folder: &str) -> Option<f64> {
        let read =
            |name: &str| fs::read_to_string(format!("{}/{name}", folder.trim_end_matches('/')));
        let number = |name: &str| read(name).ok()?.trim().parse::<f64>().ok();
        let most = number("memory.max").or_else(|| number("memory.limit_in_bytes"))?;
        let used = number("memory.current").or_else(|| number("memory.usage_in_bytes"))?;
        // The file cache is dropped under memory pressure.
        let cached = read("memory.stat").ok().and_then(|text| {
            let line = text.lines().find_map(|line| line.strip_prefix("inactive_file "))?;
            line.trim().parse::<f64>().ok()
        });
        Some((most - used + cached.unwrap_or(0.0)).max(0.0))
    }

    #[cfg(test)]
    mod tests {
        use super::*;

        #[test]
        fn reads_system_values() {
            let text = "MemTotal:   16 kB\nMemAvailable:   12345 kB\n";
            assert_eq!(kilobytes(text, "MemAvailable:"), Some(12345.0 * 1024.0));
            assert_eq!(kilobytes("", "MemAvailable:"), None);
        }

        #[test]
        fn control_groups_are_nested() {
            let both = "5:cpu,memory:/a\n3:cpuset:/x\n0::/b/c\n";
            let expected = [
                "/sys/fs/cgroup/memory/a",
                "/sys/fs/cgroup/memory/",
                "/sys/fs/cgroup/b/c",
                "/sys/fs/cgroup/b",
                "/sys/fs/cgroup/",
            ];
            assert_eq!(groups(both), expected);
            assert_eq!(remaining_in("/nowhere"), None);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn available_memory_is_positive() {
        assert!(available_memory() > 1e6);
    }
}
