//! Writes shapes as SVG: plain elements, fixed decimals, no scripts, no styles.
use crate::{
    color::Rgb,
    number::format_pixel,
    shape::{Paint, Point, Shape},
    size::Size,
};
use std::fmt::Write;

/// Returns a picture as an SVG document. `title` is for screen readers.
pub fn render_document(size: Size, background: Rgb, title: &str, shapes: &[Shape]) -> String {
    let (width, height) = (size.width(), size.height());
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} \
         {height}\" role=\"img\">\n<title>{}</title>\n<rect width=\"{width}\" height=\"{height}\" fill=\"{}\"/>\n",
        escape(title),
        background.hex()
    );
    for shape in shapes {
        write_element(shape, &mut svg);
    }
    svg += "</svg>\n";
    svg
}

/// Escapes a text for an element or attribute. Characters that XML does not allow are replaced.
pub fn escape(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => safe += "&amp;",
            '<' => safe += "&lt;",
            '>' => safe += "&gt;",
            '"' => safe += "&quot;",
            '\'' => safe += "&#39;",
            '\t' | '\n' => safe.push(' '),
            // Characters that change the reading direction could make two names look the same.
            '\u{0}'..='\u{1f}' | '\u{7f}'..='\u{9f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => {
                safe.push('\u{fffd}');
            }
            '\u{200e}' | '\u{200f}' | '\u{61c}' | '\u{fffe}' | '\u{ffff}' => safe.push('\u{fffd}'),
            letter => safe.push(letter),
        }
    }
    safe
}

fn write_element(shape: &Shape, svg: &mut String) {
    // Writing to a string never fails.
    let _ = match shape {
        Shape::Disc { center: [x, y], radius, paint } => {
            let (x, y, radius) = (format_pixel(*x), format_pixel(*y), format_pixel(*radius));
            writeln!(svg, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" {}/>", format_area(*paint))
        }
        Shape::Line { points, width, paint } => {
            let dash = if matches!(paint, Paint::Dashed(_)) { DASH } else { "" };
            let cap = if dash.is_empty() { "round" } else { "butt" };
            writeln!(
                svg,
                "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\"{} stroke-width=\"{}\" stroke-linecap=\"{cap}\" \
                 stroke-linejoin=\"round\"{dash}/>",
                format_points(points),
                paint.color().hex(),
                render_opacity("stroke", *paint),
                format_pixel(*width)
            )
        }
        Shape::Area { points, paint } => {
            writeln!(svg, "<polygon points=\"{}\" {}/>", format_points(points), format_area(*paint))
        }
        Shape::Text { place: [x, y], text, color } => writeln!(
            svg,
            "<text x=\"{}\" y=\"{}\" fill=\"{}\" font-family=\"monospace\" font-size=\"14\">{}</text>",
            format_pixel(*x),
            format_pixel(*y),
            color.hex(),
            escape(text)
        ),
    };
}

const DASH: &str = " stroke-dasharray=\"6 4\"";

fn format_area(paint: Paint) -> String {
    match paint {
        Paint::Solid(color) => format!("fill=\"{}\"", color.hex()),
        Paint::Faint(color, _) => format!("fill=\"{}\"{}", color.hex(), render_opacity("fill", paint)),
        Paint::Dashed(color) => format!("fill=\"none\" stroke=\"{}\" stroke-width=\"2\"{DASH}", color.hex()),
    }
}

fn render_opacity(what: &str, paint: Paint) -> String {
    match paint {
        Paint::Faint(_, share) => format!(" {what}-opacity=\"{}\"", format_pixel(share)),
        Paint::Solid(_) | Paint::Dashed(_) => String::new(),
    }
}

fn format_points(points: &[Point]) -> String {
    points.iter().map(|[x, y]| format!("{},{}", format_pixel(*x), format_pixel(*y))).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hostile_text_stays_text() {
        let shapes = [Shape::Text { place: [0.0; 2], text: "</text><script>".into(), color: Rgb::BLACK }];
        let hostile = "<script>alert('x')</script>\u{0}\u{202e}\"&]]>";
        let svg = render_document(Size::new(20, 20).unwrap(), Rgb::WHITE, hostile, &shapes);
        assert!(!svg.contains("<script") && !svg.contains(['\u{0}', '\u{202e}']), "{svg}");
        let mut reader = quick_xml::Reader::from_str(&svg);
        let mut elements = Vec::new();
        loop {
            match reader.read_event().unwrap() {
                quick_xml::events::Event::Eof => break,
                quick_xml::events::Event::Start(tag) | quick_xml::events::Event::Empty(tag) => {
                    elements.push(tag.name().as_ref().to_owned());
                }
                _ => {}
            }
        }
        assert_eq!(elements, ["svg", "title", "rect", "text"]);
    }
}
