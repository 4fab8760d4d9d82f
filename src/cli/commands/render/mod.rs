//! The command `render`, which draws a scene's motion as pictures, as a GIF or as a movie.
mod ffmpeg;
mod motion;

use crate::files::Identity;
use crate::{
    cli::{
        arguments::draw::{RenderArguments, RenderFormat},
        console, exit, input,
        output::{Folder, Output, has_extension},
    },
    render::{
        Extent, Painter, PictureOptions, Raster, Size,
        film::{Gif, Rate, write_png},
        number::format_short,
        shape::Shape,
        svg,
    },
    report::number::format_count,
    scene::Scene,
};
use anyhow::{Context, Result, bail};
use ffmpeg::Ffmpeg;
use motion::{Motion, StepRange};
use std::{
    io::{BufWriter, Write},
    path::Path,
};

/// The number of pictures from which films skip steps, unless `--every` is given. It is enough for a minute at 25
/// pictures per second.
const LONG_FILM: u32 = 1500;

/// The maximum number of pictures that one command draws.
const MAX_PICTURES: u32 = 100_000;

pub(super) fn run(arguments: &RenderArguments) -> Result<u8> {
    let form = output_format(arguments)?;
    let scene = input::read_scene(&arguments.scene)?;
    let picks = select_steps(arguments, form, &scene.scene)?;
    let Some(rate) = Rate::new(arguments.fps) else {
        bail!("--fps must be between 1 and {}", crate::render::film::MAX_RATE)
    };
    // The output is checked first. If it is invalid, this is reported before the work begins.
    let target = RenderTarget::open(form, arguments)?;
    let main = match &arguments.trace {
        Some(trace) => motion::read_motion(&scene.scene, trace, picks)?,
        None => motion::simulate_reference(&scene.scene, picks)?,
    };
    let overlay = &arguments.overlay;
    let overlay = overlay.as_ref().map(|trace| motion::read_motion(&scene.scene, trace, picks)).transpose()?;
    if main.pictures == 0 {
        let reason = main.stop_reason.map_or_else(String::new, |reason| format!(": {reason}"));
        bail!("there is nothing to draw of {}{reason}", main.name);
    }
    let stopped: Vec<String> = [Some(&main), overlay.as_ref()]
        .into_iter()
        .flatten()
        .filter_map(|motion| Some(format!("{} ends early: {}\n", motion.name, motion.stop_reason.as_ref()?)))
        .collect();
    let options = PictureOptions { size: arguments.size, label: !arguments.no_label };
    let mut reel = DrawableMotion::new(&scene.scene, main, overlay, options, picks);
    let to_stdout = matches!(target, RenderTarget::Stream(_)) && arguments.output == Path::new("-");
    let output = input::printable_name(&arguments.output);
    let drawn = target.draw(form, &mut reel, rate).map_err(|error| match error.is::<std::io::Error>() {
        true => error.context(format!("cannot write {output}")),
        false => error,
    })?;
    stopped.iter().for_each(console::print_error);
    let summary = format!("{drawn} into {output}\n");
    if to_stdout {
        console::print_error(&summary);
    } else {
        console::report(&summary)?;
    }
    Ok(if stopped.is_empty() { exit::ACCEPTED } else { exit::NOT_ACCEPTED })
}

/// Returns the format of the output, according to `--format` or its name. With `--step`, SVG and PNG are a single
/// picture; otherwise they are a folder with a picture for each step.
fn output_format(arguments: &RenderArguments) -> Result<RenderFormat> {
    let (output, is_single) = (&arguments.output, arguments.step.is_some());
    let by_name = |extension: &str| has_extension(output, extension);
    let format = match arguments.format {
        Some(format) => format,
        None if by_name("gif") => RenderFormat::Gif,
        None if by_name("mp4") => RenderFormat::Mp4,
        None if by_name("svg") && is_single => RenderFormat::Svg,
        None if by_name("png") && is_single => RenderFormat::Png,
        None if by_name("svg") || by_name("png") => bail!(
            "{} can hold one picture: add --step N, or name a folder and add --format svg or --format png; a name that \
             ends in .gif becomes a film",
            output.display()
        ),
        None => bail!(
            "choose the format of {}: --format svg or --format png for a folder with a picture per step, or a name \
                that \
             ends in .gif or .mp4",
            output.display()
        ),
    };
    let size = arguments.size;
    if is_film(format) && is_single {
        bail!("--step is for one picture: add --format svg or --format png");
    }
    if format == RenderFormat::Mp4 && size.width() % 2 + size.height() % 2 > 0 {
        bail!("an MP4 needs even width and height, not {size}; choose another --size");
    }
    Ok(format)
}

