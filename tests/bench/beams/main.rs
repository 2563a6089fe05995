//! How long it takes to find the ways of the sun to a point: `cargo bench --bench beams`.
//!
//! Points are behind what a picture shows of refracting interfaces, in the order of its pixels. What is printed are
//! nanoseconds of the processor a point, the least of some passes, on one thread: for all beams that may reach it, and for
//! these and the ways of the middle of the sun's disc through them.

#![allow(clippy::print_stdout)] // the lines are what it is for

use cpu_time::ProcessTime;
use floe::accel::Ignored;
use floe::driver::Job;
use floe::geometry::Ray;
use floe::integrator::Beams;
use floe::integrator::beams::Searcher;
use floe::optics::medium::MediumId;
use floe::scene::frame::Frame;
use floe::scene::surface::Surface;
use glam::Vec3;

const PASSES: u32 = 7;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/");
    for (name, scene, number) in
        [("hero", "tests/bench/hero/scene.toml", 0), ("drop, frame 9", "sequences/drop/scene.toml", 2)]
    {
        let job = Job::open(format!("{root}{scene}").as_ref())?;
        let task = job.tasks().swap_remove(number);
        let frame = job.world.assemble(task.number, task.read(&job.world)?.meshes, None)?.frame;
        measure(name, &frame)?;
    }
    Ok(())
}

fn measure(name: &str, frame: &Frame) -> Result<(), Box<dyn std::error::Error>> {
    let beams = Beams::new(frame).ok_or("no beams")?;
    let points = points(frame);
    let mut searcher = Searcher::new(frame, &beams);
    let (find, met) = least(&points, |point, _| searcher.candidates(point))?;
    let (whole, ways) = least(&points, |point, medium| searcher.ways(point, medium))?;
    println!(
        "{name}: {} beams, {} kB; candidates {find:.0} ns for {met:.2}, with their ways {whole:.0} ns for {ways:.2}",
        beams.len(),
        beams.bytes() / 1000
    );
    Ok(())
}

/// Points behind the first interfaces that a picture shows, and what they are in: straight on from these, where the next
/// surface is and half way to it.
fn points(frame: &Frame) -> Vec<(Vec3, MediumId)> {
    let [width, height] = frame.views.opening.resolution();
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x as f32 + 0.5, y as f32 + 0.5)));
    let of_pixel = |(x, y): (f32, f32)| {
        let ray = frame.views.opening.ray(x, y);
        let first = frame.accel.closest(&ray, Ignored::NOTHING)?;
        let Surface::Interface(pair) = frame.surface(first.triangle) else { return None };
        let medium = pair.crossed(first.from_front).1;
        let on = Ray::new(ray.at(first.t), ray.direction);
        let next = frame.accel.closest(&on, Ignored::one(first.triangle))?;
        Some([0.5, 1.0].map(|part| (on.at(part * next.t), medium)))
    };
    pixels.filter_map(of_pixel).flatten().collect()
}

/// Least nanoseconds of a point over some passes, and how much is found at one on average.
fn least(
    points: &[(Vec3, MediumId)],
    mut find: impl FnMut(Vec3, MediumId) -> usize,
) -> Result<(f64, f64), Box<dyn std::error::Error>> {
    let (mut least, mut found) = (f64::INFINITY, 0);
    for _ in 0..PASSES {
        let start = ProcessTime::try_now()?;
        found = points.iter().map(|&(point, medium)| find(point, medium)).sum();
        least = least.min(start.try_elapsed()?.as_secs_f64());
    }
    let count = points.len() as f64;
    Ok((least / count * 1e9, found as f64 / count))
}
