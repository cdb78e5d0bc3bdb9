//! How much memory a run takes, and how much there is.

use std::path::Path;

use crate::comm::Comm;
use crate::contact::ContactTable;
use crate::model::{Axis, Case, RigidSurface, SphForm};
use crate::populate::{self, Slab};
use crate::sph::kernel::SUPPORT;
use crate::step::bytes_of_options;

/// What a process takes with MPI and HDF5 before it has a particle (bytes). This and the figures
/// below are peaks of the resident memory of ranks that step and write, as measured on the quarter
/// impact with 48,000 and 195,000 particles on one to four ranks.
const PROCESS: f64 = 32.5e6;
/// An owned particle with its lists and buffers (bytes).
const OWNED: f64 = 620.0;
/// What contact between bodies and images behind symmetry planes add (bytes).
const CONTACT: f64 = 170.0;
/// A halo particle with its lists and messages (bytes).
const HALO: f64 = 1200.0;
/// What arrays take over their content as they grow.
const SPARE: f64 = 1.06;
/// By how much a rank's share may rise as work is balanced.
const UNEVEN: f64 = 1.05;
/// Halvings of the case's length that find a face between slabs.
const HALVINGS: usize = 40;

/// Bytes that the largest of so many ranks takes at its peak.
#[allow(clippy::cast_precision_loss, reason = "an estimate")]
pub fn of_rank(case: &Case, ranks: usize) -> f64 {
    let contact = ContactTable::new(case).is_active();
    let [owned_options, halo_options] = bytes_of_options(case).map(|bytes| SPARE * bytes as f64);
    let owned = OWNED + if contact { CONTACT } else { 0.0 } + owned_options;
    let particles = count(case, None) as f64;
    let surfaces = case.loads.surfaces.iter().map(RigidSurface::memory);
    let process = PROCESS + surfaces.sum::<usize>() as f64;
    if ranks < 2 {
        return process + particles * owned;
    }
    let Some((axis, ends)) = longest(case) else {
        return process;
    };
    let faces: Vec<f64> = (1..ranks)
        .map(|k| face(case, axis, ends, particles * k as f64 / ranks as f64))
        .collect();
    // Half of the sum of two supports is what reaches across a face.
    let reach = case
        .bodies
        .iter()
        .map(|body| SUPPORT * body.smoothing_length);
    let reach = reach.fold(0.0, f64::max);
    let beyond = |face: f64, side: f64| {
        let (lower, upper) = (face.min(face + side), face.max(face + side));
        let slab = Slab { axis, lower, upper };
        count(case, Some(slab)) as f64
    };
    let halo = (0..ranks).map(|rank| {
        let below = rank
            .checked_sub(1)
            .map_or(0.0, |k| beyond(faces[k], -reach));
        below + faces.get(rank).map_or(0.0, |&face| beyond(face, reach))
    });
    let uneven = if case.domain.balance_every == 0 {
        1.0
    } else {
        UNEVEN
    };
    let share = particles / ranks as f64 * uneven;
    process + share * owned + halo.fold(0.0, f64::max) * (HALO + halo_options)
}

fn count(case: &Case, slab: Option<Slab>) -> u64 {
    let bodies = case.bodies.iter();
    let particles: u64 = bodies
        .map(|body| populate::count(body, case.dimension, &case.symmetry, slab))
        .sum();
    // As many stress points for each as there are axes, less some at surfaces.
    match case.sph.form {
        SphForm::StressPoints => particles * (1 + case.dimension as u64),
        SphForm::Conventional | SphForm::Normalised => particles,
    }
}

/// The axis of the slabs and the ends of the case on it (m).
fn longest(case: &Case) -> Option<(usize, [f64; 2])> {
    let mut ends = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
    for body in &case.bodies {
        let (lower, upper) = populate::bounds(body, case.dimension)?;
        for axis in 0..case.dimension {
            ends[axis][0] = ends[axis][0].min(lower[axis]);
            ends[axis][1] = ends[axis][1].max(upper[axis]);
        }
    }
    for plane in &case.symmetry {
        let lower = &mut ends[plane.axis.index()][0];
        *lower = lower.max(plane.position);
    }
    let length = |axis: &usize| ends[*axis][1] - ends[*axis][0];
    let longest = (0..case.dimension)
        .rev()
        .max_by(|a, b| length(a).total_cmp(&length(b)))?;
    let axis = case.domain.axis.map_or(longest, Axis::index);
    Some((axis, ends[axis]))
}

/// Where on an axis so many particles stand below (m).
#[allow(clippy::cast_precision_loss, reason = "an estimate")]
fn face(case: &Case, axis: usize, [mut lower, mut upper]: [f64; 2], below: f64) -> f64 {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (lower + upper);
        let slab = Slab {
            axis,
            lower: f64::NEG_INFINITY,
            upper: middle,
        };
        if (count(case, Some(slab)) as f64) < below {
            lower = middle;
        } else {
            upper = middle;
        }
    }
    upper
}

/// Why the ranks have not the memory that they will take, if they have not. Collective; the same on
/// all ranks.
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
    let wanted = of_rank(case, comm.size());
    let [share] = share;
    (wanted > share as f64).then(|| {
        let (wanted, there) = (wanted * 1e-9, share as f64 * 1e-9);
        format!(
            "a rank takes about {wanted:.2} GB, and {there:.2} GB of memory are free for each rank \
             of a machine; take more machines or a coarser spacing, or --ignore-memory to start all \
             the same"
        )
    })
}

/// Ranks on this machine.
fn local_ranks(ranks: usize) -> usize {
    let names = ["OMPI_COMM_WORLD_LOCAL_SIZE", "MPI_LOCALNRANKS"];
    let found = names
        .iter()
        .find_map(|name| std::env::var(name).ok()?.parse().ok());
    found.unwrap_or(ranks).max(1)
}

/// Bytes that this process may still take: what the machine has to give, or its control group if
/// that is less. `root` is where `/proc` and `/sys` are.
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

/// What is left in the tightest control group above this process, of either version.
fn group(root: &Path) -> Option<u64> {
    let text = std::fs::read_to_string(root.join("proc/self/cgroup")).ok()?;
    let mut least = None;
    for line in text.lines() {
        let mut parts = line.splitn(3, ':').skip(1);
        let (controllers, path) = (parts.next()?, parts.next()?);
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

/// What is left in one control group; files that it holds in memory make room.
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
