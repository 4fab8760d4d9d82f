//! The original's messages about every kind of problem, and the problems that it ignores.
use super::{OriginalScene, Rejection, RejectionKind, read};
use crate::assignments::Integrator;
use crate::scene::model::{Collision, CollisionDetection, Force};
use fosssim_num::vector::Vec2;

const BARE: &str = "<duration time='1'/><integrator type='explicit-euler' dt='0.1'/>";
const TWO: &str = "<particle px='0' py='0' vx='0' vy='0' m='1' fixed='0'/>\
                   <particle px='1' py='0' vx='0' vy='0' m='1' fixed='1' radius='2' tag='b'/>";

fn scene(inner: &str) -> Result<OriginalScene, Rejection> {
    read(format!("<scene>{BARE}{inner}</scene>").as_bytes())
}

fn accepted(inner: &str) -> OriginalScene {
    scene(inner).unwrap_or_else(|refusal| panic!("{inner}: {refusal}"))
}

#[track_caller]
fn refused(result: Result<OriginalScene, Rejection>, text: &str, exit_code: u8) {
    let stderr = format!("\u{1b}[31;1mERROR IN XMLSCENEPARSER:\u{1b}[m {text}\n").into_bytes();
    let refusal = result.expect_err(text);
    let expected = Rejection { kind: RejectionKind::Message, stderr, exit_code, explanation: text.to_owned() };
    assert_eq!(refusal, expected);
}

#[track_caller]
fn says(inner: &str, text: &str) {
    refused(scene(inner), text, 1);
}

#[test]
fn defaults() {
    let read = accepted(TWO);
    assert_eq!(read.description, b"No description specified.");
    assert_eq!(read.scene.description, None);
    assert_eq!(read.scene.collision, Collision::None);
    assert_eq!(read.scene.integrator, Integrator::ExplicitEuler);
    assert_eq!((read.scene.particles[0].radius, read.scene.particles[0].fixed), (0.1, false));
    assert_eq!((read.scene.particles[1].radius, read.scene.particles[1].fixed), (2.0, true));
    let with = accepted(&format!("{TWO}<edge i='0' j='1'/><springforce edge='0' k='1' l0='2'/>"));
    assert_eq!(with.scene.edges[0].radius, 0.015);
    assert_eq!(with.scene.forces, [Force::Spring { edge: 0, stiffness: 1.0, rest_length: 2.0, damping: 0.0 }]);
}

#[test]
fn collision_defaults_depend_on_the_type() {
    let of = |attributes: &str| accepted(&format!("<collision {attributes}/>")).scene.collision;
    assert_eq!(of("type='simple'"), Collision::Simple { restitution: 1.0 });
    assert_eq!(
        of("type='penalty' COR='7'"),
        Collision::Penalty { stiffness: 100.0, thickness: 0.01, detection: CollisionDetection::AllPairs }
    );
    assert_eq!(
        of("type='hybrid' maxiters='3.9e0'"),
        Collision::Hybrid { restitution: 1.0, max_iterations: 3, stiffness: 10.0, thickness: 0.1 }
    );
    assert_eq!(of("type='continuous-time' maxiters='x' k='x'"), Collision::ContinuousTime { restitution: 1.0 });
    assert_eq!(of("type='none'"), Collision::None);
}

#[test]
fn forces_act_by_kind_not_by_place() {
    let read = accepted(&format!(
        "<vortexforce i='0' j='1' kbs='1' kvc='2'/><dragdamping b='1'/><constantforce fx='1' fy='2'/>\
         <gravitationalforce i='0' j='1' G='3'/><simplegravity fx='0' fy='-1'/>\
         <springforce edge='0' k='1' l0='1' b='2'/><dragdamping b='5'/><edge i='0' j='1'/>{TWO}"
    ));
    assert_eq!(
        read.scene.forces,
        [
            Force::Spring { edge: 0, stiffness: 1.0, rest_length: 1.0, damping: 2.0 },
            Force::SimpleGravity { acceleration: Vec2::new(0.0, -1.0) },
            Force::Gravitation { first: 0, second: 1, constant: 3.0 },
            Force::Constant { force: Vec2::new(1.0, 2.0) },
            Force::Drag { coefficient: 1.0 },
            Force::Drag { coefficient: 5.0 },
            Force::Vortex { first: 0, second: 1, strength: 1.0, coupling: 2.0 },
        ]
    );
}

