//! One element, mostly of a repeated kind, with the original's messages about its attributes (scene-format.md 5).
use super::{Rejection, markup::Element, values};
use crate::scene::model::Color;
use fosssim_num::vector::Vec2;

/// An element, its name in messages, and its number among its kind, if there may be several.
pub(super) struct Item<'e> {
    element: &'e Element<'e>,
    kind: &'static str,
    number: Option<usize>,
    exit_code: u8,
}

impl<'e> Item<'e> {
    /// Returns all elements with the name `name`; messages call them `kind`.
    pub(super) fn items_named(
        elements: &'e [Element<'e>],
        name: &'static str,
        kind: &'static str,
    ) -> impl Iterator<Item = Self> {
        // The original exits with success after a message about a half-plane.
        let exit_code = u8::from(name != "halfplane");
        elements
            .iter()
            .filter(move |element| element.name == name.as_bytes())
            .enumerate()
            .map(move |(number, element)| Self { element, kind, number: Some(number), exit_code })
    }

    /// Returns the item of an element of a kind of which only the first element is used.
    pub(super) fn from_element(element: &'e Element<'e>, kind: &'static str) -> Self {
        Self { element, kind, number: None, exit_code: 1 }
    }

    /// Returns the element's name in messages, such as `particle 3` or `backgroundcolor`.
    pub(super) fn describe(&self) -> String {
        self.number.map_or_else(|| self.kind.to_owned(), |number| format!("{} {number}", self.kind))
    }

    pub(super) fn text(&self, name: &str) -> Option<&[u8]> {
        self.element.attribute(name)
    }

    /// Reads an integer. The messages for a missing and for an invalid value both contain `value of`.
    pub(super) fn read_integer(&self, name: &str) -> Result<i32, Rejection> {
        self.require(name, "value of ", "integer", values::parse_integer)
    }

    /// Reads a scalar. Only the message about a bad value contains `value of`.
    pub(super) fn read_numeric(&self, name: &str) -> Result<f64, Rejection> {
        self.require(name, "", "numeric", values::parse_scalar)
    }

    /// Reads two scalars, each like [`Item::read_numeric`].
    pub(super) fn read_numerics(&self, x: &str, y: &str) -> Result<Vec2, Rejection> {
        Ok(Vec2::new(self.read_numeric(x)?, self.read_numeric(y)?))
    }

    /// Reads two scalars, which messages call real numbers. The messages for a missing and for an invalid value both
    /// contain `value of`.
    pub(super) fn read_reals(&self, x: &str, y: &str) -> Result<Vec2, Rejection> {
        let real = |name| self.require(name, "value of ", "real number", values::parse_scalar);
        Ok(Vec2::new(real(x)?, real(y)?))
    }

    pub(super) fn read_boolean(&self, name: &str) -> Result<bool, Rejection> {
        self.require(name, "", "boolean", values::parse_boolean)
    }

    /// Reads the optional radius. The message about a bad value lacks `value of`.
    pub(super) fn read_radius(&self, default: f64) -> Result<f64, Rejection> {
        self.read_optional("radius", default, "", "scalar")
    }

    pub(super) fn read_optional(&self, name: &str, default: f64, prefix: &str, what: &str) -> Result<f64, Rejection> {
        let Some(text) = self.text(name) else { return Ok(default) };
        values::parse_scalar(text)
            .ok_or_else(|| self.rejection(prefix, name, &format!("Value must be {what}. Exiting.")))
    }

    /// Reads the color in `r`, `g`, `b`, and checks each component before the next is read.
    pub(super) fn read_color(&self) -> Result<Color, Rejection> {
        let component = |name: &str| {
            let value = self.require(name, "value of ", "scalar", values::parse_scalar)?;
            if (0.0..=1.0).contains(&value) {
                Ok(value)
            } else {
                Err(self.rejection("value of ", name, "Invalid color specified. Valid range is 0...1"))
            }
        };
        Ok(Color { red: component("r")?, green: component("g")?, blue: component("b")? })
    }

    /// Returns the message `Failed to parse [value of ]NAME attribute for WHO. END`.
    pub(super) fn rejection(&self, prefix: &str, name: &str, end: &str) -> Rejection {
        let text = format!("Failed to parse {prefix}{name} attribute for {}. {end}", self.describe());
        Rejection::from_message(text.as_bytes(), self.exit_code)
    }

    fn require<T>(
        &self,
        name: &str,
        missing_prefix: &str,
        what: &str,
        read: impl Fn(&[u8]) -> Option<T>,
    ) -> Result<T, Rejection> {
        let text = self.text(name).ok_or_else(|| self.rejection(missing_prefix, name, "Exiting."))?;
        read(text).ok_or_else(|| self.rejection("value of ", name, &format!("Value must be {what}. Exiting.")))
    }
}
