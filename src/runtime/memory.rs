//! Memory available to this process.

use std::fs;
use std::path::Path;

/// Memory that this process may still take [B]; infinite if the system does not report it.
///
/// It is the smaller of the free or reclaimable memory (`/proc/meminfo`) and the remainder of the process's control
/// groups (version 2, or the memory groups of version 1). Address space is separate: see
/// [`crate::runtime::address_space`].
pub fn available_memory() -> f64 {
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
        let around = Path::new(path).ancestors().map(|path| format!("{root}{}", path.display()));
        all.extend(around);
    }
    all
}

/// Remaining memory of a control group [B]; `None` without a limit.
fn remaining_in(folder: &str) -> Option<f64> {
    let read = |name: &str| fs::read_to_string(format!("{}/{name}", folder.trim_end_matches('/')));
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

    #[test]
    fn available_memory_is_positive() {
        assert!(available_memory() > 1e6);
    }
}
