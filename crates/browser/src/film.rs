//! A scene in the editor: the problems that the strict reader finds, and the reference's motion.
use crate::{dropped::PageHost, parts::PageAnswer};
use fosssim_model::{
    scene::{self, LoadedScene, Problem, Scene, Severity},
    sim::{RootSearch, Simulation},
    trace::{Layout, Recorder},
};
use fosssim_render::{
    Extent, Painter, PictureOptions, Raster, Size,
    film::{Gif, Rate, write_png},
    svg,
};
use fosssim_report::describe::describe_step_error;
use serde::Deserialize;
use serde_json::{Value, json};
use std::io::{self, Write};

/// The maximum number of values of a motion that are kept. The largest course scene has 70,444 values.
const MAX_NUMBERS: usize = 1 << 24;

/// The maximum size of a trace that is created as a whole, in bytes.
const MAX_TRACE_BYTES: usize = 1 << 30;

/// The number of pictures from which a film leaves some out. It is the same as for films of the command line.
const MAX_PICTURES: u32 = 1500;

/// The number of pictures per second in a film.
const PICTURES_PER_SECOND: u16 = 25;

/// The number of steps after which progress is reported again.
const STEPS_PER_REPORT: u32 = 64;

/// A request for one picture of the motion.
#[derive(Debug, Deserialize)]
pub(crate) struct PictureRequest {
    step: u32,
    width: u32,
    height: u32,
    form: PictureForm,
}

/// The form in which a picture is returned.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum PictureForm {
    /// The picture as four bytes per pixel, for a canvas.
    Pixels,
    Png,
    Svg,
}

/// The format and the size of a film.
#[derive(Debug, Deserialize)]
pub(crate) struct FilmKind {
    width: u32,
    height: u32,
}

/// The motion of the scene in the editor.
#[derive(Debug)]
pub(crate) struct Film {
    scene: Scene,
    /// The positions of all particles after each step, beginning with the start of the scene.
    positions: Vec<f64>,
    steps: u32,
    extent: Extent,
    /// The painter, the step of its next picture, and whether its pictures have labels. Pictures must be painted in
    /// order, because particles have trails.
    painter: Option<(Painter, u32, bool)>,
}

/// Reads a scene. If it has no errors, it is also simulated.
pub(crate) fn simulate(name: &str, xml: &[u8], host: &dyn PageHost) -> (Value, Option<Film>) {
    let (scene, problems, omitted_count) = match scene::read(name, xml) {
        Ok(LoadedScene { scene, warnings, .. }) => (Some(scene), warnings, 0),
        Err(errors) => (None, errors.list, errors.omitted_count),
    };
    let problems: Vec<Value> = problems.iter().map(problem_view).collect();
    let Some(scene) = scene else { return (json!({ "problems": problems, "more": omitted_count }), None) };
    let (film, stopped) = Film::for_scene(scene, host);
    let Film { scene, steps, .. } = &film;
    let value = json!({
        "problems": problems,
        "more": omitted_count,
        "steps": steps,
        "of": scene.step_count(),
        "dt": scene.time_step,
        "particles": scene.particles.len(),
        "edges": scene.edges.len(),
        "halfPlanes": scene.half_planes.len(),
        "stopped": stopped,
    });
    (value, Some(film))
}

fn problem_view(problem: &Problem) -> Value {
    let Problem { severity, line, column, span, message, help, is_markup, .. } = problem;
    json!({
        "error": *severity == Severity::Error, "line": line, "column": column, "from": span.start, "to": span.end,
        "message": message, "help": help, "isMarkup": is_markup,
    })
}

impl Film {
    /// Simulates a scene. If the motion ends before the scene does, the reason is returned as well.
    fn for_scene(scene: Scene, host: &dyn PageHost) -> (Self, Option<String>) {
        let mut simulation = Simulation::new(&scene, RootSearch::OnDemand);
        let mut positions = simulation.state().positions.clone();
        let start = Extent::for_scene(&scene, &positions);
        let (mut extent, mut steps, mut stopped) = (start, 0, None);
        for step in 1..=scene.step_count() {
            if positions.len() + 2 * scene.particles.len() > MAX_NUMBERS {
                stopped = Some(format!("the motion is too long to be shown from step {step} on"));
                break;
            }
            if let Err(error) = simulation.step(&mut ()) {
                stopped = Some(describe_step_error(&error));
                break;
            }
            extent.add(&scene, &simulation.state().positions);
            positions.extend(&simulation.state().positions);
            steps = step;
            if step % STEPS_PER_REPORT == 0 {
                host.progress(step, scene.step_count());
            }
        }
        let extent = extent.limit_to(&start);
        (Self { scene, positions, steps, extent, painter: None }, stopped)
    }

