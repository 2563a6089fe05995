//! The numbers behind the header of a grid's file.

use super::Volume;
use super::error::Fault;

/// How a number is written down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    /// An unsigned byte, 255 being density 1.
    U8,
    /// Single precision.
    F32 {
        /// Most significant byte first.
        big_endian: bool,
    },
    /// Double precision.
    F64 {
        /// Most significant byte first.
        big_endian: bool,
    },
}

/// What a header says about the numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Layout {
    pub size: [usize; 3],
    pub scalar: Scalar,
    /// Whether x runs fastest, or z.
    pub x_fastest: bool,
}

/// Most cells of a grid: 4 GiB of single precision.
const MAX_CELLS: usize = 1 << 30;

impl Scalar {
    fn bytes(self) -> usize {
        match self {
            Self::U8 => 1,
            Self::F32 { .. } => 4,
            Self::F64 { .. } => 8,
        }
    }

    fn read(self, bytes: &[u8]) -> f32 {
        let four = |b: &[u8]| <[u8; 4]>::try_from(b).unwrap_or_default();
        let eight = |b: &[u8]| <[u8; 8]>::try_from(b).unwrap_or_default();
        match self {
            Self::U8 => f32::from(bytes[0]) / 255.0,
            Self::F32 { big_endian: true } => f32::from_be_bytes(four(bytes)),
            Self::F32 { big_endian: false } => f32::from_le_bytes(four(bytes)),
            Self::F64 { big_endian: true } => f64::from_be_bytes(eight(bytes)) as f32,
            Self::F64 { big_endian: false } => f64::from_le_bytes(eight(bytes)) as f32,
        }
    }
}

impl Layout {
    /// The bytes that the numbers take.
    ///
    /// # Errors
    /// When an axis has no cells, or there are more cells than can be kept.
    pub fn bytes(&self) -> Result<usize, Fault> {
        let [x, y, z] = self.size;
        if self.size.contains(&0) {
            let problem = format!("the grid has {x} x {y} x {z} cells");
            return Err(Fault::Invalid(problem, "write at least one cell along each axis"));
        }
        let cells = self.size.iter().try_fold(1_usize, |product, &n| product.checked_mul(n));
        match cells.filter(|&cells| cells <= MAX_CELLS) {
            Some(cells) => Ok(cells * self.scalar.bytes()),
            None => {
                let problem = format!("the grid has {x} x {y} x {z} cells, more than {MAX_CELLS}");
                Err(Fault::Unsupported(problem, "write a coarser grid"))
            }
        }
    }

    /// The grid of these numbers.
    ///
    /// # Errors
    /// When there are more or fewer bytes than the header says, or a number is no density.
    pub fn volume(&self, bytes: &[u8]) -> Result<Volume, Fault> {
        let expected = self.bytes()?;
        let [x, y, z] = self.size;
        if bytes.len() != expected {
            let problem = format!(
                "{} bytes of data where {x} x {y} x {z} cells of {} bytes take {expected}",
                bytes.len(),
                self.scalar.bytes()
            );
            return Err(Fault::Malformed(
                problem,
                "the file is truncated or its header wrong; write it again",
            ));
        }
        let width = self.scalar.bytes();
        let number = |i: usize| self.scalar.read(&bytes[i * width..(i + 1) * width]);
        let mut values = Vec::with_capacity(x * y * z);
        for k in 0..z {
            for j in 0..y {
                for i in 0..x {
                    let at = if self.x_fastest { (k * y + j) * x + i } else { (i * y + j) * z + k };
                    let value = number(at);
                    if !(value.is_finite() && value >= 0.0) {
                        let problem =
                            format!("the value of cell ({i}, {j}, {k}) is {value:e} in single precision");
                        let cure = "relative densities are finite and not negative: repair the grid";
                        return Err(Fault::Invalid(problem, cure));
                    }
                    values.push(value);
                }
            }
        }
        Ok(Volume { size: self.size, values })
    }
}