/// Returns whether the pictures form a film, which begins at the start of the scene.
const fn is_film(form: RenderFormat) -> bool {
    matches!(form, RenderFormat::Gif | RenderFormat::Mp4)
}

/// Returns the steps for which pictures are drawn.
fn select_steps(arguments: &RenderArguments, form: RenderFormat, scene: &Scene) -> Result<StepRange> {
    let last = scene.step_count();
    if let Some(step) = arguments.step {
        if step > last {
            bail!("the scene has {}; there is no step {step}", format_count(last.into(), "step"));
        }
        // The path of a particle consists of its earlier positions, so they are needed.
        let first = if scene.display.paths.is_empty() { step } else { 0 };
        return Ok(StepRange { first, every: 1, last: step });
    }
    let every = match arguments.every {
        Some(every) => every.get(),
        None if is_film(form) => last.div_ceil(LONG_FILM).max(1),
        None => 1,
    };
    // The first picture of the original shows the state after the first step.
    let first = if is_film(form) { 0 } else { every };
    let picks = StepRange { first, every, last };
    let count = picks.count();
    if count > MAX_PICTURES {
        let min_interval = last.div_ceil(MAX_PICTURES - 1);
        bail!("this would draw {count} pictures, more than the limit of {MAX_PICTURES}; add --every {min_interval}");
    }
    if count == 0 {
        let steps = format_count(last.into(), "step");
        bail!("no step is drawn: the scene has {steps}, and --every {every} is requested");
    }
    Ok(picks)
}

/// A motion, and everything that is needed to draw it.
struct DrawableMotion {
    painter: Painter,
    main: Motion,
    overlay: Option<Motion>,
    steps: StepRange,
    is_single: bool,
}

impl DrawableMotion {
    fn new(scene: &Scene, main: Motion, overlay: Option<Motion>, options: PictureOptions, picks: StepRange) -> Self {
        let mut extent = main.extent;
        if let Some(overlay) = &overlay {
            extent.join(&overlay.extent);
        }
        let start: Vec<f64> = scene.particles.iter().flat_map(|p| [p.position.x, p.position.y]).collect();
        let start = Extent::for_scene(scene, &start);
        extent.join(&start);
        let painter = Painter::new(scene, &extent.limit_to(&start), options);
        Self { painter, main, overlay, steps: picks, is_single: false }
    }

    fn size(&self) -> Size {
        self.painter.size()
    }

    /// Draws every picture, and passes it to `draw`: its number from 1, its step, and its shapes.
    fn for_each(&mut self, mut draw: impl FnMut(u32, u32, &[Shape]) -> Result<()>) -> Result<()> {
        let (mut positions, mut other) = (Vec::new(), Vec::new());
        let mut bar = console::Bar::new(self.main.pictures);
        for number in 1..=self.main.pictures {
            let step = self.steps.step(number);
            if !self.main.next(&mut positions)? {
                bail!("the stored motion of {} changed while it was being read", self.main.name);
            }
            let overlaid = match &mut self.overlay {
                Some(overlay) => overlay.next(&mut other)?,
                None => false,
            };
            let shapes = self.painter.picture(step, &positions, overlaid.then_some(&other[..]));
            if !self.is_single || number == self.main.pictures {
                draw(number, step, &shapes)?;
            }
            bar.show_step(number);
        }
        Ok(())
    }

    /// Draws every picture in pixels, and passes it to `take`.
    fn for_each_raster(&mut self, mut take: impl FnMut(u32, &Raster) -> Result<()>) -> Result<()> {
        let mut raster = Raster::new(self.size());
        let background = self.painter.background();
        self.for_each(|number, _, shapes| {
            raster.draw(background, shapes);
            take(number, &raster)
        })
    }
}

/// The place to which pictures are written, and their format.
enum RenderTarget {
    Folder(Folder),
    Stream(Output),
}

impl RenderTarget {
    fn open(form: RenderFormat, arguments: &RenderArguments) -> Result<Self> {
        let inputs: Vec<Identity> = [Some(&arguments.scene), arguments.trace.as_ref(), arguments.overlay.as_ref()]
            .into_iter()
            .flatten()
            .filter_map(|name| Some(Identity::from_metadata(&std::fs::metadata(name).ok()?)))
            .collect();
        if form == RenderFormat::Mp4 {
            Ffmpeg::find()?;
        }
        Ok(match is_film(form) || arguments.step.is_some() {
            true => Self::Stream(Output::create(&arguments.output, &inputs)?),
            false => Self::Folder(Folder::open(&arguments.output)?),
        })
    }

