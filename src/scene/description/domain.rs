//! Reads `[domain]`: the simulated box and what the faces on its planes are.

use glam::DVec3;

use super::allowed::Allowed;
use super::error::SceneError;
use super::spectrum_value;
use super::value::Value;
use super::{DomainDescription, Wall};
use crate::spectrum::Spectrum;

/// Reads `[domain]`.
pub(super) fn read(value: &Value<'_>) -> Result<DomainDescription, SceneError> {
    let table = value.table("a table [domain]")?;
    let (min, max) = corners(&table.require("box", BOX)?)?;
    let (sides, bottom, top) = table.get("walls").map_or(Ok(Default::default()), |v| walls(&v))?;
    let reflectance = table.get("reflectance");
    let reflectance =
        reflectance.map_or(Ok(Spectrum::Constant(0.5)), |v| spectrum_value::spectrum(&v, &Allowed::UNIT))?;
    table.finish()?;
    Ok(DomainDescription { min, max, sides, bottom, top, reflectance })
}

/// What to write for a box.
pub(super) const BOX: &str = "write the least and the greatest corner, such as [[-1, -1, -1], [1, 1, 1]]";

/// `box = [[..], [..]]`
pub(super) fn corners(value: &Value<'_>) -> Result<(DVec3, DVec3), SceneError> {
    match value.elements(BOX.trim_start_matches("write "))?.as_slice() {
        [least, greatest] => {
            let (min, max) = (least.point()?, greatest.point()?);
            if min.cmplt(max).all() {
                Ok((min, max))
            } else {
                Err(value.invalid(
                    "each coordinate of the first corner must be below that of the second: swap them",
                ))
            }
        }
        _ => Err(value.invalid(BOX)),
    }
}

/// `walls = { sides = .., bottom = .., top = .. }`. Under a surface that goes on for ever the fluid does too:
/// its bottom is open unless it is opaque.
fn walls(value: &Value<'_>) -> Result<(Wall, Wall, Wall), SceneError> {
    let table = value.table("a table such as { sides = \"extend\", bottom = \"open\" }")?;
    let (sides, bottom, top) = (table.get("sides"), table.get("bottom"), table.get("top"));
    table.finish()?;
    let sides = sides.map_or(Ok(Wall::Keep), |v| wall(&v))?;
    let bottom = match bottom {
        None if sides == Wall::Extend => Wall::Open,
        None => Wall::Keep,
        Some(value) => match (sides, wall(&value)?) {
            (Wall::Extend, Wall::Keep) => {
                let cure = "with sides = \"extend\" the fluid goes on below: write \"open\" or \"opaque\"";
                return Err(value.invalid(cure));
            }
            (Wall::Extend, Wall::Extend) => Wall::Open,
            (_, Wall::Extend) => {
                return Err(value.invalid("the bottom goes on only with sides = \"extend\": write \"open\""));
            }
            (_, bottom) => bottom,
        },
    };
    let top = match top {
        None => Wall::Keep,
        Some(value) => match wall(&value)? {
            Wall::Extend => {
                return Err(value.invalid("the top cannot go on: write \"keep\", \"open\" or \"opaque\""));
            }
            top => top,
        },
    };
    Ok((sides, bottom, top))
}

fn wall(value: &Value<'_>) -> Result<Wall, SceneError> {
    value.choice(&[
        ("keep", Wall::Keep),
        ("open", Wall::Open),
        ("opaque", Wall::Opaque),
        ("extend", Wall::Extend),
    ])
}
