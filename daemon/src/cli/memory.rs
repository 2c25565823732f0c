//! `--memory-limit SIZE`, and how much memory this process may still take when nobody says.

use std::path::{Path, PathBuf};

/// Where Linux tells about control groups.
const GROUPS: &str = "/sys/fs/cgroup";

/// A number of bytes as people write it: `4G`, `512M`, `1.5GiB`, `800000000`. K, M, G and T are powers of 1024.
pub fn parse_size(text: &str) -> Result<u64, String> {
    let refused = || format!("{text:?} is not a size such as 4G, 512M or 800000000");
    let upper = text.trim().to_ascii_uppercase();
    let number = upper.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let shift = match &upper[number.len()..] {
        "" | "B" => 0,
        "K" | "KB" | "KIB" => 10,
        "M" | "MB" | "MIB" => 20,
        "G" | "GB" | "GIB" => 30,
        "T" | "TB" | "TIB" => 40,
        _ => return Err(refused()),
    };
    let bytes = number.trim_end().parse::<f64>().map_err(|_| refused())? * 2f64.powi(shift);
    // The float of 2^64 is exact; what lies below it fits.
    if (1.0..u64::MAX as f64).contains(&bytes) { Ok(bytes as u64) } else { Err(refused()) }
}

/// Bytes that this process may still take: what the machine can give without swapping, or less where a control group limits it.
/// None where the system does not tell.
pub fn available() -> Option<u64> {
    available_by(&|path| std::fs::read_to_string(path).ok())
}

/// The same from the files that `read` gives.
fn available_by(read: &dyn Fn(&Path) -> Option<String>) -> Option<u64> {
    let machine = read(Path::new("/proc/meminfo")).and_then(|text| of_machine(&text));
    let groups = read(Path::new("/proc/self/cgroup")).unwrap_or_default();
    let of_groups = groups.lines().flat_map(|line| of_group(line, read));
    machine.into_iter().chain(of_groups).min()
}

/// `MemAvailable` in bytes.
fn of_machine(meminfo: &str) -> Option<u64> {
    let line = meminfo.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?.checked_mul(1024)
}

/// What is left in the group of a line of `/proc/self/cgroup`, `ID:CONTROLLERS:PATH`, and in each group above it.
fn of_group(line: &str, read: &dyn Fn(&Path) -> Option<String>) -> Vec<u64> {
    let mut parts = line.splitn(3, ':');
    let (Some(id), Some(controllers), Some(path)) = (parts.next(), parts.next(), parts.next()) else {
        return Vec::new();
    };
    let version = match (id, controllers) {
        ("0", "") => {
            Version { root: PathBuf::from(GROUPS), max: "memory.max", used: "memory.current", cache: "inactive_file" }
        }
        (_, list) if list.split(',').any(|c| c == "memory") => Version {
            root: Path::new(GROUPS).join("memory"),
            max: "memory.limit_in_bytes",
            used: "memory.usage_in_bytes",
            cache: "total_inactive_file",
        },
        _ => return Vec::new(),
    };
    let inner = version.root.join(path.trim_start_matches('/'));
    // Inside a container the path may be that of the host: its root is then what the container sees.
    inner
        .ancestors()
        .take_while(|folder| folder.starts_with(&version.root))
        .filter_map(|f| version.left(f, read))
        .collect()
}

/// Names of the files of a version of control groups.
struct Version {
    root: PathBuf,
    max: &'static str,
    used: &'static str,
    /// File contents in memory that the system gives up when it needs the room.
    cache: &'static str,
}

