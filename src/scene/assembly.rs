//! Puts the meshes of one frame together.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use glam::DVec3;

use super::description::{MaterialDescription, NormalsDescription, SurfaceDescription};
use super::domain::{self, DomainOutcome, WallTag};
use super::error::FrameError;
use super::frame::{Frame, medium_at};
use super::geometry::Geometry;
use super::needs::Needs;
use super::surface::{MediumPair, Surface, SurfaceId};
use super::world::World;
use crate::accel::Accel;
use crate::light::area::EmitterTriangle;
use crate::light::{AreaLights, Lights};
use crate::mesh::{self, Interface, RawMesh, Region, normals};
use crate::optics::medium::MediumId;
use crate::sequence::{FrameNumber, frame_path};
use crate::spectrum::{Role, Spectrum};

/// A frame ready for rays, and what there is to say about it.
#[derive(Clone, Debug)]
pub struct Assembled {
    /// The frame.
    pub frame: Frame,
    /// How many triangles of the frame's mesh lie between which regions, in order.
    pub interfaces: Vec<(Interface, usize)>,
    /// True when the frame's file says itself what lies on the two sides of its triangles.
    pub labelled: bool,
    /// True when the hierarchy of the frame before was refitted.
    pub refitted: bool,
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

impl World {
    /// Makes a frame ready for rays. The hierarchy of `previous` is refitted when the triangles are the same.
    ///
    /// # Errors
    /// When a mesh of a surface cannot be read, a label has no medium, or the domain does not fit.
    pub fn assemble(
        &self,
        number: FrameNumber,
        mesh: Option<FrameMesh>,
        previous: Option<Frame>,
    ) -> Result<Assembled, FrameError> {
        let mut assembly = Assembly::new(self);
        if let Some(FrameMesh { path, mesh }) = mesh {
            assembly.add_frame(mesh, &path)?;
        }
        for (i, surface) in self.description.surfaces.iter().enumerate() {
            assembly.add_surface(surface, self.still_meshes[i].as_ref(), number)?;
        }
        Ok(assembly.finish(previous))
    }
}

struct Assembly<'a> {
    world: &'a World,
    geometry: Geometry,
    surfaces: Vec<Surface>,
    pairs: BTreeMap<MediumPair, SurfaceId>,
    emitters: Vec<(SurfaceId, f32)>,
    endless: Vec<bool>,
    interfaces: Vec<(Interface, usize)>,
    labelled: bool,
    warnings: Vec<String>,
}

impl<'a> Assembly<'a> {
    fn new(world: &'a World) -> Self {
        Self {
            world,
            geometry: Geometry::default(),
            surfaces: Vec::new(),
            pairs: BTreeMap::new(),
            emitters: Vec::new(),
            endless: vec![false; world.media.len()],
            interfaces: Vec::new(),
            labelled: false,
            warnings: Vec::new(),
        }
    }

