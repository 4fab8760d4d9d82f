//! Converts the positions of a scene's bodies to the shapes of a picture.
use crate::{
    clip::ClipRectangle,
    color::Rgb,
    number::format_short,
    shape::{Paint, Point, Shape},
    size::Size,
    view::{Extent, View},
};
use fosssim_model::scene::{Color, Scene};
use fosssim_num::vector::{Vec2, vector_at};
use std::collections::VecDeque;

/// The minimum width of discs and lines, in pixels. Narrower ones would be invisible.
const MIN_WIDTH: f64 = 1.5;

/// The opacity of a half-plane's inside.
const INSIDE_DEPTH: f64 = 0.25;

/// The radius in pixels above which discs are drawn as half-planes, because they look like half-planes in the picture.
const MAX_DISC_RADIUS: f64 = 100_000.0;

/// The maximum number of points drawn of a particle's path; some of the older points are dropped.
const MAX_PATH_POINTS: usize = 2000;

/// The size of a picture, and what it shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PictureOptions {
    /// The size of the picture.
    pub size: Size,
    /// Whether the picture shows the step and the time in its lower left corner.
    pub label: bool,
}

/// Draws the bodies of one scene.
#[derive(Debug, Clone)]
pub struct Painter {
    view: View,
    label: bool,
    time_step: f64,
    background: Rgb,
    radii: Vec<f64>,
    particles: Vec<Rgb>,
    edges: Vec<([usize; 2], f64, Rgb)>,
    half_planes: Vec<(Vec2, Vec2, Rgb)>,
    trails: Vec<Trail>,
}

/// The path of a particle.
#[derive(Debug, Clone)]
struct Trail {
    particle: usize,
    color: Rgb,
    duration: f64,
    /// The times and positions, oldest first.
    points: VecDeque<(f64, Vec2)>,
}

impl Painter {
    /// Creates a painter whose pictures show all of `extent`, or the scene's own viewport.
    pub fn new(scene: &Scene, extent: &Extent, options: PictureOptions) -> Self {
        let display = &scene.display;
        // Later elements override earlier ones. Invalid indices are undefined behavior in the original, and color
        // nothing here.
        let colored = |count: usize, default: Rgb, list: &[(usize, Color)]| {
            let mut colors = vec![default; count];
            for &(index, color) in list {
                if let Some(entry) = colors.get_mut(index) {
                    *entry = color.into();
                }
            }
            colors
        };
        let particles = colored(scene.particles.len(), Rgb::PARTICLE, &display.particle_colors);
        let edges = colored(scene.edges.len(), Rgb::EDGE, &display.edge_colors);
        let half_planes = colored(scene.half_planes.len(), Rgb::BLACK, &display.half_plane_colors);
        let paths = display.paths.iter().filter(|path| path.particle < scene.particles.len());
        Self {
            view: View::for_scene(scene, extent, options.size),
            label: options.label,
            time_step: scene.time_step,
            background: display.background.map_or(Rgb::WHITE, Rgb::from),
            radii: scene.particles.iter().map(|particle| particle.radius).collect(),
            particles,
            edges: scene.edges.iter().zip(edges).map(|(e, color)| ([e.first, e.second], e.radius, color)).collect(),
            half_planes: scene.half_planes.iter().zip(half_planes).map(|(h, c)| (h.point, h.normal, c)).collect(),
            trails: paths
                .map(|path| Trail {
                    particle: path.particle,
                    color: path.color.into(),
                    duration: path.duration,
                    points: VecDeque::new(),
                })
                .collect(),
        }
    }

    /// Returns the size of the pictures.
    pub const fn size(&self) -> Size {
        self.view.size()
    }

    /// Returns the background color.
    pub const fn background(&self) -> Rgb {
        self.background
    }

    /// Returns all colors in the pictures, the background first.
    pub fn colors(&self) -> Vec<Rgb> {
        let mut colors = vec![self.background, self.background.contrasting_ink(), self.overlay_color()];
        colors.extend(self.trails.iter().map(|trail| trail.color));
        colors.extend(&self.particles);
        colors.extend(self.edges.iter().map(|edge| edge.2));
        colors.extend(self.half_planes.iter().map(|half_plane| half_plane.2));
        let mut seen = std::collections::BTreeSet::new();
        colors.retain(|&color| seen.insert(color));
        colors
    }

