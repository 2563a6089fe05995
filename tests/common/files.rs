//! Files of skies and densities.

use std::io::Cursor;

use exr::prelude::*;
use glam::DVec3;

/// A latitude-longitude picture of 64 x 32 texels from the radiance of each texel's direction (z up, x in the middle).
pub fn sky_picture(radiance: impl Fn(DVec3) -> DVec3 + Sync) -> Vec<u8> {
    let (width, height) = (64, 32);
    let texel = |x: usize, y: usize| {
        let phi = (2.0 * (x as f64 + 0.5) / width as f64 - 1.0) * std::f64::consts::PI;
        let theta = (y as f64 + 0.5) / height as f64 * std::f64::consts::PI;
        let direction = DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos());
        let [r, g, b] = radiance(direction).to_array().map(|v| v as f32);
        (r, g, b)
    };
    let image =
        Image::from_channels((width, height), SpecificChannels::rgb(|p: Vec2<usize>| texel(p.x(), p.y())));
    let mut bytes = Cursor::new(Vec::new());
    image.write().to_buffered(&mut bytes).unwrap_or_else(|e| panic!("no picture: {e}"));
    bytes.into_inner()
}

/// A `.npy` of single precision in Fortran order.
pub fn npy(size: [usize; 3], value: impl Fn(usize) -> f32) -> Vec<u8> {
    let [x, y, z] = size;
    let header = format!("{{'descr': '<f4', 'fortran_order': True, 'shape': ({x}, {y}, {z}), }}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend((0..x * y * z).flat_map(|i| value(i).to_le_bytes()));
    bytes
}
