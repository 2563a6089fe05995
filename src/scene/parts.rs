//! Meshes put together in one list, with what their triangles are.

use std::collections::BTreeMap;
use std::fmt::Display;
use std::path::Path;

use glam::{DVec3, Vec3};

use super::bodies::Body;
use super::description::{MaterialDescription, NormalsDescription, SurfaceDescription};
use super::error::FrameError;
use super::geometry::Geometry;
use super::motion::Pace;
use super::surface::{MediumPair, Surface, SurfaceId};
use super::world::World;
use crate::mesh::{self, CornerNormals, MeshWarning, RawMesh, VelocityName, normals};
use crate::optics::medium::MediumId;
use crate::spectrum::Role;

/// Triangles and the surfaces that they belong to.
#[derive(Clone, Debug, Default)]
pub(super) struct Parts {
    pub geometry: Geometry,
    pub surfaces: Vec<Surface>,
    /// The boundaries among the surfaces.
    pub pairs: BTreeMap<MediumPair, SurfaceId>,
    /// The lights among the surfaces, and how bright each counts.
    pub emitters: Vec<(SurfaceId, f32)>,
    /// The `[[meshes]]` among the triangles.
    pub bodies: Vec<Body>,
    pub warnings: Vec<String>,
}

/// A mesh that is fit for rays, and how it enters a scene.
pub(super) struct Placed<'a> {
    pub mesh: &'a RawMesh,
    /// Where it came from; messages name it.
    pub path: &'a Path,
    pub normals: NormalsDescription,
    /// Equal for triangles that may share normals, as in [`normals::group_keys`].
    pub group: &'a [u32],
    /// What each triangle is; `None` for nothing.
    pub ids: &'a [Option<SurfaceId>],
    /// Metres a unit.
    pub scale: f64,
    /// What becomes of its velocities; `None` when it stands still.
    pub pace: Option<Pace>,
}

/// Farthest coordinate in metres: squares of distances must stay finite.
const FARTHEST: f32 = 1e18;

impl Parts {
    /// A mesh that the simulator did not write.
    pub fn add_surface(
        &mut self,
        world: &World,
        surface: &SurfaceDescription,
        raw: RawMesh,
        path: &Path,
    ) -> Result<(), FrameError> {
        let mut raw = raw;
        if matches!(surface.material, MaterialDescription::Emitter { .. }) && raw.velocities.take().is_some()
        {
            self.warn(path, ["lights stand still within a frame: the velocities of the mesh are left out"]);
        }
        // What a surface is follows from the scene file; labels that its file may carry mean nothing here.
        let (mut mesh, warnings) = mesh::prepare_sheets(raw, path)?;
        let bounds_media = matches!(
            surface.material,
            MaterialDescription::Dielectric { .. } | MaterialDescription::Null { .. }
        );
        // How an opaque surface hangs together is its own affair.
        let counts = |warning: &MeshWarning| bounds_media || matches!(warning, MeshWarning::Coarse(_));
        self.warn(path, warnings.into_iter().filter(counts));
        // Front is the side of the normal as the file has it, whatever was made of an inside-out mesh.
        mesh.interfaces = None;
        let id = self.add_material(world, &surface.material);
        let ids = vec![id; mesh.triangles.len()];
        let group = vec![0; mesh.triangles.len()];
        let (scale, translate) = (surface.scale, surface.translate);
        let placed = Placed {
            mesh: &mesh,
            path,
            normals: surface.normals,
            group: &group,
            ids: &ids,
            scale,
            pace: world.pace(),
        };
        self.append(&placed, |p| p * scale + translate - world.origin)
    }