    /// Returns the color of a second motion, which contrasts with light and dark backgrounds.
    fn overlay_color(&self) -> Rgb {
        if self.background.brightness() > 127 { Rgb([178, 0, 110]) } else { Rgb([255, 140, 220]) }
    }

    /// Returns the picture after `step` at `positions` (2N, trace order), with those of a second motion on top.
    /// Pictures must be requested in the order of the steps, because particles have trails.
    ///
    /// # Panics
    /// Panics if there are fewer positions than the scene has particles.
    #[must_use]
    pub fn picture(&mut self, step: u32, positions: &[f64], overlay: Option<&[f64]>) -> Vec<Shape> {
        let time = f64::from(step) * self.time_step;
        let mut shapes = Vec::new();
        for &(point, normal, color) in &self.half_planes {
            self.draw_half_plane(point, normal, color, &mut shapes);
        }
        let (view, frame) = (self.view, self.frame(4.0));
        for trail in &mut self.trails {
            trail.extend(time, vector_at(positions, trail.particle));
            trail.draw(&view, &frame, &mut shapes);
        }
        self.draw_bodies(positions, None, &mut shapes);
        if let Some(other) = overlay {
            self.draw_bodies(other, Some(Paint::Dashed(self.overlay_color())), &mut shapes);
        }
        if self.label {
            self.write(step, time, &mut shapes);
        }
        shapes
    }

    /// Draws edges and particles, either in their own colors or as the thin outlines of an overlay.
    fn draw_bodies(&self, positions: &[f64], overlay: Option<Paint>, shapes: &mut Vec<Shape>) {
        for &(ends, radius, color) in &self.edges {
            let [first, second] = ends.map(|end| vector_at(positions, end));
            let radius = if overlay.is_some() { 0.0 } else { radius };
            self.draw_edge(first, second, radius, overlay.unwrap_or(Paint::Solid(color)), shapes);
        }
        for (index, (&radius, &color)) in self.radii.iter().zip(&self.particles).enumerate() {
            self.draw_disc(vector_at(positions, index), radius, overlay.unwrap_or(Paint::Solid(color)), shapes);
        }
    }

    /// Returns the picture's rectangle, widened by `margin` pixels.
    fn frame(&self, margin: f64) -> ClipRectangle {
        let size = self.size();
        ClipRectangle {
            low: [-margin, -margin],
            high: [f64::from(size.width()) + margin, f64::from(size.height()) + margin],
        }
    }

    fn draw_disc(&self, center: Vec2, radius: f64, paint: Paint, shapes: &mut Vec<Shape>) {
        let pixel = self.view.to_pixels(center);
        let radius = self.view.to_pixel_length(radius).max(MIN_WIDTH);
        if !pixel.iter().all(|value| value.is_finite()) || !radius.is_finite() {
            return;
        }
        let frame = self.frame(4.0);
        let nearest: Point = std::array::from_fn(|k| pixel[k].clamp(frame.low[k], frame.high[k]));
        let away = [nearest[0] - pixel[0], nearest[1] - pixel[1]];
        let distance = away[0].hypot(away[1]);
        if distance > radius {
            return;
        }
        if radius < MAX_DISC_RADIUS {
            shapes.push(Shape::Disc { center: pixel, radius, paint });
            return;
        }
        if matches!(paint, Paint::Dashed(_)) {
            return;
        }
        // The edge of such a disc looks straight, and is perpendicular to the direction from its center.
        let points = match distance > 0.0 {
            true => {
                let unit = [away[0] / distance, away[1] / distance];
                frame.clip_half_plane(|[x, y]| radius - ((x - pixel[0]) * unit[0] + (y - pixel[1]) * unit[1]))
            }
            false => frame.clip_half_plane(|_| 1.0),
        };
        shapes.push(Shape::Area { points, paint });
    }

