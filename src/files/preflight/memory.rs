//! Memory of a run, and free memory.

use std::path::Path;

use super::costs::{Costs, uneven};
use comm::Comm;
use engine::domain::{Fullest, Histogram, InitialLayout, reach};
use model::{Case, SphForm};
use populate;

/// Peak memory (bytes) of the largest of `ranks` ranks. The processes of `comm`, which need not be those
/// ranks, share the work. Collective; the same on all of them.
pub fn of_rank(case: &Case, comm: &Comm, ranks: usize) -> f64 {
    let fullest = fullest_of(case, comm, ranks);
    Costs::of_case(case).of(fullest.owned, fullest.halo)
}

/// The most particles of one of `ranks` ranks at the start, stress points included. Collective.
#[allow(clippy::cast_precision_loss, reason = "an estimate")]
pub fn fullest_of(case: &Case, comm: &Comm, ranks: usize) -> Fullest {
    // As many stress points for each particle as there are axes, less some at surfaces.
    let points = match case.sph.form {
        SphForm::StressPoints => (1 + case.dimension) as f64,
        _ => 1.0,
    };
    let fullest = if ranks < 2 {
        let count = |body| populate::count(body, case.dimension, &case.symmetry, None);
        let particles: u64 = case.bodies.iter().map(count).sum();
        Fullest {
            owned: particles as f64,
            halo: 0.0,
        }
    } else {
        fullest(case, comm, ranks).unwrap_or_default()
    };
    Fullest {
        owned: points * fullest.owned,
        halo: points * fullest.halo,
    }
}

/// The most particles of one of `ranks` ranks at the start, from one count of all particles along each
/// axis. `None` for a case without particles. Collective.
#[allow(clippy::cast_precision_loss, reason = "an estimate")]
fn fullest(case: &Case, comm: &Comm, ranks: usize) -> Option<Fullest> {
    let layout = InitialLayout::new(case)?;
    let known = layout.known_levels(case, ranks);
    if known == Some(1) {
        return Some(fullest_slab(case, &layout, comm, ranks));
    }
    let forecast = layout.forecast(case, comm);
    let levels = known.unwrap_or_else(|| forecast.levels(ranks));
    let fullest = forecast.fullest(levels, ranks);
    let even = forecast.total() / ranks as f64;
    Some(Fullest {
        owned: fullest.owned.max(even * uneven(case, ranks)),
        ..fullest
    })
}

/// The most particles of one of `ranks` ranks in slabs of one level, from one count along their axis.
/// Collective.
#[allow(clippy::cast_precision_loss, reason = "an estimate")]
fn fullest_slab(case: &Case, layout: &InitialLayout, comm: &Comm, ranks: usize) -> Fullest {
    let mut histogram = Histogram::default();
    layout.count(case, comm, ranks, &mut histogram);
    histogram.sum(comm);
    let count = histogram.cumulate(0);
    let even = count.total() as f64 / ranks as f64;
    let face = |k: usize| count.plane(even * k as f64);
    let reach = reach(case);
    let mut most = [0, 0];
    for rank in 0..ranks {
        let [lower, upper] = [face(rank), face(rank + 1)];
        let mut halo = 0;
        if rank > 0 {
            halo += count.below(lower, 0.0) - count.below(lower, -reach);
        }
        if rank + 1 < ranks {
            halo += count.below(upper, reach) - count.below(upper, 0.0);
        }
        let owned = count.below(upper, 0.0) - count.below(lower, 0.0);
        most = [most[0].max(owned), most[1].max(halo)];
    }
    Fullest {
        owned: (even * uneven(case, ranks)).max(most[0] as f64),
        halo: most[1] as f64,
    }
}

/// A message if the ranks will take more memory than there is. Collective; the same on all ranks.
#[allow(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "an estimate"
)]
pub fn shortage(comm: &Comm, case: &Case) -> Option<String> {
    let local = local_ranks(comm.size()) as u64;
    let mut share = [free(Path::new("/")).map_or(u64::MAX, |bytes| bytes / local)];
    comm.min_u64(&mut share);
    let wanted = of_rank(case, comm, comm.size());
    let [share] = share;
    (wanted > share as f64).then(|| {
        let (wanted, available) = (in_words(wanted), in_words(share as f64));
        format!(
            "a rank takes about {wanted}, and {available} of memory are free for each rank of a \
             machine; take more machines or a coarser spacing, or --ignore-memory to start all \
             the same"
        )
    })
}