    fn step_positions(&self, step: u32) -> &[f64] {
        let width = 2 * self.scene.particles.len();
        &self.positions[step as usize * width..][..width]
    }

    fn painter(&self, size: Size, label: bool) -> Painter {
        Painter::new(&self.scene, &self.extent, PictureOptions { size, label })
    }

    /// Returns one picture, as the second part of the answer.
    pub(crate) fn draw_requested_picture(&mut self, request: &PictureRequest) -> PageAnswer {
        let size = Size::new(request.width, request.height).map_err(|error| error.to_string())?;
        let step = request.step.min(self.steps);
        // The page itself shows the step and the time, so the picture omits them.
        let label = !matches!(request.form, PictureForm::Pixels);
        let is_earlier =
            |(painter, next, has): &(Painter, u32, bool)| *next <= step && painter.size() == size && *has == label;
        let last = self.painter.take().filter(is_earlier);
        let (mut painter, mut next, _) = last.unwrap_or_else(|| (self.painter(size, label), 0, label));
        if self.scene.display.paths.is_empty() {
            next = step;
        }
        let mut shapes = Vec::new();
        for step in next..=step {
            shapes = painter.picture(step, self.step_positions(step), None);
        }
        let background = painter.background();
        let rasterize = || {
            let mut raster = Raster::new(size);
            raster.draw(background, &shapes);
            raster
        };
        let bytes = match request.form {
            PictureForm::Svg => svg::render_document(size, background, &format!("step {step}"), &shapes).into_bytes(),
            PictureForm::Pixels => rasterize().rgba().to_vec(),
            PictureForm::Png => {
                let mut packed = Vec::new();
                write_png(&rasterize(), &mut packed)
                    .map_err(|error| format!("the picture can't be encoded: {error}"))?;
                packed
            }
        };
        self.painter = Some((painter, step + 1, label));
        Ok((json!({ "step": step }), vec![bytes]))
    }

    /// Returns all pictures as a film, as `render` draws them.
    pub(crate) fn draw_film(&self, kind: &FilmKind, host: &dyn PageHost) -> PageAnswer {
        let size = Size::new(kind.width, kind.height).map_err(|error| error.to_string())?;
        let rate = Rate::new(PICTURES_PER_SECOND).ok_or("the frame rate is invalid")?;
        let every = self.steps.div_ceil(MAX_PICTURES).max(1);
        let pictures = self.steps / every + 1;
        let (mut painter, mut raster, mut bytes) = (self.painter(size, true), Raster::new(size), Vec::new());
        let (background, colors) = (painter.background(), painter.colors());
        let mut draw = |take: &mut dyn FnMut(&Raster) -> io::Result<()>| -> io::Result<()> {
            for (number, step) in (0..).zip((0..=self.steps).step_by(every as usize)) {
                let shapes = painter.picture(step, self.step_positions(step), None);
                raster.draw(background, &shapes);
                take(&raster)?;
                host.progress(number, pictures);
            }
            Ok(())
        };
        let encoded = Gif::new(&mut bytes, size, rate, &colors).and_then(|mut film| {
            draw(&mut |raster| film.write_picture(raster))?;
            film.finish()
        });
        encoded.map_err(|error| format!("the film can't be encoded: {error}"))?;
        Ok((json!({ "pictures": pictures }), vec![bytes]))
    }

    /// Returns the reference's trace. It has the same bytes as the output of `simulate`.
    pub(crate) fn trace(&self, host: &dyn PageHost) -> Result<Vec<u8>, String> {
        let mut simulation = Simulation::new(&self.scene, RootSearch::OnDemand);
        let buffer = TraceBuffer(Vec::new());
        let mut recorder = Recorder::start(buffer, Layout::for_scene(&self.scene), simulation.state());
        for step in 1..=self.scene.step_count() {
            if let Err(error) = simulation.step(&mut recorder) {
                return Err(format!("the trace cannot be written: {}", describe_step_error(&error)));
            }
            if recorder.has_failed() {
                break;
            }
            if step % STEPS_PER_REPORT == 0 {
                host.progress(step, self.scene.step_count());
            }
        }
        let (buffer, _) = recorder.finish().map_err(
            |_| "the trace exceeds 1 GiB, the limit in a browser: use the command `fosssim-oracle simulate`",
        )?;
        Ok(buffer.0)
    }
}

/// The buffer in memory for one trace.
struct TraceBuffer(Vec<u8>);

impl Write for TraceBuffer {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.0.len() + bytes.len() > MAX_TRACE_BYTES {
            return Err(io::Error::other("too long"));
        }
        self.0.extend(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
