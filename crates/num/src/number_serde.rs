//! Serializes numbers so that they read back bit for bit, except the bits of a NaN.
//!
//! Formats such as JSON have no infinity and no NaN, so these are written as C++ prints them ([`format_g`]). Fields of
//! numbers use `#[serde(with = "fosssim_num::number_serde")]`.
use super::{number_format::format_g, vector::Vec2};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::DeserializeOwned, de::Error};
use std::borrow::Cow;

/// A number in its serialized form, in which `nan`, `-nan`, `inf` and `-inf` are strings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WrittenNumber(pub f64);

impl Serialize for WrittenNumber {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.0.is_finite() {
            true => serializer.serialize_f64(self.0),
            false => serializer.serialize_str(&format_g(self.0)),
        }
    }
}

impl<'de> Deserialize<'de> for WrittenNumber {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged)]
        enum NumberOrText {
            Number(f64),
            Text(String),
        }
        match NumberOrText::deserialize(deserializer)? {
            NumberOrText::Number(number) => Ok(Self(number)),
            NumberOrText::Text(text) => text.parse().map(Self).map_err(D::Error::custom),
        }
    }
}

impl schemars::JsonSchema for WrittenNumber {
    fn schema_name() -> Cow<'static, str> {
        "Number".into()
    }

    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({
            "description": "A number, or a string if it is not finite.",
            "anyOf": [{ "type": "number" }, { "enum": ["nan", "-nan", "inf", "-inf"] }],
        })
    }
}

/// A type that consists of numbers and is serialized as numbers.
pub trait WrittenNumbers: Sized {
    /// The value's serialized form.
    type Form: Serialize + DeserializeOwned;
    /// Returns the value's serialized form.
    fn to_form(&self) -> Self::Form;
    /// Returns the value that has this serialized form.
    fn from_form(form: Self::Form) -> Self;
}

impl WrittenNumbers for f64 {
    type Form = WrittenNumber;
    fn to_form(&self) -> WrittenNumber {
        WrittenNumber(*self)
    }
    fn from_form(form: WrittenNumber) -> Self {
        form.0
    }
}

impl WrittenNumbers for [f64; 2] {
    type Form = [WrittenNumber; 2];
    fn to_form(&self) -> [WrittenNumber; 2] {
        self.map(WrittenNumber)
    }
    fn from_form(form: [WrittenNumber; 2]) -> Self {
        form.map(|number| number.0)
    }
}

impl WrittenNumbers for Vec2 {
    type Form = [WrittenNumber; 2];
    fn to_form(&self) -> [WrittenNumber; 2] {
        [WrittenNumber(self.x), WrittenNumber(self.y)]
    }
    fn from_form([x, y]: [WrittenNumber; 2]) -> Self {
        Self::new(x.0, y.0)
    }
}

impl WrittenNumbers for Vec<f64> {
    type Form = Vec<WrittenNumber>;
    fn to_form(&self) -> Vec<WrittenNumber> {
        self.iter().copied().map(WrittenNumber).collect()
    }
    fn from_form(form: Vec<WrittenNumber>) -> Self {
        form.into_iter().map(|number| number.0).collect()
    }
}

impl<T: WrittenNumbers> WrittenNumbers for Option<T> {
    type Form = Option<T::Form>;
    fn to_form(&self) -> Self::Form {
        self.as_ref().map(T::to_form)
    }
    fn from_form(form: Self::Form) -> Self {
        form.map(T::from_form)
    }
}

/// Serializes a value, for serde's `with`.
///
/// # Errors
/// Fails if the serializer fails.
pub fn serialize<T: WrittenNumbers, S: Serializer>(value: &T, serializer: S) -> Result<S::Ok, S::Error> {
    value.to_form().serialize(serializer)
}

/// Deserializes a value, for serde's `with`.
///
/// # Errors
/// Fails if the deserializer fails, or the text is not a number.
pub fn deserialize<'de, T: WrittenNumbers, D: Deserializer<'de>>(deserializer: D) -> Result<T, D::Error> {
    T::Form::deserialize(deserializer).map(T::from_form)
}
