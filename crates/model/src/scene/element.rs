//! Writes elements in the form that they have in a file.
use super::model::Color;
use fosssim_num::vector::Vec2;
use std::fmt;

/// An element with the attributes added so far.
pub(super) struct Element(String);

impl Element {
    pub(super) fn new(name: &str) -> Self {
        Self(format!("<{name}"))
    }

    /// Adds an attribute whose value needs no character references.
    pub(super) fn with_attribute(mut self, name: &str, value: impl fmt::Display) -> Self {
        self.0 += &format!(r#" {name}="{value}""#);
        self
    }

    /// Adds a number in its shortest form, with an exponent if that is shorter.
    pub(super) fn number(self, name: &str, value: f64) -> Self {
        let written = format!("{value:?}");
        self.with_attribute(name, written.strip_suffix(".0").unwrap_or(&written))
    }

    /// Adds two numbers.
    pub(super) fn vector(self, x: &str, y: &str, value: Vec2) -> Self {
        self.number(x, value.x).number(y, value.y)
    }

    /// Adds a color's three attributes.
    pub(super) fn color(self, Color { red, green, blue }: Color) -> Self {
        self.number("r", red).number("g", green).number("b", blue)
    }

    /// Adds the index of an edge.
    pub(super) fn edge(self, name: &str, index: usize) -> Self {
        self.with_attribute(name, index)
    }

    /// Adds the index of a particle.
    pub(super) fn particle(self, name: &str, index: usize) -> Self {
        self.with_attribute(name, index)
    }

    /// Adds any text. White space other than the space is written as references, because line feeds vanish in the
    /// original and other programs change the rest.
    pub(super) fn text(self, name: &str, text: &str) -> Self {
        let mut value = String::new();
        for c in text.chars() {
            match c {
                '&' => value += "&amp;",
                '<' => value += "&lt;",
                '>' => value += "&gt;",
                '"' => value += "&quot;",
                '\0' => value.push(char::REPLACEMENT_CHARACTER),
                '\n' | '\r' | '\t' => value += &format!("&#{};", u32::from(c)),
                _ => value.push(c),
            }
        }
        self.with_attribute(name, value)
    }
}

impl fmt::Display for Element {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/>", self.0)
    }
}
