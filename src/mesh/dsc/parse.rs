//! The text of a `.dsc` file.

use glam::DVec3;

use super::Complex;
use crate::mesh::Region;
use crate::mesh::error::{Fault, Place, excerpt};
use crate::mesh::words::Words;

/// The label of the shell around the domain.
const SHELL: i32 = 999;

const CURE: &str = "a file has records 'v x y z' and 't i0 i1 i2 i3 label'; write it again";

/// Most tetrahedra: their faces are numbered with 32 bits.
const MAX_TETRAHEDRA: usize = (u32::MAX / 4) as usize;

/// Reads the vertices and tetrahedra of a file.
pub(super) fn parse(bytes: &[u8]) -> Result<Complex, Fault> {
    let mut complex = Complex::default();
    let mut words = Words::new(bytes, CURE);
    while let Some(word) = words.next() {
        match word {
            b"v" => complex.positions.push(vertex(&mut words)?),
            b"t" => {
                let (tetrahedron, label) = tetrahedron(&mut words)?;
                complex.tetrahedra.push(tetrahedron);
                complex.labels.push(label);
            }
            _ => {
                let problem = format!("'{}' where a record begins", excerpt(word));
                return Err(Fault::malformed(words.place(), problem, CURE));
            }
        }
    }
    drop_repeated_last(&mut complex);
    check_indices(&complex, bytes)?;
    Ok(complex)
}

/// The line on which tetrahedron `index` begins.
pub(super) fn line_of_tetrahedron(bytes: &[u8], index: usize) -> usize {
    let mut words = Words::new(bytes, CURE);
    let mut left = index;
    while let Some(word) = words.next() {
        if word == b"t" {
            if left == 0 {
                break;
            }
            left -= 1;
        }
    }
    words.line()
}

fn vertex(words: &mut Words) -> Result<DVec3, Fault> {
    Ok(DVec3::new(words.coordinate()?, words.coordinate()?, words.coordinate()?))
}

fn tetrahedron(words: &mut Words) -> Result<([u32; 4], i32), Fault> {
    let mut indices = [0; 4];
    for index in &mut indices {
        let value = words.integer("a vertex index")?;
        *index = u32::try_from(value).map_err(|_| {
            let problem = format!("vertex index {value}");
            Fault::invalid(words.place(), problem, "indices count from 0 and have 32 bits")
        })?;
    }
    let value = words.integer("a label")?;
    let label = i32::try_from(value).map_err(|_| {
        let problem = format!("label {value} does not fit in 32 bits with a sign");
        Fault::invalid(words.place(), problem, "use labels up to 2147483647")
    })?;
    Ok((indices, if label == SHELL { Region::OUTSIDE.0 } else { label }))
}

fn drop_repeated_last(complex: &mut Complex) {
    if let [.., before, last] = complex.tetrahedra[..]
        && let [.., label_before, label_last] = complex.labels[..]
        && (before, label_before) == (last, label_last)
    {
        complex.tetrahedra.pop();
        complex.labels.pop();
    }
}

fn check_indices(complex: &Complex, bytes: &[u8]) -> Result<(), Fault> {
    let count = complex.positions.len();
    if complex.tetrahedra.len() > MAX_TETRAHEDRA {
        let problem = format!("more than {MAX_TETRAHEDRA} tetrahedra");
        return Err(Fault::too_large(Place::File, problem, "split the mesh into several files"));
    }
    let place = |t| Place::Line(line_of_tetrahedron(bytes, t));
    for (t, tetrahedron) in complex.tetrahedra.iter().enumerate() {
        if let Some(index) = tetrahedron.iter().find(|&&index| index as usize >= count) {
            let problem = format!("vertex index {index}, but the file has {count} vertices");
            return Err(Fault::invalid(
                place(t),
                problem,
                "the file is truncated or its indices do not count from 0",
            ));
        }
        let [a, b, c, d] = *tetrahedron;
        if a == b || a == c || a == d || b == c || b == d || c == d {
            let problem = format!("tetrahedron {a} {b} {c} {d} uses a vertex twice");
            return Err(Fault::invalid(place(t), problem, "leave such tetrahedra out"));
        }
    }
    Ok(())
}
