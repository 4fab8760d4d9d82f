//! One request after the other.
use crate::{
    check, detect,
    dropped::PageHost,
    film::{self, Film},
    parts::{self, PageAnswer},
    scenes,
    submission::{DroppedSubmission, SceneRequest, SuiteRequest},
};
use fosssim_grading::{library, plan};
use serde::Deserialize;
use serde_json::json;

/// The requests of the page. The parts behind the first are named with each request.
#[derive(Debug, Deserialize)]
#[serde(tag = "do", rename_all = "kebab-case")]
enum PageRequest {
    /// The scenes and suites that are inside.
    Scenes,
    /// The XML of an embedded scene.
    Scene { name: String },
    /// A wrong trace to examine, with its scene.
    Example,
    /// Reads the scene of the second part: whether its strict reader takes it.
    Read { name: String },
    /// The scenes inside with whose start the dropped trace begins, and the kind of file that it seems to be instead.
    Recognize {
        #[serde(default)]
        file: u32,
    },
    /// Judges a dropped trace. The second part is the scene's XML, unless the scene is embedded.
    Check(check::CheckRequest),
    /// Reads the scene of the second part, and simulates it if it is right.
    Simulate { scene: String },
    /// The trace of the scene that was simulated last.
    Trace,
    /// A picture of its motion.
    Picture(film::PictureRequest),
    /// The scene's motion as a film.
    Film(film::FilmKind),
    /// Examines one pair.
    Detect(detect::PairRequest),
    /// Begins to grade a submission's traces. Without a name the second part is the suite, dropped scenes follow.
    Suite(SuiteRequest),
    /// Judges one of the suite's scenes.
    Judge(SceneRequest),
    /// Puts the results together under this name.
    Grade { name: String },
}

/// The values between requests: the motion of the scene that was simulated last, the submission that is being graded.
#[derive(Debug, Default)]
pub struct PageSession {
    film: Option<Film>,
    submission: Option<DroppedSubmission>,
}

impl PageSession {
    /// Answers a request. The first part of an answer is JSON: the requested result, or `{"error": "words"}`.
    #[must_use]
    pub fn answer(&mut self, request: &[u8], host: &dyn PageHost) -> Vec<u8> {
        let (value, bytes) =
            self.answer_parsed(request, host).unwrap_or_else(|error| (json!({ "error": error }), Vec::new()));
        let value = value.to_string();
        let all: Vec<&[u8]> = std::iter::once(value.as_bytes()).chain(bytes.iter().map(Vec::as_slice)).collect();
        parts::join_parts(&all)
    }

    fn answer_parsed(&mut self, request: &[u8], host: &dyn PageHost) -> PageAnswer {
        let parts = parts::split(request).ok_or("the request is cut")?;
        let (first, rest) = parts.split_first().ok_or("the request is empty")?;
        let request = serde_json::from_slice(first).map_err(|error| format!("the request can't be read: {error}"))?;
        let xml = rest.first().copied();
        let last = || "no scene has been simulated".to_owned();
        match request {
            PageRequest::Scenes => {
                let suites: Vec<String> = plan::built_in_names().collect();
                Ok((json!({ "assignments": scenes::list(), "suites": suites }), Vec::new()))
            }
            PageRequest::Scene { name } => Ok((json!({}), vec![scenes::xml(&name)?.to_vec()])),
            PageRequest::Example => {
                let (scene, trace) = library::FLAWED_TRACE;
                Ok((json!({ "scene": scene }), vec![trace.to_vec()]))
            }
            PageRequest::Read { name } => check::read_scene(&name, xml).map(|_| (json!({}), Vec::new())),
            PageRequest::Recognize { file } => scenes::beginning(file, host),
            PageRequest::Check(request) => check::answer(&request, xml, host),
            PageRequest::Simulate { scene } => {
                let (value, film) = film::simulate(&scene, xml.ok_or("the scene is missing")?, host);
                self.film = film;
                Ok((value, Vec::new()))
            }
            PageRequest::Trace => Ok((json!({}), vec![self.film.as_ref().ok_or_else(last)?.trace(host)?])),
            PageRequest::Picture(picture) => self.film.as_mut().ok_or_else(last)?.picture(&picture),
            PageRequest::Film(kind) => self.film.as_ref().ok_or_else(last)?.film(&kind, host),
            PageRequest::Detect(request) => detect::answer(&request),
            PageRequest::Suite(request) => {
                let (value, submission) = DroppedSubmission::begin(&request, rest)?;
                self.submission = Some(submission);
                Ok((value, Vec::new()))
            }
            PageRequest::Judge(request) => self.submission.as_mut().ok_or("no suite is chosen")?.scene(&request, host),
            PageRequest::Grade { name } => self.submission.as_ref().ok_or("no suite is chosen")?.end(&name),
        }
    }
}
