//! Ten million triangles on a machine of 24 GiB: a process of its own, since the peak is that of the whole process.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod small;

use std::fs::{self, File};
use std::io::{BufWriter, Write};

use floe::driver::{RenderOptions, Status};
use small::{Folder, scene};

/// Squares around the ring and around its tube: ten million triangles, five million vertices.
const AROUND: [u32; 2] = [2500, 2000];

/// Most memory that the process may take, in bytes.
const MOST_MEMORY: u64 = 4 << 30;

/// Peak of the resident memory in bytes; `None` where the system does not say.
fn peak() -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    line.split_whitespace().nth(1)?.parse::<u64>().ok().map(|kib| kib * 1024)
}

/// A closed ring of water with waves all over it, written vertex by vertex.
fn write_ring(file: File) -> std::io::Result<()> {
    let [n, m] = AROUND;
    let mut out = BufWriter::new(file);
    write!(out, "ply\nformat binary_little_endian 1.0\nelement vertex {}\n", n * m)?;
    for name in ["x", "y", "z"] {
        writeln!(out, "property float {name}")?;
    }
    write!(out, "element face {}\nproperty list uchar int vertex_indices\n", 2 * n * m)?;
    write!(out, "property uchar label_front\nproperty uchar label_back\nend_header\n")?;
    let turn = |i: u32, of: u32| std::f32::consts::TAU * i as f32 / of as f32;
    for i in 0..n {
        for j in 0..m {
            let (u, v) = (turn(i, n), turn(j, m));
            let tube =
                0.3 + 0.01 * (29.0 * u).sin() * (13.0 * v).cos() + 0.002 * (211.0 * u + 97.0 * v).sin();
            let ring = 0.6 + tube * v.cos();
            for c in [ring * u.cos(), ring * u.sin(), tube * v.sin()] {
                out.write_all(&c.to_le_bytes())?;
            }
        }
    }
    for i in 0..n {
        for j in 0..m {
            let vertex = |i: u32, j: u32| (i % n) * m + j % m;
            let [a, b, c, d] = [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
            for triangle in [[a, b, c], [a, c, d]] {
                out.write_all(&[3])?;
                triangle.iter().try_for_each(|v| out.write_all(&v.to_le_bytes()))?;
                out.write_all(&[0, 1])?;
            }
        }
    }
    out.flush()
}

/// `cargo test --release --test scale -- --ignored --nocapture`
#[test]
#[ignore = "takes half a minute and three gigabytes"]
fn ten_million_triangles_are_read_built_and_rendered() {
    let folder = Folder::with_scene(&scene("[render]\nsamples = 8192\n"));
    fs::create_dir_all(folder.path("frames")).unwrap();
    write_ring(File::create(folder.path("frames/frame_0001.ply")).unwrap()).unwrap();
    let report = folder.render(RenderOptions::default());
    assert!(report.failures.is_empty(), "{:?}", report.failures);
    let frame = &report.frames[0];
    assert_eq!((frame.status, frame.triangles), (Status::Complete, 10_000_000));
    assert!(frame.warnings.is_empty(), "{:?}", frame.warnings);
    assert_eq!(frame.counters.non_finite, 0);
    assert!(
        frame.counters.rays > frame.samples + frame.samples / 10,
        "the ring is in view: {:?}",
        frame.counters
    );
    let line = &folder.ledger("out/ledger.jsonl")[0];
    assert_eq!(line["accel_bytes"], frame.accel_bytes);
    println!(
        "read {:.1} s, built {:.1} s, rendered {:.2} s; hierarchy {:.1} bytes a triangle",
        frame.read_seconds, frame.build_seconds, frame.render_seconds, frame.accel_bytes_per_triangle
    );
    println!("{} mismatches at {} rays", frame.counters.label_mismatches, frame.counters.rays);
    let Some(peak) = peak() else { return println!("no /proc/self/status: no peak to check") };
    println!("peak {:.2} GiB, {:.0} bytes a triangle", peak as f64 / f64::from(1 << 30), peak as f64 / 1e7);
    assert!(peak < MOST_MEMORY, "{peak} bytes");
}
