//! The orientation of triangles: alike along all edges, outwards in outer shells and inwards in
//! cavities.

use std::cell::OnceCell;
use std::collections::BTreeMap;

use super::closed::{MeshError, edges, location};
use super::mesh::Mesh;
use super::soup::{Soup, normal_area, number, undirected};
use super::tree::Tree;
use numerics::vector::{cross, dot, minus};

/// Depth below a face, over the size of all, where a place is within the solid.
const DEPTH: f64 = 1e-5;
/// Shells that may lie around one place.
const MOST_AROUND: usize = 64;

/// Turns triangles so that all run alike along their edges, as most of each piece do. Gives how many
/// were turned.
///
/// # Errors
/// If more than two triangles meet in an edge, or a piece has one side only.
pub(super) fn align(soup: &mut Soup) -> Result<usize, MeshError> {
    let mut meeting: BTreeMap<(u32, u32), Vec<u32>> = BTreeMap::new();
    for (n, t) in (0..).zip(&soup.triangles) {
        for k in 0..3 {
            let edge = undirected(t[k], t[(k + 1) % 3]);
            meeting.entry(edge).or_default().push(n);
        }
    }
    let tangled = |corner: u32| MeshError::Tangled {
        location: location(&soup.corners[corner as usize]),
    };
    if let Some(((corner, _), _)) = meeting.iter().find(|(_, all)| all.len() > 2) {
        return Err(tangled(*corner));
    }
    let runs = |t: &[u32; 3], a: u32, b: u32| (0..3).any(|k| t[k] == a && t[(k + 1) % 3] == b);
    let mut turned: Vec<Option<bool>> = vec![None; soup.triangles.len()];
    let mut count = 0;
    for first in 0..soup.triangles.len() {
        if turned[first].is_some() {
            continue;
        }
        turned[first] = Some(false);
        let (mut piece, mut done) = (vec![number(first)], 0);
        while let Some(&n) = piece.get(done) {
            done += 1;
            let t = soup.triangles[n as usize];
            let is_turned = turned[n as usize] == Some(true);
            for k in 0..3 {
                let (a, b) = (t[k], t[(k + 1) % 3]);
                for &other in meeting[&undirected(a, b)].iter().filter(|&&o| o != n) {
                    let alike = runs(&soup.triangles[other as usize], b, a);
                    let wanted = is_turned == alike;
                    match turned[other as usize] {
                        None => {
                            turned[other as usize] = Some(wanted);
                            piece.push(other);
                        }
                        Some(it) if it != wanted => return Err(tangled(a)),
                        Some(_) => {}
                    }
                }
            }
        }
        let of_piece = piece.iter().filter(|&&n| turned[n as usize] == Some(true));
        let of_piece = of_piece.count();
        let most = 2 * of_piece > piece.len();
        count += if most {
            piece.len() - of_piece
        } else {
            of_piece
        };
        for n in piece {
            let n = n as usize;
            if (turned[n] == Some(true)) != most {
                soup.triangles[n].swap(1, 2);
            }
        }
    }
    Ok(count)
}

/// One connected piece of a closed surface.
pub(super) struct Shell {
    triangles: Vec<u32>,
    /// Negative where normals point into it.
    volume: f64,
    lower: [f64; 3],
    upper: [f64; 3],
    /// Itself, once it is asked for distances.
    mesh: OnceCell<Mesh>,
}

impl Shell {
    /// True of a place that is deeper within it than `depth` (m).
    fn holds(&self, soup: &Soup, x: &[f64; 3], depth: f64) -> bool {
        let mesh = self.mesh.get_or_init(|| {
            let (mut corners, mut numbers) = (Vec::new(), BTreeMap::new());
            let own = self.triangles.iter().map(|&n| soup.triangles[n as usize]);
            let own = own.map(|t| {
                t.map(|c| {
                    *numbers.entry(c).or_insert_with(|| {
                        corners.push(soup.corners[c as usize]);
                        number(corners.len() - 1)
                    })
                })
            });
            let own = own.collect();
            Mesh::closed(corners, own)
        });
        mesh.distance(x) * self.volume.signum() < -depth
    }
}

/// The shells whose boxes hold a place.
///
/// # Errors
/// If there are too many of them.
fn around(shells: &[Shell], tree: &Tree, x: &[f64; 3]) -> Result<Vec<usize>, MeshError> {
    let mut found = Vec::new();
    tree.near(x, 0.0, |n| {
        let Shell { lower, upper, .. } = &shells[n as usize];
        if (0..3).all(|k| lower[k] <= x[k] && x[k] <= upper[k]) {
            found.push(n as usize);
        }
        // More are not looked for.
        if found.len() > MOST_AROUND { -1.0 } else { 0.0 }
    });
    if found.len() > MOST_AROUND {
        return Err(MeshError::Nested {
            most: MOST_AROUND,
            location: location(x),
        });
    }
    Ok(found)
}