impl Version {
    /// Limit less use, of one group; none where there is no limit.
    fn left(&self, folder: &Path, read: &dyn Fn(&Path) -> Option<String>) -> Option<u64> {
        let number = |name: &str| read(&folder.join(name))?.trim().parse::<u64>().ok();
        // Version 2 says "max" where there is none, version 1 a number beyond all machines, which the machine's own undercuts.
        let (max, used) = (number(self.max)?, number(self.used)?);
        let statistics = read(&folder.join("memory.stat")).unwrap_or_default();
        let cache = statistics.lines().find_map(|line| line.strip_prefix(self.cache)?.trim().parse::<u64>().ok());
        Some(max.saturating_sub(used.saturating_sub(cache.unwrap_or(0))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MEMINFO: &str = "MemTotal:       24684092 kB\nMemFree:        20772348 kB\nMemAvailable:   22448788 kB\n";
    const MACHINE: u64 = 22_448_788 * 1024;

    fn available_in(files: &[(&str, &str)]) -> Option<u64> {
        available_by(&|path| files.iter().find(|(name, _)| Path::new(name) == path).map(|(_, text)| (*text).to_owned()))
    }

    #[test]
    fn without_groups_the_machine_decides() {
        assert_eq!(available_in(&[("/proc/meminfo", MEMINFO)]), Some(MACHINE));
        assert_eq!(available_in(&[]), None, "another system");
        assert_eq!(available_in(&[("/proc/meminfo", "MemTotal: 5 kB\n")]), None, "an old one");
    }

    #[test]
    fn the_tightest_group_of_version_2_decides() {
        let files = [
            ("/proc/meminfo", MEMINFO),
            ("/proc/self/cgroup", "0::/batch/job\n"),
            ("/sys/fs/cgroup/batch/job/memory.max", "max\n"),
            ("/sys/fs/cgroup/batch/job/memory.current", "1000\n"),
            ("/sys/fs/cgroup/batch/memory.max", "4000000000\n"),
            ("/sys/fs/cgroup/batch/memory.current", "1500000000\n"),
            ("/sys/fs/cgroup/batch/memory.stat", "anon 1\nfile 2\ninactive_file 500000000\nactive_file 7\n"),
        ];
        assert_eq!(available_in(&files), Some(3_000_000_000));
    }

    #[test]
    fn version_1_is_read_beside_an_empty_version_2() {
        let files = [
            ("/proc/meminfo", MEMINFO),
            ("/proc/self/cgroup", "9:name=systemd:/\n4:cpu,memory:/docker/7f\n0::/\n"),
            ("/sys/fs/cgroup/memory/memory.limit_in_bytes", "2000000000\n"),
            ("/sys/fs/cgroup/memory/memory.usage_in_bytes", "2500000000\n"),
            ("/sys/fs/cgroup/memory/memory.stat", "cache 1\ninactive_file 3\ntotal_inactive_file 600000000\n"),
        ];
        assert_eq!(available_in(&files), Some(100_000_000));
        let unlimited = [
            files[0],
            files[1],
            ("/sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n"),
            ("/sys/fs/cgroup/memory/memory.usage_in_bytes", "5\n"),
        ];
        assert_eq!(available_in(&unlimited), Some(MACHINE));
    }

    #[test]
    fn a_group_above_its_limit_has_nothing_left() {
        let files = [
            ("/proc/self/cgroup", "0::/\n"),
            ("/sys/fs/cgroup/memory.max", "10\n"),
            ("/sys/fs/cgroup/memory.current", "11\n"),
        ];
        assert_eq!(available_in(&files), Some(0));
    }

    #[test]
    fn sizes_are_read_as_people_write_them() {
        for (text, bytes) in [
            ("800000000", 800_000_000),
            ("4G", 4 << 30),
            ("512m", 512 << 20),
            ("1.5 GiB", 3 << 29),
            ("64KB", 64 << 10),
            ("2T", 2 << 40),
            ("7b", 7),
        ] {
            assert_eq!(parse_size(text), Ok(bytes), "{text}");
        }
        for text in ["", "G", "0", "-1G", "4X", "4GG", "nan", "inf", "1e30T", "0.2"] {
            assert!(parse_size(text).is_err(), "{text}");
        }
    }
}
