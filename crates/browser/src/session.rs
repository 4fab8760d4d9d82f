//! One request after the other.
use crate::{
    check, detect,
    dropped::Host,
    film::{self, Film},
    parts, scenes,
};
use serde::Deserialize;
use serde_json::{Value, json};

/// What the page may ask. The parts behind the first are named with each request.
#[derive(Debug, Deserialize)]
#[serde(tag = "do", rename_all = "kebab-case")]
enum Request {
    /// The scenes that are inside.
    Scenes,
    /// The XML of one of them.
    Scene { name: String },
    /// The scenes inside with whose start the dropped trace begins.
    Recognise {
        #[serde(default)]
        file: u32,
    },
    /// Judges a dropped trace. The second part is the scene's XML, unless it is one of those inside.
    Check(check::Request),
    /// Reads the scene of the second part, and simulates it if it is right.
    Simulate(film::Request),
    /// The trace of the scene that was simulated last.
    Trace,
    /// A picture of its motion.
    Picture(film::Picture),
    /// Its motion as a film.
    Film(film::Kind),
    /// Looks at one pair.
    Detect(detect::Request),
}

/// An answer: a value, and the byte strings that belong to it.
pub(crate) type Answer = Result<(Value, Vec<Vec<u8>>), String>;

/// What is kept between requests: the motion of the scene that was simulated last.
#[derive(Debug, Default)]
pub struct Session {
    film: Option<Film>,
}

impl Session {
    /// Answers a request. The first part of an answer is JSON: what was asked for, or `{"error": "words"}`.
    #[must_use]
    pub fn answer(&mut self, request: &[u8], host: &dyn Host) -> Vec<u8> {
        let (value, bytes) = self.parsed(request, host).unwrap_or_else(|error| (json!({ "error": error }), Vec::new()));
        let value = value.to_string();
        let all: Vec<&[u8]> = std::iter::once(value.as_bytes()).chain(bytes.iter().map(Vec::as_slice)).collect();
        parts::joined(&all)
    }

    fn parsed(&mut self, request: &[u8], host: &dyn Host) -> Answer {
        let parts = parts::split(request).ok_or("the request is cut")?;
        let (first, rest) = parts.split_first().ok_or("the request is empty")?;
        let request = serde_json::from_slice(first).map_err(|error| format!("the request can't be read: {error}"))?;
        let xml = rest.first().copied();
        let last = || "no scene has been simulated".to_owned();
        match request {
            Request::Scenes => Ok((scenes::list(), Vec::new())),
            Request::Scene { name } => Ok((json!({}), vec![scenes::xml(&name)?.to_vec()])),
            Request::Recognise { file } => Ok((json!({ "scenes": scenes::beginning(file, host) }), Vec::new())),
            Request::Check(request) => check::answer(&request, xml, host),
            Request::Simulate(request) => {
                let (value, film) = film::simulate(&request, xml.ok_or("the scene is missing")?, host);
                self.film = film;
                Ok((value, Vec::new()))
            }
            Request::Trace => Ok((json!({}), vec![self.film.as_ref().ok_or_else(last)?.trace(host)?])),
            Request::Picture(picture) => self.film.as_mut().ok_or_else(last)?.picture(&picture),
            Request::Film(kind) => self.film.as_ref().ok_or_else(last)?.film(&kind, host),
            Request::Detect(request) => detect::answer(&request),
        }
    }
}
