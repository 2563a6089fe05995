//! The channels of a frame's OpenEXR file and where in a pixel their numbers are.

use crate::film::accumulate::Pixel;
use crate::scene::description::Aov;

/// A channel: its name in the file and its number in a pixel.
#[derive(Clone, Copy, Debug)]
pub struct Channel {
    /// Name in the file.
    pub name: &'static str,
    /// The number.
    pub value: fn(&Pixel) -> f32,
}

/// Premultiplied colour and coverage; the colour includes the sky, where the coverage is 0.
const BEAUTY: [Channel; 4] = [
    Channel { name: "R", value: |p| p.rgb.x },
    Channel { name: "G", value: |p| p.rgb.y },
    Channel { name: "B", value: |p| p.rgb.z },
    Channel { name: "A", value: |p| p.alpha },
];

const ALBEDO: [Channel; 3] = [
    Channel { name: "albedo.R", value: |p| p.albedo.x },
    Channel { name: "albedo.G", value: |p| p.albedo.y },
    Channel { name: "albedo.B", value: |p| p.albedo.z },
];

const NORMAL: [Channel; 3] = [
    Channel { name: "N.X", value: |p| p.normal.x },
    Channel { name: "N.Y", value: |p| p.normal.y },
    Channel { name: "N.Z", value: |p| p.normal.z },
];

const POSITION: [Channel; 3] = [
    Channel { name: "P.X", value: |p| p.position.x },
    Channel { name: "P.Y", value: |p| p.position.y },
    Channel { name: "P.Z", value: |p| p.position.z },
];

const DEPTH: [Channel; 1] = [Channel { name: "Z", value: |p| p.depth }];

/// The sample counts come with the variances: together they weigh pictures that are merged. Exact up to 2^24.
const VARIANCE: [Channel; 4] = [
    Channel { name: "variance.R", value: |p| p.variance.x },
    Channel { name: "variance.G", value: |p| p.variance.y },
    Channel { name: "variance.B", value: |p| p.variance.z },
    SAMPLES[0],
];

const SAMPLES: [Channel; 1] = [Channel { name: "samples", value: |p| p.samples as f32 }];

/// To the right and down, as pixels count.
const MOTION: [Channel; 2] = [
    Channel { name: "motion.X", value: |p| p.motion.x },
    Channel { name: "motion.Y", value: |p| p.motion.y },
];

fn layer(aov: Aov) -> &'static [Channel] {
    match aov {
        Aov::Albedo => &ALBEDO,
        Aov::Normal => &NORMAL,
        Aov::Position => &POSITION,
        Aov::Depth => &DEPTH,
        Aov::Variance => &VARIANCE,
        Aov::Motion => &MOTION,
        Aov::Samples => &SAMPLES,
    }
}

/// The channels of a file with these layers, in the format's order (by the bytes of their names).
///
/// A channel that is asked for twice, by itself or with another layer, is there once.
pub fn channels(aovs: &[Aov]) -> Vec<Channel> {
    let mut all = BEAUTY.to_vec();
    aovs.iter().for_each(|&aov| all.extend(layer(aov)));
    all.sort_by_key(|channel| channel.name);
    all.dedup_by_key(|channel| channel.name);
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(aovs: &[Aov]) -> Vec<&'static str> {
        channels(aovs).into_iter().map(|channel| channel.name).collect()
    }

    #[test]
    fn channels_are_in_the_formats_order_and_unique() {
        assert_eq!(names(&[]), ["A", "B", "G", "R"]);
        let all = names(&[
            Aov::Variance,
            Aov::Motion,
            Aov::Depth,
            Aov::Position,
            Aov::Normal,
            Aov::Albedo,
            Aov::Depth,
            Aov::Samples,
        ]);
        assert_eq!(names(&[Aov::Samples]), ["A", "B", "G", "R", "samples"]);
        let expected = "A B G N.X N.Y N.Z P.X P.Y P.Z R Z albedo.B albedo.G albedo.R motion.X motion.Y samples \
                        variance.B variance.G variance.R";
        assert_eq!(all.join(" "), expected);
    }
}
