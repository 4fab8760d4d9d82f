use super::*;

/// Renders the first step of a scene with this head, and these bodies and forces.
fn text(integrator: &str, collision: &str, rest: &str) -> String {
    let xml = format!(
        r#"<scene> <duration time="1"/> <integrator type="{integrator}" dt="0.5"/> <collision {collision}/>
            {rest} </scene>"#
    );
    let scene = fosssim_model::scene::read("small", xml.as_bytes()).expect("a scene").scene;
    first_step(&scene, None, 1).expect("a result")
}

/// Checks that a text has these lines. Several spaces count as one.
fn assert_has(text: &str, lines: &[&str]) {
    let plain = |line: &str| line.split_whitespace().collect::<Vec<_>>().join(" ");
    for line in lines {
        assert!(text.lines().any(|own| plain(own) == *line), "{line}: {text}");
    }
}

const PAIR: &str = r#"<particle m="2" px="0" py="0" vx="1" vy="0" fixed="0"/>
    <particle m="1" px="4" py="0" vx="0" vy="0" fixed="1"/> <edge i="0" j="1" radius="1"/>"#;

#[test]
fn an_explicit_step_has_its_forces_and_result() {
    let found = text(
        "explicit-euler",
        r#"type="none""#,
        &format!(r#"{PAIR} <springforce edge="0" k="2" l0="3"/> <dragdamping b="2"/>"#),
    );
    assert_has(&found, &["springforce 0 (-2, 0)", "dragdamping 0 (2, 0)", "together 1 (2, 0)"]);
    assert_has(&found, &["0 (1, 0) (0.5, 0) (0, 0)", "1 (0, 0) (4, 0) (0, 0)"]);
}

/// With drag, `v` after an implicit step is 1/(1 + h b/m): Newton's method needs one solve.
#[test]
fn an_implicit_step_has_its_system() {
    let rest = format!(r#"{PAIR} <dragdamping b="2"/>"#);
    let linearized = text("linearized-implicit-euler", r#"type="none""#, &rest);
    assert_has(&linearized, &["Forces at x + h v", "3 0 0 0", "0 (-1, 0) (-1/3, 0)", "0 (2/3, 0) (1/3, 0)"]);
    let newton = text("implicit-euler", r#"type="none""#, &rest);
    assert_has(&newton, &["3 0 0 0", "0 (-1, 0) (-1/3, 0)", "0 (2/3, 0) (1/3, 0)"]);
}

/// If bodies of masses 1 and 2 collide, the calculation contains the impulse by the law of impact.
#[test]
fn an_impact_has_its_impulse() {
    let bodies = r#"<particle m="1" px="0" py="0" vx="6" vy="0" fixed="0" radius="0.5"/>
        <particle m="2" px="2" py="0" vx="0" vy="0" fixed="0" radius="0.5"/>"#;
    let found = text("explicit-euler", r#"type="continuous-time" COR="0.5""#, bodies);
    assert_has(&found, &["particles 0 and 1 collide at t = 1/3 with n = (1, 0)"]);
    assert_has(&found, &["J = -(1 + COR) (sum of w D.u) / (sum of w^2/m) = -1.5 * 6 / 1.5 = -6"]);
    assert_has(&found, &["0 (6, 0) 1 1 (-6, 0)", "1 (0, 0) -1 0.5 (3, 0)"]);
    // This is the simulator's own result.
    assert_has(&found, &["0 (0, 0) (0, 0)", "1 (3, 0) (3.5, 0)"]);
    // Nothing is divided by zero.
    let held =
        text("explicit-euler", r#"type="continuous-time" COR="1""#, &bodies.replace("fixed=\"0\"", "fixed=\"1\""));
    assert_has(&held, &["J = -(1 + COR) (sum of w D.u) / (sum of w^2/m) = 0, because all are fixed"]);
}

/// Scenes without forces, or with forces that sum to zero, also have a step.
#[test]
fn a_step_without_forces_is_computed() {
    let one = r#"<particle m="1" px="1" py="0" vx="2" vy="0" fixed="0"/>"#;
    for integrator in ["explicit-euler", "implicit-euler"] {
        let found = text(integrator, r#"type="none""#, one);
        assert!(found.contains("  none\n") && found.contains("(2, 0)   (2, 0)"), "{found}");
    }
    let still = text("explicit-euler", r#"type="none""#, &format!(r#"{PAIR} <springforce edge="0" k="1" l0="4"/>"#));
    assert_has(&still, &["springforce 0 (0, 0)", "springforce 1 (0, 0)"]);
}

#[test]
fn a_detection_has_its_formulas_and_letters_and_a_later_step_its_beginning() {
    let xml = r#"<scene> <duration time="1"/> <integrator type="explicit-euler" dt="1"/>
        <collision type="continuous-time"/> <particle m="1" px="3" py="0" vx="-0.09" vy="0" fixed="0" radius="1"/>
        <halfplane px="0" py="0" nx="1" ny="0"/> </scene>"#;
    let scene = fosssim_model::scene::read("small", xml.as_bytes()).expect("a scene").scene;
    let pair = Pair { kind: PairKind::ParticleHalfPlane, first: 0, second: 0 };
    let found = first_step(&scene, Some((pair, None)), 2).expect("a result");
    assert!(found.starts_with("Before step 2\n"), "{found}");
    // The number contains no round-off of 3 - 0.09 - 3.
    assert_has(&found, &["0 (-0.09, 0) (3, 0)", "x, particle (3, 0) (-0.09, 0) 1"]);
    assert_has(&found, &["t^1: 2 (dx.n) ((p-x).n)", "with (dx.n) = -0.09, ((p-x).n) = -3, (n.n) = 1, r^2 = 1"]);
    assert_has(&found, &["-0.0081 t^2 + 0.54 t - 8"]);
}

#[test]
fn a_zone_has_its_rigid_motion() {
    let bodies = r#"<particle m="1" px="0" py="0" vx="0" vy="0" fixed="0" radius="0.5"/>
        <particle m="2" px="3" py="0" vx="-6" vy="0" fixed="0" radius="0.5"/>"#;
    let hybrid = r#"type="hybrid" COR="1" maxiters="0" k="0" thickness="0""#;
    let found = text("explicit-euler", hybrid, bodies);
    assert_has(
        &found,
        &[
            "impact zones: {0, 1}",
            "x_cm = (2, 0), dx_cm = (-2, 0)",
            "L = sum of m s x (dx - dx_cm) = 0, I = sum of m |s|^2 = 6, omega = L / I = 0",
        ],
    );
    assert_has(&found, &["0 1 (-2, 0) (2, 0)", "0 (-4, 0) (-2, 0)"]);
    let fixed = text("explicit-euler", hybrid, &bodies.replacen(r#"fixed="0""#, r#"fixed="1""#, 1));
    assert!(fixed.contains("a fixed particle stops it"), "{fixed}");
}

#[test]
fn a_penalty_force_has_its_depth() {
    let bodies = r#"<particle m="1" px="0" py="0" vx="0" vy="0" fixed="0" radius="1"/>
        <particle m="1" px="1.5" py="0" vx="0" vy="0" fixed="0" radius="1"/>"#;
    let found = text("explicit-euler", r#"type="penalty" k="2" thickness="0.5""#, bodies);
    assert_has(&found, &["penalty 0 (2, 0)", "particles 0 and 1 1.5 2.5 -2 0: (2, 0), 1: (-2, 0)"]);
}

#[test]
fn numbers_are_short() {
    let numbers = [1.0 / 3.0, -0.1 - 0.2, 1e-17, 2.0_f64.sqrt(), 0.0625].map(format_short);
    assert_eq!(numbers, ["1/3", "-0.3", "0", "1.41421", "0.0625"]);
}
