//! The arrays over points and cells of a legacy file.

use super::{CURE, Cells, Header, Parser};
use crate::mesh::error::{Fault, Place, excerpt};
use crate::mesh::vtk::arrays::{Association, Declared, NORMALS};
use crate::mesh::vtk::number::NumberType;
use crate::mesh::words::Words;

/// An array that was passed over, and where to find it again.
pub(super) struct Stored<'a> {
    pub declared: Declared,
    count: usize,
    number_type: NumberType,
    words: Words<'a>,
}

impl Parser<'_> {
    /// Reads a section of attributes, whose name is in lower case.
    pub(super) fn attributes(&mut self, section: &str, header: &Header) -> Result<(), Fault> {
        match section {
            "point_data" => self.associate(Association::Point, header.count(0)?, &header.place),
            "cell_data" => self.associate(Association::Cell, header.count(0)?, &header.place),
            "scalars" => {
                let components = if header.words.len() > 2 { header.count(2)? } else { 1 };
                if self.words.next_is("lookup_table") {
                    self.words.next();
                    self.words.rest_of_line();
                }
                self.array(header.word(0, "a name")?, components, header.number_type(1)?, &header.place)
            }
            "vectors" => self.array(header.word(0, "a name")?, 3, header.number_type(1)?, &header.place),
            "normals" => self.array(NORMALS, 3, header.number_type(1)?, &header.place),
            "tensors" => self.array("", 9, header.number_type(1)?, &header.place),
            "tensors6" => self.array("", 6, header.number_type(1)?, &header.place),
            "texture_coordinates" => self.array("", header.count(1)?, header.number_type(2)?, &header.place),
            "global_ids" | "pedigree_ids" | "edge_flags" => {
                self.array("", 1, header.number_type(1)?, &header.place)
            }
            // Bytes in a binary file, fractions in a text.
            "color_scalars" => self.array("", header.count(1)?, NumberType::U8, &header.place),
            "lookup_table" => self.skip(header.count(1)?, 4, NumberType::U8),
            "field" => self.field(header.count(1)?),
            _ => {
                let problem = format!("'{}' where a section begins", excerpt(section.as_bytes()));
                Err(Fault::malformed(header.place.clone(), problem, CURE))
            }
        }
    }

    fn associate(&mut self, association: Association, count: usize, place: &Place) -> Result<(), Fault> {
        let (name, there) = match association {
            Association::Point => ("points", self.points.unwrap_or(0)),
            Association::Cell => ("cells", self.cell_count()),
        };
        if count != there {
            let problem = format!("data of {count} {name}, of which there are {there}");
            return Err(Fault::malformed(place.clone(), problem, CURE));
        }
        self.association = Some(association);
        Ok(())
    }

    fn cell_count(&self) -> usize {
        self.cells.len() + self.lists.iter().flatten().map(Cells::len).sum::<usize>()
    }

    /// An array of one tuple for each point or cell.
    fn array(
        &mut self,
        name: &str,
        components: usize,
        number_type: NumberType,
        place: &Place,
    ) -> Result<(), Fault> {
        match self.association {
            Some(association) => self.store(association, name, components, number_type),
            None => {
                let problem = "an array before POINT_DATA or CELL_DATA";
                Err(Fault::malformed(place.clone(), problem, CURE))
            }
        }
    }

    /// Passes over an array and keeps its place.
    fn store(
        &mut self,
        association: Association,
        name: &str,
        components: usize,
        number_type: NumberType,
    ) -> Result<(), Fault> {
        let count = match association {
            Association::Point => self.points.unwrap_or(0),
            Association::Cell => self.cell_count(),
        };
        let declared = Declared { association, name: name.to_owned(), components };
        self.arrays.push(Stored { declared, count, number_type, words: self.words.clone() });
        self.skip(count, components, number_type)
    }

    /// The numbers of an array that was passed over.
    pub(super) fn values(&mut self, index: usize) -> Result<Vec<f64>, Fault> {
        let Stored { declared, count, number_type, words } = &self.arrays[index];
        let (components, count, number_type) = (declared.components, *count, *number_type);
        self.words = words.clone();
        self.numbers("tuple", count, components, number_type)
    }

    /// Arrays that say how long they are, and may belong to nothing.
    fn field(&mut self, arrays: usize) -> Result<(), Fault> {
        for _ in 0..arrays {
            while self.words.next_is("metadata") {
                self.words.next();
                self.words.rest_of_line();
                self.pass_to_empty_line();
            }
            let name = String::from_utf8_lossy(self.words.value("the name of an array")?).into_owned();
            let place = self.words.place();
            let header = Header::of(self.words.rest_of_line(), place);
            let (components, count) = (header.count(0)?, header.count(1)?);
            let number_type = header.number_type(2)?;
            match self.association {
                Some(Association::Point) if Some(count) == self.points => {
                    self.store(Association::Point, &name, components, number_type)?;
                }
                Some(Association::Cell) if count == self.cell_count() => {
                    self.store(Association::Cell, &name, components, number_type)?;
                }
                _ => self.skip(count, components, number_type)?,
            }
        }
        Ok(())
    }

    /// Passes over what lasts to an empty line.
    pub(super) fn pass_to_empty_line(&mut self) {
        while !self.words.rest_of_line().is_empty() {}
    }
}
