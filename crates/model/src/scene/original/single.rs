//! Reads the elements of which only the first counts, with the original's messages about them (scene-format.md 4).
use super::{Rejection, item::Item, markup::Element, values};
use crate::{
    assignments::Integrator,
    scene::model::{Collision, CollisionDetection, Color, Viewport},
};
use fosssim_num::vector::Vec2;

/// The children of the scene, found by name.
pub(super) struct Singles<'e>(pub(super) &'e [Element<'e>]);

fn reject<T>(text: &str) -> Result<T, Rejection> {
    Err(Rejection::message(text.as_bytes(), 1))
}

/// Returns a scalar of a single element. Messages call the element `kind` and the expected value `what`.
fn scalar(element: &Element<'_>, kind: &str, name: &str, what: &str) -> Result<f64, Rejection> {
    let missing = || reject(&format!("No {kind} '{name}' attribute specified. Exiting."));
    optional(element, kind, name, what)?.map_or_else(missing, Ok)
}

/// Reads an optional number.
fn optional(element: &Element<'_>, kind: &str, name: &str, what: &str) -> Result<Option<f64>, Rejection> {
    let Some(text) = element.attribute(name) else { return Ok(None) };
    let bad = || reject(&format!("Failed to parse '{name}' attribute for {kind}. Value must be {what}. Exiting."));
    values::scalar(text).map_or_else(bad, |value| Ok(Some(value)))
}

impl<'e> Singles<'e> {
    fn first(&self, name: &str) -> Option<&'e Element<'e>> {
        self.0.iter().find(|element| element.name == name.as_bytes())
    }

    /// Returns the type of simulation as written; a missing type means the particle system.
    pub(super) fn simulation_type(&self) -> &'e [u8] {
        self.first("simtype").and_then(|element| element.attribute("type")).unwrap_or_default()
    }

    pub(super) fn duration(&self) -> Result<f64, Rejection> {
        let Some(element) = self.first("duration") else { return reject("No duration specified. Exiting.") };
        scalar(element, "duration", "time", "numeric")
    }

    pub(super) fn max_frequency(&self) -> Result<Option<f64>, Rejection> {
        let kind = "maxsimfreq";
        self.first(kind).map(|element| scalar(element, kind, "max", "scalar")).transpose()
    }

    pub(super) fn viewport(&self) -> Result<Option<Viewport>, Rejection> {
        let Some(element) = self.first("viewport") else { return Ok(None) };
        let number = |name: &str| scalar(element, "viewport", name, "scalar");
        Ok(Some(Viewport { center: Vec2::new(number("cx")?, number("cy")?), size: number("size")? }))
    }

    pub(super) fn background(&self) -> Result<Option<Color>, Rejection> {
        let name = "backgroundcolor";
        self.first(name).map(|element| Item::single(element, name).color()).transpose()
    }

    pub(super) fn description(&self) -> Result<Option<&'e [u8]>, Rejection> {
        let Some(element) = self.first("description") else { return Ok(None) };
        let missing = "No text attribute specified for description. Exiting.";
        element.attribute("text").map_or_else(|| reject(missing), |text| Ok(Some(text)))
    }

    pub(super) fn tag(&self) -> Result<Option<&'e [u8]>, Rejection> {
        let Some(element) = self.first("scenetag") else { return Ok(None) };
        let missing = "Failed to parse value of tag attribute for scenetag. Value must be string. Exiting.";
        element.attribute("tag").map_or_else(|| reject(missing), |text| Ok(Some(text)))
    }

    /// Returns the integrator and the time step.
    pub(super) fn integrator(&self) -> Result<(Integrator, f64), Rejection> {
        let Some(element) = self.first("integrator") else { return reject("No integrator specified. Exiting.") };
        let Some(written) = element.attribute("type") else {
            return reject("No integrator 'type' attribute specified. Exiting.");
        };
        let Some(integrator) = Integrator::ALL.into_iter().find(|one| one.name().as_bytes() == written) else {
            return reject("Invalid integrator 'type' attribute specified. Exiting.");
        };
        Ok((integrator, scalar(element, "integrator", "dt", "numeric")?))
    }

    /// Reads the detection. Every word except the contest's has no effect.
    fn detection(&self) -> CollisionDetection {
        match self.first("collisiondetection").and_then(|element| element.attribute("type")) {
            Some(b"contest") => CollisionDetection::Contest,
            _ => CollisionDetection::AllPairs,
        }
    }

    pub(super) fn collision(&self) -> Result<Collision, Rejection> {
        let Some(element) = self.first("collision") else { return Ok(Collision::None) };
        let number = |name: &str, default: f64| {
            optional(element, "collision handler", name, "numeric").map(|value| value.unwrap_or(default))
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
                detection: self.detection(),
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