/// A number of bytes with three digits or so and a unit.
#[must_use]
pub fn in_words(bytes: f64) -> String {
    let (value, unit) = match bytes {
        b if b < 999.5 => return format!("{b:.0} bytes"),
        b if b < 999.5e3 => (b * 1e-3, "kB"),
        b if b < 999.5e6 => (b * 1e-6, "MB"),
        b if b < 999.5e9 => (b * 1e-9, "GB"),
        b => (b * 1e-12, "TB"),
    };
    let digits = usize::from(value < 9.95);
    format!("{value:.digits$} {unit}")
}

/// Ranks on this machine, of so many, as Open MPI and MPICH tell.
#[must_use]
pub fn local_ranks(ranks: usize) -> usize {
    let names = ["OMPI_COMM_WORLD_LOCAL_SIZE", "MPI_LOCALNRANKS"];
    let found = names
        .iter()
        .find_map(|name| std::env::var(name).ok()?.parse().ok());
    found.unwrap_or(ranks).max(1)
}

/// Bytes that this process may still take: those free on the machine, or in its control group if that is
/// less. `root` holds `/proc` and `/sys`.
fn free(root: &Path) -> Option<u64> {
    let limits = [machine(root), group(root)];
    limits.into_iter().flatten().min()
}

fn machine(root: &Path) -> Option<u64> {
    let text = std::fs::read_to_string(root.join("proc/meminfo")).ok()?;
    let line = text
        .lines()
        .find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024)
}

/// Bytes left in the tightest control group above this process, of either version.
fn group(root: &Path) -> Option<u64> {
    let text = std::fs::read_to_string(root.join("proc/self/cgroup")).ok()?;
    let mut least = None;
    for line in text.lines() {
        let mut fields = line.splitn(3, ':').skip(1);
        let (controllers, path) = (fields.next()?, fields.next()?);
        let (mount, names) = match controllers {
            "" => (
                "sys/fs/cgroup",
                ["memory.max", "memory.current", "inactive_file "],
            ),
            _ if controllers.split(',').any(|name| name == "memory") => (
                "sys/fs/cgroup/memory",
                [
                    "memory.limit_in_bytes",
                    "memory.usage_in_bytes",
                    "total_inactive_file ",
                ],
            ),
            _ => continue,
        };
        let mount = root.join(mount);
        for folder in mount.join(path.trim_start_matches('/')).ancestors() {
            if !folder.starts_with(&mount) {
                break;
            }
            least = [least, left(folder, names)].into_iter().flatten().min();
        }
    }
    least
}

