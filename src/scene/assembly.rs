//! Puts the meshes of one frame together: still surfaces first, so that their triangles have the same indices in every
//! frame, then the simulation, then surfaces with a mesh for each frame.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::beneath::Asked;
use super::camera_path::Views;
use super::description::IntegratorKind;
use super::domain::{self, DomainOutcome, WallTag};
use super::error::FrameError;
use super::frame::{Frame, place_of};
use super::geometry::Geometry;
use super::half_spaces::{self, Reflected};
use super::inputs::Inputs;
use super::layers::Layers;
use super::needs::Needs;
use super::parts::{Parts, Placed};
use super::resolution;
use super::surface::{MediumPair, Surface, SurfaceId};
use super::thick::{self, Reduced};
use super::thickness::thickness;
use super::world::World;
use crate::accel::{Accel, Connectivity, Update};
use crate::geometry::Bounds;
use crate::light::area::EmitterTriangle;
use crate::light::{AreaLights, Lights};
use crate::mesh::{self, Interface, RawMesh, Region, normals};
use crate::optics::half_space::HalfSpace;
use crate::optics::medium::{Medium, MediumId};
use crate::sequence::FrameNumber;
use crate::spectrum::{Role, Spectrum, Wavelengths};
use glam::Vec3;

/// A frame ready for rays, and what there is to say about it.
#[derive(Clone, Debug)]
pub struct Assembled {
    /// The frame.
    pub frame: Frame,
    /// How many triangles of the frame's mesh lie between which regions, in order.
    pub interfaces: Vec<(Interface, usize)>,
    /// True when the frame's file says itself what lies on the two sides of its triangles.
    pub labelled: bool,
    /// What became of the hierarchy of the frame before.
    pub update: Update,
    /// Media whose scattering was replaced.
    pub reduced: Vec<Reduced>,
    /// Media of which nothing but a half space is seen.
    pub reflected: Vec<Reflected>,
    /// What the user should look at.
    pub warnings: Vec<String>,
}

/// A frame's mesh as it was read.
#[derive(Clone, Debug)]
pub struct FrameMesh {
    /// Where it came from; messages name it.
    pub path: PathBuf,
    /// The mesh in the file's units.
    pub mesh: RawMesh,
}

/// The memory of a frame that is not needed any more, for another frame of the same world.
#[derive(Clone, Debug, Default)]
pub struct Buffers {
    geometry: Geometry,
    accel: Accel,
}

impl From<Frame> for Buffers {
    fn from(frame: Frame) -> Self {
        Self { geometry: frame.geometry, accel: frame.accel }
    }
}

impl World {
    /// Makes a frame ready for rays. A copy of the hierarchy of `previous` is refitted when the triangles are the same.
    ///
    /// # Errors
    /// When a mesh of a surface cannot be read, a label has no medium, or the domain does not fit.
    pub fn assemble(
        &self,
        number: FrameNumber,
        meshes: impl IntoIterator<Item = FrameMesh>,
        previous: Option<&Frame>,
    ) -> Result<Assembled, FrameError> {
        self.assemble_into(Buffers::default(), number, meshes, Inputs::default(), previous)
    }

    /// As [`World::assemble`], in memory that is there; what was in it changes nothing. Files that are among the
    /// `inputs` are not read again.
    ///
    /// # Errors
    /// Those of [`World::assemble`].
    pub fn assemble_into(
        &self,
        buffers: Buffers,
        number: FrameNumber,
        meshes: impl IntoIterator<Item = FrameMesh>,
        mut inputs: Inputs,
        previous: Option<&Frame>,
    ) -> Result<Assembled, FrameError> {
        let Buffers { geometry, accel } = buffers;
        let mut assembly = Assembly::new(self, geometry);
        let mut moving = self.meshes(false);
        for FrameMesh { path, mesh } in meshes {
            match moving.next() {
                Some((which, _)) => {
                    assembly.parts.miss_velocities(self, &mesh, &path);
                    assembly.parts.add_body(self, which, mesh, &path)?;
                }
                None => assembly.add_frame(mesh, &path)?,
            }
        }
        for surface in self.surfaces_of_frame(number) {
            let (surface, path) = surface?;
            let raw = inputs.mesh(&path, &self.velocity_name())?;
            assembly.parts.add_surface(self, surface, raw, &path)?;
        }
        let media = self.media_at(number, &mut inputs)?;
        let layers = assembly.settle_bodies()?;
        // The hierarchy takes its memory when that of the files is free again.
        drop(inputs);
        Ok(assembly.finish(number, media, layers, accel, previous))
    }
}

