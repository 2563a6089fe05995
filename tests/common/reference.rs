//! Scenes with the stored result of another renderer, and the comparison with it.

use std::path::{Path, PathBuf};

use glam::DVec3;
use serde::Deserialize;

use super::render::{Prepared, Rendered, prepare};

/// Edge of a block in pixels.
const BLOCK: u32 = 24;

/// Means and standard errors over 3 x 4 blocks and the picture.
#[derive(Debug, Deserialize)]
pub struct Reference {
    pub mean_rgb: [f64; 3],
    pub mean_rgb_se: [f64; 3],
    pub blocks_mean: Vec<Vec<[f64; 3]>>,
    pub blocks_se: Vec<Vec<[f64; 3]>>,
}

/// Standard scores of a picture against a reference.
#[derive(Debug)]
pub struct Comparison {
    /// Score, block (row, column) and channel.
    pub scores: Vec<(f64, String)>,
    pub rms: f64,
    /// Scores of the picture's mean.
    pub mean: DVec3,
}

/// Where the scenes are.
pub fn folder() -> PathBuf {
    [env!("CARGO_MANIFEST_DIR"), "tests", "data", "reference"].iter().collect()
}

/// A reference scene, ready for rays.
pub fn scene(name: &str) -> Prepared {
    prepare(&folder().join(format!("{name}.toml")))
}

/// What the other renderer made of it.
pub fn statistics(name: &str) -> Reference {
    statistics_in(&folder().join(format!("{name}.json")))
}

/// The statistics in a file.
pub fn statistics_in(file: &Path) -> Reference {
    let text = std::fs::read_to_string(file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
    serde_json::from_str(&text).unwrap_or_else(|e| panic!("{}: {e}", file.display()))
}

/// Means and standard errors of the blocks, row by row.
pub fn blocks(picture: &Rendered) -> Vec<(DVec3, DVec3)> {
    let corners = (0..3).flat_map(|row| (0..4).map(move |column| [column * BLOCK, row * BLOCK]));
    corners.map(|corner| picture.block_mean(corner, [BLOCK, BLOCK])).collect()
}

/// Differences over both standard errors.
///
/// Where neither renderer has any, a difference within the rounding of f32 (1e-6 of the value) counts as none.
pub fn compare(picture: &Rendered, reference: &Reference) -> Comparison {
    let score = |mine: DVec3, mine_se: DVec3, theirs: [f64; 3], theirs_se: [f64; 3]| {
        let (theirs, theirs_se) = (DVec3::from_array(theirs), DVec3::from_array(theirs_se));
        let rounding = 1e-6 * theirs;
        let variance = mine_se * mine_se + theirs_se * theirs_se + rounding * rounding;
        (mine - theirs) / DVec3::from_array(variance.to_array().map(f64::sqrt)).max(DVec3::splat(1e-12))
    };
    let mut scores = Vec::new();
    for (i, (mean, se)) in blocks(picture).into_iter().enumerate() {
        let (row, column) = (i / 4, i % 4);
        let z = score(mean, se, reference.blocks_mean[row][column], reference.blocks_se[row][column]);
        for (channel, z) in ["red", "green", "blue"].iter().zip(z.to_array()) {
            scores.push((z, format!("block row {row} column {column} {channel}")));
        }
    }
    let rms = (scores.iter().map(|(z, _)| z * z).sum::<f64>() / scores.len() as f64).sqrt();
    let (mean, se) = picture.mean();
    Comparison { scores, rms, mean: score(mean, se, reference.mean_rgb, reference.mean_rgb_se) }
}

impl Comparison {
    /// The greatest score.
    pub fn worst(&self) -> &(f64, String) {
        let greatest = self.scores.iter().max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
        greatest.unwrap_or_else(|| panic!("no blocks"))
    }

    /// Panics unless the pictures agree: scores of rms below 1.5 and none, nor that of the mean, above 4.5.
    pub fn assert_agrees(&self, name: &str) {
        let (worst, place) = self.worst();
        println!("{name}: rms z {:.3}, worst {worst:.2} at {place}, mean {:.2}", self.rms, self.mean);
        assert!(self.rms < 1.5, "{name}: rms of the block scores is {:.3}: {:#?}", self.rms, self.scores);
        assert!(worst.abs() < 4.5, "{name}: score {worst:.2} at {place}");
        assert!(self.mean.abs().max_element() < 4.5, "{name}: scores of the picture's mean {:.2}", self.mean);
    }
}