/// Bytes left in one control group; cached files count as free.
fn left(folder: &Path, [limit, used, files]: [&str; 3]) -> Option<u64> {
    let read = |name: &str| std::fs::read_to_string(folder.join(name)).ok();
    let number = |name: &str| read(name)?.trim().parse::<u64>().ok();
    let (limit, used) = (number(limit)?, number(used)?);
    let files = read("memory.stat").and_then(|text| {
        let mut lines = text.lines();
        lines.find_map(|line| line.strip_prefix(files)?.trim().parse::<u64>().ok())
    });
    Some(limit.saturating_sub(used.saturating_sub(files.unwrap_or(0))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input;
    use crate::preflight::{approaches, warnings};
    use engine::domain::{Balance, Tally, tally};
    use particles::Mirrors;
    use populate::visits;

    fn quarter(spacing: &str) -> Case {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../inputs/quarter-impact");
        input::load(&path, &[format!("spacing={spacing}")]).unwrap()
    }

    /// Rows are visited once, for any number of ranks, and they are many fewer than particles.
    #[test]
    fn what_is_foretold_costs_the_same_for_any_ranks() {
        let solo = Comm::solo();
        let case = quarter("0.005mm");
        let visits_of = |ranks| visits::of(|| of_rank(&case, &solo, ranks));
        // With one level rows are visited along its axis alone.
        assert!(visits_of(2) < visits_of(8));
        let few = visits_of(8);
        assert_eq!(few, visits_of(10_000));
        assert!(few < 100_000, "{few} rows");
        // All that `check` does, with eight times as many particles each time.
        let all_of = |spacing| {
            visits::of(|| {
                let case = quarter(spacing);
                let approaches = approaches(&case);
                let predicted = (warnings(&case, &approaches), approaches);
                (predicted, of_rank(&case, &solo, 10_000))
            })
        };
        let visits = ["0.01mm", "0.005mm", "0.0025mm"].map(all_of);
        assert!(visits.is_sorted_by(|a, b| *b < 5 * a), "{visits:?}");
        // A billion particles.
        let most = all_of("0.00073mm");
        assert!(most < 2_000_000, "{most} rows");
    }

    /// Slabs and halos are those of a walk along the sites.
    #[test]
    #[allow(clippy::cast_precision_loss, reason = "counts of thousands")]
    fn the_fullest_rank_is_that_of_a_walk() {
        let case = quarter("0.02mm");
        let mut x: Vec<f64> = Vec::new();
        for body in &case.bodies {
            let sites = populate::sites(body, 3, &case.symmetry, None);
            x.extend(sites.map(|site| site.position[0]));
        }
        x.sort_by(f64::total_cmp);
        let fullest = fullest(&case, &Comm::solo(), 4).unwrap();
        let reach = 2.6 * 0.02e-3;
        let within = |lower: f64, upper: f64| {
            let slab = |x: &&f64| lower <= **x && **x < upper;
            x.iter().filter(slab).count() as f64
        };
        // Just above the layer that completes the share.
        let face = |k: usize| x[(x.len() * k).div_ceil(4) - 1] + 1e-9;
        let halo = [
            within(face(1), face(1) + reach),
            within(face(1) - reach, face(1)) + within(face(2), face(2) + reach),
            within(face(2) - reach, face(2)) + within(face(3), face(3) + reach),
            within(face(3) - reach, face(3)),
        ];
        assert_eq!(fullest.halo, halo.into_iter().fold(0.0, f64::max));
        let even = x.len() as f64 / 4.0;
        assert_eq!(fullest.owned, uneven(&case, 4) * even);
    }

    /// Slabs of slabs and their halos hold as many particles as forecast, but for bodies that are no boxes.
    #[test]
    #[allow(clippy::cast_precision_loss, reason = "counts of thousands")]
    fn the_forecast_is_that_of_a_count() {
        let case = quarter("0.02mm");
        let sites = |body| populate::sites(body, 3, &case.symmetry, None);
        let sites = case.bodies.iter().flat_map(sites);
        let positions: Vec<[f64; 3]> = sites.map(|site| site.position).collect();
        let reaches = vec![0.5 * reach(&case); positions.len()];
        let solo = Comm::solo();
        let layout = InitialLayout::new(&case).unwrap();
        let forecast = layout.forecast(&case, &solo);
        assert_eq!(forecast.total(), positions.len() as f64);
        for (ranks, levels) in [(8, 1), (8, 2), (8, 3), (30, 2), (60, 3)] {
            let slabs = layout.slabs(&case, &solo, (ranks, Some(levels)), &mut Balance::default());
            let tallies = tally(&slabs, &Mirrors::default(), (&positions, &reaches), |_| {});
            let most = |of: fn(&Tally) -> u64| tallies.iter().map(of).max().unwrap() as f64;
            let (owned, halo) = (most(|tally| tally.owned), most(|tally| tally.halo));
            let predicted = forecast.fullest(levels, ranks);
            println!("{ranks} ranks, {levels} levels: {predicted:?}, in truth {owned} and {halo}");
            for (predicted, truth) in [(predicted.halo, halo), (predicted.owned, owned)] {
                assert!((predicted / truth - 1.0).abs() < 0.25, "{ranks} {levels}");
            }
        }
        assert!(forecast.levels(10_000) > 1);
    }

    #[test]
    fn bytes_have_a_unit_that_suits_them() {
        let sizes = [
            0.0, 999.0, 999.9, 51_234.0, 5e6, 64.4e6, 999.6e6, 1.25e9, 12e9, 2.5e13,
        ];
        let words = sizes.map(in_words);
        let expected = [
            "0 bytes",
            "999 bytes",
            "1.0 kB",
            "51 kB",
            "5.0 MB",
            "64 MB",
            "1.0 GB",
            "1.2 GB",
            "12 GB",
            "25 TB",
        ];
        assert_eq!(words, expected);
    }

    #[test]
    fn the_tightest_limit_counts() {
        let root = tempfile::tempdir().unwrap();
        let write = |path: &str, text: &str| {
            let path = root.path().join(path);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        };
        assert_eq!(free(root.path()), None);
        write("proc/meminfo", "MemTotal: 9 kB\nMemAvailable:   3000 kB\n");
        assert_eq!(free(root.path()), Some(3_072_000));
        write("proc/self/cgroup", "0::/job/task\n");
        write("sys/fs/cgroup/job/task/memory.max", "max\n");
        assert_eq!(free(root.path()), Some(3_072_000));
        write("sys/fs/cgroup/job/memory.max", "1000000\n");
        write("sys/fs/cgroup/job/memory.current", "600000\n");
        write(
            "sys/fs/cgroup/job/memory.stat",
            "anon 5\ninactive_file 100000\n",
        );
        assert_eq!(free(root.path()), Some(500_000));
        write("proc/self/cgroup", "7:cpu:/x\n4:cpuset,memory:/y\n");
        write("sys/fs/cgroup/memory/y/memory.limit_in_bytes", "900\n");
        write("sys/fs/cgroup/memory/y/memory.usage_in_bytes", "1000\n");
        assert_eq!(free(root.path()), Some(0));
    }
}
