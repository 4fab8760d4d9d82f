//! The strict reader's messages about every kind of problem, and the problems that it does not repeat.
use super::{MAX_SCENE_BYTES, read};

const START: &str = "<duration time=\"1\"/><integrator type=\"explicit-euler\" dt=\"0.1\"/>\n";
const TWO: &str = "<particle px=\"0\" py=\"0\" vx=\"0\" vy=\"0\" m=\"1\" fixed=\"0\"/>\n\
                   <particle px=\"1\" py=\"0\" vx=\"0\" vy=\"0\" m=\"1\" fixed=\"1\"/>\n";

/// Returns the problems of a text, or `fine` and its warnings.
fn judged(text: &str) -> String {
    match read("x.xml", text.as_bytes()) {
        Ok(loaded) => loaded.warnings.iter().fold("fine".to_owned(), |all, warning| format!("{all}\n{warning}")),
        Err(problems) => problems.to_string(),
    }
}

/// Reads a scene with two particles in the same way. The elements start in line 4.
fn with(inner: &str) -> String {
    judged(&format!("<scene>{START}{TWO}{inner}</scene>"))
}

#[track_caller]
fn says(inner: &str, words: &str) {
    assert_eq!(with(inner), words, "{inner}");
}

#[test]
fn numbers() {
    let bad = |value: &str| with(&format!("<dragdamping b=\"{value}\"/>"));
    for (value, words) in [
        ("", "4:16: `b` of dragdamping 0 is empty (write a number)"),
        ("x", "4:17: `b` of dragdamping 0 must be a number, not `x` (write a number such as `-1.5e-3`)"),
        (
            "0.05xyz",
            "4:17: `b` of dragdamping 0 is `0.05xyz`, which is more than a number (the original reads `0.05` and \
             ignores the rest)",
        ),
        ("1,5", "4:17: `b` of dragdamping 0 is `1,5`, with a decimal comma (write `1.5`)"),
        ("NaN", "4:17: `b` of dragdamping 0 is `NaN` (only finite numbers are allowed)"),
        ("-inf", "4:17: `b` of dragdamping 0 is `-inf` (only finite numbers are allowed)"),
        ("1e400", "4:17: `b` of dragdamping 0 is `1e400`, too large (the largest 64-bit number is 1.8e308)"),
        ("1\n2", "4:17: `b` of dragdamping 0 has a line break inside (the original joins the lines and reads `12`)"),
        ("\n 1 \n", "fine"),
        ("&#49;", "fine"),
        (
            "1e-400",
            "fine\n4:17: warning: `b` of dragdamping 0 is `1e-400`, which becomes zero (the smallest 64-bit number is \
             5e-324)",
        ),
        ("-1", "fine\n4:17: warning: `b` of dragdamping 0 is `-1` (motion is driven instead of damped)"),
    ] {
        assert_eq!(bad(value), words, "{value}");
    }
}

#[test]
fn references_in_values() {
    let known = "the known references are `&lt;` `&gt;` `&amp;` `&apos;` `&quot;` `&#65;` `&#x41;`";
    for (value, words) in [
        ("&foo;", "has an unknown entity `&foo;`"),
        ("a & b", "has an `&` without `;`"),
        ("&#xZ;", "has a reference to a character that does not exist"),
        ("&#0;", "has a reference to a character that does not exist"),
    ] {
        says(&format!("<description text=\"{value}\"/>"), &format!("4:20: `text` of description {words} ({known})"));
    }
    says("<description text=\"&lt;&#xe9;&amp;\"/>", "fine");
    says(
        "<description text=\"a\nb\"/>",
        "fine\n4:20: warning: `text` of description has a line break, which vanishes (the original joins lines without \
         a space)",
    );
}

#[test]
fn truth_values_and_whole_numbers() {
    let particle = |fixed: &str| with(&format!("<particle px='3' py='0' vx='0' vy='0' m='1' fixed='{fixed}'/>"));
    assert_eq!(particle("true"), "4:52: `fixed` of particle 2 is `true` (write `1`)");
    assert_eq!(particle("No"), "4:52: `fixed` of particle 2 is `No` (write `0`)");
    assert_eq!(particle("2"), "4:52: `fixed` of particle 2 is `2` (must be `0` or `1`)");
    assert_eq!(particle(" 1 "), "fine");
    says("<edge i='0.0' j='1'/>", "4:10: `i` of edge 0 is `0.0` (write a whole number)");
    says(
        "<edge i='0' j='4294967296'/>",
        "4:16: `j` of edge 0 is `4294967296`, beyond 32 bits (write -2147483648 to 2147483647)",
    );
}