/// Turns the shells of a closed surface so that normals point out of the solid: outwards from those
/// within no other or in a cavity, inwards from cavities. Returns them, and the number of turned
/// ones, if not all.
///
/// # Errors
/// If a shell encloses nothing, or lies within too many.
pub(super) fn nest(soup: &mut Soup) -> Result<(Vec<Shell>, usize), MeshError> {
    let mut shells = shells(soup);
    let is_some = |volume: f64| volume.is_finite() && volume != 0.0;
    if !shells.iter().all(|shell| is_some(shell.volume)) {
        return Err(MeshError::NoVolume);
    }
    if let [shell] = &shells[..] {
        if shell.volume < 0.0 {
            turn(soup, &mut shells[0]);
        }
        return Ok((shells, 0));
    }
    let tree = tree(&shells);
    let wrong: Result<Vec<bool>, MeshError> = (0..shells.len())
        .map(|n| {
            let inside = depth(soup, &shells, &tree, n)? % 2 == 1;
            Ok((shells[n].volume < 0.0) != inside)
        })
        .collect();
    let wrong = wrong?;
    for (shell, _) in shells.iter_mut().zip(&wrong).filter(|(_, wrong)| **wrong) {
        turn(soup, shell);
    }
    let turned = wrong.iter().filter(|wrong| **wrong).count();
    let turned = if turned == shells.len() { 0 } else { turned };
    Ok((shells, turned))
}

fn turn(soup: &mut Soup, shell: &mut Shell) {
    for &n in &shell.triangles {
        soup.triangles[n as usize].swap(1, 2);
    }
    shell.volume = -shell.volume;
    shell.mesh.take();
}

fn tree(shells: &[Shell]) -> Tree {
    let boxes: Vec<_> = shells.iter().map(|s| (s.lower, s.upper)).collect();
    Tree::new(&boxes)
}

/// Checks that shells, turned as they nest, do not overlap: the places right below the middles of all
/// triangles must be within the solid once. Flat parts that touch do not overlap.
///
/// # Errors
/// If they do.
pub(super) fn check_apart(soup: &Soup, shells: &[Shell]) -> Result<(), MeshError> {
    if shells.len() < 2 {
        return Ok(());
    }
    let (tree, below) = (tree(shells), DEPTH * soup.size());
    for &n in shells.iter().flat_map(|shell| &shell.triangles) {
        let t = &soup.triangles[n as usize];
        let normal = normal_area(&soup.at(t));
        let length = dot(&normal, &normal).sqrt();
        let middle = middle(soup, n);
        let x: [f64; 3] = std::array::from_fn(|a| middle[a] - below / length * normal[a]);
        let around = around(shells, &tree, &x)?;
        if around.len() < 2 {
            continue;
        }
        let holding = around.iter().map(|&n| &shells[n]);
        let holding = holding.filter(|shell| shell.holds(soup, &x, 0.5 * below));
        let times = holding.fold(0.0, |sum, shell| sum + shell.volume.signum());
        if times > 1.0 {
            let location = location(&middle);
            return Err(MeshError::Overlap { location });
        }
    }
    Ok(())
}

/// The middle of a triangle (m).
fn middle(soup: &Soup, n: u32) -> [f64; 3] {
    let [a, b, c] = soup.at(&soup.triangles[n as usize]);
    std::array::from_fn(|k| (a[k] + b[k] + c[k]) / 3.0)
}

fn shells(soup: &Soup) -> Vec<Shell> {
    let edges = edges(&soup.triangles);
    let mut reached = vec![false; soup.triangles.len()];
    let mut shells = Vec::new();
    for first in 0..soup.triangles.len() {
        if reached[first] {
            continue;
        }
        reached[first] = true;
        let mut shell = Shell {
            triangles: vec![number(first)],
            volume: 0.0,
            lower: [f64::INFINITY; 3],
            upper: [f64::NEG_INFINITY; 3],
            mesh: OnceCell::new(),
        };
        let mut done = 0;
        while let Some(&n) = shell.triangles.get(done) {
            done += 1;
            let t = soup.triangles[n as usize];
            for k in 0..3 {
                let other = edges[&(t[(k + 1) % 3], t[k])];
                if !reached[other as usize] {
                    reached[other as usize] = true;
                    shell.triangles.push(other);
                }
            }
            for x in soup.at(&t) {
                for a in 0..3 {
                    shell.lower[a] = shell.lower[a].min(x[a]);
                    shell.upper[a] = shell.upper[a].max(x[a]);
                }
            }
        }
        let from = shell.lower;
        shell.volume = (shell.triangles.iter())
            .map(|&n| {
                let [a, b, c] = soup
                    .at(&soup.triangles[n as usize])
                    .map(|x| minus(&x, &from));
                dot(&a, &cross(&b, &c)) / 6.0
            })
            .fold(0.0, |sum, part| sum + part);
        shells.push(shell);
    }
    shells
}