#[test]
fn bytes_that_are_not_utf_8_pass_through() {
    let read = read(
        b"<scene><duration time='1'/><integrator type='implicit-euler' dt='1'/><description text='caf\xe9'/></scene>",
    )
    .expect("accepted");
    assert_eq!(read.description, b"caf\xe9");
    assert_eq!(read.scene.description.as_deref(), Some("caf\u{fffd}"));
}

#[test]
fn messages_about_the_whole() {
    let root = "Failed to parse xml scene file. Failed to locate root <scene> node. Exiting.";
    refused(read(b""), root, 1);
    refused(read(b"<Scene/>"), root, 1);
    refused(read(b"<scene/>"), "No duration specified. Exiting.", 1);
    refused(read(b"<scene><duration/></scene>"), "No duration 'time' attribute specified. Exiting.", 1);
    refused(
        read(b"<scene><duration time='inf'/></scene>"),
        "Failed to parse 'time' attribute for duration. Value must be numeric. Exiting.",
        1,
    );
    let timed = |inner: &str| read(format!("<scene><duration time='1'/>{inner}</scene>").as_bytes());
    refused(timed(""), "No integrator specified. Exiting.", 1);
    refused(timed("<integrator/>"), "No integrator 'type' attribute specified. Exiting.", 1);
    refused(timed("<integrator type='Euler'/>"), "Invalid integrator 'type' attribute specified. Exiting.", 1);
    refused(timed("<integrator type='implicit-euler'/>"), "No integrator 'dt' attribute specified. Exiting.", 1);
    refused(
        timed("<integrator type='implicit-euler' dt=''/>"),
        "Failed to parse 'dt' attribute for integrator. Value must be numeric. Exiting.",
        1,
    );
}

#[test]
fn messages_about_single_elements() {
    says(
        "<collision COR='x'/>",
        "Failed to parse 'COR' attribute for collision handler. Value must be numeric. Exiting.",
    );
    says("<collision/>", "No collision handler 'type' attribute specified. Exiting.");
    says("<collision type='contest'/>", "Invalid collision handler 'type' attribute specified. Exiting.");
    for name in ["maxiters", "k", "thickness"] {
        says(
            &format!("<collision type='hybrid' {name}='x'/>"),
            &format!("Failed to parse '{name}' attribute for collision handler. Value must be numeric. Exiting."),
        );
    }
    says("<maxsimfreq/>", "No maxsimfreq 'max' attribute specified. Exiting.");
    says("<maxsimfreq max='x'/>", "Failed to parse 'max' attribute for maxsimfreq. Value must be scalar. Exiting.");
    says("<viewport cx='0'/>", "No viewport 'cy' attribute specified. Exiting.");
    says("<viewport cx='x'/>", "Failed to parse 'cx' attribute for viewport. Value must be scalar. Exiting.");
    says("<backgroundcolor/>", "Failed to parse value of r attribute for backgroundcolor. Exiting.");
    says(
        "<backgroundcolor r='1' g='x'/>",
        "Failed to parse value of g attribute for backgroundcolor. Value must be scalar. Exiting.",
    );
    says(
        "<backgroundcolor r='1.1'/>",
        "Failed to parse value of r attribute for backgroundcolor. Invalid color specified. Valid range is 0...1",
    );
    says("<description/>", "No text attribute specified for description. Exiting.");
    says("<scenetag/>", "Failed to parse value of tag attribute for scenetag. Value must be string. Exiting.");
    says(
        "<simtype type='x'/>",
        "Invalid simtype 'x' specified. Valid options are 'particle-system' and 'rigid-body'. Exiting.",
    );
    accepted("<simtype/>");
    accepted("<simtype type='particle-system'/>");
}