#[test]
fn names_that_do_not_exist() {
    says("<foo/>", "4:1: unknown element `foo` (the original ignores it silently)");
    says("<half-plane/>", "4:1: unknown element `half-plane` (did you mean `halfplane`?)");
    says("<edge i='0' j='1' radios='1'/>", "4:19: unknown attribute `radios` of `edge` (did you mean `radius`?)");
    says(
        "<dragdamping b='1' color='red'/>",
        "4:20: unknown attribute `color` of `dragdamping` (`dragdamping` has `b`)",
    );
    says(
        "<simplegravity fx='0' fz='1' fy='1'/>",
        "4:23: unknown attribute `fz` of `simplegravity` (`simplegravity` has `fx` and `fy`)",
    );
    says("<collision type='Hybrid'/>", "4:18: `type` of collision is `Hybrid` (did you mean `hybrid`?)");
    says(
        "<collision type='contest'/>",
        "4:18: `type` of collision is `contest` (the allowed values are `none`, `simple`, `penalty`, \
         `continuous-time` and `hybrid`)",
    );
    says(
        "<collisiondetection type='contest'/>",
        "fine\n4:1: warning: `collisiondetection` has no effect (it says how a `penalty` scene finds its pairs; other \
         collision handling tests all pairs)",
    );
    says("<collision type='penalty'/><collisiondetection type='contest'/>", "fine");
    says(
        "<collision type='penalty'/><collisiondetection type='contests'/>",
        "4:54: `type` of collisiondetection is `contests` (did you mean `contest`?)",
    );
    assert_eq!(
        judged(&format!("<scene x='1'>{START}{TWO}</scene>")),
        "1:8: unknown attribute `x` of `scene` (`scene` has none)"
    );
}

#[test]
fn similar_names_are_suggested() {
    // A misspelled name causes no further messages such as `no integrator`, `no px` or an index out of range.
    assert_eq!(
        judged(
            "<scene><duration time='1'/><integratr type='explicit-euler' dt='1'/><edge i='0' j='1'/>\n\
             <partcile pxx='0'/></scene>"
        ),
        "1:28: unknown element `integratr` (did you mean `integrator`?)\n\
         2:1: unknown element `partcile` (did you mean `particle`?)"
    );
    says(
        "<dragdamping bee='1' B='1'/>",
        "4:14: unknown attribute `bee` of `dragdamping` (`dragdamping` has `b`)\n4:22: unknown attribute `B` of \
        `dragdamping` (did you mean `b`?)",
    );
}

#[test]
fn what_is_missing() {
    assert_eq!(
        judged("<scene/>"),
        "1:1: the scene has no `integrator` (add `<integrator type=\"...\" dt=\"...\"/>`)\n\
         1:1: the scene has no `duration` (add `<duration time=\"...\"/>`)"
    );
    assert_eq!(
        judged(&format!("<scene>{START}</scene>")),
        "fine\n1:1: warning: the scene has no particles (its trace would contain no state)"
    );
    says("<edge j='1'/>", "4:1: edge 0 has no `i` (required: a whole number)");
    says(
        "<collision COR='1'/>",
        "4:1: collision has no `type` (required: `none`, `simple`, `penalty`, `continuous-time` and `hybrid`)",
    );
    assert_eq!(judged(""), "1:1: the file has no `scene` (put everything between `<scene>` and `</scene>`)");
    assert_eq!(
        judged("<world><duration/></world>"),
        "1:1: the root element is `world`, not `scene` (put all elements into one element `scene`)"
    );
    assert_eq!(
        judged(&format!("<Scene>{START}{TWO}<foo/></Scene>")),
        "1:1: the root element is `Scene`, not `scene` (did you mean `scene`?)\n\
         4:1: unknown element `foo` (the original ignores it silently)"
    );
}