    fn draw_edge(&self, first: Vec2, second: Vec2, radius: f64, paint: Paint, shapes: &mut Vec<Shape>) {
        let wide = 2.0 * self.view.to_pixel_length(radius);
        let width = if wide.is_nan() { MIN_WIDTH } else { wide.clamp(MIN_WIDTH, MAX_DISC_RADIUS) };
        let frame = self.frame(width);
        if let Some(ends) = frame.clip_line(self.view.to_pixels(first), self.view.to_pixels(second)) {
            shapes.push(Shape::Line { points: ends.to_vec(), width, paint });
        }
    }

    fn draw_half_plane(&self, point: Vec2, normal: Vec2, color: Rgb, shapes: &mut Vec<Shape>) {
        let pixel = self.view.to_pixels(point);
        // The y axis points down in the picture.
        let (x, y) = (normal.x, -normal.y);
        let length = x.hypot(y);
        if !(length > 0.0) || !length.is_finite() || !pixel.iter().all(|value| value.is_finite()) {
            return;
        }
        let unit = [x / length, y / length];
        let above = |[x, y]: Point| (x - pixel[0]) * unit[0] + (y - pixel[1]) * unit[1];
        let points = self.frame(4.0).clip_half_plane(|point| -above(point));
        if points.len() > 2 {
            shapes.push(Shape::Area { points, paint: Paint::Faint(color, INSIDE_DEPTH) });
        }
        // The visible part of the boundary, around its point nearest to the middle of the picture.
        let size = self.size();
        let middle = [0.5 * f64::from(size.width()), 0.5 * f64::from(size.height())];
        let distance = above(middle);
        let nearest_point = [middle[0] - distance * unit[0], middle[1] - distance * unit[1]];
        let reach = f64::from(size.width()) + f64::from(size.height());
        let offset = [-unit[1] * reach, unit[0] * reach];
        let ends = [
            [nearest_point[0] - offset[0], nearest_point[1] - offset[1]],
            [nearest_point[0] + offset[0], nearest_point[1] + offset[1]],
        ];
        if let Some(ends) = self.frame(4.0).clip_line(ends[0], ends[1]) {
            shapes.push(Shape::Line { points: ends.to_vec(), width: 2.0, paint: Paint::Solid(color) });
        }
    }

    fn write(&self, step: u32, time: f64, shapes: &mut Vec<Shape>) {
        let position = [8.0, f64::from(self.size().height()) - 8.0];
        let text = format!("step {step}  t {}", format_short(time));
        shapes.push(Shape::Text { place: position, text, color: self.background.contrasting_ink() });
    }
}

impl Trail {
    /// Continues the path to the particle's new position.
    fn extend(&mut self, time: f64, point: Vec2) {
        while self.points.front().is_some_and(|&(then, _)| !(time - then <= self.duration)) {
            self.points.pop_front();
        }
        if self.points.len() >= MAX_PATH_POINTS {
            let mut keep = false;
            self.points.retain(|_| {
                keep = !keep;
                keep
            });
        }
        self.points.push_back((time, point));
    }