/// So many emitting triangles are asked for the medium before them; where there are more, they may be in any.
const MOST_ASKED: usize = 256;

struct Assembly<'a> {
    world: &'a World,
    parts: Parts,
    endless: Vec<bool>,
    interfaces: Vec<(Interface, usize)>,
    labelled: bool,
}

impl<'a> Assembly<'a> {
    fn new(world: &'a World, geometry: Geometry) -> Self {
        Self {
            world,
            parts: Parts::copy_in(geometry, &world.still),
            endless: vec![false; world.media.len()],
            interfaces: Vec::new(),
            labelled: false,
        }
    }

    /// The mesh of the simulation, with its labels and the walls of its box.
    fn add_frame(&mut self, mesh: RawMesh, path: &Path) -> Result<(), FrameError> {
        let Some(frames) = self.world.frames() else { return Ok(()) };
        self.labelled = mesh.interfaces.is_some();
        self.parts.miss_velocities(self.world, &mesh, path);
        let (mut mesh, warnings) = mesh::prepare(mesh, frames.inside, path)?;
        self.parts.warn(path, warnings);
        self.count_interfaces(&mesh);
        let walls = self.apply_domain(&mut mesh, path)?;
        let interfaces = mesh.interfaces.clone().unwrap_or_default();
        let mut ids = Vec::with_capacity(interfaces.len());
        let mut opaque = None;
        for (interface, wall) in interfaces.iter().zip(&walls) {
            ids.push(match wall {
                WallTag::Opaque(_) => Some(*opaque.get_or_insert_with(|| self.add_wall_surface())),
                _ => {
                    let front = self.world.medium_of_region(interface.front, path)?;
                    let back = self.world.medium_of_region(interface.back, path)?;
                    self.parts.pair(self.world, front, back, matches!(wall, WallTag::Open(_)))
                }
            });
        }
        let group = normals::group_keys(
            mesh.triangles.len(),
            &interfaces,
            &walls.iter().map(|w| w.wall()).collect::<Vec<_>>(),
        );
        let (scale, origin) = (frames.scale, self.world.origin);
        let placed = Placed {
            mesh: &mesh,
            path,
            normals: frames.normals,
            group: &group,
            ids: &ids,
            scale,
            pace: self.world.pace(),
        };
        self.parts.append(&placed, |p| p * scale - origin)
    }

    /// What the `[[meshes]]` are to each other.
    fn settle_bodies(&mut self) -> Result<Layers, FrameError> {
        let layers = self.parts.settle_bodies(self.world)?;
        if !self.parts.bodies.is_empty() {
            let faces = self.parts.bodies.iter().flat_map(|body| &body.faces);
            let counts = faces.fold(BTreeMap::new(), |mut counts, face| {
                *counts.entry(face.interface).or_insert(0) += face.triangles;
                counts
            });
            self.interfaces = counts.into_iter().collect();
            self.labelled = self.parts.bodies.iter().all(|body| body.labelled);
        }
        Ok(layers)
    }