#[test]
fn what_is_there_twice() {
    says(
        "<duration time='x'/>",
        "4:1: a second `duration` (the original takes the first and ignores the others; remove one)",
    );
    says(
        "<dragdamping b='1' b='2'/>",
        "4:20: a second `b` of `dragdamping` (the original takes the first; remove one)",
    );
    // The children of a second root are not checked.
    assert_eq!(
        judged(&format!("<scene>{START}{TWO}</scene>\n<scene><particle/></scene>\n<foo/>")),
        "5:1: a second `scene` (only the first one counts; move its elements there or to another file)\n\
         6:1: a second root element `foo` (only the first `scene` counts)"
    );
}

#[test]
fn indices() {
    says(
        "<edge i='0' j='2'/>",
        "4:16: `j` of edge 0 is 2, but the scene has no such particle (must be between 0 and 1; numbering starts at 0)",
    );
    says(
        "<edge i='-1' j='1'/>",
        "4:10: `i` of edge 0 is -1, but the scene has no such particle (must be between 0 and 1; \
            numbering starts at 0)",
    );
    says("<edge i='1' j='1'/>", "4:16: `j` of edge 0 is the same particle as `i` (two different particles are needed)");
    // An unreadable index proves nothing about the other one.
    says("<edge i='x' j='0'/>", "4:10: `i` of edge 0 must be a number, not `x` (write a number such as `-1.5e-3`)");
    for (inner, words) in [
        (
            "<springforce edge='0' k='1' l0='1'/>",
            "4:20: `edge` of springforce 0 is 0, but the scene has no such edge (there is no edge)",
        ),
        (
            "<gravitationalforce i='0' j='9' G='1'/>",
            "4:30: `j` of gravitationalforce 0 is 9, but the scene has no such particle (must be between 0 and 1; \
             numbering starts at 0)",
        ),
        (
            "<vortexforce i='9' j='0' kbs='1' kvc='1'/>",
            "4:17: `i` of vortexforce 0 is 9, but the scene has no such particle (must be between 0 and 1; \
             numbering starts at 0)",
        ),
        (
            "<particlecolor i='2' r='0' g='0' b='0'/>",
            "4:19: `i` of particlecolor 0 is 2, but the scene has no such particle (must be between 0 and 1; \
             numbering starts at 0)",
        ),
        (
            "<edgecolor i='0' r='0' g='0' b='0'/>",
            "4:15: `i` of edgecolor 0 is 0, but the scene has no such edge (there is no edge)",
        ),
        (
            "<halfplanecolor i='0' r='0' g='0' b='0'/>",
            "4:20: `i` of halfplanecolor 0 is 0, but the scene has no such half-plane (there is no half-plane)",
        ),
        (
            "<particlepath i='2' duration='1' r='0' g='0' b='0'/>",
            "4:18: `i` of particlepath 0 is 2, but the scene has no such particle (must be between 0 and 1; \
             numbering starts at 0)",
        ),
    ] {
        says(inner, words);
    }
}

#[test]
fn values_that_make_no_sense() {
    let particle = |rest: &str| with(&format!("<particle px='9' py='0' vx='0' vy='0' fixed='0' {rest}/>"));
    let mass = "(a mass must be positive; the original divides by it)";
    assert_eq!(particle("m='0'"), format!("4:52: `m` of particle 2 is `0` {mass}"));
    assert_eq!(particle("m='-1'"), format!("4:52: `m` of particle 2 is `-1` {mass}"));
    assert_eq!(particle("m='1' radius='-1'"), "4:63: `radius` of particle 2 is `-1` (a radius cannot be negative)");
    says(
        "<backgroundcolor r='0' g='1.5' b='-1'/>",
        "4:27: `g` of backgroundcolor is `1.5` (must be between 0 and 1)\n4:35: `b` of backgroundcolor is `-1` \
            (must be between 0 and 1)",
    );
    says(
        "<particlepath i='0' duration='-1' r='0' g='0' b='0'/>",
        "4:31: `duration` of particlepath 0 is `-1` (a duration cannot be negative)",
    );
    says(
        "<collision type='hybrid' maxiters='2.5'/>",
        "4:36: `maxiters` of collision is `2.5` (write a whole number of at most 2147483647)",
    );
    says(
        "<collision type='hybrid' maxiters='3e9'/>",
        "4:36: `maxiters` of collision is `3e9` (write a whole number of at most 2147483647)",
    );
    says("<collision type='hybrid' maxiters='0'/>", "fine");
    says(
        "<collision type='simple' COR='2' k='1'/>",
        "fine\n4:31: warning: `COR` of collision is `2` (a coefficient of restitution must be between 0 and 1)\n\
         4:37: warning: `k` of collision has no effect (this type of collision handling does not use it)",
    );
    says(
        "<halfplane px='0' py='0' nx='-0' ny='1e-200'/>",
        "4:1: the normal of halfplane 0 has no length (`nx` and `ny` must not both be zero or so small that their \
         squares vanish)",
    );
}

