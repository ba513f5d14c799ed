//! The memory that this process may still take.

use std::fs::read_to_string;
use std::path::Path;

/// Bytes as text: "10.0 MiB".
pub(crate) fn mib(bytes: u64) -> String {
    format!("{:.1} MiB", bytes as f64 / f64::from(1 << 20))
}

/// Returns the memory that this process may still take: of the machine, of its group's limit and of its own; `None` where unknown.
pub(crate) fn free_bytes() -> Option<u64> {
    let of_machine = kib_field_bytes("/proc/meminfo", "MemAvailable:");
    [
        of_machine,
        cgroup_memory_headroom(),
        address_space_headroom(),
    ]
    .into_iter()
    .flatten()
    .min()
}

/// The number behind `name` in a file of the system that counts in KiB, bytes.
fn kib_field_bytes(file: &str, name: &str) -> Option<u64> {
    let text = read_to_string(file).ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    let count: u64 = line.split_whitespace().next()?.parse().ok()?;
    Some(count << 10)
}

/// The free memory under the limit on addresses (`ulimit -v`).
fn address_space_headroom() -> Option<u64> {
    let limits = read_to_string("/proc/self/limits").ok()?;
    let most = limits
        .lines()
        .find_map(|line| line.strip_prefix("Max address space"))?;
    let most: u64 = most.split_whitespace().next()?.parse().ok()?;
    Some(most.saturating_sub(kib_field_bytes("/proc/self/status", "VmSize:")?))
}

/// The free memory under the limits of the process's control groups, of either version.
fn cgroup_memory_headroom() -> Option<u64> {
    let groups = read_to_string("/proc/self/cgroup").ok()?;
    let rooms = groups.lines().filter_map(|line| {
        let (_, line) = line.split_once(':')?;
        let (kinds, path) = line.split_once(':')?;
        let (root, most, used) = match kinds {
            "" => ("/sys/fs/cgroup", "memory.max", "memory.current"),
            "memory" => (
                "/sys/fs/cgroup/memory",
                "memory.limit_in_bytes",
                "memory.usage_in_bytes",
            ),
            _ => return None,
        };
        let groups = Path::new(path).ancestors();
        let folders =
            groups.map(|group| Path::new(root).join(group.strip_prefix("/").unwrap_or(group)));
        folders
            .filter_map(|folder| cgroup_headroom(&folder, most, used))
            .min()
    });
    rooms.min()
}

fn cgroup_headroom(folder: &Path, most: &str, used: &str) -> Option<u64> {
    let number =
        |name: &str| -> Option<u64> { read_to_string(folder.join(name)).ok()?.trim().parse().ok() };
    let most = number(most)?;
    // The system's cache of files is given up when memory is needed.
    let stat = read_to_string(folder.join("memory.stat")).unwrap_or_default();
    let kept = stat
        .lines()
        .find_map(|line| line.strip_prefix("inactive_file "))
        .and_then(|count| count.trim().parse().ok())
        .unwrap_or(0);
    Some(most.saturating_sub(number(used)?.saturating_sub(kept)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_group_has_room_for_its_limit_less_what_it_uses_and_cannot_give_up() {
        let folder = tempfile::tempdir().unwrap();
        let write =
            |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
        let room = || cgroup_headroom(folder.path(), "memory.max", "memory.current");
        assert_eq!(room(), None);
        write("memory.max", "max\n");
        write("memory.current", "700\n");
        assert_eq!(room(), None);
        write("memory.max", "1000\n");
        assert_eq!(room(), Some(300));
        write("memory.stat", "anon 5\ninactive_file 200\nactive_file 9\n");
        assert_eq!(room(), Some(500));
    }
}