    /// Draws all pictures, and describes the result for the user.
    fn draw(self, form: RenderFormat, reel: &mut DrawableMotion, rate: Rate) -> Result<String> {
        let (pictures, size) = (reel.main.pictures, reel.size());
        let steps = match (reel.steps.step(1), reel.steps.step(pictures)) {
            (first, last) if first == last => format!("step {first}"),
            (first, last) => format!("steps {first} to {last}"),
        };
        let counted_pictures = format_count(pictures.into(), "picture");
        let every = match reel.steps.every {
            1 => String::new(),
            every => format!(", every {every}th"),
        };
        let film = |bytes: u64| {
            let seconds = format_short(f64::from(pictures) / f64::from(rate.per_second()));
            let bytes = if bytes > 0 { format!(", {}", format_count(bytes, "byte")) } else { String::new() };
            let per_second = rate.per_second();
            format!("{counted_pictures} of {size}: {steps}{every}, {per_second} per second, {seconds} s{bytes},")
        };
        match (self, form) {
            (Self::Folder(folder), form) => {
                let names = |number: u32| match form {
                    // These are the names that the original gives to its pictures.
                    RenderFormat::Svg => format!("frame{number:020}.svg"),
                    _ => format!("frame{number:05}.png"),
                };
                let background = reel.painter.background();
                let mut raster = Raster::new(size);
                reel.for_each(|number, step, shapes| {
                    let bytes = picture(form, &mut raster, background, step, shapes)?;
                    folder.write(&names(number), &bytes)
                })?;
                if folder.contains(&names(pictures + 1)) {
                    let line =
                        format!("{} also contains older pictures, from {} on\n", folder.name(), names(pictures + 1));
                    console::print_error(&line);
                }
                let files = match pictures {
                    1 => names(1),
                    _ => format!("{} to {}", names(1), names(pictures)),
                };
                Ok(format!("{counted_pictures} of {size}: {steps}{every}, {files},"))
            }
            (Self::Stream(mut output), RenderFormat::Svg | RenderFormat::Png) => {
                reel.is_single = true;
                let background = reel.painter.background();
                let mut raster = Raster::new(size);
                reel.for_each(|_, step, shapes| {
                    let bytes = picture(form, &mut raster, background, step, shapes)?;
                    Ok(output.write_all(&bytes)?)
                })?;
                output.finish()?;
                Ok(format!("A picture of {size}: step {},", reel.steps.last.min(reel.steps.step(pictures))))
            }
            (Self::Stream(output), RenderFormat::Mp4) => {
                let mut encoder = Ffmpeg::start(size, rate, output)?;
                // If ffmpeg ends early, its own messages explain more than a closed pipe.
                let drawn = reel.for_each_raster(|_, raster| encoder.write_picture(raster.rgba()));
                encoder.finish(drawn)?;
                Ok(film(0))
            }
            (Self::Stream(output), _) => {
                let mut out = CountedWriter { out: BufWriter::new(output), bytes: 0 };
                let mut gif = Gif::new(&mut out, size, rate, &reel.painter.colors())?;
                reel.for_each_raster(|_, raster| Ok(gif.write_picture(raster)?))?;
                gif.finish()?;
                let bytes = out.bytes;
                out.out.into_inner().map_err(std::io::IntoInnerError::into_error)?.finish()?;
                Ok(film(bytes))
            }
        }
    }
}

/// Returns one picture in the format of its file.
fn picture(
    form: RenderFormat,
    raster: &mut Raster,
    background: crate::render::color::Rgb,
    step: u32,
    shapes: &[Shape],
) -> Result<Vec<u8>> {
    if form == RenderFormat::Svg {
        return Ok(svg::render_document(raster.size(), background, &format!("step {step}"), shapes).into_bytes());
    }
    raster.draw(background, shapes);
    let mut bytes = Vec::new();
    write_png(raster, &mut bytes).context("the picture can't be encoded")?;
    Ok(bytes)
}

/// A writer that counts the bytes that were written.
struct CountedWriter<W> {
    out: W,
    bytes: u64,
}

impl<W: Write> Write for CountedWriter<W> {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        let count = self.out.write(bytes)?;
        self.bytes += count as u64;
        Ok(count)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.out.flush()
    }
}
