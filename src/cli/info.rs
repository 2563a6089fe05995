//! `floe info`

use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;

use super::exit::Exit;
use super::streams::{print, say};
use crate::driver::fingerprint::Parsed;
use crate::driver::{Job, RenderError};
use crate::integrator::Integrator;
use crate::mesh::Region;
use crate::optics::density::Density;
use crate::optics::medium::Medium;
use crate::optics::particles::Cache;
use crate::scene::assembly::{Assembled, Buffers};
use crate::scene::camera_path::StartPlaces;
use crate::scene::description::{
    Axis, Daylight, DensityDescription, MeshContents, Model, SceneDescription, SkyDescription,
};
use crate::scene::world::World;
use crate::sequence::{FrameSelection, format_numbers, gaps};
use crate::spectrum::{LaneCurve, LaneMode};

#[derive(Debug, Args)]
pub struct InfoArguments {
    /// A scene file, or a folder with scene.toml or with frames
    scene: PathBuf,
    /// The frame to look into, or several [default: the first]
    #[arg(long, value_name = "RANGE", value_parser = FrameSelection::parse, allow_hyphen_values = true)]
    frames: Option<FrameSelection>,
}

/// Prints the scene, and what a frame of it needs.
pub fn run(arguments: &InfoArguments) -> Exit {
    let mut text = String::new();
    match report(arguments, &mut text) {
        Ok(()) => print(&text),
        Err(error) => {
            // What was found out before is worth having.
            print(&text);
            say(&format!("error: {error}"));
            Exit::from(&error)
        }
    }
}

fn report(arguments: &InfoArguments, text: &mut String) -> Result<(), RenderError> {
    let job = Job::open(&arguments.scene)?;
    *text += &describe_job(&job);
    let chosen = match &arguments.frames {
        Some(selection) => job.select(selection)?,
        None => job.tasks().into_iter().take(1).collect(),
    };
    let integrator = Integrator::new(&job.world.description.render);
    let mut previous = None;
    for task in chosen {
        let Parsed { meshes, inputs, warnings, .. } = task.read(&job.world)?;
        let buffers = Buffers::default();
        let mut assembled =
            job.world.assemble_into(buffers, task.number, meshes, inputs, previous.as_ref())?;
        assembled.warnings.extend(warnings);
        *text += &describe_frame(&task.number.to_string(), &assembled, &integrator);
        previous = Some(assembled.frame);
    }
    Ok(())
}

fn describe_job(job: &Job) -> String {
    let world = &job.world;
    let mut text = format!("scene     {}\n", world.description.file.display());
    if let Some(scene) = &job.written_scene {
        let _ = writeln!(text, "          (written just now: {})", scene.display());
    }
    if job.files.is_empty() {
        text += "frames    one still\n";
    } else {
        let numbers: Vec<_> = job.files.iter().map(|f| f.number).collect();
        let _ = writeln!(text, "frames    {} ({})", numbers.len(), format_numbers(&numbers));
        let missing = gaps(&job.files);
        if !missing.is_empty() {
            let list: Vec<String> = missing.iter().map(ToString::to_string).collect();
            let _ = writeln!(text, "missing   {}", list.join(", "));
        }
    }
    let [width, height] = world.description.camera.resolution;
    let render = &world.description.render;
    let target = render.target_error.map_or_else(String::new, |error| {
        format!(" at most, to an error of {} % at {} % confidence", 100.0 * error, 100.0 * render.confidence)
    });
    let _ = writeln!(
        text,
        "picture   {width} x {height}, {} samples{target}, {}",
        render.samples,
        job.output_pattern()
    );
    let lanes = match world.mode {
        LaneMode::Rgb => "linear RGB",
        LaneMode::Spectral => "four wavelengths of 380 to 780 nm",
    };
    let _ = writeln!(text, "lanes     {lanes}");
    text + &describe_lights(&world.description) + &describe_meshes(job) + &describe_media(world)
}

fn describe_lights(scene: &SceneDescription) -> String {
    let up = scene.frames.as_ref().map_or(Axis::Z, |frames| frames.up);
    let daylight = Daylight::new(&scene.suns, &scene.sky, up);
    let mut text = String::new();
    let light = |light: &Daylight| format!("{:.0} lx, {:.0} on level ground", light.sun, light.sun_level);
    if scene.suns.len() > 1 {
        let _ = writeln!(text, "suns      {}, {}", scene.suns.len(), light(&daylight));
    }
    for sun in &scene.suns {
        let [elevation, azimuth] = sun.angles(up);
        let own = light(&Daylight::new(std::slice::from_ref(sun), &SkyDescription::default(), up));
        let _ = writeln!(text, "sun       elevation {elevation:.2}, azimuth {azimuth:.2} degrees, {own}");
    }
    match (&scene.sky, daylight.sky_level) {
        (SkyDescription::Image { image }, _) => {
            let _ = writeln!(text, "sky       {image}");
        }
        (_, Some(lux)) if lux > 0.0 => {
            let _ = writeln!(text, "sky       {lux:.0} lx on level ground");
        }
        _ => (),
    }
    if scene.output.exposure != 0.0 {
        let _ = writeln!(text, "exposure  {:+.1} stops", scene.output.exposure);
    }
    text
}

fn describe_meshes(job: &Job) -> String {
    let meshes = &job.world.description.meshes;
    let mut text = String::from(if meshes.is_empty() { "" } else { "meshes\n" });
    for (which, mesh) in meshes.iter().enumerate() {
        let contents = match &mesh.contents {
            MeshContents::Inside(medium) => format!("{medium} inside"),
            MeshContents::Regions(regions) => {
                let inside = regions.iter().filter(|(region, _)| **region != Region::OUTSIDE);
                let names: Vec<String> = inside.map(|(r, name)| format!("{} = {name}", r.0)).collect();
                format!("labels {}", names.join(", "))
            }
        };
        let moving = job.meshes.iter().find(|moving| moving.mesh == which);
        let files = moving.map_or_else(|| "still".to_owned(), |m| format!("{} files", m.files.len()));
        let _ = writeln!(text, "  {}: {contents}, priority {}, {files}", mesh.path, mesh.priority);
    }
    text
}

