//! Memory of this machine and of processes, as Linux tells it; other systems tell nothing here.

use std::fs::read_to_string;
use std::path::Path;

/// Memory that can be had now, bytes: what the machine has left, and what the control group of this
/// program may still take, as a cluster sets it.
pub(crate) fn free() -> Option<u64> {
    let machine = figure("/proc/meminfo", "MemAvailable:")?;
    Some(group().map_or(machine, |group| group.min(machine)))
}

/// What the control group of this program, and those above it, may still take.
fn group() -> Option<u64> {
    let own = read_to_string("/proc/self/cgroup").ok()?;
    let path = own.lines().find_map(|l| l.strip_prefix("0::/"))?.to_owned();
    let root = Path::new("/sys/fs/cgroup");
    let number = |file: &Path| read_to_string(file).ok()?.trim().parse::<u64>().ok();
    let left = |group: &Path| {
        let most = number(&group.join("memory.max"))?;
        Some(most.saturating_sub(number(&group.join("memory.current"))?))
    };
    root.join(path).ancestors().take_while(|a| a.starts_with(root)).filter_map(left).min()
}

/// Resident memory of a process, bytes.
pub(crate) fn held(process: u32) -> Option<u64> {
    figure(&format!("/proc/{process}/status"), "VmRSS:")
}

/// A figure of the kernel's, in bytes.
fn figure(file: &str, name: &str) -> Option<u64> {
    let text = read_to_string(file).ok()?;
    let line = text.lines().find_map(|l| l.strip_prefix(name))?;
    Some(line.trim().trim_end_matches("kB").trim().parse::<u64>().ok()? * 1024)
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_process_holds_what_it_has_written() {
        let before = held(std::process::id()).unwrap();
        let much = std::hint::black_box(vec![1_u8; 64 << 20]);
        let after = held(std::process::id()).unwrap();
        assert!(after > before + (32 << 20) && much.len() > 1, "{before} {after}");
        assert!(free().unwrap() > 1 << 20);
    }
}