    /// The tags of the triangles; nothing is on a wall without `[domain]`.
    fn apply_domain(&mut self, mesh: &mut RawMesh, path: &Path) -> Result<Vec<WallTag>, FrameError> {
        let (Some(domain), Some(frames)) = (&self.world.description.domain, self.world.frames()) else {
            return Ok(vec![WallTag::None; mesh.triangles.len()]);
        };
        if mesh.triangles.is_empty() {
            return Ok(Vec::new());
        }
        let DomainOutcome { walls, extended, warnings } = domain::apply(mesh, domain, frames.up)
            .map_err(|source| FrameError::Domain { path: path.into(), source })?;
        self.parts.warn(path, warnings);
        for region in extended {
            self.extend_region(region, path)?;
        }
        Ok(walls)
    }

    fn extend_region(&mut self, region: Region, path: &Path) -> Result<(), FrameError> {
        let id = self.world.medium_of_region(region, path)?;
        if id == MediumId(0) {
            // A fluid that is told to be what is outside anyway: there is the sky, not the dark of a sea.
            return Ok(());
        }
        self.endless[id.0 as usize] = true;
        let medium = &self.world.media[id.0 as usize];
        if medium.sigma_a.is_zero() && medium.sigma_s.is_zero() {
            let name = &medium.name;
            self.parts.warn(path, [format!(
                "the sea of clear \"{name}\" goes on without end and is black below; give it absorption or scattering"
            )]);
        }
        Ok(())
    }

    fn count_interfaces(&mut self, mesh: &RawMesh) {
        let mut counts = BTreeMap::new();
        for interface in mesh.interfaces.iter().flatten() {
            *counts.entry(*interface).or_insert(0) += 1;
        }
        self.interfaces = counts.into_iter().collect();
    }

    fn add_wall_surface(&mut self) -> SurfaceId {
        let grey = Spectrum::Constant(0.5);
        let reflectance = self.world.description.domain.as_ref().map_or(&grey, |d| &d.reflectance);
        let reflectance = reflectance.prepare(Role::Reflectance, self.world.mode);
        self.parts.push_surface(Surface::Diffuse { reflectance })
    }

    fn finish(
        mut self,
        number: FrameNumber,
        mut media: Vec<Medium>,
        layers: Layers,
        accel: Accel,
        previous: Option<&Frame>,
    ) -> Assembled {
        let world = self.world;
        let shutter = world.description.camera.shutter;
        self.parts.geometry.settle_motions();
        let lights = Lights {
            environment: world.environment.clone(),
            suns: world.suns.clone(),
            area: self.area_lights(),
        };
        let still = world.still.geometry.triangles.len();
        let (mut accel, update) = hierarchy(&self.parts.geometry, still, accel, previous);
        if shutter > 0.0 && !self.parts.geometry.motions.is_empty() {
            accel.set_in_motion(&self.parts.geometry.motions, &self.parts.geometry.triangles, shutter);
        }
        let Parts { geometry, surfaces, .. } = &self.parts;
        let surface = |triangle: u32| &surfaces[geometry.surfaces[triangle as usize].0 as usize];
        let views = Views::new(&world.camera, number, shutter, world.tells_motion());
        let place_of = |point, time| place_of(point, time, &accel, surface, &layers);
        let camera = place_of(views.opening.eye(), 0.0);
        let starts = views.start_places(camera, accel.is_in_motion(), place_of);
        let medium_at = |point| place_of(point, 0.0).medium;
        let lit = self.lit(medium_at);
        let boxes = thick::boxes(&media, geometry, surfaces);
        let (half_spaces, reflected) = self.half_spaces(&media, &boxes, medium_at);
        let order = world.description.render.similarity;
        let reduced = thick::reduce(&mut media, &world.reductions, order, &self.endless, &boxes);
        let led = thick::led(&media, &self.endless, &boxes);
        let roughness = resolution::roughness(&media, &boxes);
        let asked = Asked {
            parts: &self.parts,
            media: &media,
            lights: &lights,
            lit: &lit,
            accel: &accel,
            wavelengths: Wavelengths::for_mode(world.mode, 0.5),
        };
        let beneath = asked.beneath();
        let looked_from: Vec<bool> = lit.iter().zip(&beneath).map(|(lit, b)| *lit || b.is_some()).collect();
        let needs = self.needs(&media, &lights, &looked_from, camera.medium);
        let is_half_space = |id: MediumId| half_spaces.get(id.0 as usize).is_some_and(Option::is_some);
        let lets_sun_in = |p: &MediumPair| {
            !p.matched
                && (p.front == camera.medium || !is_half_space(p.front))
                && (p.back == camera.medium || !is_half_space(p.back))
        };
        let needs = Needs {
            similarity: !reduced.is_empty(),
            half_spaces: !half_spaces.is_empty(),
            direct_light: needs.direct_light || (lights.are_sampled() && !half_spaces.is_empty()),
            sun_behind_interface: needs.sun_behind_interface && self.parts.pairs.keys().any(lets_sun_in),
            layers: !layers.is_empty(),
            // Layers may be hidden, which rays pass straight through.
            matched_interfaces: needs.matched_interfaces || !layers.is_empty(),
            motion: accel.is_in_motion(),
            lens: world.description.camera.aperture > 0.0,
            ..needs
        };
        Assembled {
            frame: Frame {
                mode: world.mode,
                origin: world.origin,
                views,
                starts,
                media,
                endless: self.endless,
                lit,
                beneath,
                led,
                half_spaces,
                roughness,
                geometry: self.parts.geometry,
                surfaces: self.parts.surfaces,
                layers,
                accel,
                lights,
                white: Spectrum::Constant(1.0).prepare(Role::Illuminant, world.mode),
                needs,
            },
            interfaces: self.interfaces,
            labelled: self.labelled,
            update,
            reduced,
            reflected,
            warnings: self.parts.warnings,
        }
    }