fn describe_media(world: &World) -> String {
    let mut text = String::from("media\n");
    for medium in &world.media {
        let labels: Vec<String> = world
            .description
            .regions
            .iter()
            .filter(|(_, name)| **name == medium.name)
            .map(|(region, _)| region.0.to_string())
            .collect();
        let labels =
            if labels.is_empty() { String::new() } else { format!(" (label {})", labels.join(", ")) };
        let _ = writeln!(
            text,
            "  {}{labels}: index {}, absorption up to {:.4} /m, scattering up to {:.4} /m, mean cosine {}",
            medium.name,
            describe_index(medium),
            medium.sigma_a.maximum(),
            medium.sigma_s.maximum(),
            describe_mean_cosine(&medium.phase.mean_cosine())
        );
        if let Some(model) = &world.description.media[&medium.name].model {
            text += &describe_model(model);
        }
        if medium.glows() {
            let _ = writeln!(text, "    emits up to {:.4e}", medium.emission.maximum());
        }
        if let Some(density) =
            describe_density(&world.description.media[&medium.name].density, &medium.density)
        {
            let _ = writeln!(text, "    density {density}");
        }
    }
    text
}

/// What is in a medium, and what that does to light in the blue, green and red.
fn describe_model(model: &Model) -> String {
    let species = model.mixture.species.iter().map(|s| format!("{} {:.4e}", s.name, s.volume_fraction));
    let species: Vec<String> = species.collect();
    let contents = if species.is_empty() { "nothing".to_owned() } else { species.join(", ") };
    let mut text = format!("    model {}, with {contents} of the volume\n", model.kind.name());
    let wavelengths = [450.0, 550.0, 650.0];
    // What frames are rendered with, which the cache has by now.
    let scattering = model.mixture.scattering(&Cache::of_user());
    let Some(bulk) = scattering.ok().and_then(|found| found.bulk.at(&wavelengths)) else { return text };
    for (i, lambda) in wavelengths.iter().enumerate() {
        let (a, s, g) = (bulk.sigma_a[i], bulk.sigma_s[i], bulk.g[i]);
        let path = 1.0 / (a + s);
        let _ = writeln!(
            text,
            "    {lambda} nm: absorption {a:.4e} /m, scattering {s:.4e} /m, mean cosine {g:.4}, mean free path {path:.4e} m"
        );
    }
    let _ = writeln!(text, "    error of the integrals over radius {:.0e}", bulk.relative_error);
    text
}

fn describe_index(medium: &Medium) -> String {
    match medium.disperses() {
        true => format!("{:.4} to {:.4}", medium.index.minimum(), medium.index.maximum()),
        false => format!("{:.4}", medium.n),
    }
}

/// A number, or those that it lies between.
fn describe_mean_cosine(g: &LaneCurve) -> String {
    let (least, most) = (g.minimum(), g.maximum());
    if least == most { format!("{most:.3}") } else { format!("{least:.3} to {most:.3} over wavelength") }
}

fn describe_density(described: &DensityDescription, density: &Density) -> Option<String> {
    match described {
        DensityDescription::Homogeneous => None,
        DensityDescription::Stratified { depth, surface } => {
            let way = if *depth > 0.0 { "down" } else { "up" };
            Some(format!("1 at height {surface} m, falling to 1/e within {} m further {way}", depth.abs()))
        }
        DensityDescription::Grid { file, .. } => Some(match density {
            Density::Grid(grid) => {
                let [x, y, z] = grid.cells();
                format!("of {file}: {x} x {y} x {z} cells, up to {}", grid.maximum())
            }
            _ => format!("of {file}, one for each frame"),
        }),
    }
}

fn describe_frame(number: &str, assembled: &Assembled, integrator: &Integrator) -> String {
    let frame = &assembled.frame;
    let integrator = integrator.on(&frame.needs);
    let mut text = format!("frame {number}\n");
    let _ = writeln!(text, "  triangles {}", frame.geometry.triangles.len());
    for (interface, count) in &assembled.interfaces {
        let _ = writeln!(text, "    between {} and {}: {count}", interface.front.0, interface.back.0);
    }
    let camera_in = match frame.starts {
        StartPlaces::One(place) => &frame.medium(place.medium).name,
        StartPlaces::Several => "more than one medium",
    };
    let _ = writeln!(text, "  camera in {camera_in}");
    let hierarchy = assembled.update.hierarchy.name();
    let _ = writeln!(text, "  hierarchy {hierarchy}, {} bytes", frame.accel.bytes());
    let _ = writeln!(text, "  integrator {}", integrator.name());
    for line in integrator.lines(&frame.needs) {
        let _ = writeln!(text, "  {line}");
    }
    let reflected = assembled.reflected.iter().map(ToString::to_string);
    let left_out = integrator.left_out(&frame.needs).into_iter().map(Into::into).chain(reflected);
    let left_out: Vec<String> = left_out.collect();
    if !left_out.is_empty() {
        let _ = writeln!(text, "  left out: {}", left_out.join(", "));
    }
    for reduced in &assembled.reduced {
        let _ = writeln!(
            text,
            "  {} scatters {:.4} as often: similarity of order {}, biased",
            reduced.medium, reduced.alpha, reduced.order
        );
    }
    for warning in &assembled.warnings {
        let _ = writeln!(text, "  warning: {warning}");
    }
    text
}
