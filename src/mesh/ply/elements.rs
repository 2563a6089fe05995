//! The records that the general PLY reader fills, one at a time.

use glam::{DVec3, Vec3};
use ply_rs::ply::{PropertyAccess, PropertyAccessResult};

use super::header::VELOCITY;

/// Implements the setter of every scalar type by one function that takes the wider `$wide`.
macro_rules! scalar_setters {
    ($wide:ty: $($setter:ident($narrow:ty)),*) => {$(
        fn $setter(&mut self, name: &str, value: $narrow) -> PropertyAccessResult {
            self.set(name, <$wide>::from(value))
        }
    )*};
}

/// Implements the setter of every integer list type by widening its entries.
macro_rules! list_setters {
    ($($setter:ident($narrow:ty)),*) => {$(
        fn $setter(&mut self, name: &str, values: Vec<$narrow>) -> PropertyAccessResult {
            if !matches!(name, "vertex_indices" | "vertex_index") {
                return PropertyAccessResult::Ignored;
            }
            self.indices = values.into_iter().map(i64::from).collect();
            PropertyAccessResult::Set
        }
    )*};
}

/// An element `vertex`.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct VertexRecord {
    /// `x y z`.
    pub position: DVec3,
    /// `nx ny nz`.
    pub normal: Vec3,
    /// Units per second.
    pub velocity: Vec3,
}

impl VertexRecord {
    fn set(&mut self, name: &str, value: f64) -> PropertyAccessResult {
        match name {
            "x" => self.position.x = value,
            "y" => self.position.y = value,
            "z" => self.position.z = value,
            "nx" => self.normal.x = value as f32,
            "ny" => self.normal.y = value as f32,
            "nz" => self.normal.z = value as f32,
            _ => match VELOCITY.iter().position(|axis| *axis == name) {
                Some(axis) => self.velocity[axis] = value as f32,
                None => return PropertyAccessResult::Ignored,
            },
        }
        PropertyAccessResult::Set
    }
}

impl PropertyAccess for VertexRecord {
    fn new() -> Self {
        Self::default()
    }

    scalar_setters!(f64: set_char(i8), set_uchar(u8), set_short(i16), set_ushort(u16), set_int(i32),
        set_uint(u32), set_float(f32), set_double(f64));
}

/// An element `face`.
#[derive(Clone, Debug, Default)]
pub(super) struct FaceRecord {
    /// The vertices around the face.
    pub indices: Vec<i64>,
    /// `label_front`.
    pub front: i64,
    /// `label_back`.
    pub back: i64,
}

impl FaceRecord {
    fn set(&mut self, name: &str, value: i64) -> PropertyAccessResult {
        match name {
            "label_front" => self.front = value,
            "label_back" => self.back = value,
            _ => return PropertyAccessResult::Ignored,
        }
        PropertyAccessResult::Set
    }
}

impl PropertyAccess for FaceRecord {
    fn new() -> Self {
        Self::default()
    }

    scalar_setters!(i64: set_char(i8), set_uchar(u8), set_short(i16), set_ushort(u16), set_int(i32),
        set_uint(u32));

    list_setters!(
        set_list_char(i8),
        set_list_uchar(u8),
        set_list_short(i16),
        set_list_ushort(u16),
        set_list_int(i32),
        set_list_uint(u32)
    );
}

/// An element that is passed over.
#[derive(Clone, Copy, Debug)]
pub(super) struct SkippedRecord;

impl PropertyAccess for SkippedRecord {
    fn new() -> Self {
        Self
    }
}
