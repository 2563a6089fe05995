//! TOML tables that know where they stand and which of their keys have been asked for.
//!
//! Each reader of a table asks for the keys that it knows and then calls [`Table::finish`], which reports the
//! first key that nobody asked for. So the known keys are written once, where they are read.

use std::cell::RefCell;
use std::path::Path;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::error::{Place, SceneError};
use super::nearest::{nearest, suggestion};
use super::value::Value;

/// The text of a scene file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Source<'t> {
    /// What the file holds.
    pub text: &'t str,
    /// Where it was read from.
    pub file: &'t Path,
}

impl Source<'_> {
    /// Line and column of a byte offset; one that is past the end or within a character is moved back.
    pub fn place(&self, offset: usize) -> Place {
        let in_text = 0..=offset.min(self.text.len());
        let offset = in_text.rev().find(|&at| self.text.is_char_boundary(at)).unwrap_or(0);
        let before = &self.text[..offset];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        Place {
            file: self.file.to_owned(),
            line: before.matches('\n').count() + 1,
            // A byte order mark is not seen in an editor.
            column: before[line_start..].trim_start_matches('\u{feff}').chars().count() + 1,
        }
    }
}

/// A table of the scene file.
#[derive(Debug)]
pub(super) struct Table<'t> {
    source: Source<'t>,
    /// Dotted path of the table; empty for the whole file.
    name: String,
    offset: usize,
    table: &'t DeTable<'t>,
    known: RefCell<Vec<&'static str>>,
}

impl<'t> Table<'t> {
    /// The table `name` that starts at byte `offset`.
    pub fn new(source: Source<'t>, name: String, offset: usize, table: &'t DeTable<'t>) -> Self {
        Self { source, name, offset, table, known: RefCell::default() }
    }

    /// The value of a key, if it is there.
    pub fn get(&self, key: &'static str) -> Option<Value<'t>> {
        self.known.borrow_mut().push(key);
        self.table.get(key).map(|item| self.value(key, item))
    }

    /// The value of a key that must be there; `cure` says what to write.
    ///
    /// # Errors
    /// [`SceneError::MissingKey`], or [`SceneError::UnknownKey`] when a mistyped one is there instead.
    pub fn require(&self, key: &'static str, cure: &str) -> Result<Value<'t>, SceneError> {
        if let Some(value) = self.get(key) {
            return Ok(value);
        }
        if let Some((mistyped, place)) = self.unasked().find(|(other, _)| nearest(other, [key]).is_some()) {
            return Err(self.unknown(mistyped, place));
        }
        Err(SceneError::MissingKey {
            place: self.source.place(self.offset),
            table: self.heading(),
            key,
            cure: cure.to_owned(),
        })
    }

    /// Every key with its value, in the order of the file; for tables whose keys are free names.
    pub fn entries(&self) -> Vec<(&'t Spanned<std::borrow::Cow<'t, str>>, Value<'t>)> {
        let mut entries: Vec<_> =
            self.table.iter().map(|(key, item)| (key, self.value(key.get_ref(), item))).collect();
        entries.sort_by_key(|(key, _)| key.span().start);
        entries
    }

    /// Reports the first key that nobody asked for.
    ///
    /// # Errors
    /// [`SceneError::UnknownKey`] with the nearest known key.
    pub fn finish(self) -> Result<(), SceneError> {
        match self.unasked().min_by_key(|&(_, offset)| offset) {
            Some((key, offset)) => Err(self.unknown(key, offset)),
            None => Ok(()),
        }
    }

    /// An error at a key of this table; `found` says what is there.
    pub fn invalid_key(&self, key: &Spanned<std::borrow::Cow<'t, str>>, cure: String) -> SceneError {
        SceneError::Invalid {
            place: self.source.place(key.span().start),
            what: self.heading(),
            found: format!("`{}`", key.get_ref()),
            cure,
        }
    }

    fn value(&self, key: &str, item: &'t Spanned<DeValue<'t>>) -> Value<'t> {
        let name = if self.name.is_empty() { key.to_owned() } else { format!("{}.{key}", self.name) };
        Value::new(self.source, name, item)
    }

    /// Keys that nobody asked for, and where they stand.
    fn unasked(&self) -> impl Iterator<Item = (&'t str, usize)> {
        let known = self.known.borrow().clone();
        self.table
            .keys()
            .filter(move |key| !known.contains(&key.get_ref().as_ref()))
            .map(|key| (key.get_ref().as_ref(), key.span().start))
    }

    fn unknown(&self, key: &str, offset: usize) -> SceneError {
        let known = self.known.borrow();
        let near = suggestion(key, &known, "the known keys are");
        SceneError::UnknownKey {
            place: self.source.place(offset),
            key: key.to_owned(),
            table: self.heading(),
            cure: if near.ends_with('?') { format!("; {near}") } else { format!(": {near}") },
        }
    }

    /// How messages call the table.
    fn heading(&self) -> String {
        match self.name.as_str() {
            "" => "the scene file".to_owned(),
            name if name.contains('[') => name.to_owned(),
            name => format!("[{name}]"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_count_characters_from_one() {
        let source = Source { text: "é = 1\nab = \"ü\" # x", file: Path::new("s.toml") };
        for (offset, line, column) in
            [(0, 1, 1), (1, 1, 1), (3, 1, 3), (7, 2, 1), (9, 2, 3), (17, 2, 10), (999, 2, 13)]
        {
            let place = source.place(offset);
            assert_eq!((place.line, place.column), (line, column), "{offset}");
        }
        assert_eq!(source.place(7).to_string(), "s.toml:2:1");
    }
}
