//! Whether all files of a frame are whole: its mesh, the velocities beside it, and the meshes of its surfaces.

use std::path::Path;

use crate::driver::ready::Proof;
use crate::driver::whole::{Inspected, Traits, inspect};
use crate::mesh::{Format, MeshError, RawMesh, Syntax, VelocityName};
use crate::scene::inputs::Inputs;
use crate::scene::world::World;
use crate::sequence::FrameNumber;

/// The mesh of a frame, and how sure it is that nothing of its files is missing.
pub(super) struct Whole {
    /// The mesh, with velocities.
    pub mesh: RawMesh,
    /// How sure of all of them.
    pub proof: Proof,
    /// What is doubtful, with the file where that is not the mesh.
    pub doubt: Option<String>,
    /// What the mesh has, and then the surfaces.
    pub traits: Vec<Traits>,
}

impl Whole {
    /// Looks at the bytes of a mesh, and the other files of its frame if they are there; `before` is what was found of
    /// another frame.
    pub fn of(
        world: &World,
        number: FrameNumber,
        (path, bytes): (&Path, &[u8]),
        inputs: Option<&Inputs>,
        before: &[Traits],
    ) -> Result<Self, MeshError> {
        let velocity = world.velocity_name();
        let known = |which: usize| before.get(which).copied().unwrap_or_default();
        let mut inspected = inspect(bytes, path, &velocity, known(0))?;
        if let Some(inputs) = inputs {
            inputs.add_velocities(&mut inspected.mesh, path, &velocity)?;
            let may_have = Format::of(path).is_some_and(|format| format.syntax == Syntax::Bobj);
            if may_have && velocity != VelocityName::Nothing {
                inspected.expect_velocities(known(0));
            }
        }
        let Inspected { mesh, proof, doubt, traits } = inspected;
        let mut whole = Self { mesh, proof, doubt, traits: vec![traits] };
        for (path, bytes) in inputs.map(|inputs| inputs.surfaces(world, number)).unwrap_or_default() {
            let surface = inspect(bytes, path, &VelocityName::Nothing, known(whole.traits.len()))?;
            whole.proof = whole.proof.max(surface.proof);
            let doubt = surface.doubt.map(|doubt| format!("{}: {doubt}", path.display()));
            whole.doubt = whole.doubt.or(doubt);
            whole.traits.push(surface.traits);
        }
        Ok(whole)
    }
}
