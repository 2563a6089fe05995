//! Reads `density = ..` of a medium.

use super::DensityDescription;
use super::allowed::Allowed;
use super::domain;
use super::error::SceneError;
use super::value::Value;

const FORMS: &str =
    "{ stratified = 0.5, surface = 0.0 } or { grid = \"plume.npy\", box = [[-1, -1, -1], [1, 1, 1]] }";

/// `{ stratified = depth, surface = height }` or `{ grid = file, box = [[..], [..]] }`
pub(super) fn read(value: &Value<'_>) -> Result<DensityDescription, SceneError> {
    let table = value.table(FORMS)?;
    let density = match (table.get("stratified"), table.get("grid")) {
        (Some(depth), None) => {
            let surface = table.get("surface").map_or(Ok(0.0), |v| v.number(&Allowed::COORDINATE))?;
            let metres = depth.number(&Allowed::COORDINATE)?;
            if metres.abs() < 1e-9 {
                return Err(depth.invalid(
                    "write the depth in metres over which the density falls to 1/e; below 0 it falls upwards",
                ));
            }
            DensityDescription::Stratified { depth: metres, surface }
        }
        (None, Some(grid)) => {
            let file = grid.text("the name of a .npy or .nrrd file, or a pattern such as plume_####.npy")?;
            let (min, max) = domain::corners(&table.require("box", domain::BOX)?)?;
            DensityDescription::Grid { file: file.to_owned(), min, max }
        }
        (Some(_), Some(grid)) => {
            return Err(
                grid.invalid("a density is stratified or a grid: remove one of `stratified` and `grid`")
            );
        }
        (None, None) => {
            table.finish()?;
            return Err(value.invalid(format!("write {FORMS}")));
        }
    };
    table.finish()?;
    Ok(density)
}
