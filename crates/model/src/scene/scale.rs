//! The same scene at another size: every length times a power of two.
//!
//! Such a factor is exact in binary arithmetic, so the scaled scene is the same motion with other exponents, bit for
//! bit, save where an absolute threshold takes part (small leading coefficients, Newton's method).
use super::model::{Collision, Force, Scene};

impl Scene {
    /// The scene with lengths times `2^power`: positions, velocities, radii, points of half-planes, thicknesses and
    /// rest lengths. Times and masses stay, and so do stiffnesses, dampings and the directions of normals;
    /// accelerations and constant forces grow like lengths, `G` like their cube, a vortex's strength like a length and
    /// its coupling like a square. What only a display uses stays, too.
    #[must_use]
    pub fn scaled(&self, power: i32) -> Self {
        let base = if power < 0 { 0.5 } else { 2.0 };
        let length = (0..power.unsigned_abs()).fold(1.0, |factor: f64, _| factor * base);
        let mut scene = self.clone();
        match &mut scene.collision {
            Collision::None | Collision::Simple { .. } | Collision::ContinuousTime { .. } => {}
            Collision::Penalty { thickness, .. } | Collision::Hybrid { thickness, .. } => *thickness *= length,
        }
        for particle in &mut scene.particles {
            particle.position *= length;
            particle.velocity *= length;
            particle.radius *= length;
        }
        for edge in &mut scene.edges {
            edge.radius *= length;
        }
        for half_plane in &mut scene.half_planes {
            half_plane.point *= length;
        }
        for force in &mut scene.forces {
            match force {
                Force::Spring { rest_length, .. } => *rest_length *= length,
                Force::SimpleGravity { acceleration } => *acceleration *= length,
                Force::Gravitation { constant, .. } => *constant *= length * length * length,
                Force::Constant { force } => *force *= length,
                Force::Drag { .. } => {}
                Force::Vortex { strength, coupling, .. } => {
                    *strength *= length;
                    *coupling *= length * length;
                }
            }
        }
        scene
    }
}

#[cfg(test)]
mod tests {
    use crate::scene;

    const SCENE: &str = r#"<scene>
      <duration time="1"/><integrator type="symplectic-euler" dt="0.1"/>
      <collision type="hybrid" COR="0.5" maxiters="3" k="7" thickness="0.01"/>
      <simplegravity fx="0.1" fy="-1"/>
      <particle m="1" px="-1" py="0.3" vx="0.2" vy="0" fixed="0" radius="0.1"/>
      <particle m="2" px="1" py="0.1" vx="0" vy="0.4" fixed="0" radius="0.2"/>
      <edge i="0" j="1" radius="0.05"/>
      <springforce edge="0" k="3" l0="1.7" b="0.2"/>
      <gravitationalforce i="0" j="1" G="0.3"/>
      <vortexforce i="0" j="1" kbs="0.3" kvc="0.7"/>
      <dragdamping b="0.1"/>
      <halfplane px="0" py="-1" nx="0.3" ny="1"/>
    </scene>"#;

    #[test]
    fn there_and_back_is_the_same_scene() {
        let scene = scene::read("scene", SCENE.as_bytes()).expect("a scene").scene;
        assert_eq!(scene.scaled(0), scene);
        assert_eq!(scene.scaled(7).scaled(-7), scene);
        assert_eq!(scene.scaled(1).particles[0].position.x, -2.0);
    }
}
