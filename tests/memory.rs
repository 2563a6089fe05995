//! What reading takes of memory: a process of its own, since the peak is that of the whole process.

use std::fs::{self, File};
use std::io::{BufWriter, Write};

/// Peak of the resident memory in bytes; `None` where the system does not say.
fn peak() -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    line.split_whitespace().nth(1)?.parse::<u64>().ok().map(|kib| kib * 1024)
}

/// A wavy sheet of 2 n^2 labelled triangles.
fn write_sheet(file: File, n: u32) -> std::io::Result<()> {
    let mut out = BufWriter::new(file);
    let vertices = (n + 1) * (n + 1);
    write!(out, "ply\nformat binary_little_endian 1.0\nelement vertex {vertices}\n")?;
    for name in ["x", "y", "z"] {
        writeln!(out, "property float {name}")?;
    }
    write!(out, "element face {}\nproperty list uchar int vertex_indices\n", 2 * n * n)?;
    write!(out, "property uchar label_front\nproperty uchar label_back\nend_header\n")?;
    for i in 0..vertices {
        let (x, y) = ((i % (n + 1)) as f32, (i / (n + 1)) as f32);
        for c in [x, y, (0.1 * x).sin() + (0.13 * y).cos()] {
            out.write_all(&c.to_le_bytes())?;
        }
    }
    for j in 0..n {
        for i in 0..n {
            let a = j * (n + 1) + i;
            for triangle in [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]] {
                out.write_all(&[3])?;
                triangle.iter().try_for_each(|v| out.write_all(&v.to_le_bytes()))?;
                out.write_all(&[0, 1])?;
            }
        }
    }
    out.flush()
}

#[test]
fn reading_takes_less_than_three_times_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sheet.ply");
    write_sheet(File::create(&path).unwrap(), 700).unwrap();
    let size = fs::metadata(&path).unwrap().len();
    let Some(before) = peak() else { return println!("no /proc/self/status: nothing to measure") };
    let mesh = floe::mesh::read(&path).unwrap();
    let taken = peak().unwrap_or(before) - before;
    assert_eq!(mesh.triangles.len(), 2 * 700 * 700);
    println!("{:.2} times the {size} bytes of the file", taken as f64 / size as f64);
    assert!(taken > size, "{taken} bytes cannot hold the mesh: the measurement is wrong");
    assert!(taken < 3 * size, "{taken} bytes for a file of {size}");
}
