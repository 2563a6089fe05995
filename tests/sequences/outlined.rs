//! Triangles of the level of the water whose edges follow the outlines of the ice.
//!
//! Right triangles are bisected where they are too large, and their neighbours with them, so that no vertex lies on
//! another's edge. Then vertices beside an outline are moved onto it, and edges that still cross it are cut.

use std::collections::{HashMap, HashSet};

use super::ice_cover::{Body, HALF, Point, within_ice};

/// Edges of the finest cells along an edge of the square.
const CELLS: i32 = 512;
/// The edge of the finest cells: a sixth of the shortest wave.
const FINEST: f64 = 2.0 * HALF / CELLS as f64;
/// Blocks that bisection begins with, in halves of cells.
const BLOCK: i32 = 32;
/// What is seen sharply: within so many metres of a point.
const SHARP: (Point, f64) = ([0.3, -1.5], 4.5);
/// Vertices are moved to an outline over at most this share of their shortest edge, which turns no triangle over.
const MOVED: f64 = 0.3;

/// Triangles of the level; `within` is 0 at vertices on an outline, positive in ice.
pub struct Outlined {
    pub at: Vec<Point>,
    pub within: Vec<f64>,
    pub triangles: Vec<[usize; 3]>,
}

/// A point in halves of cells from a corner of the square.
type Half = [i32; 2];
type Edge<T> = (T, T);

fn place(h: Half) -> Point {
    h.map(|c| f64::from(c) * FINEST * 0.5 - HALF)
}

fn edge<T: PartialOrd>(a: T, b: T) -> Edge<T> {
    if a < b { (a, b) } else { (b, a) }
}

fn apart(a: Point, b: Point) -> f64 {
    libm::hypot(a[0] - b[0], a[1] - b[1])
}

/// The edge that triangles at a point should have: fine at water and outlines and on the berg, coarse far away.
fn wanted(p: Point) -> f64 {
    let (within, body) = within_ice(p);
    let fine = match body {
        Body::Cover if within >= 0.2 => (FINEST + 0.8 * (within - 0.2)).min(0.5),
        _ => FINEST,
    };
    fine * (1.0 + 0.7 * (apart(p, SHARP.0) - SHARP.1).max(0.0))
}

fn middle(a: Half, b: Half) -> Half {
    [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2]
}

fn blocks() -> Vec<[Half; 3]> {
    let starts = || (0..2 * CELLS).step_by(BLOCK as usize);
    let corners = |i, j| [[i, j], [i + BLOCK, j], [i + BLOCK, j + BLOCK], [i, j + BLOCK]];
    let quarters = |(i, j)| {
        let (q, centre) = (corners(i, j), [i + BLOCK / 2, j + BLOCK / 2]);
        [0, 1, 2, 3].map(|k| [q[k], q[(k + 1) % 4], centre])
    };
    starts().flat_map(|i| starts().map(move |j| (i, j))).flat_map(quarters).collect()
}

/// The longest edge, which is bisected, is the first of a triangle.
fn too_large(t: &[Half; 3]) -> bool {
    let [a, b, c] = t.map(place);
    let m = place(middle(t[0], t[1]));
    let centroid = [0, 1].map(|k| (2.0 * m[k] + c[k]) / 3.0);
    let least = [a, b, c, m, centroid].map(wanted).into_iter().fold(f64::INFINITY, f64::min);
    let divisible = (t[0][0] - t[1][0]).abs().max((t[0][1] - t[1][1]).abs()) > 1;
    divisible && apart(a, b) > 1.45 * least
}

/// Whoever has a marked edge has to bisect its own longest one before.
fn spread(triangles: &[[Half; 3]], marked: &mut HashSet<Edge<Half>>) {
    let mut before = 0;
    while marked.len() > before {
        before = marked.len();
        for t in triangles {
            if marked.contains(&edge(t[1], t[2])) || marked.contains(&edge(t[2], t[0])) {
                marked.insert(edge(t[0], t[1]));
            }
        }
    }
}

