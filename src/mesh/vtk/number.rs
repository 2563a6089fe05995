//! Numbers of every type in either byte order.

/// Which byte of a number comes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ByteOrder {
    Little,
    Big,
}

/// How a number is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NumberType {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

impl NumberType {
    /// The type of a name in a legacy file, in whatever case. `vtkIdType` is written as 32 bits.
    pub fn of_legacy(name: &str) -> Option<Self> {
        Some(match name.to_ascii_lowercase().as_str() {
            "char" | "signed_char" => Self::I8,
            "unsigned_char" => Self::U8,
            "short" => Self::I16,
            "unsigned_short" => Self::U16,
            "int" | "vtkidtype" => Self::I32,
            "unsigned_int" => Self::U32,
            "long" | "long_long" | "vtktypeint64" => Self::I64,
            "unsigned_long" | "unsigned_long_long" | "vtktypeuint64" => Self::U64,
            "float" => Self::F32,
            "double" => Self::F64,
            _ => return None,
        })
    }

    /// The type of a name in an XML file.
    pub fn of_xml(name: &str) -> Option<Self> {
        Some(match name {
            "Int8" => Self::I8,
            "UInt8" => Self::U8,
            "Int16" => Self::I16,
            "UInt16" => Self::U16,
            "Int32" => Self::I32,
            "UInt32" => Self::U32,
            "Int64" => Self::I64,
            "UInt64" => Self::U64,
            "Float32" => Self::F32,
            "Float64" => Self::F64,
            _ => return None,
        })
    }

    /// Bytes of a number.
    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// The numbers in bytes. Whole ones beyond 2^53 are rounded; they are no index and no label anyway.
    pub fn read(self, bytes: &[u8], order: ByteOrder) -> Vec<f64> {
        macro_rules! numbers {
            ($number:ty) => {{
                let (numbers, _) = bytes.as_chunks::<{ size_of::<$number>() }>();
                match order {
                    ByteOrder::Little => {
                        numbers.iter().map(|b| <$number>::from_le_bytes(*b) as f64).collect()
                    }
                    ByteOrder::Big => numbers.iter().map(|b| <$number>::from_be_bytes(*b) as f64).collect(),
                }
            }};
        }
        match self {
            Self::I8 => numbers!(i8),
            Self::U8 => numbers!(u8),
            Self::I16 => numbers!(i16),
            Self::U16 => numbers!(u16),
            Self::I32 => numbers!(i32),
            Self::U32 => numbers!(u32),
            Self::I64 => numbers!(i64),
            Self::U64 => numbers!(u64),
            Self::F32 => numbers!(f32),
            Self::F64 => numbers!(f64),
        }
    }
}

/// A whole number without sign, of at most eight bytes.
pub(super) fn unsigned(bytes: &[u8], order: ByteOrder) -> u64 {
    let join = |bits: u64, &byte: &u8| bits << 8 | u64::from(byte);
    match order {
        ByteOrder::Big => bytes.iter().fold(0, join),
        ByteOrder::Little => bytes.iter().rev().fold(0, join),
    }
}

/// A number that is whole, as such; `None` for a fraction and beyond 2^53.
pub(super) fn whole(value: f64) -> Option<i64> {
    (value.abs() <= (1_u64 << 53) as f64 && value as i64 as f64 == value).then_some(value as i64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_type_is_read_in_both_byte_orders() {
        for (number_type, little, expected) in [
            (NumberType::I8, &[0xfe][..], -2.0),
            (NumberType::U8, &[0xfe], 254.0),
            (NumberType::I16, &[0xfe, 0xff], -2.0),
            (NumberType::U16, &[0x01, 0xff], 65281.0),
            (NumberType::I32, &[0xfe, 0xff, 0xff, 0xff], -2.0),
            (NumberType::U32, &[0xfe, 0xff, 0xff, 0xff], 4294967294.0),
            (NumberType::I64, &[0xfe, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff], -2.0),
            (NumberType::U64, &[0x02, 1, 0, 0, 0, 0, 0, 0], 258.0),
            (NumberType::F32, &0.1_f32.to_le_bytes(), f64::from(0.1_f32)),
            (NumberType::F64, &0.1_f64.to_le_bytes(), 0.1),
        ] {
            assert_eq!(number_type.size(), little.len());
            let big: Vec<u8> = little.iter().rev().copied().collect();
            assert_eq!(number_type.read(little, ByteOrder::Little), [expected]);
            assert_eq!(number_type.read(&big, ByteOrder::Big), [expected]);
        }
    }

    #[test]
    fn fractions_and_what_is_no_number_are_not_whole() {
        assert_eq!([-3.0, 0.0, 9007199254740992.0].map(whole), [Some(-3), Some(0), Some(1 << 53)]);
        assert_eq!([0.5, f64::NAN, f64::INFINITY, 1e300].map(whole), [None; 4]);
    }
}