#[test]
fn messages_about_particles_edges_and_half_planes() {
    says("<particle px='1'/>", "Failed to parse py attribute for particle 0. Exiting.");
    says("<particle px='x'/>", "Failed to parse value of px attribute for particle 0. Value must be numeric. Exiting.");
    let start = "<particle px='0' py='0' vx='0' vy='0' m='1'";
    says(&format!("{TWO}{start}/>"), "Failed to parse fixed attribute for particle 2. Exiting.");
    says(
        &format!("{start} fixed='true'/>"),
        "Failed to parse value of fixed attribute for particle 0. Value must be boolean. Exiting.",
    );
    says(
        &format!("{start} fixed='0' radius='x'/>"),
        "Failed to parse radius attribute for particle 0. Value must be scalar. Exiting.",
    );
    says("<edge/>", "Failed to parse value of i attribute for edge 0. Exiting.");
    says("<edge i='0' j='x'/>", "Failed to parse value of j attribute for edge 0. Value must be integer. Exiting.");
    says(
        "<edge i='0' j='1' radius=''/>",
        "Failed to parse radius attribute for edge 0. Value must be scalar. Exiting.",
    );
    refused(scene("<halfplane px='0'/>"), "Failed to parse value of py attribute for halfplane 0. Exiting.", 0);
    refused(
        scene("<halfplane px='0' py='0' nx='x'/>"),
        "Failed to parse value of nx attribute for halfplane 0. Value must be real number. Exiting.",
        0,
    );
}

#[test]
fn messages_about_forces() {
    says("<springforce/>", "Failed to parse value of edge attribute for springforce 0. Exiting.");
    says(
        "<springforce edge='x'/>",
        "Failed to parse value of edge attribute for springforce 0. Value must be integer. Exiting.",
    );
    says("<springforce edge='0' k='1'/>", "Failed to parse l0 attribute for springforce 0. Exiting.");
    says(
        "<springforce edge='0' k='1' l0='1' b='x'/>",
        "Failed to parse value of b attribute for springforce 0. Value must be numeric. Exiting.",
    );
    for name in ["simplegravity", "constantforce"] {
        says(&format!("<{name} fx='0'/>"), "Failed to parse fy attribute for constantforce 0. Exiting.");
        says(
            &format!("<{name} fx='x'/>"),
            "Failed to parse value of fx attribute for constantforce 0. Value must be numeric. Exiting.",
        );
    }
    says("<gravitationalforce/>", "Failed to parse value of i attribute for gravitationalforce 0. Exiting.");
    says("<gravitationalforce i='0' j='0'/>", "Failed to parse G attribute for gravitationalforce 0. Exiting.");
    says(
        "<gravitationalforce i='0' j='0' G='x'/>",
        "Failed to parse value of G attribute for gravitationalforce 0. Value must be numeric. Exiting.",
    );
    says("<dragdamping/>", "Failed to parse b attribute for dragdamping 0. Exiting.");
    says(
        "<dragdamping b='x'/>",
        "Failed to parse value of b attribute for dragdamping 0. Value must be numeric. Exiting.",
    );
    says(
        "<vortexforce i='0' j='x'/>",
        "Failed to parse value of j attribute for vortexforce 0. Value must be integer. Exiting.",
    );
    says("<vortexforce i='0' j='0' kbs='1'/>", "Failed to parse kvc attribute for vortexforce 0. Exiting.");
}

