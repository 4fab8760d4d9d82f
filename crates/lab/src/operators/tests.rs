use super::*;
use fosssim_oracle::{
    scene::read,
    student::{self, Student},
};
use std::collections::BTreeSet;

#[test]
fn every_place_has_its_changes_once() {
    let all: Vec<String> = mutations().iter().map(ToString::to_string).collect();
    assert!(all.len() > 500, "{}", all.len());
    assert_eq!(all.iter().collect::<BTreeSet<_>>().len(), all.len());
    for (place, operators, _) in EQUIVALENT {
        for &operator in *operators {
            assert!(mutations().contains(&Mutation { place: *place, operator }), "{place:?}: {operator:?}");
        }
    }
}

/// Two discs meet in a world without impulses, off centre, so that they turn.
const MEETING: &str = r#"<scene><duration time="0.5"/><integrator type="explicit-euler" dt="0.5"/>
    <collision type="hybrid" COR="0.5" maxiters="0" k="0" thickness="0"/>
    <particle m="1" px="0" py="0" vx="4" vy="0" fixed="0" radius="1"/>
    <particle m="3" px="3" py="0.5" vx="0" vy="0" fixed="0" radius="1"/></scene>"#;

#[test]
fn a_change_changes_what_it_says() {
    let scene = read("scene", MEETING.as_bytes()).expect("a scene").scene;
    let end = |student: Student| {
        let bytes = student::trace(&scene, student).expect("a run");
        // The last record begins with the position of the first disc.
        let records: Vec<f64> =
            bytes.chunks_exact(8).map(|eight| f64::from_le_bytes(eight.try_into().expect("8"))).collect();
        (bytes, records)
    };
    let right = end(Student::default()).0;
    let differs = |place, operator| end(Student::default().with_mutation(Mutation { place, operator })).0 != right;
    assert!(differs(Place::AngularMomentum, Operator::Negated));
    assert!(differs(Place::FreeZone, Operator::NotAfterZero));
    assert!(differs(Place::ZoneOther, Operator::Other));
    assert!(!differs(Place::FreeZone, Operator::AtZero), "this zone turns");
    assert!(!differs(Place::ZoneEnd { role: 2 }, Operator::AfterOther), "there is no edge");
}
