//! Pictures of several seeds: their mean over blocks and the error of it.

use floe::integrator::Integrator;
use glam::DVec3;

use crate::common::render::{Prepared, Rendered};

/// Means of the parts of a picture, one for each seed.
#[derive(Clone, Debug)]
pub struct Seeds(pub Vec<Vec<DVec3>>);

/// Mean and standard error of each part of a picture.
pub type Means = Vec<(DVec3, DVec3)>;

impl Seeds {
    /// Renders with the seeds 1 to `count` and cuts each picture into `columns` x `rows` parts.
    pub fn render(scene: &Prepared, samples: u32, count: u64, grid: [u32; 2]) -> Self {
        Self((1..=count).map(|seed| parts(&scene.render(samples, seed), grid)).collect())
    }

    /// From pictures of radii r, 2 r and 4 r with the same seeds: what radius 0 would give.
    pub fn extrapolated(near: &Self, middle: &Self, wide: &Self) -> Self {
        let of_seed = |((a, b), c): ((&Vec<DVec3>, &Vec<DVec3>), &Vec<DVec3>)| {
            a.iter().zip(b).zip(c).map(|((a, b), c)| (8.0 * *a - 6.0 * *b + *c) / 3.0).collect()
        };
        Self(near.0.iter().zip(&middle.0).zip(&wide.0).map(of_seed).collect())
    }

    /// Means over the seeds, with the standard errors of their spread.
    pub fn means(&self) -> Means {
        let count = self.0.len() as f64;
        (0..self.0[0].len())
            .map(|part| {
                let mean = self.0.iter().map(|seed| seed[part]).sum::<DVec3>() / count;
                let squares =
                    self.0.iter().map(|seed| (seed[part] - mean) * (seed[part] - mean)).sum::<DVec3>();
                let variance = squares / (count * (count - 1.0));
                (mean, DVec3::from_array(variance.to_array().map(f64::sqrt)))
            })
            .collect()
    }
}

/// Means of `columns` x `rows` parts of a picture, row by row.
pub fn parts(picture: &Rendered, [columns, rows]: [u32; 2]) -> Vec<DVec3> {
    let size = [picture.image.width / columns, picture.image.height / rows];
    let corners = (0..rows).flat_map(|j| (0..columns).map(move |i| [i * size[0], j * size[1]]));
    corners.map(|corner| picture.block_mean(corner, size).0).collect()
}

/// The scene by photons that are spread over `radius` in every pass.
pub fn with_radius(scene: Prepared, radius: f32) -> Prepared {
    let mut scene = scene;
    let (Integrator::Photon(mapper) | Integrator::Beams(mapper)) = &mut scene.sampling.integrator else {
        panic!("no photons")
    };
    mapper.settings.radius = Some(radius);
    mapper.settings.volume_radius = Some(radius);
    mapper.settings.shrink = 1.0;
    scene
}

/// Root of the mean square and the greatest of the differences over their standard errors.
///
/// A spread of few seeds is known badly: where it happens to be small a score would count for more than it should, so
/// that of each part is joined with the mean over all parts, relative to their values.
pub fn scores(a: &Means, b: &Means) -> (f64, f64) {
    let relative = |means: &Means| {
        let sum: f64 =
            means.iter().map(|(m, se)| (*se / m.max(DVec3::splat(1e-9))).length_squared() / 3.0).sum();
        sum / means.len() as f64
    };
    let (share_a, share_b) = (relative(a), relative(b));
    let (mut squares, mut worst, mut count) = (0.0, 0.0_f64, 0.0);
    for ((a, a_se), (b, b_se)) in a.iter().zip(b) {
        for channel in 0..3 {
            let own = a_se[channel].powi(2) + b_se[channel].powi(2);
            let joint = share_a * a[channel].powi(2) + share_b * b[channel].powi(2);
            let z = (a[channel] - b[channel]) / (0.5 * (own + joint)).sqrt().max(1e-12);
            squares += z * z;
            worst = worst.max(z.abs());
            count += 1.0;
        }
    }
    ((squares / count).sqrt(), worst)
}

/// Panics unless two estimates agree and are known to `most` of their value on average.
pub fn assert_agree(name: &str, a: &Means, b: &Means, most: f64) {
    let (rms, worst) = scores(a, b);
    let error = |means: &Means| {
        means.iter().map(|(m, se)| se.length() / m.length().max(1e-9)).sum::<f64>() / means.len() as f64
    };
    let (error_a, error_b) = (error(a), error(b));
    println!("{name}: rms z {rms:.2}, worst {worst:.2}, relative errors {error_a:.4} {error_b:.4}");
    assert!(error_a.max(error_b) < most, "{name}: errors of {error_a} and {error_b} show too little");
    assert!(rms < 1.5 && worst < 4.5, "{name}: rms z {rms:.2}, worst {worst:.2}\n{a:.4?}\n{b:.4?}");
}
