//! The elements of which only the first counts, with the original's words about them (scene-format.md 4).
use super::markup::Element;
use super::{Refusal, values};
use crate::scene::model::{Collision, CollisionDetection, Color, Integrator, Viewport};
use fosssim_num::vector::Vec2;

/// The children of the scene, looked up by name.
pub(super) struct Singles<'e>(pub(super) &'e [Element<'e>]);

fn refuse<T>(text: &str) -> Result<T, Refusal> {
    Err(Refusal::message(text.as_bytes(), 1))
}

/// A scalar of a single element: the messages for a missing and for a bad one.
fn scalar(element: &Element<'_>, name: &str, missing: &str, bad: &str) -> Result<f64, Refusal> {
    let Some(text) = element.attribute(name) else { return refuse(missing) };
    values::scalar(text).map_or_else(|| refuse(bad), Ok)
}

impl<'e> Singles<'e> {
    fn first(&self, name: &str) -> Option<&'e Element<'e>> {
        self.0.iter().find(|element| element.name == name.as_bytes())
    }

    /// The type of simulation as written; absent means the particle system.
    pub(super) fn simulation_type(&self) -> &'e [u8] {
        self.first("simtype").and_then(|element| element.attribute("type")).unwrap_or_default()
    }

    pub(super) fn duration(&self) -> Result<f64, Refusal> {
        let Some(element) = self.first("duration") else { return refuse("No duration specified. Exiting.") };
        scalar(
            element,
            "time",
            "No duration 'time' attribute specified. Exiting.",
            "Failed to parse 'time' attribute for duration. Value must be numeric. Exiting.",
        )
    }

    pub(super) fn max_frequency(&self) -> Result<Option<f64>, Refusal> {
        let Some(element) = self.first("maxsimfreq") else { return Ok(None) };
        let missing = "No maxsimfreq 'max' attribute specified. Exiting.";
        let bad = "Failed to parse 'max' attribute for maxsimfreq. Value must be scalar. Exiting.";
        scalar(element, "max", missing, bad).map(Some)
    }

    pub(super) fn viewport(&self) -> Result<Option<Viewport>, Refusal> {
        let Some(element) = self.first("viewport") else { return Ok(None) };
        let number = |name: &str| {
            let missing = format!("No viewport '{name}' attribute specified. Exiting.");
            let bad = format!("Failed to parse '{name}' attribute for viewport. Value must be scalar. Exiting.");
            scalar(element, name, &missing, &bad)
        };
        Ok(Some(Viewport { center: Vec2::new(number("cx")?, number("cy")?), size: number("size")? }))
    }

    pub(super) fn background(&self) -> Result<Option<Color>, Refusal> {
        let Some(element) = self.first("backgroundcolor") else { return Ok(None) };
        let component = |name: &str| {
            let start = format!("Failed to parse value of {name} attribute for backgroundcolor.");
            let bad = format!("{start} Value must be scalar. Exiting.");
            let value = scalar(element, name, &format!("{start} Exiting."), &bad)?;
            if (0.0..=1.0).contains(&value) {
                Ok(value)
            } else {
                refuse(&format!("{start} Invalid color specified. Valid range is 0...1"))
            }
        };
        Ok(Some(Color { red: component("r")?, green: component("g")?, blue: component("b")? }))
    }

    pub(super) fn description(&self) -> Result<Option<&'e [u8]>, Refusal> {
        let Some(element) = self.first("description") else { return Ok(None) };
        let missing = "No text attribute specified for description. Exiting.";
        element.attribute("text").map_or_else(|| refuse(missing), |text| Ok(Some(text)))
    }

    pub(super) fn tag(&self) -> Result<Option<&'e [u8]>, Refusal> {
        let Some(element) = self.first("scenetag") else { return Ok(None) };
        let missing = "Failed to parse value of tag attribute for scenetag. Value must be string. Exiting.";
        element.attribute("tag").map_or_else(|| refuse(missing), |text| Ok(Some(text)))
    }

    /// The integrator and the time step.
    pub(super) fn integrator(&self) -> Result<(Integrator, f64), Refusal> {
        let Some(element) = self.first("integrator") else { return refuse("No integrator specified. Exiting.") };
        let integrator = match element.attribute("type") {
            None => return refuse("No integrator 'type' attribute specified. Exiting."),
            Some(b"explicit-euler") => Integrator::ExplicitEuler,
            Some(b"forward-backward-euler") => Integrator::ForwardBackwardEuler,
            Some(b"symplectic-euler") => Integrator::SymplecticEuler,
            Some(b"implicit-euler") => Integrator::ImplicitEuler,
            Some(b"linearized-implicit-euler") => Integrator::LinearizedImplicitEuler,
            Some(_) => return refuse("Invalid integrator 'type' attribute specified. Exiting."),
        };
        let time_step = scalar(
            element,
            "dt",
            "No integrator 'dt' attribute specified. Exiting.",
            "Failed to parse 'dt' attribute for integrator. Value must be numeric. Exiting.",
        )?;
        Ok((integrator, time_step))
    }

    /// Every word but the contest's detection has no effect.
    fn detection(&self) -> CollisionDetection {
        match self.first("collisiondetection").and_then(|element| element.attribute("type")) {
            Some(b"contest") => CollisionDetection::Contest,
            _ => CollisionDetection::AllPairs,
        }
    }

    pub(super) fn collision(&self) -> Result<Collision, Refusal> {
        let Some(element) = self.first("collision") else { return Ok(Collision::None) };
        let number = |name: &str, default: f64| {
            let Some(text) = element.attribute(name) else { return Ok(default) };
            let bad =
                format!("Failed to parse '{name}' attribute for collision handler. Value must be numeric. Exiting.");
            values::scalar(text).map_or_else(|| refuse(&bad), Ok)
        };
        let restitution = number("COR", 1.0)?;
        match element.attribute("type") {
            None => refuse("No collision handler 'type' attribute specified. Exiting."),
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
                max_iterations: values::truncated(number("maxiters", 10.0)?),
                stiffness: number("k", 10.0)?,
                thickness: number("thickness", 0.1)?,
            }),
            Some(_) => refuse("Invalid collision handler 'type' attribute specified. Exiting."),
        }
    }
}