    fn add_material(&mut self, world: &World, material: &MaterialDescription) -> Option<SurfaceId> {
        let mode = world.mode;
        let medium = |name: &str| world.medium_of_name(name).unwrap_or(MediumId(0));
        let surface = match material {
            MaterialDescription::Dielectric { front, back } => {
                return self.pair(world, medium(front), medium(back), false);
            }
            MaterialDescription::Null { front, back } => {
                return self.pair(world, medium(front), medium(back), true);
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

    /// The boundary between two media; `None` between a medium and itself, which is nothing.
    pub fn pair(&mut self, world: &World, front: MediumId, back: MediumId, open: bool) -> Option<SurfaceId> {
        if front == back {
            return None;
        }
        let pair = world.pair_of(front, back);
        let pair = MediumPair { matched: open || pair.matched, ..pair };
        if let Some(id) = self.pairs.get(&pair) {
            return Some(*id);
        }
        let id = self.push_surface(Surface::Interface(pair));
        self.pairs.insert(pair, id);
        Some(id)
    }

    /// A surface of its own.
    pub fn push_surface(&mut self, surface: Surface) -> SurfaceId {
        self.surfaces.push(surface);
        SurfaceId((self.surfaces.len() - 1) as u16)
    }

    /// Appends the triangles that are something; `placed` gives metres from the scene's origin.
    pub fn append(&mut self, part: &Placed, placed: impl Fn(DVec3) -> DVec3) -> Result<(), FrameError> {
        let Placed { mesh, path, group, ids, .. } = *part;
        let first_vertex = self.geometry.positions.len() as u32;
        let first_normal = self.geometry.normals.len() as u32;
        for (vertex, &p) in mesh.positions.iter().enumerate() {
            let relative = placed(p);
            if relative.abs().max_element() > f64::from(FARTHEST) {
                let distance = relative.abs().max_element();
                return Err(FrameError::TooFar { path: path.into(), vertex, distance });
            }
            self.geometry.positions.push(relative.as_vec3());
        }
        let shading = match part.normals {
            NormalsDescription::Flat => None,
            NormalsDescription::Smooth => Some(normals::smooth(mesh, group)),
            NormalsDescription::File => Some(normals::checked_file_normals(mesh, group).0),
        };
        if let Some(shading) = &shading {
            self.geometry.normals.extend_from_slice(&shading.values);
        }
        self.append_motions(part, [first_vertex, first_normal], shading.as_ref());
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

    /// Appends what vertices and normals change by; `first` are the numbers of those before. From the first part that moves
    /// on there is a motion for every vertex, and a change for every normal.
    fn append_motions(&mut self, part: &Placed, first: [u32; 2], shading: Option<&CornerNormals>) {
        let [vertices, normals] = first.map(|count| count as usize);
        let Geometry { positions, motions, normals: all_normals, normal_changes, .. } = &mut self.geometry;
        let mut too_fast = 0;
        if let (Some(pace), Some(velocities)) = (part.pace, &part.mesh.velocities) {
            motions.resize(vertices, Vec3::ZERO);
            for (&velocity, &from) in velocities.iter().zip(&positions[vertices..]) {
                let motion = pace.motion(velocity, part.scale);
                let is_in_reach = motion.is_finite() && (from + motion).abs().max_element() <= FARTHEST;
                too_fast += usize::from(!is_in_reach);
                motions.push(if is_in_reach { motion } else { Vec3::ZERO });
            }
            if let Some(shading) = shading.filter(|_| part.normals == NormalsDescription::Smooth)
                && let Some(changes) = pace.normal_changes(part.mesh, part.group, shading)
            {
                normal_changes.resize(normals, Vec3::ZERO);
                normal_changes.extend(changes);
            }
        }
        if !motions.is_empty() {
            motions.resize(positions.len(), Vec3::ZERO);
        }
        if !normal_changes.is_empty() {
            normal_changes.resize(all_normals.len(), Vec3::ZERO);
        }
        if too_fast > 0 {
            let text = format!(
                "{too_fast} vertices go farther than 1e18 m in a frame and stand still: check the velocities and frames.scale"
            );
            self.warn(part.path, [text]);
        }
    }

    /// Warns where a mesh that changes from frame to frame has no velocities though they are asked for.
    pub fn miss_velocities(&mut self, world: &World, mesh: &RawMesh, path: &Path) {
        if world.velocity_name() != VelocityName::Nothing && mesh.velocities.is_none() {
            self.warn(path, ["the file has no velocities: nothing in it moves while the shutter is open"]);
        }
    }

    /// Warnings about a file.
    pub fn warn(&mut self, path: &Path, warnings: impl IntoIterator<Item = impl Display>) {
        self.warnings.extend(warnings.into_iter().map(|w| format!("{}: {w}", path.display())));
    }

    /// Becomes a copy of other parts in the memory of a geometry that nothing needs any more.
    pub fn copy_in(mut geometry: Geometry, other: &Self) -> Self {
        geometry.copy_from(&other.geometry);
        Self {
            geometry,
            surfaces: other.surfaces.clone(),
            pairs: other.pairs.clone(),
            emitters: other.emitters.clone(),
            bodies: other.bodies.clone(),
            warnings: other.warnings.clone(),
        }
    }
}