    /// The mesh of the simulation, with its labels and the walls of its box.
    fn add_frame(&mut self, mesh: RawMesh, path: &Path) -> Result<(), FrameError> {
        let Some(frames) = self.world.frames() else { return Ok(()) };
        self.labelled = mesh.interfaces.is_some();
        let (mut mesh, warnings) = mesh::prepare(mesh, frames.inside, path)?;
        self.warn(path, warnings);
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
                    self.pair(front, back, matches!(wall, WallTag::Open(_)))
                }
            });
        }
        let group = normals::group_keys(
            mesh.triangles.len(),
            &interfaces,
            &walls.iter().map(|w| w.wall()).collect::<Vec<_>>(),
        );
        let scale = frames.scale;
        let placed = |p: DVec3| p * scale;
        self.append(&mesh, path, frames.normals, &group, &ids, placed)
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
        self.warn(path, warnings);
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
            self.warn(path, [format!(
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

    /// A mesh that the simulator did not write.
    fn add_surface(
        &mut self,
        surface: &SurfaceDescription,
        still: Option<&RawMesh>,
        number: FrameNumber,
    ) -> Result<(), FrameError> {
        let name = frame_path(&surface.mesh, number)?;
        let path = self.world.description.directory.join(name);
        let raw = still.cloned().map_or_else(|| mesh::read(&path), Ok)?;
        // What a surface is follows from the scene file; labels that its file may carry mean nothing here.
        let unlabelled = RawMesh { interfaces: None, ..raw };
        let (mut mesh, warnings) = mesh::prepare(unlabelled, Region(1), &path)?;
        if let MaterialDescription::Dielectric { .. } | MaterialDescription::Null { .. } = surface.material {
            self.warn(&path, warnings);
        }
        // Front is the side of the normal as the file has it, whatever was made of an inside-out mesh.
        mesh.interfaces = None;
        let id = self.add_material(&surface.material);
        let ids = vec![id; mesh.triangles.len()];
        let group = vec![0; mesh.triangles.len()];
        let (scale, translate) = (surface.scale, surface.translate);
        self.append(&mesh, &path, surface.normals, &group, &ids, |p| p * scale + translate)
    }

    fn add_material(&mut self, material: &MaterialDescription) -> Option<SurfaceId> {
        let mode = self.world.mode;
        let medium = |name: &str| self.world.medium_of_name(name).unwrap_or(MediumId(0));
        let surface = match material {
            MaterialDescription::Dielectric { front, back } => {
                return self.pair(medium(front), medium(back), false);
            }
            MaterialDescription::Null { front, back } => {
                return self.pair(medium(front), medium(back), true);
            }
            MaterialDescription::Diffuse { reflectance } => {
                Surface::Diffuse { reflectance: reflectance.prepare(Role::Reflectance, mode) }
            }
            MaterialDescription::Conductor { eta, k } => Surface::Conductor {
                eta: eta.prepare(Role::Coefficient, mode),
                k: k.prepare(Role::Coefficient, mode),
            },
            MaterialDescription::Emitter { radiance } => {
                let importance = radiance.to_rgb(Role::Illuminant).element_sum().max(0.0);
                self.emitters.push((SurfaceId(self.surfaces.len() as u16), importance));
                Surface::Emitter { radiance: radiance.prepare(Role::Illuminant, mode) }
            }
        };
        Some(self.push_surface(surface))
    }

    fn add_wall_surface(&mut self) -> SurfaceId {
        let grey = Spectrum::Constant(0.5);
        let reflectance = self.world.description.domain.as_ref().map_or(&grey, |d| &d.reflectance);
        let reflectance = reflectance.prepare(Role::Reflectance, self.world.mode);
        self.push_surface(Surface::Diffuse { reflectance })
    }

    /// The boundary between two media; `None` between a medium and itself, which is nothing.
    fn pair(&mut self, front: MediumId, back: MediumId, open: bool) -> Option<SurfaceId> {
        if front == back {
            return None;
        }
        let index = |id: MediumId| self.world.media[id.0 as usize].n;
        let pair = MediumPair { front, back, matched: open || index(front) == index(back) };
        if let Some(id) = self.pairs.get(&pair) {
            return Some(*id);
        }
        let id = self.push_surface(Surface::Interface(pair));
        self.pairs.insert(pair, id);
        Some(id)
    }

    fn push_surface(&mut self, surface: Surface) -> SurfaceId {
        self.surfaces.push(surface);
        SurfaceId((self.surfaces.len() - 1) as u16)
    }

    /// Appends the triangles that are something, in metres from the scene's origin.
    fn append(
        &mut self,
        mesh: &RawMesh,
        path: &Path,
        kind: NormalsDescription,
        group: &[u32],
        ids: &[Option<SurfaceId>],
        placed: impl Fn(DVec3) -> DVec3,
    ) -> Result<(), FrameError> {
        let first_vertex = self.geometry.positions.len() as u32;
        let first_normal = self.geometry.normals.len() as u32;
        for (vertex, &p) in mesh.positions.iter().enumerate() {
            let relative = placed(p) - self.world.origin;
            // Squares of distances must stay finite.
            if relative.abs().max_element() > 1e18 {
                let distance = relative.abs().max_element();
                return Err(FrameError::TooFar { path: path.into(), vertex, distance });
            }
            self.geometry.positions.push(relative.as_vec3());
        }
        let shading = match kind {
            NormalsDescription::Flat => None,
            NormalsDescription::Smooth => Some(normals::smooth(mesh, group)),
            NormalsDescription::File => Some(normals::checked_file_normals(mesh, group).0),
        };
        if let Some(shading) = &shading {
            self.geometry.normals.extend_from_slice(&shading.values);
        }
        let corners = shading.and_then(|s| s.corners);
        for (i, id) in ids.iter().enumerate() {
            let Some(id) = id else { continue };
            self.geometry.triangles.push(mesh.triangles[i].map(|v| v + first_vertex));
            self.geometry.surfaces.push(*id);
            let flat = Geometry::FLAT;
            self.geometry.corners.push(corners.as_ref().map_or(flat, |c| c[i].map(|n| n + first_normal)));
        }
        Ok(())
    }

    fn warn(&mut self, path: &Path, warnings: impl IntoIterator<Item = impl std::fmt::Display>) {
        self.warnings.extend(warnings.into_iter().map(|w| format!("{}: {w}", path.display())));
    }

    fn finish(self, previous: Option<Frame>) -> Assembled {
        let world = self.world;
        let lights = Lights {
            environment: world.environment.clone(),
            sun: world.sun.clone(),
            area: self.area_lights(),
        };
        let (accel, refitted) = hierarchy(&self.geometry, previous);
        let pair_of =
            |triangle: u32| match &self.surfaces[self.geometry.surfaces[triangle as usize].0 as usize] {
                Surface::Interface(pair) => Some(*pair),
                _ => None,
            };
        let camera_medium = medium_at(world.camera.eye(), &accel, pair_of, MediumId(0));
        let lit = self.lit(&lights);
        let needs = self.needs(&lights, &lit, camera_medium);
        Assembled {
            frame: Frame {
                mode: world.mode,
                origin: world.origin,
                camera: world.camera.clone(),
                camera_medium,
                media: world.media.clone(),
                endless: self.endless,
                lit,
                geometry: self.geometry,
                surfaces: self.surfaces,
                accel,
                lights,
                white: Spectrum::Constant(1.0).prepare(Role::Illuminant, world.mode),
                needs,
            },
            interfaces: self.interfaces,
            labelled: self.labelled,
            refitted,
            warnings: self.warnings,
        }
    }

    fn area_lights(&self) -> Option<AreaLights> {
        let triangles = (0..self.geometry.triangles.len() as u32).filter_map(|id| {
            let surface = self.geometry.surfaces[id as usize];
            let (_, importance) = self.emitters.iter().find(|(emitter, _)| *emitter == surface)?;
            let Surface::Emitter { radiance } = &self.surfaces[surface.0 as usize] else { return None };
            let vertices = self.geometry.vertices(id);
            Some(EmitterTriangle { id, vertices, radiance: radiance.clone(), importance: *importance })
        });
        if self.emitters.is_empty() { None } else { AreaLights::new(triangles.collect()) }
    }

    fn needs(&self, lights: &Lights, lit: &[bool], camera_medium: MediumId) -> Needs {
        let mut used = vec![false; self.world.media.len()];
        used[camera_medium.0 as usize] = true;
        for pair in self.pairs.keys() {
            used[pair.front.0 as usize] = true;
            used[pair.back.0 as usize] = true;
        }
        let in_use = || self.world.media.iter().enumerate().filter(|(i, _)| used[*i]);
        let scattering = in_use().any(|(_, m)| !m.sigma_s.is_zero());
        let lit_scattering = in_use().any(|(i, m)| lit[i] && !m.sigma_s.is_zero());
        let diffuse = self.surfaces.iter().any(|s| matches!(s, Surface::Diffuse { .. }));
        Needs {
            scattering,
            direct_light: lights.are_sampled() && (lit_scattering || diffuse),
            matched_interfaces: self.pairs.keys().any(|p| p.matched),
            attenuation: scattering || in_use().any(|(_, m)| !m.sigma_a.is_zero()),
            spectral: self.world.mode == crate::spectrum::LaneMode::Spectral,
            diffuse,
            sun_behind_interface: lights.sun.is_some() && self.pairs.keys().any(|p| !p.matched),
        }
    }

    /// Media that are joined to the outside by index-matched boundaries; all of them where triangles emit.
    fn lit(&self, lights: &Lights) -> Vec<bool> {
        let mut lit = vec![lights.area.is_some(); self.world.media.len()];
        lit[0] = true;
        loop {
            let before = lit.clone();
            for pair in self.pairs.keys().filter(|p| p.matched) {
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

/// The hierarchy of the frame before when its triangles are the same, else a new one.
fn hierarchy(geometry: &Geometry, previous: Option<Frame>) -> (Accel, bool) {
    match previous {
        Some(previous) if previous.geometry.triangles == geometry.triangles => {
            let mut accel = previous.accel;
            accel.refit(&geometry.positions, &geometry.triangles);
            (accel, true)
        }
        _ => (Accel::build(&geometry.positions, &geometry.triangles), false),
    }
}
