//! The memory of this process.

use std::fs;

/// The peak memory of this process in bytes, on Linux; `None` on other systems.
pub fn peak_memory() -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = peak.trim().strip_suffix("kB")?.trim_end().parse().ok()?;
    kibibytes.checked_mul(1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(target_os = "linux")]
    fn linux_tells_how_much_it_is() {
        let mebibytes = peak_memory().unwrap() >> 20;
        assert!((1..1 << 20).contains(&mebibytes), "{mebibytes}");
    }
}
