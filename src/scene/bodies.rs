//! The closed meshes of `[[meshes]]` among the parts of a frame, and which of them overlap.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::path::Path;

use super::description::{MeshContents, MeshDescription};
use super::error::FrameError;
use super::layers::{COINCIDENT, Insides, Layer, Layers};
use super::parts::{Parts, Placed};
use super::surface::{MediumPair, Surface, SurfaceId};
use super::world::World;
use crate::geometry::Bounds;
use crate::mesh::{self, Interface, RawMesh, Region, normals};
use crate::optics::medium::MediumId;

/// One of the `[[meshes]]`.
#[derive(Clone, Debug)]
pub(super) struct Body {
    /// Which.
    pub mesh: usize,
    /// True when its file says itself what lies on the two sides of its triangles.
    pub labelled: bool,
    pub faces: Vec<Face>,
    bounds: Bounds,
}

/// Its triangles between two regions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    pub interface: Interface,
    pub triangles: usize,
    pair: MediumPair,
    surface: SurfaceId,
}

impl Parts {
    /// One of the `[[meshes]]`; what its triangles are is settled when all are there.
    pub fn add_body(
        &mut self,
        world: &World,
        mesh: usize,
        raw: RawMesh,
        path: &Path,
    ) -> Result<(), FrameError> {
        let described = &world.description.meshes[mesh];
        let labelled = raw.interfaces.is_some();
        if labelled && matches!(described.contents, MeshContents::Inside(_)) {
            let scene = world.description.file.clone();
            return Err(FrameError::Labelled { path: path.into(), scene });
        }
        let inside = world.frames().map_or(Region(1), |frames| frames.inside);
        let (prepared, warnings) = mesh::prepare(raw, inside, path)?;
        self.warn(path, warnings);
        let interfaces = prepared.interfaces.clone().unwrap_or_default();
        let first = self.geometry.triangles.len();
        let (faces, ids) = self.add_faces(world, described, &interfaces, path)?;
        let group = normals::group_keys(prepared.triangles.len(), &interfaces, &[]);
        let (scale, translate, origin) = (described.scale, described.translate, world.origin);
        let placed = Placed {
            mesh: &prepared,
            path,
            normals: described.normals,
            group: &group,
            ids: &ids,
            scale,
            pace: world.pace(),
        };
        self.append(&placed, |p| p * scale + translate - origin)?;
        let own = first as u32..self.geometry.triangles.len() as u32;
        // From where it is when the shutter opens to where it is when that closes.
        let moments = [0.0, world.description.camera.shutter];
        let corners = |triangle| moments.map(|time| self.geometry.vertices_at(triangle, time)).concat();
        let bounds = Bounds::of_points(own.flat_map(corners));
        // Faces on each other touch, though rounding may have parted them.
        let by = COINCIDENT * bounds.min.abs().max(bounds.max.abs());
        let bounds = Bounds { min: bounds.min - by, max: bounds.max + by };
        self.bodies.push(Body { mesh, labelled, faces, bounds });
        Ok(())
    }

    /// An interface for each two regions of a mesh, and which of them each triangle is.
    fn add_faces(
        &mut self,
        world: &World,
        described: &MeshDescription,
        interfaces: &[Interface],
        path: &Path,
    ) -> Result<(Vec<Face>, Vec<Option<SurfaceId>>), FrameError> {
        let mut faces: BTreeMap<Interface, Face> = BTreeMap::new();
        let mut ids = Vec::with_capacity(interfaces.len());
        for &interface in interfaces {
            let face = match faces.entry(interface) {
                Entry::Occupied(known) => known.into_mut(),
                Entry::Vacant(new) => {
                    let front = medium_of(world, described, interface.front, path)?;
                    let back = medium_of(world, described, interface.back, path)?;
                    let pair = world.pair_of(front, back);
                    let surface = self.push_surface(Surface::Interface(pair));
                    new.insert(Face { interface, triangles: 0, pair, surface })
                }
            };
            face.triangles += 1;
            ids.push(Some(face.surface));
        }
        Ok((faces.into_values().collect(), ids))
    }

    /// Settles what the triangles of `[[meshes]]` are: interfaces, or layers where others may be in the same place.
    pub fn settle_bodies(&mut self, world: &World) -> Result<Layers, FrameError> {
        let bodies = std::mem::take(&mut self.bodies);
        let overlaps = |body: &&Body| {
            let others = bodies.iter().filter(|other| other.mesh != body.mesh);
            others.into_iter().any(|other| body.bounds.meets(&other.bounds))
        };
        let (mut layered, alone): (Vec<&Body>, Vec<&Body>) = bodies.iter().partition(overlaps);
        for face in alone.iter().flat_map(|body| &body.faces) {
            self.pairs.entry(face.pair).or_insert(face.surface);
        }
        // The weakest first: the least priority, of equal ones the last in the file.
        layered
            .sort_by_key(|body| (world.description.meshes[body.mesh].priority, std::cmp::Reverse(body.mesh)));
        let mut media = Vec::new();
        for body in layered {
            self.settle(body, &mut media);
            if media.len() > Insides::MOST {
                return Err(FrameError::TooManyLayers { scene: world.description.file.clone() });
            }
        }
        self.add_pairs_of(world, &media);
        self.bodies = bodies;
        Ok(Layers(media))
    }

    /// Makes layers of a mesh's triangles; its regions follow those of `media`.
    fn settle(&mut self, body: &Body, media: &mut Vec<MediumId>) {
        let mut regions: BTreeMap<Region, Insides> = BTreeMap::new();
        for face in &body.faces {
            let sides = [(face.interface.front, face.pair.front), (face.interface.back, face.pair.back)];
            for (region, medium) in sides.into_iter().filter(|(region, _)| *region != Region::OUTSIDE) {
                regions.entry(region).or_insert_with(|| {
                    media.push(medium);
                    Insides::region(media.len() - 1)
                });
            }
        }
        let mesh = regions.values().copied().fold(Insides::NONE, Insides::and);
        let of = |region: Region| regions.get(&region).copied().unwrap_or(Insides::NONE);
        for face in &body.faces {
            let (front, back) = (of(face.interface.front), of(face.interface.back));
            self.surfaces[face.surface.0 as usize] =
                Surface::Layer(Layer { pair: face.pair, front, back, mesh });
        }
    }

    /// Any two media of overlapping meshes may meet.
    fn add_pairs_of(&mut self, world: &World, media: &[MediumId]) {
        let mut all = media.to_vec();
        if !all.is_empty() {
            all.push(MediumId(0));
        }
        all.sort_unstable();
        all.dedup();
        for &front in &all {
            for &back in &all {
                self.pair(world, front, back, false);
            }
        }
    }
}

fn medium_of(
    world: &World,
    described: &MeshDescription,
    region: Region,
    path: &Path,
) -> Result<MediumId, FrameError> {
    if region == Region::OUTSIDE {
        return Ok(MediumId(0));
    }
    let name = match &described.contents {
        MeshContents::Inside(name) => Some(name),
        MeshContents::Regions(regions) => regions.get(&region),
    };
    name.and_then(|name| world.medium_of_name(name)).ok_or_else(|| FrameError::NoMediumInMesh {
        path: path.into(),
        label: region.0,
        scene: world.description.file.clone(),
    })
}