#[test]
fn messages_about_colors_and_paths() {
    says("<particlecolor/>", "Failed to parse value of i attribute for particlecolor 0. Exiting.");
    says("<edgecolor i='x'/>", "Failed to parse value of i attribute for edgecolor 0. Value must be integer. Exiting.");
    says(
        "<particlecolor i='0'/>",
        "Failed to parse value of i attribute for particlecolor 0. Invalid particle specified. Valid range is \
         0...18446744073709551615",
    );
    says(
        &format!("{TWO}<particlecolor i='0' r='0' g='0' b='0'/><particlecolor i='2'/>"),
        "Failed to parse value of i attribute for particlecolor 1. Invalid particle specified. Valid range is 0...1",
    );
    says(
        "<halfplane px='0' py='0' nx='0' ny='1'/><halfplanecolor i='2'/>",
        "Failed to parse value of i attribute for halfplanecolor 0. Invalid half-plane specified. Valid range is 0...0",
    );
    says(
        &format!("{TWO}<particlecolor i='0' r='0' g='2'/>"),
        "Failed to parse value of g attribute for particlecolor 0. Invalid color specified. Valid range is 0...1",
    );
    for duration in ["", "duration='x'", "duration='-1'"] {
        says(
            &format!("<particlepath i='0' {duration}/>"),
            "Failed to parse value of duration attribute for particlepath 0. Value must be positive scalar.",
        );
    }
    let paths = accepted("<particlepath i='-3' duration='0' r='0' g='0' b='0'/>").scene.display.paths;
    assert_eq!(paths, []);
}

#[test]
fn the_order_of_evaluation_decides_which_message_comes() {
    says("<edge/><particle/><maxsimfreq/>", "No maxsimfreq 'max' attribute specified. Exiting.");
    says("<edge/><particle/>", "Failed to parse px attribute for particle 0. Exiting.");
    refused(read(b"<scene><integrator/><duration/></scene>"), "No duration 'time' attribute specified. Exiting.", 1);
    says("<edge i='9' j='9'/><collision/>", "No collision handler 'type' attribute specified. Exiting.");
}

#[test]
fn foreign_memory_is_rejected() {
    for (inner, text) in [
        ("<edge i='0' j='2'/>", "edge 0 names particle 2, but the scene has 2"),
        ("<edge i='-1' j='1'/>", "edge 0 names particle -1, but the scene has 2"),
        ("<springforce edge='0' k='1' l0='1'/>", "springforce 0 names edge 0, but the scene has 0"),
        ("<gravitationalforce i='0' j='5' G='1'/>", "gravitationalforce 0 names particle 5, but the scene has 2"),
        ("<vortexforce i='7' j='1' kbs='1' kvc='1'/>", "vortexforce 0 names particle 7, but the scene has 2"),
        ("<edgecolor i='0' r='0' g='0' b='0'/>", "edgecolor 0 names edge 0, but the scene has 0"),
    ] {
        let refusal = scene(&format!("{TWO}{inner}")).expect_err(inner);
        assert_eq!((refusal.kind, refusal.exit_code), (RejectionKind::Undefined, 1));
        assert_eq!(refusal.to_string(), format!("{text}; the original would read memory that is not its own"));
    }
    let stub = scene("<simtype type='rigid-body'/>").expect_err("refused");
    assert_eq!(stub.kind, RejectionKind::Undefined);
}

#[test]
fn broken_xml_is_a_crash() {
    let refusal = read(b"<scene>").expect_err("refused");
    assert_eq!((refusal.kind, refusal.exit_code), (RejectionKind::Crash, 134));
    assert_eq!(
        String::from_utf8_lossy(&refusal.stderr),
        "terminate called after throwing an instance of 'rapidxml::parse_error'\n  what():  unexpected end of data\n"
    );
    assert_eq!(refusal.to_string(), "the scene is not well-formed XML: unexpected end of data");
}

#[test]
fn an_unreadable_file_has_its_own_message() {
    assert_eq!(
        String::from_utf8_lossy(&Rejection::from_unreadable_file(b"a.xml").stderr),
        "\u{1b}[31;1mERROR IN TWODSCENEXMLPARSER:\u{1b}[m XML scene file a.xml. Failed to read file.\n"
    );
}