#[test]
fn durations_and_steps() {
    let timed = |time: &str, dt: &str| {
        judged(&format!("<scene><duration time='{time}'/><integrator type='explicit-euler' dt='{dt}'/>{TWO}</scene>"))
    };
    let step = "(the time step must be positive; the original makes no step)";
    assert_eq!(timed("1", "0"), format!("1:66: `dt` of integrator is `0` {step}"));
    assert_eq!(timed("1", "-1"), format!("1:66: `dt` of integrator is `-1` {step}"));
    assert_eq!(timed("-1", "1"), "1:24: `time` of duration is `-1` (the simulated time cannot be negative)");
    assert_eq!(timed("0", "1"), "fine\n1:8: warning: the duration is zero (there are no steps)");
    assert_eq!(
        timed("1e10", "1"),
        "1:8: 10000000000.0 seconds in steps of 1.0 are 1e10 steps (at most 2147483647 steps are possible; the \
         original would run none)"
    );
    assert_eq!(timed("2147483647", "1"), "fine");
}

#[test]
fn things_in_one_place() {
    let three = |collision: &str, inner: &str| {
        with(&format!(
            "{collision}\n<particle px='-0' py='-0' vx='0' vy='0' m='1' fixed='1'/>\n\
             <particle px='0.5' py='0' vx='0' vy='0' m='1' fixed='1'/>{inner}"
        ))
    };
    let penalty = "(the penalty force between them has no direction and is not a number; move one of them)";
    let edge = "<edge i='0' j='1'/>";
    for collision in ["<collision type='penalty'/>", "<collision type='hybrid'/>"] {
        assert_eq!(
            three(collision, edge),
            format!(
                "5:1: particles 0 and 2 start at the same position {penalty}\n6:1: particle 3 starts exactly on edge 0 \
                {penalty}"
            )
        );
    }
    let contact = "(a contact there has no direction and would not be a number)";
    assert_eq!(
        three("<collision type='continuous-time'/>", edge),
        format!(
            "fine\n5:1: warning: particles 0 and 2 start at the same position {contact}\n\
             6:1: warning: particle 3 starts exactly on edge 0 {contact}"
        )
    );
    assert_eq!(three("<collision type='simple'/>", edge), "fine");
    // A half-plane moves fixed particles only when there is a response.
    let plane = "<halfplane px='0.5' py='7' nx='1' ny='0'/>";
    assert!(
        three("<collision type='hybrid'/>", plane)
            .contains(&format!("6:1: particle 3 starts exactly on halfplane 0 {penalty}"))
    );
    assert!(!three("<collision type='penalty'/>", plane).contains("halfplane"));
    says(
        "<particle px='0' py='0' vx='0' vy='0' m='1' fixed='1'/><edge i='0' j='2'/>",
        "4:56: edge 0 joins particles 0 and 2, which start at one position (an edge without length has no direction; a \
         spring on it is not a number)",
    );
    says(
        "<particle px='0' py='0' vx='0' vy='0' m='1' fixed='1'/><gravitationalforce i='0' j='2' G='1'/>",
        "4:56: `gravitationalforce` between particles 0 and 2, which start at one position \
         (at distance zero it is not a number)",
    );
}

