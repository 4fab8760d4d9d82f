//! Reads the elements of which only the first counts, with the original's messages about them (scene-format.md 4).
use super::{Rejection, item::Item, markup::Element, values};
use crate::{
    assignments::Integrator,
    scene::model::{Collision, CollisionDetection, Color, Viewport},
};
use fosssim_num::vector::Vec2;

/// The children of the scene, found by name.
pub(super) struct SingleElements<'e>(pub(super) &'e [Element<'e>]);

fn reject<T>(text: &str) -> Result<T, Rejection> {
    Err(Rejection::from_message(text.as_bytes(), 1))
}

/// Returns a scalar of a single element. Messages call the element `kind` and the expected value `what`.
fn read_scalar(element: &Element<'_>, kind: &str, name: &str, what: &str) -> Result<f64, Rejection> {
    let missing = || reject(&format!("No {kind} '{name}' attribute specified. Exiting."));
    read_optional(element, kind, name, what)?.map_or_else(missing, Ok)
}

/// Reads an optional number.
fn read_optional(element: &Element<'_>, kind: &str, name: &str, what: &str) -> Result<Option<f64>, Rejection> {
    let Some(text) = element.attribute(name) else { return Ok(None) };
    let bad = || reject(&format!("Failed to parse '{name}' attribute for {kind}. Value must be {what}. Exiting."));
    values::parse_scalar(text).map_or_else(bad, |value| Ok(Some(value)))
}

impl<'e> SingleElements<'e> {
    fn find_first(&self, name: &str) -> Option<&'e Element<'e>> {
        self.0.iter().find(|element| element.name == name.as_bytes())
    }

    /// Returns the type of simulation as written; a missing type means the particle system.
    pub(super) fn read_simulation_type(&self) -> &'e [u8] {
        self.find_first("simtype").and_then(|element| element.attribute("type")).unwrap_or_default()
    }

    pub(super) fn read_duration(&self) -> Result<f64, Rejection> {
        let Some(element) = self.find_first("duration") else { return reject("No duration specified. Exiting.") };
        read_scalar(element, "duration", "time", "numeric")
    }

    pub(super) fn read_max_frequency(&self) -> Result<Option<f64>, Rejection> {
        let kind = "maxsimfreq";
        self.find_first(kind).map(|element| read_scalar(element, kind, "max", "scalar")).transpose()
    }

    pub(super) fn read_viewport(&self) -> Result<Option<Viewport>, Rejection> {
        let Some(element) = self.find_first("viewport") else { return Ok(None) };
        let number = |name: &str| read_scalar(element, "viewport", name, "scalar");
        Ok(Some(Viewport { center: Vec2::new(number("cx")?, number("cy")?), size: number("size")? }))
    }

    pub(super) fn read_background(&self) -> Result<Option<Color>, Rejection> {
        let name = "backgroundcolor";
        self.find_first(name).map(|element| Item::from_element(element, name).read_color()).transpose()
    }

    pub(super) fn read_description(&self) -> Result<Option<&'e [u8]>, Rejection> {
        let Some(element) = self.find_first("description") else { return Ok(None) };
        let missing = "No text attribute specified for description. Exiting.";
        element.attribute("text").map_or_else(|| reject(missing), |text| Ok(Some(text)))
    }

    pub(super) fn read_tag(&self) -> Result<Option<&'e [u8]>, Rejection> {
        let Some(element) = self.find_first("scenetag") else { return Ok(None) };
        let missing = "Failed to parse value of tag attribute for scenetag. Value must be string. Exiting.";
        element.attribute("tag").map_or_else(|| reject(missing), |text| Ok(Some(text)))
    }

    /// Returns the integrator and the time step.
    pub(super) fn read_integrator(&self) -> Result<(Integrator, f64), Rejection> {
        let Some(element) = self.find_first("integrator") else { return reject("No integrator specified. Exiting.") };
        let Some(written) = element.attribute("type") else {
            return reject("No integrator 'type' attribute specified. Exiting.");
        };
        let Some(integrator) = Integrator::ALL.into_iter().find(|integrator| integrator.name().as_bytes() == written)
        else {
            return reject("Invalid integrator 'type' attribute specified. Exiting.");
        };
        Ok((integrator, read_scalar(element, "integrator", "dt", "numeric")?))
    }

    /// Reads the detection. Every word except the contest's has no effect.
    fn read_detection(&self) -> CollisionDetection {
        match self.find_first("collisiondetection").and_then(|element| element.attribute("type")) {
            Some(b"contest") => CollisionDetection::Contest,
            _ => CollisionDetection::AllPairs,
        }
    }

    pub(super) fn read_collision(&self) -> Result<Collision, Rejection> {
        let Some(element) = self.find_first("collision") else { return Ok(Collision::None) };
        let number = |name: &str, default: f64| {
            read_optional(element, "collision handler", name, "numeric").map(|value| value.unwrap_or(default))
        };
        let restitution = number("COR", 1.0)?;
        match element.attribute("type") {
            None => reject("No collision handler 'type' attribute specified. Exiting."),
            Some(b"none") => Ok(Collision::None),
            Some(b"simple") => Ok(Collision::Simple { restitution }),
            Some(b"continuous-time") => Ok(Collision::ContinuousTime { restitution }),
            Some(b"penalty") => Ok(Collision::Penalty {
                stiffness: number("k", 100.0)?,
                thickness: number("thickness", 0.01)?,
                detection: self.read_detection(),
            }),
            Some(b"hybrid") => Ok(Collision::Hybrid {
                restitution,
                max_iterations: values::truncate(number("maxiters", 10.0)?),
                stiffness: number("k", 10.0)?,
                thickness: number("thickness", 0.1)?,
            }),
            Some(_) => reject("Invalid collision handler 'type' attribute specified. Exiting."),
        }
    }
}
