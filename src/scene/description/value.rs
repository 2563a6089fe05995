//! A value of the scene file with its name and its place, read as what is needed there.

use glam::{DVec3, Vec3};
use toml::Spanned;
use toml::de::DeValue;

use super::allowed::Allowed;
use super::document::{Source, Table};
use super::error::SceneError;
use super::nearest::{list, suggestion};

/// A value of the scene file.
#[derive(Clone, Debug)]
pub(super) struct Value<'t> {
    source: Source<'t>,
    name: String,
    item: &'t Spanned<DeValue<'t>>,
}

impl<'t> Value<'t> {
    /// The value that messages call `name`.
    pub fn new(source: Source<'t>, name: String, item: &'t Spanned<DeValue<'t>>) -> Self {
        Self { source, name, item }
    }

    /// An error at this value; `cure` says what to write instead.
    pub fn invalid(&self, cure: impl Into<String>) -> SceneError {
        let span = self.item.span();
        SceneError::Invalid {
            place: self.source.place(span.start),
            what: self.name.clone(),
            found: excerpt(self.source.text.get(span).unwrap_or_default()),
            cure: cure.into(),
        }
    }

    /// Whether the value is a table with a certain key.
    pub fn has_key(&self, key: &str) -> bool {
        matches!(self.item.get_ref(), DeValue::Table(table) if table.contains_key(key))
    }

    /// Whether the value is a table.
    pub fn is_table(&self) -> bool {
        self.item.get_ref().is_table()
    }

    /// Whether the value is an array.
    pub fn is_array(&self) -> bool {
        self.item.get_ref().is_array()
    }

    /// Whether the value is a number.
    pub fn is_number(&self) -> bool {
        self.raw_number().is_some()
    }

    /// A table; `forms` says what may stand here.
    pub fn table(&self, forms: &str) -> Result<Table<'t>, SceneError> {
        match self.item.get_ref() {
            DeValue::Table(table) => {
                Ok(Table::new(self.source, self.name.clone(), self.item.span().start, table))
            }
            _ => Err(self.invalid(format!("write {forms}"))),
        }
    }

    /// The elements of an array; `forms` says what may stand here.
    pub fn elements(&self, forms: &str) -> Result<Vec<Value<'t>>, SceneError> {
        match self.item.get_ref() {
            DeValue::Array(array) => {
                let element =
                    |(i, item)| Value { source: self.source, name: format!("{}[{i}]", self.name), item };
                Ok(array.iter().enumerate().map(element).collect())
            }
            _ => Err(self.invalid(format!("write {forms}"))),
        }
    }

    /// An integer or a float within a range.
    pub fn number(&self, allowed: &Allowed) -> Result<f64, SceneError> {
        self.raw_number()
            .filter(|&number| allowed.contains(number))
            .ok_or_else(|| self.invalid(format!("write {}", allowed.words)))
    }

    /// A number that is within the range after rounding to single precision.
    pub fn number32(&self, allowed: &Allowed) -> Result<f32, SceneError> {
        let number = self.number(allowed)? as f32;
        if allowed.contains(f64::from(number)) {
            Ok(number)
        } else {
            Err(self.invalid(format!("write {}, in single precision", allowed.words)))
        }
    }

    /// A whole number within a range.
    pub fn integer<T: TryFrom<i128>>(&self, least: i128, greatest: i128) -> Result<T, SceneError> {
        let number = match self.item.get_ref() {
            DeValue::Integer(integer) => i128::from_str_radix(integer.as_str(), integer.radix()).ok(),
            _ => None,
        };
        number
            .filter(|number| (least..=greatest).contains(number))
            .and_then(|number| T::try_from(number).ok())
            .ok_or_else(|| self.invalid(format!("write a whole number from {least} to {greatest}")))
    }

    /// True or false.
    pub fn boolean(&self) -> Result<bool, SceneError> {
        self.item.get_ref().as_bool().ok_or_else(|| self.invalid("write true or false"))
    }

    /// A text that is not empty; `what` says which.
    pub fn text(&self, what: &str) -> Result<&'t str, SceneError> {
        match self.item.get_ref().as_str() {
            Some(text) if !text.trim().is_empty() => Ok(text),
            _ => Err(self.invalid(format!("write {what} in quotes"))),
        }
    }

    /// One of a few names.
    pub fn choice<T: Copy>(&self, choices: &[(&str, T)]) -> Result<T, SceneError> {
        let names: Vec<&str> = choices.iter().map(|(name, _)| *name).collect();
        let Some(text) = self.item.get_ref().as_str() else {
            return Err(self.invalid(format!("write one of {} in quotes", list(&names))));
        };
        match choices.iter().find(|(name, _)| *name == text) {
            Some((_, choice)) => Ok(*choice),
            None => Err(self.invalid(suggestion(text, &names, "write one of"))),
        }
    }

    /// Three coordinates.
    pub fn point(&self) -> Result<DVec3, SceneError> {
        let [x, y, z] = self.triple("three numbers such as [0, 0, 1]", |v| v.number(&Allowed::COORDINATE))?;
        Ok(DVec3::new(x, y, z))
    }

    /// A direction of any length above zero, made a unit vector.
    pub fn direction(&self) -> Result<Vec3, SceneError> {
        let vector = self.point()?;
        // Scaled first: squares of extreme components would leave the range of f64.
        let direction = (vector / vector.abs().max_element()).try_normalize();
        direction.map(DVec3::as_vec3).ok_or_else(|| self.invalid("write a direction that is not zero"))
    }

    /// Exactly three elements, each read in the same way.
    pub fn triple<T>(
        &self,
        forms: &str,
        read: impl Fn(&Value<'t>) -> Result<T, SceneError>,
    ) -> Result<[T; 3], SceneError> {
        match self.elements(forms)?.as_slice() {
            [a, b, c] => Ok([read(a)?, read(b)?, read(c)?]),
            _ => Err(self.invalid(format!("write {forms}"))),
        }
    }

    fn raw_number(&self) -> Option<f64> {
        match self.item.get_ref() {
            DeValue::Integer(i) => {
                i128::from_str_radix(i.as_str(), i.radix()).ok().map(|integer| integer as f64)
            }
            DeValue::Float(float) => float.as_str().parse().ok(),
            _ => None,
        }
    }
}

/// The text of a value on one line, shortened.
fn excerpt(text: &str) -> String {
    const LONGEST: usize = 40;
    let mut words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    if words.chars().count() > LONGEST {
        words = words.chars().take(LONGEST - 3).chain("...".chars()).collect();
    }
    words
}
