//! The timing scenes of the contest, which are as large as the course's. They are generated when they are needed,
//! because their files would take several megabytes.
use std::{fmt::Write, sync::OnceLock};

/// A scene that is generated when it is needed.
pub struct GeneratedScene {
    /// The name of the scene, in the same form as for embedded scenes.
    pub name: &'static str,
    generate: fn() -> String,
    text: OnceLock<String>,
}

/// All timing scenes, in alphabetical order.
pub static TIMING_SCENES: [GeneratedScene; 2] = [
    GeneratedScene { name: "TimingTests/box-of-balls", generate: box_of_balls, text: OnceLock::new() },
    GeneratedScene { name: "TimingTests/pile-of-ribbons", generate: pile_of_ribbons, text: OnceLock::new() },
];

impl GeneratedScene {
    /// Returns the content of the scene's file.
    pub fn xml(&'static self) -> &'static [u8] {
        self.text.get_or_init(self.generate).as_bytes()
    }
}

/// A linear congruential generator of pseudo-random whole numbers below 1000.
struct PseudoRandomNumbers(u32);

impl PseudoRandomNumbers {
    fn next(&mut self) -> i32 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.0 >> 8).cast_signed() % 1000
    }
}

/// Formats a number of thousandths as a decimal number.
fn format_thousandths(number: i32) -> String {
    format!("{}{}.{:03}", if number < 0 { "-" } else { "" }, number.abs() / 1000, number.abs() % 1000)
}

fn begin_scene(description: &str, stiffness: u32) -> String {
    format!(
        "<scene>\n<description text=\"{description}\"/>\n<duration time=\"0.2\"/>\n\
         <integrator type=\"forward-backward-euler\" dt=\"0.01\"/>\n\
         <collision type=\"penalty\" k=\"{stiffness}\" thickness=\"0\"/>\n<collisiondetection type=\"contest\"/>\n"
    )
}

/// Adds a particle to a scene. Its position and its velocity are in thousandths.
fn add_particle(text: &mut String, position: [i32; 2], velocity: [i32; 2], radius: i32, fixed: bool) {
    let ([px, py], [vx, vy]) = (position.map(format_thousandths), velocity.map(format_thousandths));
    let (radius, fixed) = (format_thousandths(radius), u8::from(fixed));
    let _ = writeln!(
        text,
        "<particle m=\"1\" px=\"{px}\" py=\"{py}\" vx=\"{vx}\" vy=\"{vy}\" fixed=\"{fixed}\" radius=\"{radius}\"/>"
    );
}

/// Returns a scene of 15,000 balls in a box of four edges. Each ball is close to its neighbors, and a few balls are
/// fast.
fn box_of_balls() -> String {
    let mut text = begin_scene("15,000 balls in a box of four edges. The time that it takes counts.", 100);
    let mut drawn = PseudoRandomNumbers(1);
    for corner in [[-400, -400], [30_400, -400], [30_400, 20_400], [-400, 20_400]] {
        add_particle(&mut text, corner, [0; 2], 400, true);
    }
    for index in 0..15_000 {
        let (column, row) = (index % 150, index / 150);
        let position = [200 * column + 100 + drawn.next() / 20, 200 * row + 100 + drawn.next() / 20];
        let haste = if drawn.next() < 10 { 20 } else { 1 };
        let velocity = [haste * (drawn.next() - 500), haste * (drawn.next() - 500)];
        add_particle(&mut text, position, velocity, 80 + drawn.next() / 50, false);
    }
    for edge in 0..4 {
        let _ = writeln!(text, "<edge i=\"{edge}\" j=\"{}\" radius=\"0.4\"/>", (edge + 1) % 4);
    }
    text + "</scene>\n"
}

/// Returns a scene of 120 ribbons, one above the other, on a half-plane. Each ribbon has 40 particles.
fn pile_of_ribbons() -> String {
    let (ribbons, length) = (120, 40);
    let mut text =
        begin_scene("120 ribbons fall onto each other and onto a half-plane. The time that it takes counts.", 200);
    let mut drawn = PseudoRandomNumbers(2);
    let mut edges = String::new();
    for ribbon in 0..ribbons {
        let left_x = 2 * drawn.next();
        for link in 0..length {
            let position = [left_x + 150 * link, 60 + 90 * ribbon + drawn.next() / 40];
            add_particle(&mut text, position, [drawn.next() / 4, -drawn.next()], 40, false);
            if link > 0 {
                let second = ribbon * length + link;
                let edge = ribbon * (length - 1) + link - 1;
                let _ = writeln!(edges, "<edge i=\"{}\" j=\"{second}\" radius=\"0.03\"/>", second - 1);
                let _ = writeln!(edges, "<springforce edge=\"{edge}\" k=\"100\" l0=\"0.15\" b=\"0.1\"/>");
            }
        }
    }
    text + &edges
        + "<halfplane px=\"0\" py=\"0\" nx=\"0.1\" ny=\"2\"/>\n<simplegravity fx=\"0\" fy=\"-9.8\"/>\n</scene>\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use fosssim_model::{assignments::Assignment, scene};

    #[test]
    fn timing_scenes_are_of_the_courses_size() {
        for (made, [particles, edges]) in TIMING_SCENES.iter().zip([[15_004, 4], [4800, 4680]]) {
            let scene = scene::read(made.name, made.xml()).expect("a sound scene").scene;
            assert_eq!((scene.assignment(), scene.step_count()), (Assignment::T2M3, 20));
            assert_eq!([scene.particles.len(), scene.edges.len()], [particles, edges]);
        }
        assert_eq!([0, -5, 1203, -12_000].map(format_thousandths), ["0.000", "-0.005", "1.203", "-12.000"]);
    }
}