/// Within how many others a shell lies.
fn depth(soup: &Soup, shells: &[Shell], tree: &Tree, n: usize) -> Result<usize, MeshError> {
    let x = middle(soup, shells[n].triangles[0]);
    let least = DEPTH * DEPTH * soup.size();
    let holds = |&other: &usize| {
        let (a, b) = (&shells[n], &shells[other]);
        let wider = (0..3).all(|k| b.lower[k] <= a.lower[k] && a.upper[k] <= b.upper[k]);
        other != n && wider && b.holds(soup, &x, least)
    };
    Ok(around(shells, tree, &x)?.into_iter().filter(holds).count())
}

/// Removes triangles that occur twice: of those that run alike one is kept, those that run against
/// each other cancel out, as where two solids share a face. Returns the number of removed ones.
pub(super) fn drop_doubles(soup: &mut Soup) -> usize {
    let before = soup.triangles.len();
    let key = |t: &[u32; 3]| {
        let mut sorted = *t;
        sorted.sort_unstable();
        let first = t.iter().position(|&c| c == sorted[0]).unwrap_or(0);
        (sorted, t[(first + 1) % 3] == sorted[1])
    };
    let mut copies: BTreeMap<[u32; 3], [u32; 2]> = BTreeMap::new();
    for t in &soup.triangles {
        let (sorted, forward) = key(t);
        copies.entry(sorted).or_default()[usize::from(forward)] += 1;
    }
    soup.triangles.retain(|t| {
        let (sorted, forward) = key(t);
        let Some(counts) = copies.get_mut(&sorted) else {
            return false;
        };
        let [own, other] = [usize::from(forward), usize::from(!forward)];
        let is_kept = counts[own] > counts[other];
        if is_kept {
            // One of them stays.
            copies.remove(&sorted);
        }
        is_kept
    });
    before - soup.triangles.len()
}

/// Replaces triangles whose corners lie on a line by a swap of their longest edge, which changes no
/// place of the surface. Returns their number.
pub(super) fn swap_flat(soup: &mut Soup, rounding: f64) -> usize {
    let mut edges = edges(&soup.triangles);
    let longest = |soup: &Soup, t: &[u32; 3]| {
        let x = soup.at(t);
        let squares: [f64; 3] = std::array::from_fn(|k| {
            let r = minus(&x[(k + 1) % 3], &x[k]);
            dot(&r, &r)
        });
        let k = (1..3).fold(
            0,
            |best, k| if squares[k] > squares[best] { k } else { best },
        );
        let area = normal_area(&x);
        let is_flat = dot(&area, &area) <= rounding * rounding * squares[k];
        is_flat.then_some(k)
    };
    let flat = |n: &usize| longest(soup, &soup.triangles[*n]).is_some();
    let mut open: Vec<usize> = (0..soup.triangles.len()).filter(flat).collect();
    let flat_ones = open.len();
    // Each swap may leave another flat triangle, along a line of many corners.
    let mut swaps = 100 * flat_ones;
    while let (Some(n), true) = (open.pop(), swaps > 0) {
        swaps -= 1;
        let t = soup.triangles[n];
        let Some(k) = longest(soup, &t) else { continue };
        let (p, q, o) = (t[k], t[(k + 1) % 3], t[(k + 2) % 3]);
        let Some(&m) = edges.get(&(q, p)) else {
            continue;
        };
        let u = soup.triangles[m as usize];
        let Some(&d) = u.iter().find(|&&c| c != p && c != q) else {
            continue;
        };
        if d == o || edges.contains_key(&(o, d)) || edges.contains_key(&(d, o)) {
            continue;
        }
        edges.remove(&(p, q));
        edges.remove(&(q, p));
        for (index, new) in [(n, [o, p, d]), (m as usize, [d, q, o])] {
            soup.triangles[index] = new;
            for k in 0..3 {
                edges.insert((new[k], new[(k + 1) % 3]), number(index));
            }
            open.push(index);
        }
    }
    flat_ones
}
