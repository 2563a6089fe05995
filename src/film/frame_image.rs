//! A frame's pixels, assembled from tiles in any order.
//!
//! Tiles are handed out along a Hilbert curve `[HILBERT91]`: neighbours in time are neighbours in the picture, and so
//! see the same part of the scene while it is in the caches. The order has no influence on the result.

use super::accumulate::Pixel;

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TileRect {
    /// Column of the first pixel.
    pub x: u32,
    /// Row of the first pixel; 0 is the top.
    pub y: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl TileRect {
    /// The pixels (column, row) of the rectangle in the order in which a tile stores them.
    pub fn pixels(self) -> impl Iterator<Item = (u32, u32)> {
        (self.y..self.y + self.height).flat_map(move |y| (self.x..self.x + self.width).map(move |x| (x, y)))
    }

    /// Number of pixels.
    pub fn area(self) -> usize {
        self.width as usize * self.height as usize
    }
}

/// A finished rectangle of a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Tile {
    /// Where it belongs.
    pub rect: TileRect,
    /// Its pixels, row after row.
    pub pixels: Vec<Pixel>,
}

/// A frame.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameImage {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// The pixels, row after row from the top.
    pub pixels: Vec<Pixel>,
}

impl FrameImage {
    /// A frame of pixels without samples.
    pub fn new(width: u32, height: u32) -> Self {
        Self { width, height, pixels: vec![Pixel::EMPTY; width as usize * height as usize] }
    }

    /// A frame of tiles; what no tile covers stays without samples.
    ///
    /// # Panics
    /// As [`place`](Self::place).
    pub fn from_tiles(width: u32, height: u32, tiles: impl IntoIterator<Item = Tile>) -> Self {
        let mut image = Self::new(width, height);
        for tile in tiles {
            image.place(&tile);
        }
        image
    }

    /// Copies a tile to its place.
    ///
    /// # Panics
    /// When the tile does not lie within the frame or has not as many pixels as its rectangle.
    pub fn place(&mut self, tile: &Tile) {
        let TileRect { x, y, width, height } = tile.rect;
        assert!(
            x + width <= self.width && y + height <= self.height,
            "a tile beyond the frame: {:?}",
            tile.rect
        );
        assert_eq!(tile.pixels.len(), tile.rect.area(), "a tile that lacks pixels: {:?}", tile.rect);
        let width = width as usize;
        for row in 0..height as usize {
            let start = (y as usize + row) * self.width as usize + x as usize;
            self.pixels[start..start + width].copy_from_slice(&tile.pixels[row * width..(row + 1) * width]);
        }
    }

    /// The pixels of a row; 0 is the top.
    pub fn row(&self, y: u32) -> &[Pixel] {
        let width = self.width as usize;
        &self.pixels[y as usize * width..(y as usize + 1) * width]
    }

    /// Samples in all pixels.
    pub fn samples(&self) -> u64 {
        self.pixels.iter().map(|p| u64::from(p.samples)).sum()
    }

    /// Samples that were left out because a number in them was not finite.
    pub fn rejected(&self) -> u64 {
        self.pixels.iter().map(|p| u64::from(p.rejected)).sum()
    }
}

/// The tiles of a frame in the order in which to render them; `size` is their edge in pixels (at least 1).
pub fn tiles(width: u32, height: u32, size: u32) -> Vec<TileRect> {
    let size = size.max(1);
    let (columns, rows) = (width.div_ceil(size), height.div_ceil(size));
    let side = u64::from(columns.max(rows).next_power_of_two());
    let mut places: Vec<(u64, TileRect)> = (0..rows)
        .flat_map(|row| (0..columns).map(move |column| (column, row)))
        .map(|(column, row)| {
            let (x, y) = (column * size, row * size);
            let rect = TileRect { x, y, width: size.min(width - x), height: size.min(height - y) };
            (hilbert_index(side, u64::from(column), u64::from(row)), rect)
        })
        .collect();
    places.sort_unstable_by_key(|&(index, _)| index);
    places.into_iter().map(|(_, rect)| rect).collect()
}

/// Place of the cell (x, y) along the Hilbert curve through a square of `side` (a power of two) cells.
fn hilbert_index(side: u64, mut x: u64, mut y: u64) -> u64 {
    let mut index = 0;
    let mut half = side / 2;
    while half > 0 {
        let (right, low) = (u64::from(x & half > 0), u64::from(y & half > 0));
        index += half * half * ((3 * right) ^ low);
        // Turn the quadrant so that the curve within it starts and ends at its proper corners.
        if low == 0 {
            if right == 1 {
                (x, y) = (side - 1 - x, side - 1 - y);
            }
            (x, y) = (y, x);
        }
        half /= 2;
    }
    index
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn tiles_cover_every_pixel_once(width in 1_u32..90, height in 1_u32..90, size in 0_u32..40) {
            let mut seen = vec![0; (width * height) as usize];
            for rect in tiles(width, height, size) {
                prop_assert!(rect.area() > 0);
                for (x, y) in rect.pixels() {
                    seen[(y * width + x) as usize] += 1;
                }
            }
            prop_assert!(seen.iter().all(|&count| count == 1));
        }

        #[test]
        fn any_order_of_tiles_gives_the_same_frame(width in 1_u32..50, height in 1_u32..50, size in 1_u32..20) {
            let pixel = |x, y| Pixel { samples: y * width + x, ..Pixel::EMPTY };
            let made: Vec<Tile> = tiles(width, height, size)
                .into_iter()
                .map(|rect| Tile { rect, pixels: rect.pixels().map(|(x, y)| pixel(x, y)).collect() })
                .collect();
            let forwards = FrameImage::from_tiles(width, height, made.clone());
            let backwards = FrameImage::from_tiles(width, height, made.into_iter().rev());
            prop_assert_eq!(&forwards, &backwards);
            for (i, pixel) in forwards.pixels.iter().enumerate() {
                prop_assert_eq!(pixel.samples as usize, i);
            }
        }
    }

    #[test]
    fn consecutive_tiles_of_a_square_touch() {
        let order = tiles(256, 256, 16);
        for pair in order.windows(2) {
            let step = pair[0].x.abs_diff(pair[1].x) + pair[0].y.abs_diff(pair[1].y);
            assert_eq!(step, 16, "{pair:?}");
        }
        assert_eq!((order[0].x, order[0].y), (0, 0));
    }

    #[test]
    fn an_empty_frame_has_no_tiles() {
        assert!(tiles(0, 10, 16).is_empty());
        assert!(tiles(10, 0, 16).is_empty());
    }

    #[test]
    #[should_panic(expected = "beyond the frame")]
    fn a_tile_beyond_the_frame_is_refused() {
        let rect = TileRect { x: 1, y: 0, width: 2, height: 1 };
        FrameImage::new(2, 1).place(&Tile { rect, pixels: vec![Pixel::EMPTY; 2] });
    }
}
