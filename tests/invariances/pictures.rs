//! Two pictures that ought to be the same, but for noise or to the last bit.

use glam::DVec3;

use crate::common::render::Rendered;

/// Blocks in a row and in a column.
const BLOCKS: [u32; 2] = [4, 3];

/// Scores of the differences of blocks: root of the mean square, and the greatest. Where nothing is noisy a difference
/// within the rounding of f32, 1e-6 of the value, counts as none.
fn scores(a: &Rendered, b: &Rendered) -> (f64, f64) {
    let size = [a.image.width / BLOCKS[0], a.image.height / BLOCKS[1]];
    let corners = (0..BLOCKS[1]).flat_map(|j| (0..BLOCKS[0]).map(move |i| [i * size[0], j * size[1]]));
    let (mut squares, mut worst) = (0.0, 0.0_f64);
    for corner in corners {
        let [(mean_a, se_a), (mean_b, se_b)] = [a, b].map(|picture| picture.block_mean(corner, size));
        let rounding = 1e-6 * mean_a;
        let variance = se_a * se_a + se_b * se_b + rounding * rounding;
        let error = DVec3::from_array(variance.to_array().map(f64::sqrt)).max(DVec3::splat(1e-12));
        let z = (mean_a - mean_b) / error;
        squares += z.length_squared() / 3.0;
        worst = worst.max(z.abs().max_element());
    }
    ((squares / f64::from(BLOCKS[0] * BLOCKS[1])).sqrt(), worst)
}

/// Panics unless two pictures are the same but for noise.
///
/// Of independent pictures a root mean square of 1.6 over 12 blocks, whose channels go together, is exceeded once in 450
/// times (chi-square), and 4.5 by one of 36 scores once in 4000. Of pictures that share their random numbers the scores
/// are less, as only rounding sends paths elsewhere. Seeds are fixed.
pub fn assert_alike(name: &str, a: &Rendered, b: &Rendered) {
    let (rms, worst) = scores(a, b);
    let (mean, error) = a.mean();
    let apart = apart(a, b);
    println!(
        "{name}: rms z {rms:.2}, worst {worst:.2}, {apart} pixels apart, mean known to {:.4}",
        (error / mean).max_element()
    );
    assert!((error / mean).max_element() < 0.03, "{name}: {error} of {mean} shows too little");
    assert!(rms < 1.6 && worst < 4.5, "{name}: rms z {rms:.2}, worst {worst:.2}");
}

/// Pixels that differ by more than a thousandth.
pub fn apart(a: &Rendered, b: &Rendered) -> usize {
    let pixels = a.image.pixels.iter().zip(&b.image.pixels);
    pixels.filter(|(a, b)| (a.rgb - b.rgb).abs().max_element() > 1e-3 * a.rgb.max_element()).count()
}

/// Panics unless all pixels have the same bits.
pub fn assert_same(name: &str, a: &Rendered, b: &Rendered) {
    let pixels = a.image.pixels.iter().zip(&b.image.pixels);
    let differ = pixels.filter(|(a, b)| a.rgb != b.rgb).count();
    assert_eq!(differ, 0, "{name}: pixels differ, {} by more than a thousandth", apart(a, b));
    assert_eq!(a.counters, b.counters, "{name}");
}
