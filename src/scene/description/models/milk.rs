//! Reads `model = "milk"`.

use super::super::allowed::Allowed;
use super::super::document::Table;
use super::super::error::SceneError;
use super::{Contents, preset};
use crate::optics::milk::{Milk, PRESETS};

pub(super) fn read(table: &Table<'_>) -> Result<Contents, SceneError> {
    let base = preset(table, &PRESETS, PRESETS[0].1)?;
    let given = |key, allowed| table.get(key).map(|v| v.number(allowed)).transpose();
    let milk = Milk {
        fat: given("fat", &Allowed::FAT)?.unwrap_or(base.fat),
        protein: given("protein", &Allowed::PROTEIN)?.unwrap_or(base.protein),
        pressure: given("homogenisation_pressure", &Allowed::HOMOGENISATION)?.or(base.pressure),
    };
    Ok(Contents { mixture: milk.mixture(), warnings: Vec::new() })
}