#[test]
fn methods_that_do_not_go_together() {
    let implicit = |kind: &str, inner: &str| {
        judged(&format!("<scene><duration time='1'/><integrator type='{kind}' dt='1'/>\n{TWO}{inner}</scene>"))
    };
    for kind in ["implicit-euler", "linearized-implicit-euler"] {
        assert_eq!(
            implicit(kind, "<vortexforce i='0' j='1' kbs='1' kvc='1'/>"),
            "4:1: a `vortexforce` with an implicit integrator (it has no Hessian; the original stops at the first step)"
        );
    }
    for collision in ["<collision type='penalty'/>", "<collision type='hybrid'/>"] {
        assert_eq!(
            implicit("implicit-euler", collision),
            "fine\n1:28: warning: `implicit-euler` with a penalty force (its Hessian is missing, so Newton's method \
             may never converge)"
        );
        assert_eq!(implicit("linearized-implicit-euler", collision), "fine");
    }
    says(
        "<particle px='9' py='9' vx='0' vy='1' m='1' fixed='1'/><collision type='simple'/>\
         <halfplane px='0' py='-5' nx='0' ny='1'/>",
        "fine\n4:1: warning: particle 2 is fixed but moves, and half-planes will reflect it (the response to \
         half-planes does not check whether a particle is fixed)",
    );
    let many: String =
        (0..4097).map(|x| format!("<particle px='{x}' py='9' vx='0' vy='0' m='1' fixed='0'/>")).collect();
    assert_eq!(
        implicit("implicit-euler", &many).replace("4099", "N"),
        "1:28: N particles are too many for an implicit integrator (at most 4096: it solves a dense system of twice \
         that size in every step)"
    );
}

#[test]
fn rigid_bodies_are_rejected() {
    assert_eq!(
        judged("<scene><simtype type='rigid-body'/><rigidbodyvertex x='0'/><rigidbody p='0' p='1'/></scene>"),
        "1:23: `type` of simtype is `rigid-body` (rigid bodies are an unfinished stub of the original and are not \
         simulated; use `particle-system`)"
    );
    says("<simtype type=''/>", "fine");
    says("<simtype/>", "fine");
    says(
        "<rigidbody p='0' p='1'/>",
        "1:1: the scene has rigid bodies (rigid bodies are an unfinished stub of the original and are not simulated; \
         use particles and edges)",
    );
}

#[test]
fn broken_tags() {
    let how = "(attributes are written `name=\"value\"`)";
    says(
        "<dragdamping b=1/>",
        &format!("4:14: quotation marks are missing around the value after `b=` in `dragdamping` {how}"),
    );
    says("<dragdamping b/>", &format!("4:14: `=` and a value are missing after `b` in `dragdamping` {how}"));
    says("<dragdamping b= />", &format!("4:14: a value is missing after `b=` in `dragdamping` {how}"));
    says("<dragdamping b='1' / >", "4:20: a `/` in `dragdamping` (`/` must be directly before `>`)");
    says(
        "<dragdamping b='1'\n<dragdamping b='1'/>",
        "5:1: a `<` in `dragdamping` (is the `>` of this element missing?)",
    );
    says(
        "<dragdamping\nb='1'/>",
        "4:1: only a line break between `dragdamping` and its first attribute (the original joins the lines and \
         then misses the element; put a space before the attribute)",
    );
    says("<dragdamping\r\nb='1'/><dragdamping\n b='1'/><dragdamping b='1'\n/><maxsimfreq max='1'\n/>", "fine");
    says("< dragdamping b='1'/>", "4:1: no element name after `<`");
    says("<dragdamping b='1/>", "4:1: a quotation mark is missing in this tag or after it (close every value)");
}