    /// Those of path tracing: photons walk, and other integrators want less than all scattered light.
    fn half_spaces(
        &self,
        media: &[Medium],
        boxes: &[Bounds],
        medium_at: impl Fn(Vec3) -> MediumId,
    ) -> (Vec<Option<HalfSpace>>, Vec<Reflected>) {
        let integrator = self.world.description.render.integrator;
        if !matches!(integrator, IntegratorKind::Auto | IntegratorKind::Path) {
            return Default::default();
        }
        let Parts { geometry, surfaces, .. } = &self.parts;
        let holds_light = |id, bounds: &Bounds| {
            let near = |triangle: &u32| bounds.meets(&Bounds::of_points(geometry.vertices(*triangle)));
            let near: Vec<u32> = self.emitting().filter(near).take(MOST_ASKED + 1).collect();
            near.len() > MOST_ASKED || near.into_iter().any(|triangle| medium_at(self.before(triangle)) == id)
        };
        let thickness = |id, bounds: &Bounds| thickness(id, geometry, surfaces, bounds);
        half_spaces::half_spaces(media, boxes, thickness, holds_light)
    }

    fn area_lights(&self) -> Option<AreaLights> {
        let triangles = (0..self.parts.geometry.triangles.len() as u32).filter_map(|id| {
            let surface = self.parts.geometry.surfaces[id as usize];
            let (_, importance) = self.parts.emitters.iter().find(|(emitter, _)| *emitter == surface)?;
            let Surface::Emitter { radiance } = &self.parts.surfaces[surface.0 as usize] else { return None };
            let vertices = self.parts.geometry.vertices(id);
            Some(EmitterTriangle { id, vertices, radiance: radiance.clone(), importance: *importance })
        });
        if self.parts.emitters.is_empty() { None } else { AreaLights::new(triangles.collect()) }
    }

