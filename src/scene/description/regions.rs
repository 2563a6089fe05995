//! Reads `[regions]`: which medium each label of the frame files is.

use std::collections::BTreeMap;

use super::error::SceneError;
use super::media::{AIR, existing_medium};
use super::value::Value;
use crate::mesh::Region;

/// The regions of a scene that names none.
pub(super) fn air_outside() -> BTreeMap<Region, String> {
    BTreeMap::from([(Region::OUTSIDE, AIR.to_owned())])
}

/// Reads `[regions]`; `media` are those that the scene defines.
pub(super) fn read<T>(
    value: &Value<'_>,
    media: &BTreeMap<String, T>,
) -> Result<BTreeMap<Region, String>, SceneError> {
    let table = value.table("a table [regions] such as 1 = \"sea\"")?;
    let mut regions = BTreeMap::new();
    for (key, value) in table.entries() {
        let Ok(label) = key.get_ref().parse::<i32>() else {
            return Err(
                table.invalid_key(key, "write the label as a whole number, such as 1 = \"sea\"".to_owned())
            );
        };
        let medium = existing_medium(&value, media, &format!("label {label}"))?;
        if regions.insert(Region(label), medium).is_some() {
            return Err(table.invalid_key(key, format!("label {label} is there twice: keep one of the two")));
        }
    }
    regions.entry(Region::OUTSIDE).or_insert_with(|| AIR.to_owned());
    Ok(regions)
}
