use super::*;
use crate::runs::judge;
use fosssim_model::{assignments::Assignment, scene};
use fosssim_oracle::{judge::fair::FairVerdict, suite::library};

/// A scene of linearized implicit steps whose bodies have these masses.
fn scene(masses: [f64; 3]) -> Scene {
    let [a, b, c] = masses;
    let text = format!(
        r#"<scene><duration time="1"/><integrator type="linearized-implicit-euler" dt="0.01"/>
        <particle m="{a}" px="0" py="0" vx="0" vy="0.1" fixed="0" radius="0.1"/>
        <particle m="{b}" px="1" py="0.1" vx="0.3" vy="-6.3" fixed="0" radius="0.1"/>
        <particle m="{c}" px="2" py="-0.2" vx="0.1" vy="0" fixed="0" radius="0.1"/>
        <edge i="0" j="1" radius="0.01"/><edge i="1" j="2" radius="0.01"/>
        <springforce edge="0" k="900" l0="0.9"/><springforce edge="1" k="3" l0="1.2"/>
        <gravitationalforce i="0" j="2" G="0.0001"/></scene>"#
    );
    scene::read("scene", text.as_bytes()).expect("a scene").scene
}

/// The verdict on what a program writes of a scene.
fn verdict(scene: &Scene, arithmetic: Arithmetic) -> FairVerdict {
    let trace = arithmetic.trace(scene, |_, _| ()).unwrap_or_else(|_| panic!("{} ends early", arithmetic.name));
    judge(scene, &trace).fair.expect("the fair rules were asked").verdict
}

#[test]
fn whatever_solves_the_system_of_an_implicit_step_is_right() {
    // Where masses differ, solvers that are exact beside the largest entry are not so beside each row's.
    let mut scenes = vec![scene([1e7, 1.0, 4.0]), scene([1e6, 1.0, 1e2])];
    let of_milestone = library::names().filter(|name| library::assignment(name) == Some(Assignment::T1M3));
    scenes.extend(
        of_milestone.map(|name| scene::read(name, library::scene(name).expect("its text")).expect("a scene").scene),
    );
    assert!(scenes.len() > 5);
    for (number, scene) in scenes.iter().enumerate() {
        for arithmetic in ALL {
            let verdict = verdict(scene, arithmetic);
            assert_eq!(verdict, FairVerdict::Accepted, "scene {number}, {}", arithmetic.name);
        }
    }
}