fn bisected() -> Vec<[Half; 3]> {
    let mut all = blocks();
    loop {
        let mut marked: HashSet<_> = all.iter().filter(|t| too_large(t)).map(|t| edge(t[0], t[1])).collect();
        if marked.is_empty() {
            return all;
        }
        spread(&all, &mut marked);
        let mut next = Vec::new();
        while let Some(t) = all.pop() {
            if marked.contains(&edge(t[0], t[1])) {
                let m = middle(t[0], t[1]);
                all.extend([[t[1], t[2], m], [t[2], t[0], m]]);
            } else {
                next.push(t);
            }
        }
        all = next;
    }
}

/// Newton's steps towards the outline.
fn onto_outline(mut p: Point) -> Point {
    const STEP: f64 = 1e-4;
    for _ in 0..3 {
        let slope = |dx, dy| {
            let at = |s: f64| within_ice([p[0] + s * dx, p[1] + s * dy]).0;
            (at(1.0) - at(-1.0)) / (2.0 * STEP)
        };
        let (d, g) = (within_ice(p).0, [slope(STEP, 0.0), slope(0.0, STEP)]);
        let square = (g[0] * g[0] + g[1] * g[1]).max(1e-3);
        p = [p[0] - d * g[0] / square, p[1] - d * g[1] / square];
    }
    p
}

/// Moves vertices beside an outline onto it.
fn pull(mesh: &mut Outlined) {
    let mut shortest = vec![f64::INFINITY; mesh.at.len()];
    for t in &mesh.triangles {
        for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            let length = apart(mesh.at[a], mesh.at[b]);
            shortest[a] = shortest[a].min(length);
            shortest[b] = shortest[b].min(length);
        }
    }
    for (v, shortest) in shortest.into_iter().enumerate() {
        let p = onto_outline(mesh.at[v]);
        if apart(p, mesh.at[v]) < MOVED * shortest && within_ice(p).0.abs() < 1e-4 {
            (mesh.at[v], mesh.within[v]) = (p, 0.0);
        }
    }
}

/// The point of an edge that is on the outline.
fn crossing(a: Point, b: Point, within_a: f64) -> Point {
    let point = |s: f64| [a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])];
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..40 {
        let s = 0.5 * (low + high);
        if within_ice(point(s)).0 * within_a > 0.0 { low = s } else { high = s }
    }
    point(low)
}

/// Cuts triangles at the edges that cross an outline.
fn cut(mesh: &mut Outlined) {
    let mut cuts: HashMap<Edge<usize>, usize> = HashMap::new();
    for t in std::mem::take(&mut mesh.triangles) {
        let mut cut_edges = Vec::new();
        for k in 0..3 {
            let (a, b) = edge(t[k], t[(k + 1) % 3]);
            if mesh.within[a] * mesh.within[b] < 0.0 {
                let v = *cuts.entry((a, b)).or_insert_with(|| {
                    mesh.at.push(crossing(mesh.at[a], mesh.at[b], mesh.within[a]));
                    mesh.within.push(0.0);
                    mesh.at.len() - 1
                });
                cut_edges.push((k, v));
            }
        }
        let from = |k: usize| [t[k], t[(k + 1) % 3], t[(k + 2) % 3]];
        match cut_edges[..] {
            [(k, v)] => {
                let [a, b, c] = from(k);
                mesh.triangles.extend([[a, v, c], [v, b, c]]);
            }
            [(k, v), (l, w)] => {
                // The first vertex of the later of the two edges, going round, lies between them.
                let (corner, v, w) = if (k + 1) % 3 == l { (l, v, w) } else { (k, w, v) };
                let [a, b, c] = from(corner);
                mesh.triangles.extend([[v, a, w], [v, w, b], [v, b, c]]);
            }
            _ => mesh.triangles.push(t),
        }
    }
}

/// The level of the water, in triangles that are either of ice or of water.
pub fn outlined() -> Outlined {
    let mut index: HashMap<Half, usize> = HashMap::new();
    let mut at = Vec::new();
    let mut number = |h: Half| {
        *index.entry(h).or_insert_with(|| {
            at.push(place(h));
            at.len() - 1
        })
    };
    let triangles = bisected().into_iter().map(|t| t.map(&mut number)).collect();
    let within = at.iter().map(|&p| within_ice(p).0).collect();
    let mut mesh = Outlined { at, within, triangles };
    pull(&mut mesh);
    cut(&mut mesh);
    mesh
}