    fn needs(
        &self,
        media: &[Medium],
        lights: &Lights,
        looked_from: &[bool],
        camera_medium: MediumId,
    ) -> Needs {
        let mut used = vec![false; media.len()];
        used[camera_medium.0 as usize] = true;
        for pair in self.parts.pairs.keys() {
            used[pair.front.0 as usize] = true;
            used[pair.back.0 as usize] = true;
        }
        let in_use = || media.iter().enumerate().filter(|(i, _)| used[*i]);
        let scattering = in_use().any(|(_, m)| !m.sigma_s.is_zero());
        let lit_scattering = in_use().any(|(i, m)| looked_from[i] && !m.sigma_s.is_zero());
        let diffuse = self.parts.surfaces.iter().any(|s| matches!(s, Surface::Diffuse { .. }));
        Needs {
            scattering,
            direct_light: lights.are_sampled() && (lit_scattering || diffuse),
            matched_interfaces: self.parts.pairs.keys().any(|p| p.matched),
            attenuation: scattering || in_use().any(|(_, m)| !m.sigma_a.is_zero()),
            heterogeneous: in_use().any(|(_, m)| m.is_heterogeneous()),
            emission: in_use().any(|(_, m)| m.glows()),
            spectral: self.world.mode == crate::spectrum::LaneMode::Spectral,
            dispersive: in_use().any(|(_, m)| m.disperses()),
            diffuse,
            specular: self.parts.pairs.keys().any(|p| !p.matched)
                || self.parts.surfaces.iter().any(|s| matches!(s, Surface::Conductor { .. })),
            turbid_air: !media[0].sigma_s.is_zero(),
            lamps: !lights.suns.is_empty() || lights.area.is_some(),
            sky: lights.environment.is_sampled() || lights.environment.is_constant_light(),
            peaked_sky: lights.environment.is_peaked(),
            layers: false,
            similarity: false,
            half_spaces: false,
            motion: false,
            lens: false,
            sun_behind_interface: !lights.suns.is_empty() && self.parts.pairs.keys().any(|p| !p.matched),
        }
    }

    /// The triangles that emit.
    fn emitting(&self) -> impl Iterator<Item = u32> {
        let Parts { geometry, emitters, .. } = &self.parts;
        let emits = |id: &u32| emitters.iter().any(|(e, _)| *e == geometry.surfaces[*id as usize]);
        (0..geometry.triangles.len() as u32).filter(emits)
    }

    /// A point close before the middle of a triangle.
    fn before(&self, triangle: u32) -> Vec3 {
        let [a, b, c] = self.parts.geometry.vertices(triangle);
        (a + b + c) / 3.0 + 1e-4 * (b - a).cross(c - a).normalize_or_zero() * (b - a).length()
    }

    /// Media that are joined to the outside, or to one that a triangle emits into, by index-matched boundaries.
    ///
    /// A light that is looked for where it cannot be seen costs shadow rays, and one that is not is still met by chance.
    fn lit(&self, medium_at: impl Fn(Vec3) -> MediumId) -> Vec<bool> {
        let emitting: Vec<u32> = self.emitting().take(MOST_ASKED + 1).collect();
        let mut lit = vec![emitting.len() > MOST_ASKED; self.world.media.len()];
        lit[0] = true;
        for id in emitting.into_iter().take(MOST_ASKED) {
            lit[medium_at(self.before(id)).0 as usize] = true;
        }
        loop {
            let before = lit.clone();
            for pair in self.parts.pairs.keys().filter(|p| p.matched) {
                let either = lit[pair.front.0 as usize] || lit[pair.back.0 as usize];
                lit[pair.front.0 as usize] = either;
                lit[pair.back.0 as usize] = either;
            }
            if lit == before {
                return lit;
            }
        }
    }
}

/// A copy of the hierarchy of the frame before, refitted, when its triangles are the same; else a new one.
fn hierarchy(
    geometry: &Geometry,
    still: usize,
    mut accel: Accel,
    previous: Option<&Frame>,
) -> (Accel, Update) {
    let mut connectivity = Connectivity::New;
    if let Some(previous) = previous {
        connectivity = Connectivity::between(&previous.geometry.triangles, &geometry.triangles);
        // Where others are new, the still triangles have their part of the tree already.
        if connectivity != Connectivity::New || (still > 0 && accel.is_empty()) {
            accel.copy_from(&previous.accel);
        }
    }
    let update = accel.update(&geometry.positions, &geometry.triangles, still, &connectivity);
    (accel, update)
}
