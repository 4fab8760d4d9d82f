//! Answers the request `detect` for one pair.
use crate::parts::PageAnswer;
use fosssim_judge::study::Study;
use fosssim_model::sim::{PairMotion, PointMotion};
use fosssim_num::{number_format::format_g, vector::Vec2};
use fosssim_render::{detection, plot::PlotTarget};
use fosssim_report::{detect::DetectReport, style::Style};
use serde::Deserialize;
use serde_json::json;

/// A request to examine a pair. Each moving point is `[x, y, dx, dy]`: a position and a displacement.
#[derive(Debug, Deserialize)]
#[serde(tag = "kind")]
pub(crate) enum PairRequest {
    /// Two particles.
    #[serde(rename = "pp")]
    Particles { centers: [[f64; 4]; 2], radii: [f64; 2] },
    /// A particle and an edge.
    #[serde(rename = "pe")]
    Edge { center: [f64; 4], ends: [[f64; 4]; 2], radii: [f64; 2] },
    /// A particle and a half-plane.
    #[serde(rename = "ph")]
    HalfPlane { center: [f64; 4], radius: f64, point: [f64; 2], normal: [f64; 2] },
}

impl PairRequest {
    fn to_motion(&self) -> Result<PairMotion, String> {
        let moving = |&[x, y, dx, dy]: &[f64; 4]| PointMotion { start: Vec2::new(x, y), shift: Vec2::new(dx, dy) };
        let vector = |&[x, y]: &[f64; 2]| Vec2::new(x, y);
        let not_negative = |radii: &[f64]| match radii.iter().all(|&radius| radius >= 0.0) {
            true => Ok(()),
            false => Err("a radius is negative".to_owned()),
        };
        Ok(match self {
            Self::Particles { centers, radii } => {
                not_negative(radii)?;
                PairMotion::Particles { centers: centers.each_ref().map(moving), radii: *radii }
            }
            Self::Edge { center, ends, radii } => {
                not_negative(radii)?;
                PairMotion::Edge { center: moving(center), ends: ends.each_ref().map(moving), radii: *radii }
            }
            Self::HalfPlane { center, radius, point, normal } => {
                not_negative(&[*radius])?;
                if *normal == [0.0, 0.0] {
                    return Err("the half-plane's normal is zero".to_owned());
                }
                let (point, normal) = (vector(point), vector(normal));
                PairMotion::HalfPlane { center: moving(center), radius: *radius, point, normal }
            }
        })
    }
}

/// Examines a pair. The second to fourth parts of the answer are what `detect --format text`, `json` and `svg` print.
/// The last part is the picture for a page that has the style sheet of plots.
pub(crate) fn answer(request: &PairRequest) -> PageAnswer {
    let study = Study::for_motion(&request.to_motion()?)
        .map_err(|_| "no result: the numbers are too large or too small, and the original would hang")?;
    let report = DetectReport { study: &study, place: None };
    let picture = |embedding| detection::render_picture(&study, &report.title(), embedding).into_bytes();
    let value = json!({ "decision": report.describe_decision(format_g), "collides": study.answer.decision.collides() });
    let parts = vec![
        report.render_text(Style::Plain).into_bytes(),
        report.json().into_bytes(),
        picture(PlotTarget::File),
        picture(PlotTarget::Page),
    ];
    Ok((value, parts))
}