    /// Draws the parts of the path that are in the picture.
    fn draw(&self, view: &View, frame: &ClipRectangle, shapes: &mut Vec<Shape>) {
        let mut piece: Vec<Point> = Vec::new();
        let mut finish = |piece: &mut Vec<Point>| {
            if piece.len() > 1 {
                let points = std::mem::take(piece);
                shapes.push(Shape::Line { points, width: MIN_WIDTH, paint: Paint::Solid(self.color) });
            }
            piece.clear();
        };
        for (&(_, from), &(_, to)) in self.points.iter().zip(self.points.iter().skip(1)) {
            let Some([from, to]) = frame.clip_line(view.to_pixels(from), view.to_pixels(to)) else {
                finish(&mut piece);
                continue;
            };
            if piece.last() != Some(&from) {
                finish(&mut piece);
                piece.push(from);
            }
            piece.push(to);
        }
        finish(&mut piece);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fosssim_model::scene::original;

    const SCENE: &str = r#"<scene><duration time="1"/><viewport cx="0" cy="0" size="2"/>
        <backgroundcolor r="0" g="0" b="0.2"/><integrator type="explicit-euler" dt="0.1"/>
        <particle m="1" px="-1" py="0" vx="0" vy="0" fixed="0" radius="0.5"/>
        <particle m="1" px="1" py="0" vx="0" vy="0" fixed="0" radius="0.25"/>
        <edge i="0" j="1" radius="0.1"/><halfplane px="0" py="-1" nx="0" ny="3"/>
        <particlecolor i="1" r="1" g="0" b="0"/><particlecolor i="1" r="0" g="1" b="0"/>
        <particlepath i="1" duration="0.25" r="1" g="1" b="0"/></scene>"#;

    fn painter(xml: &str) -> Painter {
        let scene = original::read(xml.as_bytes()).unwrap().scene;
        Painter::new(&scene, &Extent::default(), PictureOptions { size: Size::new(400, 400).unwrap(), label: true })
    }

    #[test]
    fn bodies_have_the_scenes_own_colors_and_places() {
        let shapes = painter(SCENE).picture(3, &[-1.0, 0.0, 1.0, 0.0], None);
        let green = Paint::Solid(Rgb([0, 255, 0]));
        assert!(shapes.contains(&Shape::Disc {
            center: [100.0, 200.0],
            radius: 50.0,
            paint: Paint::Solid(Rgb::PARTICLE)
        }));
        assert!(shapes.contains(&Shape::Disc { center: [300.0, 200.0], radius: 25.0, paint: green }));
        let line =
            Shape::Line { points: vec![[100.0, 200.0], [300.0, 200.0]], width: 20.0, paint: Paint::Solid(Rgb::EDGE) };
        assert!(shapes.contains(&line), "{shapes:?}");
        // The half-plane's inside is below its boundary, where y is larger.
        let Shape::Area { points, .. } = &shapes[0] else { panic!("{shapes:?}") };
        assert!(points.iter().all(|point| point[1] >= 300.0), "{points:?}");
        let text = Shape::Text { place: [8.0, 392.0], text: "step 3  t 0.3".into(), color: Rgb::WHITE };
        assert_eq!(shapes.last(), Some(&text));
    }

    #[test]
    fn a_second_motion_is_dashed() {
        let shapes = painter(SCENE).picture(0, &[-1.0, 0.0, 1.0, 0.0], Some(&[-1.0, 0.5, 1.0, 0.5]));
        let dashed = shapes.iter().filter(|shape| {
            matches!(shape, Shape::Disc { paint: Paint::Dashed(_), .. } | Shape::Line { paint: Paint::Dashed(_), .. })
        });
        assert_eq!(dashed.count(), 3);
    }

    #[test]
    fn paths_last_as_long_as_the_scene_says() {
        let mut painter = painter(SCENE);
        let yellow = Paint::Solid(Rgb([255, 255, 0]));
        let lengths: Vec<usize> = (0..6)
            .map(|step| {
                let x = 1.0 - 0.1 * f64::from(step);
                let shapes = painter.picture(step, &[-1.0, 0.0, x, 0.0], None);
                let path = shapes.iter().find_map(|shape| match shape {
                    Shape::Line { points, paint, .. } if *paint == yellow => Some(points.len()),
                    _ => None,
                });
                path.unwrap_or(0)
            })
            .collect();
        assert_eq!(lengths, [0, 2, 3, 3, 3, 3]);
    }

    #[test]
    fn bodies_without_a_place_and_very_far_ones_are_left_out() {
        let mut painter = painter(SCENE);
        for positions in
            [[f64::NAN, 0.0, f64::INFINITY, 0.0], [1e300, 1e300, -1e300, 0.0], [1e9, 0.0, f64::NAN, f64::NAN]]
        {
            let shapes = painter.picture(0, &positions, Some(&positions));
            assert!(!shapes.iter().any(|shape| matches!(shape, Shape::Disc { .. })), "{positions:?}");
        }
        let huge = SCENE.replace(r#"radius="0.5""#, r#"radius="1e9""#);
        let shapes = self::painter(&huge).picture(0, &[-1e9, 0.0, 1.0, 0.0], None);
        let Some(Shape::Area { points, .. }) = shapes.get(shapes.len() - 3) else { panic!("{shapes:?}") };
        // The half-plane's edge is in the middle of the image.
        assert!(points.iter().all(|point| point[0] < 200.1), "{points:?}");
    }
}
