//! Answers requests, one after the other.
use crate::{
    check, detect,
    dropped::PageHost,
    film::{self, Film},
    parts::{self, PageAnswer},
    scenes,
    submission::{SceneRequest, SuiteRequest, UploadedSubmission},
};
use fosssim_grading::{library, plan};
use serde::Deserialize;
use serde_json::json;

/// A request from the page. For some requests, the parts after the first one are described here.
#[derive(Debug, Deserialize)]
#[serde(tag = "do", rename_all = "kebab-case")]
enum PageRequest {
    /// Lists the embedded scenes and suites.
    Scenes,
    /// Returns the XML of an embedded scene.
    Scene { name: String },
    /// Returns a wrong trace and its scene, as an example.
    Example,
    /// Reads the scene in the second part. Returns whether the strict reader accepts it.
    Read { name: String },
    /// Finds the embedded scenes to which the dropped trace may belong. If the file cannot be a trace, finds its
    /// probable kind.
    Recognize {
        #[serde(default)]
        file: u32,
    },
    /// Judges a dropped trace. The second part is the XML of the scene, unless the scene is embedded.
    Check(check::CheckRequest),
    /// Reads the scene in the second part. If it has no errors, it is simulated.
    Simulate { scene: String },
    /// Returns the reference's trace of the scene that was last simulated.
    Trace,
    /// Returns a picture of the motion that was last simulated.
    Picture(film::PictureRequest),
    /// Returns the motion that was last simulated as a film.
    Film(film::FilmKind),
    /// Examines a pair.
    Detect(detect::PairRequest),
    /// Begins to grade a submission that consists of traces. If no suite is named, the second part is the suite, and
    /// the parts after it are dropped scenes.
    Suite(SuiteRequest),
    /// Judges the trace for one of the suite's scenes.
    Judge(SceneRequest),
    /// Combines the results of all scenes into a grade. `name` is the submission's name.
    Grade { name: String },
}

/// The state between requests: the motion that was last simulated, and the submission that is being graded.
#[derive(Debug, Default)]
pub struct PageSession {
    film: Option<Film>,
    submission: Option<UploadedSubmission>,
}

impl PageSession {
    /// Answers a request. The first part of the answer is JSON. It contains the result, or `{"error": "message"}`.
    #[must_use]
    pub fn answer(&mut self, request: &[u8], host: &dyn PageHost) -> Vec<u8> {
        let (value, bytes) =
            self.answer_parsed(request, host).unwrap_or_else(|error| (json!({ "error": error }), Vec::new()));
        let value = value.to_string();
        let all: Vec<&[u8]> = std::iter::once(value.as_bytes()).chain(bytes.iter().map(Vec::as_slice)).collect();
        parts::join_parts(&all)
    }

    fn answer_parsed(&mut self, request: &[u8], host: &dyn PageHost) -> PageAnswer {
        let parts = parts::split(request).ok_or("the request is truncated")?;
        let (first, rest) = parts.split_first().ok_or("the request is empty")?;
        let request = serde_json::from_slice(first).map_err(|error| format!("the request can't be read: {error}"))?;
        let xml = rest.first().copied();
        let last = || "no scene has been simulated".to_owned();
        match request {
            PageRequest::Scenes => {
                let suites: Vec<_> = plan::built_in_names().map(|name| scenes::describe_suite(&name)).collect();
                Ok((json!({ "assignments": scenes::list_scenes(), "suites": suites }), Vec::new()))
            }
            PageRequest::Scene { name } => Ok((json!({}), vec![scenes::find_xml(&name)?.to_vec()])),
            PageRequest::Example => {
                let (scene, trace) = library::FLAWED_TRACE;
                Ok((json!({ "scene": scene }), vec![trace.to_vec()]))
            }
            PageRequest::Read { name } => check::read_scene(&name, xml).map(|_| (json!({}), Vec::new())),
            PageRequest::Recognize { file } => scenes::recognize_scenes(file, host),
            PageRequest::Check(request) => check::answer(&request, xml, host),
            PageRequest::Simulate { scene } => {
                let (value, film) = film::simulate(&scene, xml.ok_or("the scene is missing")?, host);
                self.film = film;
                Ok((value, Vec::new()))
            }
            PageRequest::Trace => Ok((json!({}), vec![self.film.as_ref().ok_or_else(last)?.trace(host)?])),
            PageRequest::Picture(picture) => self.film.as_mut().ok_or_else(last)?.draw_requested_picture(&picture),
            PageRequest::Film(kind) => self.film.as_ref().ok_or_else(last)?.draw_film(&kind, host),
            PageRequest::Detect(request) => detect::answer(&request),
            PageRequest::Suite(request) => {
                let (value, submission) = UploadedSubmission::from_request(&request, rest)?;
                self.submission = Some(submission);
                Ok((value, Vec::new()))
            }
            PageRequest::Judge(request) => {
                self.submission.as_mut().ok_or("no suite is chosen")?.judge_scene(&request, host)
            }
            PageRequest::Grade { name } => {
                self.submission.as_ref().ok_or("no suite is chosen")?.finish_submission(&name)
            }
        }
    }
}
