//! Reads the material of a surface, with the media of its two sides where the kind has any.

use std::collections::BTreeMap;

use super::MaterialDescription;
use super::allowed::Allowed;
use super::document::Table;
use super::error::SceneError;
use super::media::existing_medium;
use super::spectrum_value;
use super::value::Value;
use crate::spectrum::Spectrum;

/// `front` and `back` of a surface, as far as they are there.
pub(super) struct Sides<'t> {
    pub front: Option<Value<'t>>,
    pub back: Option<Value<'t>>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Diffuse,
    Dielectric,
    Null,
    Conductor,
    Emitter,
}

const KINDS: [(&str, Kind); 5] = [
    ("diffuse", Kind::Diffuse),
    ("dielectric", Kind::Dielectric),
    ("null", Kind::Null),
    ("conductor", Kind::Conductor),
    ("emitter", Kind::Emitter),
];

/// Reads `material = { kind = .. }` of the surface in `surface`.
pub(super) fn read<T>(
    surface: &Table<'_>,
    value: &Value<'_>,
    sides: Sides<'_>,
    media: &BTreeMap<String, T>,
) -> Result<MaterialDescription, SceneError> {
    let table = value.table("a table such as { kind = \"diffuse\", reflectance = 0.5 }")?;
    let kind = table.require("kind", "write for example kind = \"diffuse\"")?.choice(&KINDS)?;
    let material = match kind {
        Kind::Dielectric => {
            let (front, back) = both_sides(surface, media)?;
            MaterialDescription::Dielectric { front, back }
        }
        Kind::Null => {
            let (front, back) = both_sides(surface, media)?;
            MaterialDescription::Null { front, back }
        }
        Kind::Diffuse | Kind::Conductor | Kind::Emitter => opaque(&table, kind, sides)?,
    };
    table.finish()?;
    Ok(material)
}

/// The media of a boundary.
fn both_sides<T>(surface: &Table<'_>, media: &BTreeMap<String, T>) -> Result<(String, String), SceneError> {
    let medium = |key, cure| existing_medium(&surface.require(key, cure)?, media, "this side");
    Ok((
        medium("front", "write the medium on the side that the normals point to")?,
        medium("back", "write the medium on the side that the normals point away from")?,
    ))
}

/// Materials that no ray crosses: a path keeps its medium when it reflects there.
fn opaque(table: &Table<'_>, kind: Kind, sides: Sides<'_>) -> Result<MaterialDescription, SceneError> {
    if let Some(side) = sides.front.or(sides.back) {
        return Err(side.invalid("an opaque surface has no media: remove `front` and `back`"));
    }
    let spectrum = |key, cure, allowed| spectrum_value::spectrum(&table.require(key, cure)?, allowed);
    Ok(match kind {
        Kind::Conductor => MaterialDescription::Conductor {
            eta: spectrum("eta", "write the real part of the metal's index", &Allowed::POSITIVE)?,
            k: spectrum("k", "write the imaginary part of the metal's index", &Allowed::NOT_NEGATIVE)?,
        },
        Kind::Emitter => MaterialDescription::Emitter {
            radiance: spectrum_value::radiance(&table.require("radiance", "write the emitted radiance")?)?,
        },
        _ => MaterialDescription::Diffuse {
            reflectance: match table.get("reflectance") {
                Some(value) => spectrum_value::spectrum(&value, &Allowed::UNIT)?,
                None => Spectrum::Constant(0.5),
            },
        },
    })
}