#[test]
fn broken_nesting() {
    says(
        "<dragdamping b='1'>\n<foo/><edge/>",
        "5:1: `foo` inside `dragdamping` (only elements directly in `scene` count; is the end of `dragdamping` \
        missing?)",
    );
    says("<dragdamping b='1'>", "4:1: `<dragdamping>` is not closed (end it with `/>` or with `</dragdamping>`)");
    says("<dragdamping b='1'></dragdampin>", "4:20: `</dragdampin>` closes nothing (open is `<dragdamping>`)");
    says("<dragdamping b='1'/></edge>", "4:21: `</edge>` closes nothing (open is `<scene>`)");
    says("</scene>", "4:9: `</scene>` closes nothing");
    // After broken markup, no element is reported as missing or out of range.
    assert_eq!(
        judged("<scene><duration time='1'/><edge i='0' j='1'/>"),
        "1:1: `<scene>` is never closed (end it with `/>` or with `</scene>`)"
    );
    assert_eq!(
        judged("<scene><edge i='0' j='1'/><!-- <particle/></scene>"),
        "1:27: a comment without end (end it with `-->`)"
    );
    assert_eq!(judged("<scene></scene"), "1:8: a tag without end (end it with `>` or `/>`)");
}

#[test]
fn faults_of_the_markup_are_marked() {
    for (inner, is_markup) in [
        ("<dragdamping b/>", true),
        ("<dragdamping b='1'>", true),
        ("<dragdamping b='1/>", true),
        ("<dragdamping b='1'><foo/>", true),
        ("</scene>", true),
        ("<dragdamping b='x'/>", false),
        ("<foo/>", false),
    ] {
        let problems = read("x.xml", format!("<scene>{START}{TWO}{inner}</scene>").as_bytes()).expect_err("an error");
        assert_eq!(problems.list[0].is_markup, is_markup, "{inner}");
    }
}

#[test]
fn text_and_other_markup() {
    says(
        "hello &amp; <![CDATA[you]]>",
        "4:1: text between the elements: `hello` (only elements count here; remove it or make it a comment, \
         `<!-- ... -->`)",
    );
    assert_eq!(
        judged(&format!("<?xml version='1.0'?><!DOCTYPE scene><!-- c --><scene>{START}{TWO}<?pi?></scene>\n;")),
        "5:1: text outside the scene: `;` (only elements count here; remove it or make it a comment, `<!-- ... -->`)"
    );
    assert_eq!(
        judged(&format!("<!DOCTYPE scene [<!ENTITY a 'b'>]><scene>{START}{TWO}</scene>")),
        "1:1: the document type contains declarations, and the original ignores them (replace the entities by their \
         text, and remove the document type)"
    );
    says("<!foo>", "4:1: `<!` does not start a known construct (`<!-- ... -->`)");
    assert_eq!(judged(&format!("\u{feff}<scene>{START}{TWO}</scene>")), "fine");
}

#[test]
fn bytes_that_are_no_text() {
    let bytes = |bytes: &[u8]| read("x", bytes).map(|_| ()).expect_err("refused").to_string();
    assert_eq!(bytes(b"\xff\xfe<\0"), "1:1: the file is in UTF-16 (save it as UTF-8)");
    let scene = format!("<scene>{START}{TWO}<description text='caf?'/></scene>").into_bytes();
    let latin: Vec<u8> = scene.iter().map(|&byte| if byte == b'?' { 0xe9 } else { byte }).collect();
    assert_eq!(bytes(&latin), "4:23: a byte that is not UTF-8 (save the file as UTF-8)");
    let ended: Vec<u8> = scene.iter().map(|&byte| if byte == b'?' { 0 } else { byte }).collect();
    assert_eq!(bytes(&ended), "4:23: a NUL byte (the original stops reading there)");
    assert_eq!(bytes(&vec![b' '; MAX_SCENE_BYTES + 1]), "1:1: the file has 8388609 bytes (a scene has at most 8 MiB)");
}

#[test]
fn what_only_the_original_sees() {
    // Joining the lines ends the comment early.
    says(
        "<!-- --\n> <dragdamping/> -->",
        "1:1: the original reads this file differently (Failed to parse b attribute for dragdamping 0. Exiting.)",
    );
}

#[test]
fn problems_say_where_and_about_what() {
    let text = format!("<scene>{START}{TWO}<edge i='0' j='7'/></scene>");
    let problems = read("x.xml", text.as_bytes()).expect_err("refused");
    assert_eq!((problems.source.as_str(), problems.list.len()), ("x.xml", 1));
    let problem = &problems.list[0];
    assert_eq!((problem.element.as_deref(), problem.attribute.as_deref()), (Some("edge"), Some("j")));
    assert_eq!(&text[problem.span.clone()], "7");
}
